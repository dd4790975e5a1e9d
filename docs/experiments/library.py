#!/usr/bin/env python3
"""How few grains stand for a powder in bulk: beds of 250 grains in LIGGGHTS, by clumps of 20 spheres of each of its
grains, and by the K grains that mskit grains --choose takes.

    docs/experiments/library.py GRAINS [--seeds N] [--kinds K,...] [--choice SEED] [--work FOLDER] [--most MINUTES]

GRAINS is a folder of meshes; the one of docs/population.md is meant. Each row goes to library.csv beside this file;
rows that are there are not run again. Then the table of all of them goes into docs/behaviour.md, which --seeds 0 does
alone. MSKIT names the program (build/eval/mskit), LIGGGHTS the engine (liggghts). Takes numpy.

Bed, material and what is measured are those of contrasts.py. Shape alone differs: all clumps are scaled to the volume
of its candy, as are their moments. kinds is K, or 0 for the powder itself: 250 of its grains, drawn without replacement
by the seed of the run. Of K grains there are as many as their weights say, to the nearest of 250 (largest remainders).
    choice    the seed with which they were chosen, 0 of the powder itself; below 0, drawn at random by the seed of the
              run and as many of each (added when two runs of the first choice had been looked at)
    contacts  particles and feet of the floor that a particle touches in the settled bed, on average
"""
import argparse
import math
import os
import re
import time

import numpy

import contrasts_tables
from bed import COUNT, FRICTION, SIDE, run_bed
from contrasts_cells import read_rows, tell_template, write_rows
from intervals import interval, interval_by_own, pool
from packing import DENSITY, MASS, RESTITUTION, SEEDS, YOUNG, read_seeds, read_spheres
from program import read_counts, run_mskit
import tables  # of docs, where packing looks

HERE = os.path.dirname(os.path.abspath(__file__))
TABLE = os.path.join(HERE, "library.csv")
COLUMNS = ["kinds", "choice", "seed", "step", "rate", "particles", "height", "fraction", "contacts", "start", "stop",
           "flowed", "kinetic_over_m_g_d", "seconds", "cpu_seconds", "version"]
KINDS, SPHERES = [0, 1, 5, 20], 20
FLOOR = numpy.array([[7.5 * i, 7.5 * j, 0.0, 3.75] for i in range(8) for j in range(8)])  # mm, as in bed.py
# what is measured: heading, digits
MEASURED = {"fraction": ("fraction", 4), "contacts": ("contacts", 2), "start": ("start, degrees", 2),
            "stop": ("stop, degrees", 2), "flowed": ("fraction after flow", 4)}


def make_clumps(grains, folder):
    """Names of the clumps of all grains, of 20 spheres each."""
    clumps = os.path.join(folder, "clumps")
    run_mskit("grains", grains, "-n", SPHERES, "--cells", 50, "--equal-volume", "--density", DENSITY, "--unit", "mm",
              "--format", "liggghts", "-o", clumps, *(["--resume"] if os.path.exists(clumps) else []))
    return [row["file"] for row in tables.read(os.path.join(clumps, "grains.csv")) if row["status"] == "ok"]


def choose(folder, kinds, choice):
    """(name, weight) of so many grains."""
    library = os.path.join(folder, f"library-{kinds}-{choice}")
    if not os.path.exists(os.path.join(library, "library.csv")):
        run_mskit("grains", "--choose", kinds, os.path.join(folder, "clumps"), "--seed", choice, "-o", library)
    return [(row["file"], float(row["number"])) for row in tables.read(os.path.join(library, "library.csv"))]


def share_out(weighted):
    """(name, count) with counts of together COUNT, by largest remainders."""
    total = sum(weight for _, weight in weighted)
    exact = [COUNT * weight / total for _, weight in weighted]
    counts = [math.floor(x) for x in exact]
    for k in sorted(range(len(exact)), key=lambda k: counts[k] - exact[k])[:COUNT - sum(counts)]:
        counts[k] += 1
    return [(name, count) for (name, _), count in zip(weighted, counts) if count]


def draw(names, folder, kinds, choice, seed):
    """(name, count) of a bed's particles."""
    if kinds and choice >= 0:
        return share_out(choose(folder, kinds, choice))
    drawn = numpy.random.default_rng(seed).choice(names, kinds or COUNT, replace=False)
    return share_out([(name, 1) for name in sorted(drawn)])


def list_primes(count):
    """So many of them above 10^6, as LIGGGHTS wants for templates: each its own."""
    sieve = numpy.ones(2_000_000, dtype=bool)
    for k in range(2, 1415):
        if sieve[k]:
            sieve[k * k::k] = False
    return (10 ** 6 + numpy.flatnonzero(sieve[10 ** 6:]))[:count].tolist()


def scale_template(source, folder, number, prime):
    """The line of a template for LIGGGHTS, of the candy's mass and volume; its spheres go into a file of the folder,
    whose name is a number, since those of grains come from outside."""
    with open(source + ".in", encoding="utf-8") as stream:
        line = next(line for line in stream if line.startswith("fix clump "))
    mass, tensor = re.search(r" mass (\S+) inertia_tensor ((?:\S+ ){6})use_density$", line.strip()).groups()
    factor = (MASS / float(mass)) ** (1 / 3)
    file = f"{number}.spheres"
    write_rows(os.path.join(folder, file), [[factor * x for x in row] for row in read_rows(source)])
    return tell_template(f"clump{number}", file, SPHERES, [float(x) * factor ** 5 for x in tensor.split()], prime,
                         number + 1)


def make_bed(folder, work, drawn):
    """What bed.run_bed wants, to run in the folder work."""
    os.makedirs(work, exist_ok=True)
    # A template a particle: of shares that are not alike LIGGGHTS rounds some down and draws what is missing.
    names = [name for name, count in drawn for _ in range(count)]
    lines = [scale_template(os.path.join(folder, "clumps", name), work, number, prime)
             for (number, name), prime in zip(enumerate(names), list_primes(len(names)))]
    shares = " ".join(f"clump{number} {1 / COUNT!r}" for number in range(len(names)))
    return {"template": "\n".join(lines), "kinds": f"{len(names)} {shares}", "members": SPHERES, "rolling": 0.0,
            "friction": FRICTION, "young": YOUNG, "e": RESTITUTION, "smooth": False}


def count_contacts(spheres):
    """Of a particle, on average; spheres in mm, particle by particle. The engine's six digits hide overlaps below 1e-4
    mm, which bear no more than a hundredth of a particle's weight."""
    of = numpy.arange(len(spheres)) // SPHERES
    touching = set()
    for k, (x, y, z, r) in enumerate(spheres):
        for others, base in ((spheres, 0), (FLOOR, COUNT)):
            gap = others[:, :3] - (x, y, z)
            gap[:, :2] -= SIDE * numpy.round(gap[:, :2] / SIDE)
            near = numpy.flatnonzero((gap ** 2).sum(axis=1) < (others[:, 3] + r) ** 2)
            touching |= {(of[k], base + (of[j] if base == 0 else j)) for j in near}
    return sum(a != b for a, b in touching) / COUNT


def run(folder, names, kinds, choice, seed):
    """One row."""
    work = os.path.join(folder, f"{kinds}-{choice}-{seed}")
    clump = make_bed(folder, work, draw(names, folder, kinds, choice, seed))
    measured = run_bed(work, clump, seed, contrasts_tables.STEP, contrasts_tables.RATE)
    contacts = count_contacts(read_spheres(os.path.join(work, "settled.dump")))
    return {"kinds": kinds, "choice": choice, **measured, "contacts": round(contacts, 3)}


def name_grains(kinds, choice):
    if kinds == "0":
        return "all"
    if int(choice) < 0:
        return f"{kinds}, at random"
    return kinds if choice == "1" else f"{kinds}, choice {choice}"


def list_sets(rows, kinds, field, drawn):
    """The mean of each set of so many grains: a choice is one, and each run of those that are drawn."""
    sets = {}
    for row in rows:
        if int(row["kinds"]) == kinds and (int(row["choice"]) < 0) == drawn:
            sets.setdefault(row["seed"] if drawn else row["choice"], []).append(float(row[field]))
    return [numpy.mean(values) for values in sets.values()]


def compare_sets(rows):
    """Lines: drawn sets against chosen ones of as many grains, where there are two of each, a set as one value."""
    out = []
    for kinds in sorted({int(row["kinds"]) for row in rows if int(row["choice"]) < 0}):
        pairs = {f: [list_sets(rows, kinds, f, drawn) for drawn in (True, False)] for f in MEASURED}
        if min(map(len, pairs["fraction"])) > 1:
            out.append([f"{kinds}, at random - chosen, by sets", ", ".join(str(len(x)) for x in pairs["fraction"])]
                       + [contrasts_tables.show(*interval_by_own(*pairs[f]), MEASURED[f][1]) for f in MEASURED])
    return out


def make_table(rows):
    """Means, spread within rows of the same grains, and differences from the powder with half of their 90 %
    interval."""
    if not rows:
        return "None was run yet."
    groups = {}
    for row in sorted(rows, key=lambda row: (int(row["kinds"]), int(row["choice"]))):
        groups.setdefault(name_grains(row["kinds"], row["choice"]), []).append(row)
    values = {f: {k: [float(row[f]) for row in these] for k, these in groups.items()} for f in MEASURED}
    out = [[k, str(len(these))] + [f"{numpy.mean(values[f][k]):.{digits}f}" for f, (_, digits) in MEASURED.items()]
           for k, these in groups.items()]
    pooled = {f: pool(list(values[f].values())) for f in MEASURED}
    out.append(["spread within", str(pooled["fraction"][1])]
               + [f"{pooled[f][0]:.{digits}f}" for f, (_, digits) in MEASURED.items()])
    others = {k: [k] for k in groups if k != "all"}
    if len(others) > 1:
        others["all others"] = list(others)
    for name, of in others.items() if "all" in groups else ():
        these = {f: [x for k in of for x in values[f][k]] for f in MEASURED}
        out.append([f"{name} - all", ""]
                   + [contrasts_tables.show(*interval(these[f], values[f]["all"], *pooled[f]), digits)
                      for f, (_, digits) in MEASURED.items()])
    return tables.markdown(["kinds", "runs"] + [head for head, _ in MEASURED.values()], out + compare_sets(rows))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("grains", help="folder of meshes")
    parser.add_argument("--seeds", type=read_seeds, default=3, help="runs of each (3)")
    parser.add_argument("--kinds", type=read_counts, default=KINDS, help="0: all (0,1,5,20)")
    parser.add_argument("--choice", type=int, default=1, help="seed of the choice (1)")
    parser.add_argument("--work", default="library", help="folder of the engine's files (library)")
    parser.add_argument("--most", type=float, default=1e9, help="no run is begun after so many minutes")
    asked = parser.parse_args()
    os.makedirs(asked.work, exist_ok=True)
    names = make_clumps(asked.grains, asked.work) if asked.seeds else []
    begun, rows = time.time(), tables.read_if_there(TABLE, COLUMNS)
    there = {(int(row["kinds"]), int(row["choice"]), int(row["seed"])) for row in rows}
    for seed in SEEDS[:asked.seeds]:
        for kinds in asked.kinds:
            choice = asked.choice if kinds else 0
            if (kinds, choice, seed) in there or time.time() - begun > 60 * asked.most:
                continue
            row = run(asked.work, names, kinds, choice, seed)
            tables.add_row(TABLE, COLUMNS, row)
            print(", ".join(f"{key} {row[key]}" for key in COLUMNS if key not in ("particles", "version")), flush=True)
    tables.fill(os.path.join(HERE, "..", "behaviour.md"), {"library": make_table(tables.read_if_there(TABLE, COLUMNS))})


if __name__ == "__main__":
    main()
