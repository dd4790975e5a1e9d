"""Masses and templates: mskit correct, convert and generate --correct. Sums are made again here."""
import json
import math
import os

from support import Case, box_obj, npy, shared_file

DENSITY = 2650
GRID = ("--cells", "20")


def sums(rows, scale):
    """Mass, centre and inertia of solid spheres x, y, z, r, mass."""
    mass = sum(row[4] for row in rows)
    centre = [sum(row[4] * row[k] for row in rows) / mass for k in range(3)]
    inertia = [[0.0] * 3 for _ in range(3)]
    for *place, r, m in (row[:5] for row in rows):
        p = [scale * (x - c) for x, c in zip(place, centre)]
        for i in range(3):
            inertia[i][i] += m * (sum(x * x for x in p) + 0.4 * (scale * r) ** 2)
            for j in range(3):
                inertia[i][j] -= m * p[i] * p[j]
    return mass, centre, inertia


class Correct(Case):
    def setUp(self):
        super().setUp()
        self.write("box.obj", box_obj((1, 1, 1), (4, 3, 2)))
        self.mskit("generate", "box.obj", "-g", "setcover", *GRID, "-n", "60", "-o", "c.csv")

    def rows(self, name):
        lines = self.read(name).decode().split("\n")
        self.assertEqual(lines[0], "x,y,z,r,mass,density")
        return [[float(word) for word in line.split(",")] for line in lines[1:] if line]

    def test_the_sums_are_those_of_the_box(self):
        """In millimetres: 6 mm^3; the inertia of a box is m (b^2 + c^2) / 12."""
        flags = ("--density", DENSITY, "--unit", "mm", "--centre-tolerance", 0)
        self.mskit("correct", "c.csv", "--target", "box.obj", *flags, "-o", "d.csv")
        rows = self.rows("d.csv")
        mass, centre, inertia = sums(rows, 1e-3)
        truth = 6e-9 * DENSITY
        self.assert_close(mass, truth, 1e-12)
        for k, middle in enumerate((2.5, 2, 1.5)):
            self.assert_close(centre[k], middle, 1e-9)
        report = self.mskit("correct", "c.csv", "--target", "box.obj", *flags, "--json").json
        moments = [truth * square * 1e-6 / 12 for square in (5, 10, 13)]
        for k, moment in enumerate(moments):
            self.assert_close(report["particle"]["principal_moments"][k], moment, 1e-12)
            self.assertLessEqual(abs(inertia[k][k] / moment - 1), report["masses"]["epsilon"] + 1e-9)
            self.assert_close(report["masses"]["error_moments"][k], inertia[k][k] / moment - 1, 1e-9)
        for row in rows:
            self.assert_close(row[5] * 4 / 3 * math.pi * (1e-3 * row[3]) ** 3, row[4], 1e-14)
            self.assertGreaterEqual(row[4], truth / 1000 * (1 - 1e-9))

    def test_centre_tolerance(self):
        """Two spheres on either side of the centre, too far out. The second's share m adds 3 m to the moment across
        and is 1/3 with the centre met; T radii of gyration, sqrt(14 / 12), take T sqrt(14 / 12) / (10 / 12) off it."""
        self.write("far.csv", "1.5,2,1.5,0.5\n4.5,2,1.5,0.5\n")
        for flags, tolerance in ((("--centre-tolerance", 0), 0), ((), 1e-7), (("--centre-tolerance", 0.02), 0.02)):
            run = self.mskit("correct", "far.csv", "--target", "box.obj", "--density", 1, *flags, "--json")
            masses = run.json["masses"]
            self.assertEqual(masses["centre_epsilon"], 0)
            self.assertLessEqual(abs(masses["error_centre"] - tolerance), 1e-10)
            epsilon = (0.1 + 2) / (10 / 12) - 1 - tolerance * math.sqrt(14 / 12) / (10 / 12)
            self.assertLessEqual(abs(masses["epsilon"] - epsilon), 1e-10)

    def test_carriers(self):
        """Two balls do not fill a box of 4 x 3 x 2: their masses alone do not, with carriers all ten sums are met, and
        the spheres that touch are as they were."""
        self.write("balls.csv", "".join(f"{x},{y},{z},1\n" for x in (2, 3, 4) for y in (2, 2.5) for z in (2,)))
        self.write("long.obj", box_obj((1, 1, 1), (5, 3.5, 3)))
        flags = ("balls.csv", "--target", "long.obj", "--density", DENSITY, "--unit", "mm")
        self.assertGreater(self.mskit("correct", *flags, "--json").json["masses"]["epsilon"], 0.01)
        run = self.mskit("correct", *flags, "--carriers", "-o", "c.csv", "-o", "c.json", "-o", "c.lammps")
        lines = self.read("c.csv").decode().split()
        self.assertEqual(lines[0], "x,y,z,r,mass,density,carrier")
        rows = [[float(word) for word in line.split(",")] for line in lines[1:]]
        carriers = [row for row in rows if row[6] == 1]
        self.assertEqual([row[6] for row in rows], [0] * 6 + [1] * len(carriers))
        self.assertIn(f"carriers                           {len(carriers)}\n", run.out)
        self.assertLessEqual(len(carriers), 8)
        mass, centre, inertia = sums(rows, 1e-3)
        self.assert_close(mass, 20e-9 * DENSITY, 1e-12)
        for i, middle in enumerate((3, 2.25, 2)):
            self.assert_close(centre[i], middle, 1e-9)
            moment = mass * (16 + 6.25 + 4 - (16, 6.25, 4)[i]) * 1e-6 / 12
            for j in range(3):
                self.assertLess(abs(inertia[i][j] - (moment if i == j else 0)), 1e-9 * moment)
        self.assertEqual(len(json.loads(self.read("c.json"))["carriers"]), len(carriers))
        self.assertIn("Walls know no types", self.read("c.lammps.in").decode())
        score = [self.mskit("score", name, "--target", "long.obj", *GRID).out.split("\n", 1)[1]
                 for name in ("balls.csv", "c.csv")]
        self.assertEqual(*score)
        self.mskit("convert", "c.json", "-o", "again.lammps")
        self.assertEqual(self.read("again.lammps"), self.read("c.lammps"))

    def test_carriers_refused(self):
        self.write("two.csv", "2.5,2,1.5,0.5\n2.6,2,1.5,0.5\n")
        flags = ("--target", "box.obj", "--density", "1", "-o", "d.csv")
        self.assert_refused("correct", "two.csv", *flags, "--carriers", code=1, says=("no carriers do",))
        self.assert_refused("correct", "two.csv", *flags, "--carrier-depth", "0.1", code=2, says=("takes --carriers",))
        self.assert_refused("correct", "two.csv", *flags, "--carriers", "--carrier-depth", "0", code=2,
                            says=("carrier-depth",))
        self.write("mixed.csv", "x,y,z,r,mass,density,carrier\n0,0,0,1,1,1,0\n0,0,0,0.1,1,1,1\n0,0,1,1,1,1,0\n")
        self.assert_refused("convert", "mixed.csv", "-o", "e.json", code=1, says=("behind all spheres",))

    def test_equal_volume(self):
        """One ball for a box of 6 mm^3; the scores are those of the scaled clump, and so are the masses."""
        radius = (6 * 3 / (4 * math.pi)) ** (1 / 3)
        self.write("ball.csv", "2.5,2,1.5,0.5\n")
        flags = ("--target", "box.obj", "--equal-volume")
        run = self.mskit("correct", "ball.csv", *flags, "--density", 1, "-o", "d.csv")
        self.assertIn(f"equal volume                       scaled by {2 * radius:.6g}; volume of the union 6,", run.out)
        self.assertIn(f"mean width of the clump            {2 * radius:.6g}", run.out)
        self.assert_close(self.rows("d.csv")[0][3], radius, 1e-12)
        run = self.mskit("generate", "box.obj", "-g", "mss", *GRID, "-n", 10, "--equal-volume", "--json", "-o", "e.csv")
        done = run.json["equal_volume"]
        self.assert_close(done["volume"], 6, 1e-12)
        self.assertGreater(done["scale"], 1)
        score = self.mskit("score", "e.csv", "--target", "box.obj", *GRID, "--json").json
        self.assertEqual(score["scores"]["dice"], run.json["scores"]["dice"])

    def test_equal_volume_by_far_is_said(self):
        """A tenth of the length, and not a ball that holds most of the volume."""
        for radius, far in ((0.5, True), (1.1, False)):
            self.write("ball.csv", f"2.5,2,1.5,{radius}\n")
            run = self.mskit("correct", "ball.csv", "--target", "box.obj", "--equal-volume", "--density", 1,
                             "-o", "d.csv")
            said = f"ball.csv: the spheres held {100 * 4 / 3 * math.pi * radius ** 3 / 6:.3g} % of the shape's volume"
            self.assertEqual(said in run.err, far)
        bowl = self.shape("bowl", "fineness=12")
        run = self.mskit("generate", bowl, "-g", "mss", "--cells", 20, "-n", 5, "--equal-volume", "-o", "e.csv")
        self.assert_says(run, "they lie beside it; take more spheres")
        coarse = ("-g", "mss", "--cells", 20, "--equal-volume")
        said = run.err[run.err.index("the spheres held"):run.err.index("(variational)")]
        run = self.mskit("grains", bowl, *coarse, "-n", 5, "-o", "g")
        self.assertIn(said, self.read("g/grains.csv").decode())
        scene = self.mskit("scene", bowl, *coarse, "--max-spheres", 5, "--budget", 5, "--particles", 1)
        self.assertRegex(scene.err, r"bowl\.stl: the spheres held [0-9.]+ % of the shape's volume; scaled by")

    def test_equal_volume_is_held(self):
        """variational leaves little to scale, unless it is told not to hold it."""
        scale = {}
        for hold in (True, False):
            flags = () if hold else ("--set", "hold-volume=0")
            run = self.mskit("generate", "box.obj", *GRID, "-n", 5, "--equal-volume", *flags, "--json",
                             "-o", "e.csv").json
            self.assertEqual(run["options"]["hold-volume"], "on" if hold else "off")
            self.assert_close(run["equal_volume"]["volume"], 6, 1e-12)
            scale[hold] = run["equal_volume"]["scale"]
        self.assertLess(abs(scale[True] - 1), 1e-3)
        self.assertGreater(abs(scale[False] - 1), 5e-3)

    def test_equal_volume_that_cannot_be_held_is_said(self):
        """Balls whose least D on a plate takes far more than its volume."""
        plate = self.shape("plate")
        run = self.mskit("generate", plate, "-n", 3, "--cells", 6, "--equal-volume", "--json", "-o", "e.csv")
        self.assert_says(run, "the fit leaves 3 spheres with 1.1", "left to scaling")
        self.assert_close(run.json["equal_volume"]["volume"], 5 * 5 * 0.1, 1e-6)

    def test_equal_volume_refused(self):
        self.assert_refused("correct", "c.csv", "--properties", "union", "--density", 1, "--equal-volume",
                            "-o", "d.csv", code=2, says=("--equal-volume",))
        self.assert_refused("generate", "box.obj", "--equal-volume", "-n", 5, "--curve", "d.csv", code=2,
                            says=("--equal-volume",))

    def test_units(self):
        mass = {}
        for flags in (("--unit", "um"), ("--scale", "1e-6"), ("--unit", "m"), ()):
            mass[flags] = self.mskit("correct", "c.csv", "--target", "box.obj", "--density", "1", *flags,
                                     "--json").json["particle"]["mass"]
        self.assert_close(mass[("--unit", "um")], 6e-18, 1e-12)
        self.assertEqual(mass[("--unit", "um")], mass[("--scale", "1e-6")])
        self.assertEqual(mass[()], mass[("--unit", "m")])
        self.assert_close(mass[()], 6, 1e-12)

    def test_union(self):
        """Two balls that do not touch are their own union."""
        self.write("two.csv", "0,0,0,1\n3,0,0,1\n")
        report = self.mskit("correct", "two.csv", "--properties", "union", "--density", "3", "--json").json
        self.assert_close(report["particle"]["mass"], 8 * math.pi, 1e-3)
        self.assert_close(report["masses"]["least"], report["masses"]["most"], 1e-3)

    def test_volume(self):
        self.write("scan.npy", npy([7] * 1000, (10, 10, 10)))
        self.mskit("generate", "scan.npy", "-g", "setcover", "-n", "40", "-o", "v.csv")
        report = self.mskit("correct", "v.csv", "--target", "scan.npy", "--density", "2", "--json").json
        self.assert_close(report["particle"]["mass"], 2000, 1e-12)
        self.assert_close(report["particle"]["principal_moments"][0], 2000 * 200 / 12, 1e-12)

    def test_generate_and_correct_are_one(self):
        mass = ("--density", DENSITY, "--unit", "mm")
        self.mskit("generate", "box.obj", "-g", "setcover", *GRID, "-n", "60", "--correct", *mass, "-o", "a.csv",
                   "-o", "a.json")
        self.mskit("correct", "c.csv", "--target", "box.obj", *mass, "-o", "b.csv")
        self.assertEqual(self.read("a.csv"), self.read("b.csv"))
        record = json.loads(self.read("a.json"))
        self.assertEqual(record["columns"], ["x", "y", "z", "r", "mass", "density"])
        self.assertIn("epsilon", record["masses"])
        self.assertIn("scores", record)

    def test_all_formats(self):
        self.mskit("correct", "c.csv", "--target", "box.obj", "--density", DENSITY, "--unit", "mm",
                   "--all-formats", "out")
        names = sorted(os.listdir(self.path("out")))
        endings = "clu csv deme frame.json json lammps lammps.in liggghts liggghts.in mercury mfix pfc vtk yade yade.py"
        self.assertEqual(names, ["c." + ending for ending in endings.split()])

    def test_formats_are_repeatable(self):
        self.mskit("generate", "box.obj", *GRID, "-n", "30", "--correct", "--density", "1", "--format", "liggghts",
                   "--format", "csv")
        self.assertEqual([n for n in self.files() if n.startswith("box-variational")],
                         ["box-variational" + ending
                          for ending in (".csv", ".frame.json", ".liggghts", ".liggghts.in")])

    def test_there_and_back(self):
        """A template with its frame gives the spheres of the shape again."""
        self.mskit("correct", "c.csv", "--target", "box.obj", "--density", DENSITY, "--unit", "mm", "-o", "d.json")
        self.mskit("convert", "d.json", "-o", "t.liggghts", "-o", "t.lammps", "-o", "t.yade")
        before = self.spheres("c.csv")
        for name in ("t.liggghts", "t.lammps", "t.yade"):
            self.mskit("convert", name, "--frame", "t.frame.json", "-o", "back.csv")
            after = [line.split(",")[:4] for line in self.read("back.csv").decode().split("\n")[1:] if line]
            self.assertEqual(len(after), len(before))
            for one, other in zip(before, after):
                self.assertLess(math.dist(one, [float(word) for word in other]), 1e-14, name)
        self.mskit("convert", "d.json", "-o", "e.csv", "-o", "e.json")
        self.mskit("convert", "e.csv", "--unit", "mm", "-o", "f.csv")
        self.assertEqual(self.read("e.csv"), self.read("f.csv"))
        self.assertEqual(json.loads(self.read("e.json"))["particle"], json.loads(self.read("d.json"))["particle"])

    def test_csv_with_masses_makes_templates(self):
        """The particle is then the sum of the spheres."""
        self.mskit("correct", "c.csv", "--target", "box.obj", "--density", DENSITY, "--unit", "mm", "-o", "d.csv")
        self.assert_refused("convert", "d.csv", "-o", "t.lammps", code=1, says=("needs the mass",))
        self.mskit("convert", "d.csv", "--unit", "mm", "--density", DENSITY, "-o", "t.lammps")
        self.assert_close(float(self.read("t.lammps").decode().split("\n")[3].split()[0]), 6e-9 * DENSITY, 1e-12)

    def test_a_missed_centre_is_a_number(self):
        """The centre is 0.3 above a plane of four spheres; radius of gyration of the box: sqrt(14 / 12)."""
        self.write("flat.csv", "2,2,1.2,0.1\n3,2,1.2,0.1\n2,2.5,1.2,0.1\n3,1.5,1.2,0.1\n")
        run = self.mskit("correct", "flat.csv", "--target", "box.obj", "--density", "1", "-o", "d.csv", "-o",
                         "d.lammps", "--json")
        self.assert_close(run.json["masses"]["centre_epsilon"], 0.3 / math.sqrt(14 / 12), 1e-9)
        self.assertTrue(run.json["masses"]["optimal"])
        self.assert_close(sums(self.rows("d.csv"), 1)[1][2], 1.2, 1e-12)
        self.assert_close(run.json["particle"]["centre"][2], 1.5, 1e-12)  # the particle keeps its own
        words = self.mskit("correct", "flat.csv", "--target", "box.obj", "--density", "1", "-o", "e.csv").out
        self.assertIn("the least is 0.278 along an axis", words)

    def test_few_spheres_always_have_masses(self):
        """Their centre of mass is that of the shape but for what voxels and meshes are off."""
        for kind in ("ellipsoid", "torus", "cone", "grain"):
            shape = self.shape(kind)
            for method in ("mss", "variational"):
                for n in (1, 2, 3, 5):
                    name = f"{kind}-{method}-{n}"
                    with self.subTest(run=name):
                        run = self.generate(shape, "-g", method, "-n", n, "--cells", 15, "--correct", "--density", 2500,
                                            "-o", name + ".csv", "-o", name + ".lammps")
                        self.assertTrue(run["masses"]["optimal"])
                        self.assert_close(sums(self.rows(name + ".csv"), 1)[0], run["particle"]["mass"], 1e-9)
                        header = self.read(name + ".lammps").decode().split("\n")[3].split()
                        self.assertEqual(float(header[0]), run["particle"]["mass"])

    def test_a_dimer_in_single_precision(self):
        """Two balls of radius 1 mm that touch no third thing; the corners are right to 6e-8."""
        clump, mesh = shared_file("cases", "m01_dimer.csv"), shared_file("cases", "m01_dimer_float32.stl")
        run = self.mskit("correct", clump, "--target", mesh, "--density", "2500", "--unit", "mm", "-o", "m.lammps",
                         "-o", "m.csv", "--json").json
        self.assert_close(run["particle"]["mass"], 2.0795e-5, 1e-5)
        for found, truth in zip(run["particle"]["centre"], (0.75, 0.1, 0.2)):
            self.assertLess(abs(found - truth), 1e-7)
        for row in self.rows("m.csv"):
            self.assert_close(row[4], run["particle"]["mass"] / 2, 1e-6)

    def test_specks_in_all_formats(self):
        """What MFiX would sum of them vanishes; the templates have the mass of the body all the same."""
        for r, says in (("1e-9", "MFiX sums the spheres"), ("1e-90", "no mass or inertia")):
            self.write("specks.csv", f"x,y,z,r\n2,2,1.5,{r}\n3,2,1.5,{r}\n")
            run = self.mskit("correct", "specks.csv", "--target", "box.obj", "--density", "1000",
                             "--all-formats", "out" + r)
            self.assert_says(run, says)
            self.assertIn(b" mass 6000 ", self.read(f"out{r}/specks.liggghts.in"))

    def test_one_sphere_in_all_formats(self):
        """LIGGGHTS gets a second one in it, which is gone when it is read back."""
        self.write("one.csv", "0,0,0,1\n")
        ball = self.shape("ball")
        run = self.mskit("correct", "one.csv", "--target", ball, "--density", "1000", "--all-formats", "out")
        self.assertNotIn("MFiX", run.err)  # whose sum is right to 0.05 %
        endings = ("clu csv deme frame.json json lammps lammps.in liggghts liggghts.in mercury mfix pfc vtk yade "
                   "yade.py").split()
        self.assertEqual(sorted(os.listdir(self.path("out"))), ["one." + ending for ending in endings])
        self.generate(ball, "-n", "1", *GRID, "--correct", "--density", "1000", "--all-formats", "made")
        self.assertEqual(sorted(os.listdir(self.path("made"))), ["ball-variational." + ending for ending in endings])
        lines = self.read("out/one.liggghts").decode().splitlines()
        (outer, inner) = (list(map(float, line.split())) for line in lines)
        self.assertEqual(inner, outer[:3] + [outer[3] / 2])
        self.assertIn(b" nspheres 2 ", self.read("out/one.liggghts.in"))
        self.mskit("convert", "out/one.liggghts", "--frame", "out/one.frame.json", "-o", "back.csv")
        (back,) = self.spheres("back.csv")
        for got, want in zip(back, (0, 0, 0, 1)):
            self.assertAlmostEqual(got, want, delta=1e-12)
        self.write("two.liggghts", "0 0 0 1\n0 0 0 0.4\n")  # no such pair
        self.mskit("convert", "two.liggghts", "-o", "two.csv")
        self.assertEqual(len(self.spheres("two.csv")), 2)

    def test_what_engines_sum_is_said(self):
        """Two balls of radius 1, centres 1 apart, share two caps of height 1/2: 1.1852 times the union."""
        self.write("two.csv", "0,0,0,1\n1,0,0,1\n")
        run = self.mskit("correct", "two.csv", "--properties", "union", "--density", "1", "-o", "a.mfix", "-o",
                         "a.yade")
        self.assert_says(run, "a.mfix: MFiX sums the spheres", "mass +19 %")
        self.assertNotIn("a.yade:", run.err)
        self.write("half.csv", "0,0,0,0.5\n")  # a quarter of the moments, at the same mass
        run = self.mskit("correct", "half.csv", "--target", self.shape("ball"), "--density", "1", "-o", "h.json", "-o",
                         "h.lammps")
        self.assert_says(run, "h.lammps: LAMMPS sums the spheres", "moments of inertia up to -75 %")
        run = self.mskit("convert", "h.json", "-o", "i.lammps", "-o", "i.mfix")
        self.assert_says(run, "i.lammps: LAMMPS", "up to -75 %", "i.mfix: MFiX", "mass -87 %")

    def test_products_of_a_molecule_may_be_rounding(self):
        self.mskit("correct", "c.csv", "--target", "box.obj", "--density", DENSITY, "-o", "t.lammps")
        text = self.read("t.lammps").decode()
        moment = float(text.split("\n")[5].split()[0])
        for part, code in ((1e-12, 0), (1e-3, 1)):
            self.write("u.lammps", text.replace(" 0 0 0 inertia", f" 0 {part * moment!r} 0 inertia"))
            run = self.mskit("convert", "u.lammps", "-o", "u.csv", code=code)
        self.assert_says(run, "has products")

    def test_what_cannot_be(self):
        target = ("--target", "box.obj", "--density", "1")
        self.assert_refused("correct", "c.csv", *target, "--least-mass", "0.5", "-o", "e.csv", code=1, says=("eq. 5",))
        self.assert_refused("correct", "c.csv", *target, "-o", "c.csv", code=1, says=("is the input itself",))
        self.assert_refused("correct", "c.csv", "--target", "missing.stl", "--density", "1", "-o", "e.csv", code=1,
                            says=("missing.stl",))
        self.assert_refused("convert", "c.csv", "-o", "t.liggghts", code=1, says=("mskit correct",))
        self.assert_refused("convert", "c.csv", "-o", "e.csv", "--density", "5", code=1, says=("c.csv has no masses",))
        self.assert_refused("convert", "c.csv", "--frame", "c.csv", "-o", "e.csv", code=1, says=("no JSON",))

    def test_wrong_usage(self):
        whole = ("correct", "c.csv", "--target", "box.obj", "--density", "1")
        union = ("correct", "c.csv", "--properties", "union", "--density", "1", "-o", "d.csv")
        for args, says in (
                (("correct", "c.csv", "-o", "d.csv", "--density", "1"), "--target SHAPE or --properties union"),
                (("correct", "c.csv", "-o", "d.csv", "--target", "box.obj"), "--density"),
                (whole, "-o FILE"),
                ((*whole, "--density", "0", "-o", "d.csv"), "--density '0'"),
                ((*whole, "--unit", "ft", "-o", "d.csv"), "'ft'"),
                ((*whole, "--unit", "m", "--scale", "1", "-o", "d.csv"), "exclude"),
                ((*whole, "--axes", "x", "-o", "d.csv"), "principal, input"),
                ((*union, "--weld", "0.1"), "--weld is of a shape"),
                ((*union, "--label", "2"), "--label is of a shape"),
                ((*union, "--cells", "20"), "--cells is of a shape"),
                ((*whole, "--format", "csv", "--format", "csv"), "twice"),
                (("convert", "c.csv"), "-o FILE"),
                (("convert", "c.csv", "-o", "a.xyz"), "names no format"),
                (("convert", "c.csv", "-o", "a.csv", "--unit", "ft"), "'ft'"),
                (("generate", "box.obj", "--correct"), "--density"),
                (("generate", "box.obj", "--density", "1"), "--correct"),
                (("generate", "box.obj", "-o", "a.liggghts"), "--correct --density"),
                (("generate", "box.obj", "--format", "csv", "--format", "vtk", "-o", "a.csv"), "once")):
            with self.subTest(args=args):
                self.assert_refused(*args, code=2, says=(says,))
