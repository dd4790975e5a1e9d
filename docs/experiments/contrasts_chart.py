"""The chart of docs/behaviour.md on beds: fraction and start angle against the number of spheres. Takes gnuplot."""
import os
import shutil
import statistics
import subprocess

from contrasts_cells import CELLS, GRAINS, SERIES, find_cell
from contrasts_tables import HERE, pool_cells, take
from intervals import quantile

CHART = os.path.join(HERE, "beds.svg")
COLOURS = ["#666666", "#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8c510a", "#56b4e9", "#e69f00",
           "#b2182b"]
SMOOTH, GRAIN = "the candy itself", "a grain, variational"
TITLES = {"fraction": "packing fraction", "start": "start angle, degrees"}


def find_group(name):
    cell = find_cell(name)
    if name in SERIES[1:]:
        return "variational"
    if name in GRAINS:
        return GRAIN
    if name == "smooth":
        return SMOOTH
    if name == "smooth-ball":
        return "a sphere, as a superquadric"
    if cell.method == "sphere":
        return f"a sphere, rolling friction {cell.rolling:g}"
    return f"{cell.method}, radii times {cell.radii:g}" if cell.radii != 1 else cell.method


def place(cell):
    """Along the axis: the smooth body stands behind the largest number."""
    return cell.n or 2 * max(cell.n for cell in CELLS.values())


def collect(rows, field):
    """Of each group of cells the points: number of spheres, mean, half of its 90 % interval by the pooled deviation."""
    groups = {}
    for cells in (CELLS, GRAINS):
        deviation, freedom = pool_cells(rows, field, cells)
        for name, cell in cells.items():
            values = take(rows, field, name)
            if values:
                half = quantile(freedom) * deviation / len(values) ** 0.5 if freedom else 0.0
                groups.setdefault(find_group(name), []).append((place(cell), statistics.mean(values), half))
    return groups


def write_commands(rows):
    places = sorted({(place(cell), str(cell.n or "smooth")) for name, cell in CELLS.items()
                     if take(rows, "fraction", name)})
    ticks = ", ".join(f"'{label}' {x}" for x, label in places)
    lines = ["set terminal svg size 900,520 background rgb 'white'", f"set output '{CHART}'",
             "set multiplot layout 1,2", "set key outside below maxcols 2 title ' '", "set logscale x",
             f"set xrange [0.8:{1.5 * places[-1][0]:g}]", f"set xtics ({ticks})",
             "set xlabel 'spheres'",
             "set offsets 0, 0, graph 0.05, graph 0.05"]
    for field, title in TITLES.items():
        plots = []
        for k, (name, points) in enumerate(collect(rows, field).items()):
            data, style = f"${field}{k}", "yerrorlines" if len(points) > 1 else "yerrorbars"
            lines.append(f"{data} << END\n" + "".join(f"{n} {mean} {half}\n" for n, mean, half in points) + "END")
            # as many spheres: beside each other
            shift = {SMOOTH: 1, GRAIN: 1.03}.get(name, 0.94 + 0.06 * k)
            plots.append(f"{data} using ($1*{shift}):2:3 with {style} linecolor rgb '{COLOURS[k]}' "
                         f"pointtype {k + 4} title '{name}'")
        lines += [f"set title '{title}'", "plot " + ", ".join(plots)]
    return "\n".join(lines) + "\n"


def draw(rows):
    if not shutil.which("gnuplot"):
        print("gnuplot is not installed (package gnuplot-nox): the chart is not drawn anew")
        return
    if not any(take(rows, "fraction", name) for name in CELLS):
        print("no cell of the candy was run yet: the chart is not drawn anew")
        return
    subprocess.run(["gnuplot"], input=write_commands(rows), encoding="utf-8", check=True)
