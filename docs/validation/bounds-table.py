#!/usr/bin/env python3
"""What `gap` and `connected` of variational cost by many spheres: the table of docs/validation.md.

    MSKIT=build/eval/mskit docs/validation/bounds-table.py SHARED [N,N,...] [NAME,NAME,...]

SHARED holds data/open-clumps/NAME.stl, data/human_femur.stl and data/bunny.ply. Each shape gets N spheres (60, 150)
three times: free, with `gap` half the largest gap of the free ones, and `connected`. D, gap (voxels of 100 cells) and
pieces are those of mskit's own measures, times are user times of one thread, reading and scoring included. How often
both are held goes to standard error.
"""
import json
import os
import sys

from timing import run

MSKIT = os.environ.get("MSKIT", "mskit")


def generate(mesh, n, *options):
    text, seconds = run(MSKIT, "generate", mesh, "-g", "variational", "-n", n, "-o", "/dev/null", "--format", "csv",
                        "--json", *options)
    told = json.loads(text)
    scores = told["scores"]
    return {"n": scores["spheres"], "dice": scores["dice"], "pieces": scores["pieces"],
            "gap": scores["gap_max"] / told["input"]["voxel_size"],
            "seconds": seconds}


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    data = os.path.join(sys.argv[1], "data")
    counts = [int(word) for word in sys.argv[2].split(",")] if len(sys.argv) > 2 else [60, 150]
    names = sys.argv[3].split(",") if len(sys.argv) > 3 else None
    folder = os.path.join(data, "open-clumps")
    meshes = [os.path.join(folder, name) for name in sorted(os.listdir(folder)) if name.endswith(".stl")]
    meshes += [os.path.join(data, name) for name in ("human_femur.stl", "bunny.ply")]
    print("| shape | n | D | gap | pieces | s | gap <= | gap | D | s | n connected | pieces | D | s |")
    print("|" + "---|" * 14)
    for n in counts:
        held = {"gap": 0, "connected": 0}
        tried = 0
        for mesh in meshes:
            name = os.path.basename(mesh).rsplit(".", 1)[0]
            if names and name not in names:
                continue
            free = generate(mesh, n)
            bound = round(free["gap"] / 2, 2)
            near = generate(mesh, n, "--gap", repr(bound))
            one = generate(mesh, n, "--connected")
            tried += 1
            held["gap"] += near["gap"] <= bound * (1 + 1e-6)
            held["connected"] += one["pieces"] == 1 and one["n"] == n
            print(f"| {name} | {n} | {free['dice']:.4f} | {free['gap']:.1f} | {free['pieces']} | {free['seconds']:.1f} "
                  f"| {bound:.2f} | {near['gap']:.2f} | {near['dice']:.4f} | {near['seconds']:.1f} "
                  f"| {one['n']} | {one['pieces']} | {one['dice']:.4f} | {one['seconds']:.1f} |", flush=True)
        print(f"{n} spheres: gap held in {held['gap']}, connected with all spheres in {held['connected']}, of {tried}",
              file=sys.stderr)


if __name__ == "__main__":
    main()
