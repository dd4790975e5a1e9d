#!/usr/bin/env python3
"""Fifty particles fall into a box and come to rest, in the engines, by the scripts as mskit writes them.

    MSKIT=build/eval/mskit tests/engines/test_packing.py [-v]

It takes minutes; `meson test` leaves it out, `meson test --suite packing` runs it.
"""
import math
import os
import re
import shutil
import unittest

import test_engines as engines
from test_engines import dot, numbers

COUNT = 50
GRAVITY = 9.81


class Clump(engines.Clump):
    def __init__(self, folder):
        self.folder = folder
        self.mskit("shape", "grain", "-o", "c.stl")
        self.mskit("generate", "c.stl", "-g", "setcover", "-n", "15", "--cells", "40", "--correct", "--density",
                   str(engines.DENSITY), "--unit", "mm", *engines.TEMPLATES)
        self.read()


class Packing(unittest.TestCase):
    def setUp(self):
        program = self.id().rsplit("_", 1)[1]
        if not shutil.which(program):
            self.skipTest(f"{program} is not installed")
        self.clump = Clump(engines.make_folder())

    def check(self, spheres):
        """spheres: x, y, z, r, vx, vy, vz, particle by particle."""
        clump, reach = self.clump, self.clump.reach
        self.assertEqual(len(spheres), COUNT * len(clump.spheres), "particles are missing")
        lows = [min(s[2] - s[3] for s in spheres)] + [4 * reach - max(abs(s[k]) + s[3] for s in spheres)
                                                      for k in (0, 1)]
        speeds = sorted(dot(s[4:], s[4:]) / (GRAVITY * reach) for s in spheres)
        depth = self.deepest(spheres)
        if os.environ.get("MSKIT_VERBOSE"):
            print(self.id(), "walls", [low / reach for low in lows], "between", depth / reach,
                  "v2 over g reach: mean", sum(speeds) / len(speeds), "median", speeds[len(speeds) // 2], "most",
                  speeds[-1])
        for low in lows:
            self.assertGreater(low, -0.01 * reach, "through a wall")
        self.assertLess(depth, 0.01 * reach, "particles in each other")
        self.assertLess(speeds[len(speeds) // 2], 1e-5, "not at rest")
        self.assertLess(sum(speeds) / len(speeds), 1e-3, "not all at rest")
        self.assertLess(max(s[2] for s in spheres), 6 * reach, "has not fallen")
        i, j, k = clump.three
        for first in range(0, len(spheres), len(clump.spheres)):
            for a, b in ((i, j), (j, k), (k, i)):
                self.assertAlmostEqual(math.dist(spheres[first + a][:3], spheres[first + b][:3]),
                                       math.dist(clump.spheres[a][:3], clump.spheres[b][:3]), delta=1e-5 * reach)

    def deepest(self, spheres):
        """Largest overlap of spheres of two particles."""
        n = len(self.clump.spheres)
        return max(a[3] + b[3] - math.dist(a[:3], b[:3]) for i, a in enumerate(spheres)
                   for b in spheres[(i // n + 1) * n:])

    def read_end(self):
        (rows,) = engines.read_dumps(self.clump.path("end.txt")).values()
        return [rows[i] for i in sorted(rows)]

    def test_liggghts(self):
        self.clump.write("pack.in", self.clump.script("c.liggghts.in") +
                         "write_dump all custom end.txt id x y z radius vx vy vz\n")
        self.clump.run("liggghts", "-in", "pack.in", "-var", "n", str(COUNT))
        self.check(self.read_end())

    def test_lmp(self):
        self.clump.write("pack.in", self.clump.script("c.lammps.in") +
                         "write_dump all custom end.txt id x y z radius vx vy vz\n")
        self.clump.run("lmp", "-in", "pack.in", "-var", "n", str(COUNT))
        self.check(self.read_end())

    def test_yade(self):
        self.clump.write("pack.py", self.clump.script("c.yade.py") + f"""
for clump in clumps:
    body = O.bodies[clump]
    for i in sorted(body.shape.members)[:{len(self.clump.spheres)}]:
        state = O.bodies[i].state
        print('SPHERE', *state.pos, O.bodies[i].shape.radius, *body.state.vel)
""")
        out = self.clump.run("yade", "-x", "-n", "pack.py", str(COUNT), timeout=3000)
        self.check([numbers(line) for line in re.findall(r"(?m)^SPHERE (.*)", out)])


if __name__ == "__main__":
    engines.skip_without_engines()
    unittest.main()
