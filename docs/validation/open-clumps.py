#!/usr/bin/env python3
"""variational against clumps that another generator published for its meshes: the table of docs/validation.md.

    MSKIT=build/eval/mskit docs/validation/open-clumps.py [SHARED]

SHARED (or MSKIT_SHARED) holds data/open-clumps with NAME.stl and NAME.spheres.csv, and tools/score.c, the judge,
compiled here by cc. Each shape gets as many spheres as theirs four times: by default options, with `gap` set to the
largest gap of theirs, `connected`, and no sphere below their least radius. D is the judge's, and lower only where that
of `mskit score --cells 100` is, too; gap (in voxels of 100 cells) and pieces are those of mskit score. In how many it
is held and lower goes to standard error.
"""
import json
import os
import sys
import tempfile

from judge import run

MSKIT = os.environ.get("MSKIT", "mskit")


def judge(program, mesh, clump):
    told = json.loads(run(MSKIT, "score", clump, "--target", mesh, "--cells", 100, "--json"))
    with open(clump) as lines:
        radii = [float(line.split(",")[3]) for line in lines if line[0] in "-0123456789"]
    return {"n": len(radii), "least": min(radii), "dice": json.loads(run(program, mesh, clump, 200))["D"],
            "score": told["scores"]["dice"], "pieces": told["scores"]["pieces"],
            "gap": told["scores"]["gap_max"] / told["target"]["voxel_size"]}


def is_lower(ours, theirs):
    return ours["dice"] < theirs["dice"] and ours["score"] < theirs["score"]


def compare(folder, program, mesh, theirs):
    """Ours for each setting, and whether it reaches what is asked of it."""
    clump = os.path.join(folder, "clump.csv")
    least = theirs["least"]
    settings = {"free": [], "gap": ["--gap", repr(theirs["gap"])], "connected": ["--connected"],
                "radius": ["--min-radius", repr(least)]}
    ours = {}
    for name, words in settings.items():
        run(MSKIT, "generate", mesh, "-g", "variational", "-n", theirs["n"], "-o", clump, *words)
        ours[name] = judge(program, mesh, clump)
    reached = {"free": True, "gap": ours["gap"]["gap"] <= theirs["gap"], "connected": ours["connected"]["pieces"] == 1,
               "radius": ours["radius"]["least"] >= least * (1 - 1e-9)}
    return ours, reached


def main():
    shared = sys.argv[1] if len(sys.argv) > 1 else os.environ.get("MSKIT_SHARED")
    if not shared:
        sys.exit(__doc__)
    data = os.path.join(shared, "data/open-clumps")
    if not os.path.isdir(data):
        sys.exit(f"no {data}")
    names = sorted(name[:-4] for name in os.listdir(data) if name.endswith(".stl"))
    held, won = dict.fromkeys(("free", "gap", "connected", "radius"), 0), dict.fromkeys(
        ("free", "gap", "connected", "radius"), 0)
    print("| shape | n | D theirs | D | gap theirs | gap | D | pieces theirs | pieces | D | least radius theirs "
          "| least radius | D |")
    print("|" + "---|" * 13)
    with tempfile.TemporaryDirectory() as folder:
        program = os.path.join(folder, "score")
        run("cc", "-O2", "-w", "-o", program, os.path.join(shared, "tools/score.c"), "-lm")
        for name in names:
            mesh = os.path.join(data, name + ".stl")
            theirs = judge(program, mesh, os.path.join(data, name + ".spheres.csv"))
            ours, reached = compare(folder, program, mesh, theirs)
            for key in held:
                held[key] += reached[key]
                won[key] += reached[key] and is_lower(ours[key], theirs)
            free, gap, one, radius = ours["free"], ours["gap"], ours["connected"], ours["radius"]
            print(f"| {name} | {theirs['n']} | {theirs['dice']:.4f} | {free['dice']:.4f} "
                  f"| {theirs['gap']:.1f} | {gap['gap']:.1f} | {gap['dice']:.4f} "
                  f"| {theirs['pieces']} | {one['pieces']} | {one['dice']:.4f} "
                  f"| {theirs['least']:.4f} | {radius['least']:.4f} | {radius['dice']:.4f} |", flush=True)
    for key in held:
        print(f"{key}: held in {held[key]}, and D lower in {won[key]}, of {len(names)}", file=sys.stderr)


if __name__ == "__main__":
    main()
