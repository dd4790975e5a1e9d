"""mskit scene: as many spheres as a scene needs, against all choices there are; manifests that are wrong."""
import itertools
import json
import os
import re

from support import Case, box_obj

GRID = ("--cells", "20", "-j", "1")
QUICK = (*GRID, "-g", "mss")


class Scene(Case):
    """A scene of a cuboid, a grain and a tablet, of different numbers."""

    COUNTS = {"box.obj": 7, "grain.stl": 30, "tablet.stl": 12}

    def setUp(self):
        super().setUp()
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))
        self.shape("grain", "fineness=8")
        self.shape("tablet", "fineness=12")
        self.manifest()

    def manifest(self, rows=None, header="shape,count", name="scene.csv"):
        rows = [f"{shape},{count}" for shape, count in self.COUNTS.items()] if rows is None else rows
        return self.write(name, "\n".join([header, *rows]) + "\n")

    def scene(self, *args, source="scene.csv"):
        return self.mskit("scene", source, "--json", *args).json

    def templates(self, scene):
        """Number of spheres of each template."""
        return [shape["scores"]["spheres"] for shape in scene["shapes"]]

    def sums(self, scene, numbers):
        """Spheres in the scene and mean D of any choice of templates, from the curves."""
        pairs = [(shape["particles"], n, shape["curve"][n - 1]) for shape, n in zip(scene["shapes"], numbers)]
        particles = sum(count for count, _, _ in pairs)
        return sum(c * n for c, n, _ in pairs), sum(c * d for c, _, d in pairs) / particles

    def choices(self, scene):
        """All choices of templates: (spheres, mean D)."""
        return [self.sums(scene, numbers)
                for numbers in itertools.product(*(range(1, len(s["curve"]) + 1) for s in scene["shapes"]))]

    def check_sums(self, scene):
        spheres, mean = self.sums(scene, self.templates(scene))
        self.assertEqual(scene["spheres"], spheres)
        self.assertEqual(scene["particles"], sum(s["particles"] for s in scene["shapes"]))
        self.assert_close(scene["mean_dice"], mean, 1e-12, "mean D")
        for shape in scene["shapes"]:
            n = shape["scores"]["spheres"]
            self.assertEqual(shape["scores"]["dice"], shape["curve"][n - 1])
            if n > 1:
                self.assert_close(shape["gain"], shape["curve"][n - 2] - shape["curve"][n - 1], 1e-12, "gain")
        back = [(curve[m - 1] - curve[n - 1]) / (n - m)
                for curve, n in zip((s["curve"] for s in scene["shapes"]), self.templates(scene)) for m in range(1, n)]
        self.assert_close(scene["least_gain"], min(back, default=0), 1e-12, "least useful sphere")
        even = scene["even"]
        each, part = int(even["each"]), even["each"] % 1
        (few, mean), (more, further) = (self.sums(scene, [min(n, len(s["curve"])) for s in scene["shapes"]])
                                        for n in (each, each + 1))
        self.assert_close(few + part * (more - few), even["spheres"], 1e-12, "spheres, spread evenly")
        self.assert_close(even["mean_dice"], mean + part * (further - mean), 1e-12, "mean D, spread evenly")
        if more > few:  # not all at the ends of their curves
            self.assertEqual(even["spheres"], scene["spheres"])


class Choice(Scene):
    """Which templates are chosen, against all choices."""

    MOST = ("--max-spheres", "12")

    def test_budget(self):
        for budget in (49, 60, 111, 150, 200, 333, 588, 10000):
            with self.subTest(budget=budget):
                scene = self.scene(*QUICK, *self.MOST, "--budget", budget)
                self.check_sums(scene)
                self.assertEqual(scene["goal"], {"budget": budget})
                self.assertLessEqual(scene["spheres"], budget)
                best = min(mean for spheres, mean in self.choices(scene) if spheres <= budget)
                self.assertAlmostEqual(scene["mean_dice"], best, delta=1e-11)
                self.assertEqual(scene["slack"], 0)

    def test_mean_tolerance(self):
        for value in (0.5, 0.2, 0.15, 0.12):
            with self.subTest(value=value):
                scene = self.scene(*QUICK, *self.MOST, "--mean-tolerance", f"dice={value}")
                self.check_sums(scene)
                self.assertLessEqual(scene["mean_dice"], value + 1e-12)
                fewest = min(spheres for spheres, mean in self.choices(scene) if mean <= value)
                self.assertEqual((scene["spheres"], scene["slack"]), (fewest, 0))

    def test_tolerance_takes_the_least_number(self):
        for measure, value, rises in (("dice", 0.2, False), ("eta", 0.3, False), ("coverage", 0.7, True),
                                      ("inertia", 0.4, False)):
            with self.subTest(measure=measure):
                scene = self.scene(*QUICK, "--max-spheres", "40", "--tolerance", f"{measure}={value}", "-o", "out")
                self.check_sums(scene)
                self.assertEqual(scene["goal"], {"tolerance": value, "measure": measure})
                self.assertIsNone(scene["slack"])
                for shape in scene["shapes"]:
                    reached = shape["scores"][measure]
                    self.assertTrue(reached >= value if rises else reached <= value, f"{measure} {reached}")
                    before = self.before(shape, measure)
                    self.assertFalse(before >= value if rises else before <= value, f"{measure} {before} before")

    def test_tolerance_is_searched_where_each_number_is_a_run(self):
        """Few numbers are run; the one that is chosen reaches the tolerance, one sphere less was run and does not."""
        for value in (0.3, 0.12, 0.05):
            scene = self.scene(*GRID, "-g", "variational", "--max-spheres", "60", "--tolerance", f"dice={value}",
                               "-o", "out")
            self.assertIsNone(scene["even"])
            for shape in scene["shapes"]:
                run = [n for n, dice in enumerate(shape["curve"], 1) if dice is not None]
                chosen = shape["curve"].index(shape["scores"]["dice"]) + 1
                self.assertLessEqual(len(run), 12)
                self.assertLessEqual(shape["scores"]["dice"], value)
                if chosen > 1:
                    self.assertIn(chosen - 1, run)
                    self.assertGreater(shape["curve"][chosen - 2], value)
        self.assert_refused("scene", "scene.csv", *GRID, "-g", "variational", "--max-spheres", "3", "--tolerance",
                            "dice=0.001", code=1, says=("3 spheres", "dice 0.001"))

    def before(self, shape, measure):
        """The measure of the template without its last sphere, by mskit score; MSS is nested."""
        path = shape["input"]["path"]
        spheres = self.spheres("out/" + path.rsplit(".", 1)[0] + ".csv")
        self.assertGreater(len(spheres), 1, "else the test tests nothing")
        self.write("fewer.csv", "".join("%r,%r,%r,%r\n" % s for s in spheres[:-1]))
        scores = self.mskit("score", "fewer.csv", "--target", path, "--json", *GRID).json["scores"]
        return scores["inertia_error"]["weighted_mean"] if measure == "inertia" else scores[measure]

    def test_a_template_has_its_remarks(self):
        """A bound that the template cannot hold is said of its number alone, whichever the first one run was."""
        for most, *goal in ((5, "--tolerance", "dice=0.5"), (5, "--mean-tolerance", "dice=0.5"), (5, "--budget", "3"),
                            (8, "--knee", "0.12")):
            with self.subTest(goal=goal):
                result = self.mskit("scene", "box.obj", *GRID, "-g", "variational", "--gap", "0.1", "--protrusion", "0",
                                    "--max-spheres", most, *goal, "--json")
                spheres = result.json["shapes"][0]["scores"]["spheres"]
                said = [int(n) for n in re.findall(r"gap=0.1 cannot be held by (\d+) spheres", result.err)]
                self.assertTrue(1 < spheres < most and said == [spheres], (spheres, said))

    def test_column_of_tolerances(self):
        self.manifest(["box.obj,2,0.3", "grain.stl,1,", " tablet.stl , 5 , 0.2 "], header="shape,count,tolerance")
        scene = self.scene(*QUICK, "--tolerance", "dice=0.15", "--max-spheres", "40")
        for shape, own, limit in zip(scene["shapes"], (0.3, None, 0.2), (0.3, 0.15, 0.2)):
            self.assertEqual(shape["tolerance"], own)
            n = shape["scores"]["spheres"]
            self.assertTrue(shape["curve"][n - 1] <= limit < min(shape["curve"][:n - 1]))
        self.manifest(["box.obj,2,0.3", "tablet.stl,5,0.2"], header="shape,count,tolerance")
        self.assertEqual(self.templates(self.scene(*QUICK)), [self.templates(scene)[0], self.templates(scene)[2]])

    def test_knee(self):
        """No further template takes away as much for each sphere; from every smaller one some does."""
        scene = self.scene(*QUICK, "--knee", "0.05", "--max-spheres", "40", source="grain.stl")
        self.assertEqual((scene["particles"], scene["goal"]), (1, {"knee": 0.05}))
        curve = scene["shapes"][0]["curve"]
        slope = [max((curve[a] - curve[b]) / (b - a) for b in range(a + 1, len(curve))) for a in range(len(curve) - 1)]
        knee = next(n + 1 for n, s in enumerate(slope) if s < 0.05 * curve[n])
        self.assertGreater(knee, 2)
        self.assertEqual(self.templates(scene), [knee])


class Templates(Scene):
    def test_scores_of_the_files_are_those_of_the_table(self):
        for generator in ("mss", "variational"):
            with self.subTest(generator=generator):
                scene = self.scene(*GRID, "-g", generator, "--budget", "250", "--max-spheres", "8", "-o", generator)
                self.check_sums(scene)
                self.assertEqual(self.files_of(generator), ["box.csv", "grain.csv", "tablet.csv"])
                for shape in scene["shapes"]:
                    path = shape["input"]["path"]
                    clump = generator + "/" + path.rsplit(".", 1)[0] + ".csv"
                    judged = self.mskit("score", clump, "--target", path, "--json", *GRID).json["scores"]
                    for key in ("spheres", "dice", "eta", "coverage", "overshoot", "off_volume"):
                        self.assertEqual(judged[key], shape["scores"][key], f"{key} of {clump}")
                    self.assert_close(judged["inertia_error"]["weighted_mean"], shape["scores"]["inertia"], 1e-9, clump)
                    radii = [s[3] for s in self.spheres(clump)]
                    self.assertEqual(min(radii), shape["smallest_radius"])
                smallest = min(scene["shapes"], key=lambda s: s["smallest_radius"])
                self.assertEqual(scene["smallest"],
                                 {"radius": smallest["smallest_radius"], "shape": smallest["input"]["path"]})

    def files_of(self, folder):
        return sorted(os.listdir(self.path(folder)))

    def test_formats(self):
        self.mskit("scene", "scene.csv", *QUICK, "--budget", "100", "--max-spheres", "4", "-o", "out", "--format",
                   "json")
        record = json.loads(self.read("out/grain.json"))
        self.assertEqual((record["generator"], record["max_spheres"], record["min_radius"]), ("mss", 4, None))
        self.assertEqual(record["input"]["path"], "grain.stl")
        self.assertEqual(len(record["spheres"]), record["scores"]["spheres"])

    def test_threads_make_no_difference(self):
        args = ("--cells", "20", "--budget", "250", "--max-spheres", "8", "-o")
        first = self.mskit("scene", "scene.csv", "--json", *args, "one", "-j", "1").out
        second = self.mskit("scene", "scene.csv", "--json", *args, "three", "-j", "3").out
        self.assertEqual(first, second)
        for name in self.files_of("one"):
            self.assertEqual(self.read("one/" + name), self.read("three/" + name))

    def test_least_radius(self):
        for generator in ("mss", "variational"):
            with self.subTest(generator=generator):
                args = (*GRID, "-g", generator, "--budget", "12", "--max-spheres", "12")
                least = 1.2 * self.scene(*args, source="grain.stl")["smallest"]["radius"]
                bound = self.scene(*args, "--min-radius", repr(least), "-o", "out", source="grain.stl")
                self.assertEqual(bound["min_radius"], least)
                self.assertGreaterEqual(bound["smallest"]["radius"], least)
                self.assertGreaterEqual(min(s[3] for s in self.spheres("out/grain.csv")), least)

    def test_paths_are_relative_to_the_manifest(self):
        os.mkdir(self.path("sub"))
        self.write("sub/m.csv", "# a scene\n\nshape,count\n../grain.stl,3\r\n" + self.path("box.obj") + ",2\n")
        scene = self.scene(*QUICK, "--budget", "20", source="sub/m.csv")
        self.assertEqual([s["input"]["path"] for s in scene["shapes"]], ["sub/../grain.stl", self.path("box.obj")])

    def test_table(self):
        out = self.mskit("scene", "scene.csv", *QUICK, "--budget", "250", "--max-spheres", "8", "-o", "out").out
        for word in ("a budget of 250 spheres", "grain.stl", "spread evenly", "by convention it limits the time step",
                     "wrote out/box.csv"):
            self.assertIn(word, out)


class Engines(Scene):
    """Masses and scripts; the engines themselves are in tests/engines."""

    SCENE = (*QUICK, "--budget", "250", "--max-spheres", "8", "--density", "2650", "--unit", "mm")

    def test_scripts_have_the_counts_of_the_manifest(self):
        out = self.mskit("scene", "scene.csv", *self.SCENE, "--format", "liggghts", "--format", "lammps",
                         "--format", "yade", "--format", "json", "-o", "out").out
        for name in ("scene.liggghts.in", "scene.lammps.in", "scene.yade.py"):
            self.assertIn("wrote out/" + name, out)
        liggghts, lammps, yade = (self.read("out/" + name).decode() for name in ("scene.liggghts.in", "scene.lammps.in",
                                                                                   "scene.yade.py"))
        counts = [self.COUNTS[name] for name in ("tablet.stl", "box.obj", "grain.stl")]  # the largest first
        self.assertEqual(re.findall(r"particles_in_region (\d+)", liggghts),
                         [str(n) for n in itertools.accumulate(counts)])
        self.assertEqual([int(n) for n in re.findall(r" deposit (\d+) ", lammps)], counts)
        self.assertEqual([int(n) for n in re.findall(r"(?m)^    \((\d+), ", yade)], counts)
        masses = [json.loads(self.read(f"out/{shape}.json"))["particle"]["mass"]
                  for shape in ("tablet", "box", "grain")]
        self.assert_close(masses[1], 2650 * 6e-9, 1e-12, "mass of the box")
        for mass, given in zip(masses, re.findall(r" mass (\d\S+) inertia", liggghts)):
            self.assert_close(float(given), mass, 1e-12, "mass")

    def test_equal_volume_is_judged_as_written(self):
        scene = self.scene(*self.SCENE, "--equal-volume", "-o", "out")
        self.check_sums(scene)
        for shape in scene["shapes"]:
            path = shape["input"]["path"]
            judged = self.mskit("score", "out/" + path[:-4] + ".csv", "--target", path, "--json", *GRID).json["scores"]
            self.assertEqual(judged["dice"], shape["scores"]["dice"])
            self.assert_close(judged["off_volume"], 1, 0.02, "volume on the grid")

    def test_particles_of_one_shape(self):
        scene = self.scene(*QUICK, "--knee", "0.2", "--particles", "12", source="grain.stl")
        self.assertEqual(scene["particles"], 12)

    def test_refused(self):
        script = ("--format", "liggghts", "-o", "out")
        for args, says in (
            ((*self.SCENE, "--cylinder", "2", *script), ("box.obj reaches", "the cylinder has 2")),
            ((*self.SCENE, "--box", "9,2", *script), ("box.obj reaches", "the box has 2")),
            ((*QUICK, "--budget", "300", "--density", "1", "--least-mass", "0.9", *script), ("box.obj:", "mass")),
        ):
            with self.subTest(args=args):
                self.assert_refused("scene", "scene.csv", *args, code=1, says=says)
        for flag, width, wrong in (("--box", "9,1e101", "'1e101'"), ("--box", "0,9", "'0'"), ("--box", "9", "X,Y"),
                                   ("--cylinder", "nan", "'nan'")):
            with self.subTest(width=width):
                self.assert_refused("scene", "scene.csv", *self.SCENE, flag, width, *script, code=2, says=(flag, wrong))
        os.rename(self.path("grain.stl"), self.path("scene.stl"))
        self.assert_refused("scene", "scene.stl", *self.SCENE, *script, code=1, says=("out/scene.liggghts.in",))


class Refused(Scene):
    def test_manifests(self):
        self.write("nul.csv", b"shape,count\nbox.obj,\x001\n")
        many = ["box.obj,1"] + [f"box{n}.obj,1" for n in range(3)]
        for text, says in (
            ("", ("empty", "shape,count")),
            ("shape,count\n", ("no shape",)),
            ("# nothing\n\n", ("empty",)),
            ("box.obj,3\n", ("line 1", "header", "shape,count")),
            ("shape;count\nbox.obj;3\n", ("line 1", "header")),
            ("shape,count,tolerance,more\n", ("line 1", "header")),
            ("shape,count\nbox.obj\n", ("line 2", "header says")),
            ("shape,count\n,3\n", ("line 2",)),
            ("shape,count\nbox.obj,3,0.1\n", ("line 2", "header says")),
            ("shape,count\nbox.obj,0\n", ("line 2", "'0'", "1 to 1000000000")),
            ("shape,count\nbox.obj,-2\n", ("line 2", "'-2'")),
            ("shape,count\nbox.obj,1.5\n", ("line 2", "'1.5'", "whole")),
            ("shape,count\nbox.obj,nan\n", ("line 2", "'nan'")),
            ("shape,count\nbox.obj,1e400\n", ("line 2", "'1e400'")),
            ("shape,count\nbox.obj,99999999999999999999\n", ("line 2", "whole")),
            ("shape,count\nbox.obj,\n", ("line 2", "''")),
            ("shape,count\nbox.obj,1\n\nnone.stl,2\n", ("line 4", "none.stl", "No such file")),
            ("shape,count\nbox.obj,1\ngrain.stl,1\nbox.obj,2\n", ("line 4", "box.obj", "twice")),
            ('shape,count\n"box.obj",1\n', ("line 2", "quotation mark")),
            ("shape,count,tolerance\nbox.obj,1,nan\n", ("line 2", "'nan'", "0 to 1")),
            ("shape,count,tolerance\nbox.obj,1,2\n", ("line 2", "'2'")),
            ("shape,count,tolerance\nbox.obj,1,0.1x\n", ("line 2", "'0.1x'")),
            ("shape,count\n.,1\n", (".",)),
            ("shape,count\nscene.csv,1\n", ("scene.csv", "ending")),
            ("\n".join(["shape,count", *many]), ("line 3", "box0.obj")),
        ):
            with self.subTest(text=text):
                self.write("scene.csv", text)
                self.assert_refused("scene", "scene.csv", "--budget", "50", *QUICK, code=1, says=says)
        self.assert_refused("scene", "nul.csv", "--budget", "50", code=1, says=("nul.csv", "text"))
        self.assert_refused("scene", "none.csv", "--budget", "50", code=1, says=("none.csv",))
        self.assert_refused("scene", "none.stl", "--budget", "50", code=1, says=("none.stl",))

    def test_too_many_shapes(self):
        for n in range(1001):
            self.write(f"{n}.obj", "")
        self.write("scene.csv", "shape,count\n" + "".join(f"{n}.obj,1\n" for n in range(1001)))
        self.assert_refused("scene", "scene.csv", "--budget", "5000", code=1, says=("line 1002", "1000 shapes"))

    def test_goals(self):
        for args, says in (
            ((), ("no goal", "--budget", "--tolerance", "--knee")),
            (("--budget", "60", "--knee", "0.1"), ("exclude one another",)),
            (("--budget", "60", "--budget", "70"), ("exclude one another",)),
            (("--budget", "0"), ("--budget",)),
            (("--budget", "nan"), ("--budget",)),
            (("--budget", "60.5"), ("whole",)),
            (("--knee", "0"), ("--knee",)),
            (("--knee", "nan"), ("--knee",)),
            (("--tolerance", "dice"), ("--tolerance",)),
            (("--tolerance", "dice=nan"), ("--tolerance", "0 to 1")),
            (("--tolerance", "0.1"), ("'0.1'", "eta, dice, coverage, inertia, coverage_cut")),
            (("--tolerance", "radius=1"), ("'radius'", "eta, dice, coverage, inertia, coverage_cut")),
            (("--mean-tolerance", "coverage=0.5"), ("dice=VALUE", "coverage")),
            (("--mean-tolerance", "dice=2"), ("--mean-tolerance", "0 to 1")),
            (("--budget", "60", "--max-spheres", "1001"), ("--max-spheres", "1000")),
            (("--budget", "60", "--min-radius", "-1"), ("--min-radius",)),
            (("--budget", "60", "--format", "json"), ("-o DIR",)),
            (("--budget", "60", "--density", "5"), ("--density", "-o DIR")),
            (("--budget", "60", "-o", "out", "--format", "lammps"), ("lammps", "--density RHO")),
            (("--budget", "60", "-o", "out", "--format", "csv", "--format", "csv"), ("csv", "twice")),
            (("--budget", "60", "--unit", "mm"), ("--density",)),
            (("--budget", "60", "-o", "out", "--box", "1,2"), ("--box", "--format liggghts")),
            (("--budget", "60", "--box", "5"), ("two widths",)),
            (("--budget", "60", "--box", "5,x"), ("--box", "'x'")),
            (("--budget", "60", "--box", "5,6", "--cylinder", "5"), ("one vessel",)),
            (("--budget", "60", "--cylinder", "0"), ("--cylinder",)),
            (("--budget", "60", "--particles", "3"), ("--particles", "manifest")),
            (("--budget", "60", "-o", ""), ("--output",)),
            (("--budget", "60", "--set", "spacing=1"), ("'spacing'",)),  # an option of mss
            (("--budget", "60", "scene.csv"), ("one manifest",)),
        ):
            with self.subTest(args=args):
                self.assert_refused("scene", "scene.csv", *args, code=2, says=says)

    def test_tolerances_beside_another_goal(self):
        self.manifest(["box.obj,2,0.3", "grain.stl,1,"], header="shape,count,tolerance")
        self.assert_refused("scene", "scene.csv", "--budget", "60", code=2, says=("tolerances", "scene.csv"))
        self.assert_refused("scene", "scene.csv", code=2, says=("no goal", "tolerance for each shape"))

    def test_budget_below_one_sphere_each(self):
        self.assert_refused("scene", "scene.csv", "--budget", "48", code=1, says=("48 spheres", "49 particles"))

    def test_out_of_reach(self):
        few = (*QUICK, "--max-spheres", "3")
        for args, says in (
            (("--tolerance", "dice=0.01"), ("box.obj", "3 spheres", "dice 0.01", "--max-spheres")),
            (("--tolerance", "coverage=0.999"), ("box.obj", "coverage 0.999")),
            (("--mean-tolerance", "dice=0.01"), ("0.01", "more spheres")),
            (("--knee", "1e-9"), ("box.obj", "3 spheres", "--max-spheres")),
            (("--budget", "60", "--min-radius", "5"), ("box.obj", "placed no sphere")),
        ):
            with self.subTest(args=args):
                self.assert_refused("scene", "scene.csv", *few, *args, code=1, says=says)

    def test_a_shape_that_fails_ends_the_run(self):
        """A scene is whole or not at all, so that no run is left without a row."""
        self.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.assert_refused("scene", "open.obj", *QUICK, "--knee", "0.1", code=1, says=("open.obj: the mesh is open",))

    def test_templates_that_would_overwrite(self):
        os.mkdir(self.path("sub"))
        os.rename(self.path("box.obj"), self.path("sub/grain.obj"))
        self.manifest(["grain.stl,1", "sub/grain.obj,2"])
        self.mskit("scene", "scene.csv", *QUICK, "--budget", "9", "-o", "out", code=1)
        self.assert_says(self.mskit("scene", "scene.csv", *QUICK, "--budget", "9", "-o", "out", code=1),
                         "sub/grain.obj", "out/grain.csv", "rename")
        before = self.write("grain.csv", "shape,count\ngrain.stl,1\n")
        self.assert_refused("scene", "grain.csv", *QUICK, "--budget", "9", "-o", ".", code=1, says=("input itself",))
        self.assertEqual(self.read(before), b"shape,count\ngrain.stl,1\n")
        self.assert_refused("scene", "grain.csv", *QUICK, "--budget", "9", "-o", "no/such", code=1, says=("no/such",))
