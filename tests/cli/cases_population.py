"""mskit compare of many shapes: tables against the rows, the verdict, clumps of other tools that go with shapes by
name."""
import csv
import json
import os
import re
import shutil
import statistics
import unittest

from support import Case, box_obj

RUN = ("-g", "variational", "-g", "mss", "-n", "2,4", "--cells", "8", "-j", "1")


class Population(Case):
    def setUp(self):
        super().setUp()
        os.mkdir(self.path("shapes"))
        for k in range(6):
            self.write(f"shapes/box-{k}.obj", box_obj((0, 0, 0), (3, 2, 1 + k / 4)))
        self.write("shapes/readme.txt", "no shape")

    def table(self, name):
        with open(self.path(name), newline="", encoding="utf-8") as stream:
            return list(csv.DictReader(stream))

    def clumps(self, ending="-tool.csv", but=()):
        os.makedirs(self.path("clumps"), exist_ok=True)
        for k in range(6):
            if k not in but:
                self.write(f"clumps/box-{k}{ending}", f"1,1,0.5,0.5\n2,1,{0.5 + k / 8},0.5\n")


@unittest.skipUnless(shutil.which("gnuplot"), "gnuplot is not installed (package gnuplot-nox)")
class Tables(Population):
    def test_folder_and_pattern_are_one_list(self):
        wanted = [f"shapes/box-{k}.obj" for k in range(6)]
        for word in ("shapes", "shapes/", "shapes/*", "shapes/box-?.obj"):
            with self.subTest(word=word):
                self.mskit("compare", word, "-g", "mss", "-n", "1", "--cells", "6", "-j", "1", "-o", "one.csv")
                self.assertEqual([row["shape"] for row in self.table("one.csv")], wanted)
                os.remove(self.path("one.csv"))

    def test_tables_are_those_of_the_rows(self):
        self.mskit("compare", "shapes", *RUN, "--population", "pop")
        rows, spread = self.table("compare.csv"), self.table("pop/population.csv")
        self.assertEqual({row["generator"] for row in spread}, {"variational", "mss"})
        first = statistics.mean(float(row["seconds_generate"]) for row in rows
                                if (row["generator"], row["n_asked"]) == ("variational", "2"))
        for row in spread:
            normalised = row["quantity"] == "time_normalised"
            column = "seconds_generate" if normalised else row["quantity"]
            values = [float(r[column]) / (first if normalised else 1) for r in rows
                      if all(r[c] == row[c] for c in ("cells", "generator", "options", "n_asked")) and r[column]]
            self.assertEqual(int(row["shapes"]), len(values))
            self.assert_close(float(row["mean"]), statistics.mean(values), 1e-9)
            quartiles = statistics.quantiles(values, n=4, method="inclusive")
            for name, value in zip(("lower_quartile", "median", "upper_quartile"), quartiles):
                self.assert_close(float(row[name]), value, 1e-9)
        self.check_best(rows, self.table("pop/best.csv"))
        whole = json.loads(self.read("pop/population.json"))
        self.assertEqual((len(whole["population"]), len(whole["best"])), (len(spread), 8))

    def check_best(self, rows, best):
        dice = {(r["shape"], r["generator"], r["n_asked"]): float(r["dice"]) for r in rows}
        shapes = {r["shape"] for r in rows}
        for row in best:
            if row["by"] == "dice":
                other = "mss" if row["generator"] == "variational" else "variational"
                ratios = [max(dice[s, other, row["n_asked"]], 1e-6) /
                          max(dice[s, row["generator"], row["n_asked"]], 1e-6)
                          for s in shapes]
                self.assertEqual((int(row["shapes"]), int(row["best"])), (6, sum(r >= 1 for r in ratios)))
                self.assert_close(float(row["factor"]), statistics.geometric_mean(ratios), 1e-9)
                self.assertTrue(float(row["factor_low"]) <= float(row["factor"]) <= float(row["factor_high"]))

    def test_report_of_other_tools(self):
        """A clump of a folder, in a format that is no text; all into a folder that is not there, the sums on stdout."""
        os.mkdir(self.path("given"))
        self.write("two.csv", "1,1,0.5,0.5\n2,1,0.5,0.5\n")
        self.mskit("convert", "two.csv", "-o", "given/box-0.json")
        run = self.mskit("compare", "shapes/box-0.obj", "-g", "mss", "-n", "1", "--cells", "6", "-j", "1", "--clump",
                         "tool=given", "-o", "out/c.csv", "--charts", "out", "--report", "out/r.html", "--json")
        self.assertEqual([row["generator"] for row in run.json], ["mss", "tool"])
        self.assertIn("drew out/box-0-work.svg", run.err)
        page = self.read("out/r.html").decode()
        scenes = json.loads(re.search(r'id="scenes">(.*?)</script>', page, re.S).group(1))
        self.assertEqual([scene["name"] for scene in scenes], ["shapes/box-0.obj, mss, 1 spheres",
                                                               "shapes/box-0.obj, tool:given/box-0.json, 2 spheres"])
        self.assertEqual(re.findall(r'data-scene="(\d+)"', page), ["0", "1"])

    def test_no_clump_of_a_run_before(self):
        """A run that fails in a folder of charts leaves its place empty: the clump that was kept there is not its
        own."""
        run = ("compare", "shapes/box-0.obj", "-g", "mss", "-n", "2", "--cells", "8", "--charts", "out")
        self.mskit(*run, "-o", "a.csv")
        self.assertTrue(os.path.exists(self.path("out/box-0-mss-2.csv")))
        failed = self.mskit(*run, "-o", "b.csv", "--min-radius", "1e6", code=1)
        self.assertIn("its place on the contact sheet is empty", failed.err)
        self.assertFalse(os.path.exists(self.path("out/box-0-mss-2.csv")))

    def test_the_verdict(self):
        result = self.mskit("compare", "shapes", *RUN, "--population", "pop")
        lines = [line for line in result.err.split("\n") if line.startswith("n = ")]
        self.assertEqual([line.split(": ")[0] for line in lines], ["n = 2", "n = 4", "n = 4"])
        best = {(r["n_asked"], r["by"], r["generator"]): r for r in self.table("pop/best.csv")}
        self.assertIn(f"on {best['2', 'dice', 'variational']['best']} of 6 shapes", lines[0])
        self.assertIn("(95 %: ", lines[0])
        self.assertIn("is the quickest", lines[2])
        self.assertNotIn("side by side", lines[2])
        with self.subTest("again, of rows that are there: the same bits"):
            text = self.read("pop/best.csv")
            again = self.mskit("compare", "shapes", *RUN, "--population", "pop", "--resume")
            self.assertEqual(lines, [line for line in again.err.split("\n") if line.startswith("n = ")])
            self.assertEqual(text, self.read("pop/best.csv"))

    def test_the_verdict_does_not_pretend(self):
        says = self.mskit("compare", "shapes/box-0.obj", "shapes/box-1.obj", "-g", "mss", "-g", "mss:boost=1",
                          "-n", "1", "--cells", "8", "-j", "1").err
        self.assertIn("not to be told apart", says)
        says = self.mskit("compare", "shapes", "-g", "mss", "-n", "1", "--cells", "8", "-j", "1", "-o", "one.csv").err
        self.assertNotIn("n = 1", says, "of one method there is nothing to say")


@unittest.skipUnless(shutil.which("gnuplot"), "gnuplot is not installed (package gnuplot-nox)")
class Clumps(Population):
    def test_clumps_of_a_folder(self):
        self.clumps()
        self.write("clumps/other.csv", "not read: it goes with no shape")
        os.mkdir(self.path("clumps/box-1.mercury"))  # a template that is a folder, which is written and not read
        os.mkdir(self.path("pop"))
        self.write("pop/population-dice.svg", "of a run before")
        for word in ("clumps", "clumps/box-*.csv", "./clumps/*-tool.csv"):
            self.mskit("compare", "shapes", "-g", "mss", "-n", "4", "--cells", "8", "-j", "1",
                       "--clump", f"tool={word}", "-o", "c.csv", "--population", "pop")
            rows = [row for row in self.table("c.csv") if row["generator"] == "tool"]
            self.assertEqual([(r["shape"], r["options"], r["n"], r["seconds_generate"]) for r in rows],
                             [(f"shapes/box-{k}.obj", f"{word.split('clumps')[0]}clumps/box-{k}-tool.csv", "2", "")
                              for k in range(6)])
            scores = self.mskit("score", "clumps/box-3-tool.csv", "--target", "shapes/box-3.obj", "--cells", "8",
                                "--json").json["scores"]
            self.assertEqual(float(rows[3]["dice"]), scores["dice"])
            found = {r["quantity"]: r for r in self.table("pop/population.csv") if r["generator"] == "tool"}
            self.assertEqual((found["dice"]["n_asked"], found["dice"]["shapes"]), ("4", "6"))
            self.assertFalse({"seconds_generate", "time_normalised"} & set(found), "nobody knows its time")
            self.assertEqual({r["shapes"] for r in self.table("pop/best.csv") if r["generator"] == "tool"}, {"6"})
            self.assertFalse(os.path.exists(self.path("pop/population-dice.svg")), "of one number there is no chart")
            os.remove(self.path("c.csv"))

    def test_the_longer_name_has_it(self):
        self.write("a.obj", box_obj((0, 0, 0), (3, 2, 1)))
        self.write("a-b.obj", box_obj((0, 0, 0), (3, 2, 2)))
        os.mkdir(self.path("two"))
        self.write("two/a.csv", "1,1,0.5,0.5\n")
        self.write("two/a-b-tool.csv", "1,1,1,1\n")
        self.mskit("compare", "a.obj", "a-b.obj", "-g", "mss", "-n", "1", "--cells", "8", "-j", "1", "--clump", "x=two")
        self.assertEqual([r["options"] for r in self.table("compare.csv") if r["generator"] == "x"],
                         ["two/a.csv", "two/a-b-tool.csv"])


class Refusals(Population):
    def refused(self, *args, says, code=2):
        self.assert_refused("compare", *args, "-g", "mss", "-n", "1", "--cells", "6", code=code, says=says)

    def test_clumps(self):
        self.clumps(but=(4,))
        self.refused("shapes", "--clump", "tool=clumps", says=("no clump goes with shapes/box-4.obj",))
        self.clumps()
        self.refused("shapes", "--clump", "tool=clumps/box-0-tool.csv", says=("of one shape", "there are 6"))
        self.refused("shapes", "--clump", "tool=clumps", "--clump", "tool=clumps/*.csv", says=("tool is there twice",))
        self.refused("shapes", "--clump", "tool=clumps/*.none", says=("clumps/*.none", "pattern"))
        self.clumps(ending=".json")
        self.refused("shapes", "--clump", "tool=clumps", says=("box-0-tool.csv and clumps/box-0.json", "FOLDER/*.csv"))
        self.write("clumps/box-2-tool.csv", "no,clump\n")
        self.refused("shapes", "--clump", "tool=clumps/*.csv", says=("box-2-tool.csv",))

    def test_shapes(self):
        os.mkdir(self.path("none"))
        self.refused("none", says=("none: no mesh and no volume is in this folder",), code=1)
        self.refused("*.stl", says=("*.stl: no file has this name or fits this pattern",), code=1)
        self.refused("shapes/*.txt", says=("no mesh and no volume fits this pattern",), code=1)
        self.refused("shapes/box-0.obj", "--population", "pop", says=("--population takes several shapes",))
        self.refused("shapes", "--population", "no/such", says=("no/such",), code=1)
        os.mkdir(self.path("pop"))
        self.refused("shapes", "--population", "pop", "-o", "pop/best.csv", says=("pop/best.csv",), code=1)
        self.refused("shapes", "shapes/box-0.obj", says=("shapes/box-0.obj is there twice",))
        self.refused("shapes", "./shapes/box-0.obj", says=("./shapes/box-0.obj is there twice, as shapes/box-0.obj",))


if __name__ == "__main__":
    unittest.main()
