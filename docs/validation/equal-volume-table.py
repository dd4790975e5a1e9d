#!/usr/bin/env python3
"""What the volume of the shape costs variational: D, in Markdown.

    MSKIT=build/eval/mskit docs/validation/equal-volume-table.py DATA

Of the free clump, of the same one scaled afterwards, and of the one that is fitted under the constraint, with the
volume of the free one and the user time of both runs. DATA holds the meshes named below; those that are not there are
named and left out. The other shapes are made. D is scored at 200 cells along the longest side. One thread.
"""
import json
import os
import sys
import tempfile

from timing import run

SHAPES = ["bunny.ply", "human_femur.stl", "sand_grain.stl", "pear.stl", "cube", "torus", "bowl"]
NUMBERS = [10, 30, 100]


def measure(mskit, path, n, flags, folder):
    """D, the volume over the shape's, user time."""
    clump = os.path.join(folder, "clump.csv")
    seconds = run(mskit, "generate", path, "-g", "variational", "-n", n, *flags, "-o", clump)[1]
    scores = json.loads(run(mskit, "score", clump, "--target", path, "--cells", 200, "--json")[0])["scores"]
    return scores["dice"], scores["off_volume"], seconds


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    mskit = os.environ.get("MSKIT", "build/eval/mskit")
    print("| shape | n | volume, free | D free | scaled | held | s free | s held |")
    print("| --- |" + " --: |" * 7)
    with tempfile.TemporaryDirectory() as folder:
        for shape in SHAPES:
            path = os.path.join(sys.argv[1], shape)
            if "." not in shape:
                path = os.path.join(folder, shape + ".stl")
                run(mskit, "shape", shape, "-o", path)
            if not os.path.exists(path):
                print(f"skipped: no {path}", file=sys.stderr)
                continue
            for n in NUMBERS:
                free, volume, before = measure(mskit, path, n, [], folder)
                scaled = measure(mskit, path, n, ["--equal-volume", "--set", "hold-volume=0"], folder)[0]
                held, _, seconds = measure(mskit, path, n, ["--equal-volume"], folder)
                print(f"| {shape} | {n} | {volume:.3f} | {free:.5f} | {scaled / free:.3f} | {held / free:.3f} | "
                      f"{before:.2f} | {seconds:.2f} |", flush=True)


if __name__ == "__main__":
    main()
