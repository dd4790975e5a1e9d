#!/usr/bin/env python3
"""What contact does in the engines: restitution of impacts, the mass that damps, the largest stable step.

    MSKIT=build/eval/mskit docs/experiments/contact.py [walls] [masses] [impacts] [steps] [tables]

Rows are added to contact-impacts.csv, contact-masses.csv and contact-steps.csv beside this file; those that are there
are not run again. `tables` puts the tables of these files between the marks of docs/behaviour.md. Takes liggghts, lmp
and yade; some ten CPU minutes for all of it.
"""
import json
import math
import os
import resource
import sys
import tempfile

import contact_tables
import dem
import oracle
from program import run_mskit

HERE = os.path.dirname(os.path.abspath(__file__))
GLASS = dem.Law("hertz", 70e9, 0.3, 0.5)
LOCK = 1e9  # moments of inertia times this: rotation is locked
# What points down, in the frame of the shape.
DOWN = {"cube": {"flat": (0, 0, -1), "edge": (1, 0, 1), "corner": (1, 1, 1)},
        "tablet": {"flat": (0, 0, -1), "edge": (5.675, 0, 2), "side": (1, 0, 0)}}


class Table:
    """A CSV file whose rows have keys; a row that is there is kept."""

    def __init__(self, name, fields, keys):
        self.path, self.fields, self.keys = os.path.join(HERE, name), fields.split(), keys
        self.rows = contact_tables.tables.read_if_there(self.path)
        self.seen = {self.key(row) for row in self.rows}

    def key(self, row):
        return tuple(str(row[name]) for name in self.fields[:self.keys])

    def add(self, make, *key):
        """make: gives the other fields. CPU seconds are those of its programs."""
        if tuple(map(str, key)) in self.seen:
            return
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        values = [value if isinstance(value, (int, str)) else f"{value:.6g}" for value in make()]
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        row = dict(zip(self.fields, [*key, *values, f"{cpu:.2f}"]))
        contact_tables.tables.add_row(self.path, self.fields, row)
        self.rows.append(row)
        print(*row.values(), flush=True)


def turn_down(u):
    """Rows of the rotation that turns u to -z."""
    length = math.hypot(*u)
    z = [-x / length for x in u]
    side = [1.0, 0, 0] if abs(z[0]) < 0.6 else [0, 1.0, 0]
    along = sum(a * b for a, b in zip(side, z))
    x = [a - along * b for a, b in zip(side, z)]
    x = [a / math.hypot(*x) for a in x]
    return [x, oracle.cross(z, x), z]


def load_clump(path, down):
    """A clump of mskit about its centre of mass, with `down` pointing down."""
    with open(path, encoding="utf-8") as f:
        record = json.load(f)
    particle = record["particle"]
    rows = turn_down(down)
    spheres = []
    for s in record["spheres"]:
        at = [particle["scale"] * (x - c) for x, c in zip(s[:3], particle["centre"])]
        spheres.append([sum(a * b for a, b in zip(row, at)) for row in rows] + [particle["scale"] * s[3]])
    axes = [[sum(a * b for a, b in zip(row, axis)) for row in rows] for axis in particle["principal_axes"]]
    return dem.Body(spheres, particle["mass"], particle["principal_moments"], axes)


def make_clump(folder, shape, n):
    path = os.path.join(folder, f"{shape}-{n}.json")
    if not os.path.exists(path):
        mesh = os.path.join(folder, shape + ".stl")
        run_mskit("shape", shape, *(["a=10"] if shape == "cube" else []), "-o", mesh)
        run_mskit("generate", mesh, "-g", "setcover", "-n", n, "--cells", 50, "--correct", "--density", dem.DENSITY,
                  "--unit", "mm", "-o", path)
    return path


def locked(body):
    return body._replace(moments=[LOCK * i for i in body.moments])


def impact(folder, engine, body, law, speed):
    """Root of the energy that is left; steps of 1/100 of the time 1/omega of the contact at its largest overlap."""
    base = min(s[2] - s[3] for s in body.spheres)
    seen = oracle.impact(body, law, speed, engine)
    step = 0.01 / seen.omega
    gap = 20 * step * speed
    steps = 20 + math.ceil(seen.seconds / step)
    start = dem.Start(gap - base, (0.0, 0.0, -speed), (0.0, 0.0, 0.0), 0.0)
    (rows,) = dem.RUN[engine](folder, body, law, start, [step], 2, math.ceil(steps / 2))
    if not 0 < sum(rows[-1]) < math.inf:
        raise RuntimeError(f"{engine}: the body has left the box")
    return math.sqrt(sum(rows[-1]) / sum(rows[0])), seen


def run_impacts(folder):
    table = Table("contact-impacts.csv", "engine shape spheres impact speed rotation e touching number closed oracle "
                  "overlap cpu", 6)
    for shape, impacts in DOWN.items():
        for n in (10, 30, 100):
            for name, down in impacts.items():
                for rotation in ("locked", "free"):
                    for engine in dem.ENGINES:
                        for speed in (0.1, 1.0, 3.0):
                            def make():
                                body = load_clump(make_clump(folder, shape, n), down)
                                body = locked(body) if rotation == "locked" else body
                                e, seen = impact(folder, engine, body, GLASS, speed)
                                closed = oracle.closed_form(GLASS.restitution, seen.number, engine)
                                return e, seen.touching, seen.number, closed, seen.e, seen.overlap
                            table.add(make, engine, shape, n, name, speed, rotation)


R_EQ = 5e-3
BALL = dem.DENSITY * 4 / 3 * math.pi * R_EQ ** 3


def make_feet(radius, places, member=1.0):
    """A body with the mass and inertia of the ball of R_EQ; feet of one radius, all as low as that ball."""
    spheres = [[0.0, 0.0, 0.01 * R_EQ, 0.9 * R_EQ]] + [[x, y, radius - R_EQ, radius] for x, y in places]
    # Moments that differ by 1e-6 leave no engine a choice of axes.
    moments = [0.4 * BALL * R_EQ ** 2 * (1 + k * 1e-6) for k in range(3)]
    return dem.Body(spheres, BALL, moments, [[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]], member)


def lay_square(side, width):
    """side^2 places, so far apart."""
    return [(width * (i - (side - 1) / 2), width * (j - (side - 1) / 2)) for i in range(side) for j in range(side)]


def run_masses(folder):
    """Members of another mass than the body's: one foot, and four."""
    table = Table("contact-masses.csv", "engine member feet e by_body by_member cpu", 3)
    for engine in dem.ENGINES:
        for member in (0.1, 1.0, 10.0):
            for side in (1, 2):
                def make():
                    body = locked(make_feet(0.2 * R_EQ, lay_square(side, 0.5 * R_EQ), member))
                    n = len(body.spheres) - 1
                    e, _ = impact(folder, engine, body, GLASS, 1.0)
                    return (e, *(oracle.closed_form(GLASS.restitution, n * f, engine) for f in (1, member)))
                table.add(make, engine, member, side ** 2)


def run_walls(folder):
    """Force of a wall on a sphere, over that of Hertz."""
    table = Table("contact-walls.csv", "engine over_hertz oracle cpu", 1)
    body, overlap, step = make_feet(0.2 * R_EQ, [(0.0, 0.0)]), 1e-3 * R_EQ, 1e-9
    hertz = 4 / 3 * GLASS.young / (1 - GLASS.poisson ** 2) / 2 * math.sqrt(0.2 * R_EQ) * overlap ** 1.5
    for engine in dem.ENGINES:
        def make():
            start = dem.Start(R_EQ - overlap, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0)
            (rows,) = dem.RUN[engine](folder, body, GLASS._replace(restitution=1), start, [step], 1, 100)
            speeds = [math.sqrt(2 * row[0] / body.mass) for row in rows]
            return ((speeds[1] - speeds[0]) * body.mass / (100 * step) / hertz,
                    oracle.wall_modulus(GLASS, engine) / oracle.wall_modulus(GLASS, "LIGGGHTS"))
        table.add(make, engine)


def rayleigh(radius):
    """Time of a free sphere of that radius."""
    shear = GLASS.young / (2 * (1 + GLASS.poisson))
    return math.pi * radius * math.sqrt(dem.DENSITY / shear) / (0.1631 * GLASS.poisson + 0.8766)


# Presses a sphere of R_EQ by a thousandth of its radius into LIGGGHTS' wall.
LOAD = 4 / 3 * GLASS.young / (1 - GLASS.poisson ** 2) / 2 * R_EQ ** 2 * 1e-3 ** 1.5


def hold(engine, law, body):
    """A body that LOAD presses on its feet: law, overlap, stiffness of one foot."""
    n, radius = len(body.spheres) - 1, body.spheres[-1][3]
    if law == "linear":
        stiffness = LOAD / (1e-3 * R_EQ)
        return dem.Law("linear", stiffness / radius, GLASS.poisson, 1, stiffness), LOAD / n / stiffness, stiffness
    modulus = oracle.wall_modulus(GLASS, engine)
    overlap = (0.75 * LOAD / n / modulus / math.sqrt(radius)) ** (2 / 3)
    return GLASS._replace(restitution=1), overlap, 2 * modulus * math.sqrt(radius * overlap)


def stable(rows, energy):
    """Of a motion of 10^-6 of the overlap: its energy never is 10^4 of what it was."""
    energies = [sum(row) for row in rows[1:]]
    return 0 < min(energies) and max(energies) < 1e4 * energy  # 0: it has left the box


def largest_step(folder, engine, body, law, start, expected):
    """By three grids of steps, from 1/4 to 2 of what is expected down to 0.1 %: the last before the first that is
    unstable. Each run has 500 steps; at 0.1 % above the limit an undamped amplitude grows by exp(0.09) in each.
    LIGGGHTS and LAMMPS tell the velocity of a whole step, which is 0 in a motion of two steps that neither grows nor
    decays any more: there each step is looked at. YADE tells that of half a step."""
    low, factor = expected / 4, 8 ** (1 / 16)
    for _ in range(3):
        grid = [low * factor ** k for k in range(17)]
        runs = dem.RUN[engine](folder, body, law, start, grid, *((4, 125) if engine == "YADE" else (500, 1)))
        good = [stable(rows, body.mass * start.velocity[2] ** 2 / 2) for rows in runs]
        if not good[0] or all(good):
            raise RuntimeError(f"{engine}: no limit from {grid[0]} to {grid[-1]} s: {good}")
        low, factor = grid[good.index(False) - 1], factor ** (1 / 16)
    return low


def measure_step(folder, engine, law, body, restitution):
    """Step, and 2/omega of its stiffest mode (heave or rock), less by the damping ratio z: root(1 + z^2) - z."""
    own, overlap, stiffness = hold(engine, law, body)
    feet = body.spheres[1:]
    heave = stiffness * len(feet) / body.mass
    rock = max(stiffness * sum(s[k] ** 2 for s in feet) / body.moments[1 - k] for k in (0, 1))
    omega = math.sqrt(max(heave, rock))
    ratio = 0.0
    if restitution < 1:
        b = oracle.ratio_of(restitution, engine != "YADE")
        # of a Hertz contact about a load: 2 root(5/6) b root(S m)
        ratio = math.sqrt(5 / 6) * b * omega / math.sqrt(stiffness / body.mass)
        own = own._replace(restitution=restitution)
    theory = 2 / omega * (math.sqrt(1 + ratio ** 2) - ratio)
    small = 1e-6 * overlap * omega
    start = dem.Start(R_EQ - overlap, (0.0, 0.0, -small), (0.0, 0.5 * small / R_EQ * (len(feet) > 1), 0.0),
                      LOAD / body.mass)
    step = largest_step(folder, engine, body, own, start, theory)
    radius = feet[0][3]
    return step, theory, step / theory, step / rayleigh(radius), step / rayleigh(R_EQ)


def run_steps(folder):
    table = Table("contact-steps.csv",
                  "engine case law restitution radius feet arm step theory over_theory over_rayleigh "
                  "over_rayleigh_eq cpu", 7)
    cases = [("radius", law, 1, radius, 1, 0.0) for law in ("hertz", "linear") for radius in (1.0, 0.5, 0.2, 0.1, 0.05)]
    cases += [("number", "hertz", e, 0.1, side, 0.2) for e in (1, 0.5) for side in (1, 2, 3, 4, 5)]
    cases += [("arm", "hertz", 1, 0.1, 0, arm) for arm in (0.2, 0.5, 0.9)]
    for case, law, restitution, radius, side, arm in cases:
        width = 2 * arm / (side - 1) if side > 1 else 0.0
        places = lay_square(side, width * R_EQ) if side else [(-arm * R_EQ, 0.0), (arm * R_EQ, 0.0)]
        body = make_feet(radius * R_EQ, places)
        body = locked(body) if len(places) == 1 else body  # on one foot it would fall over
        for engine in dem.ENGINES:
            table.add(lambda: measure_step(folder, engine, law, body, restitution), engine, case, law, restitution,
                      radius, len(places), arm)


def run_tables(_):
    contact_tables.fill()


def main():
    names = ["walls", "masses", "impacts", "steps", "tables"]
    tasks = sys.argv[1:] or names
    if not set(tasks) <= set(names):
        sys.exit(__doc__.strip())
    with tempfile.TemporaryDirectory(prefix="contact-") as folder:
        for task in tasks:
            globals()["run_" + task](folder)


if __name__ == "__main__":
    main()
