"""Results are the program's, to the last bit: spheres, scores, curves, masses, whichever way the shape came in."""
import json
import pickle
import unittest

import mskit
import numpy
from support_python import PythonCase, labelled


class Same(PythonCase):
    def expect_same(self, clump, *command):
        """Its CSV is that of `mskit generate` or `correct`, byte for byte."""
        self.mskit(*command, "-o", "program.csv")
        clump.write(self.path("module.csv"))
        self.assertEqual(self.read("module.csv"), self.read("program.csv"), command)

    def test_every_method(self):
        for name in mskit.generators:
            clump = mskit.generate(self.path(self.grain), name, spheres=8, cells=20, seed=5)
            self.expect_same(clump, "generate", self.grain, "-g", name, "-n", 8, "--cells", 20, "--seed", 5)

    def test_defaults(self):
        self.expect_same(mskit.generate(self.path(self.grain), "mss"), "generate", self.grain, "-g", "mss")

    def test_options_and_stop_rules(self):
        path = self.path(self.grain)
        for options, flags in [
                ({"variant": "paper", "order": "gain", "cells": 20}, "--variant paper --order gain --cells 20"),
                ({"spacing": 1.25, "deq": 24}, "--spacing 1.25 --deq 24"),
                ({"plane": [(1, 0, 0, 0.25), (0, 0, 1, 1)], "voxel_size": 0.1},
                 "--plane 1,0,0,0.25 --plane 0,0,1,1 --voxel-size 0.1"),
                ({"until": {"dice": 0.08}, "max_voxels": 20000}, "--until dice=0.08 --max-voxels 20000"),
                ({"confine": True, "min_radius": 0.2, "rule": "centre", "cells": 25, "max_voxels": 1e6},
                 "--confine --min-radius 0.2 --rule centre --cells 25 --max-voxels 1M")]:
            self.expect_same(mskit.generate(path, "mss", **options), "generate", self.grain, "-g", "mss",
                             *flags.split())

    def test_cut_cells(self):
        clump = mskit.generate(self.path(self.grain), "setcover", until={"coverage_cut": 0.8}, cells=20)
        self.expect_same(clump, "generate", self.grain, "-g", "setcover", "--until", "coverage_cut=0.8", "--cells", 20)
        self.assertGreaterEqual(clump.scores["coverage_cut"], 0.8)
        self.assertEqual(clump.stopped_by, "coverage_cut")

    def test_start_from_a_clump(self):
        first = mskit.generate(self.path(self.grain), "mss", spheres=6, cells=20)
        first.write(self.path("first.csv"))
        for start in (first, self.path("first.csv")):
            clump = mskit.generate(self.path(self.grain), spheres=6, cells=20, refine=start)
            self.expect_same(clump, "generate", self.grain, "-n", 6, "--cells", 20, "--refine", "first.csv")

    def test_arrays_as_files(self):
        """Indexed triangles, a soup of them, strided and in other types: the same spheres as from the file."""
        shape = mskit.read(self.path(self.grain))
        corners, faces = shape.vertices, shape.faces
        soup = corners[faces].reshape(-1, 3)
        wide = numpy.repeat(corners, 2, axis=1)[:, ::2]
        self.assertFalse(wide.flags.c_contiguous)
        for vertices, triangles in [(corners, faces), (soup, numpy.arange(len(soup)).reshape(-1, 3)),
                                    (wide, faces.astype(">i8")), (numpy.asfortranarray(corners), faces.tolist()),
                                    (corners.astype(numpy.longdouble), faces.astype(numpy.uint16))]:
            clump = mskit.generate((vertices, triangles), "mss", spheres=5, cells=20)
            self.expect_same(clump, "generate", self.grain, "-g", "mss", "-n", 5, "--cells", 20)

    def test_object_with_vertices_and_faces(self):
        class Other:
            vertices, faces = mskit.body("torus", fineness=6).vertices, mskit.body("torus", fineness=6).faces

        self.shape("torus", "fineness=6", name="torus.ply")
        clump = mskit.generate(Other(), "mss", spheres=5, cells=12)
        self.expect_same(clump, "generate", "torus.ply", "-g", "mss", "-n", 5, "--cells", 12)

    def test_volumes(self):
        labels = labelled()
        numpy.save(self.path("v.npy"), labels)
        flags = ("generate", "v.npy", "-g", "mss", "-n", 4, "--label", 8)
        for array in (labels, labels.astype(">i4"), labels.astype(float), numpy.asfortranarray(labels),
                      numpy.repeat(labels, 2, axis=2)[:, :, ::2]):
            self.expect_same(mskit.generate(mskit.volume(array, label=8), "mss", spheres=4), *flags)
        self.expect_same(mskit.generate(mskit.read(self.path("v.npy"), label=8), "mss", spheres=4), *flags)

    def test_unequal_spacing_and_threshold(self):
        grey = labelled() * 0.5
        numpy.save(self.path("g.npy"), grey)
        shape = mskit.volume(grey, spacing=(3, 1.5, 1), threshold=2, label=1)
        self.expect_same(mskit.generate(shape, "mss", spheres=3), "generate", "g.npy", "-g", "mss", "-n", 3,
                         "--label", 1, "--threshold", 2, "--voxel-spacing", "1,1.5,3")

    def test_grains(self):
        labels = labelled()
        numpy.save(self.path("v.npy"), labels)
        found = list(mskit.grains(labels, spacing=0.5))
        self.assertEqual([(g.label, g.voxels, g.cut) for g in found],
                         [(k, int((labels == k).sum()), k == 8) for k in (3, 8)])
        for grain in found:
            self.expect_same(mskit.generate(grain, "mss", spheres=3), "generate", "v.npy", "-g", "mss", "-n", 3,
                             "--label", grain.label, "--voxel-spacing", "0.5,0.5,0.5")
        self.assertEqual([g.label for g in mskit.grains(self.path("v.npy"), border=False)], [3])
        self.assertEqual(list(mskit.grains(labels, min_voxels=10**6)), [])

    def test_scores(self):
        clump = mskit.generate(self.path(self.grain), "mss", spheres=7, cells=20)
        clump.write(self.path("c.csv"))
        told = self.mskit("score", "c.csv", "--target", self.grain, "--cells", 20, "--cut", "--json").json["scores"]
        mine = mskit.score(clump, cut=True)
        self.assertEqual({k: v for k, v in clump.scores.items() if k != "coverage_cut"},
                         {k: v for k, v in mine.items() if k != "coverage_cut"})
        self.assertEqual(mine, mskit.score(self.path("c.csv"), self.path(self.grain), cells=20, cut=True))
        told["inertia"] = told["inertia_error"]["weighted_mean"]
        for name, value in mine.items():
            self.assertEqual(None if value != value else value, told[name], name)
        self.assertEqual(set(mine), {"spheres", *mskit.measures})
        coarse = mskit.score(clump, cells=12)
        self.assertNotEqual(coarse["dice"], mine["dice"])

    def test_curves(self):
        for name in ("mss", "variational"):
            clump = mskit.generate(self.path(self.grain), name, spheres=4, cells=20)
            self.mskit("generate", self.grain, "-g", name, "-n", 4, "--cells", 20, "--curve", "curve.csv",
                       "-o", "c.csv")
            rows = self.rows_of_curve(self.read("curve.csv").decode())
            curve = mskit.curve(clump)
            self.assertEqual(curve["spheres"].tolist(), [1, 2, 3, 4])
            for column in set(rows[0]) - {"n"}:
                self.assertEqual([float(f"{value:.8g}") for value in curve[column]], [row[column] for row in rows],
                                 column)

    def test_masses(self):
        clump = mskit.generate(self.path(self.grain), "mss", spheres=12, cells=20)
        clump.write(self.path("c.csv"))
        common = ("correct", "c.csv", "--target", self.grain, "--density", 2650, "--unit", "mm")
        self.expect_same(mskit.correct(clump, density=2650, unit="mm"), *common)
        heavy = mskit.correct(clump[:6], density=2650, scale=0.001, axes="input", least_mass=0.01)
        clump[:6].write(self.path("c.csv"))
        self.expect_same(heavy, *common, "--axes", "input", "--least-mass", 0.01)
        self.expect_same(mskit.correct(self.path("c.csv"), density=2650, unit="mm", properties="union"), "correct",
                         "c.csv", "--density", 2650, "--unit", "mm", "--properties", "union")
        self.assertAlmostEqual(heavy.masses.sum() / heavy.particle.mass, 1, delta=1e-12)
        self.assertAlmostEqual(heavy.particle.mass / (2650e-9 * clump.shape.volume), 1, delta=1e-12)

    def test_carriers_and_templates(self):
        clump = mskit.generate(self.path(self.grain), "mss", spheres=6, cells=20)
        clump.write(self.path("c.csv"))
        heavy = mskit.correct(clump, density=2650, carriers=True)
        self.mskit("correct", "c.csv", "--target", self.grain, "--density", 2650, "--carriers", "-o", "p.lammps")
        heavy.write(self.path("m.lammps"))
        self.assertEqual(self.read("m.lammps"), self.read("p.lammps"))
        self.assertGreater(len(heavy.carriers), 0)
        total = heavy.masses.sum() + heavy.carriers.masses.sum()
        self.assertAlmostEqual(total / heavy.particle.mass, 1, delta=1e-9)
        heavy.write(self.path("m.json"))
        again = mskit.read_clump(self.path("m.json"))
        self.assertTrue((again.carriers.spheres == heavy.carriers.spheres).all())
        self.assertTrue((again.masses == heavy.masses).all())

    def test_equal_volume(self):
        for method, options in (("mss", {}), ("variational", {"hold_volume": True})):
            clump = mskit.generate(self.path(self.grain), method, spheres=6, cells=20, **options)
            self.expect_same(mskit.equal_volume(clump), "generate", self.grain, "-g", method, "-n", 6, "--cells", 20,
                             "--equal-volume")

    def test_equal_volume_by_far_is_said(self):
        far = mskit.Clump([(0, 0, 0)], [0.5])
        with self.assertWarnsRegex(mskit.Remark, "^the spheres held 12[.]5 % of .*; scaled by 2 they lie"):
            scaled = mskit.equal_volume(far, mskit.body("ball", r=1, fineness=200))
        self.assertAlmostEqual(scaled.radii[0], 1, delta=1e-3)

    def test_expected(self):
        numpy.save(self.path("v.npy"), labelled())
        for shape, flags in ((mskit.read(self.path(self.grain)), (self.grain,)),
                             (mskit.volume(labelled(), label=3), ("v.npy", "--label", 3))):
            told = self.mskit("info", *flags, "--expect", "--json").json["expected"]
            expected = mskit.expect(shape)
            for kind, inscribed in (("free", False), ("inscribed", True)):
                for given, found in (("spheres", expected.dice), ("dice", expected.spheres)):
                    rows = told["dice" if given == "spheres" else "spheres"]
                    self.assertEqual(found([row[given] for row in rows], inscribed=inscribed).tolist(),
                                     [row[kind] for row in rows])
                self.assertEqual(expected.least_spheres(inscribed=inscribed), told["least_spheres"][kind])
            self.assertEqual(told["range"], [1 / expected.range, expected.range])
            self.assertEqual(expected.dice(7.5), pickle.loads(pickle.dumps(expected)).dice(7.5))
            self.assertEqual(expected.dice(numpy.array([[2, 3]])).shape, (1, 2))

    def test_allocation(self):
        """By the program's curves, and by those of the module's own clumps, the numbers that scene chooses."""
        self.shape("torus", "fineness=6", name="torus.ply")
        self.write("scene.csv", f"shape,count\n{self.grain},300\ntorus.ply,20\n")
        clumps = [mskit.generate(self.path(name), "mss", spheres=9, cells=15) for name in (self.grain, "torus.ply")]
        for goal, flags in [({"budget": 2000}, ("--budget", 2000)),
                            ({"mean_dice": 0.11}, ("--mean-tolerance", "dice=0.11")),
                            ({"knee": 0.3}, ("--knee", 0.3))]:
            told = self.mskit("scene", "scene.csv", *flags, "-g", "mss", "--cells", 15, "--max-spheres", 9,
                              "--json").json
            for curves in ([shape["curve"] for shape in told["shapes"]],
                           [mskit.curve(clump)["dice"] for clump in clumps]):
                found = mskit.allocate(curves, [300, 20], **goal)
                self.assertEqual(found.spheres.tolist(), [shape["scores"]["spheres"] for shape in told["shapes"]])
                self.assertEqual((found.total, found.mean_dice, found.least_gain),
                                 (told["spheres"], told["mean_dice"], told["least_gain"]))
                self.assertEqual(found.slack, told["slack"] or 0)

    def plain(self, value):
        """As JSON has it."""
        if isinstance(value, dict):
            return {key: [[n, part] for n, part in each.items()] if key == "counts" else self.plain(each)
                    for key, each in value.items()}
        if isinstance(value, (list, numpy.ndarray)):
            return [self.plain(each) for each in value]
        return None if isinstance(value, float) and not numpy.isfinite(value) else value

    def test_contact(self):
        """Of a mesh, of a volume, of the particle that a file knows, and of the spheres alone."""
        numpy.save(self.path("v.npy"), labelled())
        clump = mskit.generate(self.path(self.grain), "mss", spheres=6, cells=20)
        clump.write(self.path("c.csv"))
        self.shape("cube", "a=2", "fineness=1", name="cube.stl")
        cube = mskit.read(self.path("cube.stl"))
        in_voxels = mskit.generate(mskit.volume(labelled(), label=3), "mss", spheres=3)
        in_voxels.write(self.path("v.csv"))
        mskit.correct(clump, density=2650, unit="mm").write(self.path("m.json"))
        for found, flags in [
                (mskit.contact(clump, poses=20, overlap=0.001, factors=True, restitution=0.7, seed=3),
                 ("c.csv", "--target", self.grain, "--overlap", 0.001, "--factors", "--restitution", 0.7, "--seed", 3)),
                (mskit.contact(in_voxels, poses=20), ("v.csv", "--target", "v.npy", "--label", 3)),
                (mskit.contact(self.path("m.json"), poses=20, threads=1), ("m.json",)),
                (mskit.contact(clump.spheres, poses=20, overlap=[0.002, 0.1]), ("c.csv", "--overlap", "0.002,0.1")),
                (mskit.contact(clump.spheres, poses=20, overlap=0.01, envelope=0.3),
                 ("c.csv", "--overlap", 0.01, "--envelope", 0.3)),
                (mskit.contact(clump, cube, poses=20, overlap=0.01, envelope=[0.1, 2]),
                 ("c.csv", "--target", "cube.stl", "--overlap", 0.01, "--envelope", "0.1,2"))]:
            told = self.mskit("contact", *flags, "--poses", 20, "--json").json
            for name in ("path", "target", "spheres", "orientations", "single_restitution", "seed"):
                del told[name]
            self.assertEqual(self.plain(found), told, flags)

    def test_shapes_from_another_process(self):
        """A pickled shape has the same voxels and gives the same spheres, masses and contacts."""
        for shape in (mskit.read(self.path(self.grain)), mskit.volume(labelled(), label=8, spacing=0.5),
                      mskit.mesh(mskit.body("torus").vertices, mskit.body("torus").faces[3:], allow_open=True)):
            again = pickle.loads(pickle.dumps(shape))
            self.assertEqual((again.name, again.report, again.label, again.voxels, again.cut, repr(again)),
                             (shape.name, shape.report, shape.label, shape.voxels, shape.cut, repr(shape)))
            grid = {"cells": 20} if shape.is_mesh else {}
            one, other = (mskit.generate(each, "mss", spheres=4, **grid) for each in (shape, again))
            self.assertEqual(one.spheres.tobytes(), other.spheres.tobytes())
            self.assertEqual(repr(one.scores), repr(other.scores))
            self.assertEqual(one.shape.c_body(one.run.grid).volume, other.shape.c_body(other.run.grid).volume)
            for a, b in zip(again.surface(), shape.surface()):
                self.assertEqual(a.tobytes(), b.tobytes())

    def test_tables_are_those_of_the_program(self):
        for name, generator in mskit.generators.items():
            about = self.mskit("help", name, "--json").json
            self.assertEqual((about["name"], about["summary"], about["source"]), generator[:3])
            told = [option["name"].replace("-", "_") for option in about["options"]]
            self.assertEqual(told, list(generator.options))
            for option in about["options"]:
                self.assertEqual(option["help"], generator.options[option["name"].replace("-", "_")].help)
        kinds = self.mskit("shape", "--list", "--json").json
        for kind in kinds:
            self.assertGreater(mskit.body(kind["name"]).volume, 0)

    def test_record_stands_in_the_file(self):
        mskit.generate(self.path(self.grain), "mss", spheres=2, cells=12, spacing=2.5).write(self.path("c.json"))
        self.assertIn('"spacing": 2.5', json.dumps(json.loads(self.read("c.json"))))


if __name__ == "__main__":
    unittest.main()
