#!/usr/bin/env python3
"""D of MSS against other codes: the tables of docs/validation.md.

    MSKIT=build/eval/mskit docs/validation/mss-table.py SHARED [best] [polish] [paper] [spacing] [heldout]

SHARED holds data/ with the meshes, peers-mss.csv with the better D of other codes, and tools/ with the judge (score.c,
compiled here by cc) and tostl.py. Meshes that are not there are named and left out. All n of a nested variant come from
one run, each a prefix; with polish each n is a run of its own. Prints D, and its ratio to that of the other codes, as
tables; what they are goes to standard error.
`spacing`: D of variant=paper over delta_min for the two bodies of the paper.
`heldout`: best beside paper on shapes outside the table; there are no figures of other codes for them.
"""
import csv
import math
import os
import sys
import tempfile

from judge import Judge

VARIANTS = {"best": [], "paper": ["--variant", "paper"], "polish": ["--polish"]}


def mean(ratios):
    return math.exp(sum(map(math.log, ratios)) / len(ratios))


def say_mean(ratios):
    print(f"\nGeometric mean of the ratios {mean(ratios):.3f}, largest {max(ratios):.2f}.")


def against_others(judge, peers, variant):
    ratios = []
    print(f"{variant}: D (ratio)", file=sys.stderr)
    numbers = next(iter(peers.values()))
    print("| | " + " | ".join(str(n) for n in numbers) + " |\n" + "|---" * (1 + len(numbers)) + "|")
    for shape, row in peers.items():
        mesh = judge.mesh(shape)
        if not mesh:
            continue
        nested = variant != "polish"
        all_spheres = judge.spheres(mesh[0], max(row), "mss", VARIANTS[variant]) if nested else None
        cells = []
        for n, other in row.items():
            lines = all_spheres[:n] if nested else judge.spheres(mesh[0], n, "mss", VARIANTS[variant])
            dice = judge.dice(mesh[1], lines)
            ratios.append(dice / other)
            short = "" if len(lines) == n else f", {len(lines)}"
            cells.append(f"{dice:.4f} ({dice / other:.2f}{short})")
        print("| " + " | ".join([shape, *cells]) + " |", flush=True)
    if ratios:
        say_mean(ratios)


SPACINGS = (0, 1, 2, 3, 4, 6, 8, 12)


def over_spacing(judge):
    """In brackets how many spheres there are, where not as many as asked for."""
    print("| delta_min, voxels | automatic | " + " | ".join(str(spacing) for spacing in SPACINGS[1:]) + " |\n"
          + "|---" * (1 + len(SPACINGS)) + "|")
    for shape, n in (("ellipsoid_2_1_1.stl", 10), ("human_femur.stl", 70)):
        mesh = judge.mesh(shape)
        cells = []
        for spacing in SPACINGS if mesh else ():
            lines = judge.spheres(mesh[0], n, "mss", ["--variant", "paper", "--spacing", spacing])
            short = "" if len(lines) == n else f" ({len(lines)})"
            cells.append(f"{judge.dice(mesh[1], lines):.4f}{short}")
        print("| " + " | ".join([f"{shape}, n = {n}", *cells]) + " |", flush=True)


HELD_OUT = ("lithic_flake2.ply", "open-clumps/bowl.stl", "open-clumps/boot.stl", "grains402/ma165-00048.ply",
            "grains402/ma165-00112.ply")


def held_out(judge):
    """D of best, and its ratio to paper's; where paper has fewer spheres than asked for, how many."""
    print("held out: D of best (ratio to paper)", file=sys.stderr)
    print("| | 10 | 30 | 100 |\n|---|---|---|---|")
    ratios = []
    for shape in HELD_OUT:
        mesh = judge.mesh(shape)
        if not mesh:
            continue
        best, paper = (judge.spheres(mesh[0], 100, "mss", VARIANTS[name]) for name in ("best", "paper"))
        cells = []
        for n in (10, 30, 100):
            ours, theirs = judge.dice(mesh[1], best[:n]), judge.dice(mesh[1], paper[:n])
            ratios.append(ours / theirs)
            short = "" if len(paper) >= n else f", {len(paper)}"
            cells.append(f"{ours:.4f} ({ours / theirs:.2f}{short})")
        print("| " + " | ".join([shape, *cells]) + " |", flush=True)
    if ratios:
        say_mean(ratios)


def read_peers(shared):
    """D of the better of the other codes by shape and number."""
    table, peers = os.path.join(shared, "peers-mss.csv"), {}
    if not os.path.exists(table):
        sys.exit(f"no {table}")
    with open(table) as lines:
        for row in csv.DictReader(lines):
            peers.setdefault(row["shape"], {})[int(row["n"])] = float(row["best_public_mss_dice"])
    return peers


def main():
    tables = ["best", "polish", "paper", "spacing", "heldout"]
    if len(sys.argv) < 2 or not set(sys.argv[2:]) <= set(tables):
        sys.exit(__doc__)
    shared, chosen = sys.argv[1], sys.argv[2:] or tables
    with tempfile.TemporaryDirectory() as folder:
        judge = Judge(shared, folder)
        for name in chosen:
            if name == "spacing":
                over_spacing(judge)
            elif name == "heldout":
                held_out(judge)
            else:
                against_others(judge, read_peers(shared), name)


if __name__ == "__main__":
    main()
