#!/usr/bin/env python3
"""Tables in Markdown from the results of mskit compare, at their finest resolution.

    docs/comparison-tables.py RESULTS.csv [N...]      n = 10, 30 and 100 by default
"""
import csv
import os
import statistics
import sys


def read(path):
    with open(path, newline="", encoding="utf-8") as f:
        rows = list(csv.DictReader(f))
    for row in rows:
        row["name"] = os.path.splitext(os.path.basename(row["shape"]))[0]
        row["method"] = row["generator"] + (":" + row["options"] if row["options"] else "")
    finest = max((float(row["cells"]) for row in rows if row["cells"]), default=None)
    return [row for row in rows if not row["cells"] or float(row["cells"]) == finest]


def unique(rows, key):
    return list(dict.fromkeys(row[key] for row in rows))


def table(rows, title, numbers, cell):
    """A row for each shape, a column for each method and number; `cell` makes text of a row of results."""
    methods = unique(rows, "method")
    found = {(row["name"], row["method"], row["n_asked"]): row for row in rows}
    print(f"\n{title}\n")
    print("| shape | " + " | ".join(f"{m} {n}" for m in methods for n in numbers) + " |")
    print("|---" * (1 + len(methods) * len(numbers)) + "|")
    for name in unique(rows, "name"):
        cells = [cell(found.get((name, m, n))) for m in methods for n in numbers]
        print(f"| {name} | " + " | ".join(cells) + " |")


def mismatch(row):
    """A star where there are fewer spheres than asked for."""
    if not row or not row["dice"]:
        return "-"
    return f"{float(row['dice']):.4f}" + ("*" if int(row["n"]) < int(row["n_asked"]) else "")


def seconds(row):
    return f"{float(row['seconds_generate']):.2g}" if row and row["seconds_generate"] else "-"


def per_cent(text):
    """0 below a hundred thousandth of a per cent: rounding."""
    value = 100 * float(text)
    return f"{value:.2g}" if value > 1e-5 else "0"


def inertia(row):
    """Before and after correction; none where no masses meet the centre."""
    if not row or not row["inertia_union"]:
        return "-"
    met = row["inertia_corrected"] and float(row.get("centre_epsilon") or 0) <= 1e-7
    after = per_cent(row["inertia_corrected"]) if met else "none"
    return f"{per_cent(row['inertia_union'])} / {after}"


def worst(rows, numbers):
    """For each method how far, and where farthest, it is behind the best method, by the same number of spheres."""
    rows = [row for row in rows if row["n_asked"] in numbers and row["dice"]]
    best = {}
    for row in rows:
        key = row["name"], row["n_asked"]
        best[key] = min(best.get(key, 1e300), float(row["dice"]))
    print("\nHow far each method is behind the best (D over the best D of as many spheres)\n")
    print("| method | geometric mean | worst | second | third | best of all in |\n|---|---|---|---|---|---|")
    for method in unique(rows, "method"):
        own = [(max(float(row["dice"]), 1e-12) / max(best[row["name"], row["n_asked"]], 1e-12), row) for row in rows
               if row["method"] == method]
        own.sort(key=lambda pair: -pair[0])
        cells = [f"{row['name']}, n = {row['n_asked']}: {ratio:.1f} (D {float(row['dice']):.2g})"
                 for ratio, row in own[:3]]
        cells += ["-"] * (3 - len(cells))
        mean = f"{statistics.geometric_mean(ratio for ratio, _ in own):.2f}" if own else "-"
        print(f"| {method} | {mean} | " + " | ".join(cells) +
              f" | {sum(ratio == 1 for ratio, _ in own)} of {len(own)} |")


def faults(rows):
    print("\nOf all rows\n")
    print("| method | rows | without result | fewer spheres than asked for | not connected | masses not found |")
    print("|---|---|---|---|---|---|")
    for method in unique(rows, "method"):
        own = [row for row in rows if row["method"] == method]
        done = [row for row in own if row["dice"]]
        fewer = sum(int(row["n"]) < int(row["n_asked"]) for row in done if row["n_asked"])
        pieces = sum(int(row["pieces"]) > 1 for row in done)
        unmet = sum(not row["epsilon"] for row in done)
        print(f"| {method} | {len(own)} | {len(own) - len(done)} | {fewer} | {pieces} | {unmet} |")


def on_front(row, rows):
    """Whether no run on its shape was both faster and at least as true."""
    return not any(other["name"] == row["name"] and float(other["seconds_generate"]) < float(row["seconds_generate"])
                   and float(other["dice"]) <= float(row["dice"]) for other in rows)


def in_voxels(rows, measure, number):
    values = [float(row[measure]) / float(row["voxel_size"]) for row in rows if row["n_asked"] == number]
    return f"{statistics.median(values):.1f}" if values else "-"


def places(rows, numbers):
    """Time and mismatch together, and by how far surfaces differ."""
    done = [row for row in rows if row["dice"] and row["seconds_generate"]]
    print("\nOn the Pareto front of time and D, of all rows; largest protrusion and largest gap, voxels, median of the "
          "shapes\n")
    heads = [f"{measure} {n}" for measure in ("protrusion", "gap") for n in numbers]
    print("| method | on the front | " + " | ".join(heads) + " |\n" + "|---" * (2 + len(heads)) + "|")
    for method in unique(done, "method"):
        own = [row for row in done if row["method"] == method]
        cells = [in_voxels(own, measure, n) for measure in ("protrusion_max", "gap_max") for n in numbers]
        front = sum(on_front(row, done) for row in own)
        print(f"| {method} | {front} of {len(own)} | " + " | ".join(cells) + " |")


def told(rows):
    """What the figures are of."""
    kinds = {key: ", ".join(dict.fromkeys(row[key] for row in rows if row["seconds_generate"]))
             for key in ("version", "machine", "threads", "repeats", "beside")}
    beside = "" if kinds["beside"] == "0" else ", with others beside them"
    runs = "single runs" if kinds["repeats"] == "1" else f"medians of {kinds['repeats']} runs"
    print(f"mskit {kinds['version']}, {rows[0]['cells']} cells, {len(rows)} rows; times on {kinds['machine']} by "
          f"{kinds['threads']} threads, {runs}{beside}.")


def main():
    numbers = sys.argv[2:] or ["10", "30", "100"]
    rows = read(sys.argv[1])
    told(rows)
    table(rows, "Mismatch D; * fewer spheres than asked for", numbers, mismatch)
    table(rows, "Time of the method, s", numbers, seconds)
    table(rows, "Error of the principal moments, %: of the union / with corrected masses (none: no masses meet the "
          "centre)", numbers, inertia)
    worst(rows, numbers)
    places(rows, numbers)
    faults(rows)


if __name__ == "__main__":
    main()
