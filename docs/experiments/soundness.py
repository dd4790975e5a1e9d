#!/usr/bin/env python3
"""What the intervals of the beds take for granted, held against the runs, and what so many runs can show.

    docs/experiments/soundness.py

Makes a table of docs/behaviour.md from contrasts.csv beside this file, as contrasts.py does when it has run. Takes
numpy. p is the part of 9999 cases, drawn with a seed that stands below, whose statistic is no less than that of the
runs, which count as one more:
    same seed       values change places within their cell; squares of the sums over each seed
    variances       as many values a cell of one normal distribution; Bartlett's statistic
    one mean        values change places between the cells; squares of the sums over each cell
Of two cells that are alike, as many runs of each, with the spread and its degrees of freedom as measured: half of the
interval of their difference over the margin, and the chance that the whole interval lies within it.
"""
import math
import os
import statistics

import numpy

from contrasts_cells import CELLS, GRAINS
from contrasts_tables import (HERE, LOOKED_AT, MEASURED, RATE, STEP, find_largest, is_different, is_equivalent,
                              judge_series, margin, pool_cells, read_runs, take)
from intervals import interval_by_own, quantile
import tables  # of docs, where contrasts_tables looks

SEED, DRAWS = 1, 9999
EACH, SURE = 6, 0.9  # runs of a cell, and a chance that will do
MOST = 10000  # runs of a cell beyond which none are counted


def find_part(found, drawn):
    """p of what was found among what was drawn; equal values may differ by rounding."""
    return (1 + numpy.count_nonzero(drawn >= (1 - 1e-9) * found)) / (1 + len(drawn))


def judge_groups(values, groups, strata):
    """p of no difference between groups: of the squares of their sums over their sizes, values less the mean of their
    stratum, where these change places within strata."""
    random = numpy.random.default_rng(SEED)
    values = numpy.array(values, dtype=float)
    _, group = numpy.unique(groups, return_inverse=True)
    parts = [numpy.flatnonzero(numpy.array(strata) == stratum) for stratum in dict.fromkeys(strata)]
    for part in parts:
        values[part] -= values[part].mean()
    orders = numpy.tile(values, (1 + DRAWS, 1))
    for part in parts:
        orders[1:, part] = random.permuted(orders[1:, part], axis=1)
    of_group = group[:, None] == numpy.arange(group.max() + 1)
    squares = ((orders @ of_group) ** 2 / of_group.sum(axis=0)).sum(axis=1)
    return find_part(squares[0], squares[1:])


def find_bartlett(variances, freedom):
    """The statistic of cells by their variances, but for a constant factor."""
    together = (variances * freedom).sum(axis=-1) / freedom.sum()
    with numpy.errstate(divide="ignore"):  # of a cell without any spread it is infinite
        return freedom.sum() * numpy.log(together) - (freedom * numpy.log(variances)).sum(axis=-1)


def judge_variances(cells):
    """p of one variance of all cells, of normal values."""
    cells = [values for values in cells if len(values) > 1]
    freedom = numpy.array([len(values) - 1 for values in cells])
    drawn = numpy.random.default_rng(SEED).chisquare(freedom, (DRAWS, len(cells))) / freedom
    found = find_bartlett(numpy.array([statistics.variance(values) for values in cells]), freedom)
    return find_part(found, find_bartlett(drawn, freedom))


def find_half(deviation, freedom, each):
    """Half of the 90 % interval of a difference, as many runs of each."""
    return quantile(freedom) * deviation * math.sqrt(2 / each)


def find_chance(deviation, freedom, allowed, each):
    """That the interval of two like cells lies within the margin, as many runs of each."""
    room = allowed - find_half(deviation, freedom, each)
    return max(0.0, 2 * statistics.NormalDist().cdf(room / (deviation * math.sqrt(2 / each))) - 1)


def count_runs(is_enough):
    """The least number of runs of each for which it is, in words."""
    return next((str(each) for each in range(2, MOST) if is_enough(each)), f"more than {MOST}")


def judge_cells(rows, cells):
    """p of the three tests, each by what was measured."""
    runs = [row for row in rows if row["cell"] in cells and (float(row["step"]), float(row["rate"])) == (STEP, RATE)]
    names = [row["cell"] for row in runs]
    values = {field: [float(row[field]) for row in runs] for field in MEASURED}
    return {"same seed": [judge_groups(values[f], [row["seed"] for row in runs], names) for f in MEASURED],
            "variances": [judge_variances([take(rows, f, cell) for cell in cells]) for f in MEASURED],
            "one mean": [judge_groups(values[f], names, [""] * len(runs)) for f in MEASURED]}


def list_chances(rows, reference):
    """Lines: what so many runs can show of two like cells."""
    halves, chances, fitting, sure = [], [], [], []
    for field in MEASURED:
        spread, allowed = pool_cells(rows, field), margin(field, take(rows, field, reference))
        halves.append(f"{find_half(*spread, EACH) / allowed:.1f}")
        chances.append(f"{find_chance(*spread, allowed, EACH):.2f}")
        fitting.append(count_runs(lambda each, s=spread, m=allowed: find_half(*s, each) <= m))
        sure.append(count_runs(lambda each, s=spread, m=allowed: find_chance(*s, m, each) >= SURE))
    return [[f"half an interval over the margin, {EACH} runs of each", *halves],
            [f"chance that like cells are found alike, {EACH} runs of each", *chances],
            ["runs of each until half an interval is the margin", *fitting],
            [f"runs of each until that chance is {SURE:g}", *sure]]


def list_changes(rows, reference):
    """Cells whose verdict is another with each cell's own variance (of three runs or more), by what was measured."""
    if len(take(rows, "fraction", reference)) <= LOOKED_AT:
        return ["too few runs"] * len(MEASURED)
    out = []
    for field in MEASURED:
        those, changed = take(rows, field, reference), []
        for cell, *pooled, _ in judge_series(rows, field, reference):
            these, allowed = take(rows, field, cell), margin(field, those)
            if len(these) > LOOKED_AT:
                own = interval_by_own(these, those)
                if any(judge(*pooled, allowed) != judge(*own, allowed) for judge in (is_equivalent, is_different)):
                    changed.append(cell)
        out.append(", ".join(changed) or "none")
    return out


def has_spread(rows, cells):
    return all(pool_cells(rows, field, cells)[0] > 0 for field in MEASURED)


def make_table(rows):
    if not take(rows, "fraction", "smooth") or not has_spread(rows, CELLS):
        return "None was run yet."
    out = []
    for body, cells in (("candy", CELLS), ("grain", GRAINS)):
        if has_spread(rows, cells):
            out += [[f"{body}: {what}, p", *(f"{p:.{4 if p < 0.01 else 2}f}" for p in found)]
                    for what, found in judge_cells(rows, cells).items()]
    out += list_chances(rows, "smooth")
    out += [[f"other verdicts against {reference} by own variances", *list_changes(rows, reference)]
            for reference in (find_largest(rows), "smooth")]
    return tables.markdown(["", *(head for head, _, _ in MEASURED.values())], out)


def fill():
    tables.fill(os.path.join(HERE, "..", "behaviour.md"), {"bed-soundness": make_table(read_runs())})


if __name__ == "__main__":
    fill()
