#!/usr/bin/env python3
"""The mixture of a library, in the engines: each body is one of its kinds, in one of its sizes, with mass and inertia.

    MSKIT=build/eval/mskit tests/engines/test_mixture.py [-v]
"""
import csv
import itertools
import os
import re
import unittest

import test_assembly as assembly
import test_engines as engines
from test_engines import numbers

PARTICLES = 12


class Mixture(engines.Clump):
    """A library of two of three grains in two sizes, in a folder of its own."""

    def __init__(self, folder):
        self.folder = folder
        with open(self.path("scan.npy"), "wb") as f:
            f.write(assembly.volume())
        self.mskit("grains", "scan.npy", "-g", "mss", "--variant", "paper", "-n", "6",
                   "--density", str(engines.DENSITY), "--unit", "mm", "--format", "csv", "--format", "liggghts",
                   "--format", "lammps", "--format", "yade", "-o", "all")
        self.mskit("grains", "--choose", "2", "--classes", "2", "all", "-o", "few")
        grains = {row["file"]: row for row in self.read("all/grains.csv")}
        self.kinds = []
        for chosen, size in itertools.product(self.read("few/library.csv"), self.read("few/sizes.csv")):
            grain = grains[chosen["file"]]
            scale = float(size["diameter"]) / float(grain["shape_equivalent_diameter"])
            if float(chosen["number"]) > 0:
                self.kinds.append({
                    "share": float(chosen["number"]) * float(size["number"]), "scale": scale,
                    "mass": float(grain["mass"]) * scale ** 3,
                    "inertia": [float(grain[f"moment_{m}"]) * scale ** 5 for m in (1, 2, 3)]})
        self.folder = os.path.join(folder, "few")

    def read(self, name):
        with open(self.path(name), encoding="ascii") as f:
            return list(csv.DictReader(f))


class Engine(unittest.TestCase):
    program = None

    @classmethod
    def setUpClass(cls):
        engines.need_program(cls.program)
        cls.mixture = Mixture(engines.make_folder())

    def check_bodies(self, bodies, digits=9):
        """bodies: mass and, if the engine tells them, the moments. All there, each of a kind, of more than one."""
        self.assertEqual(len(bodies), PARTICLES)
        seen = set()
        for body in bodies:
            found = [k for k, kind in enumerate(self.mixture.kinds)
                     if all(abs(got / truth - 1) < 10 ** -digits
                            for got, truth in zip([body[0], *sorted(body[1:])], [kind["mass"], *kind["inertia"]]))]
            self.assertTrue(found, f"no kind is like {body}")
            seen.update(found)
        self.assertGreater(len(seen), 1)


class Liggghts(Engine):
    program = "liggghts"

    def test_bodies(self):
        script = self.mixture.script("library.liggghts.in").replace("run ${steps}", "run 500")
        self.mixture.write("short.in", script + "write_dump all custom end.txt id mass\n")
        out = self.mixture.run("liggghts", "-in", "short.in", "-var", "n", str(PARTICLES))
        self.assertIn(f"inserted {PARTICLES} particle templates", out)
        (atoms,) = engines.read_dumps(self.mixture.path("end.txt")).values()
        spheres = 6
        self.assertEqual(len(atoms), PARTICLES * spheres)  # of each the mass of its body
        masses = [atoms[i][-1] for i in sorted(atoms)]
        self.check_bodies([[mass] for mass in masses[::spheres]], digits=5)


class Lammps(Engine):
    program = "lmp"

    def test_bodies(self):
        script = self.mixture.script("library.lammps.in")
        steps = int(re.search(r"(?m)^variable steps equal ceil\((\d+)", script).group(1))
        dump = ("compute bodies all rigid/local move mass inertiax inertiay inertiaz\n"
                "dump b all local 1 bodies.txt c_bodies[1] c_bodies[2] c_bodies[3] c_bodies[4]\n"
                'dump_modify b format line "%.17g %.17g %.17g %.17g"\nrun 0\n')
        self.mixture.write("short.in", script + dump)
        self.mixture.run("lmp", "-in", "short.in", "-var", "n", str(PARTICLES))
        self.assertGreater(steps, 0)
        with open(self.mixture.path("bodies.txt"), encoding="ascii") as f:
            self.check_bodies([numbers(line) for line in f.read().splitlines()[9:]])


class Yade(Engine):
    program = "yade"

    def test_bodies(self):
        script = re.sub(r"O\.run\(.*, True\)", "O.run(20, True)", self.mixture.script("library.yade.py"))
        show = ("for clump in clumps:\n    body = O.bodies[clump]\n"
                "    print('BODY', body.state.mass, *body.state.inertia)\n")
        self.mixture.write("short.py", script + show)
        out = self.mixture.run("yade", "-x", "-n", "short.py", str(PARTICLES))
        self.check_bodies([numbers(line) for line in re.findall(r"(?m)^BODY (.*)", out)])

    def test_shares(self):
        with open(self.mixture.path("library.yade"), encoding="ascii") as f:
            kinds = [numbers(line.rsplit(" ", 1)[0]) for line in f if not line.startswith("#")]
        self.assertEqual(len(kinds), len(self.mixture.kinds))
        self.assertAlmostEqual(sum(kind[0] for kind in kinds), 1, delta=1e-12)
        for got, truth in zip(kinds, self.mixture.kinds):
            for value, right in zip(got, [truth["share"], truth["scale"], truth["mass"], *truth["inertia"]]):
                self.assertAlmostEqual(value / right, 1, delta=1e-9)


if __name__ == "__main__":
    engines.skip_without_engines()
    unittest.main()
