"""scene --report and grains --report: a row and a clump for each shape, on one page."""
import base64
import csv
import io
import json
import os
import re
import shutil
import struct

from html import unescape

from support import Case, box_obj, npy

GRID = ("-g", "mss", "--cells", "10", "-j", "1")


def scenes_of(page):
    return json.loads(re.search(r'id="scenes">(.*?)</script>', page, re.S).group(1))


def rows_of(page):
    """The scene of each row ("" without) and its cells."""
    body = re.search(r"<tbody>(.*?)</tbody>", page, re.S).group(1)
    return [(re.match(r"<tr(?: data-scene=\"(\d+)\")?>", row).group(1) or "",
             [unescape(cell) for cell in re.findall(r"<td[^>]*>([^<]*)", row)])
            for row in body.strip().split("\n")]


def spheres_of(scene):
    """In the frame of the clump; single precision."""
    data = base64.b64decode(scene["spheres"])
    shown = struct.iter_unpack("<4f", data)
    return [tuple(c + scene["scale"] * x for c, x in zip(scene["centre"] + [0], sphere)) for sphere in shown]


class Report(Case):
    def setUp(self):
        super().setUp()
        self.write("a&<b>.obj", box_obj((0, 0, 0), (3, 2, 1)))
        self.write("c.obj", box_obj((5, 5, 5), (6, 6, 7)))

    def page(self):
        return self.read("r.html").decode()

    def assert_shown(self, scene, clump):
        """The spheres of a page are those of a file."""
        rows = csv.DictReader(io.StringIO(self.read(clump).decode()))
        wanted = [tuple(float(row[key]) for key in "xyzr") for row in rows]
        shown = spheres_of(scene)
        self.assertEqual(len(shown), len(wanted))
        for a, b in zip(shown, wanted):
            for x, y in zip(a, b):
                self.assertLess(abs(x - y), 1e-5)

    def test_scene(self):
        self.write("scene.csv", "shape,count\na&<b>.obj,3\nc.obj,4\n")
        args = ("scene", "scene.csv", *GRID, "--budget", "20", "--max-spheres", "6", "--report", "r.html")
        alone = self.mskit(*args)
        self.assertIn("wrote r.html\n", alone.out)
        self.assertEqual(self.files(), ["a&<b>.obj", "c.obj", "r.html", "scene.csv"])
        told = self.mskit(*args, "-o", "out", "--density", "1000", "--json").json
        page = self.page()
        rows, scenes = rows_of(page), scenes_of(page)
        self.assertEqual([scene for scene, _ in rows], ["0", "1"])
        for (_, cells), shape, name in zip(rows, told["shapes"], ("a&<b>.obj", "c.obj")):
            scores = shape["scores"]
            self.assertEqual(cells[:3], [name, str(shape["particles"]), str(scores["spheres"])])
            self.assert_close(float(cells[3]), scores["dice"], 1e-4, "D")
            self.assert_close(float(cells[7]), shape["smallest_radius"], 1e-4, "least radius")
        self.assertIn(f"{told['spheres']} for 7 particles", page)
        self.assertNotIn("<h2>charts", page)
        for scene, name, clump in zip(scenes, ("a&<b>.obj", "c.obj"), sorted(os.listdir(self.path("out")))):
            self.assertTrue(scene["name"].startswith(name + ", mss, "), scene["name"])
            self.assertEqual(scene["mesh"]["of"], 12)
            self.assertIn("mass", scene)
            self.assert_shown(scene, "out/" + clump)

    def test_scene_charts(self):
        """A chart for each shape: D of its templates with the chosen one marked, or the measure of the tolerance; where
        gnuplot is missing the page stands without them and says so."""
        self.write("scene.csv", "shape,count\na&<b>.obj,3\nc.obj,4\n")
        common = ("scene", "scene.csv", *GRID, "--max-spheres", "6", "--charts", "charts", "--report", "r.html",
                  "--json")
        names = [f"charts/{stem}-dice" for stem in ("1-a&_b_", "2-c")]
        run = self.mskit(*common, "--budget", "20", code=1, env={**os.environ, "PATH": self.dir})
        self.assert_says(run, "gnuplot-nox", names[0] + ".gp")
        self.assertEqual(len(scenes_of(self.page())), 2)
        undrawn = re.findall(r"<p>not drawn: (.*?)\.gp; charts need gnuplot", unescape(self.page()))
        self.assertEqual(undrawn, names)
        for shape, name in zip(run.json["shapes"], names):
            templates, chosen = self.read(name + ".dat").decode().strip("\n").split("\n\n\n")
            drawn = [[float(word) for word in line.split()[:2]] for line in templates.split("\n")[1:]]
            self.assertEqual(drawn, [[n + 1, float(f"{dice:.9g}")] for n, dice in enumerate(shape["curve"])])
            n = shape["scores"]["spheres"]
            self.assertEqual(chosen.split("\n")[1].split()[:3:2], [str(n), f'"{n}"'])
        if not shutil.which("gnuplot"):
            self.skipTest("gnuplot is not installed (package gnuplot-nox)")
        self.write("charts/1-a&_b_-coverage.svg", "of a run before")
        run = self.mskit(*common, "--tolerance", "coverage=0.7")
        self.assertIn("drew charts/2-c-coverage.svg", run.err)
        self.assertEqual(self.page().count('<img class="chart" alt="'), 2)
        tolerance = self.read("charts/2-c-coverage.dat").decode().strip("\n").split("\n\n\n")[2]
        self.assertEqual([line.split()[1] for line in tolerance.split("\n")[1:]], ["0.7", "0.7"])
        self.assertNotIn(b"before", self.read("charts/1-a&_b_-coverage.svg"))

    def test_grains(self):
        """Of a volume each label, of a mesh itself, as they lie there; a grain without a clump is a row alone."""
        self.write("scan.npy",
                   npy([1 if i < 5 else 3 if i > 7 else 0 for _ in range(36) for i in range(12)], (6, 6, 12)))
        self.write("bad.obj", "nothing\n")
        args = ("grains", "scan.npy", "a&<b>.obj", "bad.obj", *GRID, "-n", "4", "-o", "out", "--report", "out/r.html")
        self.assertIn("wrote out/r.html\n", self.mskit(*args, "--format", "json", "--format", "csv").out)
        page = self.read("out/r.html").decode()
        table = list(csv.DictReader(io.StringIO(self.read("out/grains.csv").decode())))
        rows, scenes = rows_of(page), scenes_of(page)
        self.assertEqual([scene for scene, _ in rows], ["0", "1", "2", ""])
        self.assertEqual([(cells[0], cells[5], cells[6]) for _, cells in rows],
                         [(row["grain"], row["status"], row["n"]) for row in table])
        for (_, cells), row in zip(rows[:3], table):
            self.assert_close(float(cells[7]), float(row["dice"]), 1e-4, "D")
        self.assertEqual(rows[2][1][1], "a&<b>.obj")
        for scene, row in zip(scenes, table):
            self.assert_shown(scene, "out/" + row["file"].replace(".json", ".csv"))
            self.assertIn("mesh", scene)
        lows = [scene["centre"][0] + scene["scale"] * scene["mesh"]["low"][0] for scene in scenes[:2]]
        self.assertGreater(lows[1], lows[0] + 6, "each grain is where its label is")
        os.remove(self.path("out/r.html"))
        self.mskit(*args, "--format", "json", "--format", "csv", "--resume")
        again = self.read("out/r.html").decode()
        self.assertEqual(scenes_of(again), scenes, "clumps of a run before are read back")

    def test_largest_piece(self):
        """What is shown is what the clump was made of."""
        label = [1 if i < 5 or i > 9 else 0 for _ in range(36) for i in range(12)]
        self.write("scan.npy", npy(label, (6, 6, 12)))
        for flag, least, most in ((("--largest-piece",), 4, 6), ((), 11, 13)):
            self.mskit("grains", "scan.npy", *GRID[:2], "-n", "2", *flag, "-o", "out" + "".join(flag),
                       "--report", "r.html")
            scene = scenes_of(self.page())[0]
            width = scene["scale"] * (scene["mesh"]["high"][0] - scene["mesh"]["low"][0])
            self.assertTrue(least < width < most, width)

    def test_refused(self):
        self.write("scene.csv", "shape,count\nc.obj,4\n")
        scene = ("scene", "scene.csv", *GRID, "--budget", "20", "--report")
        grains = ("grains", "c.obj", *GRID, "-n", "2", "-o", "out", "--report")
        compare = ("compare", "c.obj", *GRID, "-n", "2", "--charts", "charts", "--report")
        for command in (scene, grains, compare, ("stability", "c.obj", "-n", "2", "--report")):
            for other in ("-", "c.obj", "page", "page.txt", "x.html/page"):
                self.assert_refused(*command, other, code=2, says=("--report", f"'{other}'", ".html"))
        os.symlink("c.obj", self.path("c.html"))  # an input by the name of a page
        for command in (scene, grains, compare):
            self.assert_refused(*command, "c.html", code=1, says=("c.html", "input"))
        for folder, why in (("no/charts", "No such file"), ("c.obj", "File exists")):
            self.assert_refused("stability", "c.obj", *GRID, "-n", "2", "--charts", folder, code=1,
                                says=(f"the folder '{folder}' cannot be made: {why}",))
        self.assert_refused(*scene, "no/r.html", code=1, says=("no/r.html",))
        self.assert_refused(*grains, "no/r.html", code=1, says=("no/r.html",))
        self.assert_refused(*grains, "r.html", "--format", "vtk", code=1, says=("vtk", "--format csv"))
        self.assert_refused(*grains, "r.html", "--dry-run", code=2, says=("--dry-run", "--report"))
        self.assert_refused("grains", "--merge", "a", "-o", "out", "--report", "r.html", code=2,
                            says=("--merge", "--report"))
