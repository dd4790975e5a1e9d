"""Pages, surfaces and pictures of clumps."""
import base64
import json
import math
import re
import shlex
import struct
import zlib

from html import unescape

from support import Case

TWO = "0,0,0,1\n1.2,0,0,0.8\n"


def volume_of_two(a, b, distance):
    """Two balls less the two caps."""
    x = (distance ** 2 + a * a - b * b) / (2 * distance)
    cap = sum(math.pi * h * h * (3 * r - h) / 3 for r, h in ((a, a - x), (b, b - (distance - x))))
    return 4 / 3 * math.pi * (a ** 3 + b ** 3) - cap


def scene(page):
    text = re.search(r'<script type="application/json" id="scenes">(.*?)</script>', page, re.S).group(1)
    return json.loads(text)[0]


def numbers(text, kind):
    data = base64.b64decode(text)
    return struct.unpack(f"<{len(data) // struct.calcsize(kind)}{kind}", data)


class Surfaces(Case):
    def test_closed_in_every_format(self):
        self.write("two.csv", TWO)
        truth = volume_of_two(1, 0.8, 1.2)
        for ending in ("stl", "ply", "obj"):
            self.mskit("convert", "two.csv", "-o", "two." + ending, "--cells", 40)
            run = self.mskit("info", "two." + ending, "--json").json
            self.assertTrue(run["closed"])
            self.assertEqual(run["nonmanifold_edges"], 0)
            self.assertEqual(run["bodies"], 1)
            self.assertLess(run["volume"], truth)
            self.assert_close(run["volume"], truth, 0.002, ending)

    def test_resolution(self):
        self.write("two.csv", TWO)
        triangles = []
        for flag in (("--cells", 10), ("--cells", 20), ("--voxel-size", 0.1)):
            self.mskit("convert", "two.csv", "-o", "two.ply", *flag)
            triangles.append(self.mskit("info", "two.ply", "--json").json["triangles"])
        self.assertGreater(triangles[1], 3.5 * triangles[0])
        self.assertEqual(triangles[1], triangles[2], "20 cells on a shortest side of 2 are cells of 0.1")

    def test_says_what_is_lost(self):
        """A neck of width 0.1 between spheres of diameter 2."""
        gap = 2 * math.sqrt(1 - 0.05 ** 2)
        self.write("neck.csv",
                   f"0.123,0.456,0.789,1\n{0.123 + gap * 2 / 7},{0.456 + gap * 3 / 7},{0.789 + gap * 6 / 7},1\n")
        coarse = self.mskit("convert", "neck.csv", "-o", "neck.stl", "--cells", 5)
        self.assert_says(coarse, "of the volume of the spheres", "--cells")
        fine = self.mskit("convert", "neck.csv", "-o", "neck.stl", "--cells", 80)
        self.assertEqual(fine.err, "")
        self.write("far.csv", "0,0,0,1\n1e9,0,0,1\n")
        self.mskit("convert", "far.csv", "-o", "far.png", "-o", "far.html")
        self.assertIn("fewer cells", self.mskit("convert", "far.csv", "-o", "far.stl", code=1).err)

    def test_of_generate_and_score(self):
        self.shape("ball", name="ball.stl")
        self.mskit("generate", "ball.stl", "-n", 3, "--cells", 20, "-o", "c.csv", "-o", "c.stl")
        out = self.mskit("score", "c.csv", "--target", "ball.stl", "--cells", 20, "-o", "d.stl", "-o", "d.png")
        self.assertIn("wrote d.stl", out.out)
        self.assertEqual(self.read("c.stl"), self.read("d.stl"))
        width, height = struct.unpack(">II", self.read("d.png")[16:24])
        self.assertEqual((width, height), (1200, 600))
        self.mskit("convert", "c.csv", "-o", "alone.png")
        self.expect_ball(self.read("alone.png"))

    def expect_ball(self, png):
        """A picture of a disc: its grey pixels are those of a circle of 0.46 of the side."""
        size = struct.unpack(">I", png[33:37])[0]
        rows = zlib.decompress(png[41:41 + size])
        dark = sum(row[1:].count(255) < 600 for row in (rows[601 * j:601 * j + 601] for j in range(600)))
        self.assertAlmostEqual(dark, 2 * 0.46 * 600, delta=40)


class Pages(Case):
    def page(self, name):
        return self.read(name).decode()

    def test_spheres_and_shape(self):
        self.shape("grain", name="grain.ply")
        self.mskit("generate", "grain.ply", "-n", 60, "--cells", 30, "-o", "c.html", "-o", "c.csv")
        self.assertLess(len(self.read("c.html")), 600_000, "60 spheres and 18,432 triangles")
        shown, spheres = scene(self.page("c.html")), self.spheres("c.csv")
        values = numbers(shown["spheres"], "f")
        self.assertEqual(len(values), 4 * len(spheres))
        for k, sphere in enumerate(spheres):
            at = [shown["centre"][c] + shown["scale"] * values[4 * k + c] for c in range(3)]
            for got, wanted in zip(at + [shown["scale"] * values[4 * k + 3]], sphere):
                self.assertAlmostEqual(got, wanted, delta=1e-6)
        mesh = shown["mesh"]
        self.assertEqual(mesh["of"], 18432)
        self.assertEqual(len(numbers(mesh["faces"], "H")), 3 * 18432)
        self.assertFalse(shown["ordered"], "prefixes of variational are no clumps")
        most = max(numbers(shown["protrusion"], "f"))
        scores = self.mskit("score", "c.csv", "--target", "grain.ply", "--cells", 30, "--json").json["scores"]
        self.assert_close(most, scores["protrusion_max"], 0.1)
        self.assertIn(f"{scores['dice']:.5f}", self.page("c.html"))

    def test_protrusion_of_a_ball_beyond_another(self):
        self.shape("ball", "r=1", name="ball.stl")
        self.write("c.csv", "0,0,0,0.9\n0.5,0,0,0.7\n")
        self.mskit("score", "c.csv", "--target", "ball.stl", "--cells", 20, "-o", "c.html")
        first, second = numbers(scene(self.page("c.html"))["protrusion"], "f")
        self.assertEqual(first, 0)
        self.assert_close(second, 0.2, 0.05)

    def test_asks_for_nothing(self):
        """No address, no source of any kind but the hashes of what is in the page."""
        self.write("two.csv", TWO)
        self.mskit("convert", "two.csv", "-o", "two.html")
        page = self.page("two.html")
        policy = re.search(r'Content-Security-Policy" content="([^"]*)"', page).group(1)
        self.assertTrue(policy.startswith("default-src 'none'; script-src 'sha256-"), policy)
        self.assertNotRegex(page, r"https?://|<link|<iframe|\bsrc=|\bimport\b")
        self.assertNotIn("mesh", scene(page), "without a target the clump alone")

    def test_command_is_one_for_a_shell(self):
        self.write("two.csv", TWO)
        self.mskit("convert", "two.csv", "-o", "O'Brien & $(x) <b>.html", "--cells", 20)
        page = self.page("O'Brien & $(x) <b>.html")
        line = unescape(re.search(r'<pre id="command">(.*?)</pre>', page).group(1))
        self.assertEqual(sorted(shlex.split(line)),
                         sorted(["mskit", "convert", "two.csv", "-o", "O'Brien & $(x) <b>.html", "--cells", "20"]))

    def test_refusals(self):
        self.write("two.csv", TWO)
        self.shape("ball", name="ball.stl")
        self.assert_refused("convert", "two.csv", "-o", "a.html", "--rule", "centre", code=2,
                            says=("--rule", "--target"))
        self.assert_refused("convert", "two.csv", "-o", "a.csv", "--target", "ball.stl", code=2, says=("--target",))
        self.assert_refused("convert", "two.csv", "-o", "a.csv", "--cells", 20, code=2, says=("--cells", "surfaces"))
        self.assert_refused("score", "two.csv", "--target", "ball.stl", "--json", "-o", "-", code=2,
                            says=("choose one",))
        self.assert_refused("score", "two.csv", "--target", "ball.stl", "-o", "two.csv", code=1, says=("two.csv",))
        self.assert_refused("convert", "two.csv", "-o", "a.htm", code=2, says=("html", "stl"))
        self.write("apart.csv", "0,0,0,1\n1e200,0,0,1\n")
        self.assert_refused("convert", "apart.csv", "-o", "a.html", code=1, says=("too far",))
