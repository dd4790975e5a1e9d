"""What is expected before a clump is made, where it is said, and what is made of it."""
import csv
import io
import os
import re

from support import Case, box_obj


class Expected(Case):
    def test_info_of_a_torus(self):
        """Along a curve D is 11.72 / n^2 for R = 3 r, and 4/3 of that for inscribed spheres."""
        self.shape("torus")
        expected = self.mskit("info", "torus.stl", "--expect", "--json").json["expected"]
        dice = {row["spheres"]: row for row in expected["dice"]}
        self.assertEqual(list(dice), [5, 10, 15, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800, 1000])
        for n, row in dice.items():
            self.assertLess(row["free"], row["inscribed"], f"{n} spheres")
        self.assert_close(dice[20]["free"], 11.72 / 20**2, 0.06)
        self.assert_close(dice[20]["inscribed"], 4 / 3 * 11.72 / 20**2, 0.08)
        numbers = {row["dice"]: row for row in expected["spheres"]}
        self.assertEqual(list(numbers), [0.1, 0.05, 0.02, 0.01])
        self.assert_close(numbers[0.02]["free"], (11.72 / 0.02) ** 0.5, 0.06)
        self.assertLess(expected["least_spheres"]["free"], 12)
        self.assert_close(expected["range"][0] * expected["range"][1], 1, 1e-12)
        table = self.mskit("info", "torus.stl", "--expect").out
        self.assertRegex(table, r"expected least D by number of spheres \(asymptotic, an estimate, not a proven bound")
        self.assertRegex(table, r"(?m)^ +free( +[\d.e-]+){8}$")
        self.assertNotIn("expected", self.mskit("info", "torus.stl").out)
        self.assertNotIn("expected", self.mskit("info", "torus.stl", "--json").json)

    def test_figures_are_the_same_at_any_number_of_threads(self):
        self.shape("grain")
        one, three = (self.mskit("info", "grain.stl", "--expect", "--json",
                                 env={**os.environ, "OMP_NUM_THREADS": threads}).out for threads in ("1", "3"))
        self.assertEqual(one, three)

    def test_what_has_no_figure_is_refused(self):
        self.write("open.obj", box_obj((0, 0, 0), (3, 2, 1), skip=1))
        self.assert_refused("info", "open.obj", "--expect", code=1, says=("open.obj", "is open"))
        second = re.sub(r"(?m)^f (\d+) (\d+) (\d+)$", lambda m: "f %d %d %d" % tuple(int(v) + 8 for v in m.groups()),
                        box_obj((1, 1, 1), (3, 3, 3)))
        self.write("two.obj", box_obj((0, 0, 0), (2, 2, 2)) + second)
        self.assert_refused("info", "two.obj", "--expect", code=1, says=("two.obj", "passes through itself"))

    def test_generate_says_how_far_it_is(self):
        self.shape("torus")
        run = self.mskit("generate", "torus.stl", "-g", "variational", "-n", 12, "--cells", 30, "-o", "t.csv")
        self.assertRegex(run.out, r"times the least D expected of 12 spheres")
        self.assertNotIn("too thin", run.err)
        json = self.generate("torus.stl", "-g", "variational", "-n", 12, "--cells", 30, "-o", "u.csv")
        self.assert_close(json["expected"]["dice"], 11.72 / 12**2, 0.08)
        self.assert_close(json["expected"]["factor"], json["scores"]["dice"] / json["expected"]["dice"], 1e-9)

    def test_generate_warns_where_a_wall_is_too_thin(self):
        self.shape("plate", "c=0.2")
        run = self.mskit("generate", "plate.stl", "-g", "variational", "-n", 10, "--cells", 8, "-o", "p.csv")
        self.assertRegex(run.err,
                         r"for 10 spheres the least D to be expected is about 0\.\d+: most of the shape is too "
                                  r"thin for so few; \d+ would")

    def test_generate_of_an_open_mesh_has_none(self):
        self.write("open.obj", box_obj((0, 0, 0), (3, 2, 1), skip=1))
        json = self.generate("open.obj", "--allow-open", "-n", 3, "--cells", 10, "-o", "o.csv")
        self.assertIsNone(json["expected"])

    def test_compare_has_a_column_and_a_line(self):
        self.shape("torus")
        self.mskit("compare", "torus.stl", "-g", "mss", "-n", "10,20", "--cells", 20, "--charts", "charts")
        rows = list(csv.DictReader(io.StringIO(self.read("compare.csv").decode())))
        for row in rows:
            self.assert_close(float(row["expected"]), 11.72 / float(row["n"])**2, 0.08)
        self.assertIn("expected least", self.read("charts/torus-dice.gp").decode())
        self.assertNotIn("expected least", self.read("charts/torus-time.gp").decode())
