#!/usr/bin/env python3
"""Yuan (2019), section 5.3: 130 M&M candies tumble in a drum at 25 revolutions a minute, in LIGGGHTS, by clumps of set
cover scaled to the volume of the candy.

    docs/experiments/drum.py [--spheres N,...] [--seeds K] [--work FOLDER] [--most MINUTES]

Each row goes to drum.csv beside this file; rows that are there are not run again. Then two tables of all of them go
into docs/behaviour.md, which --seeds 0 does alone. N = 0 is the candy itself, a superquadric. MSKIT names the program
(build/eval/mskit), LIGGGHTS the engine (liggghts), LIGGGHTS_SMOOTH one that was built with superquadrics. Takes numpy.

The paper does not give the size of its drum. This one has a diameter of 100 mm and no ends: it is 40 mm long and
periodic along its axis, so that ends play no part. Candies come in during the first turn. Material and friction are
those of packing.py, the step is that of contrasts.py. What is measured, as fixed before the first run in the table, of
ten turns from the fourth on, every 0.1 s:
    angle        degrees of the line of least squares through the highest points over lines 1 mm apart, averaged along
                 the axis, of the middle part of the bed, which is as wide as the drum's radius
    bare         looks in which the bed does not reach over all of that part, which are left out (added later, when one
                 run had one; one of twenty or more is refused)
    correlation  its correlation time, s: the integral of its autocorrelation up to where that first falls below 0
    blocks       its means over 20 blocks of 1.2 s, taken as independent where they are ten times as long as that
A second table holds runs beside their blocks, by shuffling as in soundness.py. A look has the variance of a block times
its length over twice the correlation time. Yuan's angle is the mean of ten looks, far enough apart to be independent.
"""
import argparse
import math
import os
import statistics
import sys
import time

import numpy

import contrasts_tables
from bed import LIGGGHTS_SMOOTH, SMOOTH, SPHERES, ball, ellipsoid
from contrasts_cells import make_smooth
from intervals import interval, interval_by_own, pool, quantile
from packing import (ENERGY, LIGGGHTS, MATERIAL, RESTITUTION, SEEDS, YOUNG, make_clump, put_in_order, read_dumps,
                     read_seeds, run_engine)
from program import ask_version, read_counts
import soundness
import tables  # of docs, where packing looks

HERE = os.path.dirname(os.path.abspath(__file__))
TABLE = os.path.join(HERE, "drum.csv")
COLUMNS = ["n", "dice", "seed", "step", "particles", "angle", "bare", "correlation", "blocks", "cpu_seconds", "version"]
COUNT, RADIUS, LENGTH, TURN, LOOK = 130, 50.0, 40.0, 60 / 25, 0.1  # particles, mm, mm, s, s
SKIPPED, TURNS, BLOCKS = 3, 10, 20
LOOKS = 10  # of which Yuan took the mean

# Of a wall that turns, LIGGGHTS 3.8.0 takes any direction but the axis, and for its speed radians a second.
SCRIPT = """atom_style {style}
atom_modify map array
communicate single vel yes
boundary f f p
newton off
units si
region box block -0.051 0.051 -0.051 0.051 0 {length} units box
create_box 2 box
neighbor 0.001 bin
neigh_modify delay 0
""" + MATERIAL + """fix friction all property/global coefficientFriction peratomtypepair 2 0.35 0.30 0.30 0.30
pair_style gran model hertz tangential history{surface}
pair_coeff * *
timestep {step}
fix drum all wall/gran model hertz tangential history{surface} primitive type 2 zcylinder {radius} 0 0 shear x {turning}
fix gravity all gravity 9.81 vector 0 -1 0
{template}
fix kinds all particledistribution/discrete 15485867 1 clump 1.0
region inside cylinder z 0 0 0.042 0 {length} volume_limit 1e-300 units box
fix insert all insert/rate/region seed {seed} distributiontemplate kinds nparticles {count} particlerate {count} &
    insert_every {often} vel constant 0 0 0 orientation random overlapcheck yes all_in no region inside
""" + ENERGY + """thermo_style custom step atoms v_kinetic
thermo {each}
run {skipped}
dump looks all custom {each} looks.dump id type x y z {columns}
dump_modify looks sort id
run {measured}
"""


def make_script(template, seed, step, smooth):
    each = round(LOOK / step)
    return SCRIPT.format(template=template, seed=seed, step=step, each=each, count=COUNT, radius=RADIUS / 1000,
                         length=LENGTH / 1000, often=2 * each, turning=2 * math.pi / TURN,
                         skipped=round(SKIPPED * TURN / step), measured=round(TURNS * TURN / step), young=YOUNG,
                         e=RESTITUTION, **({**SMOOTH, "group": "all"} if smooth else SPHERES))


def list_bodies(rows):
    """Those of a look as bed.measure takes them, upwards and along the drum in each other's place: the drum turned by
    90 degrees about x, y up to z. rows: as LIGGGHTS writes them, of spheres or of superquadrics."""
    rows = numpy.array(rows)
    x, y, z = 1000 * rows[:, :3].T
    if rows.shape[1] == 4:
        return [ball(*row) for row in numpy.stack([x, -z, y, 1000 * rows[:, 3]], axis=1)]
    w, i, j, k = rows[:, 6:].T
    turned = math.sqrt(0.5) * numpy.stack([w - i, w + i, j - k, j + k], axis=1)
    return [ellipsoid(*at, 1000 * row[3:6], turn) for at, row, turn in zip(zip(x, -z, y), rows, turned)]


def measure(bodies, h=1.0):
    """The angle of a look, in degrees, of bodies in mm; NaN where the bed is bare."""
    x = numpy.arange(-RADIUS / 2, RADIUS / 2 + h / 2, h)
    z = (numpy.arange(round(LENGTH / h)) + 0.5) * h
    top = numpy.full((len(x), len(z)), numpy.nan)
    for cx, cz, cy, reach, chords in bodies:
        i = slice(*numpy.searchsorted(x, [cx - reach, cx + reach]))
        along = (z - cz + LENGTH / 2) % LENGTH - LENGTH / 2
        top[i] = numpy.fmax(top[i], cy + chords(x[i, None] - cx, along[None, :])[1])
    if numpy.isnan(top).all(axis=1).any():
        return math.nan
    return abs(math.degrees(math.atan(numpy.polyfit(x, numpy.nanmean(top, axis=1), 1)[0])))


def find_correlation(series):
    """Integral of the autocorrelation to where it first falls below 0, in s, the value at 0 by half."""
    moved = numpy.asarray(series) - numpy.mean(series)
    total = 0.5
    for lag in range(1, len(moved)):
        rho = (moved[lag:] * moved[:-lag]).sum() / (moved ** 2).sum()
        if rho < 0:
            break
        total += rho
    return LOOK * total


def leave_out_bare(angles, work):
    """Those of looks with an angle, and how many have none."""
    seen = [angle for angle in angles if not math.isnan(angle)]
    bare = len(angles) - len(seen)
    if 20 * bare >= len(angles):
        sys.exit(f"{work}: in {bare} of {len(angles)} looks the bed is bare in the middle, where its angle would be")
    return seen, bare


def run(folder, n, seed):
    """One row."""
    version = ask_version()  # before the engine: a program that is not there would cost the run
    if n:
        template, said = make_clump(folder, n)
        dice = said["scores"]["dice"]
    else:
        template, dice = make_smooth("smooth")["template"], 0.0
    work, members = os.path.join(folder, f"{n}-{seed}"), n or 1
    _, cpu = run_engine(work, make_script(template, seed, contrasts_tables.STEP, not n),
                        LIGGGHTS if n else LIGGGHTS_SMOOTH)
    angles = []
    for rows in read_dumps(os.path.join(work, "looks.dump")):
        if len(rows) != COUNT * members:
            sys.exit(f"{work}: {len(rows)} rows are not those of {COUNT} particles of {members}")
        angles.append(measure(list_bodies(rows)))
    del angles[0]  # of before the first turn that counts
    angles, bare = leave_out_bare(angles, work)
    blocks = [statistics.mean(block) for block in numpy.array_split(angles, BLOCKS)]
    return {"n": n, "dice": dice, "seed": seed, "step": contrasts_tables.STEP, "particles": COUNT,
            "angle": round(statistics.mean(angles), 3), "bare": bare, "correlation": round(find_correlation(angles), 3),
            "blocks": " ".join(f"{block:.3f}" for block in blocks), "cpu_seconds": cpu, "version": version}


def list_blocks(rows):
    """By number of spheres, the candy itself last, the blocks of each run."""
    return {n: [[float(x) for x in row["blocks"].split()] for row in rows if int(row["n"]) == n]
            for n in sorted({int(row["n"]) for row in rows}, key=lambda n: n or math.inf)}


def list_references(joined):
    """Of the numbers those that others are held against: the most spheres, and the candy itself where it was run."""
    return [max(joined), *([0] if 0 in joined and len(joined) > 1 else [])]


def name(n):
    return f"{n} spheres" if n else "the candy"


def make_table(rows):
    """Mean and half of its 90 % interval by blocks, whose spread is pooled over all runs; difference from the most
    spheres, and from the candy itself, that over D as well."""
    if not rows:
        return "None was run yet."
    blocks = list_blocks(rows)
    deviation, freedom = pool([run for runs in blocks.values() for run in runs])
    joined = {n: [x for run in runs for x in run] for n, runs in blocks.items()}
    out, references = [], list_references(joined)
    for n, these in joined.items():
        found = [row for row in rows if int(row["n"]) == n]
        half = quantile(freedom) * deviation / math.sqrt(len(these))
        beside = [interval(these, joined[other], deviation, freedom) for other in references]
        out.append([str(n or "smooth"), f"{float(found[0]['dice']):.4f}", str(len(found)),
                    f"{statistics.mean(these):.2f} +- {half:.2f}",
                    *("" if n == other else contrasts_tables.show(*difference, 2)
                      for other, difference in zip(references, beside)),
                    *([f"{beside[-1][0] / float(found[0]['dice']):.0f}" if n else ""] if 0 in references else []),
                    ", ".join(f"{float(row['correlation']):.2f}" for row in found),
                    f"{statistics.mean(float(row['cpu_seconds']) for row in found):.0f}"])
    return tables.markdown(["spheres", "D", "runs", "angle, degrees", *(f"beside {name(n)}" for n in references),
                            *(["over D"] if 0 in references else []), "correlation, s", "CPU s"], out)


def find_look(deviation, correlation):
    """Standard deviation of one look, of that of blocks and the correlation time."""
    return deviation * math.sqrt(TURNS * TURN / BLOCKS / (2 * correlation))


def table_soundness(rows):
    """Of each number of spheres what its blocks scatter, its runs beside what their blocks let expect, the difference
    from the most spheres by variances of their own, and what a look scatters and two means of ten differ by; p of one
    variance of all runs, and of no difference between runs of a number."""
    if not rows:
        return "None was run yet."
    blocks, out = list_blocks(rows), []
    joined = {n: [x for run in runs for x in run] for n, runs in blocks.items()}
    references = list_references(joined)
    for n, runs in blocks.items():
        deviation, freedom = pool(runs)
        look = find_look(deviation, statistics.mean(float(row["correlation"]) for row in rows if int(row["n"]) == n))
        means = f"{statistics.stdev(map(statistics.mean, runs)):.2f}" if len(runs) > 1 else ""
        own = ["" if n == other else contrasts_tables.show(*interval_by_own(joined[n], joined[other]), 2)
               for other in references]
        out.append([str(n or "smooth"), f"{deviation:.2f}", means, f"{deviation / math.sqrt(BLOCKS):.2f}", *own,
                    f"{look:.2f}", f"{quantile(freedom) * look * math.sqrt(2 / LOOKS):.2f}"])
    values, of_run, of_number = zip(*((x, f"{n}-{k}", n) for n, runs in blocks.items() for k, run in enumerate(runs)
                                      for x in run))
    variances = soundness.judge_variances([run for runs in blocks.values() for run in runs])
    out.append(["p", f"{variances:.2f}", f"{soundness.judge_groups(values, of_run, of_number):.2f}"]
               + [""] * (3 + len(references)))
    return tables.markdown(["spheres", "spread of blocks", "of the runs' means", "by their blocks",
                            *(f"beside {name(n)}, own variances" for n in references), "spread of a look",
                            f"interval of a difference, {LOOKS} looks"], out)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spheres", type=read_counts, default=[10, 30, 60, 120],
                        help="of a candy (10,30,60,120); 0: the candy itself")
    parser.add_argument("--seeds", type=read_seeds, default=2, help="runs of each (2)")
    parser.add_argument("--work", default="drum", help="folder of the engine's files (drum)")
    parser.add_argument("--most", type=float, default=1e9, help="no run is begun after so many minutes")
    asked = parser.parse_args()
    if asked.seeds and 0 in asked.spheres and not LIGGGHTS_SMOOTH:
        sys.exit("0 spheres: LIGGGHTS_SMOOTH names no engine with superquadrics; build-smooth.sh makes one")
    os.makedirs(asked.work, exist_ok=True)
    begun, rows = time.time(), tables.read_if_there(TABLE, COLUMNS)
    there = {(int(row["n"]), int(row["seed"])) for row in rows}
    for seed in SEEDS[:asked.seeds]:
        for n in asked.spheres:
            if (n, seed) in there or time.time() - begun > 60 * asked.most:
                continue
            row = run(asked.work, n, seed)
            tables.add_row(TABLE, COLUMNS, row)
            print(", ".join(f"{key} {row[key]}" for key in ("n", "seed", "angle", "correlation", "cpu_seconds")),
                  flush=True)
    rows = put_in_order(tables.read_if_there(TABLE, COLUMNS), "n")
    tables.fill(os.path.join(HERE, "..", "behaviour.md"),
                {"drum": make_table(rows), "drum-soundness": table_soundness(rows)})


if __name__ == "__main__":
    main()
