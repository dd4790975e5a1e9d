#!/usr/bin/env python3
"""What docs/experiments/soundness.py makes of runs whose effects were planted, beside closed forms and all cases
counted.

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


if __name__ == "__main__":
    unittest.main()
