"""Bodies that overlap are one, said once; voxels that do not hold the shape are said, with a cure that cures."""
import re

from support import Case, box_obj, shared_file

UNION = "passes through itself"
TOO_COARSE = "the voxels hold"


def together(*boxes):
    """Several cuboids in one OBJ; each counts its vertices on from the last."""
    text, before = "", 0
    for lo, hi in boxes:
        for line in box_obj(lo, hi).splitlines():
            words = line.split()
            if words[0] == "f":
                line = "f " + " ".join(str(int(w) + before) for w in words[1:])
            text += line + "\n"
        before += 8
    return text


def cells_advised(result):
    return int(re.search(r"try --cells (\d+)", result.err).group(1))


class Overlap(Case):
    def expect_union(self, path, volume, centre):
        result = self.mskit("info", path, "--json")
        info = result.json
        self.assertIs(info["overlapping"], True)
        self.assertEqual(result.err.count(UNION), 1, str(result))
        self.assertNotIn("separate", result.err)
        self.assertIsNone(info["sphericity"])
        self.assert_close(info["volume"], volume, 1e-3, "volume")
        for got, truth in zip(info["centroid"], centre):
            self.assertAlmostEqual(got, truth, delta=1e-3)
        return info

    def test_shared_cases(self):
        self.expect_union(shared_file("cases", "c04_two_boxes_overlap.obj"), 2.25, (1.1666667, 0.5, 0.5))
        self.expect_union(shared_file("cases", "h00_dimer.obj"), 7.02, (0, 0, 0))
        self.expect_union(shared_file("cases", "overlap_cubes.obj"), 1.6625, (0.75, 0.625, 0.55))

    def test_every_command_has_the_same_body(self):
        """Boxes of 6 and 3 that share 1.5 x 1 x 1: mass, moments and voxels are of 7.5."""
        self.write("two.obj", together(((0, 0, 0), (3, 2, 1)), ((1.5, 1, 0), (4.5, 2, 1))))
        info = self.expect_union("two.obj", 7.5, (1.95, 1.1, 0.5))
        run = self.mskit("generate", "two.obj", "-g", "mss", "-n", 12, "--deq", 40, "--correct", "--density", 1000,
                         "--centre-tolerance", 0.5, "--json", "-o", "m.json", "-o", "c.csv")
        self.assertEqual(run.err.count(UNION), 1, str(run))
        target = run.json["input"]
        self.assert_close(target["voxel_size"], (6 * 7.5 / 3.14159265) ** (1 / 3) / 40, 1e-4, "--deq")
        result = self.mskit("score", "c.csv", "--target", "two.obj", "--cells", 20, "--json")
        target = result.json["target"]
        self.assert_close(target["voxels"] * target["voxel_size"] ** 3, 7.5, 1e-9, "voxels")
        self.assertNotIn(TOO_COARSE, result.err)
        result = self.mskit("correct", "c.csv", "--target", "two.obj", "--density", 1000, "--centre-tolerance", 0.5,
                            "--json", "-o", "d.csv")
        self.assertEqual(result.err.count(UNION), 1, str(result))
        particle = result.json["particle"]
        self.assert_close(particle["mass"], 7500, 1e-3, "mass")
        for got, of_info in zip(particle["principal_moments"], info["principal_moments"]):
            self.assert_close(got, 1000 * of_info, 1e-12, "moments")
        for command in (("score", "c.csv", "--target", "two.obj"), ("scene", "two.obj", "-g", "mss", "--knee", 0.9,
                                                                   "--max-spheres", 4)):
            result = self.mskit(*command, "--cells", 20)
            self.assertEqual(result.err.count(UNION), 1, str(result))

    def test_bodies_that_only_touch(self):
        self.write("touch.obj", together(((0, 0, 0), (1, 1, 1)), ((1, 0.25, 0.25), (2, 0.75, 0.75))))
        result = self.mskit("info", "touch.obj", "--json")
        self.assertIs(result.json["overlapping"], False)
        self.assertEqual(result.json["volume"], 1.25)
        self.assert_says(result, "2 bodies", "none overlap")
        self.assertNotIn("separate", result.err)

    def test_bodies_apart_are_separate(self):
        self.write("apart.obj", together(((0, 0, 0), (1, 1, 1)), ((1.001, 0.25, 0.25), (2, 0.75, 0.75))))
        result = self.mskit("info", "apart.obj", "--json")
        self.assertIs(result.json["overlapping"], False)
        self.assert_says(result, "2 separate bodies")


class Voxels(Case):
    def score(self, shape, *grid):
        self.write("c.csv", "x,y,z,r\n0,0,0,0.05\n")
        return self.mskit("score", "c.csv", "--target", shape, *grid)

    def test_thin_shapes(self):
        """What is said is what the voxels hold; with the cells that it names, nothing is said."""
        for kind, grid in (("plate", ("--deq", 40)), ("needle", ("--cells", 3)), ("needle", ("--deq", 20))):
            with self.subTest(kind=kind, grid=grid):
                self.shape(kind)
                result = self.score(kind + ".stl", *grid)
                self.assertEqual(result.err.count(TOO_COARSE), 1, str(result))
                target = self.mskit("score", "c.csv", "--target", kind + ".stl", "--json", *grid).json["target"]
                volume = self.mskit("info", kind + ".stl", "--json").json["volume"]
                misfit = 100 * (target["voxels"] * target["voxel_size"] ** 3 / volume - 1)
                said = re.search(r"hold ([0-9.]+) % (more|less)", result.err)
                self.assertAlmostEqual(float(said.group(1)), abs(misfit), delta=0.01 * abs(misfit))
                self.assertEqual(said.group(2), "more" if misfit > 0 else "less")
                better = self.score(kind + ".stl", "--cells", cells_advised(result))
                if TOO_COARSE in better.err:  # far off, one step is not enough
                    better = self.score(kind + ".stl", "--cells", cells_advised(better))
                self.assertNotIn(TOO_COARSE, better.err, str(better))

    def test_what_fits_is_not_said(self):
        self.shape("ball")
        self.shape("cube")
        self.shape("plate")
        for shape, cells in (("ball", 20), ("ball", 40), ("cube", 1), ("cube", 13), ("plate", 1)):
            self.assertNotIn(TOO_COARSE, self.score(shape + ".stl", "--cells", cells).err)

    def test_every_command_says_it_once_per_grid(self):
        """3.9 voxels across a side."""
        self.write("bar.obj", box_obj((0, 0, 0), (4, 1, 1.3)))
        grid = ("--cells", 3)
        methods = ("-g", "mss", "-g", "mss:variant=paper")
        for command in (("generate", "bar.obj", "-g", "mss", "-n", 2, *grid, "-o", "a.csv"),
                        ("compare", "bar.obj", *methods, "-n", "2,3", *grid, "-o", "b.csv"),
                        ("scene", "bar.obj", "-g", "mss", "--knee", 0.9, "--max-spheres", 4, *grid),
                        ("stability", "bar.obj", *methods, "-n", 2, "--runs", 2, *grid, "--perturb", "seed", "-o",
                         "c.csv")):
            with self.subTest(command=command[0]):
                result = self.mskit(*command)
                self.assertEqual(result.err.count(TOO_COARSE), 1, str(result))

    def test_stability_says_it_once_for_each_resolution(self):
        self.write("bar.obj", box_obj((0, 0, 0), (4, 1, 1.25)))
        result = self.mskit("stability", "bar.obj", "-g", "mss", "-g", "mss:variant=paper", "-n", 2, "--cells", 4,
                            "--runs", 2, "--perturb", "resolution", "-o", "c.csv")
        said = re.findall(r"bar.obj: the voxels hold .*now ([0-9.]+)", result.err)
        self.assertGreater(len(said), 0, str(result))
        self.assertEqual(len(said), len(set(said)), "each once")

    def test_an_open_mesh_says_whose_volume_it_has(self):
        self.write("open.obj", box_obj((0, 0, 0), (1, 1, 1), skip=1))
        result = self.score("open.obj", "--allow-open", "--cells", 10)
        self.assert_says(result, "those of the voxels")
        self.assertNotIn(TOO_COARSE, result.err)
