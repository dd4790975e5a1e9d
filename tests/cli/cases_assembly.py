"""mskit grains --assembly: every clump in its place and turn, and where neighbours overlap."""
import json
import math
import os

from support import box_obj, npy, shared_file
from cases_grains import Grains, parse

SIZE = (30, 26, 24)  # voxels
DENSITY, MM = 2000, 1e-3
# Centre, half edges, angle about (2, -2, 1)/3, of boxes in the volume.
BOXES = {3: ((8, 9, 9), (6, 4, 3), 0.7), 5: ((20, 14, 12), (5, 3.4, 6), -0.4), 6: ((9, 18, 16), (4, 3, 5), 2.9)}


def turned(v, about, angle):
    """Rodrigues."""
    along = sum(a * b for a, b in zip(about, v))
    across = (about[1] * v[2] - about[2] * v[1], about[2] * v[0] - about[0] * v[2], about[0] * v[1] - about[1] * v[0])
    return [math.cos(angle) * a + math.sin(angle) * b + (1 - math.cos(angle)) * along * c
            for a, b, c in zip(v, across, about)]


def scan():
    def at(*voxel):
        for label, (centre, half, angle) in BOXES.items():
            own = turned([v - c for v, c in zip(voxel, centre)], (2 / 3, -2 / 3, 1 / 3), -angle)
            if all(abs(x) <= h for x, h in zip(own, half)):
                return label
        return 0
    return npy([at(i, j, k) for k in range(SIZE[2]) for j in range(SIZE[1]) for i in range(SIZE[0])], SIZE[::-1])


def numbers(row, *columns):
    return [float(row[column]) for column in columns]


def by_quaternion(v, q):
    w, u = q[0], q[1:]
    once = [a + w * b for a, b in zip(cross(u, v), v)]
    return [a + 2 * b for a, b in zip(v, cross(u, once))]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


class Assembly(Grains):
    ARGS = ("scan.npy", "-g", "mss", "-n", "9", "--density", str(DENSITY), "--unit", "mm")
    ALL = ("--format", "csv", "--format", "liggghts", "--format", "lammps", "--format", "yade", "--assembly")

    def setUp(self):
        super().setUp()
        self.write("scan.npy", scan())

    def spheres(self, row, out="out"):
        lines = parse(self.read(f"{out}/{row['file']}").decode())
        return [[float(line[column]) for column in "xyzr"] for line in lines]

    def pairs(self, out="out"):
        return {(row["grain"], row["neighbour"]): row for row in parse(self.read(out + "/assembly.csv").decode())}

    def packing_files(self, out):
        return {name: self.read(f"{out}/{name}") for name in os.listdir(self.path(out)) if name.startswith("assembly")}

    def check_depths(self, rows, out="out"):
        """All pairs of all spheres, against the table."""
        pairs = self.pairs(out)
        scale = {}
        for (a, b), pair in pairs.items():
            scale[a], scale[b] = numbers(pair, "scale", "neighbour_scale")
        for i, a in enumerate(rows):
            for b in rows[i + 1:]:
                size = min(float(row["equivalent_diameter"]) / 2 for row in (a, b))
                depth = max(s[3] + t[3] - math.dist(s[:3], t[:3])
                            for s in self.shrunk(a, scale, out) for t in self.shrunk(b, scale, out))
                pair = pairs.pop((a["grain"], b["grain"]), None)
                self.assertEqual(pair is not None, depth > -0.1 * size, "a tenth of the radius is near")
                if pair:
                    self.assert_close(float(pair["depth"]), depth, 1e-9, "depth")
                    self.assert_close(float(pair["relative_depth"]), depth / size, 1e-9, "relative depth")
        self.assertFalse(pairs)
        return scale

    def shrunk(self, row, scale, out):
        factor, centre = scale.get(row["grain"], 1), numbers(row, "centre_x", "centre_y", "centre_z")
        return [[c + factor * (x - c) for x, c in zip(s, centre)] + [factor * s[3]] for s in self.spheres(row, out)]


class Places(Assembly):
    def test_a_template_is_turned_back_onto_its_grain(self):
        rows = self.grains(*self.ARGS, *self.ALL)
        self.assertEqual([row["label"] for row in rows], ["3", "5", "6"])
        for row in rows:
            centre = numbers(row, "centre_x", "centre_y", "centre_z")
            turn = numbers(row, "quaternion_w", "quaternion_x", "quaternion_y", "quaternion_z")
            for format_name, unpack in (("liggghts", lambda words: words), ("yade", lambda words: words[:4])):
                lines = self.read("out/" + row["file"].replace(".csv", "." + format_name)).decode().splitlines()
                template = [unpack([float(word) for word in line.split()]) for line in lines if line[0] != "#"]
                self.assertEqual(len(template), int(row["n"]))
                for t, s in zip(template, self.spheres(row)):
                    back = [c + x / MM for c, x in zip(centre, by_quaternion(t[:3], turn))]
                    self.assertLess(max(abs(x - y) for x, y in zip(back + [t[3] / MM], s)), 1e-12 * max(SIZE))

    def test_the_turn_is_that_of_the_box(self):
        """The principal axes of a box are its edges, the longest first: known but for what voxels leave, and a sign."""
        for row in self.grains(*self.ARGS, "--assembly"):
            centre, half, angle = BOXES[int(row["label"])]
            turn = numbers(row, "quaternion_w", "quaternion_x", "quaternion_y", "quaternion_z")
            self.assert_close(sum(x * x for x in turn), 1, 1e-15, "length")
            self.assertLess(math.dist(numbers(row, "centre_x", "centre_y", "centre_z"), centre), 0.2)
            for axis, edge in enumerate(sorted(range(3), key=lambda k: -half[k])):
                truth = turned([float(k == edge) for k in range(3)], (2 / 3, -2 / 3, 1 / 3), angle)
                got = by_quaternion([float(k == axis) for k in range(3)], turn)
                self.assertGreater(abs(sum(a * b for a, b in zip(truth, got))), math.cos(0.06))

    def test_the_frame_beside_a_template_agrees(self):
        for row in self.grains(*self.ARGS, "--format", "liggghts"):
            frame = json.loads(self.read("out/" + row["file"].replace(".liggghts", ".frame.json")))
            turn = numbers(row, "quaternion_w", "quaternion_x", "quaternion_y", "quaternion_z")
            self.assertEqual(frame["particle"]["centre"], numbers(row, "centre_x", "centre_y", "centre_z"))
            self.assertEqual(frame["particle"]["mass"], float(row["mass"]))
            self.assertEqual(frame["particle"]["principal_moments"], numbers(row, "moment_1", "moment_2", "moment_3"))
            for k, axis in enumerate(frame["particle"]["principal_axes"]):
                self.assertLess(math.dist(by_quaternion([float(k == m) for m in range(3)], turn), axis), 1e-14)

    def test_places_without_masses(self):
        with_masses = self.grains(*self.ARGS, out="with")
        for row, other in zip(self.grains("scan.npy", "-g", "mss", "-n", "9", "--assembly"), with_masses):
            self.assertEqual((row["mass"], row["moment_1"]), ("", ""))
            for column in ("centre_x", "quaternion_w", "quaternion_z"):
                self.assert_close(float(row[column]), float(other[column]), 1e-9, column)
        self.check_depths(self.table())

    def test_meshes_of_one_frame(self):
        self.write("stones/c.obj", box_obj((2.9, 0, 0), (5, 2, 1)))
        rows = self.grains("stones/b.obj", "stones/c.obj", "-g", "mss", "-n", "8", "--cells", "14", "--assembly")
        self.check_depths(rows)
        self.assertEqual(list(self.pairs()), [("1", "2")])


class Depths(Assembly):
    def test_depths_are_those_of_all_pairs(self):
        result = self.mskit("grains", *self.ARGS, "--assembly", "-o", "out")
        self.assertEqual(set(self.check_depths(self.table()).values()), {1.0})
        depths = [float(pair["relative_depth"]) for pair in self.pairs().values()]
        self.assertRegex(result.out, rf"3 clumps in their places, {len(depths)} pairs of neighbours")

    def test_two_balls(self):
        for name, x in (("a", 0), ("b", 1.8)):
            self.mskit("shape", "ball", "-o", f"{name}.obj")
            lines = self.read(f"{name}.obj").decode().splitlines()
            self.write(f"{name}.obj", "\n".join(
                f"v {float(line.split()[1]) + x} {line.split()[2]} {line.split()[3]}" if line.startswith("v ") else line
                for line in lines))
        self.grains("a.obj", "b.obj", "-g", "mss", "-n", "1", "--cells", "40", "--assembly")
        (pair,) = self.pairs().values()
        self.assertLess(abs(float(pair["relative_depth"]) - 0.2), 0.05, "1 + 1 - 1.8, by spheres of voxels")
        self.assertEqual(pair["contacts"], "1")

    def test_shrunk_until_none_is_deeper(self):
        self.write("stones/c.obj", box_obj((2.5, 0, 0), (5, 2, 1)))
        run = ("stones/b.obj", "stones/c.obj", "-g", "mss", "-n", "8", "--cells", "14", "--assembly")
        rows = self.grains(*run)
        self.assertGreater(max(float(pair["relative_depth"]) for pair in self.pairs().values()), 0.1)
        result = self.mskit("grains", *run, "--most-overlap", "0.01", "-o", "out", "--resume", "--json")
        scale = self.check_depths(rows)
        self.assertLessEqual(max(float(pair["relative_depth"]) for pair in self.pairs().values()), 0.01)
        volume = [float(row["volume"]) for row in rows]
        kept = sum(v * scale.get(row["grain"], 1) ** 3 for v, row in zip(volume, rows)) / sum(volume)
        self.assertLess(kept, 1)
        self.assert_close(json.loads(result.out)["assembly"]["volume_kept"], kept, 1e-9, "volume")


class Runs(Assembly):
    def test_written_again_by_resume(self):
        self.grains(*self.ARGS, *self.ALL, out="one")
        self.mskit("grains", *self.ARGS, *self.ALL[:-1], "-o", "two")
        self.assertEqual(self.packing_files("two"), {})
        self.mskit("grains", *self.ARGS, *self.ALL, "-o", "two", "--resume")
        files = self.packing_files("one")
        endings = ("csv", "lammps", "lammps.bodies", "lammps.in", "liggghts", "liggghts.in", "yade", "yade.py")
        self.assertEqual(sorted(files), ["assembly." + ending for ending in endings])
        self.assertEqual(self.packing_files("two"), files)

    def test_after_parts_are_merged(self):
        self.grains(*self.ARGS, *self.ALL, out="one")
        for part in "12":
            self.mskit("grains", *self.ARGS, *self.ALL[:-1], "-o", "two", "--part", part + "/2")
        self.mskit("grains", "--merge", "two", "-o", "two")
        self.mskit("grains", *self.ARGS, *self.ALL, "-o", "two", "--resume")
        self.assertEqual(self.packing_files("two"), self.packing_files("one"))

    def test_grains_without_a_clump_are_missing(self):
        result = self.mskit("grains", *self.ARGS, "--assembly", "--least-voxels", "530", "-o", "out")
        self.assertEqual([row["status"] for row in self.table()].count("left-out"), 1)
        self.assertIn("2 clumps in their places", result.out)
        self.assertIn("grains without a clump are missing", result.out)
        self.assert_says(self.mskit("grains", *self.ARGS, "--assembly", "--least-voxels", "9999", "-o", "none", code=1),
                         "not one grain")

    def test_what_is_wrong_is_said_before_the_work(self):
        run = ("grains", *self.ARGS, "-o", "out")
        self.assert_refused(*run, "--assembly", "--part", "1/2", code=2, says=("--merge",))
        self.assert_refused("grains", "--merge", "out", "--assembly", "-o", "out", code=2, says=("--resume",))
        self.assert_refused(*run, "--most-overlap", "0.1", code=2, says=("--assembly",))
        self.assert_refused(*run, "--assembly", "--most-overlap", "0", code=2, says=("most-overlap",))
        self.assert_refused(*run, "stones", "--assembly", code=1, says=("scan.npy", "one frame"))
        self.assert_refused(*run, "--assembly", "--format", "vtk", code=1, says=("vtk", "--format csv"))
        os.mkdir(self.path("out"))
        self.write("out/assembly.csv", "shape\n../scan.npy\n")
        before = self.read("out/assembly.csv")
        result = self.mskit("grains", "out/assembly.csv", "-g", "mss", "-o", "out", "--assembly", code=1)
        self.assert_says(result, "assembly.csv")
        self.assertEqual(self.read("out/assembly.csv"), before)

    def test_rows_of_other_masses(self):
        self.grains("scan.npy", "-g", "mss", "-n", "9")
        go_on = ("--assembly", "-o", "out", "--resume")
        self.assert_says(self.mskit("grains", *self.ARGS, *go_on, code=1), "another run")
        self.grains(*self.ARGS, out="two")
        self.assert_says(self.mskit("grains", *self.ARGS, "--density", "1000", "--assembly", "-o", "two", "--resume",
                                    code=1), "another run")


class Scan(Assembly):
    def test_a_tomogram(self):
        """Grains of the sample touch, and so do their clumps."""
        result = self.mskit("grains", shared_file("nmc_ct_labels.npy"), "-g", "mss", "-n", "5", "--least-voxels", "200",
                            "--assembly", "-o", "out", "--json")
        assembly = json.loads(result.out)["assembly"]
        self.assertGreater(assembly["overlapping"], 20)
        self.assertLess(assembly["most_relative_depth"], 1)
        self.check_depths([row for row in self.table() if row["status"] == "ok"])
