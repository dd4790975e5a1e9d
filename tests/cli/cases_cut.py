"""Coverage of cells that follow the surface, by --cut, --until coverage_cut and setcover's count=cut."""
import csv
import io
import itertools

from support import Case, box_obj, parse_spheres

BOX = (3, 2.25, 1.5)  # of whole voxels: no cell is cut, those by the surface are eighths of a voxel
H = 0.25
GRID = ("--voxel-size", str(H), "-j", "1")
SETCOVER = ("-g", "setcover", "--skeleton-deq", "20")


def cells_of_box():
    """Centre and volume of each."""
    n = [round(side / H) for side in BOX]
    for at in itertools.product(*map(range, n)):
        if all(0 < i < most - 1 for i, most in zip(at, n)):
            yield [(i + 0.5) * H for i in at], 8
        else:
            for part in itertools.product((0.25, 0.75), repeat=3):
                yield [(i + p) * H for i, p in zip(at, part)], 1


CELLS = list(cells_of_box())


def coverage_cut(spheres):
    covered = sum(weight for at, weight in CELLS
                  if any(sum((a - c) ** 2 for a, c in zip(at, s[:3])) <= s[3] ** 2 * (1 + 1e-9) for s in spheres))
    return covered / sum(weight for _, weight in CELLS)


class Cut(Case):
    def setUp(self):
        super().setUp()
        self.write("box.obj", box_obj((0, 0, 0), BOX))

    def rows(self, name):
        return list(csv.DictReader(io.StringIO(self.read(name).decode())))

    def test_score(self):
        spheres = [(0.8137, 1.1219, 0.7301, 0.71), (1.7731, 1.0117, 0.9103, 0.83), (2.9, 0.3, 0.2, 0.5)]
        self.write("c.csv", "x,y,z,r\n" + "".join("%r,%r,%r,%r\n" % s for s in spheres))
        target = ("score", "c.csv", "--target", "box.obj", *GRID)
        scores = self.mskit(*target, "--cut", "--json").json["scores"]
        self.assertAlmostEqual(scores["coverage_cut"], coverage_cut(spheres), delta=1e-12)
        self.assertIsNone(self.mskit(*target, "--json").json["scores"]["coverage_cut"])
        self.assertIn("coverage of cut cells", self.mskit(*target, "--cut").out)
        self.assertNotIn("coverage of cut cells", self.mskit(*target).out)
        curve = self.rows_of_curve(self.mskit(*target, "--cut", "--curve").out)
        for row, n in zip(curve, (1, 2, 3), strict=True):
            self.assertAlmostEqual(row["coverage_cut"], coverage_cut(spheres[:n]), delta=1e-7)
        self.assertNotIn("coverage_cut", self.mskit(*target, "--curve").out)

    def test_until(self):
        """The run ends with the very sphere that covers enough, however setcover counts, and with another method."""
        for options in (SETCOVER, (*SETCOVER, "--set", "count=cut"), ("-g", "mss")):
            json = self.mskit("generate", "box.obj", *GRID, *options, "--until", "coverage_cut=0.8", "-o", "c.csv",
                              "--json").json
            spheres = parse_spheres(self.read("c.csv").decode())
            self.assertEqual(json["stopped_by"], "coverage_cut")
            self.assertAlmostEqual(json["scores"]["coverage_cut"], coverage_cut(spheres), delta=1e-12)
            self.assertGreaterEqual(coverage_cut(spheres), 0.8)
            self.assertLess(coverage_cut(spheres[:-1]), 0.8)
        self.assert_refused("generate", "box.obj", *GRID, "--until", "coverage_cut=1.5", code=2, says=("coverage_cut",))

    def test_count(self):
        """With count=cut no sphere covers more cells than one before it, as the best one each time cannot."""
        for count in ("voxels", "cut"):
            self.mskit("generate", "box.obj", *GRID, *SETCOVER, "--set", f"count={count}", "-n", 12, "--cut",
                       "-o", f"{count}.csv", "--curve", "k.csv")
            spheres = parse_spheres(self.read(f"{count}.csv").decode())
            curve = [float(row["coverage_cut"]) for row in self.rows("k.csv")]
            for n, value in enumerate(curve, 1):
                self.assertAlmostEqual(value, coverage_cut(spheres[:n]), delta=1e-7)
        gains = [after - before for before, after in zip([0, *curve], curve)]
        self.assertEqual(len(gains), 12)
        for before, after in zip(gains, gains[1:]):
            self.assertLessEqual(after, before + 1e-7)
        self.assertNotEqual(self.read("voxels.csv"), self.read("cut.csv"))
        self.assert_refused("generate", "box.obj", *GRID, *SETCOVER, "--set", "count=cells", code=2,
                            says=("voxels, cut",))

    def test_compare(self):
        self.write("c.csv", "x,y,z,r\n1.5137,1.1,0.7,0.7\n")
        for name, cut in (("plain.csv", ()), ("rows.csv", ("--cut",))):
            self.mskit("compare", "box.obj", "--clump", "theirs=c.csv", "-g", "mss", *GRID[2:], "--cells", 6, "-n", 3,
                       *cut, "-o", name)
            self.assertEqual({row["coverage_cut"] != "" for row in self.rows(name)}, {bool(cut)})
        row = next(row for row in self.rows("rows.csv") if row["generator"] == "theirs")
        self.assertAlmostEqual(float(row["coverage_cut"]), coverage_cut([(1.5137, 1.1, 0.7, 0.7)]), delta=1e-6)

    def test_memory(self):
        """What cut cells take is announced, and counts against --max-memory, where they are asked for in any way."""
        for asked in (("--cut",), ("--until", "coverage_cut=0.5"), (*SETCOVER, "--set", "count=cut")):
            args = ("generate", "box.obj", *GRID, *SETCOVER, "-n", 3, "-o", "c.csv", "--max-memory", "60k")
            self.mskit(*args)
            self.assert_refused(*args, *asked, code=1, says=("--max-memory",))
        score = ("score", "c.csv", "--target", "box.obj", *GRID, "--max-memory", "60k")
        self.mskit(*score)
        self.assert_refused(*score, "--cut", code=1, says=("--max-memory",))
