#!/usr/bin/env python3
"""What is expected against the least D known: the tables of docs/expected.md.

    MSKIT=build/eval/mskit MSKIT_SHARED=../shared docs/expected-table.py RUNS.csv [--effort E...] [--start NAME...]
                                                                          [--body NAME...] [--most N] [--timeout S]

For each body and number of spheres up to N it runs `mskit generate -g variational` with these efforts (0 and 1 by
default; none with `--effort`) from these starts: `own`, the default; a method's name, for `--refine` from what that
method gives for as many spheres; `included`, for `--refine` from the clump that another generator published with the
mesh, where there is one. MSKIT_SHARED/tools/score.c judges the clump at 200 cells or more, and a row is added to
RUNS.csv; rows that are there are not run again. A run of more than S seconds is left out. The least D known is the
least of all rows. Then it prints the tables, and which runs the least came from. Takes cc; some 30 CPU minutes by
default.
"""
import argparse
import csv
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
from collections import Counter

import tables

MSKIT = os.path.abspath(os.environ.get("MSKIT", "build/eval/mskit"))
SHARED = os.path.abspath(os.environ.get("MSKIT_SHARED", "../shared"))
FIELDS = "shape n effort start cells delivered seconds D".split()
ANALYTIC = {"torus": ("torus",), "prolate": ("ellipsoid", "a=2", "b=1", "c=1", "fineness=150"),
            "needle": ("needle",), "oblate": ("ellipsoid", "a=2", "b=2", "c=1", "fineness=100"),
            "grain5": ("grain", "seed=5"), "grain11": ("grain", "seed=11"), "tablet": ("tablet",),
            "cylinder": ("cylinder",), "oblate331": ("ellipsoid", "a=3", "b=3", "c=1", "fineness=100"),
            "oblate332": ("ellipsoid", "a=1.5", "b=1.5", "c=1", "fineness=100"),
            "triaxial": ("ellipsoid", "a=3", "b=2", "c=1.5", "fineness=100")}
# Bodies, numbers of spheres, cells along the shortest side for the method and along the longest for the judge: more
# where the body stands along the grid's own planes, so that 200 err by 15 %. The constants of the model (CHEAPER,
# TOLERANCE, the points of a level) were chosen on the first list.
FITTED = [
    ("torus", (10, 15, 20, 30, 40, 60), 100, 600), ("prolate", (10, 15, 20, 30, 40, 60), 100, 500),
    ("needle", (10, 15, 20, 30, 40, 60), 100, 1600), ("oblate", (30, 60, 100, 200), 100, 400),
    *((name, (10, 30, 100, 300), 100, 200) for name in (
        "asteroid_castalia.obj", "boulder_SP2B.stl", "bunny.ply", "human_femur.stl", "lithic_flake2.ply",
        "octahedron.stl", "pear.stl", "powder_ma165_03636.stl", "sand_grain.stl")),
    ("open-clumps/bowl.stl", (100, 200, 400, 600), 50, 200),
    ("open-clumps/mug.stl", (50, 100, 200, 400, 500), 100, 200),
    ("open-clumps/pitcher.stl", (30, 40, 50, 100, 200, 400), 100, 200),
]
HELD_OUT = [
    *((f"open-clumps/{name}.stl", (10, 30, 100), 100, 200) for name in (
        "boot", "coffee_jar", "link0", "link1", "link2", "link3", "lion", "teapot", "toaster")),
    *((f"grains402/ma165-{number}.ply", (10, 30, 100), 60, 200) for number in (
        "00463", "01576", "02694", "03830", "04989", "06136")),
    *((name, (10, 30, 100), 60, 200) for name in ("grain5", "grain11", "tablet", "cylinder")),
    *((name, (30, 100), 100, 400) for name in ("oblate331", "oblate332", "triaxial")),
]


def name_of(body):
    return os.path.splitext(os.path.basename(body))[0]


def run(*command, timeout=None):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          timeout=timeout, env={**os.environ, "OMP_NUM_THREADS": "1"}).stdout


class Judge:
    """Meshes as STL, which is what the judge reads, in a folder of their own."""

    def __init__(self, folder):
        self.folder = folder
        self.program = os.path.join(folder, "score")
        run("cc", "-O2", "-o", self.program, os.path.join(SHARED, "tools", "score.c"), "-lm")

    def mesh(self, body):
        path = os.path.join(self.folder, name_of(body) + ".stl")
        source = os.path.join(SHARED, "data", body)
        if os.path.exists(path):
            return path
        if body in ANALYTIC:
            run(MSKIT, "shape", *ANALYTIC[body], "-o", path)
        elif body.endswith(".stl"):
            os.symlink(source, path)
        else:
            run(sys.executable, os.path.join(SHARED, "tools", "tostl.py"), source, path)
        return path

    def clump_of(self, start, body, n, cells, timeout):
        """Options that make variational begin there; None where the body has no such clump."""
        if start == "own":
            return ()
        path = os.path.join(self.folder, "start.csv")
        if start == "included":
            path = os.path.join(SHARED, "data", os.path.splitext(body)[0] + ".spheres.csv")
            return ("--refine", path) if os.path.exists(path) else None
        run(MSKIT, "generate", self.mesh(body), "-g", start, "-n", str(n), "--cells", str(cells), "-o", path,
            timeout=timeout)
        return ("--refine", path)

    def try_method(self, body, n, effort, start, cells, judged, timeout):
        """The row of a run; None for one that takes too long, or has nothing to begin with."""
        clump = os.path.join(self.folder, "clump.csv")
        try:
            begin = self.clump_of(start, body, n, cells, timeout)
            if begin is None:
                return None
            text = run(MSKIT, "generate", self.mesh(body), "-g", "variational", "-n", str(n), "--set",
                       f"effort={effort}", *begin, "--cells", str(cells), "-o", clump, "--json", timeout=timeout)
        except subprocess.TimeoutExpired:
            return None
        score = json.loads(run(self.program, self.mesh(body), clump, str(judged)))
        dice = score["eta"] / (1 + score["coverage"] + score["overshoot"])  # more digits than its own
        return dict(zip(FIELDS, (name_of(body), n, effort, start, cells, score["n"], json.loads(text)["seconds"]["cpu"],
                                 f"{dice:.4g}")))


def read_runs(path):
    if not os.path.exists(path):
        return []
    with open(path, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def planned(arguments):
    for effort in arguments.effort:
        for body, numbers, *cells in FITTED + HELD_OUT:
            for n in numbers:
                if n <= arguments.most and (not arguments.body or name_of(body) in arguments.body):
                    for start in arguments.start:
                        yield body, n, effort, start, *cells


def add_runs(judge, arguments):
    there = {(row["shape"], int(row["n"]), int(row["effort"]), row["start"]) for row in read_runs(arguments.runs)}
    for body, *what, cells, judged in planned(arguments):
        row = (name_of(body), *what) not in there and judge.try_method(body, *what, cells, judged, arguments.timeout)
        if row:
            tables.add_row(arguments.runs, FIELDS, row)


def expect(judge, body):
    rows = json.loads(run(MSKIT, "info", judge.mesh(body), "--expect", "--json"))["expected"]["dice"]
    return {int(row["spheres"]): row["free"] for row in rows}


def known(runs, body, n):
    """The least D of a body by n spheres; None if none was measured."""
    return min((float(row["D"]) for row in runs if row["shape"] == name_of(body) and int(row["n"]) == n), default=None)


def print_table(judge, runs, bodies):
    """Prints a row for each body; returns the ratios by number of spheres."""
    ratios = {}
    print("| body | n: expected least D / least D known = ratio |\n|---|---|")
    for body, numbers, *_ in bodies:
        expected = expect(judge, body)
        cells = []
        for n in numbers:
            least = known(runs, body, n)
            if least:
                ratios.setdefault(n, []).append(expected[n] / least)
                cells.append(f"{n}: {expected[n]:.3g} / {least:.3g} = {expected[n] / least:.2f}")
        if cells:
            print(f"| {name_of(body)} | {'; '.join(cells)} |")
    return ratios


def print_winners(runs):
    """How often each start and effort gave the least D, and what starts other than variational's own brought."""
    best, own = {}, {}
    for row in runs:
        key = row["shape"], row["n"]
        best[key] = min(best.get(key, row), row, key=lambda r: float(r["D"]))
        if row["start"] == "own":
            own[key] = min(own.get(key, row), row, key=lambda r: float(r["D"]))
    print("\nthe least came from:")
    for what, count in Counter((row["start"], row["effort"]) for row in best.values()).most_common():
        print(f"  {what[0]}, effort {what[1]}: {count}")
    gains = [(float(own[key]["D"]) / float(row["D"]), *key, row["start"]) for key, row in best.items() if key in own]
    for gain, body, n, start in sorted(gains, reverse=True)[:10]:
        print(f"  {body} {n}: {gain:.3f} times as much from its own start as from {start}")


def print_range(role, ratios):
    for n in sorted(ratios):
        values = sorted(ratios[n])
        print(f"{role}, {n} spheres: {len(values)} bodies, {values[0]:.2f} to {values[-1]:.2f}, "
              f"median {statistics.median(values):.2f}")


def number_for(dice, points):
    """The number of spheres of a mismatch, between two (number, D) in logarithms; None outside."""
    points = sorted(points)
    for (n, a), (m, b) in zip(points, points[1:]):
        if a >= dice >= b:
            return n * (m / n) ** (math.log(a / dice) / math.log(a / b))
    return None


def print_vessels(judge, runs, dice=0.2):
    for body, *_ in FITTED:
        if name_of(body) in ("bowl", "mug", "pitcher"):
            numbers = sorted({int(row["n"]) for row in runs if row["shape"] == name_of(body)})
            least = number_for(dice, [(n, known(runs, body, n)) for n in numbers])
            expected = number_for(dice, expect(judge, body).items())
            if least and expected:
                print(f"{name_of(body)}: D = {dice} with {expected:.0f} / {least:.0f} spheres = {expected / least:.2f}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("runs")
    parser.add_argument("--effort", nargs="*", type=int, default=[0, 1])
    parser.add_argument("--start", nargs="*", default=["own"])
    parser.add_argument("--body", nargs="*")
    parser.add_argument("--most", type=int, default=1000)
    parser.add_argument("--timeout", type=float, default=600)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        judge = Judge(folder)
        add_runs(judge, arguments)
        for role, bodies in (("fitted", FITTED), ("held out", HELD_OUT)):
            print(f"\n{role}:\n")
            print_range(role, print_table(judge, read_runs(arguments.runs), bodies))
        print_vessels(judge, read_runs(arguments.runs))
        print_winners(read_runs(arguments.runs))


if __name__ == "__main__":
    main()
