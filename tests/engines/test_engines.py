#!/usr/bin/env python3
"""The engines as judges: they load the templates, and the particles move as the true ones would.

    MSKIT=build/eval/mskit TUMBLE=build/tests/engines/tumble tests/engines/test_engines.py [-v]

Every engine that is not installed is skipped. A free, tumbling body is held against Euler's equations, which `tumble`
solves by GSL; the orientation is that of the engine's spheres, so that spheres and inertia must belong together.
"""
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

MSKIT = os.environ.get("MSKIT", "mskit")
TUMBLE = os.environ.get("TUMBLE", "tumble")
DENSITY = 2650
STEPS = 100000
TEMPLATES = ("-o", "c.liggghts", "-o", "c.lammps", "-o", "c.yade", "-o", "c.json")
SAMPLES = 10
TURNS = 5
STEP = TURNS * 2 * math.pi / STEPS  # angle of a step, radians
# shape, its parameters, its unit, spheres
CLUMPS = {"grain": ("grain", (), "mm", 60), "flat": ("tablet", (), "m", 60),
          "long": ("ellipsoid", ("a=4", "b=1.3", "c=1"), "um", 40)}


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(dot(a, a))
    return [x / length for x in a]


def apply(m, v):
    return [dot(row, v) for row in m]


def transpose(m):
    return [list(column) for column in zip(*m)]


def times(a, b):
    return [[dot(row, column) for column in zip(*b)] for row in a]


def rotation(q):
    w, x, y, z = q
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


def frame(three):
    """Columns: an orthonormal frame on three points."""
    a = unit(sub(three[1], three[0]))
    c = unit(cross(a, sub(three[2], three[0])))
    return transpose([a, cross(c, a), c])


def angle(a, b):
    """Between two orientations."""
    difference = times(a, transpose(b))
    off = [difference[2][1] - difference[1][2], difference[0][2] - difference[2][0],
           difference[1][0] - difference[0][1]]
    trace = difference[0][0] + difference[1][1] + difference[2][2]
    return math.atan2(math.sqrt(dot(off, off)), trace - 1)


def numbers(line):
    return [float(word) for word in line.split()]


def read_dumps(path):
    """{step: {id: [values]}} of dump files of LIGGGHTS and LAMMPS."""
    steps = {}
    with open(path, encoding="ascii") as f:
        lines = f.read().splitlines()
    at = 0
    while at < len(lines):
        step, count = int(lines[at + 1]), int(lines[at + 3])
        rows = [numbers(line) for line in lines[at + 9:at + 9 + count]]
        steps[step] = {int(row[0]): row[1:] for row in rows}
        at += 9 + count
    return steps


class Clump:
    """A clump with its templates, in a folder of its own."""

    def __init__(self, name, folder):
        kind, parameters, self.length, n = CLUMPS[name]
        self.folder = os.path.join(folder, name)
        os.mkdir(self.folder)
        self.mskit("shape", kind, *parameters, "-o", "c.stl")
        self.mskit("generate", "c.stl", "-g", "setcover", "-n", str(n), "--cells", "50", "--correct",
                   "--density", str(DENSITY), "--unit", self.length, *TEMPLATES)
        self.read()

    def read(self):
        with open(self.path("c.json"), encoding="utf-8") as f:
            self.record = json.load(f)
        self.masses = self.record["masses"]
        self.mass = self.record["particle"]["mass"]
        self.inertia = self.record["particle"]["principal_moments"]
        with open(self.path("c.liggghts"), encoding="ascii") as f:
            self.spheres = [numbers(line) for line in f]
        self.reach = max(math.sqrt(dot(s[:3], s[:3])) + s[3] for s in self.spheres)
        self.three = self.far_apart()

    def path(self, name):
        return os.path.join(self.folder, name)

    def run(self, *command, timeout=1200):
        process = subprocess.run(command, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                 stderr=subprocess.STDOUT, timeout=timeout, check=False)
        out = process.stdout.decode("utf-8", "replace")
        if process.returncode != 0 or "ERROR" in out:
            raise AssertionError(f"$ {' '.join(command)}\nexit code {process.returncode}\n{out[-3000:]}")
        return out

    def mskit(self, *args):
        return self.run(MSKIT, *args)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="ascii") as f:
            f.write(text)

    def script(self, name):
        with open(self.path(name), encoding="ascii") as f:
            return f.read()

    def far_apart(self):
        """Indices of three spheres that give a good frame."""
        places = [s[:3] for s in self.spheres]
        far = max(range(len(places)), key=lambda i: dot(sub(places[i], places[0]), sub(places[i], places[0])))

        def area(i):
            c = cross(sub(places[far], places[0]), sub(places[i], places[0]))
            return dot(c, c)
        return [0, far, max(range(len(places)), key=area)]

    def orientation(self, places):
        """From the template's axes to those of the three spheres."""
        return times(frame(places), transpose(frame([self.spheres[i][:3] for i in self.three])))


def make_folder():
    holder = tempfile.TemporaryDirectory(prefix="mskit-engines-")
    unittest.addModuleCleanup(holder.cleanup)
    return holder.name


def need_program(program):
    """Skips a class of tests: the common one, which names no program, or one whose engine is not installed."""
    if program is None:
        raise unittest.SkipTest("the engines below do the work")
    if not shutil.which(program):
        raise unittest.SkipTest(f"{program} is not installed")


def skip_without_engines():
    if not any(shutil.which(program) for program in ("liggghts", "lmp", "yade")):
        print("skipped: neither liggghts nor lmp nor yade is installed")
        sys.exit(77)


def without_fall(script):
    """A script of LIGGGHTS or LAMMPS without gravity and without its run."""
    script = re.sub(r"(?m)^fix gravity .*\n|^(run|thermo|variable steps) .*\n", "", script)
    return script.replace(" gravity gravity", "")


def alone(script):
    """The same without walls."""
    return re.sub(r"(?m)^fix .* wall/gran .*\n", "", without_fall(script))


class Engine(unittest.TestCase):
    program = None
    clumps = {}  # made once, for all engines
    # A method of second order, over 31 radians.
    tolerance = 100 * STEP ** 2

    @classmethod
    def setUpClass(cls):
        need_program(cls.program)
        if not Engine.clumps:
            Engine.clumps = {name: Clump(name, make_folder()) for name in CLUMPS}

    def each(self, check):
        for name, clump in self.clumps.items():
            with self.subTest(clump=name):
                check(clump)

    def check_tumbling(self, clump, states):
        """states: (time, places of the three spheres, angular velocity), the first at time 0."""
        _, places, spin = states[0]
        start = clump.orientation(places)
        body_spin = apply(transpose(start), spin)
        out = subprocess.run([TUMBLE] + [repr(x) for x in clump.inertia + body_spin] + [repr(s[0]) for s in states],
                             stdout=subprocess.PIPE, check=True).stdout.decode()
        speed = math.sqrt(dot(spin, spin))
        worst = {"orientation": 0.0, "spin": 0.0, "energy": 0.0, "momentum": 0.0}
        energy0, momentum0 = self.kinetics(clump, start, spin)
        for (_, places, spin), truth in zip(states, map(numbers, out.splitlines())):
            now, expected = clump.orientation(places), times(start, rotation(truth[3:]))
            worst["orientation"] = max(worst["orientation"], angle(now, expected))
            worst["spin"] = max(worst["spin"], math.dist(spin, apply(expected, truth[:3])) / speed)
            energy, momentum = self.kinetics(clump, now, spin)
            worst["energy"] = max(worst["energy"], abs(energy / energy0 - 1))
            worst["momentum"] = max(worst["momentum"], math.dist(momentum, momentum0) / math.hypot(*momentum0))
        if os.environ.get("MSKIT_VERBOSE"):
            print(type(self).__name__, os.path.basename(clump.folder), speed * states[-1][0] / 2 / math.pi, worst)
        self.assertEqual(len(states), SAMPLES + 1)
        self.assertGreater(speed * states[-1][0], 3 * 2 * math.pi, "several turns")
        for what, error in worst.items():
            self.assertLess(error, self.tolerance, what)

    @staticmethod
    def kinetics(clump, orientation, spin):
        body_spin = apply(transpose(orientation), spin)
        momentum = [i * w for i, w in zip(clump.inertia, body_spin)]
        return dot(momentum, body_spin) / 2, apply(orientation, momentum)

    def check_drop(self, clump, spheres):
        """spheres: x, y, z, r at the end: on the plane, no deeper than what the stiffness allows, and not apart."""
        self.assertEqual(len(spheres), len(clump.spheres))
        lowest = min(z - r for _, _, z, r in spheres)
        self.assertGreater(lowest, -0.02 * clump.reach, "sank into the plane")
        self.assertLess(lowest, clump.reach, "has not fallen")
        i, j, k = clump.three
        # Six digits are right to 5e-6 of a coordinate at the least; two places have three each.
        printed = 2 * 3**0.5 * 5e-6 * max(abs(x) for s in spheres for x in s[:3])
        for a, b in ((i, j), (j, k), (k, i)):
            self.assertAlmostEqual(math.dist(spheres[a][:3], spheres[b][:3]),
                                   math.dist(clump.spheres[a][:3], clump.spheres[b][:3]),
                                   delta=1e-5 * clump.reach + printed)


class Liggghts(Engine):
    program = "liggghts"

    def test_mass_and_inertia(self):
        def check(clump):
            clump.write("load.in", re.sub(r"(?m)^run .*", "run 0", clump.script("c.liggghts.in")))
            clump.run("liggghts", "-in", "load.in")
            log = clump.script("log.liggghts")
            self.assertIn(f"mass = {clump.mass:.6e}", log)
            self.assertIn("center of mass = 0.000000e+00, 0.000000e+00, 0.000000e+00", log)
            self.assertIn("Principal moments of inertia_: " + ", ".join(f"{i:.6e}" for i in clump.inertia), log)

        self.each(check)

    def test_tumbling(self):
        def check(clump):
            step = STEP / math.hypot(1, 2, 3)
            script = alone(clump.script("c.liggghts.in"))
            script = re.sub(r"(?m)^timestep .*", f"timestep {step!r}", script)
            script = script.replace("insert_every once", "omega constant 1 2 3 insert_every once")
            clump.write("tumble.in", script + f"""
run 1
dump states all custom {STEPS // SAMPLES} states.txt id x y z omegax omegay omegaz mass
dump_modify states first yes format "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g"
run {STEPS}
""")
            clump.run("liggghts", "-in", "tumble.in")
            dumps = sorted(read_dumps(clump.path("states.txt")).items())
            states = []
            for number, rows in dumps:
                three = [rows[i + 1] for i in clump.three]
                self.assertEqual(three[0][6], clump.mass)
                states.append((step * (number - dumps[0][0]), [row[:3] for row in three], three[0][3:6]))
            self.check_tumbling(clump, states[-SAMPLES - 1:])

        self.each(check)

    def test_drop(self):
        def check(clump):
            clump.write("drop.in", clump.script("c.liggghts.in") + "write_dump all custom end.txt id x y z radius\n")
            clump.run("liggghts", "-in", "drop.in")
            (rows,) = read_dumps(clump.path("end.txt")).values()
            self.check_drop(clump, [rows[i] for i in sorted(rows)])

        self.each(check)


class Lammps(Engine):
    program = "lmp"

    def test_mass_and_inertia(self):
        def check(clump):
            self.run_tumbling(clump)
            with open(clump.path("bodies.txt"), encoding="ascii") as f:
                body = numbers(f.read().splitlines()[9])
            self.assertAlmostEqual(body[0] / clump.mass, 1, delta=1e-14)
            for got, given in zip(sorted(body[1:4]), clump.inertia):
                self.assertAlmostEqual(got / given, 1, delta=1e-12)

        self.each(check)

    def test_sums_of_the_atoms(self):
        """With carriers masses are exact: LAMMPS sums the atoms to the mass and inertia that are given."""
        carriers = []

        def check(clump):
            clump.mskit("correct", "c.json", "--target", "c.stl", "--density", str(DENSITY), "--unit", clump.length,
                        "--carriers", "-o", "e.lammps")
            molecule = re.sub(r"(?m)^.* (mass|com|inertia)\n", "", clump.script("e.lammps"))
            carriers.append(molecule.split("Types")[1].split("Diameters")[0].count(" 2\n"))
            clump.write("bare.lammps", molecule)
            script = re.sub(r"(?m)^fix (insert|move) .*\n|^molecule .*\n", "", alone(clump.script("e.lammps.in")))
            clump.write("sum.in", script + """
molecule clump bare.lammps
create_atoms 0 single 0 0 0 mol clump 1 rotate 0 0 0 1 units box
fix move all rigid/small molecule
compute bodies all rigid/local move mass inertiax inertiay inertiaz x y z
dump bodies all local 1 sums.txt c_bodies[1] c_bodies[2] c_bodies[3] c_bodies[4] c_bodies[5] c_bodies[6] c_bodies[7]
dump_modify bodies format line "%.17g %.17g %.17g %.17g %.17g %.17g %.17g"
dump atoms all custom 1 atoms.txt id x y z
dump_modify atoms format line "%d %.17g %.17g %.17g"
run 0
""")
            clump.run("lmp", "-in", "sum.in")
            with open(clump.path("sums.txt"), encoding="ascii") as f:
                body = numbers(f.read().splitlines()[9])
            self.assertAlmostEqual(body[0] / clump.mass, 1, delta=1e-12)
            for got, given in zip(sorted(body[1:4]), clump.inertia):
                self.assertAlmostEqual(got / given, 1, delta=1e-9)
            (atoms,) = read_dumps(clump.path("atoms.txt")).values()
            for centre, atom, place in zip(body[4:7], atoms[1], clump.spheres[0]):
                self.assertAlmostEqual(atom - centre, place, delta=1e-9 * clump.reach)

        self.each(check)
        self.assertGreater(max(carriers), 0, "no clump needed carriers")

    def run_tumbling(self, clump):
        """A couple of forces on two spheres sets it going; returns the length of a step."""
        step, (i, j, _) = STEP / 3, clump.three
        arm = math.dist(clump.spheres[i][:3], clump.spheres[j][:3])
        push = [clump.inertia[1] * w / (100 * step * arm) for w in (1, 2, 3)]
        script = re.sub(r"(?m)^timestep .*", f"timestep {step!r}", alone(clump.script("c.lammps.in")))
        clump.write("tumble.in", script + f"""
run 1
group one id {i + 1}
group two id {j + 1}
fix push one addforce {push[0]!r} {push[1]!r} {push[2]!r}
fix pull two addforce {-push[0]!r} {-push[1]!r} {-push[2]!r}
run 100
unfix push
unfix pull
compute bodies all rigid/local move mass inertiax inertiay inertiaz
dump bodies all local {STEPS} bodies.txt c_bodies[1] c_bodies[2] c_bodies[3] c_bodies[4]
dump_modify bodies first yes format line "%.17g %.17g %.17g %.17g"
dump states all custom {STEPS // SAMPLES} states.txt id x y z omegax omegay omegaz
dump_modify states first yes format line "%d %.17g %.17g %.17g %.17g %.17g %.17g"
run {STEPS}
""")
        clump.run("lmp", "-in", "tumble.in")
        return step

    def test_tumbling(self):
        def check(clump):
            step = self.run_tumbling(clump)
            dumps = sorted(read_dumps(clump.path("states.txt")).items())
            states = [(step * (number - dumps[0][0]), [rows[i + 1][:3] for i in clump.three], rows[1][3:6])
                      for number, rows in dumps]
            self.check_tumbling(clump, states[:SAMPLES + 1])

        self.each(check)

    def test_drop(self):
        def check(clump):
            clump.write("drop.in", clump.script("c.lammps.in") + "write_dump all custom end.txt id x y z radius\n")
            clump.run("lmp", "-in", "drop.in")
            (rows,) = read_dumps(clump.path("end.txt")).values()
            self.check_drop(clump, [rows[i] for i in sorted(rows)])

        self.each(check)


class Yade(Engine):
    program = "yade"
    tolerance = 200 * STEP  # its method is of first order

    def test_mass_and_tumbling(self):
        def check(clump):
            step = STEP / math.hypot(1, 2, 3)
            script = clump.script("c.yade.py").split("reach, side =")[0]
            clump.write("tumble.py", script + f"""
clump = particle(Vector3(0, 0, 0))
state = O.bodies[clump].state
O.engines = [ForceResetter(), NewtonIntegrator(damping=0, gravity=(0, 0, 0))]
O.dt = {step!r}
state.angVel = Vector3(1, 2, 3)
body_spin = state.ori.conjugate() * state.angVel
state.angMom = state.ori * Vector3(*[i * w for i, w in zip(state.inertia, body_spin)])
print('BODY', state.mass, *state.inertia, *state.pos, *state.ori)
for sample in range({SAMPLES} + 1):
    three = [x for i in {clump.three} for x in O.bodies[i].state.pos]
    print('STATE', O.time, *three, *state.angVel)
    O.run({STEPS // SAMPLES}, True)
""")
            out = clump.run("yade", "-x", "-n", "tumble.py")
            body = numbers(re.search(r"(?m)^BODY (.*)", out).group(1))
            self.assertEqual(body[:4], [clump.mass] + clump.inertia)
            states = []
            for line in re.findall(r"(?m)^STATE (.*)", out):
                v = numbers(line)
                states.append((v[0], [v[1:4], v[4:7], v[7:10]], v[10:13]))
            self.check_tumbling(clump, states)

        self.each(check)

    def test_drop(self):
        def check(clump):
            clump.write("drop.py", clump.script("c.yade.py") + f"""
for i in range({len(clump.spheres)}):
    print('SPHERE', *O.bodies[i].state.pos, O.bodies[i].shape.radius)
""")
            out = clump.run("yade", "-x", "-n", "drop.py")
            self.check_drop(clump, [numbers(line) for line in re.findall(r"(?m)^SPHERE (.*)", out)])

        self.each(check)


if __name__ == "__main__":
    skip_without_engines()
    unittest.main()
