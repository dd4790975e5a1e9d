#!/usr/bin/env python3
"""The packing of an assembly, in the engines: every sphere where the scan has it, mass and inertia of each body, and
the scripts bring it to rest.

    MSKIT=build/eval/mskit tests/engines/test_assembly.py [-v]
"""
import csv
import math
import os
import re
import struct
import unittest

import test_engines as engines
from test_engines import apply, numbers, rotation, times, transpose

SIZE = (30, 26, 24)
MM = 1e-3
# Centre, half edges, quaternion of boxes in a volume: they do not touch, nor do spheres inscribed in them.
BOXES = {3: ((8, 9, 9), (6, 4, 3), (0.8, 0.4, -0.4, 0.2)), 5: ((20, 14, 12), (5, 3.4, 6), (0.9, -0.1, 0.4, -0.141421)),
         6: ((9, 19, 17), (4, 3, 5), (0.1, 0.7, 0.1, 0.7))}


def volume():
    labels = []
    for at in ((i, j, k) for k in range(SIZE[2]) for j in range(SIZE[1]) for i in range(SIZE[0])):
        label = 0
        for name, (centre, half, turn) in BOXES.items():
            own = apply(transpose(rotation(turn)), [x - c for x, c in zip(at, centre)])
            label = name if all(abs(x) <= h for x, h in zip(own, half)) else label
        labels.append(label)
    head = f"{{'descr': '<u1', 'fortran_order': False, 'shape': {SIZE[::-1]}, }}".encode()
    head += b" " * (-(len(head) + 11) % 64) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head + bytes(labels)


class Assembly(engines.Clump):
    """A packing, in a folder of its own."""

    def __init__(self, folder):
        self.folder = folder
        with open(self.path("scan.npy"), "wb") as f:
            f.write(volume())
        self.mskit("grains", "scan.npy", "-g", "mss", "--variant", "paper", "-n", "12",
                   "--density", str(engines.DENSITY), "--unit", "mm",
                   "--format", "csv", "--format", "liggghts", "--format", "lammps", "--format", "yade", "--assembly",
                   "--most-overlap", "1", "-o", "out")
        self.folder = os.path.join(folder, "out")
        with open(self.path("grains.csv"), encoding="ascii") as f:
            self.rows = list(csv.DictReader(f))
        self.spheres = []
        for row in self.rows:
            with open(self.path(row["file"]), encoding="ascii") as f:
                clump = [[float(s[c]) * MM for c in "xyzr"] for s in csv.DictReader(f)]
            self.spheres.append(clump)
        self.masses = [float(row["mass"]) for row in self.rows]
        self.smallest = min(s[3] for clump in self.spheres for s in clump)

    def inertia(self, row):
        """Along the axes of the packing."""
        turn = rotation([float(row["quaternion_" + c]) for c in "wxyz"])
        moments = [[float(row[f"moment_{m + 1}"]) * (m == n) for m in range(3)] for n in range(3)]
        return times(times(turn, moments), transpose(turn))


ROWS_AT_END = "write_dump all custom end.txt id x y z radius vx vy vz\n"


class Engine(unittest.TestCase):
    program = None

    @classmethod
    def setUpClass(cls):
        engines.need_program(cls.program)
        cls.assembly = Assembly(engines.make_folder())

    def check_places(self, spheres):
        """spheres: x, y, z, r in the order of the bodies."""
        truth = [s for clump in self.assembly.spheres for s in clump]
        self.assertEqual(len(spheres), len(truth))
        for got, s in zip(spheres, truth):
            self.assertLess(math.dist(got[:3], s[:3]), 1e-8 * self.assembly.smallest, "place")
            self.assertAlmostEqual(got[3] / s[3], 1, delta=1e-12)

    def check_at_rest(self, spheres):
        """In the box and without much of the energy of their fall; spheres: x, y, z, r, speed."""
        truth = [s for clump in self.assembly.spheres for s in clump]
        self.assertEqual(len(spheres), len(truth))
        lows = [min(s[k] - s[3] for s in truth) for k in range(3)]
        highs = [max(s[k] + s[3] for s in truth) for k in range(3)]
        fallen = 0
        for got, s in zip(spheres, truth):
            fallen += s[2] - got[2]
            for k in range(3):
                self.assertGreater(got[k] - got[3], lows[k] - 0.05 * self.assembly.smallest)
                self.assertLess(got[k] + got[3], highs[k] + 0.05 * self.assembly.smallest)
            self.assertLess(got[4], 0.01 * math.sqrt(2 * 9.81 * (highs[2] - lows[2])), "speed, of a fall through all")
        self.assertGreater(fallen, 0, "gravity acts")

    def read_dump(self, name):
        (rows,) = engines.read_dumps(self.assembly.path(name)).values()
        return [rows[i] for i in sorted(rows)]

    def read_end(self):
        """Of a dump of ROWS_AT_END."""
        return [[*row[:4], math.hypot(*row[4:])] for row in self.read_dump("end.txt")]


class Liggghts(Engine):
    program = "liggghts"

    def test_places_and_settling(self):
        script = self.assembly.script("assembly.liggghts.in")
        dump = 'dump d all custom 1 {0} id x y z radius mass\ndump_modify d format "%d %.17g %.17g %.17g %.17g %.17g"\n'
        # Of the first step, in which they are inserted.
        self.assembly.write("load.in", script.replace("run ${loosen}", dump.format("load.txt") + "run 1\nundump d")
                            + ROWS_AT_END)
        self.assembly.run("liggghts", "-in", "load.in")
        spheres = engines.read_dumps(self.assembly.path("load.txt"))[1]
        spheres = [spheres[i] for i in sorted(spheres)]
        self.check_places(spheres)
        self.assertEqual([s[4] for s in spheres],
                         [mass for mass, clump in zip(self.assembly.masses, self.assembly.spheres) for _ in clump])
        self.check_at_rest(self.read_end())
        log = self.assembly.script("log.liggghts")
        for row in self.assembly.rows:
            moments = ", ".join(f"{float(row[f'moment_{m}']):.6e}" for m in (1, 2, 3))
            self.assertIn("Principal moments of inertia_: " + moments, log)


class Lammps(Engine):
    program = "lmp"

    def test_places_and_settling(self):
        script = self.assembly.script("assembly.lammps.in")
        columns = "mass x y z inertiax inertiay inertiaz quatw quati quatj quatk"
        count = len(columns.split())
        load = ("compute bodies all rigid/local move " + columns + "\ndump b all local 1 bodies.txt "
                + " ".join(f"c_bodies[{k + 1}]" for k in range(count))
                + '\ndump_modify b format line "' + " ".join(["%.17g"] * count) + '"\n'
                'dump d all custom 1 load.txt id x y z radius\ndump_modify d format line "%d %.17g %.17g %.17g %.17g"\n'
                "run 0\nundump d\nundump b\nuncompute bodies")
        self.assembly.write("load.in", script.replace("run ${loosen}", load)
                            + ROWS_AT_END)
        self.assembly.run("lmp", "-in", "load.in")
        self.check_places(self.read_dump("load.txt"))
        with open(self.assembly.path("bodies.txt"), encoding="ascii") as f:
            bodies = [numbers(line) for line in f.read().splitlines()[9:]]
        self.assertEqual(len(bodies), len(self.assembly.rows))
        for body, row in zip(bodies, self.assembly.rows):
            self.assertEqual(body[0], float(row["mass"]))
            turn = rotation(body[7:])
            moments = [[body[4 + m] * (m == n) for m in range(3)] for n in range(3)]
            got, truth = times(times(turn, moments), transpose(turn)), self.assembly.inertia(row)
            scale = max(body[4:7])
            for a in range(3):
                for b in range(3):
                    self.assertLess(abs(got[a][b] - truth[a][b]), 1e-9 * scale, "inertia along the axes of the scan")
        self.check_at_rest(self.read_end())


class Yade(Engine):
    program = "yade"

    def test_places_and_settling(self):
        script = self.assembly.script("assembly.yade.py")
        show = """
def show(word):
    for clump in clumps:
        body = O.bodies[clump]
        print(word + 'BODY', body.state.mass, *body.state.inertia)
        for i in sorted(body.shape.members)[:-4]:
            print(word, *O.bodies[i].state.pos, O.bodies[i].shape.radius, O.bodies[i].state.vel.norm())


"""
        load = show + "O.run(1, True)\nshow('LOAD')\n# Those that"
        self.assembly.write("load.py", script.replace("# Those that", load) + "show('END')\n")
        out = self.assembly.run("yade", "-x", "-n", "load.py", "20")
        self.check_places([numbers(line) for line in re.findall(r"(?m)^LOAD (.*)", out)])
        bodies = [numbers(line) for line in re.findall(r"(?m)^LOADBODY (.*)", out)]
        self.assertEqual([body[0] for body in bodies], self.assembly.masses)
        for body, row in zip(bodies, self.assembly.rows):
            self.assertEqual(body[1:], [float(row[f"moment_{m}"]) for m in (1, 2, 3)])
        self.check_at_rest([numbers(line) for line in re.findall(r"(?m)^END (.*)", out)])


if __name__ == "__main__":
    engines.skip_without_engines()
    unittest.main()
