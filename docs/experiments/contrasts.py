#!/usr/bin/env python3
"""How many spheres are enough in bulk: beds of M&M candies by clumps that differ in one thing, in LIGGGHTS.

    docs/experiments/contrasts.py [--seeds K] [--cells NAME,...] [--largest N] [--step SECONDS] [--rate DEGREES]
                                  [--work FOLDER] [--most MINUTES]

A cell is a clump (contrasts_cells.py); a run is a cell with a seed. Each adds a row to contrasts.csv beside this file;
rows that are there are not run again. Then tables and chart of all of them go into docs/behaviour.md, which --seeds 0
does alone. MSKIT names the program (build/eval/mskit), LIGGGHTS the engine (liggghts), LIGGGHTS_SMOOTH one that was
built with superquadrics, for the candy itself, GRAIN the mesh of a second body. Takes numpy, and gnuplot.

Material, friction and stiffness are Yuan's (packing.py). A box of 60 x 60 mm, periodic in x and y, has a floor of 8 x 8
fixed spheres that touch. 250 candies in random orientations fall onto it from up to half a metre, all at once. At rest
(kinetic energy below 1e-6 m g d in the mean) height and fraction are measured; then gravity tilts towards x, by RATE
degrees a second from 16 degrees on and four times as fast before, until the bed flows at 0.05 m/s, and back until it
stands.
    height    mean of the highest points along vertical lines 0.5 mm apart, above the centres of the floor's spheres, mm
    fraction  between 1/4 and 3/4 of the height, the part within particles (voxels of 0.5 mm)
    start     degrees at which the mean velocity along x rises above 0.01 m/s and stays there until the bed flows
    stop      degrees at which, on the way back, it falls below that
    flowed    the fraction once it is below 0.002 m/s
Velocity is the mean over all spheres, of the cell smooth over its candies, every 0.01 s.
"""
import argparse
import os
import sys
import time

import contrasts_cells as cells
import contrasts_chart
import contrasts_tables
import soundness
from bed import LIGGGHTS_SMOOTH, run_bed
from packing import SEEDS, read_seeds
from program import read_count, read_positive
from tables import add_row

HERE = os.path.dirname(os.path.abspath(__file__))
TABLE = os.path.join(HERE, "contrasts.csv")
COLUMNS = ["cell", "seed", "step", "rate", "particles", "height", "fraction", "start", "stop", "flowed",
           "kinetic_over_m_g_d", "seconds", "cpu_seconds", "version"]


def run(folder, name, seed, step, rate):
    """One row."""
    work = os.path.join(folder, f"{name}-{seed}-{step:g}-{rate:g}")
    return {"cell": name, **run_bed(work, cells.make(folder, name), seed, step, rate)}


def can_run(cell):
    return (LIGGGHTS_SMOOTH or cell.method != "smooth") and (cells.GRAIN or cell.body == "candy")


def choose_cells(names, largest):
    if not names and not LIGGGHTS_SMOOTH:
        print("smooth: left out, as LIGGGHTS_SMOOTH names no engine", file=sys.stderr)
    known = [*cells.CELLS, *cells.CONTROLS, *cells.FRICTIONS, *cells.GRAINS]
    if not names and not cells.GRAIN:
        print("grain-N: left out, as GRAIN names no mesh", file=sys.stderr)
    asked = names.split(",") if names else [name for name in known if can_run(cells.find_cell(name))]
    for name in asked:
        if name not in known:
            sys.exit(f"there is no cell {name!r}; choose from {', '.join(known)}")
        if cells.find_cell(name).method == "smooth" and not LIGGGHTS_SMOOTH:
            sys.exit(f"{name}: LIGGGHTS_SMOOTH names no engine with superquadrics; build-smooth.sh makes one")
        if name in cells.GRAINS and not cells.GRAIN:
            sys.exit(f"{name}: GRAIN names no mesh")
    return [name for name in asked if cells.find_cell(name).n <= largest]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=read_seeds, default=3, help="runs of each cell (3)")
    parser.add_argument("--cells", help="names, with commas between (all)")
    parser.add_argument("--largest", type=read_count, default=20, help="no clumps of more spheres (20)")
    parser.add_argument("--step", type=read_positive, default=contrasts_tables.STEP, help="s (4e-5)")
    parser.add_argument("--rate", type=read_positive, default=contrasts_tables.RATE, help="degrees a second (8)")
    parser.add_argument("--work", default="contrasts", help="folder of the engine's files (contrasts)")
    parser.add_argument("--most", type=float, default=1e9, help="no run is begun after so many minutes")
    asked = parser.parse_args()
    os.makedirs(asked.work, exist_ok=True)
    cells.describe_all(asked.work, contrasts_tables.CLUMPS)
    begun, rows = time.time(), contrasts_tables.read_runs(TABLE)
    there = {(row["cell"], int(row["seed"]), float(row["step"]), float(row["rate"])) for row in rows}
    chosen = choose_cells(asked.cells, asked.largest) if asked.seeds else []
    for seed in SEEDS[:asked.seeds]:
        for name in chosen:
            if (name, seed, asked.step, asked.rate) in there:
                continue
            if time.time() - begun > 60 * asked.most:
                break
            row = run(asked.work, name, seed, asked.step, asked.rate)
            add_row(TABLE, COLUMNS, row)
            print(", ".join(f"{key} {row[key]}" for key in COLUMNS if key not in ("particles", "version")), flush=True)
    contrasts_tables.fill()
    soundness.fill()
    contrasts_chart.draw(contrasts_tables.read_runs(TABLE))


if __name__ == "__main__":
    main()
