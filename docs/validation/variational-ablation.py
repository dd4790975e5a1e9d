#!/usr/bin/env python3
"""What each stage of variational brings: D and user time without it over those with all, in Markdown.

    docs/validation/variational-ablation.py SOURCE DATA [FOLDER]

SOURCE is this project; it is copied into FOLDER (a temporary one by default) and built there once for each stage, with
one constant of the source changed so that the stage does nothing: the program itself has no switch for that. DATA holds
bunny.ply, human_femur.stl and open-clumps/; what is not there is named and left out. The other shapes are made. D is
scored at 200 cells along the longest side by the build with all stages. One thread; the build without a stage and
the whole one take turns, and of two runs the least time counts: its ratio tells more than itself.
"""
import glob
import json
import os
import shutil
import sys
import tempfile

from timing import run

ROOM = "generators/variational/"
SOLVE, FIT, SOLVER, PRUNE = (ROOM + f for f in ("ms_variational_solve.c", "ms_surface_fit.c", "ms_variational_solver.c",
                                                "ms_prune.c"))
# Name, file, what stands there, and what is put in its place.
WITHOUT = [("more spheres at the start, and pruning", SOLVER,
            [("SURPLUS = 1.25", "SURPLUS = 1"), ("MORE = 12", "MORE = 0")]),
           ("the fit before pruning", SOLVE, [("START_STEPS = 40", "START_STEPS = 0")]),
           ("fits while pruning", SOLVE, [("DROP_STEPS = 15", "DROP_STEPS = 0")]),
           ("spheres that go at once are apart", PRUNE, [("CLOSE = 0.3", "CLOSE = 0")]),
           ("losses by the surface", PRUNE, [("FEW = 100", "FEW = 0")]),
           ("the long fit", SOLVE, [("LONG_STEPS = 40", "LONG_STEPS = 0")]),
           ("the last fit", SOLVE, [("LAST_STEPS = 50", "LAST_STEPS = 0")]),
           ("momentum", FIT, [("MOMENTUM = 0.5", "MOMENTUM = 0")]),
           ("cubic look-up, mismatch by the surface", SOLVE, [("FINE = 0.1", "FINE = 0")]),
           ("idle spheres put elsewhere", SOLVE, [("REPAIRS = 3", "REPAIRS = 0")]),
           ("the second start", SOLVE, [("HOPELESS = 0.2", "HOPELESS = 2")])]
MADE = {"oblate": ["ellipsoid", "a=2", "b=2", "c=1", "fineness=100"],
        "prolate": ["ellipsoid", "a=2", "b=1", "c=1", "fineness=100"],
        "torus": ["torus"]}
SHAPES = [("oblate", 100), ("prolate", 30), ("prolate", 100), ("torus", 40), ("bunny.ply", 100),
          ("human_femur.stl", 70),
          ("open-clumps/bowl.*", 20)]
REPEATS = 2


def build(folder, name):
    """The program as the copy of the source is now."""
    run("ninja", "-C", os.path.join(folder, "build"), "eval/mskit")
    return shutil.copy(os.path.join(folder, "build/eval/mskit"), os.path.join(folder, name))


def build_without(source, folder, which):
    """The same with constants changed, and changed back."""
    _, file, changes = WITHOUT[which]
    path = os.path.join(source, file)
    with open(path, encoding="utf-8") as f:
        whole = text = f.read()
    for there, instead in changes:
        if text.count(there) != 1:
            sys.exit(f"{file}: '{there}' stands there {text.count(there)} times, not once: mend the list WITHOUT")
        text = text.replace(there, instead)
    with open(path, "w", encoding="utf-8") as f:
        f.write(text)
    made = build(folder, f"without-{which}")
    with open(path, "w", encoding="utf-8") as f:
        f.write(whole)
    return made


def find_shape(name, data, folder, mskit):
    """Its file; None if there is none."""
    if name in MADE:
        path = os.path.join(folder, name + ".stl")
        run(mskit, "shape", *MADE[name], "-o", path)
        return path
    found = [p for p in sorted(glob.glob(os.path.join(data, name))) if p.endswith((".stl", ".obj", ".ply"))]
    if not found:
        print(f"skipped: no {os.path.join(data, name)}", file=sys.stderr)
    return found[0] if found else None


def measure(builds, path, n, folder):
    """D and the least user time of each build."""
    clump = os.path.join(folder, "clump.csv")
    score, least = [None] * len(builds), [float("inf")] * len(builds)
    for _ in range(REPEATS):
        for b, mskit in enumerate(builds):
            least[b] = min(least[b], run(mskit, "generate", path, "-g", "variational", "-n", n, "-o", clump)[1])
            if score[b] is None:
                said = run(builds[0], "score", clump, "--target", path, "--cells", 200, "--json")[0]
                score[b] = json.loads(said)["scores"]["dice"]
    return score, least


def print_row(name, cells):
    print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


def tabulate(data, folder):
    """Builds, runs and prints, each row as soon as it is measured."""
    source = os.path.join(folder, "source")
    run("meson", "setup", os.path.join(folder, "build"), source)
    whole = build(folder, "whole")
    shapes = [(name, find_shape(name, data, folder, whole), n) for name, n in SHAPES]
    shapes = [shape for shape in shapes if shape[1]]
    print_row("without", [f"{os.path.splitext(os.path.basename(name))[0]} {n}" for name, _, n in shapes])
    print("| --- |" + " --: |" * len(shapes), flush=True)
    alone = [measure([whole], path, n, folder) for _, path, n in shapes]
    print_row("nothing: D, time", [f"{score[0]:.5f}, {least[0]:.2f} s" for score, least in alone])
    for which, (name, _, _) in enumerate(WITHOUT):
        builds = [whole, build_without(source, folder, which)]
        pairs = [measure(builds, path, n, folder) for _, path, n in shapes]
        print_row(name, [f"{score[1] / score[0]:.3f}, {least[1] / least[0]:.2f}" for score, least in pairs])


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as own:
        folder = sys.argv[3] if len(sys.argv) == 4 else own
        shutil.copytree(sys.argv[1], os.path.join(folder, "source"), ignore=shutil.ignore_patterns(".git", "build*"))
        tabulate(sys.argv[2], folder)


if __name__ == "__main__":
    main()
