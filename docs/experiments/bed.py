"""A bed of 250 particles in LIGGGHTS: it falls into a box, is measured at rest, and is tilted until it flows and back
until it stands. What contrasts.py and library.py share; contrasts.py says what is measured."""
import math
import os
import re
import sys

import numpy

from packing import CLUMPS, ENERGY, LIGGGHTS, MATERIAL, REST, SETTLE, read_dump, run_to_rest
from program import ask_version

COUNT, SIDE, PASS = 250, 60.0, 0.01  # particles, mm, s between two looks at the velocity
# An engine with superquadrics, for the cell smooth: the packaged one has none.
LIGGGHTS_SMOOTH = os.environ.get("LIGGGHTS_SMOOTH")
# What differs between spheres and superquadrics in the script.
SPHERES = {"style": "granular", "surface": "", "base": "diameter 0.0075", "gather": "", "columns": "radius", **CLUMPS}
SMOOTH = {"style": "superquadric", "surface": " surface superquadric",
          "base": "shape 0.00375 0.00375 0.00375 blockiness 2 2", "gather": "group candies type 1\n",
          "group": "candies", "move": "nve/superquadric integration_scheme 1", "ke": "ke",
          "erotate": "erotate/superquadric", "columns": "shapex shapey shapez quat1 quat2 quat3 quat4"}
MOVES, FLOWS, STANDS = 0.01, 0.05, 0.002  # m/s
FRICTION = 0.35

TILT = """variable angle equal ${{next}}
variable x equal sin(${{angle}}*PI/180)
variable z equal -cos(${{angle}}*PI/180)
fix gravity all gravity 9.81 vector ${{x}} 0 ${{z}}
run {each}
variable now equal ${{speed}}
"""

SCRIPT = """atom_style {style}
atom_modify map array
communicate single vel yes
boundary p p f
newton off
units si
region box block 0 0.06 0 0.06 -0.01 0.55 units box
create_box 2 box
neighbor 0.001 bin
neigh_modify delay 0
""" + MATERIAL + """fix friction all property/global coefficientFriction peratomtypepair 2 {frictions}
fix rolling all property/global coefficientRollingFriction peratomtypepair 2 {rolling} {rolling} {rolling} {rolling}
pair_style gran model hertz tangential history {model}{surface}
pair_coeff * *
timestep {step}
lattice sc 0.0075
region base block 0 0.0599 0 0.0599 -0.0001 0.0001 units box
create_atoms 2 region base
set type 2 {base} density 1377
group base type 2
fix hold base freeze
fix floor all wall/gran model hertz tangential history {model}{surface} primitive type 2 zplane 0
fix gravity all gravity 9.81 vector 0 0 -1
{template}
fix kinds all particledistribution/discrete 15485867 {kinds}
region above block 0 0.06 0 0.06 0.012 0.5 volume_limit 1e-300 units box
{gather}fix insert {group} insert/pack seed {seed} distributiontemplate kinds insert_every once overlapcheck yes &
    orientation random all_in no particles_in_region {count} region above
""" + ENERGY + """compute along all property/atom vx
compute flow all reduce sum c_along
variable speed equal c_flow/{spheres}
thermo_style custom step atoms v_kinetic v_speed
thermo {each}
run {falling}
{forget}
""" + SETTLE + """group candies type 1
write_dump candies custom settled.dump id type x y z {columns} modify sort id
variable angle equal 0
variable up loop 10000
label rise
if "${{angle}} < 15.999" then "variable next equal ${{angle}}+{fast}" else "variable next equal ${{angle}}+{slow}"
""" + TILT + """print "RISE ${{angle}} ${{now}}"
if "${{now}} > {flows} || ${{angle}} > 60" then "jump SELF flows"
next up
jump SELF rise
label flows
variable down loop 10000
label fall
variable next equal ${{angle}}-{slow}
""" + TILT + """print "FALL ${{angle}} ${{now}}"
if "${{now}} < {stands} || ${{angle}} < 0" then "jump SELF stands"
next down
jump SELF fall
label stands
write_dump candies custom flowed.dump id type x y z {columns} modify sort id
"""


def measure(bodies, h=0.5):
    """Height and fraction. bodies: x, y, z in mm, how far it reaches from there, and a function of the distances x, y
    of vertical lines from there that gives the z from there between which they are within it, NaN where they miss."""
    count = round(SIDE / h)
    layers = math.ceil(max(z + reach for _, _, z, reach, _ in bodies) / h) + 1
    z = (numpy.arange(layers) + 0.5) * h
    top, filled = numpy.zeros((count, count)), numpy.zeros((count, count, layers), dtype=bool)
    for cx, cy, cz, reach, chords in bodies:
        # the cells of a line that the body may reach, counted on beyond the box, and their distances from its centre
        lines = [numpy.arange(math.floor((c - reach) / h), math.ceil((c + reach) / h)) for c in (cx, cy)]
        at = numpy.ix_(*(line % count for line in lines))
        x, y = ((line + 0.5) * h - c for line, c in zip(lines, (cx, cy)))
        low, high = chords(x[:, None], y[None, :])
        top[at] = numpy.fmax(top[at], cz + high)
        k = slice(*numpy.searchsorted(z, [cz - reach, cz + reach]))
        filled[(*at, k)] |= (z[k] >= cz + low[:, :, None]) & (z[k] <= cz + high[:, :, None])
    height = float(top.mean())
    middle = (z >= height / 4) & (z <= 3 * height / 4)
    return height, float(filled[:, :, middle].mean())


def root_or_nan(x):
    return numpy.sqrt(numpy.where(x > 0, x, numpy.nan))


def ball(x, y, z, r):
    """A body of measure()."""
    def chords(dx, dy):
        half = root_or_nan(r * r - dx ** 2 - dy ** 2)
        return -half, half
    return x, y, z, r, chords


def ellipsoid(x, y, z, axes, quaternion):
    """The same, of half axes in mm that the quaternion w, x, y, z turns."""
    w, (i, j, k) = quaternion[0], quaternion[1:]
    cross = numpy.array([[0, -k, j], [k, 0, -i], [-j, i, 0]])
    turn = numpy.eye(3) + 2 * w * cross + 2 * cross @ cross
    m = turn @ numpy.diag(1 / numpy.square(axes)) @ turn.T

    def chords(dx, dy):  # where (dx, dy, z) m (dx, dy, z) = 1
        b = (m[0, 2] * dx + m[1, 2] * dy) / m[2, 2]
        half = root_or_nan(b ** 2 + (1 - m[0, 0] * dx ** 2 - 2 * m[0, 1] * dx * dy - m[1, 1] * dy ** 2) / m[2, 2])
        return -b - half, -b + half
    return x, y, z, max(axes), chords


def find_angles(rise, fall):
    """start and stop, of (degrees, m/s) on the way up and back; None where the bed did not flow, or not stand."""
    if not rise or rise[-1][1] <= FLOWS or not fall or fall[-1][1] >= STANDS:
        return None, None
    first = len(rise) - 1
    while first > 0 and rise[first - 1][1] > MOVES:
        first -= 1
    return rise[first][0], next(angle for angle, speed in fall if speed < MOVES)


def make_script(clump, seed, step, rate):
    """clump: as of contrasts_cells.make; template and kinds may name several."""
    each, rolling = round(PASS / step), clump["rolling"]
    # Each run looks through all templates for each of them: of 250 that is nine tenths of the time.
    forget = "\n".join("unfix " + name for name in ["insert", "kinds", *re.findall(r"^fix (\S+) all particletemplate",
                                                                               clump["template"], re.MULTILINE)])
    return SCRIPT.format(template=clump["template"], kinds=clump["kinds"], spheres=COUNT * clump["members"],
                         frictions=" ".join([repr(clump["friction"])] * 4), rolling=rolling,
                         model="rolling_friction epsd2" if rolling else "", seed=seed, step=step, count=COUNT,
                         forget=forget, rest=REST, each=each, falling=60 * each, tenth=10 * each, slow=rate * PASS,
                         fast=4 * rate * PASS, flows=FLOWS, stands=STANDS, young=clump["young"], e=clump["e"],
                         **(SMOOTH if clump["smooth"] else SPHERES))


def read_bodies(path, clump):
    """Those of a bed for measure(), particle by particle."""
    rows = read_dump(path)
    if len(rows) != COUNT * clump["members"]:
        sys.exit(f"{path}: {len(rows)} are not those of {COUNT} particles")
    if clump["smooth"]:
        return [ellipsoid(*(1000 * row[:3]), 1000 * row[3:6], row[6:]) for row in rows]
    return [ball(*row) for row in 1000 * rows]


def run_bed(work, clump, seed, step, rate):
    """What is measured of one bed."""
    version = ask_version()  # before the engine: a program that is not there would cost the run
    text, kinetic, cpu = run_to_rest(work, make_script(clump, seed, step, rate),
                                     LIGGGHTS_SMOOTH if clump["smooth"] else LIGGGHTS)
    rise, fall = ([(float(a), float(v)) for a, v in re.findall(rf"^{way} (\S+) (\S+)", text, re.MULTILINE)]
                  for way in ("RISE", "FALL"))
    start, stop = find_angles(rise, fall)
    if start is None:
        sys.exit(f"{work}: the bed did not flow, or not stand again; see {work}/out")
    (height, fraction), (_, flowed) = (measure(read_bodies(os.path.join(work, when + ".dump"), clump))
                                       for when in ("settled", "flowed"))
    steps = int(re.findall(r"^\s*(\d+)\s+\d+\s+\S+\s+\S+\s*$", text, re.MULTILINE)[-1])
    return {"seed": seed, "step": step, "rate": rate, "particles": COUNT, "height": round(height, 3),
            "fraction": round(fraction, 5), "start": round(start, 2), "stop": round(stop, 2),
            "flowed": round(flowed, 5), "kinetic_over_m_g_d": kinetic, "seconds": round(steps * step, 2),
            "cpu_seconds": cpu, "version": version}
