#!/usr/bin/env python3
"""Particles that collide in the engines, by the scripts as mskit writes them.

    MSKIT=build/eval/mskit tests/engines/test_collisions.py [-v]

The clumps are made so that a contact is a single one and its line goes through the centres of mass: `rod` ends in a
small sphere on its long axis; `ball` has all its spheres in one around its centre, so that every way it meets something
is central. Mass and inertia are those of an ellipsoid and not of the spheres. Every engine that is not installed is
skipped.
"""
import math
import os
import re
import unittest

import test_engines as engines
from test_engines import apply, cross, dot, numbers, sub, transpose

RESTITUTION = 0.5  # of the scripts
SPEED = 0.05
GAP = 1e-5
STEPS = 500
MILLIMETRE = 1e-3
CLUMPS = {
    "rod": [(-2.8, 0, 0, 0.8), (2.8, 0, 0, 0.8), (0, 0, 0, 1.1), (-1.4, 0.1, 0, 1), (-1.4, -0.1, 0, 1),
            (1.4, 0, 0.1, 1),
            (1.4, 0, -0.1, 1)],
    "ball": [(0, 0, 0, 2), (-0.5, 0, 0, 1), (0.5, 0, 0, 1), (0, 0.3, 0, 1), (0, -0.3, 0, 1)],
    **{f"feet{n * n}": [((2 * i - n + 1) * 3 / n, (2 * j - n + 1) * 1.5 / n, 0, 1.1) for i in range(n)
                        for j in range(n)]
       for n in (2, 3, 4)},
}


class Clump(engines.Clump):
    def __init__(self, name, folder):
        self.folder = os.path.join(folder, name)
        os.mkdir(self.folder)
        self.write("spheres.csv", "x,y,z,r\n" + "".join("{},{},{},{}\n".format(*s) for s in CLUMPS[name]))
        self.mskit("shape", "ellipsoid", "a=4", "b=1.3", "c=1", "-o", "c.stl")
        self.mskit("correct", "spheres.csv", "--target", "c.stl", "--density", str(engines.DENSITY), "--unit", "mm",
                   *engines.TEMPLATES)
        self.read()

    def motion(self, rows):
        """Of a body, from place, velocity and spin of its three spheres: place, velocity, spin, orientation."""
        orientation = self.orientation([row[:3] for row in rows])
        arm, spin = apply(orientation, self.spheres[self.three[0]][:3]), rows[0][6:9]
        return sub(rows[0][:3], arm), sub(rows[0][3:6], cross(spin, arm)), spin, orientation

    def momenta(self, motions):
        """Linear and angular, of all bodies."""
        linear, angular = [0, 0, 0], [0, 0, 0]
        for place, velocity, spin, orientation in motions:
            own = apply(orientation, [i * w for i, w in zip(self.inertia, apply(transpose(orientation), spin))])
            orbital = cross(place, [self.mass * v for v in velocity])
            linear = [a + self.mass * v for a, v in zip(linear, velocity)]
            angular = [a + b + c for a, b, c in zip(angular, own, orbital)]
        return linear, angular


def along(a, direction, length):
    return [x + length * d for x, d in zip(a, direction)]


class Engine(unittest.TestCase):
    """An engine runs bodies, each a place and a velocity, and says how they move at the start and at the end."""
    program = None
    attracts = True  # what damps a contact may pull
    finer = 1  # steps than those of the script
    clumps = {}

    @classmethod
    def setUpClass(cls):
        engines.need_program(cls.program)
        folder = engines.make_folder()
        cls.clumps = {name: Clump(name, folder) for name in CLUMPS}

    def collide(self, clump, offset):
        """One rod runs into the end of another, its line past the other's centre by the offset; the start and the
        end."""
        axis, side = self.axes(clump)
        end = clump.reach
        first = [0, 0, 3 * end]
        second = along(along(first, axis, 2 * end + GAP), side, offset)
        return axis, self.run_bodies(clump, [(first, [SPEED * a for a in axis]), (second, [0, 0, 0])])

    def axes(self, clump):
        """The first two axes of the bodies, which all begin alike."""
        orientation = transpose(self.run_bodies(clump, [([0, 0, 3 * clump.reach], [0, 0, 0])], steps=1)[0][0][3])
        return orientation[0], orientation[1]

    def overlap(self, clump):
        """Largest overlap of the ends of two rods by Hertz, without damping; metres."""
        young = float(re.search(r"young=([^,]*)", clump.script("c.yade.py")).group(1))
        radius = 0.8 * MILLIMETRE / 2
        stiffness = young / (1 - 0.3 ** 2) / 2
        return (15 * clump.mass / 2 * SPEED ** 2 / (16 * stiffness * math.sqrt(radius))) ** 0.4

    def test_central(self):
        axis, (start, end) = self.collide(self.clumps["rod"], 0)
        before, after = (dot(sub(b[1], a[1]), axis) for a, b in (start, end))
        self.assertAlmostEqual(before, -SPEED, delta=1e-6 * SPEED)
        self.assertAlmostEqual(after / SPEED, RESTITUTION, delta=0.02 * RESTITUTION)
        for _, velocity, spin, _ in end:
            self.assertLess(math.hypot(*spin) * self.clumps["rod"].reach, 1e-6 * SPEED)
            self.assertLess(math.hypot(*cross(velocity, axis)), 1e-6 * SPEED)

    def test_oblique(self):
        clump = self.clumps["rod"]
        _, (start, end) = self.collide(clump, 0.4 * MILLIMETRE)
        (linear0, angular0), (linear1, angular1) = clump.momenta(start), clump.momenta(end)
        scale, radius = clump.mass * SPEED, 0.8 * MILLIMETRE
        linear, angular = math.dist(linear0, linear1) / scale, math.dist(angular0, angular1) / scale / radius
        if os.environ.get("MSKIT_VERBOSE"):
            print(type(self).__name__, "overlap", self.overlap(clump) / radius, "linear", linear, "angular", angular)
        self.assertLess(linear, 1e-12)
        self.assertLess(angular, 1e-10)
        for _, velocity, spin, _ in end:
            self.assertGreater(math.hypot(*spin) * clump.reach, 1e-3 * SPEED, "has not been set turning")

    def floor(self, clump):
        """Its own restitution on the floor of the script."""
        radius = max(s[3] for s in clump.spheres)
        ((_, before, _, _),), ((_, after, spin, _),) = self.run_bodies(
            clump, [([0, 0, radius + GAP], [0, 0, -SPEED])], steps=math.ceil(3 * STEPS * self.finer))
        self.assertAlmostEqual(before[2], -SPEED, delta=1e-6 * SPEED)
        self.assertLess(math.hypot(*spin) * clump.reach, 1e-3 * SPEED)
        return after[2] / SPEED

    def test_floor(self):
        self.assertAlmostEqual(self.floor(self.clumps["ball"]), RESTITUTION, delta=0.02 * RESTITUTION)

    def test_step_of_the_body(self):
        """That of the comment, for as many contacts as there are spheres, is stable; ten times as long a one is not."""
        clump = self.clumps["feet16"]
        script = clump.script("c.yade.py")
        step, = re.findall(r"(?m)^O.dt = (.*)", script)
        bound, = re.findall(r"(?m)^# of its reach .*, to (\S+) s on all", script)
        self.finer = float(step) / float(bound)
        self.assertLess(abs(self.floor(clump)), RESTITUTION)
        self.finer /= 10
        self.assertGreater(abs(self.floor(clump)), 1, "energy from nothing")

    def refine(self, script):
        """The step, divided."""
        refined = re.sub(r"(?m)^(timestep |O\.dt = )(.*)", lambda m: m[1] + repr(float(m[2]) / self.finer), script)
        self.assertEqual(refined == script, self.finer == 1)
        return refined

    def test_contacts_at_once(self):
        self.finer = 5
        for number in (4, 9, 16):
            with self.subTest(number=number):
                found = self.floor(self.clumps[f"feet{number}"])
                self.assertAlmostEqual(found, closed_form(number, self.attracts), delta=0.003)


def rebound(ratio, attracts):
    """Restitution at a ratio of damping: of a linear oscillator, as of a Hertz contact that is damped as overlap^(1/4)
    (Antypov and Elliott 2011), until the overlap is 0; or until the force is, where none may attract (Schwager and
    Poeschel 2007)."""
    if ratio >= 1:
        return 0 if attracts else math.exp(-2 * ratio * math.acosh(ratio) / math.sqrt(ratio ** 2 - 1))
    phase = math.pi if attracts else 2 * math.acos(ratio)
    return math.exp(-ratio * phase / math.sqrt(1 - ratio ** 2))


def closed_form(number, attracts):
    """e(N) of contacts that are each damped as if they bore the body alone: the ratio is root N times that of one."""
    low, high = 0, 0.9
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if rebound(middle, attracts) > RESTITUTION else (low, middle)
    return rebound(low * math.sqrt(number), attracts)


STATE = "x y z vx vy vz omegax omegay omegaz"


def read_states(clump, name, count):
    """Of dumps of all spheres: the motion of each body, at each time."""
    return [[clump.motion([rows[len(clump.spheres) * body + i + 1] for i in clump.three]) for body in range(count)]
            for _, rows in sorted(engines.read_dumps(clump.path(name)).items()) if rows]


class Liggghts(Engine):
    program = "liggghts"

    def run_bodies(self, clump, bodies, steps=STEPS):
        script = engines.without_fall(clump.script("c.liggghts.in")).replace(" orientation random", "")
        script = self.refine(script)
        if len(bodies) > 1:
            script = engines.alone(script)
        insert = re.search(r"(?m)^fix insert .*\n", script).group(0).replace("all_in yes", "all_in no")
        inserts = ""
        for k, (place, velocity) in enumerate(bodies):
            block = " ".join(f"{x - 1e-12!r} {x + 1e-12!r}" for x in place)
            inserts += f"region at{k} block {block} volume_limit 1e-300 units box\n"
            inserts += (insert.replace("fix insert", f"fix insert{k}").replace("region above", f"region at{k}")
                        .replace("insert_every once",
                                 "vel constant {!r} {!r} {!r} insert_every once".format(*velocity)))
        script = re.sub(r"(?m)^fix insert .*\n", lambda _: inserts, script)
        clump.write("bodies.in", script + f"""
run 1
dump states all custom {steps} states.txt id {STATE} mass
dump_modify states first yes format "%d{' %.17g' * 10}"
run {steps}
""")
        clump.run("liggghts", "-in", "bodies.in")
        dumps = sorted(engines.read_dumps(clump.path("states.txt")).items())
        for row in dumps[-1][1].values():
            self.assertEqual(row[9], clump.mass)
        states = read_states(clump, "states.txt", len(bodies))
        return states[0], states[-1]


class Lammps(Engine):
    program = "lmp"
    before = ""  # commands before the run that is measured
    heavier = 1  # the atoms than the body's mass divided among them
    orient = ""  # bodies are turned about any axis

    def run_bodies(self, clump, bodies, steps=STEPS):
        """Bodies inserted with one seed are turned alike. A second run would damp walls wrongly."""
        script = self.refine(engines.without_fall(clump.script("c.lammps.in")))
        if len(bodies) > 1:
            script = engines.alone(script)
        insert = re.search(r"(?m)^fix insert .*\n", script).group(0)
        inserts = ""
        for k, (place, velocity) in enumerate(bodies):
            inserts += f"region at{k} block " + " ".join(f"{x!r} {x!r}" for x in place) + "\n"
            inserts += re.sub(r" near \S+", "", insert.replace("fix insert", f"fix insert{k}")
                              .replace("region above", f"region at{k}").rstrip())
            inserts += self.orient + "".join(f" v{axis} {v!r} {v!r}" for axis, v in zip("xyz", velocity)) + "\n"
        script = re.sub(r"(?m)^fix insert .*\n", lambda _: inserts, script)
        head, masses = clump.script("c.lammps").split("Masses\n\n")
        rows = [line.split() for line in masses.splitlines()]
        clump.write("heavier.lammps", head + "Masses\n\n"
                    + "".join(f"{number} {self.heavier * float(mass)!r}\n" for number, mass in rows))
        script = script.replace('"c.lammps"', '"heavier.lammps"')
        self.assertIn("heavier.lammps", script)
        clump.write("bodies.in", script + self.before + f"""
compute bodies all rigid/local move mass inertiax inertiay inertiaz
dump bodies all local {steps + 1} bodies.txt c_bodies[1] c_bodies[2] c_bodies[3] c_bodies[4]
dump_modify bodies format line "%.17g %.17g %.17g %.17g"
dump states all custom 1 states.txt id {STATE}
dump_modify states format line "%d{' %.17g' * 9}"
run {steps + 1}
""")
        clump.run("lmp", "-in", "bodies.in")
        for line in clump.script("bodies.txt").splitlines()[-len(bodies):]:
            mass, *moments = numbers(line)
            self.assertAlmostEqual(mass / clump.mass, 1, delta=1e-14)
            for got, given in zip(sorted(moments), clump.inertia):
                self.assertAlmostEqual(got / given, 1, delta=1e-12)
        states = read_states(clump, "states.txt", len(bodies))
        return states[0], states[-1]

    def test_contacts_at_once(self):
        self.orient = " orient 0 0 1"
        super().test_contacts_at_once()

    def test_step_of_the_body(self):
        self.orient = " orient 0 0 1"
        super().test_step_of_the_body()

    def test_floor_of_a_second_run(self):
        """The cure that docs/templates.md tells: the walls are fixed again before it."""
        fix = re.search(r"(?m)^fix floor .*\n", self.clumps["ball"].script("c.lammps.in")).group(0)
        self.before = "run 1\nunfix floor\n" + fix
        self.test_floor()

    def test_mass_of_members(self):
        """It damps nothing: the mass of the body does, whatever the atoms weigh."""
        self.heavier = 10
        self.test_floor()


class Yade(Engine):
    program = "yade"
    attracts = False
    heavier = 1  # members than the body

    def run_bodies(self, clump, bodies, steps=STEPS):
        head, tail = clump.script("c.yade.py").split("reach, side =")
        head = head.replace("state.mass = mass  #", f"state.mass = {self.heavier} * mass  #")
        wall = re.search(r"(?m)^O\.bodies\.append\(wall\(0.*\n", tail).group(0) if len(bodies) == 1 else ""
        law = re.search(r"(?ms)^O\.engines = .*?^O\.dt = .*?\n", tail).group(0).replace("(0, 0, -9.81)", "(0, 0, 0)")
        law = self.refine(law)
        clump.write("bodies.py", head + wall + law + f"""
clumps = [particle(Vector3(place)) for place, velocity in {bodies!r}]
for clump, (place, velocity) in zip(clumps, {bodies!r}):
    O.bodies[clump].state.vel = Vector3(velocity)
for part in range(2):
    for clump in clumps:
        body = O.bodies[clump]
        print('BODY', body.state.mass, *body.state.inertia)
        for i in {clump.three}:
            state = O.bodies[min(body.shape.members) + i].state
            print('STATE', *state.pos, *body.state.vel + body.state.angVel.cross(state.pos - body.state.pos),
                  *body.state.angVel)
    O.run({steps}, True)
""")
        out = clump.run("yade", "-x", "-n", "bodies.py")
        for line in re.findall(r"(?m)^BODY (.*)", out):
            self.assertEqual(numbers(line), [clump.mass] + clump.inertia)
        rows = [numbers(line) for line in re.findall(r"(?m)^STATE (.*)", out)]
        motions = [clump.motion(rows[k:k + 3]) for k in range(0, len(rows), 3)]
        return motions[:len(bodies)], motions[len(bodies):]

    def test_mass_of_members(self):
        """It is what damps: ten times that of the body damp as ten contacts do."""
        self.heavier = 10
        found = self.floor(self.clumps["ball"])
        self.assertAlmostEqual(found, closed_form(10, self.attracts), delta=0.003)


if __name__ == "__main__":
    engines.skip_without_engines()
    unittest.main()
