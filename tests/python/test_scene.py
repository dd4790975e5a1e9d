"""Scenes: templates, scripts and figures are those of `mskit scene`, byte for byte."""
import math
import os
import pathlib
import pickle
import unittest

import mskit
import numpy
from support_python import PythonCase, labelled

ENGINES = ["liggghts", "lammps", "yade"]
HEAVY = {"density": 2650, "unit": "mm"}


class Scenes(PythonCase):
    def setUp(self):
        super().setUp()
        self.shape("torus", "fineness=6", name="torus.ply")
        self.torus = self.path("torus.ply")
        self.grain = self.path(self.grain)

    def files(self, folder):
        return {name: self.read(os.path.join(folder, name)) for name in os.listdir(self.path(folder))}

    def expect_same(self, scene, manifest, *flags, masses=(), **vessel):
        """Figures, curves and all files."""
        self.write("scene.csv", manifest)
        told = self.mskit("scene", "scene.csv", *flags, "-o", "program", "--density", 2650, "--unit", "mm", "--json",
                          *[word for name in ENGINES for word in ("--format", name)]).json
        self.assertEqual((scene.particles, scene.spheres, scene.mean_dice, scene.least_gain, scene.slack),
                         (told["particles"], told["spheres"], told["mean_dice"], told["least_gain"],
                          told["slack"] or 0))
        for kind, shape in zip(scene.kinds, told["shapes"]):
            self.assertEqual([None if math.isnan(dice) else dice for dice in kind.dice], shape["curve"])
        written = scene.correct(**HEAVY, **dict(masses)).write(self.path("module"), ENGINES, **vessel)
        mine, theirs = self.files("module"), self.files("program")
        self.assertEqual(sorted(mine), sorted(theirs))
        for name in theirs:
            self.assertEqual(mine[name], theirs[name], name)
        self.assertEqual(len(written), 3 * len(scene.kinds) + 3)
        self.assertLessEqual({os.path.basename(path) for path in written}, set(mine))

    def test_two_shapes_with_sizes(self):
        """Of all numbers of spheres, and where few are searched."""
        rows = [{"shape": self.grain, "count": 300, "size": 0.5}, (self.torus, 20),
                {"shape": self.grain, "count": 30, "size": 2}]
        manifest = "shape,count,size\ngrain.ply,300,0.5\ntorus.ply,20,\ngrain.ply,30,2\n"
        for method, flags, vessel in [("mss", ("--box", "20,30"), {"box": (20, 30)}),
                                      ("fcm", ("--cylinder", 25), {"cylinder": 25})]:
            scene = mskit.scene(rows, tolerance_length=0.15, generator=method, max_spheres=12, cells=12)
            self.expect_same(scene, manifest, "--tolerance-length", 0.15, "-g", method, "--max-spheres", 12,
                             "--cells", 12, *flags, **vessel)
        small, large = scene.kinds[0], scene.kinds[2]
        self.assertLess(len(small.clump), len(large.clump))
        self.assertAlmostEqual(large.factor / small.factor, 4, delta=1e-12)
        self.assertIsNone(large.clump.shape)
        self.assertEqual(scene.kinds[1].clump.scores["dice"], scene.kinds[1].dice[len(scene.kinds[1].clump) - 1])

    def test_goals(self):
        rows, manifest = [(self.grain, 300), (self.torus, 20)], "shape,count\ngrain.ply,300\ntorus.ply,20\n"
        for method, goal, flags in [
                ("mss", {"budget": 2000}, ("--budget", 2000)),
                ("mss", {"mean_dice": 0.14}, ("--mean-tolerance", "dice=0.14")),
                ("mss", {"knee": 0.3}, ("--knee", 0.3)),
                ("setcover", {"tolerance": {"coverage_cut": 0.6}}, ("--tolerance", "coverage_cut=0.6")),
                ("variational", {"tolerance": {"dice": 0.3}, "equal_volume": True},
                 ("--tolerance", "dice=0.3", "--equal-volume"))]:
            scene = mskit.scene(rows, generator=method, max_spheres=9, cells=10, **goal)
            self.expect_same(scene, manifest, *flags, "-g", method, "--max-spheres", 9, "--cells", 10)

    def test_tolerances_of_rows(self):
        rows = [{"shape": pathlib.Path(self.grain), "count": 3, "tolerance": 0.2},
                {"shape": self.torus, "count": 2, "tolerance": 0.4}]
        scene = mskit.scene(rows, generator="mss", max_spheres=9, cells=10)
        self.expect_same(scene, "shape,count,tolerance\ngrain.ply,3,0.2\ntorus.ply,2,0.4\n", "-g", "mss",
                         "--max-spheres", 9, "--cells", 10)

    def test_sieve(self):
        """By a curve in a file and in memory, and rows likewise."""
        self.write("curve.csv", "size,passing\n0.5,0\n1,0.3\n2.2,1\n")
        self.write("scene.csv", "shape,count\ngrain.ply,100\ntorus.ply,9\n")
        flags = ("--tolerance-length", 0.3, "-g", "mss", "--max-spheres", 9, "--cells", 10)
        for classes, more in ((None, ()), (3, ("--classes", 3))):
            found = mskit.sieve([(self.grain, 100), (self.torus, 9)], [(0.5, 0), (1, 0.3), (2.2, 1)], classes)
            again = mskit.sieve(self.path("scene.csv"), self.path("curve.csv"), classes)
            scene = mskit.scene(found.rows, tolerance_length=0.3, generator="mss", max_spheres=9, cells=10)
            told = self.mskit("scene", "scene.csv", "--sieve", "curve.csv", *flags, *more, "--json").json
            for one in (found, again):
                self.assertEqual([list(row) for row in zip(*(each.tolist() for each in one[1:]))],
                                 [[of[name] for name in ("size", "particles", "asked", "have")]
                                  for of in told["sieve"]])
            self.assertEqual([(kind.particles, kind.size, len(kind.clump)) for kind in scene.kinds],
                             [(of["particles"], of["size"], of["scores"]["spheres"]) for of in told["shapes"]])
        self.expect_same(mskit.scene(self.path("scene.csv"), knee=1, generator="mss", cells=8, max_spheres=3),
                         "shape,count\ngrain.ply,100\ntorus.ply,9\n", "--knee", 1, "-g", "mss", "--cells", 8,
                         "--max-spheres", 3, "--properties", "union", masses={"properties": "union"})
        for rows, curve, words in [
                ([(self.grain, 1)], [(1, 0.5), (2, 1)], "the sieve curve: row 0: 0.5 of the mass is finer"),
                ([(self.grain, 1)], [(1, 0), (2, math.nan)], "row 1: the share 'nan'"),
                ([(self.grain, 1)], numpy.empty((0, 2)), "lets 0 of the mass pass"),
                ([(self.grain, 1)], [1, 2], "neither rows size, passing"), ([(self.grain, 1)], "none.csv", "none.csv"),
                ([(self.grain, 10**9 + 1)], [(1, 0), (2, 1)], "row 0: count=1000000001"),
                ([(self.grain, 10**9), (self.torus, 1)], [(1, 0), (2, 1)], "1000000001 particles of 2 shapes"),
                ([{"shape": self.grain, "count": 1, "size": 1}], [(1, 0), (2, 1)], "rows have sizes")]:
            self.refused(mskit.Error, words, mskit.sieve, rows, curve)

    def test_voxels_stay_with_shapes_that_were_given(self):
        grain = mskit.read(self.grain)
        scene = mskit.scene([(grain, 2), (self.torus, 3)], knee=1, generator="mss", cells=8, max_spheres=2)
        self.assertEqual([kind.shape._made is None for kind in scene.kinds], [False, True])
        before = scene.kinds[1].clump.scores
        scene.kinds[1].shape.drop_voxels()
        self.assertEqual(repr(mskit.score(scene.kinds[1].clump)), repr(before))

    def test_progress(self):
        """It is told of each shape's runs, and what the listener raises ends them."""
        rows, told = [(self.grain, 2), (self.torus, 3)], []

        def end(now):
            told.append(now)
            raise KeyboardInterrupt

        for method in ("mss", "fcm"):
            told.clear()
            with self.assertRaises(KeyboardInterrupt):
                mskit.scene(rows, tolerance={"dice": 0.05}, generator=method, max_spheres=20, cells=10,
                            progress=end)
            self.assertEqual(len(told), 1)
            mskit.scene(rows, tolerance={"dice": 0.8}, generator=method, max_spheres=4, cells=8, progress=told.append)
            self.assertGreater(len(told), 2)
            self.assertIsInstance(told[-1], mskit.Progress)
        self.refused(mskit.ArgumentError, "progress=3", mskit.scene, rows, knee=1, progress=3)

    def test_what_is_made_in_memory(self):
        """By its name; in another process, too."""
        grains = list(mskit.grains(labelled()))
        for grain, name in zip(grains, ("a.npy", "round thing.npy")):
            grain.name = name
        scene = mskit.scene([(grain, 5) for grain in grains], budget=20, generator="mss", max_spheres=4)
        scene = scene.correct(density=1000)
        again = pickle.loads(pickle.dumps(scene))
        for one, folder in ((scene, "a"), (again, "b")):
            self.assertEqual([os.path.basename(path) for path in one.write(self.path(folder), "yade")],
                             ["a.yade", "round thing.yade", "scene.yade.py"])
        self.assertEqual(self.files("a"), self.files("b"))
        for kind in again.kinds:
            self.assertAlmostEqual(kind.clump.particle.mass / (1000 * kind.shape.volume), 1, delta=1e-12)

    def test_refusals(self):
        cube = mskit.body("cube", fineness=1)
        self.write("bad.csv", "shape,count\ngrain.ply,3\ntorus.ply,0\n")
        for rows, words in [
                ([], "rows=[] is neither a list"), (3, "rows=3 is neither"), ([3], "row 0: 3 is neither"),
                ("none.csv", "none.csv"),
                (self.path("bad.csv"), "bad.csv: line 3: the count '0' is not a whole number"),
                ([(cube, 0)], "row 0: count=0 is not a whole number from 1 to 1000000000"),
                ([(cube, 1), ("none.stl", 2)], "row 1: "),
                ([(cube, 1.5)], "row 0: count=1.5 is not a whole number"),
                ([{"shape": cube}], "row 0 has no count"),
                ([{"shape": cube, "count": 1, "sizes": 2}], "row 0: there is no column 'sizes'"),
                ([{"shape": cube, "count": 1, "size": 0}], "row 0: size=0 is not"),
                ([{"shape": cube, "count": 1, "tolerance": 2}], "row 0: tolerance=2"),
                ([(cube, 1), (cube, 2)], "row 1: cube stands twice; add up the counts"),
                ([{"shape": cube, "count": n, "size": 2} for n in (1, 2)], "twice in this size"),
                ([(pathlib.Path(self.grain), n) for n in (1, 2)], "grain.ply stands twice")]:
            self.refused(mskit.Error, words, mskit.scene, rows, budget=99)
        sized, tolerated = [{"shape": cube, "count": 1, "size": 2}], [{"shape": cube, "count": 1, "tolerance": 0.2}]
        for rows, options, words in [
                ([(cube, 9)], {}, "no goal"), ([(cube, 9)], {"budget": 9, "knee": 0.1}, "exclude one another"),
                ([(cube, 9)], {"budget": 8}, "8 spheres is less than one for each of 9"),
                ([(cube, 9)], {"tolerance": 0.1}, "is no dict of one measure"),
                ([(cube, 9)], {"tolerance": {"dise": 0.1}}, "dise"), ([(cube, 9)], {"knee": 0}, "knee=0"),
                ([(cube, 9)], {"tolerance": {"dice": 2}}, "tolerance dice=2"),
                ([(cube, 9)], {"tolerance_length": 0}, "tolerance_length=0"),
                (tolerated, {"budget": 9}, "the tolerances of rows go with"),
                (sized, {"budget": 9, "min_radius": 0.1}, "min_radius is of shapes in their own size"),
                ([(cube, 9)], {"budget": 9, "max_spheres": 0}, "max_spheres=0"),
                ([(cube, 9)], {"budget": 9, "equal_volume": 1}, "equal_volume=1 is neither"),
                (sized, {"tolerance_length": 1e-3}, "cube, size 2: no template of up to 3 spheres has a mean distance"),
                ([(cube, 9)], {"tolerance": {"dice": 1e-3}}, "no template of up to 3 spheres has dice 0.001"),
                ([(cube, 9)], {"knee": 1e-3}, "cube: up to the last of 3 spheres"),
                ([(cube, 9)], {"mean_dice": 1e-3}, "the best templates reach")]:
            self.refused(mskit.Error, words, mskit.scene, rows,
                         **{"generator": "mss", "max_spheres": 3, "cells": 8, **options})

    def test_what_cannot_be_written(self):
        cube, other = mskit.body("cube", fineness=1), mskit.body("cube", fineness=1)
        bare = mskit.scene([(cube, 2), (other, 3)], knee=1, generator="mss", max_spheres=8, cells=8)
        self.refused(mskit.ArgumentError, "the templates of cube and cube would both be", bare.write,
                     self.path("out"))
        other.name = "box"
        self.refused(mskit.ArgumentError, "cube: a yade template needs the mass", bare.write, self.path("out"), "yade")
        scene = bare.correct(density=1000)
        for format, options, words in [
                ("stl", {}, "no clump format 'stl'"), ([], {}, "neither a format nor"), (3, {}, "format=3"),
                (["yade", "yade"], {}, "given twice"), ("yade", {"box": (1, 1)}, "reaches 0.59"),
                ("yade", {"cylinder": 1}, "the cylinder has 1"), ("yade", {"box": 3}, "box=3 is not two widths"),
                ("yade", {"cylinder": 0}, "cylinder=0"), ("yade", {"box": (9, 9), "cylinder": 9}, "one vessel"),
                ("csv", {"cylinder": 9}, "box and cylinder are of scripts")]:
            self.refused(mskit.ArgumentError, words, scene.write, self.path("out"), format, **options)
        for name, format, words in [
                ("scene", "yade", "scene.yade.py; rename the shape"), (3, "csv", "3 is no path"),
                ("\ud800", "csv", "is no path")]:
            other.name = name
            self.refused(mskit.ArgumentError, words, scene.write, self.path("out"), format)
        other.name, cube.name = "a.frame.json", "a.x"  # the stem of the first is a.frame
        self.refused(mskit.ArgumentError, "a.frame.json; rename one of the shapes", scene.write, self.path("out"),
                     ["json", "yade"])
        for particles in (0, 1.5, -1, 10**12):
            self.refused(mskit.ArgumentError, f"particles={particles} is not a whole number from 1",
                         scene._replace(kinds=[scene.kinds[0]._replace(particles=particles)]).write,
                         self.path("out"), "yade")
        near = mskit.scene([{"shape": cube, "count": 1, "size": size} for size in (1.2345678, 1.2345679)], knee=1,
                           generator="mss", max_spheres=8, cells=8)
        self.refused(mskit.ArgumentError, "in the sizes 1.2345678 and 1.2345679", near.write, self.path("out"))
        for format in ("csv", "yade"):
            self.refused(mskit.ArgumentError, "no kinds of particles", scene._replace(kinds=[]).write,
                         self.path("out"), format)
        self.refused(mskit.ArgumentError, "is no path", scene.write, "\ud800")
        cube.name = 300 * "a"
        self.refused(mskit.FileError, "aaa.csv: ", scene.write, self.path("out"))
        self.assertFalse(os.path.exists(self.path("out")))
        self.write("file", "")
        for folder in ("file/out", "file", "none/out", "/".join(3000 * "a")):
            self.refused(mskit.FileError, "cannot be made", scene.write, self.path(folder), "yade")
        cube.name = "cube"
        os.makedirs(self.path("out/scene.liggghts.in"))
        self.refused(mskit.FileError, "scene.liggghts.in: is a folder", scene.write, self.path("out"), "liggghts")
        self.assertEqual(os.listdir(self.path("out")), ["scene.liggghts.in"])
        numpy.testing.assert_array_equal(bare.kinds[0].clump.radii, scene.kinds[0].clump.radii)


if __name__ == "__main__":
    unittest.main()
