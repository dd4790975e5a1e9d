"""Meshes as they come: seams, holes, surfaces that stand twice, crumbs, lax files; and grids of so many voxels in
all."""
import csv
import io
import json
import random
import re

from support import Case, box_obj, npy
from cases_bodies import together

BOX = ((0, 0, 0), (3, 2, 1))
VOLUME = 6


def soup_obj(text, by, seed=1):
    """Every triangle with corners of its own, each coordinate moved by at most `by`."""
    rng = random.Random(seed)
    vertices = [[float(w) for w in line.split()[1:]] for line in text.splitlines() if line[0] == "v"]
    faces = [[int(w) - 1 for w in line.split()[1:]] for line in text.splitlines() if line[0] == "f"]
    out = ""
    for face in faces:
        for v in face:
            out += "v " + " ".join(repr(x + by * rng.uniform(-1, 1)) for x in vertices[v]) + "\n"
        out += "f -3 -2 -1\n"
    return out


def doubled_obj(text, turned):
    faces = [line.split()[1:] for line in text.splitlines() if line[0] == "f"]
    return text + "".join("f " + " ".join(f[::-1] if turned else f) + "\n" for f in faces)


class Mending(Case):
    def info(self, name, *flags):
        result = self.mskit("info", name, "--json", *flags)
        return result.json, result

    def test_seams(self):
        """The length is 3: corners up to 3e-7 apart are one; those 3e-6 apart are if that is asked for."""
        self.write("near.obj", soup_obj(box_obj(*BOX), 1.4e-7))
        self.write("far.obj", soup_obj(box_obj(*BOX), 1.4e-6))
        info, result = self.info("near.obj")
        self.assert_says(result, "near.obj: joined 28 corners of open edges", "1e-07", "--weld")
        self.assertEqual((info["closed"], info["joined"], info["vertices"]), (True, 28, 8))
        self.assert_close(info["volume"], VOLUME, 1e-6, "volume")
        self.assertFalse(self.info("near.obj", "--weld", 0)[0]["closed"])
        self.assertFalse(self.info("far.obj")[0]["closed"])
        info, result = self.info("far.obj", "--weld", "1e-6")
        self.assertTrue(info["closed"])
        self.assert_close(info["volume"], VOLUME, 1e-5, "volume")

    def test_a_clean_mesh_is_not_spoken_of(self):
        self.write("box.obj", box_obj(*BOX))
        info, result = self.info("box.obj", "--weld", 0.1, "--fill-holes", 9, "--drop-bodies", 0.5)
        self.assertEqual(result.err, "")
        self.assertEqual([info[key] for key in ("joined", "filled_holes", "dropped_bodies", "dropped_volume", "holes")],
                         [0] * 5)

    def test_holes(self):
        self.write("open.obj", box_obj(*BOX, skip=2))
        self.assert_refused("generate", "open.obj", code=1,
                            says=("open.obj: the mesh is open: 4 edges", "(1, the largest of 4 edges)",
                                  "--fill-holes 4"))
        self.assertRegex(self.mskit("info", "open.obj").out, "holes +1, the largest of 4 edges")
        self.assertFalse(self.info("open.obj", "--fill-holes", 3)[0]["closed"])
        info, result = self.info("open.obj", "--fill-holes", 4)
        self.assert_says(result, "filled 1 holes of at most 4 edges")
        self.assertEqual((info["closed"], info["filled_holes"]), (True, 1))
        self.assert_close(info["volume"], VOLUME, 1e-12, "volume")

    def test_surfaces_that_stand_twice(self):
        for turned in (False, True):
            self.write("twice.obj", doubled_obj(box_obj(*BOX), turned))
            info, result = self.info("twice.obj")
            self.assert_says(result, "dropped 0 degenerate and 12 duplicate triangles")
            self.assertEqual((info["closed"], info["triangles"], info["dropped_duplicate"]), (True, 12, 12))
            self.assert_close(info["volume"], VOLUME, 1e-12, "volume")

    def test_crumbs(self):
        self.write("crumbs.obj", together(BOX, ((5, 0, 0), (5.1, 0.1, 0.1)), ((6, 0, 0), (6.1, 0.1, 0.2))))
        self.assertEqual(self.info("crumbs.obj", "--drop-bodies", 1e-4)[0]["bodies"], 3)
        info, result = self.info("crumbs.obj", "--drop-bodies", 2e-4)
        self.assert_says(result, "dropped 1 pieces smaller than 0.0002 of the largest, of volume 0.001 in all")
        self.assertEqual((info["bodies"], info["dropped_bodies"]), (2, 1))
        info = self.info("crumbs.obj", "--drop-bodies", 0.01)[0]
        self.assert_close(info["dropped_volume"], 0.003, 1e-9, "volume of crumbs")
        self.assert_close(info["volume"], VOLUME, 1e-12, "volume")
        self.assertEqual(info["box_hi"], [3, 2, 1])

    def test_every_command(self):
        """The same body by each command that reads a mesh: a box without a face, a crumb beside it, seams."""
        text = together(BOX, ((5, 0, 0), (5.1, 0.1, 0.1))).splitlines()
        faces = [k for k, line in enumerate(text) if line[0] == "f"]
        text = [line for k, line in enumerate(text) if k not in faces[:2]]
        self.write("bad.obj", soup_obj("\n".join(text), 1e-7))
        mend = ("--fill-holes", 4, "--drop-bodies", 0.01)
        said = ("joined", "filled 1 holes", "dropped 1 pieces")
        grid = ("--cells", 10)
        run = self.mskit("generate", "bad.obj", *mend, *grid, "-g", "mss", "-n", 5, "--json", "-o", "c.csv")
        self.assert_says(run, *said)
        record = run.json["input"]
        self.assertEqual((record["closed"], record["filled_holes"], record["dropped_bodies"]), (True, 1, 1))
        self.assertGreater(record["joined"], 20)
        self.assert_close(record["dropped_volume"], 0.001, 1e-4, "volume of crumbs")
        self.assertEqual(record["voxels"], 6000)
        result = self.mskit("score", "c.csv", "--target", "bad.obj", *mend, *grid, "--json")
        self.assert_says(result, *said)
        self.assertEqual(result.json["target"]["voxels"], 6000)
        result = self.mskit("correct", "c.csv", "--target", "bad.obj", *mend, "--density", 1000, "--json",
                            "-o", "d.csv", "--centre-tolerance", 0.5)
        self.assert_says(result, *said)
        self.assert_close(result.json["particle"]["mass"], 6000, 1e-6, "mass")
        self.mskit("compare", "bad.obj", *mend, *grid, "-g", "mss", "-n", 5, "-o", "compare.csv")
        row = next(csv.DictReader(io.StringIO(self.read("compare.csv").decode())))
        self.assertEqual(float(row["dice"]), run.json["scores"]["dice"])
        self.mskit("scene", "bad.obj", *mend, *grid, "-g", "mss", "--budget", 5, "-o", "scene")
        self.mskit("stability", "bad.obj", *mend, *grid, "-g", "mss", "-n", 5, "--perturb", "rotation", "--runs", 1,
                   "-o", "stability.csv")

    def test_wrong_flags(self):
        self.write("box.obj", box_obj(*BOX))
        self.write("v.npy", npy([1] * 64, (4, 4, 4)))
        for flag, value in (("--weld", "0.2"), ("--weld", "-1e-7"), ("--weld", "x"), ("--fill-holes", "1.5"),
                            ("--fill-holes", "-1"), ("--drop-bodies", "1.1"), ("--max-voxels", "0"),
                            ("--max-voxels", "many")):
            self.assert_refused("score", "c.csv", "--target", "box.obj", flag, value, code=2, says=(flag, value))
        self.assert_refused("info", "box.obj", "--weld", "1e-20", code=1, says=("1e-20", "1e-13 to 0.1"))
        for flag in (("--fill-holes", "4"), ("--drop-bodies", "0.1"), ("--max-voxels", "1000")):
            self.assert_refused("generate", "v.npy", *flag, code=1, says=("v.npy", flag[0]))


class Lax(Case):
    """What other programs read too, and a remark that says so."""

    def test_remarks(self):
        facet = "facet normal 0 0 0\nouter loop\n%send loop\nendfacet\n"
        lines = box_obj(*BOX).splitlines()
        vertices = [line[2:] for line in lines if line[0] == "v"]
        faces = [[int(w) - 1 for w in line.split()[1:]] for line in lines if line[0] == "f"]
        stl = "".join(facet % "".join("vertex " + vertices[v] + "\n" for v in f) for f in faces)
        strips = [" ".join(["3"] + [str(v) for v in f]) for f in faces]
        ply = ("ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
               "element tristrips 12\nproperty list int int vertex_indices\nend_header\n")
        ply += "\n".join(vertices + strips) + "\n"
        slashes = re.sub(r"(?m)^f (\d+) (\d+) (\d+)$", r"f \1// \2// \3//", box_obj(*BOX))
        for name, text, remark in (("a.stl", "solid\n" + stl + "end solid\n", "line 7: 'end loop' was read"),
                                   ("b.stl", "solid\n" + stl.replace("end loop", "endloop"), "without 'endsolid'"),
                                   ("c.obj", slashes, "line 9: '1//' names a texture"),
                                   ("d.ply", ply, "triangle strips were read as triangles")):
            self.write(name, text)
            result = self.mskit("info", name, "--json")
            self.assert_says(result, name, remark)
            self.assertEqual(len(result.err.splitlines()), 1, str(result))
            self.assert_close(result.json["volume"], VOLUME, 1e-12, "volume")


class MaxVoxels(Case):
    PLATE = ((0, 0, 0), (100, 100, 1))

    def grid(self, name, *flags):
        result = self.mskit("generate", name, "-g", "mss", "-n", 2, "--json", "-o", "c.csv", *flags)
        n = result.json["input"]["grid"]
        return n[0] * n[1] * n[2], result

    def test_a_plate(self):
        """At 40 cells of thickness it has 4004 x 4004 x 44 voxels; 3 cells make 304 x 304 x 7, 4 make 404 x 404 x 8."""
        self.write("plate.obj", box_obj(*self.PLATE))
        self.assert_refused("generate", "plate.obj", "--cells", 40, "--max-memory", "1G", code=1,
                            says=("--max-voxels",))
        voxels, result = self.grid("plate.obj", "--max-voxels", "1M")
        self.assertEqual(voxels, 304 * 304 * 7)
        self.assertNotIn("leaves", result.err)
        voxels, result = self.grid("plate.obj", "--max-voxels", "1000k", "--cells", 40)
        self.assertEqual(voxels, 304 * 304 * 7)
        self.assert_says(result,
                         "plate.obj: --max-voxels 1e+06 leaves 3 cells along the shortest side, of 40 asked for")
        for finer in (("--deq", 2000), ("--voxel-size", "0.01")):
            self.assertEqual(self.grid("plate.obj", "--max-voxels", 1e6, *finer)[0], 304 * 304 * 7)
        voxels, result = self.grid("plate.obj", "--max-voxels", 1e9, "--cells", 2)
        self.assertEqual(voxels, 204 * 204 * 6)
        self.assertNotIn("leaves", result.err)
        self.assert_refused("generate", "plate.obj", "--max-voxels", 1000, code=1,
                            says=("plate.obj", "1000 voxels are too few", "54080"))

    def test_other_commands(self):
        self.write("box.obj", box_obj(*BOX))
        self.write("c.csv", "x,y,z,r\n1,1,0.5,0.5\n")
        most = ("--max-voxels", 5000)  # 8 cells: 28 x 20 x 12 = 6720; 7 cells: 25 x 18 x 11 = 4950
        result = self.mskit("score", "c.csv", "--target", "box.obj", *most, "--json")
        self.assertEqual(result.json["target"]["voxels"], 7 ** 3 * VOLUME)
        result = self.mskit("compare", "box.obj", "-g", "mss", "-n", 2, "--cells", "5,40", *most, "-o", "compare.csv")
        self.assert_says(result, "leaves 7 cells along the shortest side, of 40 asked for")
        sizes = [float(row["voxel_size"]) for row in csv.DictReader(io.StringIO(self.read("compare.csv").decode()))]
        self.assertEqual([round(1 / h, 9) for h in sizes], [5, 7])
        self.mskit("scene", "box.obj", "-g", "mss", "--budget", 2, *most, "-o", "scene")
        result = self.mskit("stability", "box.obj", "-g", "mss", "-n", 2, "--perturb", "rotation", "--runs", 1, *most,
                            "-o", "stability.csv", "--json")
        self.assertIsNotNone(json.loads(result.out))
