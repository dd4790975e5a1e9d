#!/usr/bin/env python3
"""What docs/experiments/contrasts.py makes of its runs: beds of known height and fraction, series of velocities made up
here, intervals by hand, and a table that is gone on with. The engine is a stand-in that notes how often it was called.

    /usr/bin/python3 tests/experiments/test_contrasts.py [-v]
"""
import contextlib
import csv
import io
import math
import os
import shutil
import stat
import sys
import tempfile
import unittest
from unittest import mock

import numpy

for name in ("GRAIN", "LIGGGHTS", "LIGGGHTS_SMOOTH"):  # with what whoever runs this has set, engines would run
    os.environ.pop(name, None)
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "experiments"))
import bed  # noqa: E402
import contrasts  # noqa: E402
import contrasts_cells as cells  # noqa: E402
import contrasts_chart as chart  # noqa: E402
import contrasts_tables as tables  # noqa: E402
import intervals  # noqa: E402
import packing  # noqa: E402
import program  # noqa: E402
import soundness  # noqa: E402
from tables import add_row  # noqa: E402


def balls(spheres):
    return [bed.ball(*sphere) for sphere in spheres]


class Beds(unittest.TestCase):
    def test_layers_across_the_borders(self):
        """Balls of radius 5 mm on a square lattice of 10 mm, those at the border cut by it. Lines end on the upper half
        of a ball, pi/6 of its radius high in the mean over its square, or pass between, as 1 - pi/4 of them do."""
        layers, ticks = 12, numpy.arange(6) * 10.0
        spheres = numpy.array([[x, y, 5 + 10 * k, 5] for k in range(layers) for x in ticks for y in ticks])
        height, fraction = bed.measure(balls(spheres))
        expected = math.pi / 4 * (10 * layers - 5) + math.pi / 6 * 5
        self.assertAlmostEqual(height, expected, delta=0.01 * expected)
        low, high = height / 4, 3 * height / 4
        part = sum(self.slab(low - 5 - 10 * k, high - 5 - 10 * k) for k in range(layers)) / (10 * 10 * (high - low))
        self.assertAlmostEqual(fraction, part, delta=0.01 * part)

    @staticmethod
    def slab(low, high, r=5.0):
        """Volume of a ball between two planes."""
        low, high = max(-r, min(r, low)), max(-r, min(r, high))
        return math.pi * (r * r * (high - low) - (high ** 3 - low ** 3) / 3)

    def test_wherever_the_box_begins(self):
        """A bed that is shifted by whole voxels is the same bed."""
        spheres = numpy.array([[3.0, 58.0, 9.0, 6.0], [30.0, 1.0, 20.0, 7.0], [59.5, 30.0, 31.0, 5.0]])
        shifted = spheres + [17.5, 44.0, 0, 0]
        shifted[:, :2] %= 60
        for one, other in zip(bed.measure(balls(spheres)), bed.measure(balls(shifted))):
            self.assertAlmostEqual(one, other, places=12)

    def test_an_ellipsoid_that_is_turned(self):
        """A quarter turn about y lays the short axis along x; any turn leaves the volume and a ball as they are."""
        half, lines = math.sqrt(0.5), numpy.arange(-7, 7, 0.1) + 0.05
        _, _, _, reach, chords = bed.ellipsoid(30, 30, 30, (6, 6, 3), (half, 0, half, 0))
        self.assertEqual(reach, 6)
        low, high = chords(numpy.array([0.0, 2.9, 3.1, 0.0]), numpy.array([0.0, 0.0, 0.0, 5.9]))
        for got, expected in zip(high, (6, 6 * math.sqrt(1 - (2.9 / 3) ** 2), math.nan, math.sqrt(36 - 5.9 ** 2))):
            self.assertTrue(abs(got - expected) < 1e-12 or math.isnan(got) and math.isnan(expected), (got, expected))
        turned = numpy.array([0.3, 0.5, -0.2, 0.7]) / math.sqrt(0.87)
        low, high = bed.ellipsoid(0, 0, 0, (6, 5, 3), turned)[4](lines[:, None], lines[None, :])
        self.assertAlmostEqual(numpy.nansum(high - low) * 0.01, 4 / 3 * math.pi * 6 * 5 * 3, delta=0.5)
        # Across, from the matrix of the turn: the furthest point along z is the root of the sum of (axis times R3k)^2.
        w, x, y, z = turned
        third = numpy.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
        self.assertAlmostEqual(numpy.nanmax(high), numpy.linalg.norm(third * [6, 5, 3]), delta=0.01)
        ball, same = balls([[30, 30, 20, 5]]), [bed.ellipsoid(30, 30, 20, (5, 5, 5), turned)]
        for one, other in zip(bed.measure(ball), bed.measure(same)):
            self.assertAlmostEqual(one, other, places=12)


class Angles(unittest.TestCase):
    def test_where_it_starts_to_flow_for_good(self):
        """What moves and comes to rest again before is no start."""
        rise = [(20.0, 0.0), (21.0, 0.03), (22.0, 0.005), (23.0, 0.011), (24.0, 0.02), (25.0, 0.06)]
        fall = [(24.0, 0.08), (23.0, 0.04), (22.0, 0.009), (21.0, 0.001)]
        self.assertEqual(bed.find_angles(rise, fall), (23.0, 22.0))

    def test_it_moved_from_the_first(self):
        self.assertEqual(bed.find_angles([(1.0, 0.02), (2.0, 0.06)], [(1.0, 0.001)]), (1.0, 1.0))

    def test_no_flow_or_no_rest(self):
        for rise, fall in (([(20.0, 0.04)], [(19.0, 0.001)]), ([(20.0, 0.06)], [(19.0, 0.009)]), ([(20.0, 0.06)], []),
                           ([], [])):
            self.assertEqual(bed.find_angles(rise, fall), (None, None))


class Intervals(unittest.TestCase):
    def test_quantiles(self):
        """Of Student's distribution, tables of any textbook."""
        for freedom, expected in ((1, 6.3138), (2, 2.9200), (5, 2.0150), (10, 1.8125), (30, 1.6973), (1000, 1.6464)):
            self.assertAlmostEqual(intervals.quantile(freedom), expected, delta=1e-3)
        self.assertAlmostEqual(intervals.quantile(3), 2.3534, delta=0.004 * 2.3534)

        self.assertAlmostEqual(intervals.quantile(20, 0.995), 2.8453, delta=1e-3)
        self.assertAlmostEqual(intervals.quantile(30, 0.999), 3.3852, delta=1e-3)

    def test_each_with_its_own_variance(self):
        """Welch, of four values with a variance of 2/3 and four with one of 16."""
        difference, half = intervals.interval_by_own([-1.0, 0.0, 0.0, 1.0], [math.sqrt(24) * x for x in (-1, 0, 0, 1)])
        self.assertAlmostEqual(difference, 0)
        one, other = 2 / 3 / 4, 16 / 4
        freedom = (one + other) ** 2 / (one ** 2 / 3 + other ** 2 / 3)
        self.assertAlmostEqual(half, intervals.quantile(freedom) * math.sqrt(one + other))

    def test_all_at_once(self):
        """Of one interval nothing changes; of 28 each has 99.82 % below its upper end."""
        one, all_of = (intervals.interval([1.0, 3.0], [2.0], 1.0, 52, count)[1] for count in (1, 28))
        self.assertAlmostEqual(one, intervals.interval([1.0, 3.0], [2.0], 1.0, 52)[1])
        self.assertAlmostEqual(all_of / one, 3.0506 / 1.6747, delta=2e-3)

    def test_pooled(self):
        deviation, freedom = intervals.pool([[1.0, 3.0], [10.0, 12.0, 14.0], [7.0]])
        self.assertEqual(freedom, 3)
        self.assertAlmostEqual(deviation, math.sqrt((2 + 8) / 3))
        difference, half = intervals.interval([1.0, 3.0], [10.0, 12.0, 14.0], deviation, 10)
        self.assertAlmostEqual(difference, -10)
        self.assertAlmostEqual(half, intervals.quantile(10) * deviation * math.sqrt(1 / 2 + 1 / 3))

    def test_one_run_has_no_interval(self):
        deviation, freedom = intervals.pool([[1.0], [2.0]])
        difference, half = intervals.interval([1.0], [2.0], deviation, freedom)
        self.assertEqual(difference, -1)
        self.assertTrue(math.isnan(half))
        self.assertFalse(tables.is_equivalent(difference, half, 5))
        self.assertFalse(tables.is_different(difference, half, 0.5))

    def test_the_whole_interval_within_the_margin(self):
        self.assertTrue(tables.is_equivalent(-0.5, 0.4, 1))
        self.assertFalse(tables.is_equivalent(0.1, 1.0, 1))
        self.assertFalse(tables.is_equivalent(-1.2, 0.1, 1))
        self.assertTrue(tables.is_different(-1.2, 0.1, 1))
        self.assertFalse(tables.is_different(-1.2, 0.3, 1))

    def test_enough_only_if_so_at_every_larger_number(self):
        """Five spheres agree with the reference and twenty do not: ten, between them, agrees and is not enough."""
        series = tables.SERIES[:7]  # to sixty spheres
        means = dict(zip(series, (30.0, 25.0, 25.0, 20.0, 20.0, 25.0, 20.0)))
        rows = [{"cell": cell, "step": tables.STEP, "rate": tables.RATE, "start": mean + noise}
                for cell, mean in means.items() for noise in (-0.01, 0.01)]
        judged = tables.judge_series(rows, "start", series[-1])
        self.assertEqual([line[0] for line in judged], series[:-1])
        self.assertEqual([line[3] for line in judged], ["outside"] * 3 + ["within"] * 2 + ["outside"])
        for row in rows:
            row["start"] -= 5 * (row["cell"] == "variational-20")
        judged = tables.judge_series(rows, "start", series[-1])
        self.assertEqual([line[3] for line in judged], ["outside"] * 3 + ["enough"] * 3)
        smooth = [{**row, "cell": "smooth"} for row in rows if row["cell"] == "variational-60"]
        judged = tables.judge_series(rows + smooth, "start", "smooth")
        self.assertEqual([(line[0], line[3]) for line in judged[-4:]],
                         [(cell, "enough") for cell in series[-4:]])

    def test_a_predictor_that_holds_elsewhere_and_one_that_does_not(self):
        """The angle is 20 + 100 D, whatever the method; mean width goes with it in the series alone."""
        clumps = [{"cell": cell, "method": "any", "dice": dice, "mean_width": width} for cell, dice, width in (
            ("variational-2", 0.3, 1.3), ("variational-10", 0.1, 1.1), ("variational-60", 0, 1), ("euclid-20", 0.2, 1))]
        rows = [{"cell": clump["cell"], "step": tables.STEP, "rate": tables.RATE, "start": 20 + 100 * clump["dice"]}
                for clump in clumps]
        for predictor, inside, outside in (("dice", 0, 0), ("mean_width", 0, 20),
                                           ("", 100 * math.sqrt(0.14 / 9), 20 / 3)):
            errors = tables.judge_predictor(rows, clumps, "start", predictor)
            self.assertAlmostEqual(errors[0], inside)
            self.assertAlmostEqual(errors[1], outside)
            self.assertTrue(math.isnan(errors[2]) and math.isnan(errors[3]))
        rows += [{**rows[0], "cell": "smooth", "start": value} for value in (23, 25)]  # D nil: 20 of the line
        self.assertAlmostEqual(tables.judge_predictor(rows, clumps, "start", "dice")[2], 4)
        # The grain starts elsewhere, and by 70 degrees for 100 D: 30 D are missed.
        grains = [{"cell": f"grain-{n}", "method": "variational", "dice": dice}
                  for n, dice in ((2, 0.4), (5, 0.3), (60, 0))]
        rows += [{**rows[0], "cell": grain["cell"], "start": 9 + 70 * grain["dice"]} for grain in grains]
        self.assertAlmostEqual(tables.judge_predictor(rows, clumps + grains, "start", "dice")[3],
                               math.hypot(12, 9) / math.sqrt(2))
        self.assertAlmostEqual(tables.judge_predictor(rows, clumps + grains, "start", "")[3],
                               math.hypot(28, 21) / math.sqrt(2))
        self.assertAlmostEqual(tables.judge_predictor(rows, clumps + grains, "start", "dice")[1], 0)

    def test_controls_stand_beside_their_cells_and_each_other(self):
        few, many = cells.CONTROLLED
        listed = tables.list_controls()
        self.assertIn(("e0.2", few + "-e0.2", few), listed)
        self.assertIn(("as above", many, few), listed)
        self.assertIn(("undone", many + "-undone", few + "-undone"), listed)
        self.assertEqual(len(listed), len(cells.CONTROLS) + 1 + len(cells.CONTROLS) // 2)
        for _, one, other in listed:
            cells.find_cell(one), cells.find_cell(other)

    def test_a_friction_between_runs(self):
        """The candy starts at 20 and 24 by 0.35 and 0.5, and by 0.7 at 23: on the line between the nearest above and
        below."""
        rows = self.list_rows({"smooth": (19, 21), "smooth-f0.5": (24,), "smooth-f0.7": (23,), "variational-10": (22,),
                               "variational-2": (25,)})
        self.assertAlmostEqual(tables.find_friction(rows, "start", "variational-10"), 0.35 + 0.35 * 2 / 3)
        self.assertTrue(math.isnan(tables.find_friction(rows, "start", "variational-2")))
        self.assertTrue(math.isnan(tables.find_friction(rows[:2] + rows[-2:], "start", "variational-10")))

    def test_checks_are_no_part_of_the_means(self):
        rows = [{"cell": "setcover-10", "step": step, "rate": rate, "start": value}
                for step, rate, value in ((tables.STEP, tables.RATE, 1), (tables.STEP / 2, tables.RATE, 2),
                                          (tables.STEP, tables.RATE / 2, 3), (tables.STEP, tables.RATE, 4))]
        self.assertEqual(tables.take(rows, "start", "setcover-10"), [1, 4])

    def test_intervals_made_otherwise(self):
        """The early runs of two cells differ by 10 and the later by 1, or not at all; a third cell has early ones
        alone, and a fourth is so wide that all is within its interval."""
        noise = (0.0, 0.2, 0.1, 0.0, 0.2)
        rows = self.list_rows({"smooth": noise, "variational-2": (10.0, 10.2, 1.1, 1.0, 1.2),
                               "variational-3": (10.0, 10.2, *noise[2:]), "variational-10": (30.0, -30.0, *noise[2:])})
        for cell, expected in (("variational-2", "later"), ("variational-3", "none"), ("variational-10", "none")):
            self.assertEqual(tables.judge_otherwise(rows, "start", cell, "smooth", 4), expected)
        rows = self.list_rows({"smooth": noise, "variational-2": [9 + x for x in noise], "variational-5": (10.0, 10.2)})
        for cell, expected in (("variational-2", "all four"), ("variational-5", "rule, at once")):
            self.assertEqual(tables.judge_otherwise(rows, "start", cell, "smooth", 4), expected)

    @staticmethod
    def list_rows(values):
        return [{"cell": cell, "step": tables.STEP, "rate": tables.RATE, "start": value}
                for cell, of in values.items() for value in of]

    def test_against_the_candy_by_another_step(self):
        """Beside the experiment's, where the candy was run so, too: of a cell by another rate it was not."""
        ways = ((tables.STEP, tables.RATE), (tables.STEP / 2, tables.RATE), (tables.STEP, tables.RATE / 2))
        rows = [{"cell": cell, "step": step, "rate": rate, **dict.fromkeys(tables.MEASURED, value + noise)}
                for cell, value, runs in (("variational-5", 3.0, ways), ("smooth", 1.0, ways[:2]))
                for step, rate in runs for noise in (-0.01 * step / tables.STEP, 0.01)]
        lines = [line.strip("| ").split(" | ") for line in tables.table_steps(rows, "smooth").splitlines()[2:]]
        self.assertEqual([line[:4] for line in lines], [["variational-5 - smooth", f"{step:g}", "8", "2, 2"]
                                                        for step in (tables.STEP, tables.STEP / 2)])
        self.assertTrue(all(line[5].startswith("+2.00 +- ") for line in lines))


class Clumps(unittest.TestCase):
    def test_a_sphere_of_the_candy_s_volume(self):
        with tempfile.TemporaryDirectory() as folder:
            clump = cells.make(folder, "sphere-0.1")
            self.assertEqual((clump["members"], clump["rolling"]), (2, 0.1))
            (x, y, z, r), (*_, hidden) = cells.read_rows(os.path.join(folder, "sphere-0.1.liggghts"))
            self.assertEqual((x, y, z), (0, 0, 0))
            self.assertAlmostEqual(r ** 3, 6.585e-3 ** 2 * 3.395e-3, delta=1e-15)
            self.assertLess(hidden, 0.02 * r)
            words = clump["template"].split()
            mass, inertia = (float(words[words.index(word) + 1]) for word in ("mass", "inertia_tensor"))
            self.assertAlmostEqual(mass, 1377 * 4 / 3 * math.pi * r ** 3, delta=1e-12)
            self.assertAlmostEqual(inertia, 0.4 * mass * r * r, delta=1e-15)

    def test_the_law_that_undoes_contacts_side_by_side(self):
        said = {"factors": [{"against": "plane", "where": "random", "modulus": 3, "restitution": 0.9},
                            {"against": "particle", "where": "random", "modulus": 1.5, "restitution": 0.6}]}
        with mock.patch.object(cells, "ask_contact", lambda *words: said):
            self.assertEqual(cells.find_law("", "variational-3-undone"), {"young": 1.5 * packing.YOUNG, "e": 0.6})
        self.assertEqual(cells.find_law("", "variational-3-e0.2"), {"young": packing.YOUNG, "e": 0.2})
        self.assertEqual(cells.find_law("", "variational-3"), {"young": packing.YOUNG, "e": 0.5})

    def test_the_candy_itself(self):
        """As heavy as the clumps, and in the same bed but for what makes it a superquadric."""
        clump = cells.make("", "smooth")
        words = clump["template"].split()
        axes = [float(words[words.index("shape") + k]) for k in (2, 3, 4)]
        self.assertAlmostEqual(1377 * 4 / 3 * math.pi * axes[0] * axes[1] * axes[2], packing.MASS, delta=1e-12)
        smooth, spheres = (bed.make_script({**clump, "smooth": which}, 1, tables.STEP, tables.RATE).splitlines()
                           for which in (True, False))
        changed = [line for line in smooth if line not in spheres]
        self.assertIn("atom_style superquadric", changed)
        self.assertTrue(all("superquadric" in line or "shape" in line or "candies" in line or line.endswith(" ke")
                            for line in changed), changed)

    def test_friction_alone_differs(self):
        for name in cells.FRICTIONS:
            with tempfile.TemporaryDirectory() as folder, mock.patch.object(cells, "run_mskit", self.write_fake), \
                    mock.patch.object(cells, "find_candy", lambda folder: "candy.stl"):
                of = name[:name.rindex("-f")]
                here, there = (bed.make_script(cells.make(folder, cell), 1, tables.STEP, tables.RATE).replace(name, of)
                               .splitlines() for cell in (name, of))
            changed = [line for line in here if line not in there]
            self.assertEqual([line.split()[3:] for line in changed],
                             [["property/global", "coefficientFriction", "peratomtypepair", "2"] + [name[-3:]] * 4])

    def test_a_grain_in_the_candy_s_volume(self):
        """A mesh of the volume 1000 of its units is written in units that make it the candy's."""
        said = []

        def write(*words):
            said.append(words)
            self.write_fake(*words)
            return '{"volume": 1000}'
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(cells, "run_mskit", write), \
                mock.patch.object(cells, "GRAIN", "grain.stl"):
            cells.make(folder, "grain-5")
        (made,) = [words for words in said if words[0] == "generate"]
        self.assertEqual(made[1], "grain.stl")
        scale = float(made[made.index("--scale") + 1])
        self.assertAlmostEqual(1377 * 1000 * scale ** 3, packing.MASS, delta=1e-12)
        self.assertNotIn("--unit", made)

    def test_radii_alone_differ(self):
        """Places, mass and inertia of the small and the large clump are those of the one between."""
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(cells, "run_mskit", self.write_fake), \
                mock.patch.object(cells, "find_candy", lambda folder: "candy.stl"):
            lines, rows = {}, {}
            for name in ("variational-10", "variational-10-small", "variational-10-large"):
                lines[name] = cells.make(folder, name)["template"].replace(name, "")
                rows[name] = cells.read_rows(os.path.join(folder, name + ".liggghts"))
        self.assertEqual(len(set(lines.values())), 1)
        for name, factor in (("variational-10-small", 0.97), ("variational-10-large", 1.03)):
            for (*at, r), (*here, radius) in zip(rows["variational-10"], rows[name]):
                self.assertEqual(at, here)
                self.assertAlmostEqual(radius, factor * r, places=15)

    @staticmethod
    def write_fake(*words):
        """A clump of two spheres, for the generator's."""
        if words[0] == "generate":
            path = next(word for word in words if str(word).endswith(".liggghts"))
            with open(path, "w", encoding="ascii") as stream:
                stream.write("-0.001 0 0 0.004\n0.001 0 0 0.003\n")
            with open(path + ".in", "w", encoding="ascii") as stream:
                stream.write(f"# a drop\nfix clump all \"{os.path.basename(path)}\" mass 1\nfix kinds all\n")


ENGINE = """#!/bin/sh
echo called >> ../calls
cat > settled.dump <<end
ITEM: TIMESTEP
1000
ITEM: NUMBER OF ATOMS
{count}
ITEM: BOX BOUNDS pp pp ff
0 0.06
0 0.06
-0.01 0.55
ITEM: ATOMS id type x y z radius
{atoms}
end
cp settled.dump flowed.dump
echo "{said}"
"""
SAID = """at rest: 1e-20 J
    1000 564 1e-20 0
RISE 20 0.02
RISE 21 0.06
FALL 20 0.02
FALL 19 0.001
"""


class Tables(unittest.TestCase):
    def test_clumps_in_the_table_are_not_described_again(self):
        def describe(_, name, value=0):
            return {**dict.fromkeys(cells.COLUMNS, value), "cell": name}
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(cells, "describe", describe):
            path = os.path.join(folder, "clumps.csv")
            add_row(path, cells.COLUMNS, describe("", "variational-10", 1))
            for _ in range(2):
                cells.describe_all(folder, path)
            with open(path, newline="", encoding="utf-8") as stream:
                rows = [(row["cell"], row["dice"]) for row in csv.DictReader(stream)]
        others = [(name, "0") for name in cells.CELLS 
                  if name != "variational-10" and cells.CELLS[name].method != "smooth"]
        self.assertEqual(rows, [("variational-10", "1")] + others)


class Rows(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = os.path.join(folder.name, "runs.csv")

    def write(self, text):
        with open(self.path, "w", encoding="ascii") as stream:
            stream.write(text)

    def test_a_row_after_an_empty_file_has_a_head(self):
        self.write("")
        add_row(self.path, ["cell", "seed"], {"cell": "sphere-0", "seed": 7})
        self.assertEqual(tables.tables.read_if_there(self.path), [{"cell": "sphere-0", "seed": "7"}])

    def test_a_line_cut_short_is_no_run(self):
        self.write("cell,start\nsphere-0,24")
        with self.assertRaisesRegex(SystemExit, "runs.csv: the last line has no end"):
            tables.tables.read_if_there(self.path)

    def test_columns_and_values_that_lack(self):
        for text, sentence in (("cell,sead\nsphere-0,7\n", "runs.csv: the head has no column seed"),
                               ("cell,seed\nsphere-0,7\nsphere-0\n", "runs.csv: row 2 has not as many values"),
                               ("cell,seed\nsphere-0,7,8\n", "runs.csv: row 1 has not as many values")):
            self.write(text)
            with self.assertRaisesRegex(SystemExit, sentence):
                tables.tables.read_if_there(self.path, ["cell", "seed"])

    def test_a_run_that_is_repeated_changes_no_order(self):
        lines = [f"{cell},{seed},4e-05,8.0\n" for seed in contrasts.SEEDS[:3] for cell in ("sphere-0", "variational-2")]
        for at in range(len(lines)):
            self.write("cell,seed,step,rate\n" + "".join(lines[:at] + lines[at + 1:] + lines[at:at + 1]))
            found = [f"{','.join(row.values())}\n" for row in tables.read_runs(self.path)]
            self.assertEqual(found, lines, at)

    def test_tables_of_no_run_and_of_each_alone(self):
        known = tables.read_runs()
        for rows in [[], *([row] for row in known)]:
            parts = {}
            with mock.patch.object(tables, "read_runs", lambda these=rows: these), \
                    mock.patch.object(soundness, "read_runs", lambda these=rows: these), \
                    mock.patch.object(tables.tables, "fill", lambda _, these, into=parts: into.update(these)):
                tables.fill()
                soundness.fill()
            self.assertEqual(parts["bed-predictors"], "Too few cells were run yet.")
            self.assertEqual(parts["bed-soundness"], "None was run yet.")


class Chart(unittest.TestCase):
    def setUp(self):
        self.rows = [{"cell": cell, "step": tables.STEP, "rate": tables.RATE, "fraction": k / 100, "start": 20 + k}
                     for cell in ("variational-2", "variational-10", "euclid-20") for k in (0, 2)]

    def test_points_and_bars(self):
        half = intervals.quantile(3) * math.sqrt(2) / math.sqrt(2)
        self.assertEqual(chart.collect(self.rows, "start"),
                         {"variational": [(2, 21, half), (10, 21, half)], "euclid": [(20, 21, half)]})

    @unittest.skipUnless(shutil.which("gnuplot"), "gnuplot is not installed (package gnuplot-nox)")
    def test_drawn(self):
        self.rows = [{**self.rows[0], "cell": cell, "fraction": k / 100} for cell in cells.CELLS for k in (0, 2)]
        with tempfile.TemporaryDirectory() as folder:
            with mock.patch.object(chart, "CHART", os.path.join(folder, "beds.svg")):
                chart.draw(self.rows)
            with open(os.path.join(folder, "beds.svg"), encoding="utf-8") as stream:
                drawn = stream.read()
        for text in ("packing fraction", "start angle, degrees", *map(chart.find_group, cells.CELLS)):
            self.assertIn(text, drawn)


class Resumption(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.table = os.path.join(self.folder, "contrasts.csv")
        self.write_engine(SAID)
        mskit = self.write("mskit", "#!/bin/sh\necho mskit 0\n")
        for target, name, value in ((contrasts, "TABLE", self.table), (program, "MSKIT", mskit),
                                    (bed, "LIGGGHTS", os.path.join(self.folder, "engine")),
                                    (tables, "fill", lambda: None), (soundness, "fill", lambda: None),
                                    (chart, "draw", lambda rows: None),
                                    (cells, "describe_all", lambda folder, path: None)):
            patch = mock.patch.object(target, name, value)
            patch.start()
            self.addCleanup(patch.stop)

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="ascii") as stream:
            stream.write(text)
        os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR)
        return path

    def write_engine(self, said, count=bed.COUNT):
        atoms = [f"{k} 1 {0.005 * (k % 12)} {0.005 * (k // 12 % 12)} {0.01 + 0.005 * (k // 144)} 0.003"
                 for k in range(2 * count)]
        self.write("engine", ENGINE.format(atoms="\n".join(atoms), count=len(atoms), said=said))

    def call(self, *words):
        with mock.patch.object(sys, "argv", ["contrasts.py", "--work", os.path.join(self.folder, "work"), *words]), \
                contextlib.redirect_stdout(io.StringIO()):
            contrasts.main()

    def calls(self):
        path = os.path.join(self.folder, "work", "calls")
        if not os.path.exists(path):
            return 0
        with open(path, encoding="ascii") as stream:
            return len(stream.readlines())

    def rows(self):
        with open(self.table, newline="", encoding="utf-8") as stream:
            return list(csv.DictReader(stream))

    def test_rows_that_are_there_are_not_run_again(self):
        self.call("--cells", "sphere-0", "--seeds", "2")
        self.assertEqual(self.calls(), 2)
        self.assertEqual([(r["start"], r["stop"], r["seconds"]) for r in self.rows()], [("20.0", "19.0", "0.04")] * 2)
        self.call("--cells", "sphere-0,sphere-0.1", "--seeds", "2")
        self.assertEqual(self.calls(), 4)
        self.call("--cells", "sphere-0", "--seeds", "2", "--rate", "2")
        self.assertEqual(self.calls(), 6)
        self.assertEqual(len({(r["cell"], r["seed"], r["rate"]) for r in self.rows()}), 6)

    def test_no_larger_clumps_than_asked_for(self):
        self.call("--cells", "sphere-0,variational-2", "--seeds", "1", "--largest", "1")
        self.assertEqual([row["cell"] for row in self.rows()], ["sphere-0"])

    def test_no_time_left(self):
        self.call("--cells", "sphere-0", "--most", "-1")
        self.assertEqual(self.calls(), 0)

    def test_what_is_not_there_is_named(self):
        for words, sentence in ((("--cells", "cube-7"), "there is no cell 'cube-7'; choose from sphere-0"),
                                (("--cells", "smooth"), "LIGGGHTS_SMOOTH names no engine")):
            with self.assertRaisesRegex(SystemExit, sentence):
                self.call(*words)
        with mock.patch.object(bed, "LIGGGHTS", os.path.join(self.folder, "none")), \
                self.assertRaisesRegex(SystemExit, "none: No such file or directory; LIGGGHTS names the engine"):
            self.call("--cells", "sphere-0")
        with mock.patch.object(program, "MSKIT", os.path.join(self.folder, "none")), \
                self.assertRaisesRegex(SystemExit, "none: No such file or directory; build the program"):
            self.call("--cells", "variational-2")
        with mock.patch.object(program, "MSKIT", os.path.join(self.folder, "none")), \
                self.assertRaisesRegex(SystemExit, "none: No such file or directory; build the program"):
            self.call("--cells", "sphere-0")
        self.assertEqual(self.calls(), 0)

    def test_numbers_that_are_none(self):
        for words, sentence in ((("--seeds", "-1"), "'-1' is not a whole number from 0 on"),
                                (("--seeds", "999"), "there are 20 seeds, 999 are asked for"),
                                (("--step", "0"), "'0' is not a number above 0"),
                                (("--rate", "nan"), "'nan' is not a number above 0")):
            said = io.StringIO()
            with contextlib.redirect_stderr(said), self.assertRaises(SystemExit):
                self.call("--cells", "sphere-0", *words)
            self.assertIn(sentence, said.getvalue())

    def test_the_program_s_own_sentence(self):
        self.write("mskit", "#!/bin/sh\necho 'mskit generate: no such shape' >&2\nexit 1\n")
        with self.assertRaisesRegex(SystemExit, "^mskit generate: no such shape$"):
            self.call("--cells", "variational-2")

    def test_a_run_that_failed_is_no_row(self):
        for said, count, word in ((SAID.replace("at rest: 1e-20 J", ""), bed.COUNT, "no rest"),
                                  (SAID.replace("1e-20 J", "1 J"), bed.COUNT, "no rest"),
                                  (SAID, bed.COUNT - 1, "settled.dump: 498 are not those of 250"),
                                  (SAID.replace("0.06", "0.04"), bed.COUNT, "did not flow")):
            self.write_engine(said, count)
            with self.assertRaisesRegex(SystemExit, word):
                self.call("--cells", "sphere-0")
            self.assertFalse(os.path.exists(self.table))


if __name__ == "__main__":
    unittest.main()
