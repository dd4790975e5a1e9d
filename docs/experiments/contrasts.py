#!/usr/bin/env python3
"""How many spheres are enough in bulk: beds of M&M candies by clumps that differ in one thing, in LIGGGHTS.

    docs/experiments/contrasts.py [--seeds K] [--cells NAME,...] [--largest N] [--step SECONDS] [--rate DEGREES]
                                  [--work FOLDER] [--most MINUTES]

A cell is a clump (contrasts_cells.py); a run is a cell with a seed. Each adds a row to contrasts.csv beside this file;
rows that are there are not run again. Then tables and chart of all of them go into docs/behaviour.md, which --seeds 0
does alone. MSKIT names the program (build/eval/mskit), LIGGGHTS the engine (liggghts). Takes numpy, and gnuplot.

Material, friction and stiffness are Yuan's (packing.py). A box of 60 x 60 mm, periodic in x and y, has a floor of 8 x 8
fixed spheres that touch. 250 candies in random orientations fall onto it from up to half a metre, all at once. At rest
(kinetic energy below 1e-6 m g d each) height and fraction are measured; then gravity tilts towards x, by RATE degrees a
second from 16 degrees on and four times as fast before, until the bed flows at 0.05 m/s, and back until it stands.
    height    mean of the highest points along vertical lines 0.5 mm apart, above the centres of the floor's spheres, mm
    fraction  between 1/4 and 3/4 of the height, the part within spheres (voxels of 0.5 mm)
    start     degrees at which the mean velocity along x rises above 0.01 m/s and stays there until the bed flows
    stop      degrees at which, on the way back, it falls below that
    flowed    the fraction once it is below 0.002 m/s
Velocity is the mean over all spheres, every 0.01 s.
"""
import argparse
import math
import os
import re
import sys
import time

import numpy

import contrasts_cells as cells
import contrasts_chart
import contrasts_tables
from packing import ENERGY, MATERIAL, REST, SEEDS, SETTLE, ask_version, read_spheres, run_to_rest
from tables import add_row

HERE = os.path.dirname(os.path.abspath(__file__))
TABLE = os.path.join(HERE, "contrasts.csv")
COLUMNS = ["cell", "seed", "step", "rate", "particles", "height", "fraction", "start", "stop", "flowed",
           "kinetic_over_m_g_d", "seconds", "cpu_seconds", "version"]
COUNT, SIDE, PASS = 250, 60.0, 0.01  # particles, mm, s between two looks at the velocity
MOVES, FLOWS, STANDS = 0.01, 0.05, 0.002  # m/s

TILT = """variable angle equal ${{next}}
variable x equal sin(${{angle}}*PI/180)
variable z equal -cos(${{angle}}*PI/180)
fix gravity all gravity 9.81 vector ${{x}} 0 ${{z}}
run {each}
variable now equal ${{speed}}
"""

SCRIPT = """atom_style granular
atom_modify map array
communicate single vel yes
boundary p p f
newton off
units si
region box block 0 0.06 0 0.06 -0.01 0.55 units box
create_box 2 box
neighbor 0.001 bin
neigh_modify delay 0
""" + MATERIAL + """fix friction all property/global coefficientFriction peratomtypepair 2 0.35 0.35 0.35 0.35
fix rolling all property/global coefficientRollingFriction peratomtypepair 2 {rolling} {rolling} {rolling} {rolling}
pair_style gran model hertz tangential history {model}
pair_coeff * *
timestep {step}
lattice sc 0.0075
region base block 0 0.0599 0 0.0599 -0.0001 0.0001 units box
create_atoms 2 region base
set type 2 diameter 0.0075 density 1377
group base type 2
fix hold base freeze
fix floor all wall/gran model hertz tangential history {model} primitive type 2 zplane 0
fix gravity all gravity 9.81 vector 0 0 -1
{template}
fix kinds all particledistribution/discrete 15485867 {kinds}
region above block 0 0.06 0 0.06 0.012 0.5 volume_limit 1e-300 units box
fix insert all insert/pack seed {seed} distributiontemplate kinds insert_every once overlapcheck yes &
    orientation random all_in no particles_in_region {count} region above
""" + ENERGY + """compute along all property/atom vx
compute flow all reduce sum c_along
variable speed equal c_flow/{spheres}
thermo_style custom step atoms v_kinetic v_speed
thermo {each}
run {falling}
""" + SETTLE + """group candies type 1
write_dump candies custom settled.dump id type x y z radius modify sort id
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
write_dump candies custom flowed.dump id type x y z radius modify sort id
"""


def measure(spheres, h=0.5):
    """Height and fraction; spheres in mm, as many as touch the box from any side."""
    count = round(SIDE / h)
    layers = math.ceil((spheres[:, 2] + spheres[:, 3]).max() / h) + 1
    z = (numpy.arange(layers) + 0.5) * h
    top, filled = numpy.zeros((count, count)), numpy.zeros((count, count, layers), dtype=bool)
    for cx, cy, cz, r in spheres:
        # the cells of a line that the sphere may reach, counted on beyond the box, and their distances from its centre
        lines = [numpy.arange(math.floor((c - r) / h), math.ceil((c + r) / h)) for c in (cx, cy)]
        at = numpy.ix_(*(line % count for line in lines))
        x, y = ((line + 0.5) * h - c for line, c in zip(lines, (cx, cy)))
        left = r * r - x[:, None] ** 2 - y[None, :] ** 2
        top[at] = numpy.maximum(top[at], numpy.where(left > 0, cz + numpy.sqrt(numpy.maximum(left, 0)), 0))
        k = slice(*numpy.searchsorted(z, [cz - r, cz + r]))
        filled[(*at, k)] |= left[:, :, None] >= (z[k] - cz) ** 2
    height = float(top.mean())
    middle = (z >= height / 4) & (z <= 3 * height / 4)
    return height, float(filled[:, :, middle].mean())


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
    return SCRIPT.format(template=clump["template"], kinds=clump["kinds"], spheres=COUNT * clump["members"],
                         rolling=rolling, model="rolling_friction epsd2" if rolling else "", seed=seed, step=step,
                         count=COUNT, rest=REST, each=each, falling=60 * each, tenth=10 * each, slow=rate * PASS,
                         fast=4 * rate * PASS, flows=FLOWS, stands=STANDS, young=clump["young"], e=clump["e"])


def run_bed(work, clump, seed, step, rate):
    """What is measured of one bed, and the spheres of the settled one, in mm, particle by particle."""
    text, kinetic, cpu = run_to_rest(work, make_script(clump, seed, step, rate))
    beds = {when: read_spheres(os.path.join(work, when + ".dump")) for when in ("settled", "flowed")}
    for when, spheres in beds.items():
        if len(spheres) != COUNT * clump["members"]:
            sys.exit(f"{work}: {len(spheres)} spheres {when} are not those of {COUNT} particles")
    rise, fall = ([(float(a), float(v)) for a, v in re.findall(rf"^{way} (\S+) (\S+)", text, re.MULTILINE)]
                  for way in ("RISE", "FALL"))
    start, stop = find_angles(rise, fall)
    if start is None:
        sys.exit(f"{work}: the bed did not flow, or not stand again; see {work}/out")
    height, fraction = measure(beds["settled"])
    steps = int(re.findall(r"^\s*(\d+)\s+\d+\s+\S+\s+\S+\s*$", text, re.MULTILINE)[-1])
    return {"seed": seed, "step": step, "rate": rate, "particles": COUNT, "height": round(height, 3),
            "fraction": round(fraction, 5), "start": round(start, 2), "stop": round(stop, 2),
            "flowed": round(measure(beds["flowed"])[1], 5), "kinetic_over_m_g_d": kinetic,
            "seconds": round(steps * step, 2), "cpu_seconds": cpu, "version": ask_version()}, beds["settled"]


def run(folder, name, seed, step, rate):
    """One row."""
    work = os.path.join(folder, f"{name}-{seed}-{step:g}-{rate:g}")
    measured, _ = run_bed(work, cells.make(folder, name), seed, step, rate)
    return {"cell": name, **measured}


def describe_clumps(folder):
    cells.describe_all(folder, contrasts_tables.CLUMPS)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=3, help="runs of each cell (3)")
    parser.add_argument("--cells", help="names, with commas between (all)")
    parser.add_argument("--largest", type=int, default=20, help="no clumps of more spheres (20)")
    parser.add_argument("--step", type=float, default=contrasts_tables.STEP, help="s (4e-5)")
    parser.add_argument("--rate", type=float, default=contrasts_tables.RATE, help="degrees a second (8)")
    parser.add_argument("--work", default="contrasts", help="folder of the engine's files (contrasts)")
    parser.add_argument("--most", type=float, default=1e9, help="no run is begun after so many minutes")
    asked = parser.parse_args()
    os.makedirs(asked.work, exist_ok=True)
    describe_clumps(asked.work)
    begun, rows = time.time(), contrasts_tables.read_runs(TABLE)
    there = {(row["cell"], int(row["seed"]), float(row["step"]), float(row["rate"])) for row in rows}
    for seed in SEEDS[:asked.seeds]:
        for name in asked.cells.split(",") if asked.cells else [*cells.CELLS, *cells.CONTROLS]:
            if cells.find_cell(name).n > asked.largest or (name, seed, asked.step, asked.rate) in there:
                continue
            if time.time() - begun > 60 * asked.most:
                break
            row = run(asked.work, name, seed, asked.step, asked.rate)
            add_row(TABLE, COLUMNS, row)
            print(", ".join(f"{key} {row[key]}" for key in COLUMNS if key not in ("particles", "version")), flush=True)
    contrasts_tables.fill()
    contrasts_chart.draw(contrasts_tables.read_runs(TABLE))


if __name__ == "__main__":
    main()
