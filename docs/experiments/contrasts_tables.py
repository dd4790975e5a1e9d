"""The tables of docs/behaviour.md on beds, from contrasts.csv and contrasts-clumps.csv beside this file."""
import math
import os
import statistics
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, ".."))
import tables  # noqa: E402
from contrasts_cells import CELLS, CONTROLLED, CONTROLS, FRICTIONS, GRAINS, SERIES, find_cell  # noqa: E402
from intervals import interval, interval_by_own, pool  # noqa: E402
from packing import put_in_order  # noqa: E402

RUNS, CLUMPS = (os.path.join(HERE, name) for name in ("contrasts.csv", "contrasts-clumps.csv"))
RUN = ["cell", "step", "rate"]  # these and its seed tell a run
STEP, RATE = 4e-5, 8.0  # of the experiment; other rows are checks of these
LOOKED_AT = 2  # runs of a cell, of the first seeds: when the others were added
# what was measured: its heading, digits, and the margin of equivalence, of the reference's mean or in degrees
MEASURED = {"fraction": ("fraction", 4, ("relative", 0.01)), "start": ("start, degrees", 2, ("absolute", 1.0)),
            "stop": ("stop, degrees", 2, ("absolute", 1.0)),
            "flowed": ("fraction after flow", 4, ("relative", 0.01))}


def read_runs(path=RUNS):
    return put_in_order(tables.read_if_there(path, [*RUN, "seed"]), *RUN)


def take(rows, field, cell, step=STEP, rate=RATE):
    """Values of a cell, in the order of the rows."""
    return [float(row[field]) for row in rows
            if row["cell"] == cell and (float(row["step"]), float(row["rate"])) == (step, rate)]


def pool_cells(rows, field, cells=CELLS):
    return pool([values for values in (take(rows, field, cell) for cell in cells) if values])


def margin(field, reference):
    kind, size = MEASURED[field][2]
    return size * statistics.mean(reference) if kind == "relative" else size


def is_equivalent(difference, half, allowed):
    """The whole interval lies within the margin."""
    return abs(difference) + half <= allowed


def is_different(difference, half, allowed):
    """The whole interval lies outside the margin."""
    return abs(difference) - half > allowed


def show(difference, half, digits):
    return f"{difference:+.{digits}f} +- {half:.{digits}f}"


def table_clumps(rows):
    return tables.markdown(
        ["cell", "spheres", "D", "volume", "mean width", "normals, degrees", "convexity", "envelope",
         "contacts of a pair"],
        [[r["cell"], r["n"], f"{float(r['dice']):.4f}", f"{float(r['volume']):.4f}", f"{float(r['mean_width']):.4f}",
          f"{float(r['normal_median']):.1f}", f"{float(r['convexity']):.4f}", f"{float(r['envelope']):.4f}",
          f"{float(r['contacts']):.2f}"]
         for r in tables.read(CLUMPS) if take(rows, "fraction", r["cell"])])


def table_runs(rows, cells=CELLS):
    out = []
    for cell in cells:
        found = {field: take(rows, field, cell) for field in [*MEASURED, "cpu_seconds"]}
        if found["fraction"]:
            out.append([cell, str(len(found["fraction"]))] + [f"{statistics.mean(found[f]):.{MEASURED[f][1]}f}"
                                                              for f in MEASURED]
                       + [f"{statistics.mean(found['cpu_seconds']):.0f}"])
    if not out:
        return "None was run yet."
    spread = [f"{pool_cells(rows, f, cells)[0]:.{MEASURED[f][1]}f}" for f in MEASURED]
    out.append(["spread within cells", str(pool_cells(rows, "fraction", cells)[1])] + spread + [""])
    return tables.markdown(["cell", "runs"] + [head for head, _, _ in MEASURED.values()] + ["CPU s"], out)


def table_contrasts(rows, contrasts, pooled=CELLS):
    out = []
    for what, cell, other in contrasts:
        these, those = (take(rows, "fraction", name) for name in (cell, other))
        if these and those:
            out.append([what, f"{cell} - {other}", f"{len(these)}, {len(those)}"] + [
                show(*interval(take(rows, f, cell), take(rows, f, other), *pool_cells(rows, f, pooled)),
                     MEASURED[f][1]) for f in MEASURED])
    if not out:
        return "None was run yet."
    return tables.markdown(["contrast", "difference", "runs"] + [head for head, _, _ in MEASURED.values()], out)


def find_friction(rows, field, cell):
    """At which the candy has what the cell has, by straight lines between its runs; NaN beyond them."""
    value = statistics.mean(take(rows, field, cell))
    points = sorted((statistics.mean(take(rows, field, name)), find_cell(name).friction)
                    for name in ("smooth", *FRICTIONS) if name.startswith("smooth") and take(rows, field, name))
    for (low, at), (high, to) in zip(points, points[1:]):
        if low <= value <= high and low < high:
            return at + (to - at) * (value - low) / (high - low)
    return math.nan


def table_friction(rows, cell="variational-10"):
    table = table_contrasts(rows, FRICTION_CONTRASTS, ["smooth", "variational-10", *FRICTIONS])
    if not take(rows, "fraction", cell) or not take(rows, "fraction", "smooth"):
        return table
    found = [find_friction(rows, field, cell) for field in MEASURED]
    line = [f"friction of the candy for {cell}", "", "", *("" if math.isnan(x) else f"{x:.2f}" for x in found)]
    return f"{table}\n| {' | '.join(line)} |"


def list_controls():
    """Each control against its cell, then one cell against the other under the same law."""
    few, many = CONTROLLED
    laws = ["", *dict.fromkeys(name[len(few):] for name in CONTROLS if name.startswith(few))]
    return ([(law.strip("-"), cell + law, cell) for law in laws[1:] for cell in CONTROLLED]
            + [(law.strip("-") or "as above", many + law, few + law) for law in laws])


def judge_series(rows, field, reference):
    """Of each cell of the series but the reference (cell, difference, half of the interval, verdict): within the
    margin, enough if so at every larger n too, outside, or nothing."""
    series = [cell for cell in SERIES if take(rows, field, cell) and cell != reference]
    those, out, so_far = take(rows, field, reference), [], True
    for cell in reversed(series):
        difference, half = interval(take(rows, field, cell), those, *pool_cells(rows, field))
        allowed = margin(field, those)
        within = is_equivalent(difference, half, allowed)
        so_far = so_far and within
        verdict = "enough" if so_far else "within" if within else ""
        out.append((cell, difference, half, "outside" if is_different(difference, half, allowed) else verdict))
    return out[::-1]


def table_enough(rows, reference):
    if not take(rows, "fraction", reference):
        return "None was run yet."
    out = []
    for lines in zip(*(judge_series(rows, field, reference) for field in MEASURED)):
        out.append([lines[0][0]] + [
            ", ".join(filter(None, (show(difference, half, MEASURED[field][1]), verdict)))
            for field, (_, difference, half, verdict) in zip(MEASURED, lines)])
    return tables.markdown([f"cell - {reference}"] + [head for head, _, _ in MEASURED.values()], out)


def find_largest(rows):
    """The last cell of SERIES that was run, or of all where none was."""
    return [cell for cell in SERIES if take(rows, "fraction", cell) or cell == SERIES[0]][-1]


def judge_otherwise(rows, field, cell, reference, at_once):
    """By which intervals of the difference it is not 0: that of the rule; with each cell's own variance; of the runs
    alone that came when the first of the cell had been looked at; of so many differences at once."""
    these, those = (take(rows, field, name) for name in (cell, reference))
    pooled = pool_cells(rows, field)
    found = {"rule": interval(these, those, *pooled), "at once": interval(these, those, *pooled, at_once)}
    if min(len(these), len(those)) > LOOKED_AT:  # three runs or more, below which Welch's interval is none
        late = [values for values in (take(rows, field, name)[LOOKED_AT:] for name in [*SERIES, reference]) if values]
        found |= {"own": interval_by_own(these, those),
                  "later": interval(these[LOOKED_AT:], those[LOOKED_AT:], *pool(late))}
    ways = [way for way in ("rule", "own", "later", "at once") if way in found and is_different(*found[way], 0)]
    return "all four" if len(ways) == 4 else ", ".join(ways) or "none"


def table_otherwise(rows, reference):
    cells = [cell for cell in SERIES if take(rows, "fraction", cell)]
    if not cells or not take(rows, "fraction", reference):
        return "None was run yet."
    count = len(cells) * len(MEASURED)
    return tables.markdown(
        [f"cell - {reference}"] + [head for head, _, _ in MEASURED.values()],
        [[cell] + [judge_otherwise(rows, field, cell, reference, count) for field in MEASURED]
         for cell in cells])


def table_checks(rows):
    """Other steps and rates, against the experiment's of the same cell."""
    out = []
    for cell, step, rate in dict.fromkeys((r["cell"], float(r["step"]), float(r["rate"])) for r in rows):
        if (step, rate) != (STEP, RATE) and take(rows, "fraction", cell):
            pairs = {f: (take(rows, f, cell, step, rate), take(rows, f, cell)) for f in MEASURED}
            out.append([cell, f"{step:g}", f"{rate:g}", str(len(pairs["fraction"][0]))] + [
                show(*interval(*pairs[f], *pool_cells(rows, f)), MEASURED[f][1]) for f in MEASURED])
    if not out:
        return "None was run yet."
    return tables.markdown(["cell", "step, s", "degrees a second", "runs"] + [head for head, _, _ in MEASURED.values()],
                           out)


def table_steps(rows, reference):
    """Cells against the reference by another step or rate, where both were run, beneath the experiment's."""
    known = dict.fromkeys((r["cell"], float(r["step"]), float(r["rate"])) for r in rows)
    out = []
    for cell, *other in known:
        needed = {(reference, *other), (cell, STEP, RATE), (reference, STEP, RATE)}
        if other != [STEP, RATE] and cell != reference and needed <= set(known):
            for how in ([STEP, RATE], other):
                pairs = {f: [take(rows, f, name, *how) for name in (cell, reference)] for f in MEASURED}
                out.append([f"{cell} - {reference}", *(f"{x:g}" for x in how),
                            ", ".join(str(len(values)) for values in pairs["fraction"])]
                           + [show(*interval(*pairs[f], *pool_cells(rows, f)), MEASURED[f][1]) for f in MEASURED])
    if not out:
        return "None was run yet."
    return tables.markdown(["difference", "step, s", "degrees a second", "runs"]
                           + [head for head, _, _ in MEASURED.values()], out)


def list_grains():
    """Each clump of the grain against that of the most spheres."""
    *fewer, most = GRAINS
    return [("fewer spheres", cell, most) for cell in fewer]


def fit_line(points):
    """Slope and intercept of least squares."""
    x, y = ([point[k] for point in points] for k in (0, 1))
    middle, height = statistics.mean(x), statistics.mean(y)
    slope = sum((a - middle) * (b - height) for a, b in points) / sum((a - middle) ** 2 for a in x)
    return slope, height - slope * middle


def root_mean_square(values):
    return math.sqrt(statistics.mean(x * x for x in values)) if values else math.nan


def judge_predictor(rows, clumps, field, predictor):
    """Root mean square errors of a line through the cells of the series, but for the sphere: on these, on cells of
    other methods and radii, which had no part in it, on the candy itself, and of the line's slope on the differences of
    the grain's clumps from the largest; NaN where those were not run. None predicts the mean of the series, and no
    difference."""
    points = {}
    for row in clumps:
        values = take(rows, field, row["cell"])
        if values and row["method"] != "sphere":
            points[row["cell"]] = (float(row[predictor]) if predictor else 0.0, statistics.mean(values))
    *grains, last = [points[cell] for cell in GRAINS if cell in points] or [(math.nan, math.nan)]
    inside, outside = ([point for cell, point in points.items() if cell in CELLS and (cell in SERIES) == part]
                       for part in (True, False))
    slope, at = fit_line(inside) if predictor else (0.0, statistics.mean(y for _, y in inside))
    of_body = take(rows, field, "smooth")
    body = [(BODY[predictor] if predictor else 0.0, statistics.mean(of_body))] if of_body else []
    return [*(root_mean_square([at + slope * x - y for x, y in part]) for part in (inside, outside, body)),
            root_mean_square([slope * (x - last[0]) - (y - last[1]) for x, y in grains])]


def table_predictors(rows):
    if sum(bool(take(rows, "fraction", cell)) for cell in SERIES[1:]) < 2:  # for a line
        return "Too few cells were run yet."
    clumps, out = tables.read(CLUMPS), []
    for predictor, name in PREDICTORS.items():
        line = [name]
        for field in MEASURED:
            line.append(", ".join(f"{error:.{MEASURED[field][1]}f}" for error in
                                  judge_predictor(rows, clumps, field, predictor)))
        out.append(line)
    return tables.markdown(["predictor"] + [head for head, _, _ in MEASURED.values()], out)


# columns of contrasts-clumps.csv, and the candy's own
BODY = {"dice": 0.0, "mean_width": 1.0, "normal_median": 0.0, "convexity": 1.0, "envelope": 1.0,
        "contacts": 1.0}
PREDICTORS = {"": "none", "dice": "D", "mean_width": "mean width", "normal_median": "normals", "convexity": "convexity",
              "envelope": "envelope", "contacts": "contacts of a pair"}
# what is asked, cell, what it is held against
CONTRASTS = [
    ("radii -3 %", "variational-10-small", "variational-10"), ("radii +3 %", "variational-10-large", "variational-10"),
    ("20 spheres, other D", "euclid-20", "variational-20"), ("10 spheres, other D", "setcover-10", "variational-10"),
    ("10 and 20 spheres", "variational-10", "variational-20"), ("equal D, other n", "euclid-20", "variational-10"),
    ("rolling friction", "sphere-0.1", "sphere-0"),
    ("a ball as a superquadric", "smooth-ball", "sphere-0"),
]
FRICTION_CONTRASTS = [
    ("more friction", "smooth-f0.5", "smooth"), ("more friction", "smooth-f0.7", "smooth"),
    ("less friction", "variational-10-f0.2", "variational-10"),
    ("bumps for friction", "variational-10", "smooth-f0.5"), ("bumps for friction", "variational-10", "smooth-f0.7"),
    ("bumps for friction", "variational-10-f0.2", "smooth"),
]


def fill():
    rows = read_runs()
    tables.fill(os.path.join(HERE, "..", "behaviour.md"), {
        "bed-clumps": table_clumps(rows), "bed-runs": table_runs(rows),
        "bed-contrasts": table_contrasts(rows, CONTRASTS),
        "bed-controls": table_contrasts(rows, list_controls(), [*CONTROLLED, *CONTROLS]),
        "bed-friction": table_friction(rows),
        "bed-grain": table_runs(rows, GRAINS),
        "bed-grain-contrasts": table_contrasts(rows, list_grains(), GRAINS),
        "bed-enough": table_enough(rows, find_largest(rows)),
        "bed-smooth": table_enough(rows, "smooth"), "bed-predictors": table_predictors(rows),
        "bed-otherwise": table_otherwise(rows, "smooth"), "bed-checks": table_checks(rows),
        "bed-steps": table_steps(rows, "smooth")})
