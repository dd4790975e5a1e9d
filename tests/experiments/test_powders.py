#!/usr/bin/env python3
"""What docs/experiments/library.py, drum.py and packing.py make of their runs: shares, templates, contacts, surfaces
known before, and differences by hand.

    /usr/bin/python3 tests/experiments/test_powders.py [-v]
"""
import math
import os
import sys
import tempfile
import unittest

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "experiments"))
import bed  # noqa: E402
import contrasts_cells as cells  # noqa: E402
import drum  # noqa: E402
import intervals  # noqa: E402
import library  # noqa: E402
import packing  # noqa: E402


class Shares(unittest.TestCase):
    def test_by_largest_remainders(self):
        self.assertEqual(library.share_out([("a", 0.2), ("b", 0.3), ("c", 0.5)]), [("a", 50), ("b", 75), ("c", 125)])
        self.assertEqual(library.share_out([("a", 1), ("b", 1), ("c", 1)]), [("a", 84), ("b", 83), ("c", 83)])
        self.assertEqual(library.share_out([("a", 999), ("b", 1)]), [("a", 250)])

    def test_of_the_powder_each_grain_once(self):
        names = [f"grain-{k}" for k in range(402)]
        one, other = (library.draw(names, "", 0, 0, seed) for seed in (1, 2))
        self.assertEqual({count for _, count in one}, {1})
        self.assertEqual(len({name for name, _ in one}), bed.COUNT)
        self.assertNotEqual(one, other)
        self.assertEqual(one, library.draw(names, "", 0, 0, 1))

    def test_kinds_drawn_at_random(self):
        names = [f"{k:04}" for k in range(402)]
        drawn = library.draw(names, "", 20, -1, 1)
        self.assertEqual((len({name for name, _ in drawn}), sum(count for _, count in drawn)), (20, bed.COUNT))
        self.assertEqual({count for _, count in drawn}, {12, 13})
        self.assertNotEqual(drawn, library.draw(names, "", 20, -1, 2))
        self.assertEqual([library.name_grains(*of) for of in (("0", "0"), ("5", "1"), ("5", "2"), ("5", "-1"))],
                         ["all", "5", "5, choice 2", "5, at random"])

    def test_each_choice_stands_alone(self):
        rows = [{"kinds": kinds, "choice": choice, **dict.fromkeys(library.MEASURED, value)}
                for kinds, choice, value in (("20", "2", 3), ("0", "0", 1), ("20", "1", 5), ("20", "2", 5),
                                             ("0", "0", 3))]
        table = [[cell.strip() for cell in line.split("|")[1:4]] for line in library.make_table(rows).splitlines()[2:]]
        self.assertEqual([line[:2] for line in table],
                         [["all", "2"], ["20", "1"], ["20, choice 2", "2"], ["spread within", "2"], ["20 - all", ""],
                          ["20, choice 2 - all", ""], ["all others - all", ""]])
        self.assertEqual([table[k][2].split(" ")[0] for k in (0, 1, 2, 4, 5, 6)],
                         ["2.0000", "5.0000", "4.0000", "+3.0000", "+2.0000", "+2.3333"])
        table = library.make_table(rows[:2]).splitlines()
        self.assertEqual([line.split(" | ")[0] for line in table[-2:]], ["| spread within", "| 20, choice 2 - all"])

    def test_a_set_is_one_value(self):
        """Runs of one choice are one set, and each run of those drawn: 4 and 6 against 1 and 3 are 3 apart."""
        rows = [{"kinds": "20", "choice": choice, "seed": seed, **dict.fromkeys(library.MEASURED, value)}
                for choice, seed, value in (("-1", "7", 4), ("-1", "8", 6), ("1", "7", 0), ("1", "8", 2),
                                             ("2", "7", 3))]
        (line,) = library.compare_sets(rows)
        self.assertEqual(line[:2], ["20, at random - chosen, by sets", "2, 2"])
        self.assertEqual(line[3], "+3.00 +- 4.13")  # two degrees of freedom, and a variance of 2 each
        self.assertEqual(library.compare_sets(rows[:4]), [])

    def test_primes(self):
        primes = library.list_primes(402)
        self.assertEqual((len(set(primes)), primes[:3]), (402, [1000003, 1000033, 1000037]))
        self.assertTrue(all(p % k for p in primes for k in range(2, math.isqrt(p) + 1)))


class Templates(unittest.TestCase):
    def test_scaled_to_the_candy(self):
        """Lengths by a factor, mass by its cube, moments by its fifth power; a grain's name is in no script."""
        mass, name = 8 * packing.MASS, "0000/a \"grain\" $x.liggghts"
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "clumps", name)
            os.makedirs(os.path.dirname(path))
            cells.write_rows(path, [[0.002, 0, -0.004, 0.006]] * library.SPHERES)
            with open(path + ".in", "w", encoding="ascii") as stream:
                stream.write("fix clump all particletemplate/multisphere 15485863 atom_type 1 nspheres 20 spheres file "
                             f"\"a mass 3 grain\" scale 1.0 type 1 mass {mass!r} inertia_tensor 32 0 0 64 0 96 "
                             "use_density\n")
            made = library.make_bed(folder, os.path.join(folder, "work"), [(name, 2)])
            rows = cells.read_rows(os.path.join(folder, "work", "1.spheres"))
        self.assertEqual(made["kinds"], "2 clump0 0.004 clump1 0.004")
        self.assertNotIn("grain", made["template"])
        for got, expected in zip(rows[0], (0.001, 0, -0.002, 0.003)):
            self.assertAlmostEqual(got, expected, places=15)
        lines = [line.split() for line in made["template"].splitlines()]
        for number, words in enumerate(lines):
            after = {word: words[words.index(word) + 1] for word in ("mass", "type", "file")}
            self.assertEqual((words[1], after["type"], after["file"]),
                             (f"clump{number}", str(number + 1), f'"{number}.spheres"'))
            self.assertAlmostEqual(float(after["mass"]), packing.MASS)
            tensor = words.index("inertia_tensor") + 1
            for got, expected in zip(words[tensor:tensor + 6], (1, 0, 0, 2, 0, 3)):
                self.assertAlmostEqual(float(got), expected)
        self.assertNotEqual(*(words[4] for words in lines))


class Contacts(unittest.TestCase):
    def test_pairs_across_the_border_and_the_floor(self):
        """All particles are far apart but two, which touch across the border, by all of their spheres, and lie on the
        foot of the floor at its corner."""
        spheres = numpy.array([[30.0, 30.0, 100.0 * (k + 1), 1.0] for k in range(bed.COUNT)
                               for _ in range(library.SPHERES)])
        places = {0: (0.5, 0.0, 4.5), 1: (58.9, 0.0, 4.5), 2: (30.0, 40.0, 20.0)}
        for particle, place in places.items():
            spheres[particle * library.SPHERES:(particle + 1) * library.SPHERES, :3] = place
        # each of the two touches the foot and the other one
        self.assertAlmostEqual(library.count_contacts(spheres), 4 / bed.COUNT)


class Drum(unittest.TestCase):
    @staticmethod
    def measure(spheres):
        """Of those in mm."""
        return drum.measure(drum.list_bodies(spheres / 1000))

    def test_a_slope(self):
        """Spheres of one radius side by side on a line of 30 degrees, all along the drum and across its border."""
        slope = math.tan(math.radians(30))
        spheres = numpy.array([[x, slope * x, z, 3.0] for x in numpy.arange(-40, 40, 0.25)
                               for z in numpy.arange(1, drum.LENGTH, 2)])
        self.assertAlmostEqual(self.measure(spheres), 30, delta=0.1)
        spheres[:, 2] = (spheres[:, 2] + 17) % drum.LENGTH
        self.assertAlmostEqual(self.measure(spheres), 30, delta=0.1)

    def test_a_candy_as_spheres(self):
        """One that lies askew, as a superquadric and as the balls that fill it, both over a floor of small ones."""
        turn = numpy.array([0.8, 0.3, -0.4, 0.3])
        turn /= numpy.linalg.norm(turn)
        w, (i, j, k) = turn[0], turn[1:]
        cross = numpy.array([[0, -k, j], [k, 0, -i], [-j, i, 0]])
        rotation = numpy.eye(3) + 2 * w * cross + 2 * cross @ cross
        axes, at = numpy.array([9.0, 6.0, 3.0]), numpy.array([12.0, 4.0, 11.0])
        points = numpy.random.default_rng(1).normal(size=(20000, 3))
        points *= (axes - 0.2) / numpy.linalg.norm(points, axis=1)[:, None]
        balls = numpy.hstack([at + points @ rotation.T, numpy.full((len(points), 1), 0.2)])
        candy = [[*at / 1000, *axes / 1000, *turn]]
        floor = numpy.array([[x, -10.0, z, 3.0] for x in numpy.arange(-40, 40) for z in range(40)])
        both = drum.measure(drum.list_bodies(candy) + drum.list_bodies(floor / 1000))
        self.assertAlmostEqual(both, self.measure(numpy.vstack([balls, floor])), delta=0.1)
        self.assertGreater(both, self.measure(floor) + 1)

    def test_a_bare_line_is_no_angle(self):
        spheres = numpy.array([[x, 0.0, z, 3.0] for x in numpy.arange(0, 40, 0.25) for z in range(40)])
        self.assertTrue(math.isnan(self.measure(spheres)))
        self.assertEqual(drum.leave_out_bare([1.0] * 20 + [math.nan], "here"), ([1.0] * 20, 1))
        with self.assertRaisesRegex(SystemExit, "here: in 1 of 20 looks"):
            drum.leave_out_bare([1.0] * 19 + [math.nan], "here")

    def test_correlation_time(self):
        """Half a look where neighbours alternate; of a series that forgets by a half a look, 3/2 looks."""
        self.assertAlmostEqual(drum.find_correlation([1.0, -1.0] * 50), 0.5 * drum.LOOK)
        random, series = numpy.random.default_rng(1), [0.0]
        for _ in range(20000):
            series.append(0.5 * series[-1] + random.normal())
        self.assertAlmostEqual(drum.find_correlation(series), 1.5 * drum.LOOK, delta=0.1 * drum.LOOK)

    def test_table(self):
        """Blocks of two runs of one number beside those of the largest."""
        rows = [{"n": n, "dice": "0.1", "blocks": blocks, "correlation": "0.2", "cpu_seconds": "10"}
                for n, blocks in (("30", "35 37"), ("10", "33 35"), ("10", "32 34"))]
        table = drum.make_table(rows).splitlines()
        self.assertEqual(table[2].split(" | ")[2:3] + table[3].split(" | ")[2:3], ["2", "1"])
        self.assertTrue(table[2].startswith("| 10 |") and "-2.50 +-" in table[2], table[2])

    def test_the_candy_stands_last(self):
        rows = [{"n": n, "dice": dice, "blocks": blocks, "correlation": "0.2", "cpu_seconds": "10"}
                for n, dice, blocks in (("0", "0.0", "30 32"), ("30", "0.1", "35 37"), ("10", "0.25", "40 42"))]
        table = [line.strip("| ").split(" | ") for line in drum.make_table(rows).splitlines()]
        self.assertEqual(table[0][4:7], ["beside 30 spheres", "beside the candy", "over D"])
        self.assertEqual([line[0] for line in table[2:]], ["10", "30", "smooth"])
        self.assertEqual([line[6] for line in table[2:4]], ["40", "50"])
        self.assertEqual([line[5].split(" ")[0] for line in table[2:4]], ["+10.00", "+5.00"])
        sound = [line.strip("| ").split(" | ") for line in drum.table_soundness(rows).splitlines()]
        self.assertEqual([len(line) for line in sound[2:5]], [8] * 3)

    def test_a_look_by_blocks(self):
        """Of a series that forgets by 0.3 a look, by blocks of twelve; with so few it is off by some percent."""
        random, series = numpy.random.default_rng(1), [0.0]
        for _ in range(36000):
            series.append(0.3 * series[-1] + random.normal())
        blocks = numpy.mean(numpy.reshape(series[1:], (-1, 12)), axis=1)
        look = drum.find_look(numpy.std(blocks), drum.find_correlation(series))
        self.assertAlmostEqual(look, numpy.std(series), delta=0.06 * numpy.std(series))

    def test_runs_beside_their_blocks(self):
        """Runs of ten spheres are 1 apart, where blocks that differ by 1 let expect 0.16; those of thirty are alike."""
        block = [0.0, 1.0] * (drum.BLOCKS // 2)
        rows = [{"n": n, "correlation": "0.15", "blocks": " ".join(str(at + x) for x in block)}
                for n, at in (("10", 41), ("10", 42), ("30", 40), ("30", 40))]
        lines = [line.strip("| ").split(" | ") for line in drum.table_soundness(rows).splitlines()[2:]]
        self.assertEqual([line[:4] for line in lines[:2]],
                         [["10", "0.51", "0.71", "0.11"], ["30", "0.51", "0.00", "0.11"]])
        self.assertEqual(lines[0][4].split(" +- ")[0], "+1.50")
        self.assertEqual([line[5] for line in lines[:2]], ["1.03"] * 2)  # twice: a block is 8 times 0.15 s
        self.assertLess(float(lines[2][2]), 0.01)
        self.assertEqual(lines[2][1], "1.00")
        self.assertGreater(float(drum.table_soundness(rows[2:]).splitlines()[-1].split(" | ")[2]), 0.9)
        self.assertEqual(drum.table_soundness([]), "None was run yet.")
        self.assertEqual(drum.table_soundness(rows[:1]).splitlines()[2].split(" | ")[2], "")

    def test_looks(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "looks.dump")
            with open(path, "w", encoding="ascii") as stream:
                for k in range(2):
                    stream.write(f"ITEM: TIMESTEP\n{k}\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff pp\n0 1\n0 1\n"
                                 f"0 1\nITEM: ATOMS id type x y z radius\n1 1 0.00{k} 0 0 0.003\n")
            looks, last = list(packing.read_dumps(path)), packing.read_dump(path)
        self.assertEqual([look.tolist() for look in looks], [[[0, 0, 0, 0.003]], [[0.001, 0, 0, 0.003]]])
        self.assertEqual(last.tolist(), looks[1].tolist())


class Packings(unittest.TestCase):
    def test_differences(self):
        """A later clump of the first number, other numbers against the one before, and another step against packings of
        its own clump."""
        rows = [{"n": n, "step": step, "dice": dice, **dict.fromkeys(("height_envelope", "height_top", "fraction"), x)}
                for n, step, dice, x in (("10", "1e-05", "0.07", 1), ("10", "1e-05", "0.07", 3),
                                         ("10", "1e-05", "0.06", 4), ("10", "1e-05", "0.06", 6),
                                         ("60", "1e-05", "0.01", 9), ("10", "5e-06", "0.06", 4),
                                         ("265", "1e-05", "0.001", 7))]
        lines = [line.strip("| ").split(" | ")[:3] for line in packing.table_differences(rows).splitlines()[2:]]
        half = intervals.quantile(3) * math.sqrt(13 / 3 * (1 + 1 / 4))  # of 1, 3, 4 and 6
        self.assertEqual(lines, [["10 spheres, D 0.0600 - 0.0700", "2, 2", "+3.00 +- 4.13"],
                                 ["60 spheres, 1e-05 s - 10 spheres, 1e-05 s", "1, 4", f"+5.50 +- {half:.2f}"],
                                 ["10 spheres, 5e-06 s - 10 spheres, 1e-05 s", "1, 2", "-1.00 +- 10.94"],
                                 ["265 spheres, 1e-05 s - 60 spheres, 1e-05 s", "1, 1", "-2.00"]])
        self.assertEqual(packing.table_differences([]), "None was run yet.")
        alone = packing.table_differences([rows[3], {**rows[0], "n": "60", "height_envelope": 11}])
        self.assertIn("| 1, 1 | +5.00 |", alone)


if __name__ == "__main__":
    unittest.main()
