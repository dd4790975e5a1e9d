#!/usr/bin/env python3
"""What is expected against the least D known: the table of docs/expected.md.

    MSKIT=build/eval/mskit MSKIT_SHARED=../shared docs/expected-table.py RUNS.csv [EFFORT...]

For each body and number of spheres it runs `mskit generate -g variational` with these efforts (0 and 1 by default; none
with -), judges the clump by MSKIT_SHARED/tools/score.c at 200 cells, and adds a row to RUNS.csv; rows that are there are
not run again. The least D known is the least of all rows. Then it prints the table. Takes cc; some 15 CPU minutes.
"""
import csv
import json
import os
import subprocess
import sys
import tempfile

MSKIT = os.path.abspath(os.environ.get("MSKIT", "build/eval/mskit"))
SHARED = os.path.abspath(os.environ.get("MSKIT_SHARED", "../shared"))
FIELDS = "shape n effort cells delivered seconds D".split()
ANALYTIC = {"torus": ("torus",), "prolate": ("ellipsoid", "a=2", "b=1", "c=1"), "needle": ("needle",),
            "oblate": ("ellipsoid", "a=2", "b=2", "c=1")}
# Bodies, numbers of spheres, cells along the shortest side.
PLAN = [
    ("torus", (10, 15, 20, 30, 40, 60), 100), ("prolate", (10, 15, 20, 30, 40, 60), 100),
    ("needle", (10, 15, 20, 30, 40, 60), 100), ("oblate", (30, 60, 100, 200), 100),
    *((name, (10, 30, 100, 300), 100) for name in (
        "asteroid_castalia.obj", "boulder_SP2B.stl", "bunny.ply", "human_femur.stl", "lithic_flake2.ply",
        "octahedron.stl", "pear.stl", "powder_ma165_03636.stl", "sand_grain.stl")),
    *((f"open-clumps/{name}.stl", (10, 30, 100), 100) for name in (
        "boot", "coffee_jar", "link0", "link1", "link2", "link3", "lion", "teapot", "toaster")),
    ("open-clumps/bowl.stl", (100, 200, 400, 600), 50), ("open-clumps/mug.stl", (50, 100, 200, 400, 500), 100),
    ("open-clumps/pitcher.stl", (30, 40, 50, 100, 200, 400), 100),
]


def name_of(body):
    return os.path.splitext(os.path.basename(body))[0]


def run(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          env={**os.environ, "OMP_NUM_THREADS": "1"}).stdout


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

    def try_method(self, body, n, effort, cells):
        clump = os.path.join(self.folder, "clump.csv")
        text = run(MSKIT, "generate", self.mesh(body), "-g", "variational", "-n", str(n), "--set", f"effort={effort}",
                   "--cells", str(cells), "-o", clump, "--json")
        score = json.loads(run(self.program, self.mesh(body), clump, "200"))
        return dict(zip(FIELDS, (name_of(body), n, effort, cells, score["n"], json.loads(text)["seconds"]["cpu"],
                                 score["D"])))


def read_runs(path):
    if not os.path.exists(path):
        return []
    with open(path, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def add_runs(judge, path, efforts):
    there = {(row["shape"], int(row["n"]), int(row["effort"])) for row in read_runs(path)}
    new = not os.path.exists(path)
    with open(path, "a", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, FIELDS, lineterminator="\n")
        if new:
            writer.writeheader()
        for effort in efforts:
            for body, numbers, cells in PLAN:
                for n in numbers:
                    if (name_of(body), n, effort) not in there:
                        writer.writerow(judge.try_method(body, n, effort, cells))
                        stream.flush()


def expect(judge, body):
    rows = json.loads(run(MSKIT, "info", judge.mesh(body), "--expect", "--json"))["expected"]["dice"]
    return {int(row["spheres"]): row["free"] for row in rows}


def print_table(judge, runs):
    print("| body | n: expected least D / least D known = ratio |\n|---|---|")
    for body, numbers, _ in PLAN:
        known = {n: min((float(row["D"]) for row in runs if row["shape"] == name_of(body) and int(row["n"]) == n),
                        default=None) for n in numbers}
        expected = expect(judge, body)
        cells = [f"{n}: {expected[n]:.3g} / {known[n]:.3g} = {expected[n] / known[n]:.2f}" for n in numbers
                 if known[n]]
        print(f"| {name_of(body)} | {'; '.join(cells)} |")


def main():
    efforts = [0, 1] if len(sys.argv) == 2 else [int(e) for e in sys.argv[2:] if e != "-"]
    with tempfile.TemporaryDirectory() as folder:
        judge = Judge(folder)
        add_runs(judge, sys.argv[1], efforts)
        print_table(judge, read_runs(sys.argv[1]))


if __name__ == "__main__":
    main()
