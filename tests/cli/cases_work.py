"""mskit generate --least-work: the clump of least work among those that reach D."""
import re

from support import Case

GRID = ("--cells", "20", "-j", "1")


class LeastWork(Case):
    def setUp(self):
        super().setUp()
        self.grain = self.shape("grain", "fineness=8")

    def search(self, dice, *args, **more):
        result = self.mskit("generate", self.grain, *GRID, "--least-work", f"dice={dice}", "-o", "c.csv",
                            "--json", *args, **more)
        return result.json, result.err

    def check(self, run, words, dice, power):
        """The rows hold what they say, the one kept has the least work, and stderr has a line for each."""
        work = run["least_work"]
        self.assertEqual((work["dice"], work["power"]), (dice, power))
        rows = work["tried"]
        self.assertTrue(1 <= len(rows) <= 12)
        reached = [r for r in rows if r["n"] and r["dice"] <= dice]
        kept = rows[work["kept"]]
        self.assertEqual(kept["work"], min(r["work"] for r in reached))
        scores = run["scores"]
        self.assertEqual((kept["n"], kept["dice"]), (scores["spheres"], scores["dice"]))
        self.assertLessEqual(scores["dice"], dice)
        self.assert_close(kept["work"], scores["spheres"] / scores["smallest_radius_ratio"]**power, 1e-9, "work")
        self.assertEqual(min(s[3] for s in self.spheres("c.csv")), kept["smallest_radius"])
        for row in rows:
            self.assertTrue(not row["n"] or row["least_radius"] is None
                            or row["smallest_radius"] >= row["least_radius"])
        lines = re.findall(r"(?m)^variational: n (\d+)(?:, no radius below ([\d.e-]+))?: (?:D ([\d.]+), (\d+) "
                           r"spheres|no clump)",
                           words)
        self.assertEqual([(int(n), least == "", int(have or 0)) for n, least, _, have in lines],
                         [(r["n_asked"], r["least_radius"] is None, r["n"]) for r in rows])
        return kept

    def test_larger_spheres_are_less_work(self):
        kept = self.check(*self.search(0.12), 0.12, 1)
        run, words = self.search(0.12, "--work-power", "0")
        fewest = self.check(run, words, 0.12, 0)
        self.assertLessEqual(fewest["n"], kept["n"])
        self.assertGreaterEqual(kept["smallest_radius"], fewest["smallest_radius"])
        below = [r for r in run["least_work"]["tried"] if r["n"] == fewest["n"] - 1]
        self.assertTrue(below and below[0]["dice"] > 0.12, "one sphere less was tried and does not reach it")

    def test_the_record_repeats_it(self):
        run, _ = self.search(0.12)
        kept = run["least_work"]["tried"][run["least_work"]["kept"]]
        until = {"spheres": kept["n_asked"]}
        if kept["least_radius"] is not None:
            until["radius"] = kept["least_radius"]
        self.assertEqual(run["until"], until)
        first = self.read("c.csv")
        self.mskit("generate", self.grain, *GRID, "-n", until["spheres"],
                   *(("--until", f"radius={until['radius']!r}") if "radius" in until else ()), "-o", "again.csv")
        self.assertEqual(self.read("again.csv"), first)

    def test_bounds_are_kept_to(self):
        run, words = self.search(0.2, "-n", "9", "--min-radius", "0.3")
        kept = self.check(run, words, 0.2, 1)
        self.assertGreaterEqual(kept["smallest_radius"], 0.3)
        for row in run["least_work"]["tried"]:
            self.assertLessEqual(row["n_asked"], 9)
            self.assertGreaterEqual(row["least_radius"], 0.3)

    def test_what_is_not_reached(self):
        for args, says in ((("-n", "3"), ("none of ", "D 0.05", "3 spheres")),
                           (("--until", "radius=50"), ("radius below 50: no clump: variational placed no sphere",
                                                        "none of 1 runs gave a clump; the last: variational placed no "
                                                        "sphere"))):
            with self.subTest(args=args):
                result = self.mskit("generate", self.grain, *GRID, "--least-work", "dice=0.05", *args, "-o", "n.csv",
                                    code=1)
                for word in says:
                    self.assertIn(word, result.err)
                self.assertNotIn("n.csv", self.files())

    def test_each_run_has_its_remarks(self):
        """A bound that the clump kept cannot hold is said of that clump, too, and not of the first run alone."""
        run, words = self.search(0.5, "--gap", "0.5", "--protrusion", "0", "-n", "3")
        rows = run["least_work"]["tried"]
        self.assertGreater(len(rows), 1)
        self.assertEqual(re.findall(r"gap=0.5 cannot be held by (\d+) spheres", words),
                         [str(r["n"]) for r in rows if r["n"]])

    def test_wrong_usage(self):
        for args, says in ((("--least-work", "eta=0.1"), "dice=VALUE alone"), (("--least-work", "dice"), "least-work"),
                           (("--least-work", ""), "--least-work '' is not of the form"),
                           (("--least-work", "dice=2"), "least-work"), (("--work-power", "1"), "--least-work"),
                           (("--least-work", "dice=0.1", "--work-power", "4"), "work-power"),
                           (("--least-work", "dice=0.1", "--until", "eta=0.1"), "--min-radius")):
            with self.subTest(args=args):
                self.assert_refused("generate", self.grain, *args, code=2, says=(says,))
