#!/usr/bin/env python3
"""Tables of docs/stability.md from the results of docs/make-stability.sh.

    docs/stability-tables.py RESULTS docs/stability.md

What stands between <!-- NAME --> and <!-- end --> is replaced.
"""
import json
import os
import statistics
import sys

import tables
from tables import markdown

RESULTS, DOCUMENT = sys.argv[1:]
HARMLESS = ("axes", "rotation", "shift", "lattice", "refine", "seed", "order", "threads")  # the same shape
HARD = ("bowl", "limbs", "cavity", "corners", "pair")
NUMBERS = ("5", "10", "20", "50", "100", "200")
FILLED = ("10", "20", "50", "100")


def read(name):
    return tables.read(os.path.join(RESULTS, name))


def text_of(name):
    with open(os.path.join(RESULTS, name), encoding="utf-8") as stream:
        return stream.read().strip()


def of_json(name):
    return json.loads(text_of(name))


def unique(rows, key):
    return list(dict.fromkeys(row[key] for row in rows))


def select(rows, **wanted):
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def number(value):
    return f"{value:.4f}" if value < 0.01 else f"{value:.3f}"


def dice(row):
    return float(row["dice"]) if row["dice"] else None


def span(values, text=number):
    return f"{text(min(values))} to {text(max(values))}"


def each(rows, head, cell):
    """A row for each shape, a column for each method; `cell` makes text of the runs of both."""
    methods = unique(rows, "generator")
    return markdown([head] + methods, [
        [shape] + [cell(select(rows, shape=shape, generator=method)) for method in methods]
        for shape in unique(rows, "shape")])


def unchanged(runs):
    return select(runs, perturbation="none")[0]


def by_harmless(runs):
    first = unchanged(runs)
    values = [dice(run) for run in runs if run["perturbation"] in HARMLESS and run["dice"]]
    if not first["dice"] or not values:
        return "failed"
    few = "" if first["status"] == "ok" else f", n = {first['n']}"
    return f"{number(dice(first))} ({span(values)}){few}"


def at_levels(kinds, pick):
    """D of some runs of a kind, of the shape itself where a kind is none."""
    def cell(runs):
        found = []
        for kind in kinds:
            own = select(runs, perturbation=kind)
            run = own[pick] if kind != "none" else own[0]
            found.append(number(dice(run)) if run["dice"] else run["status"])
        return ", ".join(found)
    return cell


def over_levels(kind):
    def cell(runs):
        return ", ".join(number(dice(run)) if run["dice"] else run["status"] for run in select(runs, perturbation=kind))
    return cell


def ratios(rows):
    """Of each change D over that of the unchanged shape, least to most over the shapes, and where it is most."""
    methods = unique(rows, "generator")
    lines = []
    for kind in unique(rows, "perturbation")[1:]:
        line = [kind]
        for method in methods:
            found, same = [], True
            for run in select(rows, generator=method, perturbation=kind):
                first = unchanged(select(rows, generator=method, shape=run["shape"]))
                if run["dice"] and first["dice"] and dice(first) > 0:
                    found.append((dice(run) / dice(first), run["shape"]))
                    same &= run["spheres_fnv1a"] == first["spheres_fnv1a"]
            line.append("same" if same else f"{min(found)[0]:.2f} to {max(found)[0]:.2f} ({max(found)[1]})")
        lines.append(line)
    return markdown(["changed"] + methods, lines)


def find_faults(runs, least):
    """Names of failures and how many runs have them."""
    first, tried = unchanged(runs), [run for run in runs if run["status"] != "unusable"]
    given = [run for run in tried if run["dice"]]
    return {
        "no clump": len(tried) - len(given),
        "in pieces": sum(int(run["pieces"]) > 1 for run in given),
        "too few": sum(run["status"] == "short" and dice(run) > 2 * least for run in given),
        "behind": sum(dice(run) > 2 * least for run in given),
        "moved": sum(run["perturbation"] in HARMLESS and bool(first["dice"]) and dice(run) > 1.5 * dice(first)
                     for run in given),
    }, len(tried)


def faults(rows):
    """Of each shape and method its failures; the last column has the method of the least D in the median."""
    methods = unique(rows, "generator")
    lines = []
    for shape in unique(rows, "shape"):
        own = {method: select(rows, shape=shape, generator=method) for method in methods}
        least = min(dice(unchanged(runs)) for runs in own.values() if unchanged(runs)["dice"])
        line = [shape]
        for runs in own.values():
            found, tried = find_faults(runs, least)
            line.append(", ".join(f"{name} {count}" for name, count in found.items() if count) or "-")
        middle = {method: statistics.median(dice(run) for run in runs if run["dice"]) for method, runs in own.items()}
        best = min(middle, key=middle.get)
        lines.append(line + [f"{tried}", f"{best} ({number(middle[best])})"])
    return markdown(["shape"] + methods + ["runs", "least D in the median"], lines)


def until(rows):
    """Spheres at fixed D."""
    methods = unique(rows, "generator")
    lines = []
    for shape in unique(rows, "shape"):
        for kind in unique(rows, "perturbation"):
            line = [f"{shape}, {kind}"]
            for method in methods:
                own = [run["n_until"] for run in select(rows, shape=shape, perturbation=kind, generator=method)]
                met = [int(n) for n in own if n]
                missed = f"{len(own) - len(met)} not reached" if len(met) < len(own) else ""
                spread = "" if not met else f"{met[0]}" if min(met) == max(met) else f"{min(met)} to {max(met)}"
                line.append(", ".join(part for part in (spread, missed) if part))
            lines.append(line)
    return markdown(["shape, changed"] + methods, lines)


def by_number():
    """D of the unchanged shape, with its pieces where they are several."""
    lines = []
    found = {n: select(read("all.csv" if n == "20" else f"hard-{n}.csv"), perturbation="none") for n in NUMBERS}
    for shape in HARD:
        for row in select(found[NUMBERS[0]], shape=shape):
            line = [f"{shape}, {row['generator']}"]
            for n in NUMBERS:
                run = select(found[n], shape=shape, generator=row["generator"])[0]
                pieces = int(run["pieces"] or 0)
                line.append((number(dice(run)) if run["dice"] else run["status"])
                            + (f" ({pieces} pieces)" if pieces > 1 else ""))
            lines.append(line)
    return markdown(["shape, method"] + [f"n = {n}" for n in NUMBERS], lines)


def filled():
    """The part of the cavity that spheres fill."""
    methods = unique(read("all.csv"), "generator")
    return markdown(["n asked for"] + methods, [
        [n] + [f"{100 * of_json(f'hollow-{method}-{n}.filled.json')['scores']['coverage']:.3g} %" for method in methods]
        for n in FILLED])


def told(rows):
    seconds = {}
    for line in text_of("seconds.txt").splitlines():  # of a run that was taken up, both parts
        name, part = line.split()
        seconds[name] = seconds.get(name, 0) + int(part)
    return (f"{text_of('version.txt').splitlines()[0]}; {len(rows)} runs in {seconds['all'] / 60:.0f} minutes, of all "
            f"commands {sum(seconds.values()) / 60:.0f}, on a machine of {text_of('cores.txt')} cores.")


def main():
    rows = read("all.csv")
    tables.fill(DOCUMENT, {
        "told": told(rows), "harmless": each(rows, "shape", by_harmless), "ratios": ratios(rows),
        "resolution": each(rows, "shape", over_levels("resolution")),
        "most": each(rows, "shape", at_levels(("noise", "decimate"), -1)),
        "number": until(read("number.csv")), "faults": faults(rows), "by-number": by_number(), "filled": filled(),
    })


if __name__ == "__main__":
    main()
