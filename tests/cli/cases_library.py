"""mskit grains --choose: few grains with weights that stand for all of a run."""
import csv
import io
import math
import os
import random

from support import Case, box_obj

GRAINS = 24


def parse(text):
    return list(csv.DictReader(io.StringIO(text)))


class Library(Case):
    def setUp(self):
        super().setUp()
        numbers = random.Random(1)
        os.mkdir(self.path("stones"))
        for grain in range(GRAINS):
            edges = [numbers.uniform(1, 3) for _ in range(3)]
            self.write(f"stones/s{grain:02}.obj", box_obj((0, 0, 0), edges))
        self.mskit("grains", "stones", "-g", "mss", "-n", "3", "--cells", "12", "-o", "all")

    def table(self, name):
        return parse(self.read(name).decode())

    def choose(self, *args, k=4, out="few"):
        return self.mskit("grains", "--choose", str(k), "all", "-o", out, "--json", *args).json

    def distance(self, column, weight, chosen, share):
        """Kolmogorov-Smirnov, at every value."""
        def below(rows, of, at):
            return sum(of(r) for r in rows if float(r[column]) <= at) / sum(of(r) for r in rows)
        grains = self.table("all/grains.csv")
        return max(abs(below(grains, share, float(r[column])) - below(chosen, weight, float(r[column])))
                   for r in grains)

    def test_distances_are_true(self):
        for how, weight, share in ((["--by", "number"], "number", lambda r: 1),
                                   (["--by", "mass", "--with-size"], "mass", lambda r: float(r["volume"]))):
            said = self.choose(*how)
            chosen = self.table("few/library.csv")
            self.assertEqual(len(chosen), 4)
            for name in ("sphericity", "elongation", "flatness", "convexity"):
                truth = self.distance("shape_" + name, lambda r, w=weight: float(r[w]), chosen, share)
                self.assertAlmostEqual(said["distance"][name], truth, delta=1e-9)
            self.assertAlmostEqual(sum(float(r["number"]) for r in chosen), 1, delta=1e-9)
            self.assertAlmostEqual(sum(float(r["mass"]) for r in chosen), 1, delta=1e-9)

    def test_sizes_keep_number_and_mass(self):
        self.choose("--classes", "5")
        diameters = [float(r["shape_equivalent_diameter"]) for r in self.table("all/grains.csv")]
        sizes = [(float(r["diameter"]), float(r["number"])) for r in self.table("few/sizes.csv")]
        self.assertEqual(sizes, sorted(sizes))
        self.assertAlmostEqual(sum(n for _, n in sizes), 1, delta=1e-9)
        mean = sum(d ** 3 for d in diameters) / len(diameters)
        for d, n in sizes:
            self.assertAlmostEqual(n * d ** 3, mean / 5, delta=1e-9 * mean)

    def test_all_of_them_are_a_library(self):
        said = self.choose("--with-size", k=GRAINS)
        self.assertLess(said["distance"]["largest"], 1e-9)
        self.assertLess(said["distance"]["correlation"], 1e-9)
        self.assertIsNone(said["split_distance"])
        for row in self.table("few/library.csv"):
            self.assertAlmostEqual(float(row["number"]), 1 / GRAINS, delta=1e-9)

    def test_the_same_seed_gives_the_same(self):
        self.choose("--seed", "5", out="one")
        self.choose("--seed", "5", out="two")
        self.assertEqual(self.read("one/library.csv"), self.read("two/library.csv"))

    def test_scene_takes_it(self):
        """In the sizes of its classes, or with those of the grains."""
        for how, rows in (("--classes", "3"), 12), (("--with-size",), 4):
            self.choose(*how)
            scene = self.table("few/scene.csv")
            self.assertEqual(len(scene), rows)
            self.mskit("scene", "few/scene.csv", "-g", "mss", "--budget", "20000000", "--max-spheres", "3", "--cells",
                       "10")

    def test_sizes_of_a_scene(self):
        """Each grain's number is dealt out to the classes."""
        self.choose("--classes", "3")
        numbers = {os.path.basename(r["source"]): float(r["number"]) for r in self.table("few/library.csv")}
        sizes = {float(r["diameter"]): float(r["number"]) for r in self.table("few/sizes.csv")}
        rows = self.table("few/scene.csv")
        self.assertEqual({float(r["size"]) for r in rows}, set(sizes))
        for row in rows:
            share = numbers[os.path.basename(row["shape"])] * sizes[float(row["size"])]
            self.assertAlmostEqual(int(row["count"]), max(1, 1e6 * share), delta=0.51)

    def test_grains_of_one_size(self):
        """Classes that are alike are one size of the scene, and its counts are those of all."""
        for grain in range(GRAINS):
            self.write(f"stones/s{grain:02}.obj", box_obj((0, 0, 0), (2, 2, 1) if grain % 2 else (4, 1, 1)))
        self.mskit("grains", "stones", "-g", "mss", "-n", "1", "--cells", "4", "-o", "alike")
        self.mskit("grains", "--choose", "2", "alike", "--classes", "4", "-o", "few")
        rows = self.table("few/scene.csv")
        self.assertEqual(len(rows), 2)
        for row in rows:
            self.assertAlmostEqual(float(row["size"]), (6 * 4 / math.pi)**(1 / 3), delta=1e-9)
        self.assertEqual(sum(int(r["count"]) for r in rows), 1000000)

    def test_a_scene_of_too_many_rows(self):
        for grain in range(GRAINS, 32):
            self.write(f"stones/s{grain:02}.obj", box_obj((0, 0, 0), (1, 1, 1 + grain / 10)))
        self.mskit("grains", "stones", "-g", "mss", "-n", "1", "--cells", "4", "-o", "more")
        self.mskit("grains", "--choose", "2", "more", "--classes", "2", "-o", "few")
        self.assertIn("scene.csv", os.listdir(self.path("few")))
        said = self.mskit("grains", "--choose", "32", "more", "--classes", "32", "-o", "few")
        self.assertIn("no scene.csv", said.out)
        self.assertIn("1000 at most", said.out)
        self.assertNotIn("scene.csv", os.listdir(self.path("few")), "nor that of a run before")

    def test_grains_without_clump_are_not_chosen(self):
        self.write("stones/broken.obj", b"v 0 0 0\nf 1 2 3\n")
        self.mskit("grains", "stones", "-g", "mss", "-n", "3", "--cells", "12", "-o", "all2")
        said = self.mskit("grains", "--choose", "3", "all2", "-o", "few", "--json").json
        self.assertEqual((said["grains"], said["without_clump"]), (GRAINS, 1))

    def test_a_table_with_faults_is_refused(self):
        lines = self.read("all/grains.csv").decode().splitlines(True)
        columns = lines[0].split(",")
        fields = lines[1].split(",")
        fields[columns.index("shape_equivalent_diameter")] = "0"
        os.mkdir(self.path("mended"))
        self.write("mended/grains.csv", lines[0] + ",".join(fields) + "".join(lines[2:]))
        said = self.mskit("grains", "--choose", "3", "mended", "-o", "few", "--json").json
        self.assertEqual((said["grains"], said["without_descriptors"]), (GRAINS - 1, 1))
        self.write("mended/grains.csv", lines[0] + "1,2,3\n")
        self.assert_refused("grains", "--choose", "1", "mended", "-o", "none", code=1, says=("line 2", "fields"))
        self.write("mended/grains.csv", lines[0])
        self.assert_refused("grains", "--choose", "1", "mended", "-o", "none", code=1, says=("no grain has a clump",))

    def test_moments_beyond_numbers_are_refused(self):
        """In another size a moment that is a number may be none."""
        self.mskit("grains", "stones", "-g", "mss", "-n", "3", "--cells", "12", "--density", "2650", "--format",
                   "liggghts", "-o", "heavy")
        lines = [line.split(",") for line in self.read("heavy/grains.csv").decode().splitlines(True)]
        for fields in lines[1:]:
            fields[lines[0].index("moment_2")] = "1.5e308"
        self.write("heavy/grains.csv", "".join(map(",".join, lines)))
        said = self.mskit("grains", "--choose", "3", "--classes", "2", "heavy", "-o", "few", code=1).err
        self.assertIn("times its size: mass, volume or inertia of the particle is not from 1e-290", said)
        self.assertNotIn("library.liggghts.in", os.listdir(self.path("few")))

    def test_what_cannot_be_is_refused(self):
        for args, word in ((["--choose", "30", "all"], "30"), (["--choose", "3", "stones"], "grains.csv"),
                           (["--choose", "3", "--classes", "50", "all"], "50")):
            self.assert_refused("grains", *args, "-o", "few", code=1, says=[word])
        for args, word in ((["--choose", "3", "--by", "numbre", "all"], "number"),
                           (["--by", "mass", "all"], "--choose"), (["--choose", "3", "--merge", "all"], "--merge"),
                           (["--choose", "3", "--with-size", "--classes", "4", "all"], "--with-size"),
                           (["--choose", "3", "all", "all"], "one folder"),
                           (["--choose", "3", "-g", "mss", "all"], "--generator has no effect"),
                           (["--choose", "3", "-n", "9", "all"], "--spheres has no effect"),
                           (["--choose", "3", "--polish", "all"], "--polish has no effect"),
                           (["--choose", "3", "--cells", "9", "all"], "--cells has no effect"),
                           (["--choose", "3", "--format", "vtk", "all"], "--format has no effect"),
                           (["--merge", "-g", "mss", "all"], "--generator has no effect"),
                           (["--merge", "-n", "9", "all"], "--spheres has no effect"),
                           (["--merge", "--json", "all"], "--json has no effect"),
                           (["--merge", "--dry-run", "all"], "--dry-run has no effect"),
                           (["--dry-run", "--json", "all"], "--json")):
            self.assert_refused("grains", *args, "-o", "few", code=2, says=[word])
