"""mskit score: clumps from any tool, judged against formulas and against an independent program."""
import json
import math
import os
import shutil
import subprocess
import unittest

from support import SHARED, TIMEOUT, Case, box_obj

GRID = ("--cells", "30")


class Score(Case):
    def setUp(self):
        super().setUp()
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))

    def score(self, clump, *args, target="box.obj"):
        return self.mskit("score", clump, "--target", target, "-j", "1", "--json", *(args or GRID)).json["scores"]


class Measures(Score):
    def check_normals(self, scores, centres, radius):
        """Inside the box, of balls apart: the face and the edge that are nearest, by their coordinates."""
        angles = {False: [], True: []}
        for centre in centres:
            for k in range(20000):
                z = 1 - (2 * k + 1) / 20000
                ring, turn = math.sqrt(1 - z * z), 2.399963229728653 * k
                normal = (ring * math.cos(turn), ring * math.sin(turn), z)
                at = [c + radius * n for c, n in zip(centre, normal)]
                away = [min(x, side - x) for x, side in zip(at, (3, 2, 1))]
                axis = away.index(min(away))
                outward = normal[axis] if at[axis] > (1.5, 1, 0.5)[axis] else -normal[axis]
                near = math.hypot(*sorted(away)[:2]) < radius
                angles[near].append(math.degrees(math.acos(max(-1, min(1, outward)))))
        self.assertAlmostEqual(scores["edge_part"], len(angles[True]) / 20000 / len(centres), delta=0.005)
        for found, names in ((angles[False], "normal_median normal_95"),
                             (angles[True], "edge_normal_median edge_normal_95")):
            found.sort()
            for name, part in zip(names.split(), (0.5, 0.95)):
                self.assertAlmostEqual(scores[name], found[int(part * len(found))], delta=1, msg=name)

    def test_two_balls_in_a_cuboid(self):
        """Balls of radius 0.5 that touch opposite faces, apart from one another."""
        self.write("c.csv", "x,y,z,r\n0.6,1,0.5,0.5\n2.4,1,0.5,0.5\n")
        scores = self.score("c.csv", "--cells", "100")
        covered = 2 * 4 / 3 * math.pi * 0.5**3
        # A ball of 50 voxels' radius has 31,416 voxels of surface, on each of which the half rule errs by less than
        # half a voxel to either side; together below 0.1 % of the ball.
        for name, truth in (("coverage", covered / 6), ("off_volume", covered / 6), ("eta", 1 - covered / 6),
                            ("dice", 1 - 2 * covered / (6 + covered)), ("volume", covered)):
            self.assert_close(scores[name], truth, 1e-3, name)
        self.assertEqual((scores["spheres"], scores["pieces"], scores["overshoot"]), (2, 2, 0))
        self.assertLessEqual(scores["protrusion_max"], 1e-12)
        self.assert_close(scores["smallest_radius_ratio"], 0.5 / (6 * 3 / (4 * math.pi)) ** (1 / 3), 1e-9, "radius")
        self.assert_close(scores["work"], 2 / scores["smallest_radius_ratio"], 1e-12, "work")
        self.check_normals(scores, [(0.6, 1, 0.5), (2.4, 1, 0.5)], 0.5)
        out = self.mskit("score", "c.csv", "--target", "box.obj", "-j", "1", "--cells", "100").out
        for label, median, most in (("error of the normals", "normal_median", "normal_95"),
                                    (f"  of {100 * scores['edge_part']:.1f} % near sharp edges", "edge_normal_median",
                                     "edge_normal_95")):
            self.assertIn(f"  {label:34} median {scores[median]:.2f}, 95 % {scores[most]:.2f} degrees\n", out)
        self.assertIn(f"  {'work, n r_eq / r_min':34} {scores['work']:.2f}\n", out)
        # The middle of a long edge is farthest from the spheres: sampled about every second voxel, so within 3 voxels.
        gap = math.dist((1.5, 0, 0), (0.6, 1, 0.5)) - 0.5
        self.assertTrue(gap - 0.03 < scores["gap_max"] <= gap, f"gap {scores['gap_max']}, edge {gap}")
        # Moments about x, y, z: each ball 2/5 m r^2, and m 0.9^2 more about y and z.
        own = 0.4 * covered * 0.25
        errors = [own / 2.5, (own + covered * 0.81) / 5, (own + covered * 0.81) / 6.5]
        for axis in range(3):
            self.assertAlmostEqual(scores["inertia_error"]["moments"][axis], errors[axis] - 1, delta=2e-3)
        weighted = sum(abs(e - 1) * m for e, m in zip(errors, (2.5, 5, 6.5))) / 14
        self.assertAlmostEqual(scores["inertia_error"]["weighted_mean"], weighted, delta=2e-3)
        self.assertAlmostEqual(scores["inertia_error"]["centroid"], 0, delta=1e-6)
        self.assertAlmostEqual(scores["inertia_error"]["axes_degrees"], 0, delta=1e-6)

    def test_ball_that_reaches_out(self):
        """Around the corner at the origin: an eighth inside; the farthest point sticks out by the radius."""
        self.write("c.csv", "0 0 0 0.8\n")
        scores = self.score("c.csv", "--cells", "60")
        volume = 4 / 3 * math.pi * 0.8**3
        self.assert_close(scores["coverage"], volume / 8 / 6, 5e-3, "coverage")
        self.assert_close(scores["overshoot"], volume * 7 / 8 / 6, 2e-3, "overshoot")
        # 1000 points on the sphere: the nearest one to the diagonal is within 0.1 radians of it.
        self.assertTrue(0.8 * 0.99 < scores["protrusion_max"] <= 0.8 + 1e-12, scores["protrusion_max"])

    def test_ball_apart_from_the_shape(self):
        self.write("c.csv", "8 1 0.5 0.5\n")
        scores = self.score("c.csv")
        self.assertEqual((scores["coverage"], scores["dice"]), (0, 1))
        self.assert_close(scores["overshoot"], 4 / 3 * math.pi * 0.125 / 6, 0.02, "overshoot")
        # The whole ball lies outside: from 4.5 to 5.5 from the face x = 3.
        self.assertTrue(5.4 < scores["protrusion_max"] <= 5.5 + 1e-12, scores["protrusion_max"])

    def test_a_ball_that_covers_no_voxel(self):
        """Has no inertia that could be compared: that is not an error of 0."""
        self.write("c.csv", "1.51 1.01 0.51 1e-6\n")
        scores = self.score("c.csv")
        self.assertEqual((scores["coverage"], scores["volume"], scores["inertia_error"]), (0, 0, None))
        self.assertIn("cover no voxel", self.mskit("score", "c.csv", "--target", "box.obj", *GRID).out)

    def test_table_says_what_json_says(self):
        self.write("c.csv", "0.6,1,0.5,0.5\n2.4,1,0.5,0.5\n")
        scores = self.score("c.csv")
        table = self.mskit("score", "c.csv", "--target", "box.obj", *GRID).out
        for label, value in (("eta, |S xor U| / |S|", f"{scores['eta']:.5f}"),
                             ("coverage", f"{scores['coverage']:.5f}"),
                             ("D, Dice mismatch", f"{scores['dice']:.5f}"), ("connected", "no, 2 pieces"),
                             ("overshoot", f"{scores['overshoot']:.5f}"), ("spheres", "2")):
            self.assertRegex(table, rf"(?m)^  {label.replace('|', '.')} +{value}$")

    def test_agrees_with_generate(self):
        name = self.shape("torus", "fineness=8")
        record = self.mskit("generate", name, *GRID, "-n", "12", "--json", "-o", "c.csv").json
        self.assertEqual(self.score("c.csv", target=name), record["scores"])

    def test_curve(self):
        name = self.shape("grain", "fineness=8")
        self.mskit("generate", name, *GRID, "-n", "12", "-o", "c.csv")
        curve, total = self.curve("c.csv", name, *GRID), self.score("c.csv", target=name)
        self.assertEqual([row["n"] for row in curve], list(range(1, 13)))
        for measure in ("eta", "dice", "coverage", "overshoot"):
            self.assert_close(curve[-1][measure], total[measure], 1e-7, f"last {measure}: 8 digits are printed")
        for earlier, later in zip(curve, curve[1:]):
            self.assertLessEqual(earlier["coverage"], later["coverage"])
            self.assertLessEqual(earlier["overshoot"], later["overshoot"])
        lines = self.read("c.csv").decode().splitlines(keepends=True)
        self.write("five.csv", "".join(lines[:6]))
        five = self.score("five.csv", target=name)
        for measure in ("eta", "dice", "coverage", "overshoot"):
            self.assert_close(curve[4][measure], five[measure], 1e-7, f"fifth {measure}")


class Files(Score):
    """Lists of spheres as other tools write them."""

    def test_other_tools(self):
        self.write("plain.csv", "x,y,z,r\n0.6,1,0.5,0.5\n2.4,1,0.5,0.45\n")
        truth = self.score("plain.csv")
        for name, text in (
            ("semicolons and more columns", "x;y;z;r;mass;id\r\n0.6;1;0.5;0.5;3.1;1\r\n2.4;1;0.5;0.45;2.9;2\r\n"),
            ("blanks", "0.6 1 0.5 0.5\n2.4 1 0.5 0.45"),
            ("tabs, comments, empty lines", "# spheres\n\n0.6\t1\t0.5\t0.5\n\n# more\n2.4\t1\t0.5\t0.45 # last\n\n"),
            ("a byte order mark", "\ufeffx,y,z,r\n0.6,1,0.5,0.5\n2.4,1,0.5,0.45\n"),
            ("exponents", "6e-1,+1.0,.5,5E-1\n24e-1,1,0.5,0.045e1\n"),
            ("a header in words", "centre x, centre y, centre z, radius [mm]\n0.6,1,0.5,0.5\n2.4,1,0.5,0.45\n"),
        ):
            with self.subTest(name):
                self.write("other.csv", text.encode())
                self.assertEqual(self.score("other.csv"), truth)

    def test_refused(self):
        for text, says in (
            ("", ("no spheres",)), ("x,y,z,r\n", ("no spheres",)), ("1,2,3\n", ("line 1", "4 numbers")),
            ("x,y,z,r\n1,1,1,1\n1,2,three,1\n", ("line 3", "three")), ("1,1,1,0\n", ("line 1", "radii above 0")),
            ("1,1,1,-1\n", ("radii above 0",)), ("1,1,nan,1\n", ("finite",)), ("1,1,1,inf\n", ("finite",)),
            ("x,y,z,r\nx,y,z,r\n1,1,1,1\n", ("line 2",)), ("1,1,1,1\n\x00", ("not a text file",)),
            ("0 0 0 1\n" * 65535, ("65534",)),
        ):
            with self.subTest(text=text[:40]):
                self.write("c.csv", text)
                self.assert_refused("score", "c.csv", "--target", "box.obj", *GRID, code=1, says=says)

    def test_a_folder_and_a_mesh_are_no_clumps(self):
        self.assert_refused("score", ".", "--target", "box.obj", code=1, says=("folder",))
        self.assert_refused("score", "missing.csv", "--target", "box.obj", code=1, says=("missing.csv", "No such file"))
        name = self.shape("ball", "fineness=4")
        self.assert_refused("score", name, "--target", "box.obj", code=1, says=(name, "not a text file"))

    def test_spheres_far_away(self):
        """In another unit or frame, as it happens: an error that says so, not a grid as large as the distance."""
        for sphere in ("1e9,0,0,1", "0,-1e9,0,1", "1e300,0,0,1", "1e308,0,0,1e308", "0,0,0,1e6"):
            with self.subTest(sphere=sphere):
                self.write("c.csv", "1,1,0.5,0.5\n" + sphere + "\n")
                result = self.assert_refused("score", "c.csv", "--target", "box.obj", *GRID, code=1,
                                             says=("reach so far", "units"))
                self.assertLess(result.seconds, 10)


class Judge(Score):
    """Against tools/score.c of the shared folder, which shares no code with mskit."""

    def judge(self):
        source = os.path.join(SHARED, "tools", "score.c")
        compiler = next((c for c in (os.environ.get("CC"), "cc", "gcc", "clang") if c and shutil.which(c)), None)
        if not os.path.exists(source) or not compiler:
            raise unittest.SkipTest("the independent judge shared/tools/score.c or a C compiler is missing here")
        subprocess.run([compiler, "-O2", "-w", "-o", self.path("judge"), source, "-lm"], check=True, timeout=TIMEOUT)
        return self.path("judge")

    def test_agrees_with_an_independent_judge(self):
        """200 voxels along the longest side for both judges, which put their voxels in different places.

        Tolerance: the surface of either body has fewer than N = 75,000 voxels among S = 0.9 million. Each judge
        decides on each of them with an error of half a voxel at most, 0.3 on average; were they independent, the
        sums would err by 0.3 sqrt(N) / S = 1e-4. On symmetric bodies rows of voxels err together, so five times
        that is allowed. The measures are of the order of 0.05 to 0.9.
        """
        judge = self.judge()
        for kind, longest, n in (("ellipsoid", 4, 8), ("torus", 8, 16)):
            name = self.shape(kind)
            self.mskit("generate", name, "-g", "mss", "--cells", "50", "-n", n, "--variant", "paper", "--radius-offset",
                       "0.6", "-o", "c.csv")
            ours = self.score("c.csv", "--voxel-size", longest / 200, target=name)
            printed = subprocess.run([judge, name, "c.csv", "200"], cwd=self.dir, check=True, timeout=TIMEOUT,
                                     stdout=subprocess.PIPE).stdout
            theirs = json.loads(printed)
            self.assertEqual(theirs["n"], n)
            self.assertGreater(theirs["overshoot"], 0.001,
                               "the offset makes spheres reach out, so that all is compared")
            for measure, key in (("D", "dice"), ("eta", "eta"), ("coverage", "coverage"), ("overshoot", "overshoot")):
                self.assertAlmostEqual(ours[key], theirs[measure], delta=5e-4, msg=f"{measure} of the {kind}")
