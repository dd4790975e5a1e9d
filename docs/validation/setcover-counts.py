#!/usr/bin/env python3
"""Spheres that set cover needs for a coverage, and the coverage of so many, by two counts: the table of
docs/validation.md.

    MSKIT=build/eval/mskit docs/validation/setcover-counts.py

Spheroid and tablet of Yuan 2019, at d_eq/100 where nothing else is said, up to 900 and 500 spheres.
"""
import csv
import os
import tempfile

from judge import run

MSKIT = os.environ.get("MSKIT", "mskit")
BODIES = {"spheroid": ("ellipsoid", "a=6.585", "b=6.585", "c=3.395"), "tablet": ("tablet",)}
GOALS = {"95 %": 0.95, "99 %": 0.99, "99.9 %": 0.999, "99.99 %": 0.9999}
NUMBERS = (96, 250, 500)
COUNTS = ("coverage", "coverage_cut")
CHOICES = (("default", 100, ()), ("`--skeleton-deq 100`", 100, ("--skeleton-deq", "100")),
           ("`--candidates skeleton`", 100, ("--candidates", "skeleton")),
           ("`--candidates all`", 100, ("--candidates", "all")), ("`count=cut`", 100, ("--set", "count=cut")),
           ("`count=cut`, `--deq 50`", 50, ("--set", "count=cut")))
PAPER = "| paper | its own | 48 | 181 | 461 | 675 | 95.04 % | 97.85 % | 99.13 % |"


def curve(folder, body, spheres, deq, options):
    """Both coverages of the first n spheres, for n from 1."""
    path = os.path.join(folder, "curve.csv")
    run(MSKIT, "generate", os.path.join(folder, body + ".stl"), "-g", "setcover", "--deq", deq, "-n", spheres, *options,
        "--cut", "--curve", path, "-o", os.path.join(folder, "clump.csv"))
    with open(path, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def needed(rows, count, goal):
    return next((row["n"] for row in rows if float(row[count]) >= goal), "never")


def covered(rows, count, n):
    return f"{100 * float(rows[n - 1][count]):.2f} %" if n <= len(rows) else "-"


def main():
    first, *others = GOALS
    print(f"| choice | count | spheroid {first} | " + " | ".join(others) + f" | tablet by {NUMBERS[0]} | "
          + " | ".join(f"by {n}" for n in NUMBERS[1:]) + " |\n" + "|---" * (2 + len(GOALS) + len(NUMBERS)) +
          f"|\n{PAPER}")
    with tempfile.TemporaryDirectory() as folder:
        for body, kind in BODIES.items():
            run(MSKIT, "shape", *kind, "-o", os.path.join(folder, body + ".stl"))
        for name, deq, options in CHOICES:
            spheroid, tablet = (curve(folder, body, n, deq, options)
                                for body, n in (("spheroid", 900), ("tablet", 500)))
            for count in COUNTS:
                cells = [needed(spheroid, count, goal) for goal in GOALS.values()]
                cells += [covered(tablet, count, n) for n in NUMBERS]
                print("| " + " | ".join([name, f"`{count}`", *cells]) + " |", flush=True)


if __name__ == "__main__":
    main()
