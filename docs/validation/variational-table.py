#!/usr/bin/env python3
"""D and user time of variational, in Markdown, beside those of another build if one is given.

    MSKIT=build/eval/mskit docs/validation/variational-table.py DATA [OTHER_MSKIT]

DATA holds bunny.ply and human_femur.stl; those that are not there are named and left out. The other shapes are made. D
is scored at 200 cells along the longest side. One thread; the two builds take turns, and of three runs the least time
counts: its ratio tells more than itself.
"""
import json
import os
import sys
import tempfile

from timing import run

MADE = {"oblate": ["ellipsoid", "a=2", "b=2", "c=1", "fineness=100"],
        "prolate": ["ellipsoid", "a=2", "b=1", "c=1", "fineness=100"],
        "torus": ["torus"]}
ROWS = [("bunny.ply", 30, []), ("bunny.ply", 100, []), ("bunny.ply", 150, []), ("bunny.ply", 1000, []),
        ("human_femur.stl", 70, []), ("human_femur.stl", 70, ["--protrusion", "0"]), ("oblate", 200, []),
        ("oblate", 400, []), ("prolate", 10, []), ("prolate", 100, []), ("torus", 20, []), ("torus", 40, [])]
REPEATS = 3


def measure(builds, path, n, options, folder):
    """D and the least user time of each build."""
    clump = os.path.join(folder, "clump.csv")
    score, least = [None] * len(builds), [float("inf")] * len(builds)
    for _ in range(REPEATS):
        for b, mskit in enumerate(builds):
            least[b] = min(least[b],
                           run(mskit, "generate", path, "-g", "variational", "-n", n, *options, "-o", clump)[1])
            if score[b] is None:
                score[b] = json.loads(run(builds[0], "score", clump, "--target", path, "--cells", 200,
                                          "--json")[0])["scores"]["dice"]
    return score, least


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    builds = [os.environ.get("MSKIT", "build/eval/mskit")] + sys.argv[2:]
    print("| shape | n | D |" + (" other D | ratio |" if len(builds) > 1 else "") + " s |" +
          (" other s |" if len(builds) > 1 else ""))
    print("| --- |" + " --: |" * (3 if len(builds) == 1 else 6))
    with tempfile.TemporaryDirectory() as folder:
        for shape, n, options in ROWS:
            path = os.path.join(sys.argv[1], shape)
            if shape in MADE:
                path = os.path.join(folder, shape + ".stl")
                run(builds[0], "shape", *MADE[shape], "-o", path)
            if not os.path.exists(path):
                print(f"skipped: no {path}", file=sys.stderr)
                continue
            score, least = measure(builds, path, n, options, folder)
            cells = [" ".join([shape] + options), n, f"{score[0]:.5f}"]
            if len(builds) > 1:
                cells += [f"{score[1]:.5f}", f"{score[0] / score[1]:.3f}"]
            cells += [f"{t:.2f}" for t in least]
            print("| " + " | ".join(map(str, cells)) + " |", flush=True)


if __name__ == "__main__":
    main()
