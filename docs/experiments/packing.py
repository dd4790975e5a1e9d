#!/usr/bin/env python3
"""Yuan (2019), section 5.2: 250 M&M candies settle in a cylinder, in LIGGGHTS, by clumps of set cover scaled to the
volume of the candy.

    docs/experiments/packing.py [--spheres N] [--seeds K] [--step SECONDS] [--work FOLDER] [--most MINUTES]

Adds a row a packing to packing.csv beside it; rows that are there are not run again. Then puts two tables of all of
them into docs/behaviour.md, which --seeds 0 does alone. MSKIT names the program (build/eval/mskit), LIGGGHTS the engine
(liggghts). Numbers of the table are Yuan's (table 3); his time step is 5e-7 s. Takes numpy.

What is measured, as fixed before the first run, of the particles at rest (kinetic energy below 1e-6 m g d in the
mean):
    height_envelope  mean over vertical lines, 0.5 mm apart and 2 mm or more from the wall, of the highest point of a
                     sphere, in mm
    height_top       the highest point of any sphere, in mm
    fraction         of the cylinder between 1/4 and 3/4 of height_envelope, the part within spheres (voxels of 0.5 mm)
"""
import argparse
import json
import math
import os
import re
import resource
import statistics
import subprocess
import sys
import time

import numpy

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, ".."))
import tables  # noqa: E402
from intervals import interval, interval_of_mean, pool  # noqa: E402
from program import ask_version, read_count, read_positive, run_mskit  # noqa: E402
LIGGGHTS = os.environ.get("LIGGGHTS", "liggghts")
TABLE = os.path.join(HERE, "packing.csv")
COLUMNS = ["method", "n", "dice", "coverage", "scaled_by", "seed", "step", "particles", "height_envelope", "height_top",
           "fraction", "kinetic_over_m_g_d", "steps", "cpu_seconds", "version"]
# of the tables: column, heading, digits
SHOWN = [("height_envelope", "mean of the upper envelope, mm", 2), ("height_top", "highest point, mm", 2),
         ("fraction", "packing fraction", 4)]

RADIUS, A, C, DENSITY, COUNT = 25.4, 6.585, 3.395, 1377, 250  # mm, kg/m^3
MASS = DENSITY * 4 / 3 * math.pi * A * A * C * 1e-9
REST = 1e-6 * MASS * 9.81 * 2 * A * 1e-3  # J a particle
# Primes, none of them a seed of the script itself: LIGGGHTS refuses a seed that stands twice.
SEEDS = [32452843, 49979687, 67867967, 86028121, 413158511, 104395301, 122949823, 141650939, 160481183, 179424673,
         198491317, 217645177, 236887691, 256203161, 275604541, 295075147, 314606869, 334214459, 353868013, 373587883]

# What the beds of contrasts.py share. Yuan's candies; kinetic energy a particle; and looks at it until all are at rest.
YOUNG, RESTITUTION = 5e7, 0.5  # Pa
MATERIAL = """hard_particles yes
fix young all property/global youngsModulus peratomtype {young:g} {young:g}
fix poisson all property/global poissonsRatio peratomtype 0.29 0.29
fix restitution all property/global coefficientRestitution peratomtypepair 2 {e:g} {e:g} {e:g} {e:g}
"""
CLUMPS = {"group": "all", "move": "multisphere", "ke": "ke/multisphere", "erotate": "erotate/multisphere"}
ENERGY = """fix move {group} {move}
compute moved all {ke}
compute turned all {erotate}
variable kinetic equal (c_moved+c_turned)/{count}
"""
SETTLE = """variable k loop 100
label settle
run {tenth}
variable now equal ${{kinetic}}
if "${{now}} < {rest}" then "jump SELF rest"
next k
jump SELF settle
label rest
print "at rest: ${{now}} J"
"""

SCRIPT = """atom_style granular
atom_modify map array
communicate single vel yes
boundary f f f
newton off
units si
region box block -0.0264 0.0264 -0.0264 0.0264 -0.002 0.26 units box
create_box 2 box
neighbor 0.0005 bin
neigh_modify delay 0
""" + MATERIAL + """fix friction all property/global coefficientFriction peratomtypepair 2 0.35 0.30 0.30 0.30
pair_style gran model hertz tangential history
pair_coeff * *
timestep {step}
fix gravity all gravity 9.81 vector 0 0 -1
fix floor all wall/gran model hertz tangential history primitive type 2 zplane 0
fix side all wall/gran model hertz tangential history primitive type 2 zcylinder 0.0254 0 0
{template}
fix kinds all particledistribution/discrete 15485867 1 clump 1.0
region above cylinder z 0 0 0.0254 0.18 0.25 volume_limit 1e-300 units box
# four at a time fall, as in the paper
fix insert all insert/rate/region seed {seed} distributiontemplate kinds nparticles {count} particlerate 160 &
    insert_every {every} vel constant 0 0 -0.5 orientation random overlapcheck yes all_in yes region above
""" + ENERGY + """thermo_style custom step atoms v_kinetic
thermo {every}
run {filling}
""" + SETTLE + """write_dump all custom packing.dump id type x y z radius modify sort id
"""


def find_candy(folder):
    shape = os.path.join(folder, "candy.stl")
    if not os.path.exists(shape):
        run_mskit("shape", "ellipsoid", f"a={A}", f"b={A}", f"c={C}", "-o", shape)
    return shape


def make_clump(folder, n):
    """The template's line for LIGGGHTS, and what mskit says of the clump."""
    clump = os.path.join(folder, f"candy-{n}.liggghts")
    said = run_mskit("generate", find_candy(folder), "-g", "setcover", "-n", n, "--deq", 100, "--equal-volume",
                     "--correct", "--density", DENSITY, "--unit", "mm", "-o", clump, "--json")
    with open(clump + ".in", encoding="utf-8") as stream:
        line = next(line for line in stream if line.startswith("fix clump "))
    return line.replace(os.path.basename(clump), os.path.abspath(clump)), json.loads(said)


def read_dumps(path):
    """Of each dump in a file what stands behind id and type, as x, y, z, r, in the engine's units."""
    with open(path, encoding="utf-8") as stream:
        while stream.readline():  # ITEM: TIMESTEP, its number, ITEM: NUMBER OF ATOMS; box and columns stand behind that
            stream.readline(), stream.readline()
            count = int(stream.readline())
            for _ in range(5):
                stream.readline()
            yield numpy.array([stream.readline().split()[2:] for _ in range(count)], dtype=float)


def read_dump(path):
    """The last one."""
    *_, last = read_dumps(path)
    return last


def read_spheres(path):
    """x, y, z, r of the last dump, in mm."""
    return 1000 * read_dump(path)


def measure(spheres, h=0.5):
    """height_envelope, height_top, fraction."""
    ticks = numpy.arange(-RADIUS, RADIUS + h, h)
    x, y = numpy.meshgrid(ticks, ticks, indexing="ij")
    within, inner = x * x + y * y <= RADIUS ** 2, x * x + y * y <= (RADIUS - 2) ** 2
    top = numpy.zeros_like(x)
    layers = int(math.ceil((spheres[:, 2] + spheres[:, 3]).max() / h)) + 1
    filled = numpy.zeros(x.shape + (layers,), dtype=bool)
    z = (numpy.arange(layers) + 0.5) * h
    for cx, cy, cz, r in spheres:
        i = slice(*numpy.searchsorted(ticks, [cx - r, cx + r]))
        j = slice(*numpy.searchsorted(ticks, [cy - r, cy + r]))
        k = slice(*numpy.searchsorted(z, [cz - r, cz + r]))
        left = r * r - (x[i, j] - cx) ** 2 - (y[i, j] - cy) ** 2
        numpy.maximum(top[i, j], numpy.where(left > 0, cz + numpy.sqrt(numpy.maximum(left, 0)), 0), out=top[i, j])
        filled[i, j, k] |= left[:, :, None] >= (z[k] - cz) ** 2
    height = float(top[inner].mean())
    middle = (z >= height / 4) & (z <= 3 * height / 4)
    return height, float((spheres[:, 2] + spheres[:, 3]).max()), float(filled[within][:, middle].mean())


def run_engine(work, script, engine=LIGGGHTS):
    """What LIGGGHTS prints, and CPU seconds. Ends here where it fails."""
    os.makedirs(work, exist_ok=True)
    with open(os.path.join(work, "in.bed"), "w", encoding="utf-8") as stream:
        stream.write(script)
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    with open(os.path.join(work, "out"), "w", encoding="utf-8") as out:
        try:
            done = subprocess.run([engine, "-in", "in.bed", "-log", "none"], cwd=work, stdout=out,
                                  stderr=subprocess.STDOUT, check=False)
        except OSError as error:
            sys.exit(f"{engine}: {error.strerror}; LIGGGHTS names the engine, LIGGGHTS_SMOOTH one with superquadrics")
    if done.returncode:
        sys.exit(f"{work}: {engine} failed; see {work}/out")
    with open(os.path.join(work, "out"), encoding="utf-8") as out:
        return out.read(), round(resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before)


def run_to_rest(work, script, engine=LIGGGHTS):
    """What LIGGGHTS prints, kinetic energy at rest over m g d, CPU seconds. Ends here where there is no rest."""
    text, cpu = run_engine(work, script, engine)
    rest = re.search(r"^at rest: (\S+) J", text, re.MULTILINE)
    if not rest or float(rest[1]) >= REST:
        sys.exit(f"{work}: no rest; see {work}/out")
    return text, f"{float(rest[1]) / REST * 1e-6:.2g}", cpu


def pack(folder, n, seed, step):
    template, said = make_clump(folder, n)
    work = os.path.join(folder, f"{n}-{seed}-{step:g}")
    every = round(4 / 160 / step)
    script = SCRIPT.format(step=step, template=template, seed=seed, count=COUNT, every=every, rest=REST,
                           young=YOUNG, e=RESTITUTION, **CLUMPS,
                           filling=round((COUNT / 160 + 0.3) / step), tenth=round(0.1 / step))
    text, kinetic, cpu = run_to_rest(work, script)
    spheres = read_spheres(os.path.join(work, "packing.dump"))
    if len(spheres) % COUNT:
        sys.exit(f"{work}: {len(spheres)} spheres are not those of {COUNT} particles")
    height, top, fraction = measure(spheres)
    steps = re.findall(r"^\s*(\d+)\s+\d+\s+\S+\s*$", text, re.MULTILINE)[-1]
    return {"method": "setcover", "n": len(spheres) // COUNT, "dice": said["scores"]["dice"],
            "coverage": said["scores"]["coverage"],
            "scaled_by": said["equal_volume"]["scale"], "seed": seed, "step": step, "particles": COUNT,
            "height_envelope": round(height, 3), "height_top": round(top, 3), "fraction": round(fraction, 5),
            "kinetic_over_m_g_d": kinetic, "steps": steps, "cpu_seconds": cpu,
            "version": ask_version()}


def make_table(rows):
    """Mean, half of its 90 % interval, and standard deviation over the packings of so many spheres and one step."""
    out = []
    for n, step in dict.fromkeys((row["n"], row["step"]) for row in rows):
        these = [row for row in rows if (row["n"], row["step"]) == (n, step)]

        def spread(name, digits, these=these):
            values = [float(row[name]) for row in these]
            if len(values) == 1:
                return f"{values[0]:.{digits}f}"
            mean, half = interval_of_mean(values)
            return f"{mean:.{digits}f} +- {half:.{digits}f} ({statistics.stdev(values):.{digits}f})"
        dice = sorted({f"{float(row['dice']):.4f}" for row in these})
        out.append([n, " and ".join(dice), step, str(len(these)), *(spread(name, digits) for name, _, digits in SHOWN),
                    f"{statistics.mean(float(row['cpu_seconds']) for row in these):.0f}"])
    return tables.markdown(["spheres", "D", "step, s", "packings", *(head for _, head, _ in SHOWN), "CPU s"], out)


def tell_difference(these, those, name, digits):
    """With half of its 90 % interval, by the spread of the two."""
    groups = [[float(row[name]) for row in rows] for rows in (these, those)]
    difference, half = interval(*groups, *pool(groups))
    return f"{difference:+.{digits}f}" + ("" if math.isnan(half) else f" +- {half:.{digits}f}")


def table_differences(rows):
    """Of the first number of spheres and step the later clumps from the first one; then each other number from the one
    before, and other steps from packings of the same clump."""
    if not rows:
        return "None was run yet."
    first, *others = dict.fromkeys((row["n"], row["step"]) for row in rows)
    base = [row for row in rows if (row["n"], row["step"]) == first]
    known, *later = dict.fromkeys(row["dice"] for row in base)
    pairs = [(f"{first[0]} spheres, D {float(dice):.4f} - {float(known):.4f}",
              *([row for row in base if row["dice"] == of] for of in (dice, known))) for dice in later]
    before = first
    for n, step in others:
        these = [row for row in rows if (row["n"], row["step"]) == (n, step)]
        those = [row for row in base if row["dice"] == these[0]["dice"]]
        other = first if those else before
        those = those or [row for row in rows if (row["n"], row["step"]) == before]
        pairs.append((f"{n} spheres, {step} s - {other[0]} spheres, {other[1]} s", these, those))
        before = (n, step) if step == first[1] else before
    return tables.markdown(
        ["difference", "packings", *(head for _, head, _ in SHOWN)],
        [[what, f"{len(these)}, {len(those)}", *(tell_difference(these, those, name, digits)
                                                 for name, _, digits in SHOWN)] for what, these, those in pairs])


def read_seeds(text):
    """The argument that says how many of SEEDS."""
    seeds = read_count(text)
    if seeds > len(SEEDS):
        raise argparse.ArgumentTypeError(f"there are {len(SEEDS)} seeds, {seeds} are asked for")
    return seeds


def put_in_order(rows, *names):
    """By SEEDS, then by these columns: a run that is repeated goes to the end of the file, and neither what is drawn
    nor which runs are a cell's first may hang on that. Other seeds stand behind."""
    places = {str(seed): place for place, seed in enumerate(SEEDS)}
    return sorted(rows, key=lambda row: (places.get(row["seed"], len(SEEDS)), *(row[name] for name in names)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spheres", type=read_count, default=10, help="of a candy (10)")
    parser.add_argument("--seeds", type=read_seeds, default=20, help="packings (20)")
    parser.add_argument("--step", type=read_positive, default=1e-5, help="s (1e-5)")
    parser.add_argument("--work", default="packing", help="folder of the engine's files (packing)")
    parser.add_argument("--most", type=float, default=1e9, help="no packing is begun after so many minutes")
    asked = parser.parse_args()
    os.makedirs(asked.work, exist_ok=True)
    start, rows = time.time(), tables.read_if_there(TABLE, COLUMNS)
    there = {(int(row["n"]), int(row["seed"]), float(row["step"])) for row in rows}
    for seed in SEEDS[:asked.seeds]:
        if (asked.spheres, seed, asked.step) in there or time.time() - start > 60 * asked.most:
            continue
        row = pack(asked.work, asked.spheres, seed, asked.step)
        tables.add_row(TABLE, COLUMNS, row)
        print(", ".join(f"{name} {row[name]}" for name in ("n", "seed", "height_envelope", "height_top", "fraction",
                                                           "cpu_seconds")), flush=True)
    rows = sorted(put_in_order(tables.read_if_there(TABLE, COLUMNS)),
                  key=lambda row: (int(row["n"]), -float(row["step"])))
    tables.fill(os.path.join(HERE, "..", "behaviour.md"),
                {"packing": make_table(rows), "packing-differences": table_differences(rows)})


if __name__ == "__main__":
    main()
