#!/usr/bin/env python3
"""D of methods by the independent judge: tables of docs/validation.md.

    MSKIT=build/eval/mskit docs/validation/judge-table.py SHARED others|fcm|radii|inscribed

SHARED holds data/ with the meshes, and tools/ with the judge (score.c, compiled here by cc) and tostl.py. `others`: mss
(variant=paper), setcover and variational; `fcm`; `radii`: fcm by the radii of its paper on the femur; `inscribed`:
setcover and variational with protrusion=0. 100 cells, seed 1; of the nested methods one run gives all n, of the others
each is a run of its own. In brackets how many spheres there are, where not as many as asked for.
"""
import os
import sys
import tempfile

from judge import Judge, run

SHAPES = ("asteroid_castalia.obj", "boulder_SP2B.stl", "bunny.ply", "ellipsoid_2_1_1.stl", "human_femur.stl",
          "lithic_flake2.ply", "octahedron.stl", "pear.stl", "powder_ma165_03636.stl", "sand_grain.stl", "torus.stl")
NUMBERS = (10, 20, 50, 100, 200)
OTHERS = (("mss", ["--variant", "paper"]), ("setcover", []), ("variational", []))
RADII = {"default": [], "`--norm sum --radius mean`": ["--norm", "sum", "--radius", "mean"],
         "`--radius mean`": ["--radius", "mean"]}
INSCRIBED = (("human_femur.stl", 70), ("bunny.ply", 100), ("oblate", 100), ("torus", 30), ("pear.stl", 50),
             ("open-clumps/boot.stl", 60))
MADE = {"oblate": ("ellipsoid", "a=2", "b=2", "c=1", "fineness=100"), "torus": ("torus",)}
NESTED = ("mss", "setcover")


def cells(judge, mesh, numbers, method, options):
    """D of each number."""
    most = judge.spheres(mesh[0], max(numbers), method, options) if method in NESTED else None
    for n in numbers:
        lines = most[:n] if most else judge.spheres(mesh[0], n, method, options)
        yield f"{judge.dice(mesh[1], lines):.4f}" + ("" if len(lines) == n else f" ({len(lines)})")


def table(judge, methods):
    print("| shape | n=" + " | ".join(str(n) for n in NUMBERS) + " |\n" + "|---" * (1 + len(NUMBERS)) + "|")
    for shape in SHAPES:
        mesh = judge.mesh(shape)
        if mesh:
            columns = zip(*(cells(judge, mesh, NUMBERS, *method) for method in methods))
            print("| " + " | ".join([os.path.splitext(shape)[0], *(" / ".join(c) for c in columns)]) + " |", flush=True)


def radii(judge):
    print("| human_femur | n=" + " | ".join(str(n) for n in NUMBERS) + " |\n" + "|---" * (1 + len(NUMBERS)) + "|")
    mesh = judge.mesh("human_femur.stl")
    for name, options in RADII.items() if mesh else ():
        print("| " + " | ".join([name, *cells(judge, mesh, NUMBERS, "fcm", options)]) + " |", flush=True)


def inscribed(judge):
    print("| shape | n | set cover | variational |\n|---|--:|--:|--:|")
    for shape, n in INSCRIBED:
        if shape in MADE:
            path = os.path.join(judge.folder, shape + ".stl")
            run(os.environ.get("MSKIT", "mskit"), "shape", *MADE[shape], "-o", path)
            mesh = path, path
        else:
            mesh = judge.mesh(shape)
        if mesh:
            found = [next(cells(judge, mesh, (n,), *method))
                     for method in (("setcover", []), ("variational", ["--protrusion", "0"]))]
            name = os.path.splitext(os.path.basename(shape))[0]
            print("| " + " | ".join([name, str(n), *found]) + " |", flush=True)


def main():
    if len(sys.argv) != 3 or sys.argv[2] not in ("others", "fcm", "radii", "inscribed"):
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        judge = Judge(sys.argv[1], folder)
        if sys.argv[2] == "others":
            table(judge, OTHERS)
        elif sys.argv[2] == "fcm":
            table(judge, (("fcm", []),))
        else:
            (radii if sys.argv[2] == "radii" else inscribed)(judge)


if __name__ == "__main__":
    main()
