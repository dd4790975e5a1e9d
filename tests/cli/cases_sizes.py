"""mskit scene: particles in sizes, by a column of the manifest or a sieve curve; a tolerance that is a length."""
import json
import math
import os
import re

from cases_report import scenes_of
from support import Case, box_obj

QUICK = ("--cells", "20", "-j", "1", "-g", "mss")
VOLUME, AREA = 6, 22  # of the box 3:2:1
OWN = (6 * VOLUME / math.pi) ** (1 / 3)
MASSES = ("--density", "2650", "--unit", "mm")
SCRIPTS = ("--format", "liggghts", "--format", "lammps", "--format", "yade")


class Sizes(Case):
    """A cuboid in sizes."""

    def setUp(self):
        super().setUp()
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))

    def manifest(self, *rows, header="shape,count,size"):
        return self.write("scene.csv", "\n".join([header, *rows]) + "\n")

    def scene(self, *args, source="scene.csv"):
        return self.mskit("scene", source, "--json", *args).json


class Column(Sizes):
    ROWS = ("box.obj,7,0.5", "box.obj,4,", " box.obj , 2 , 2.75 ")
    NAMES = {"box-0.5": 0.5, "box": None, "box-2.75": 2.75}

    def test_templates_are_scaled(self):
        """All sizes have the curve of the shape, and its template in their size; the volume is that of the ball."""
        self.manifest(*self.ROWS)
        scene = self.scene(*QUICK, "--tolerance", "dice=0.2", "--max-spheres", "20", "-o", "out")
        self.assertEqual(sorted(os.listdir(self.path("out"))), sorted(name + ".csv" for name in self.NAMES))
        self.assertEqual([s["size"] for s in scene["shapes"]], list(self.NAMES.values()))
        own = self.spheres("out/box.csv")
        self.assertGreater(len(own), 1)
        for shape, (name, size) in zip(scene["shapes"], self.NAMES.items()):
            factor = (size or OWN) / OWN
            self.assertEqual(shape["curve"], scene["shapes"][1]["curve"])
            self.assertEqual(shape["scores"], scene["shapes"][1]["scores"])
            spheres = self.spheres(f"out/{name}.csv")
            self.assertEqual(len(spheres), len(own))
            for sphere, its in zip(spheres, own):
                for got, want in zip(sphere, its):
                    self.assertAlmostEqual(got, factor * want, delta=1e-14 * factor * 4)
            self.assertEqual(shape["smallest_radius"], min(s[3] for s in spheres))
        self.assertEqual((scene["smallest"]["shape"], scene["smallest"]["size"]), ("box.obj", 0.5))
        self.assertEqual(scene["particles"], 13)
        self.assertEqual(scene["spheres"], 13 * len(own))

    def test_one_size_is_as_without(self):
        """A shape whose rows have no size gives what it gave without the column."""
        self.write("plain.csv", "shape,count\nbox.obj,4\n")
        self.manifest("box.obj,4,")
        args = (*QUICK, "--budget", "24", "--max-spheres", "8", *MASSES, *SCRIPTS, "-o")
        texts = [self.mskit("scene", name, *args, folder).out.replace(name, "X").replace(folder, "Y")
                 for name, folder in (("plain.csv", "one"), ("scene.csv", "two"))]
        self.assertEqual(*texts)
        for name in os.listdir(self.path("one")):
            self.assertEqual(self.read("one/" + name), self.read("two/" + name))

    def test_masses(self):
        """Mass by size^3, moments by size^5, sums exact in all scripts, where the largest come first."""
        self.manifest(*self.ROWS)
        self.mskit("scene", "scene.csv", *QUICK, "--tolerance", "dice=0.2", "--carriers", *MASSES, *SCRIPTS, "--format",
                   "json", "-o", "out")
        total = 0
        order = [("box-2.75", 2, 2.75), ("box", 4, OWN), ("box-0.5", 7, 0.5)]
        for name, count, size in order:
            particle = json.loads(self.read(f"out/{name}.json"))["particle"]
            mass = 2650 * math.pi / 6 * (size * 1e-3) ** 3
            self.assert_close(particle["mass"], mass, 1e-12, "mass")
            moments = sorted(particle["principal_moments"])
            for got, (a, b) in zip(moments, ((1, 2), (1, 3), (2, 3))):
                self.assert_close(got, mass * (a * a + b * b) / 12 * (size / OWN * 1e-3) ** 2, 1e-11, "moment")
            total += count * mass
        liggghts, lammps, yade = (self.read("out/scene." + name).decode()
                                  for name in ("liggghts.in", "lammps.in", "yade.py"))
        names, counts = [o[0] for o in order], [o[1] for o in order]
        self.assertEqual(re.findall(r"file \"?([^\" ]*)\.liggghts", liggghts), names)
        self.assertEqual(re.findall(r"particles_in_region (\d+)", liggghts), ["2", "6", "13"])
        self.assertEqual([int(n) for n in re.findall(r" deposit (\d+) ", lammps)], counts)
        self.assertEqual(re.findall(r"(?m)^    \"?([^ ]*)\.lammps", lammps), names)
        rows = re.findall(r"(?m)^    \((\d+), '([^']*)\.yade', 1, ([^,]*),", yade)
        self.assertEqual([(int(n), name) for n, name, _ in rows], list(zip(counts, names)))
        self.assert_close(sum(int(n) * float(m) for n, _, m in rows), total, 1e-12, "mass of all")
        given = [float(m) for m in re.findall(r" mass (\d\S+) inertia", liggghts)]
        self.assert_close(sum(n * m for n, m in zip(counts, given)), total, 1e-12, "mass of all")

    def test_report(self):
        """A line and a page of all rows; the scenes of the page are in their sizes, shape and clump alike."""
        self.manifest(*self.ROWS)
        out = self.mskit("scene", "scene.csv", *QUICK, "--knee", "0.3", "--report", "page.html").out
        self.assertRegex(out, r"least r +size\n")
        self.assertIn(" its own\n", out)
        self.assertIn(" in box.obj, size 0.5; by convention", out)
        scenes = scenes_of(self.read("page.html").decode())
        for scene, size in zip(scenes, self.NAMES.values(), strict=True):
            factor = (size or OWN) / OWN
            for got, want in zip(scene["centre"], (1.5, 1, 0.5)):
                self.assert_close(got, factor * want, 1e-6, "centre of the page's scene")
            self.assert_close(scene["scale"], factor * 14 ** 0.5 / 2, 1e-6, "its scale")

    def test_refused(self):
        for header, row, says in (
            ("shape,count,size", "box.obj,1,0", ("line 2", "size '0'")),
            ("shape,count,size", "box.obj,1,-1", ("line 2", "size '-1'")),
            ("shape,count,size", "box.obj,1,nan", ("line 2", "size 'nan'")),
            ("shape,count,size", "box.obj,1,1e51", ("line 2", "size '1e51'")),
            ("shape,count,size", "box.obj,1", ("line 2", "2 more columns")),
            ("shape,count,size", "box.obj,1,2\nbox.obj,3,2.0", ("line 3", "box.obj stands twice in this size")),
            ("shape,count,size", "box.obj,1,\nbox.obj,3,", ("line 3", "box.obj stands twice;")),
            ("shape,size,count", "box.obj,1,2", ("line 1", "header")),
            ("shape,count,size,size", "box.obj,1,2,2", ("line 1", "header")),
            ("shape,count,tolerance,size,size", "box.obj,1,1,2,2", ("line 1", "header")),
            ("shape,count,size", "box.obj,1,1.2345678\nbox.obj,3,1.2345679",
             ("in the sizes 1.2345678", "would both be out/box-1.23457.csv")),
        ):
            with self.subTest(header=header, row=row):
                self.manifest(row, header=header)
                self.assert_refused("scene", "scene.csv", *QUICK, "--budget", "50", "-o", "out", code=1, says=says)
        self.manifest("box.obj,1,2")
        self.assert_refused("scene", "scene.csv", *QUICK, "--budget", "9", "--min-radius", "0.1", code=2,
                            says=("--min-radius", "own size"))

    def test_columns_in_any_order(self):
        for header, row in (("shape,count,size,tolerance", "box.obj,2,5,0.3"),
                            ("shape,count,tolerance,size", "box.obj,2,0.3,5")):
            self.manifest(row, header=header)
            (shape,) = self.scene(*QUICK)["shapes"]
            self.assertEqual((shape["size"], shape["tolerance"], shape["particles"]), (5, 0.3, 2))


class Length(Sizes):
    """D <= L A / (2 V): the mean distance of the surfaces is no more than L, in the size of each particle."""

    SIZES = (0.6, 1.2, OWN, 5)

    def check(self, scene, length):
        numbers = []
        for shape, size in zip(scene["shapes"], self.SIZES, strict=True):
            factor = size / OWN
            limit = length * AREA / (2 * VOLUME * factor)
            self.assert_close(shape["tolerance"], limit, 1e-12, "D")
            n = shape["scores"]["spheres"]
            self.assertLessEqual(shape["curve"][n - 1], limit)
            if n > 1:
                self.assertGreater(shape["curve"][n - 2], limit)
            distance = 2 * VOLUME / AREA * factor * shape["scores"]["dice"]
            self.assert_close(shape["mean_distance"], distance, 1e-12, "distance")
            self.assertLessEqual(shape["mean_distance"], length)
            numbers.append(n)
        self.assertEqual(numbers, sorted(numbers))
        return numbers

    def test_smaller_particles_get_fewer_spheres(self):
        self.manifest(*(f"box.obj,9,{size!r}" for size in self.SIZES))
        for generator, length in (("mss", 0.14), ("variational", 0.1)):
            with self.subTest(generator=generator):
                scene = self.scene("--cells", "20", "-j", "1", "-g", generator, "--tolerance-length", length,
                                   "--max-spheres", "60")
                self.assertEqual(scene["goal"], {"tolerance_length": length, "measure": "dice"})
                numbers = self.check(scene, length)
                self.assertEqual(numbers[0], 1)
                self.assertEqual(len(set(numbers)), len(numbers))
        out = self.mskit("scene", "scene.csv", *QUICK, "--tolerance-length", "0.14").out
        self.assertIn("a mean distance of 0.14 between the surfaces", out)

    def test_alone(self):
        """Without sizes it is the D of that distance; a column of tolerances goes before it."""
        self.manifest("box.obj,1,", header="shape,count,tolerance")
        length = 0.25 * 2 * VOLUME / AREA
        one = self.scene(*QUICK, "--tolerance-length", repr(length))["shapes"][0]
        other = self.scene(*QUICK, "--tolerance", "dice=0.25")["shapes"][0]
        self.assertEqual(one["scores"], other["scores"])
        self.manifest("box.obj,1,0.4", header="shape,count,tolerance")
        self.assertEqual(self.scene(*QUICK, "--tolerance-length", repr(length))["shapes"][0]["tolerance"], 0.4)

    def test_refused(self):
        self.manifest("box.obj,1,1")
        for args, says in ((("--tolerance-length", "0"), "'0' is not a number above 0\n"),
                           (("--tolerance-length", "nan"), "'nan'"),
                           (("--tolerance-length", "0.1", "--budget", "9"), "exclude one another")):
            with self.subTest(args=args):
                self.assert_refused("scene", "scene.csv", *QUICK, *args, code=2, says=(says,))
        self.assert_refused("scene", "scene.csv", *QUICK, "--tolerance-length", "1e-9", "--max-spheres", "3", code=1,
                            says=("box.obj, size 1:", "3 spheres has a mean distance of 1e-09, the best has 0."))
        self.manifest("box.obj,1,1,1e-9", header="shape,count,size,tolerance")
        self.assert_refused("scene", "scene.csv", *QUICK, "--tolerance-length", "1", "--max-spheres", "3", code=1,
                            says=("3 spheres has dice 1e-09",))


class Sieve(Sizes):
    CURVE = "size,passing\n0.5,0\n1,0.3\n2,0.9\n3,1\n"
    BOUNDS = (0.5, 1, 2, 3)
    SHARES = (0.3, 0.6, 0.1)

    def setUp(self):
        super().setUp()
        self.shape("tablet", "fineness=12")
        self.write("curve.csv", self.CURVE)
        self.manifest("box.obj,150", "tablet.stl,50", header="shape,count")

    def test_counts(self):
        """The best whole numbers, found by trying all, with the sum kept for each shape."""
        scene = self.scene(*QUICK, "--budget", "200", "--max-spheres", "2", "--sieve", "curve.csv")
        sizes = [((a ** -3 - b ** -3) / (3 * math.log(b / a))) ** (-1 / 3)
                 for a, b in zip(self.BOUNDS, self.BOUNDS[1:])]
        mass = [s ** 3 for s in sizes]
        each = 200 / sum(p / m for p, m in zip(self.SHARES, mass))
        best = min(((200 - b - c, b, c) for b in range(201) for c in range(201 - b)),
                   key=lambda n: sum((k * m - each * p) ** 2 for k, m, p in zip(n, mass, self.SHARES)))
        self.assertGreater(min(best), 0)
        self.assertEqual([row["particles"] for row in scene["sieve"]], list(best))
        have = sum(n * m for n, m in zip(best, mass))
        for row, size, share, n, m in zip(scene["sieve"], sizes, self.SHARES, best, mass):
            self.assert_close(row["size"], size, 1e-12, "size")
            self.assert_close(row["asked"], share, 1e-12, "share")
            self.assert_close(row["have"], n * m / have, 1e-12, "share")
        for path, count in (("box.obj", 150), ("tablet.stl", 50)):
            self.assertEqual(sum(s["particles"] for s in scene["shapes"] if s["input"]["path"] == path), count)
        for size, n in zip((row["size"] for row in scene["sieve"]), best):
            self.assertEqual(sum(s["particles"] for s in scene["shapes"] if s["size"] == size), n)

    def test_classes(self):
        scene = self.scene(*QUICK, "--budget", "200", "--max-spheres", "2", "--sieve", "curve.csv", "--classes", "5")
        self.assertEqual(len(scene["sieve"]), 5)
        for row in scene["sieve"]:
            self.assert_close(row["asked"], 0.2, 1e-12, "share")

    def test_one_shape(self):
        out = self.mskit("scene", "box.obj", *QUICK, "--budget", "40", "--particles", "40", "--sieve", "curve.csv",
                         *MASSES, *SCRIPTS, "-o", "out").out
        self.assertIn("sieve curve, by mass", out)
        deposits = re.findall(r" deposit (\d+) ", self.read("out/scene.lammps.in").decode())
        self.assertEqual(sum(int(n) for n in deposits), 40)

    def test_refused(self):
        self.write("bad.csv", "size,passing\n1,0\n")
        quick = (*QUICK, "--budget", "300")
        self.assert_refused("scene", "scene.csv", *quick, "--sieve", "none.csv", code=1, says=("none.csv",))
        self.assert_refused("scene", "scene.csv", *quick, "--sieve", "bad.csv", code=1, says=("bad.csv", "not 1"))
        for args, says in ((("--classes", "3"), "--sieve FILE"),
                           (("--sieve", "curve.csv", "--classes", "0"), "--classes"),
                           (("--sieve", "curve.csv", "--classes", "1.5"), "--classes")):
            self.assert_refused("scene", "scene.csv", *quick, *args, code=2, says=(says,))
        self.manifest("box.obj,3,1")
        self.assert_refused("scene", "scene.csv", *quick, "--sieve", "curve.csv", code=2,
                            says=("has sizes", "--sieve curve.csv"))
        self.write("out.csv", self.CURVE)
        os.symlink("out.csv", self.path("out.html"))
        self.assert_refused("scene", "box.obj", *quick, "--sieve", "out.csv", "--particles", "9",
                            "--report", "out.html", code=1, says=("out.html", "input"))
