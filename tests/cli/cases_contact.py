"""mskit contact: counts, ratios and poses of clumps whose contacts are known; what is refused."""
import csv
import io
import math
import re

from support import Case, box_obj, npy

B2 = math.log(2)**2 / (math.pi**2 + math.log(2)**2)


def restitution(n):
    """Of n contacts, each for e = 0.5."""
    return math.exp(-math.pi * math.sqrt(n * B2 / (1 - n * B2)))


class Contact(Case):
    def setUp(self):
        super().setUp()
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))
        # Flat: six spheres of radius 1/2 that fill the box's height, centres 1/2 from its sides.
        self.write("six.csv", "x,y,z,r\n" + "".join(f"{x},{y},0.5,0.5\n" for x in (0.5, 1.5, 2.5) for y in (0.5, 1.5)))

    def contact(self, *args):
        return self.mskit("contact", *args, "--poses", "50", "--json").json

    def row(self, found, against, where):
        rows = [r for r in found["contacts"] if (r["against"], r["where"]) == (against, where)]
        self.assertEqual(len(rows), 1)
        return rows[0]

    def test_flat_clump_on_plane(self):
        found = self.contact("six.csv", "--target", "box.obj", "--overlap", "0.001")
        r_eq = (3 * 6 / (4 * math.pi))**(1 / 3)
        self.assert_close(found["r_eq"], r_eq, 1e-12)
        row = self.row(found, "plane", "poses")
        poses = found["clump"]["poses"]
        self.assertEqual(len(poses), 2)  # it rolls off its sides, where spheres in one row touch
        for pose in poses:
            self.assert_close(abs(pose["down"][2]), 1, 1e-12)
            self.assert_close(pose["height"], 0.5 / r_eq, 1e-9, "height")
            self.assert_close(pose["barrier"], 0.5 / r_eq, 1e-9, "over a row, on the lattice")
            self.assertAlmostEqual(pose["share"], 0.5, delta=0.01)
            self.assertLess(pose["angle"], 1e-6)
        self.assertEqual(len(row["counts"]), 1)
        for name, truth in (("contacts", 6), ("stiffness", 6 * math.sqrt(0.5 / r_eq)),
                            ("damping", 6 * (0.5 / r_eq)**0.25), ("restitution", restitution(6)),
                            ("restitution_least", restitution(6)), ("contacts_median", 6), ("contacts_most", 6)):
            self.assert_close(row[name], truth, 1e-6, name)
        self.assertEqual((row["counts"][0][0], row["overdamped"], row["missed"]), (6, 0, 0))

    def test_factors(self):
        """On its face the clump stands on six, at random mostly on one, which pays: a sixth of the stiffness."""
        args = ("six.csv", "--target", "box.obj", "--overlap", "0.001")
        found = self.contact(*args, "--factors")
        self.assertNotIn("factors", self.contact(*args))
        self.assertEqual([(f["against"], f["where"]) for f in found["factors"]],
                         [(r["against"], r["where"]) for r in found["contacts"]])
        factors, = (f for f in found["factors"] if (f["against"], f["where"]) == ("plane", "poses"))
        r_eq = (3 * 6 / (4 * math.pi))**(1 / 3)
        self.assert_close(factors["modulus"], 1 / (6 * math.sqrt(0.5 / r_eq)), 1e-6, "modulus")
        asked = math.exp(-math.pi * math.sqrt(B2 / 6 / (1 - B2 / 6)))
        self.assert_close(factors["restitution"], asked, 1e-6, "restitution")
        self.assert_close(factors["softest"], 1 / 6, 1e-6, "softest")
        self.assert_close(factors["bounciest"], asked, 1e-6, "bounciest")
        self.assertRegex(self.mskit("contact", *args, "--factors", "--poses", "50").out,
                         r"plane +poses +0\.001 +0\.2\d+ +0\.75\d +0\.1667 +0\.75")
        self.assertIn("leave out --csv", self.mskit("contact", *args, "--factors", "--csv", code=2).err)

    def test_factors_of_soft_contacts(self):
        """Where the mean contact is damped less than one, no restitution damps it like one that hardly rebounds."""
        self.write("two.csv", "x,y,z,r\n0,0,0,1\n3,0,0,0.01\n")
        found = self.contact("two.csv", "--factors", "--restitution", "1e-6")
        random = next(f for f in found["factors"] if (f["against"], f["where"]) == ("plane", "random"))
        self.assertEqual((random["restitution"], random["bounciest"]), (0, 0))

    def test_second_particle(self):
        """Face on face the six lie on at most their like, and on two each where they stand between four."""
        row = self.row(self.contact("six.csv", "--target", "box.obj", "--overlap", "0.001"), "particle", "poses")
        self.assertEqual(row["orientations"], 50)
        self.assertAlmostEqual(sum(part for _, part in row["counts"]), 1)
        self.assertAlmostEqual(sum(n * part for n, part in row["counts"]), row["contacts"])
        self.assertLessEqual(row["contacts_most"], 12)

    def test_sled(self):
        found = self.contact("six.csv", "--target", "box.obj", "--overlap", "0.0001,0.001")
        sled = found["sled"]
        self.assertIn(sled["pose"], (0, 1))
        self.assertEqual([(d["friction"], d["overlap"]) for d in sled["drags"]],
                         [(0, 0.0001), (0.3, 0.0001), (0, 0.001), (0.3, 0.001)])
        for drag in sled["drags"]:
            # Between four spheres that touch their neighbours the next one leans by 45 degrees at most.
            self.assertLess(drag["slope_most"], (drag["friction"] + 1) / (1 - drag["friction"]) + 0.01)
            self.assertGreater(drag["most"], drag["friction"] + 0.1)
            self.assertEqual((drag["missed"], drag["jammed"]), (0, 0))

    def test_shape_and_support(self):
        found = self.contact("six.csv", "--target", "box.obj", "--overlap", "0.001")
        self.assert_close(found["shape"]["mean_width"], 3, 1e-3, "(a + b + c) / 2 of a cuboid")
        lower = {1.5: (0.5, 1), 1: (0.5, 1.5), 0.5: (1, 1.5)}  # of an edge: half the diagonal across it
        for pose in found["shape"]["poses"]:
            height = round(pose["height"] * found["r_eq"], 9)
            barrier = min(math.hypot(height, other) - height for other in lower[height])
            self.assert_close(pose["barrier"] * found["r_eq"], barrier, 2e-3, "barrier, good to the lattice")
        # Each corner is a ball of 1/2 there: h differs by (|x| + |y| + |z| - 1) / 2, whose square has this mean.
        self.assert_close(found["support_rms"], math.sqrt((2 + 4 / math.pi - 3) / 4), 2e-3, "rms")

    def test_envelope(self):
        """Of two balls that touch, between them a neck in closed form; of a box, itself."""
        self.write("two.csv", "x,y,z,r\n0.5,1,0.5,0.5\n1.5,1,0.5,0.5\n")
        args = ("two.csv", "--target", "box.obj", "--overlap", "0.01", "--poses", "5", "--envelope")
        r_eq = (3 * 6 / (4 * math.pi))**(1 / 3)
        radius = 0.5 / r_eq
        row, = self.mskit("contact", *args, repr(radius), "--json").json["envelopes"]
        # The centre on a ring of radius root(3)/2; the balls touch at 1/4 from the middle.
        ring = math.sqrt(3) / 2
        wide = (ring**2 + 0.25) / 4 - ring * (0.25 * ring / 2 + 0.25 * math.pi / 6) - 0.25**3 / 3
        neck = 2 * math.pi * (wide - (0.25**2 / 2 - 0.25**3 / 3))
        self.assert_close(row["radius"], radius, 1e-12)
        self.assert_close(row["clump_volume"] * 6, math.pi / 3, 1e-9)
        self.assertAlmostEqual(row["clump_envelope"] * 6, math.pi / 3 + neck, delta=1e-3)
        self.assert_close(row["clump_width"] * 2 * r_eq, 1.5, 1e-3, "that of a ball and half the distance")
        self.assert_close(row["shape_volume"], 1, 1e-12)
        self.assert_close(row["shape_envelope"], 1, 1e-9)
        self.assert_close(row["shape_width"] * 2 * r_eq, 3, 1e-3)
        table = list(csv.DictReader(io.StringIO(self.mskit("contact", *args, repr(radius), "--csv").out)))
        self.assertEqual(list(table[0]), list(row))
        for name, value in table[0].items():
            self.assert_close(float(value), row[name], 1e-6, name)
        alone = self.mskit("contact", "two.csv", "--overlap", "0.01", "--poses", "5", "--envelope", "0.1,1")
        self.assertEqual(len(re.findall(r"(?m)^  clump    .*e-", alone.out)), 2)
        self.assertIn("parts of r_eq", self.mskit("contact", *args, "0", code=2).err)

    def test_envelope_of_a_volume_refused(self):
        self.write("v.npy", npy([0] * 21 + [1] + [0] * 42, (4, 4, 4)))
        self.write("one.csv", "x,y,z,r\n1,1,1,0.5\n")
        self.assert_refused("contact", "one.csv", "--target", "v.npy", "--envelope", "0.5", code=1,
                            says=("takes a mesh",))

    def test_one_ball(self):
        self.write("ball.csv", "x,y,z,r\n1,2,3,0.7\n")
        found = self.contact("ball.csv", "--overlap", "0.01")
        for row in found["contacts"]:
            self.assertEqual((row["contacts"], row["contacts_most"], row["missed"]), (1, 1, 0))
            self.assert_close(row["stiffness"], 1, 1e-3, "stiffness; the radius is counted on voxels")
            self.assert_close(row["restitution"], 0.5, 1e-9, "restitution")
        self.assertIsNone(found["clump"]["poses"][0]["barrier"])
        self.assertNotIn("shape", found)
        self.assertIsNone(found["target"])

    def test_missed(self):
        """Two balls far from each other: others pass between them, and are left out."""
        self.write("apart.csv", "x,y,z,r\n-5,0,0,0.5\n5,0,0,0.5\n")
        row = self.row(self.contact("apart.csv", "--overlap", "0.001"), "particle", "random")
        self.assertEqual(row["counts"], [[0, row["missed"]], [1, row["counts"][1][1]]])
        self.assertGreater(row["missed"], 0.3)
        self.assertAlmostEqual(row["missed"] + row["counts"][1][1], 1)
        self.assertEqual((row["contacts"], row["contacts_median"]), (1, 1))
        self.assert_close(row["restitution"], 0.5, 1e-9, "restitution")
        self.assertIn("pass without touching", self.mskit("contact", "apart.csv", "--poses", "50").out)

    def test_too_small_to_touch(self):
        """Two spheres of less than the overlap together never have it: nothing is known, and no part is above 1."""
        self.write("dust.csv", "x,y,z,r\n1,1,0.5,0.001\n2,1,0.5,0.001\n")
        args = ("dust.csv", "--target", "box.obj", "--overlap", "0.1")
        found = self.contact(*args)
        for where in ("random", "poses"):
            row = self.row(found, "particle", where)
            self.assertEqual((row["missed"], row["counts"], row["contacts_most"]), (1, [[0, 1]], 0))
            self.assertIsNone(row["contacts"])
        for drag in found["sled"]["drags"]:
            self.assertEqual((drag["missed"], drag["jammed"], drag["mean"], drag["most"]), (1, 0, None, None))
        table = self.mskit("contact", *args, "--poses", "50").out
        self.assertIn("all pass without touching", table)
        self.assertNotIn("nan", table)

    def test_carriers_touch_nothing(self):
        """A clump with masses knows its centre and volume; its carriers change no contact."""
        self.mskit("correct", "six.csv", "--target", "box.obj", "--density", "2000", "-o", "plain.json")
        self.mskit("correct", "six.csv", "--target", "box.obj", "--density", "2000", "--carriers", "-o", "carried.json")
        self.assertIn(b'"carriers"', self.read("carried.json"))
        plain, carried, targeted = (self.contact(*args, "--overlap", "0.002") for args in (
            ("plain.json",), ("carried.json",), ("six.csv", "--target", "box.obj")))
        self.assertEqual(plain["contacts"], carried["contacts"])
        self.assert_close(plain["r_eq"], targeted["r_eq"], 1e-12, "r_eq")
        self.assertEqual(plain["spheres"], carried["spheres"])

    def test_csv_table_and_threads(self):
        args = ("contact", "six.csv", "--target", "box.obj", "--poses", "40", "--overlap", "0.001,0.01")
        found = self.mskit(*args, "--json", "-j", "1")
        self.assertEqual(found.out, self.mskit(*args, "--json", "-j", "3").out)
        rows = list(csv.DictReader(io.StringIO(self.mskit(*args, "--csv").out)))
        self.assertEqual(len(rows), 8)
        for row, other in zip(rows, found.json["contacts"]):
            for name in ("orientations", "contacts_median", "contacts_most"):
                self.assertIsInstance(other[name], int)
            self.assertEqual(set(row) | {"counts"}, set(other))
            for name, value in row.items():
                self.assertEqual(value if name in ("against", "where") else float(value), other[name])
        self.assertNotEqual(found.out, self.mskit(*args, "--json", "--seed", "2").out)
        table = self.mskit(*args).out
        for word in ("spheres at once", "mean width", "barrier", "shape"):
            self.assertIn(word, table)

    def test_volume(self):
        """The box as voxels: the same centre, within a voxel the same support."""
        inside = [1] * 1000
        self.write("cube.npy", npy(inside, (10, 10, 10)))
        self.write("one.csv", "x,y,z,r\n5,5,5,5\n")
        found = self.contact("one.csv", "--target", "cube.npy", "--overlap", "0.001")
        self.assert_close(found["r_eq"], (3000 / (4 * math.pi))**(1 / 3), 1e-9, "r_eq")
        self.assertEqual(len(found["shape"]["poses"]), 6)
        for pose in found["shape"]["poses"]:
            self.assert_close(pose["height"] * found["r_eq"], 5, 1e-9, "height")

    def test_refused(self):
        self.write("open.obj", box_obj((0, 0, 0), (3, 2, 1), skip=1))
        self.write("bad.csv", "x,y,z,r\n1,2,3\n")
        box = ("--target", "box.obj")
        for name, unit in (("metres", 1e-3), ("micrometres", 1e3), ("beyond", 1e200)):  # of a shape in millimetres
            self.write(name + ".csv", f"x,y,z,r\n1.5,1,0.5,{unit}\n{1.5 + unit},1,0.5,{unit}\n")
        for name, r in (("vast", 1e150), ("tiny", 1e-150)):
            self.write(name + ".csv", f"x,y,z,r\n0,0,0,{r}\n{r},0,0,{r}\n")
        for args, code, says in (
                ((), 2, ("one clump file",)), (("six.csv", "six.csv"), 2, ("one clump file",)),
                (("six.csv", "--overlap", "0.5"), 2, ("--overlap", "0.1")),
                (("six.csv", "--overlap", "0.01,"), 2, ("--overlap",)),
                (("six.csv", "--overlap", ",".join(["0.01"] * 17)), 2, ("16",)),
                (("six.csv", "--poses", "0"), 2, ("poses",)), (("six.csv", "--poses", "2.5"), 2, ("poses",)),
                (("six.csv", "--restitution", "0"), 2, ("restitution",)),
                (("six.csv", "--restitution", "1.5"), 2, ("restitution",)),
                (("six.csv", "--seed", "-1"), 2, ("seed",)), (("six.csv", "--json", "--csv"), 2, ("--csv",)),
                (("six.csv", "--weld", "0"), 2, ("--weld", "--target")), (("-", "--target", "-"), 2, ("-",)),
                (("none.csv", *box), 1, ("none.csv",)), (("bad.csv", *box), 1, ("bad.csv", "2")),
                (("metres.csv", *box), 1, ("metres.csv", "units")), (("beyond.csv", *box), 1, ("beyond.csv", "units")),
                (("micrometres.csv", *box), 1, ("micrometres.csv", "units")),
                (("six.csv", "--target", "none.obj"), 1, ("none.obj",)),
                (("vast.csv",), 1, ("spheres over 3e+150 of length", "give lengths in a unit")),
                (("tiny.csv",), 1, ("spheres over 3e-150 of length", "give lengths in a unit")),
                (("six.csv", "--target", "open.obj"), 1, ("open.obj", "not closed"))):
            with self.subTest(args=args):
                self.assert_refused("contact", *args, code=code, says=says)
