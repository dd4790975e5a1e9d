#!/usr/bin/env python3
"""D of MSS against other codes: the tables of docs/validation.md.

    MSKIT=build/eval/mskit docs/validation/mss-table.py SHARED [best] [polish] [paper] [spacing] [heldout]

SHARED holds data/ with the meshes, peers-mss.csv with the better D of other codes, and tools/ with the judge (score.c,
compiled here by cc) and tostl.py. Meshes that are not there are named and left out. All n of a nested variant come from
one run, each a prefix; with polish each n is a run of its own. Prints D, and its ratio to that of the other codes.
`spacing`: D of variant=paper over delta_min for the two bodies of the paper.
`heldout`: best beside paper on shapes outside the table; there are no figures of other codes for them.
"""
import csv
import json
import math
import os
import subprocess
import sys
import tempfile

VARIANTS = {"best": [], "paper": ["--variant", "paper"], "polish": ["--polish"]}


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stderr}")
    return done.stdout


class Judge:
    def __init__(self, shared, folder):
        self.shared, self.folder = shared, folder
        self.program = os.path.join(folder, "score")
        run("cc", "-O2", "-w", "-o", self.program, os.path.join(shared, "tools/score.c"), "-lm")

    def mesh(self, shape):
        """The mesh's own file and one that the judge reads; None where it is missing."""
        path = os.path.join(self.shared, "data", shape)
        if not os.path.exists(path):
            print(f"skipped: no {path}")
            return None
        stl = path
        if not shape.endswith(".stl"):
            stl = os.path.join(self.folder, os.path.basename(shape) + ".stl")
            run(sys.executable, os.path.join(self.shared, "tools/tostl.py"), path, stl)
        return path, stl

    def spheres(self, path, n, options):
        """The lines of a clump of up to n spheres."""
        clump = os.path.join(self.folder, "clump.csv")
        run(os.environ.get("MSKIT", "mskit"), "generate", path, "-g", "mss", "--cells", 100, "-n", n, "-o", clump, *options)
        with open(clump) as lines:
            return lines.read().splitlines()[1:]

    def dice(self, stl, lines):
        clump = os.path.join(self.folder, "prefix.csv")
        with open(clump, "w") as out:
            out.write("\n".join(["x,y,z,r", *lines]) + "\n")
        return json.loads(run(self.program, stl, clump, 200))["D"]


def mean(ratios):
    return math.exp(sum(map(math.log, ratios)) / len(ratios))


def against_others(judge, peers, variant):
    ratios = []
    print(f"\n{variant}: D (ratio)")
    for shape, row in peers.items():
        mesh = judge.mesh(shape)
        if not mesh:
            continue
        nested = variant != "polish"
        all_spheres = judge.spheres(mesh[0], max(row), VARIANTS[variant]) if nested else None
        cells = []
        for n, other in row.items():
            lines = all_spheres[:n] if nested else judge.spheres(mesh[0], n, VARIANTS[variant])
            dice = judge.dice(mesh[1], lines)
            ratios.append(dice / other)
            short = "" if len(lines) == n else f", {len(lines)}"
            cells.append(f"{dice:.4f} ({dice / other:.2f}{short})")
        print("| " + " | ".join([shape, *cells]) + " |", flush=True)
    if ratios:
        print(f"geometric mean of the ratios {mean(ratios):.3f}, largest {max(ratios):.2f}")


def over_spacing(judge):
    print("\npaper: D over delta_min, in voxels")
    for shape, n in (("ellipsoid_2_1_1.stl", 10), ("human_femur.stl", 70)):
        mesh = judge.mesh(shape)
        for spacing in (0, 1, 2, 3, 4, 6, 8, 12) if mesh else ():
            lines = judge.spheres(mesh[0], n, ["--variant", "paper", "--spacing", spacing])
            print(f"| {shape} | {spacing or 'automatic'} | {len(lines)} | {judge.dice(mesh[1], lines):.4f} |", flush=True)


HELD_OUT = ("lithic_flake2.ply", "open-clumps/bowl.stl", "open-clumps/boot.stl", "grains402/ma165-00048.ply",
            "grains402/ma165-00112.ply")


def held_out(judge):
    """D of best, and its ratio to paper's; where paper has fewer spheres than asked for, how many."""
    print("\nheld out: D of best (ratio to paper)")
    ratios = []
    for shape in HELD_OUT:
        mesh = judge.mesh(shape)
        if not mesh:
            continue
        best, paper = (judge.spheres(mesh[0], 100, VARIANTS[name]) for name in ("best", "paper"))
        cells = []
        for n in (10, 30, 100):
            ours, theirs = judge.dice(mesh[1], best[:n]), judge.dice(mesh[1], paper[:n])
            ratios.append(ours / theirs)
            short = "" if len(paper) >= n else f", {len(paper)}"
            cells.append(f"{ours:.4f} ({ours / theirs:.2f}{short})")
        print("| " + " | ".join([shape, *cells]) + " |", flush=True)
    if ratios:
        print(f"geometric mean of the ratios {mean(ratios):.3f}, largest {max(ratios):.2f}")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    shared, chosen = sys.argv[1], sys.argv[2:] or ["best", "polish", "paper", "spacing", "heldout"]
    table = os.path.join(shared, "peers-mss.csv")
    if not os.path.exists(table):
        print(f"skipped: no {table}")
        return
    peers = {}
    with open(table) as lines:
        for row in csv.DictReader(lines):
            peers.setdefault(row["shape"], {})[int(row["n"])] = float(row["best_public_mss_dice"])
    with tempfile.TemporaryDirectory() as folder:
        judge = Judge(shared, folder)
        for name in chosen:
            if name == "spacing":
                over_spacing(judge)
            elif name == "heldout":
                held_out(judge)
            else:
                against_others(judge, peers, name)


if __name__ == "__main__":
    main()
