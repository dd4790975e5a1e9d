"""Labelled voxel volumes: the label, the frame, the unit; small files made here and one real scan."""
import array
import math
import struct
import sys

from support import Case, npy, shared_file

# Extents x, y, z of the volume and boxes of the two labels in it, as half-open ranges of voxels.
SIZE = (24, 20, 16)
BOXES = {1: ((1, 5), (1, 4), (1, 3)), 2: ((8, 20), (6, 16), (4, 12))}
VOXELS = {1: 4 * 3 * 2, 2: 12 * 10 * 8}
CENTRE = {2: (13.5, 10.5, 7.5)}  # mean of the voxels' centres, which are at whole numbers


def labels(wanted=(1, 2)):
    """In order of memory, x fastest."""
    def at(*voxel):
        for label in wanted:
            if all(lo <= v < hi for v, (lo, hi) in zip(voxel, BOXES[label])):
                return label
        return 0
    return [at(i, j, k) for k in range(SIZE[2]) for j in range(SIZE[1]) for i in range(SIZE[0])]


class Volume(Case):
    def setUp(self):
        super().setUp()
        self.write("two.npy", npy(labels(), SIZE[::-1]))
        self.write("one.npy", npy(labels((2,)), SIZE[::-1]))

    def test_several_labels_need_a_choice(self):
        self.write("c.csv", "10,10,8,3\n")
        for command in (("generate", "two.npy"), ("score", "c.csv", "--target", "two.npy")):
            self.assert_refused(*command, code=1, says=("several labels", "--label"))

    def test_a_label_that_is_not_there(self):
        self.assert_refused("info", "two.npy", "--label", "3", code=1, says=("label 3",))
        self.assert_refused("generate", "two.npy", "--label", "3", code=1, says=("label 3",))

    def test_info(self):
        for name, flags, label in (("one.npy", (), 2), ("two.npy", ("--label", "2"), 2),
                                   ("two.npy", ("--label", "1"), 1)):
            info = self.mskit("info", name, *flags, "--json").json
            self.assertEqual((info["voxels"], info["volume"]), (VOXELS[label], VOXELS[label]))
            self.assertEqual(info["box_lo"], [lo - 0.5 for lo, _ in BOXES[label]])
            self.assertEqual(info["box_hi"], [hi - 0.5 for _, hi in BOXES[label]])
        info = self.mskit("info", "one.npy", "--json").json
        for axis in range(3):
            self.assert_close(info["centroid"][axis], CENTRE[2][axis], 1e-12, "centroid")
            side = [hi - lo for lo, hi in BOXES[2]]
            others = [side[a] ** 2 for a in range(3) if a != axis]
            self.assert_close(info["inertia"][axis][axis], VOXELS[2] * sum(others) / 12, 1e-12, "moment of a cuboid")
        a, b, c = (hi - lo for lo, hi in BOXES[2])
        self.assert_close(info["area"], 2 * (a * b + b * c + a * c), 0.1, "area, edges rounded off")
        self.assert_close(info["elongation"], b / a, 1e-12, "elongation of a cuboid")
        self.assert_close(info["flatness"], c / b, 1e-12, "flatness of a cuboid")

    def test_one_voxel(self):
        """Of so few the area is not known, nor what hangs on it: left out, as in JSON."""
        self.write("voxel.npy", npy(b"\1", (1, 1, 1)))
        run = self.mskit("generate", "voxel.npy", "-g", "mss", "-n", "1", "-o", "a.csv")
        self.assertNotIn("nan", run.out + run.err)
        self.assertNotIn("voxel limit", run.out + run.err)

    def test_info_lists_the_labels(self):
        """Of several labels each has a line: voxels, box, pieces, and whether the border cuts it."""
        listed = labels()
        listed[0] = 2  # a voxel in the corner, apart from the others
        self.write("cut.npy", npy(listed, SIZE[::-1]))
        info = self.mskit("info", "cut.npy", "--json").json
        self.assertEqual((info["n"], info["spacing"], info["origin"]), (list(SIZE), 1, [0, 0, 0]))
        self.assert_refused("info", "cut.npy", "--expect", code=2, says=("--expect is of one shape; give --label L",))
        (lo, hi), first = zip(*BOXES[1]), {"label": 1, "voxels": VOXELS[1], "pieces": 1, "largest_piece": VOXELS[1]}
        self.assertEqual(info["labels"][0], {**first, "box_lo": list(lo), "box_hi": list(hi), "cut_by_border": False})
        self.assertEqual(info["labels"][1], {"label": 2, "voxels": VOXELS[2] + 1, "box_lo": [0, 0, 0],
                                             "box_hi": [hi for _, hi in BOXES[2]], "pieces": 2,
                                             "largest_piece": VOXELS[2], "cut_by_border": True})
        out = self.mskit("info", "cut.npy").out
        self.assertIn("2 labels", out)
        self.assertRegex(out, f"(?m)^ +2 +{VOXELS[2] + 1} +0,0,0 +20,16,12 +2 +cuts it$")
        self.assertRegex(out, f"(?m)^ +1 +{VOXELS[1]} +1,1,1 +4,3,2 +1 +$")

    def test_a_label_in_pieces(self):
        """A grain is one piece: what touches nowhere is said, with the size of the largest piece."""
        self.write("both.npy", npy([min(label, 1) for label in labels()], SIZE[::-1]))
        info = self.mskit("info", "both.npy", "--json").json
        self.assertEqual((info["pieces"], info["largest_piece"], info["voxels"]), (2, VOXELS[2], VOXELS[1] + VOXELS[2]))
        self.assertRegex(self.mskit("info", "both.npy").out, f"pieces +2 .*largest of {VOXELS[2]} voxels")
        self.write("c.csv", "10,10,8,3\n")
        for command in (("generate", "both.npy", "-n", "3", "-o", "-"), ("score", "c.csv", "--target", "both.npy")):
            self.assert_says(self.mskit(*command), "both.npy: the label is in 2 pieces", f"largest of {VOXELS[2]} of")
        info = self.mskit("info", "one.npy", "--json").json
        self.assertEqual((info["pieces"], info["largest_piece"]), (1, VOXELS[2]))
        self.assertNotIn("pieces", self.mskit("generate", "one.npy", "-n", "3", "-o", "-").err)

    def test_fortran_order(self):
        """[x][y][z] with x fastest is the same volume."""
        self.write("fortran.npy", npy(labels(), SIZE, fortran=True))
        info = [self.mskit("info", name, "--label", "2", "--json").json for name in ("fortran.npy", "two.npy")]
        self.assertEqual(info[0]["centroid"], info[1]["centroid"])

    def test_generate_in_the_frame_of_the_volume(self):
        result = self.mskit("generate", "two.npy", "--label", "2", "-n", "6", "--json", "-j", "1", "-o", "c.csv")
        record = result.json
        self.assertEqual(record["input"]["label"], 2)
        self.assertEqual((record["input"]["voxel_size"], record["input"]["voxels"]), (1, VOXELS[2]))
        self.assert_says(result, "grid: 16x14x12 voxels")
        self.check_spheres((0, 0, 0), 1)
        self.assertGreater(record["scores"]["coverage"], 0.6)
        self.assertIsNone(record["scores"]["protrusion_max"], "there is no mesh to stick out of")
        again = self.mskit("score", "c.csv", "--target", "two.npy", "--label", "2", "--json").json
        self.assertEqual(again["scores"], record["scores"])
        self.mskit("generate", "one.npy", "-n", "6", "-j", "1", "-o", "one.csv")
        self.assertEqual(self.read("one.csv"), self.read("c.csv"), "the other label makes no difference")

    def check_spheres(self, origin, spacing):
        spheres = self.spheres("c.csv")
        self.assertEqual(len(spheres), 6)
        for axis, (lo, hi) in enumerate(BOXES[2]):
            faces = [origin[axis] + spacing * (lo - 0.5), origin[axis] + spacing * (hi - 0.5)]
            for sphere in spheres:
                # Radii are distances to centres of voxels of the background, half a voxel behind the face, found to
                # half a voxel.
                self.assertGreaterEqual(sphere[axis] - sphere[3], faces[0] - spacing, f"axis {axis}: {sphere}")
                self.assertLessEqual(sphere[axis] + sphere[3], faces[1] + spacing, f"axis {axis}: {sphere}")

    def test_spacing_and_origin(self):
        """MetaImage: spheres come in its unit, from its origin."""
        origin, spacing = (10.0, -20.0, 30.0), 0.25
        self.write("v.raw", struct.pack(f"<{len(labels())}H", *labels()))
        self.write("v.mhd", f"ObjectType = Image\nNDims = 3\nDimSize = {SIZE[0]} {SIZE[1]} {SIZE[2]}\n"
                   f"ElementSpacing = {spacing} {spacing} {spacing}\nOffset = {origin[0]} {origin[1]} {origin[2]}\n"
                   "ElementType = MET_USHORT\nElementByteOrderMSB = False\nElementDataFile = v.raw\n")
        info = self.mskit("info", "v.mhd", "--label", "2", "--json").json
        self.assert_close(info["volume"], VOXELS[2] * spacing**3, 1e-12, "volume")
        for axis in range(3):
            self.assert_close(info["centroid"][axis], origin[axis] + spacing * CENTRE[2][axis], 1e-12, "centroid")
        self.mskit("generate", "v.mhd", "--label", "2", "-n", "6", "-j", "1", "-o", "c.csv")
        self.check_spheres(origin, spacing)

    def test_flags_that_do_not_apply(self):
        for flag, value in (("--cells", "20"), ("--deq", "20"), ("--voxel-size", "0.5")):
            self.assert_refused("generate", "one.npy", flag, value, code=1, says=("voxels of its own", flag))
        self.assert_refused("generate", "one.npy", "-g", "mss", "--confine", code=1, says=("confine", "closed mesh"))

    def test_rule_applies_to_the_union(self):
        """Of the surface voxels of small balls, some are covered by more than half and not at their centre, or the
        other way round: the two rules cannot give the same union."""
        self.write("c.csv", "".join(f"{10 + 0.13 * i},{8 + 0.29 * i},{5.2 + 0.17 * i},1.3\n" for i in range(12)))
        volumes = {rule: self.mskit("score", "c.csv", "--target", "one.npy", "--rule", rule, "--json").json
                   for rule in ("half", "centre")}
        self.assertEqual([volumes[rule]["target"]["rule"] for rule in ("half", "centre")], ["half", "centre"])
        self.assertNotEqual(volumes["half"]["scores"]["volume"], volumes["centre"]["scores"]["volume"])


class Scan(Case):
    """The labelled CT scan of the shared data, in its three formats."""

    def count(self):
        """Voxels per label and the label of median size, counted here."""
        words = array.array("H")
        with open(shared_file("nmc_ct_labels.raw"), "rb") as f:
            words.frombytes(f.read())
        if sys.byteorder == "big":
            words.byteswap()
        size = {}
        for label in words:
            size[label] = size.get(label, 0) + 1
        del size[0]
        label = sorted(size, key=lambda l: (size[l], l))[len(size) // 2]
        return words, size, label

    def test_median_grain(self):
        words, size, label = self.count()
        self.assertEqual((len(words), len(size)), (128**3, 192), "as MANIFEST.md says")
        voxels = [at for at, value in enumerate(words) if value == label]
        centroid = [sum(at // 128**axis % 128 for at in voxels) / len(voxels) for axis in range(3)]
        for ending in ("npy", "mhd", "nrrd"):
            path = shared_file("nmc_ct_labels." + ending)
            self.assert_refused("generate", path, code=1, says=("several labels", "--label"))
            info = self.mskit("info", path, "--label", label, "--json").json
            self.assertEqual((info["voxels"], info["volume"]), (len(voxels), len(voxels)), ending)
            for axis in range(3):
                self.assert_close(info["centroid"][axis], centroid[axis], 1e-9, f"centroid of {ending}")
        record = self.mskit("generate", path, "--label", label, "-n", "20", "-j", "1", "--json", "-o", "c.csv").json
        self.assertEqual(record["input"]["voxels"], len(voxels))
        self.assertLess(record["scores"]["dice"], 0.25)
        reach = 1.5 + max(math.dist(centroid, [at // 128**axis % 128 for axis in range(3)]) for at in voxels)
        for x, y, z, r in self.spheres("c.csv"):
            self.assertLess(math.dist(centroid, (x, y, z)) + r, reach + 1, "spheres lie in the frame of the volume")
