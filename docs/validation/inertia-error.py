#!/usr/bin/env python3
"""Yuan's eps_w, the weighted mean error of the principal moments, at 90 and 95 % coverage by inscribed spheres.

    MSKIT=build/eval/mskit docs/validation/inertia-error.py [MESH]...

The shapes of the paper that have a formula are made by mskit: spheroid (5.2), tablet (5.1), ellipsoid (2.4; the edges
of its box are not given); further meshes are files.
"""
import json
import os
import sys
import tempfile

from judge import run

MSKIT = os.environ.get("MSKIT", "mskit")
MADE = {
    "spheroid": ["ellipsoid", "a=6.585", "b=6.585", "c=3.395"],
    "tablet": ["tablet"],
    "ellipsoid 1 : 1.414 : 1": ["ellipsoid", "a=1", "b=1.4142135623730951", "c=1"],
    "box": ["box"],
    "grain": ["grain"],
}


def row(name, mesh, folder):
    cells = []
    for coverage in ("0.90", "0.95"):
        clump = os.path.join(folder, "clump.csv")
        run(MSKIT, "generate", mesh, "-g", "setcover", "--deq", "100", "--until", f"coverage={coverage}", "-o", clump)
        scores = json.loads(run(MSKIT, "score", clump, "--target", mesh, "--deq", "100", "--json"))["scores"]
        cells.append(f"{100 * scores['inertia_error']['weighted_mean']:.1f} % ({scores['spheres']})")
    print(f"| {name} | {' | '.join(cells)} |", flush=True)


def main():
    print("| | 90 % | 95 % |\n|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name, shape in MADE.items():
            mesh = os.path.join(folder, name + ".stl")
            run(MSKIT, "shape", *shape, "-o", mesh)
            row(name, mesh, folder)
        for mesh in sys.argv[1:]:
            row(os.path.basename(mesh), mesh, folder)


if __name__ == "__main__":
    main()
