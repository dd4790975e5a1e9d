#!/usr/bin/env python3
"""Tables and charts of docs/population.md from the results of docs/make-population.sh.

    docs/population-tables.py RESULTS docs/population.md

What stands between <!-- NAME --> and <!-- end --> is replaced; charts are copied into a folder beside the document.
"""
import json
import os
import shutil
import sys

import tables
from tables import markdown

RESULTS, DOCUMENT = sys.argv[1:]


def read(*names):
    return tables.read(os.path.join(RESULTS, *names))


def by_number(run, head, quantity, text):
    """A row for each method, a column for each number of spheres."""
    rows = [row for row in read(run, "population.csv") if row["quantity"] == quantity]
    numbers, methods = (list(dict.fromkeys(row[key] for row in rows)) for key in ("n_asked", "generator"))
    found = {(row["generator"], row["n_asked"]): text(row) for row in rows}
    return markdown([head] + [f"n = {n}" for n in numbers],
                    [[m] + [found.get((m, n), "-") for n in numbers] for m in methods])


def dice(row):
    return f"{float(row['mean']):.4f} ({float(row['lower_quartile']):.3f}, {float(row['upper_quartile']):.3f})"


def number(row):
    return f"{float(row['mean']):.3g}"


def best(run, by):
    rows = [row for row in read(run, "best.csv") if row["by"] == by]
    numbers, methods = (list(dict.fromkeys(row[key] for row in rows)) for key in ("n_asked", "generator"))

    def text(row):
        interval = f" [{float(row['factor_low']):.2f}, {float(row['factor_high']):.2f}]" if row["factor_low"] else ""
        return f"{row['best']}; {float(row['factor']):.2f}{interval}"
    found = {(row["generator"], row["n_asked"]): text(row) for row in rows}
    return markdown(["method"] + [f"n = {n}" for n in numbers],
                    [[m] + [found.get((m, n), "-") for n in numbers] for m in methods])


def libraries():
    rows = []
    for k in (5, 10, 20, 50):
        name = os.path.join(RESULTS, f"library-{k}")
        if os.path.exists(name + ".json"):
            with open(name + ".json", encoding="utf-8") as stream, open(name + ".time", encoding="utf-8") as seconds:
                found, cpu = json.load(stream), seconds.read().strip()
            split = "-" if found["split_distance"] is None else f"{found['split_distance']:.3f}"
            halves = "-" if found["halves_distance"] is None else f"{found['halves_distance']:.3f}"
            rows.append([str(k), f"{found['distance']['largest']:.3f}", f"{found['distance']['correlation']:.3f}",
                         f"{found['distance_of_clumps']['largest']:.3f}", f"{found['energy_distance']:.3f}",
                         f"{split} / {halves}", "yes" if found["over_fitted"] else "no",
                         f"{found['sieve_distance']:.3f}",
                         ", ".join(f"{d:.3g}" for d in found["d5_d50_d95_of_library"]), cpu])
    return markdown(["K", "largest KS", "correlations", "KS of the clumps", "energy", "halves: choice / chance",
                     "over-fitted", "sieve curve", "D5, D50, D95", "CPU s"], rows)


def told():
    """How many rows and seconds, and what the program itself said."""
    lines = []
    for run in ("methods", "baselines", "times"):
        rows = read(run + ".csv")
        shapes = len({row["shape"] for row in rows})
        failed = sum(not row["dice"] for row in rows)
        lines.append(f"{run}: {shapes} grains, {len(rows)} rows, {failed} without a clump, {rows[0]['cells']} cells")
        with open(os.path.join(RESULTS, run + ".err"), encoding="utf-8") as stream:
            lines += ["    " + line.strip() for line in stream if line.startswith("n = ")]
    with open(os.path.join(RESULTS, "seconds.txt"), encoding="utf-8") as stream:
        lines += ["wall time: " + line.strip() for line in stream]
    return "```\n" + "\n".join(lines) + "\n```"


def charts():
    folder = os.path.join(os.path.dirname(DOCUMENT), "population")
    os.makedirs(folder, exist_ok=True)
    for run, kind in (("methods", "dice"), ("baselines", "dice"), ("times", "time")):
        shutil.copy(os.path.join(RESULTS, run, f"population-{kind}.svg"), os.path.join(folder, f"{run}-{kind}.svg"))
    return ("![D of the methods](population/methods-dice.svg)\n![D of the baselines](population/baselines-dice.svg)\n"
            "![time of all](population/times-time.svg)")


def main():
    tables.fill(DOCUMENT, {
        "told": told(), "charts": charts(), "dice": by_number("methods", "method", "dice", dice),
        "baselines": by_number("baselines", "baseline", "dice", dice),
        "times": by_number("times", "method", "time_normalised", number),
        "seconds": by_number("times", "method", "seconds_generate", number),
        "best": best("methods", "dice"), "libraries": libraries(),
    })


if __name__ == "__main__":
    main()
