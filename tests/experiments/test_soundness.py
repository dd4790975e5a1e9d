#!/usr/bin/env python3
"""What docs/experiments/soundness.py and library_forms.py make of runs whose effects were planted, beside closed forms
and all cases counted.

    /usr/bin/python3 tests/experiments/test_soundness.py [-v]
"""
import itertools
import math
import os
import statistics
import sys
import unittest

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "experiments"))
import contrasts_tables as tables  # noqa: E402
import intervals  # noqa: E402
import library_forms as forms  # noqa: E402
import soundness  # noqa: E402


def make_rows(values):
    """Rows of cells, in all that is measured; the k-th value of each has the k-th seed."""
    return [{"cell": cell, "seed": str(k), "step": tables.STEP, "rate": tables.RATE,
             **dict.fromkeys(tables.MEASURED, value)} for cell, of in values.items() for k, value in enumerate(of)]


class Groups(unittest.TestCase):
    def test_every_order_counted(self):
        """Two cells by three seeds have 36 orders."""
        values, cells, seeds = [1.0, 2.0, 4.0, 10.0, 13.0, 12.0], [0, 0, 0, 1, 1, 1], [0, 1, 2] * 2

        def square(these):
            less = [x - statistics.mean(these[3 * cell:3 * cell + 3]) for x, cell in zip(these, cells)]
            return sum((less[k] + less[k + 3]) ** 2 for k in range(3))
        squares = [square([*one, *other]) for one in itertools.permutations(values[:3])
                   for other in itertools.permutations(values[3:])]
        part = sum(x >= square(values) - 1e-9 for x in squares) / len(squares)
        self.assertTrue(0.1 < part < 0.9, part)
        self.assertAlmostEqual(soundness.judge_groups(values, seeds, cells), part, delta=0.02)

    def test_groups_of_several_sizes(self):
        """Of one, two and three values there are 720 orders; the square of a sum counts by the size."""
        values = [5.0, 1.0, 2.5, -1.0, -3.0, -4.5]  # the mean is nil

        def square(these):
            return these[0] ** 2 + sum(these[1:3]) ** 2 / 2 + sum(these[3:]) ** 2 / 3
        squares = [square(these) for these in itertools.permutations(values)]
        part = sum(x >= square(values) - 1e-9 for x in squares) / len(squares)
        self.assertAlmostEqual(soundness.judge_groups(values, [0, 1, 1, 2, 2, 2], [""] * 6), part, delta=0.005)

    def test_a_seed_that_is_planted(self):
        """Cells of unequal means and sizes, with a part of each seed and without: small, and in any order not."""
        noise = numpy.random.default_rng(5).normal(size=30)
        cells, seeds = [k // 6 for k in range(30)], [k % 6 for k in range(30)]
        values = [10 * cell + x for cell, x in zip(cells, noise)]
        self.assertGreater(soundness.judge_groups(values[2:], seeds[2:], cells[2:]), 0.1)
        values = [x + 2 * (seed == 3) - 2 * (seed == 4) for x, seed in zip(values, seeds)]
        self.assertLess(soundness.judge_groups(values[2:], seeds[2:], cells[2:]), 0.01)
        self.assertLess(soundness.judge_groups(values[2:], cells[2:], [""] * 28), 0.001)

    def test_no_more_often_than_it_says(self):
        """Of tables without any effect a fifth have p of at most a fifth."""
        random, cells, seeds = numpy.random.default_rng(7), [0, 0, 1, 1, 1, 2, 2, 2], [0, 1, 0, 1, 2, 0, 1, 2]
        found = [soundness.judge_groups(random.exponential(size=8), seeds, cells) for _ in range(300)]
        self.assertAlmostEqual(sum(p <= 0.2 for p in found) / 300, 0.2, delta=0.07)


class Variances(unittest.TestCase):
    def test_two_cells_in_closed_form(self):
        """Of two cells of three the ratio x of variances is F by 2 and 2: beyond x or 1/x lies 2 / (1 + x)."""
        for ratio in (1.5, 9.0, 100.0):
            cells = [[-1.0, 0.0, 1.0], [5 - math.sqrt(ratio), 5.0, 5 + math.sqrt(ratio)]]
            self.assertAlmostEqual(soundness.judge_variances(cells), 2 / (1 + ratio), delta=0.015)

    def test_cells_without_spread_and_of_one_run(self):
        self.assertEqual(soundness.judge_variances([[1.0, 1.0], [2.0, 3.0, 5.0], [7.0]]), 1 / (1 + soundness.DRAWS))
        self.assertEqual(soundness.judge_variances([[1.0], [2.0, 3.0, 5.0]]), 1)


class Chances(unittest.TestCase):
    def test_against_simulation(self):
        """Two cells that are alike, their spread by 52 degrees of freedom from other draws."""
        random, each = numpy.random.default_rng(3), 6
        means = random.normal(size=(2, 40000, each)).mean(axis=2)
        spread = numpy.sqrt(random.chisquare(52, 40000) / 52)
        for allowed in (1.0, 1.2, 1.5, 2.0):
            half = intervals.quantile(52) * spread * math.sqrt(2 / each)
            found = numpy.mean(abs(means[0] - means[1]) + half <= allowed)
            self.assertAlmostEqual(soundness.find_chance(1.0, 52, allowed, each), found, delta=0.05)
        self.assertEqual(soundness.find_chance(1.0, 52, 0.9, each), 0)

    def test_runs_until_it_fits(self):
        """By half an interval of 1.6747 root(2/n): 13 runs are the first within 2/3."""
        self.assertEqual(soundness.count_runs(lambda n: soundness.find_half(1.0, 52, n) <= 2 / 3), "13")
        self.assertEqual(soundness.count_runs(lambda n: False), f"more than {soundness.MOST}")


class Tables(unittest.TestCase):
    def test_what_own_variances_change(self):
        """Pooled with a wide cell, a narrow one's interval reaches beyond the margin and by itself it does not; one of
        two runs has no variance to speak of."""
        narrow = [-0.01, 0.0, 0.01] * 2
        rows = make_rows({"smooth": [20 + x for x in narrow], "variational-2": [20.5 + x for x in narrow],
                          "variational-3": [30 + 100 * x for x in narrow], "variational-5": [20.5, 20.51]})
        self.assertEqual(dict(zip(tables.MEASURED, soundness.list_changes(rows, "smooth")))["start"], "variational-2")
        self.assertEqual(soundness.list_changes(rows, "variational-5"), ["too few runs"] * len(tables.MEASURED))
        rows = [row for row in rows if row["cell"] != "variational-3"]
        self.assertEqual(dict(zip(tables.MEASURED, soundness.list_changes(rows, "smooth")))["start"], "none")

    def test_few_runs_or_none(self):
        for values in ({}, {"variational-2": [1.0, 2.0]}, {"smooth": [1.0], "variational-2": [2.0]}):
            self.assertEqual(soundness.make_table(make_rows(values)), "None was run yet.")

    def test_whole(self):
        """The candy alone; a seed that moves all cells alike is found, and that its cells differ."""
        rows = make_rows({cell: [mean + seed + 0.1 * (seed * k % 5) for seed in range(6)]
                          for k, (cell, mean) in enumerate((("smooth", 20), ("variational-2", 70), ("sphere-0", 50)))})
        lines = [line.strip("| ").split(" | ") for line in soundness.make_table(rows).splitlines()[2:]]
        self.assertEqual([line[0].split(",")[0] for line in lines],
                         ["candy: same seed", "candy: variances", "candy: one mean", "half an interval over the margin",
                          "chance that like cells are found alike", "runs of each until half an interval is the margin",
                          "runs of each until that chance is 0.9",
                          "other verdicts against variational-2 by own variances",
                          "other verdicts against smooth by own variances"])
        self.assertEqual([lines[k][1] for k in (0, 2)], ["0.0001", "0.0001"])


class Forms(unittest.TestCase):
    def test_mean_and_spread_by_weights(self):
        """Of 2 and 6, of which there are three times as many: 5, and the root of 3."""
        found = forms.find_figures(numpy.array([[0.25, 0.75, 0], [0, 0, 1]]), numpy.array([[2.0], [6.0], [1e6]]))
        for got, expected in zip(found.ravel(), (5, math.sqrt(3), 1e6, 0)):
            self.assertAlmostEqual(got, expected, places=6)

    def test_spheres(self):
        """Two balls in touch: from 2 to 4 radii wide, 3 in the mean over all directions."""
        found = forms.measure_spheres([[0, 0, -0.2, 0.2], [0, 0, 0.2, 0.2]], 0.1)
        for name, expected in (("mean radius", 2), ("largest radius", 2), ("mean width", 6), ("least width", 4),
                               ("largest width", 8)):
            self.assertAlmostEqual(found[name], expected, delta=0.02, msg=name)

    def test_a_grain_of_another_size(self):
        """All figures are of form; one that is not there ends in a sentence."""
        row = {"file": "a", "equivalent_diameter": "4", "dice": "0.1", "smallest_radius_ratio": "0.2", "moment_1": "2",
               "moment_3": "5", "voxel_size": "0.5", "protrusion_rms": "0.4", "gap_rms": "0.8",
               **{f"{what}_{name}": "0.7" for what in ("shape", "clump") for name in forms.OF_SHAPE}}
        found = forms.measure_form(row, [[0, 0, 0, 0.002]])
        self.assertAlmostEqual(found["protrusion"], 0.1)
        larger = forms.measure_form({**row, "equivalent_diameter": "8", "voxel_size": "1", "moment_1": "64",
                                     "moment_3": "160"}, [[0, 0, 0, 0.004]])
        for name in found:
            self.assertAlmostEqual(found[name], larger[name], msg=name)
        with self.assertRaisesRegex(SystemExit, "^a: grains.csv has no dice of it"):
            forms.measure_form({**row, "dice": ""}, [[0, 0, 0, 0.002]])

    def test_a_set_that_lies_apart(self):
        """Of 40 grains the five with the largest second figure, and every eighth; one grain has no spread."""
        figures = numpy.random.default_rng(2).normal(size=(40, 3))
        figures[:, 1] = numpy.arange(40)
        for grains, far in ((range(35, 40), True), (range(3, 40, 8), False)):
            weights = numpy.zeros(40)
            weights[list(grains)] = 1 / 5
            which, out, p = forms.judge_set(weights, figures)
            self.assertEqual((p < 0.01, which == 1 and out > 2), (far, far), (which, out, p))
        which, out, p = forms.judge_set(numpy.eye(40)[39], figures)
        self.assertLess(which, 3)  # a mean

    def test_a_figure_that_goes_with_the_fraction(self):
        random = numpy.random.default_rng(4)
        figures, values = random.normal(size=(12, 10)), random.normal(size=12)
        self.assertGreater(forms.judge_sets(figures, values)[2], 0.05)
        figures[:, 6] = 3 - 2 * values + 0.1 * random.normal(size=12)
        which, correlation, p = forms.judge_sets(figures, values)
        self.assertEqual((which, correlation < -0.9, p < 0.01), (6, True, True))

    def test_sets(self):
        """A choice is one set, with the mean of its runs, and each run of those drawn."""
        rows = [{"kinds": kinds, "choice": choice, "seed": seed, "fraction": fraction} for kinds, choice, seed, fraction
                in (("2", "1", "7", "0.5"), ("2", "1", "8", "0.7"), ("2", "-1", "7", "0.4"), ("2", "-1", "8", "0.3"))]
        counts = {(2, 1, None): [("a", 50), ("c", 200)], (2, -1, 7): [("a", 125), ("b", 125)], (2, -1, 8): [("b", 250)]}
        sets = forms.list_sets(rows, lambda *of: counts[of], ["a", "b", "c"])
        self.assertEqual([(kinds, choice, weights.tolist()) for kinds, choice, weights, _ in sets],
                         [(2, 1, [0.2, 0, 0.8]), (2, -1, [0.5, 0.5, 0]), (2, -1, [0, 1, 0])])
        for got, expected in zip(sets, (0.6, 0.4, 0.3)):
            self.assertAlmostEqual(got[3], expected)

    def test_table(self):
        self.assertEqual(forms.make_table([], numpy.zeros((0, 1)), []), "None was run yet.")
        sets = [(2, 1, numpy.array([0.5, 0.5, 0]), 0.6), (0, 0, numpy.array([1, 1, 1]) / 3, 0.5)]
        table = forms.make_table(sets, numpy.array([[1.0], [2.0], [4.0]]), ["mean of x", "spread of x"])
        far, best = table.split("\n\n")
        self.assertTrue(far.splitlines()[2].startswith("| 2 | "), far)
        self.assertEqual((len(far.splitlines()), len(best.splitlines())), (3, 2))  # two sets lie on any line


if __name__ == "__main__":
    unittest.main()
