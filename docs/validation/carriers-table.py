#!/usr/bin/env python3
"""How many carriers make mass, centre and inertia exact: the table of docs/validation.md.

    MSKIT=build/eval/mskit docs/validation/carriers-table.py SHARED [METHOD...]

Every body of `mskit shape` with its default parameters, and every mesh of SHARED/data, by 10, 30 and 100 spheres of
each METHOD (setcover, mss, variational) at --cells 40. A cell is the number of carriers; - where the method gave fewer
than 10 spheres, ! where none do, with the cause on standard error, as the largest error of the ten
sums, which are made again here from the CSV.
"""
import glob
import json
import math
import os
import subprocess
import sys
import tempfile

MSKIT = os.environ.get("MSKIT", "mskit")
METHODS = ["setcover", "mss", "variational"]
SPHERES = [10, 30, 100]


def run(*command):
    return subprocess.run([MSKIT, *map(str, command)], capture_output=True, text=True)


def shapes(shared, folder):
    kinds = [line.split(":")[0] for line in run("shape", "--list").stdout.split("\n") if line and line[0] != " "]
    for kind in kinds:
        path = os.path.join(folder, kind + ".stl")
        if run("shape", kind, "-o", path).returncode == 0:
            yield kind, path
    for path in sorted(glob.glob(os.path.join(shared, "data", "*"))):
        if path.endswith((".stl", ".obj", ".ply")):
            yield "data/" + os.path.basename(path), path


def worst_error(rows, particle):
    """Of mass, centre / radius of gyration and the six elements of the tensor / mean moment."""
    mass = sum(row[4] for row in rows)
    centre = [sum(row[4] * row[k] for row in rows) / mass for k in range(3)]
    truth, mean = particle["inertia"], sum(particle["inertia"][k][k] for k in range(3)) / 3
    gyration = math.sqrt(1.5 * mean / mass)
    errors = [mass / particle["mass"] - 1]
    errors += [(c - t) / gyration for c, t in zip(centre, particle["centre"])]
    for i in range(3):
        for j in range(i, 3):
            total = 0
            for *place, r, m in (row[:5] for row in rows):
                p = [x - c for x, c in zip(place, centre)]
                total += m * ((sum(x * x for x in p) + 0.4 * r * r) * (i == j) - p[i] * p[j])
            errors.append((total - truth[i][j]) / mean)
    return max(map(abs, errors))


def cell(shape, path, method, n, folder, causes):
    clump, corrected = os.path.join(folder, "c.csv"), os.path.join(folder, "d.csv")
    made = run("generate", path, "-g", method, "-n", n, "--cells", 40, "-o", clump)
    if made.returncode:
        causes.append(f"{shape}, {method}, {n}: {made.stderr.strip()}")
        return "!", 0
    if len(open(clump).readlines()) < 1 + min(SPHERES):
        return "-", 0
    done = run("correct", clump, "--target", path, "--density", 1, "--carriers", "-o", corrected, "--json")
    if done.returncode:
        causes.append(f"{shape}, {method}, {n}: {done.stderr.strip()}")
        return "!", 0
    rows = [[float(word) for word in line.split(",")] for line in open(corrected).read().split()[1:]]
    report = json.loads(done.stdout)
    return report["masses"]["carriers"], worst_error(rows, report["particle"])


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    shared, methods = sys.argv[1], sys.argv[2:] or METHODS
    causes, worst = [], 0
    print("| shape | " + " | ".join(f"{m} {n}" for m in methods for n in SPHERES) + " |")
    print("|---" * (1 + len(methods) * len(SPHERES)) + "|")
    with tempfile.TemporaryDirectory() as folder:
        for shape, path in shapes(shared, folder):
            cells = [cell(shape, path, m, n, folder, causes) for m in methods for n in SPHERES]
            worst = max([worst] + [error for _, error in cells])
            print(f"| {shape} | " + " | ".join(str(count) for count, _ in cells) + " |", flush=True)
    print("\n".join([f"largest error of the ten sums: {worst:.1e}", *causes]), file=sys.stderr)


main()
