#!/usr/bin/env python3
"""Scripts of a whole scene, in the engines: all particles of the manifest, with masses and sizes, come to rest in it.

    MSKIT=build/eval/mskit tests/engines/test_scene.py [-v]
"""
import glob
import os
import re
import unittest

import test_engines as engines
from test_engines import numbers

SHAPES = {"grain": ("grain",), "tablet": ("tablet", "band_radius=1.2", "band_height=0.8", "cap_height=0.3"),
          "ring": ("torus", "R=1", "r=0.6"), "ball": ("ball",)}
VESSELS = {"box": ("--box", "8,7"), "cylinder": ("--cylinder", "8")}
SIZE = {"box": (4e-3, 3.5e-3), "cylinder": (4e-3, 4e-3)}  # half its width
FORMATS = ("--format", "liggghts", "--format", "lammps", "--format", "yade")
SHAPES_ALONE = {"grain": 4, "tablet": 3, "ring": 3}
SIZES = {"grain-2.2": 1, "grain-1.4": 4, "ball-1.8": 2}


class Scene(engines.Clump):
    """Particles by the names of their templates, SHAPE or SHAPE-SIZE, with a script for each vessel."""

    def __init__(self, folder, counts, vessels):
        self.top = self.folder = folder
        for name, shape in SHAPES.items():
            self.mskit("shape", *shape, "-o", name + ".stl")
        rows = [(*(name.split("-") + [""])[:2], count) for name, count in counts.items()]
        self.write("scene.csv", "shape,count,size\n" + "".join(f"{name}.stl,{n},{size}\n" for name, size, n in rows))
        for vessel in vessels:
            self.mskit("scene", "scene.csv", "--tolerance", "dice=0.15", "-g", "variational", "--cells", "30",
                       "--density", str(engines.DENSITY), "--unit", "mm", "--carriers", *VESSELS[vessel], *FORMATS,
                       "-o", vessel)
        self.particles = sum(counts.values())
        self.mass = self.spheres = self.single = 0
        for name, count in counts.items():
            spheres = sum(not line.startswith("#") for line in self.script(f"{vessels[0]}/{name}.yade").splitlines())
            mass = re.search(r" mass (\d\S+)", self.script(f"{vessels[0]}/{name}.liggghts.in")).group(1)
            self.mass += count * float(mass)
            self.spheres += count * spheres
            self.single += count * (spheres == 1)


class Engine(unittest.TestCase):
    program = None
    made = None  # once, for all engines

    @classmethod
    def setUpClass(cls):
        engines.need_program(cls.program)
        Engine.made = Engine.made or [Scene(engines.make_folder(), SHAPES_ALONE, list(VESSELS)),
                                      Scene(engines.make_folder(), SIZES, ["box"])]

    def setUp(self):
        self.scene = self.made[0]

    def run_script(self, vessel, *command):
        """What it says at the end, {word: numbers}, and the total energies from the first to the last."""
        self.scene.folder = os.path.join(self.scene.top, vessel)
        out = self.scene.run(*command)
        self.assertIn("scene: at rest", out)
        said = {line.split()[0]: [float(x) for x in re.findall(r"[-+]?\d[-+.e\d]*", line)]
                for line in re.findall(r"(?m)^scene: (.*)", out)}
        rows = [numbers(line) for line in re.findall(r"(?m)^ *\d+(?: +[-+.e\d]+){6,7} *$", out)]
        return said, [row[-4] for row in rows]

    def check(self, vessel, said, energies, spheres):
        """spheres: x, y, z, r of the dump."""
        self.assertEqual(said["particles"], [self.scene.particles] * 2)
        self.assertAlmostEqual(said["mass"][0] / self.scene.mass, 1, delta=1e-9)
        self.assertLess(said["at"][0], 1e-6)  # m g d
        self.assertGreater(len(energies), 20)
        for before, after in zip(energies, energies[1:]):
            self.assertLess(after, before + 0.02 * energies[0], "the energy grows")
        self.assertLess(energies[-1], 0.7 * energies[0])
        self.assertAlmostEqual(said["energy"][0] / energies[-1], 1, delta=1e-3)
        self.assertEqual(len(spheres), self.scene.spheres)
        x, y = SIZE[vessel]
        slack = 2e-5
        for s in spheres:
            self.assertGreater(s[2] - s[3], -slack, "below the floor")
            if vessel == "box":
                self.assertTrue(abs(s[0]) + s[3] < x + slack and abs(s[1]) + s[3] < y + slack, "through a wall")
            else:
                self.assertLess((s[0] ** 2 + s[1] ** 2) ** 0.5 + s[3], x + slack, "through the wall")
        self.assertAlmostEqual(said["height"][1], max(s[2] + s[3] for s in spheres), delta=1e-5)
        self.assertTrue(0 < said["height"][0] < said["height"][1] * 1.5)
        self.assertTrue(0.1 < said["packing"][0] < 1)

    def check_picture(self, pattern):
        """A VTK file of as many points as spheres."""
        found = [p for p in glob.glob(self.scene.path(pattern)) if "boundingBox" not in p]
        self.assertEqual(len(found), 1)
        with open(found[0], encoding="latin-1") as f:
            text = f.read()
        self.assertTrue(text.startswith("# vtk DataFile"))
        return int(re.search(r"POINTS (\d+)", text).group(1))

    def fail_script(self, *command):
        with self.assertRaisesRegex(AssertionError, "(?s)exit code 1.*scene: not all particles have room"):
            self.scene.run(*command)

    def rows(self, name):
        (rows,) = engines.read_dumps(self.scene.path(name)).values()
        return list(rows.values())

    def each_scene(self, check):
        """Three shapes in both vessels; shapes in sizes, one of them of a single sphere."""
        for number, vessel in ((0, "box"), (0, "cylinder"), (1, "box")):
            self.scene = self.made[number]
            with self.subTest(vessel=vessel, number=number):
                check(vessel)


class Liggghts(Engine):
    program = "liggghts"

    def test_rest(self):
        def check(vessel):
            said, energies = self.run_script(vessel, "liggghts", "-in", "scene.liggghts.in")
            rows = [row[1:] for row in self.rows("scene.liggghts.dump")]
            centres = {tuple(row[:3]): row for row in sorted(rows, key=lambda row: row[3])}  # the outer one of two
            self.check(vessel, said, energies, list(centres.values()))
            self.assertEqual(self.check_picture("scene.liggghts_*.vtk"), self.scene.spheres + self.scene.single)

        self.each_scene(check)
        self.assertGreater(self.scene.single, 0)

    def test_no_room(self):
        """A script that cannot insert all particles says so and ends."""
        self.scene.folder = os.path.join(self.scene.top, "box")
        crowded = re.sub(r"particles_in_region 10 ", "particles_in_region 400 ", self.scene.script("scene.liggghts.in"))
        self.scene.write("crowded.in", crowded)
        self.fail_script("liggghts", "-in", "crowded.in")

    def test_without_vtk(self):
        """A LIGGGHTS that was built without it ends at the pictures, when all else is there."""
        self.scene.folder = os.path.join(self.scene.top, "box")
        self.scene.write("bare.in", self.scene.script("scene.liggghts.in").replace("custom/vtk", "custom/none"))
        if os.path.exists(self.scene.path("scene.liggghts.dump")):
            os.remove(self.scene.path("scene.liggghts.dump"))
        with self.assertRaisesRegex(AssertionError, "(?s)scene: at rest.*scene: energy .*Invalid dump style"):
            self.scene.run("liggghts", "-in", "bare.in")
        self.assertGreaterEqual(len(self.rows("scene.liggghts.dump")), self.scene.spheres)

    def test_spin(self):
        """Drag on the centres of two spheres ends no spin about their line, which counts as rest."""
        self.scene.folder = self.scene.top
        self.scene.mskit("shape", "cube", "a=1", "-o", "cube.stl")
        self.scene.mskit("scene", "cube.stl", "--particles", "20", "--budget", "40", "-g", "mss", "--cells", "20",
                         "--density", str(engines.DENSITY), "--unit", "mm", "--format", "liggghts", "-o", "pairs")
        self.scene.folder = os.path.join(self.scene.top, "pairs")
        self.assertIn("scene: at rest, kinetic energy of a particle without spin",
                      self.scene.run("liggghts", "-in", "scene.liggghts.in"))


class Lammps(Engine):
    program = "lmp"

    def test_rest(self):
        def check(vessel):
            said, energies = self.run_script(vessel, "lmp", "-in", "scene.lammps.in")
            spheres = [row[2:] for row in self.rows("scene.lammps.dump") if row[1] == 1]
            self.check(vessel, said, energies, spheres)
            self.assertGreaterEqual(self.check_picture("scene.lammps.vtk"), self.scene.spheres)  # and the carriers

        self.each_scene(check)

    def test_no_room(self):
        self.scene.folder = os.path.join(self.scene.top, "box")
        self.scene.write("crowded.in", self.scene.script("scene.lammps.in").replace(" deposit 3 ", " deposit 400 "))
        self.fail_script("lmp", "-in", "crowded.in")

    def test_sizes(self):
        """Many small particles and a few large ones, of equal volume in all, have room beside each other."""
        self.scene.folder = self.scene.top
        for name, size in (("small", 1), ("large", 3)):
            self.scene.mskit("shape", "cube", f"a={size}", "-o", name + ".stl")
        self.scene.write("sizes.csv", "shape,count\nsmall.stl,540\nlarge.stl,20\n")
        self.scene.mskit("scene", "sizes.csv", "--tolerance", "dice=0.2", "-g", "mss", "--cells", "20", "--density",
                         str(engines.DENSITY), "--unit", "mm", "--format", "lammps", "-o", "sizes")
        self.scene.folder = os.path.join(self.scene.top, "sizes")
        insertion = self.scene.script("scene.lammps.in").partition("# They fall")[0]
        self.scene.write("insertion.in", insertion)
        self.assertNotIn("unsuccessful", self.scene.run("lmp", "-in", "insertion.in"))


class Yade(Engine):
    program = "yade"

    def test_rest(self):
        def check(vessel):
            said, energies = self.run_script(vessel, "yade", "-x", "-n", "-j1", "scene.yade.py")
            with open(self.scene.path("scene.yade.dump"), encoding="ascii") as f:
                spheres = [numbers(line)[2:] for line in f if not line.startswith("#")]
            self.check(vessel, said, energies, spheres)
            self.assertEqual(self.check_picture("scene.yade-*.vtk"), self.scene.spheres)

        self.each_scene(check)

    def test_no_room(self):
        self.scene.folder = os.path.join(self.scene.top, "box")
        self.scene.write("crowded.py", re.sub(r"(?m)^    \(4, ", "    (400, ", self.scene.script("scene.yade.py")))
        self.fail_script("yade", "-x", "-n", "-j1", "crowded.py")


if __name__ == "__main__":
    engines.skip_without_engines()
    unittest.main()
