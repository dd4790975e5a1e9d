#!/usr/bin/env python3
"""Why beds of a few grains pack as they do (library.py): are the grains that were chosen others by form than as many
drawn at random, and does a figure of form go with the packing fraction?

    docs/experiments/library_forms.py GRAINS [--work FOLDER]

Repeats by their seeds the sets of library.csv, without the engine, from the clumps in FOLDER (library), which it makes
where they are missing; then makes two tables of docs/behaviour.md. GRAINS and MSKIT are those of library.py. Takes
numpy.

Figures of form are those of grains.csv that have no size: of shape and clump, of their distance (rms over the
equivalent radius), the ratio of the outer moments; and of the spheres the mean and the largest radius and the clump's
mean, least and largest width, over the same radius. Of a set each counts twice, by its mean and by its standard
deviation over the grains, weighted as in the bed. p, with the seed and so many draws as in soundness.py:
    of a set       part of the sets of as many grains, drawn at random, of which a figure lies as far out, in standard
                   deviations of such sets
    over the sets  part of the orders of the fractions in which the best of the figures goes as well with them
"""
import argparse
import os
import sys

import numpy

import library
from contrasts_cells import read_rows
from soundness import DRAWS, SEED, find_part
import tables  # of docs, where packing looks

DIRECTIONS = 500  # on half a sphere, in which a clump's width is taken
OF_SHAPE = ["sphericity", "elongation", "flatness", "feret_elongation", "feret_flatness", "corey", "convexity"]


def measure_spheres(spheres, radius):
    """Figures of a clump by its spheres, over the radius; widths in directions along Fibonacci's spiral."""
    z, turn = (numpy.arange(DIRECTIONS) + 0.5) / DIRECTIONS, numpy.pi * (1 + 5 ** 0.5) * numpy.arange(DIRECTIONS)
    across, spheres = numpy.sqrt(1 - z * z), numpy.array(spheres) / radius
    along = numpy.stack([across * numpy.cos(turn), across * numpy.sin(turn), z], axis=1) @ spheres[:, :3].T
    width = (along + spheres[:, 3]).max(axis=1) + (spheres[:, 3] - along).max(axis=1)
    return {"mean radius": spheres[:, 3].mean(), "largest radius": spheres[:, 3].max(), "mean width": width.mean(),
            "least width": width.min(), "largest width": width.max()}


def measure_form(row, spheres):
    """Figures of a grain by its row of grains.csv, in mm, and its spheres in m."""
    def read(name):
        if not row[name]:
            sys.exit(f"{row['file']}: grains.csv has no {name} of it, which is a figure of form")
        return float(row[name])
    radius = read("equivalent_diameter") / 2
    return {**{f"{name.replace('_', ' ')} of the {what}": read(f"{what}_{name}")
               for name in OF_SHAPE for what in ("shape", "clump")},
            **{name: read(f"{name}_rms") * read("voxel_size") / radius for name in ("protrusion", "gap")},
            "D": read("dice"), "least radius": read("smallest_radius_ratio"),
            "outer moments": read("moment_3") / read("moment_1"), **measure_spheres(spheres, 1e-3 * radius)}


def find_figures(weights, forms):
    """Means, then standard deviations, of sets (rows of weights over the grains) by the figures (columns of forms)."""
    centred = forms - forms.mean(axis=0)  # against rounding
    means = weights @ centred
    return numpy.hstack([means + forms.mean(axis=0), numpy.sqrt(numpy.maximum(weights @ centred ** 2 - means ** 2, 0))])


def judge_set(weights, forms):
    """Of one set: the number of its figure farthest out, how far, and p."""
    random, kinds = numpy.random.default_rng(SEED), numpy.count_nonzero(weights)
    drawn = numpy.zeros((DRAWS, len(forms)))
    numpy.put_along_axis(drawn, random.random(drawn.shape).argsort(axis=1)[:, :kinds], 1 / kinds, axis=1)
    figures = find_figures(numpy.vstack([weights, drawn]), forms)
    spread = figures[1:].std(axis=0)
    out = numpy.divide(figures - figures[1:].mean(axis=0), spread, out=numpy.zeros_like(figures),
                       where=spread > 1e-12)  # one grain has no deviation
    farthest = abs(out).max(axis=1)
    which = abs(out[0]).argmax()
    return which, out[0, which], find_part(farthest[0], farthest[1:])


def judge_sets(figures, values):
    """Over sets (rows of figures, and a value of each): the number of the figure that goes best with it, its
    correlation, and p."""
    def scale(x):
        x = x - numpy.mean(x, axis=0)
        return x / numpy.maximum(numpy.linalg.norm(x, axis=0), 1e-12)
    values, figures = scale(values), scale(figures)
    orders = numpy.random.default_rng(SEED).permuted(numpy.tile(values, (DRAWS, 1)), axis=1)
    found = values @ figures
    which = abs(found).argmax()
    return which, found[which], find_part(abs(found[which]), abs(orders @ figures).max(axis=1))


def list_sets(rows, draw, names):
    """Of each set of the rows: kinds, choice, its weights over the grains and the mean fraction of its beds. A choice
    is one set; of those drawn at random each run is one."""
    sets = {}
    for row in rows:
        kinds, choice, seed = (int(row[name]) for name in ("kinds", "choice", "seed"))
        sets.setdefault((kinds, choice, seed if choice < 1 else None), []).append(float(row["fraction"]))
    out = []
    for (kinds, choice, seed), fractions in sets.items():
        counts = dict(draw(kinds, choice, seed))
        weights = numpy.array([counts.get(name, 0) for name in names], dtype=float)
        out.append((kinds, choice, weights / weights.sum(), numpy.mean(fractions)))
    return out


def make_table(sets, forms, labels):
    """labels: of the figures of a set."""
    if not sets:
        return "None was run yet."
    out = []
    for kinds, choice, weights, _ in sorted(sets, key=lambda of: of[:2]):
        if choice > 0:
            which, far, p = judge_set(weights, forms)
            out.append([library.name_grains(str(kinds), str(choice)), labels[which], f"{far:+.1f}", f"{p:.2f}"])
    far = tables.markdown(["kinds", "figure farthest out", "deviations", "p"], out)
    out = []
    for what, least in (("all", 0), ("without the one grain", 2)):
        these = [of for of in sets if of[0] == 0 or of[0] >= least]
        if len(these) > 2:  # two lie on any line
            figures = find_figures(numpy.array([of[2] for of in these]), forms)
            which, correlation, p = judge_sets(figures, [of[3] for of in these])
            out.append([what, str(len(these)), labels[which], f"{correlation:+.2f}", f"{p:.2f}"])
    return far + "\n\n" + tables.markdown(["sets", "number", "figure that goes best with the fraction", "correlation",
                                           "p"], out)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("grains", help="folder of meshes")
    parser.add_argument("--work", default="library", help="folder of the clumps (library)")
    asked = parser.parse_args()
    os.makedirs(asked.work, exist_ok=True)
    names, clumps = library.make_clumps(asked.grains, asked.work), os.path.join(asked.work, "clumps")
    grains = {row["file"]: row for row in tables.read(os.path.join(clumps, "grains.csv"))}
    found = [measure_form(grains[name], read_rows(os.path.join(clumps, name))) for name in names]
    sets = list_sets(tables.read_if_there(library.TABLE), lambda *of: library.draw(names, asked.work, *of), names)
    labels = [f"{what} of {figure}" for what in ("mean", "spread") for figure in found[0]]
    tables.fill(os.path.join(library.HERE, "..", "behaviour.md"),
                {"library-forms": make_table(sets, numpy.array([list(form.values()) for form in found]), labels)})


if __name__ == "__main__":
    main()
