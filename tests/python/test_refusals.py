"""Bad input is an exception with one sentence that says what is wrong, never a crash and never a result."""
import os
import unittest
import warnings

import mskit
import numpy
from support_python import PythonCase, box_obj, labelled

CORNERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]


class Refusals(PythonCase):
    def test_vertices(self):
        for vertices, words in [
                ([], "vertices are not rows of three numbers"), (numpy.zeros((4, 2)), "shape (4, 2)"),
                (numpy.zeros(3), "shape (3,)"), (numpy.zeros((0, 3)), "shape (0, 3)"),
                ([[1, 2, 3], [1]], "vertices are not"),
                (numpy.array(CORNERS, complex), "complex128"), (numpy.array(CORNERS, object), "object"),
                (numpy.array(CORNERS).astype(str), "<U"), (None, "vertices are not"), ("abc", "vertices are not"),
                ([(0, 0, 0), (1, 0, float("nan")), (0, 1, 0), (0, 0, 1)], "vertex 1 is not finite: [1.0, 0.0, nan]"),
                ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, -numpy.inf)], "vertex 3 is not finite"),
                (numpy.array(CORNERS) * 1e200, "choose another unit"),
                (numpy.array(CORNERS) * 1e-200, "choose another unit"),
                (numpy.array(CORNERS) * numpy.array([1, 1, 0]), "")]:
            self.refused(mskit.Error, words, mskit.mesh, vertices, FACES)

    def test_faces(self):
        for faces, words in [
                ([], "faces are not rows of three whole numbers"), (numpy.array(FACES, float), "float64"),
                (numpy.array(FACES)[:, :2], "shape (4, 2)"), (numpy.zeros((0, 3), int), "shape (0, 3)"),
                ([(0, 2, 1), (0, 1, 4)], "face 1 is [0, 1, 4], and vertices are 0 to 3"),
                ([(0, 2, -1)], "face 0 is [0, 2, -1]"), ([(0, 2, 2**40)], "face 0 is"), ([(0, 1, 1)], "the mesh: "),
                (FACES[1:], "the mesh is open: 3 edges belong to one triangle only")]:
            self.refused(mskit.Error, words, mskit.mesh, CORNERS, faces)

    def test_open_mesh_is_taken_or_mended(self):
        self.refused(mskit.ShapeError, "fill_holes=3", mskit.mesh, CORNERS, FACES[1:])
        self.assertTrue(mskit.mesh(CORNERS, FACES[1:], fill_holes=3).closed)
        taken = mskit.mesh(CORNERS, FACES[1:], allow_open=True)
        self.assertFalse(taken.closed)
        self.refused(mskit.ArgumentError, "deq needs", mskit.generate, taken, "mss", deq=20)
        self.assertGreater(len(mskit.generate(taken, "mss", spheres=2, cells=20)), 0)

    def test_volumes(self):
        labels = labelled()
        for array, words in [
                (numpy.zeros((0, 3, 3), int), "shape (0, 3, 3)"), (numpy.zeros((3, 3)), "shape (3, 3)"),
                (labels.astype(complex), "complex"), (labels.astype(object), "object"),
                (labels.astype(float) / 2, "array.npy"),
                (labels * numpy.nan, "array.npy"), (-labels.astype(int), "array.npy"), (labels * 0, "array.npy"),
                (labels.astype(numpy.float16), "array.npy"), (labels, "several labels (8 among them)"), (5, "shape ()"),
                ([[[1, 2], [1]]], "shape (0,)")]:
            self.refused(mskit.Error, words, mskit.volume, array)
        for options, words in [
                ({"label": 4}, "no voxel of label 4"), ({"label": -1}, "label=-1"), ({"label": 1.5}, "whole number"),
                ({"spacing": 0}, "spacing=0 "), ({"spacing": (1, 2)}, "neither one number nor three"),
                ({"spacing": "wide"}, "spacing="), ({"spacing": numpy.nan}, "spacing=nan"),
                ({"origin": None}, "origin=None"),
                ({"connectivity": 7}, "none of 6, 18 and 26"), ({"threshold": "mean"}, "threshold='mean'")]:
            self.refused(mskit.Error, words, mskit.volume, labels, **options)
            if "label" not in options:
                self.refused(mskit.Error, words, mskit.grains, labels, **options)

    def test_volume_has_voxels_of_its_own(self):
        ball = mskit.volume(labelled(), label=3)
        for options in ({"cells": 20}, {"deq": 20}, {"voxel_size": 1}, {"max_voxels": 1e6}):
            self.refused(mskit.ArgumentError, "voxels of its own", mskit.generate, ball, "mss", **options)
            self.refused(mskit.ArgumentError, "voxels of its own", mskit.score, [(8, 8, 8, 6)], ball, **options)

    def test_anything(self):
        """Whatever is given where: a result, or an error with one sentence."""
        grain = mskit.body("grain", fineness=6)
        clump = mskit.generate(grain, "mss", spheres=3, cells=10)
        things = [None, 0, -1, 2.5, 1e308, float("nan"), "", "x", "\0", b"a", [], [[1, 2, 3]], (1, 2), {"dice": None},
                  {1: 2}, numpy.zeros(3), numpy.zeros((3, 3)), numpy.zeros((2, 2, 2)), numpy.full((3, 3), numpy.nan),
                  object(), True, 2**64, 10**400, 1e-300, [[1], [2, 3], [4]], numpy.int8(3), numpy.float32(0.1),
                  numpy.datetime64("2020-01-01"), grain, clump, 1j,
                  numpy.array(None), numpy.arange(12.0).reshape(3, 4), "/", lambda *_: 1]
        given = {"generate": "spheres until min_radius cells deq voxel_size max_voxels rule max_memory seed threads "
                             "progress spacing plane refine variant",
                 "score": "cells cut threads rule", "curve": "cells progress",
                 "correct": "density unit scale properties axes least_mass carriers carrier_depth", "expect": "threads",
                 "contact": "poses overlap restitution factors seed threads", "volume": "spacing origin label "
                 "threshold connectivity", "grains": "spacing min_voxels border", "mesh": "weld fill_holes drop_bodies",
                 "read": "label weld", "Clump": "masses", "body": "r", "equal_volume": "", "read_clump": "",
                 "write": "format",
                 "scene": "budget tolerance tolerance_length mean_dice knee max_spheres min_radius equal_volume cells"}
        usual = {"generate": [grain, "mss"], "volume": [labelled()], "grains": [labelled()], "mesh": [CORNERS, FACES],
                 "read": [self.path(self.grain)], "Clump": [[(0, 0, 0)], [1]], "body": ["ball"],
                 "read_clump": ["none.csv"], "expect": [grain], "scene": [[(grain, 2)]],
                 "write": [clump, self.path("c.csv")]}
        refused = 0
        for name, options in given.items():
            first = usual.get(name, [clump])
            least = {"generate": {"spheres": 1, "cells": 6}, "correct": {"density": 1},
                     "contact": {"poses": 1, "overlap": 0.01},
                     "scene": {"knee": 1, "generator": "mss", "cells": 6, "max_spheres": 2}}.get(name, {})
            for thing in things:
                calls = [(first[:k] + [thing] + first[k + 1:], least) for k in range(len(first))]
                calls += [(first, {**least, option: thing}) for option in options.split()]
                for arguments, more in calls:
                    try:
                        with warnings.catch_warnings():
                            warnings.simplefilter("ignore")
                            getattr(mskit, name)(*arguments, **more)
                    except mskit.Error as failure:
                        refused += 1
                        self.assertNotIn("\n", str(failure))
                        self.assertGreater(len(str(failure)), 9)
        self.assertGreater(refused, 1000)

    def test_huge(self):
        """Views of one number, larger than any memory."""
        self.refused(mskit.LimitError, "more than is allowed", mskit.volume,
                     numpy.broadcast_to(1, (10**4, 10**4, 10**6)))
        self.refused(mskit.LimitError, "GB on their way", mskit.mesh, numpy.broadcast_to(0.5, (2 * 10**9, 3)), FACES)
        self.refused(mskit.LimitError, "GB on their way", mskit.mesh, CORNERS, numpy.broadcast_to(0, (2 * 10**9, 3)))
        self.refused(mskit.LimitError, "more than 2147483647", mskit.mesh, numpy.broadcast_to(0.5, (10**12, 3)), FACES)
        self.refused(mskit.LimitError, "more than 2147483647", mskit.mesh, CORNERS, numpy.broadcast_to(0, (10**12, 3)))

    def test_what_is_no_shape(self):
        for shape, words in [(None, "is no shape"), (3, "is no shape"), ("", "names no file"),
                             ("a\0b.stl", "names no file"),
                             ("grain.txt", "its ending names no shape"), ("none.stl", "none.stl"),
                             ([1, 2, 3], "is no shape"),
                             (numpy.zeros((2, 2)), "")]:
            self.refused(mskit.Error, words, mskit.generate, shape)
        self.refused(mskit.FileError, "none.ply", mskit.read, self.path("none.ply"))
        self.refused(OSError, "none.ply", mskit.read, self.path("none.ply"))
        self.refused(mskit.ArgumentError, "'label' is no option", mskit.read, self.path(self.grain), label=3)
        self.write("bad.obj", box_obj((0, 0, 0), (1, 1, 1)) + "f 1 2 99\n")
        said = self.mskit("info", "bad.obj", code=1).err
        self.assertIn(self.refused(mskit.FormatError, "99", mskit.read, self.path("bad.obj")).split(": ", 1)[1], said)

    def test_sentences_are_those_of_the_program(self):
        for options, flags in [({"spacing": 5000}, "--spacing 5000"), ({"variant": "bets"}, "--variant bets"),
                               ({"until": {"dcie": 0.1}}, "--until dcie=0.1"),
                               ({"plane": (0, 0, 0, 1)}, "--plane 0,0,0,1")]:
            said = self.mskit("generate", self.grain, "-g", "mss", *flags.split(), code=2).err
            sentence = self.refused(mskit.ArgumentError, "", mskit.generate, self.path(self.grain), "mss", **options)
            self.assertIn(sentence.replace(".0", ""), said)

    def test_runs(self):
        for options, words in [
                ({"generator": "mms"}, "mms"), ({"generator": None}, "generator=None is no name"),
                ({"generator": "é"}, "é"), ({"spheres": 0}, "spheres=0 is not a whole number from 1 to 65534"),
                ({"spheres": 2.5}, "spheres=2.5 is not a whole number"), ({"spheres": 10**30}, "spheres=1"),
                ({"spheres": "10"}, "spheres='10'"), ({"until": 3}, "until=3"), ({"until": {"dice": -1}}, "dice"),
                ({"until": {"dice": 2}}, "dice"), ({"min_radius": 0}, "min_radius=0"), ({"cells": 0}, "cells=0"),
                ({"cells": 40000}, "cells=40000"), ({"cells": 20, "deq": 20}, "exclude one another"),
                ({"voxel_size": float("nan")}, "voxel_size=nan"),
                ({"rule": "third"}, "rule='third' is none of 'half', 'centre'"),
                ({"seed": -1}, "seed=-1"), ({"threads": 0}, "threads=0"), ({"threads": 5000}, "threads=5000"),
                ({"progress": 3}, "neither a function nor True"), ({"sphres": 3}, "sphres"),
                ({"spacing": []}, "spacing=[]"),
                ({"spacing": numpy.nan}, "spacing"), ({"plane": (1, 2, 3)}, "four numbers"),
                ({"confine": 7}, "confine"),
                ({"voxel_size": 1e-9}, "allowed; use fewer cells"),
                ({"max_memory": 1000}, "more than the 1e-06 GB allowed"),
                ({"max_voxels": 10}, "grain.ply: 10 voxels are too few"), ({"min_radius": 100}, "grain.ply: ")]:
            with self.subTest(options=options):
                how = {"generator": "mss", "cells": None, **options}
                self.refused(mskit.Error, words, mskit.generate, self.path(self.grain), **how)

    def test_clumps(self):
        for centres, radii in [([], []), ([(0, 0, 0)], [0]), ([(0, 0, 0)], [-1]), ([(0, 0, 0)], [float("nan")]),
                               ([(0, 0, float("inf"))], [1]), ([(0, 0)], [1]), ([(0, 0, 0)], [1, 2]), ("ab", [1]),
                               (None, None),
                               (numpy.zeros((3, 2)), [1, 2]), (numpy.zeros((2, 3)), numpy.ones((2, 2))), ([0, 0, 0], 1),
                               ([("0", "0", "0")], [1]), ([(0, 0, 1j)], [1]),
                               (numpy.zeros((70000, 3)), numpy.ones(70000))]:
            self.refused(mskit.ArgumentError, "", mskit.Clump, centres, radii)
        for masses in ([1, 2], [0], [float("nan")], "x"):
            self.refused(mskit.ArgumentError, "masses are not 1 finite", mskit.Clump, [(0, 0, 0)], [1], masses)
        pair = mskit.Clump([(0, 0, 0), (1, 0, 0)], [1, 1])
        self.refused(mskit.ArgumentError, "takes a slice", pair.__getitem__, 0)
        self.refused(mskit.ArgumentError, "give the shape", lambda: pair.scores)
        self.refused(mskit.ArgumentError, "give the shape", mskit.correct, pair, density=1)
        self.refused(mskit.ArgumentError, "is no clump", mskit.score, 3, self.path(self.grain))
        for value in (pair.centres, pair.radii, pair.spheres):
            with self.assertRaises(ValueError):
                value[...] = 0

    def test_masses(self):
        clump = mskit.generate(self.path(self.grain), "mss", spheres=3, cells=12)
        for options, words in [({"density": 0}, "density=0"), ({"density": float("inf")}, "density=inf"),
                               ({"density": 1, "unit": "ft"}, "unit='ft' is none of 'm', 'mm', 'um'"),
                               ({"density": 1, "scale": -1}, "scale=-1"), ({"density": 1, "axes": "x"}, "axes='x'"),
                               ({"density": 1, "least_mass": 0.9}, ""),
                               ({"density": 1, "carrier_depth": 1}, "carriers=True"),
                               ({"density": 1e300, "scale": 1e100}, "")]:
            self.refused(mskit.Error, words, mskit.correct, clump, **options)

    def test_files(self):
        clump = mskit.generate(self.path(self.grain), "mss", spheres=3, cells=12)
        for path, words in [("c.nothing", "no clump format 'nothing'"), ("none/c.csv", "none"), ("c.lammps", "mass"),
                            ("none/c.html", "none")]:
            self.refused(mskit.Error, words, clump.write, self.path(path))
        self.refused(mskit.ArgumentError, "names no file", clump.write, "")
        self.refused(mskit.ArgumentError, "is no path", clump.write, 3)
        self.refused(mskit.ArgumentError, "cvs", clump.write, self.path("c"), "cvs")
        self.refused(mskit.FileError, "none.csv", mskit.read_clump, self.path("none.csv"))
        self.assertEqual(self.files(), [self.grain], "a refusal leaves no file")
        os.mkdir(self.path("c.frame.json"))
        self.refused(mskit.FileError, "c.frame.json: is a folder", mskit.correct(clump, density=1).write,
                     self.path("c.yade"))
        self.assertEqual(self.files(), ["c.frame.json", self.grain])

    def test_expected(self):
        opened = mskit.mesh(CORNERS, FACES[1:], allow_open=True)
        self.refused(mskit.ShapeError, "is open nothing can be expected", mskit.expect, opened)
        corners, faces = numpy.array(CORNERS), numpy.array(FACES)
        two = numpy.concatenate((corners, corners + 0.1)), numpy.concatenate((faces, faces + len(corners)))
        self.refused(mskit.ShapeError, "passes through itself", mskit.expect, two)
        expected = mskit.expect(mskit.body("ball", fineness=8))
        for values, words in [(0, "spheres=0 "), ([5, -1], "spheres=-1"), ("x", "spheres='x'"), (None, "spheres=None"),
                              ([[1], [2, 3]], "spheres=")]:
            self.refused(mskit.ArgumentError, words, expected.dice, values)
        self.refused(mskit.ArgumentError, "dice=0 ", expected.spheres, 0)
        self.refused(mskit.ArgumentError, "inscribed=1", expected.dice, 5, inscribed=1)

    def test_allocation(self):
        curves = [[0.5, 0.2], [0.4, 0.3, 0.1]]
        for arguments, options, words in [
                ((curves,), {}, "one of budget, mean_dice and knee"),
                ((curves,), {"budget": 9, "knee": 0.1}, "one of budget"),
                ((curves, [1]), {"budget": 9}, "not a number for each of 2"),
                ((curves, [1, 0]), {"budget": 9}, "particles=0"),
                ((curves, [1, 2.5]), {"budget": 9}, "whole number"), (([],), {"budget": 9}, "no list of curves"),
                ((3,), {"budget": 9}, "no list of curves"),
                ((numpy.array(3),), {"budget": 9}, "no list of curves"),
                ((curves, numpy.array(3)), {"budget": 9}, "not a number for each of 2"),
                (([[0.5], []],), {"budget": 9}, "curve 1 is no array"),
                (([[0.5, float("nan")]],), {"budget": 9}, "curve 0 is no array"), ((curves,), {"budget": 1}, "budget"),
                ((curves,), {"mean_dice": 0.01}, "the best templates reach a mean of 0.15"),
                ((curves,), {"mean_dice": 2}, "mean_dice=2"), ((curves,), {"knee": 0}, "knee=0"),
                ((curves,), {"knee": 0.01}, "curve 0: up to the last of 2 spheres")]:
            self.refused(mskit.Error, words, mskit.allocate, *arguments, **options)

    def test_masses_of_a_shape_or_a_union(self):
        clump = mskit.generate(self.path(self.grain), "mss", spheres=3, cells=12)
        for options, words in [({"properties": "both"}, "properties='both' is none of 'shape', 'union'"),
                               ({"properties": "union", "shape": self.path(self.grain)}, "either a shape or"),
                               ({"unit": "mm", "scale": 2}, "unit and scale exclude one another")]:
            self.refused(mskit.ArgumentError, words, mskit.correct, clump, density=1, **options)

    def test_contact(self):
        clump = mskit.generate(self.path(self.grain), "mss", spheres=3, cells=12)
        for options, words in [({"poses": 0}, "poses=0"), ({"overlap": 0.5}, "overlap=0.5"),
                               ({"overlap": []}, "overlap=[]"),
                               ({"overlap": [0.01] * 17}, "nor 1 to 16 of them"), ({"overlap": "x"}, "overlap='x'"),
                               ({"restitution": 0}, "restitution=0"), ({"seed": -1}, "seed=-1"),
                               ({"factors": 2}, "factors=2"), ({"envelope": 0}, "envelope=0.0 is not a number from"),
                               ({"envelope": [1] * 17}, "nor 1 to 16 of them"), ({"envelope": "x"}, "envelope='x'"),
                               ({"envelope": 1, "shape": mskit.volume(labelled(), label=3)}, "envelope takes a mesh"),
                               ({"shape": 3}, "is no shape"), ({"threads": 0}, "threads=0"),
                               ({"shape": mskit.mesh(CORNERS, FACES[1:], allow_open=True)}, "is not closed"),
                               ({"shape": mskit.mesh(numpy.array(CORNERS) * 1e-4, FACES)}, "check units and frame")]:
            self.refused(mskit.Error, words, mskit.contact, clump, **options)

    def test_no_sentence_names_a_flag(self):
        """Those of the library reach Python as they are."""
        self.refused(mskit.FormatError, "no label (0, 1, 2, ... up to 4294967295); make labels of grey values by a "
                     "threshold, or otsu,", mskit.volume, labelled() * 0.3)
        clump = mskit.generate(self.path(self.grain), "mss", spheres=3, cells=12)
        said = self.refused(mskit.LimitError, "carriers", mskit.correct, clump, density=1, carriers=True,
                            carrier_depth=0.9)
        self.assertNotIn("--", said)

    def test_bodies(self):
        for kind, parameters, words in [("bal", {}, "ball"), ("ball\0", {}, "no name"),
                                        ("ball", {"x": 1}, "no parameter 'x', but r, fineness"),
                                        ("ball", {"r": -1}, "r"), ("ball", {"r": "a"}, "r='a'"),
                                        (3, {}, "kind=3 is no name")]:
            self.refused(mskit.ArgumentError, words, mskit.body, kind, **parameters)

    def test_remarks_are_warnings(self):
        with self.assertWarnsRegex(mskit.Remark, "too coarse") as caught:
            mskit.generate(self.path(self.grain), "mss", spheres=2, cells=4)
        self.assertEqual(os.path.basename(caught.filename), "test_refusals.py")


if __name__ == "__main__":
    unittest.main()
