"""Scans: grey values, spacings, raw files, and TIFF and NIfTI as other libraries write them."""
import csv
import io
import itertools
import json
import os
import struct
import unittest

from support import Case, npy

try:
    import numpy
    import tifffile
except ImportError:
    tifffile = None
try:
    import numpy
    import nibabel
except ImportError:
    nibabel = None

SIZE = (9, 7, 5)  # x, y, z


def read_csv(data):
    return list(csv.DictReader(io.StringIO(data.decode())))


def grey(x, y, z):
    """Two bright boxes, which share an edge, on a dark ground with a slope."""
    bright = (x < 4 and y < 3 and z < 3) or (4 <= x < 8 and 3 <= y < 6 and z < 3)
    return 100 + x + y if bright else 10 + z


def grey_values():
    return [grey(x, y, z) for z in range(SIZE[2]) for y in range(SIZE[1]) for x in range(SIZE[0])]


class Grey(Case):
    def setUp(self):
        super().setUp()
        self.write("grey.npy", npy(grey_values(), SIZE[::-1]))

    def labels(self, *args):
        return self.mskit("info", *args, "--json").json["labels"]

    def test_threshold_and_components(self):
        for connectivity, count in ((6, 2), (18, 1), (26, 1)):
            flags = ("grey.npy", "--threshold", 50, "--connectivity", connectivity)
            result = self.mskit("info", *flags, "--json")
            self.assert_says(result, f"grey.npy: {count} components of {connectivity} neighbours above 50")
            info = result.json
            self.assertEqual((info["segmentation"], info["threshold"], info["connectivity"]),
                             ("threshold", 50, connectivity))
            if count == 2:
                self.assertEqual([(l["voxels"], l["box_lo"], l["box_hi"]) for l in info["labels"]],
                                 [(36, [0, 0, 0], [4, 3, 3]), (36, [4, 3, 0], [8, 6, 3])])
            else:
                self.assertEqual(info["voxels"], 72)

    def test_otsu_is_in_the_record(self):
        """Halfway between the darkest bright and the brightest dark voxel; the same threshold gives the same."""
        record = self.mskit("generate", "grey.npy", "--otsu", "--connectivity", 6, "--label", 2, "-n", 3, "--json",
                            "-o", "a.csv").json["input"]
        self.assertEqual((record["segmentation"], record["threshold"], record["connectivity"], record["label"]),
                         ("otsu", (14 + 100) / 2, 6, 2))
        self.assertEqual(record["voxels"], 36)
        self.mskit("generate", "grey.npy", "--threshold", 57, "--connectivity", 6, "--label", 2, "-n", 3, "-o", "b.csv")
        self.assertEqual(self.read("a.csv"), self.read("b.csv"))
        score = self.mskit("score", "a.csv", "--target", "grey.npy", "--otsu", "--connectivity", 6, "--label", 2,
                           "--json")
        self.assertEqual(score.json["target"]["segmentation"], "otsu")

    def test_labels_stay_without_a_flag(self):
        self.assertEqual(len(self.labels("grey.npy")), len(set(grey_values())))
        record = self.mskit("generate", "grey.npy", "--label", 10, "-n", 2, "--json", "-o", "c.csv").json["input"]
        for key in ("segmentation", "threshold", "connectivity", "stored_spacing"):
            self.assertNotIn(key, record)

    def test_wrong_usage(self):
        for flags, says in ((("--threshold", 1, "--otsu"), "exclude"), (("--connectivity", 8), "none of 6, 18 and 26"),
                            (("--voxel-spacing", "1,2"), "three numbers"),
                            (("--voxel-spacing", "1,2,0"), "three numbers"),
                            (("--raw-size", "1,2,2.5"), "whole numbers"), (("--raw-type", "u12"), "no type of voxels"),
                            (("--threshold", "x"), "threshold")):
            self.assert_refused("generate", "grey.npy", *flags, code=2, says=(says,))
        self.mskit("shape", "ball", "-o", "ball.stl")
        self.assert_refused("generate", "ball.stl", "--otsu", code=1, says=("is a mesh", "--otsu"))
        self.assert_refused("generate", "grey.npy", "--threshold", 1000, code=1,
                            says=("no voxel is above 1000", "10 to 112"))

    def test_fractions_are_told_what_to_do(self):
        self.write("f.raw", struct.pack("<8f", *(0.5 * i for i in range(8))))
        raw = ("f.raw", "--raw-size", "2,2,2", "--raw-type", "f32")
        self.assert_refused("generate", *raw, code=1, says=("voxel (1, 0, 0) holds 0.5", "by a threshold, or otsu"))
        self.assertEqual(self.mskit("info", *raw, "--threshold", 1.9, "--json").json["voxels"], 4)


class Spacing(Case):
    def test_unequal_spacings(self):
        """Labels by the nearest voxel, said, and kept in the record."""
        self.write("v.raw", bytes([0, 1, 1, 0] * 3))
        flags = ("v.raw", "--raw-size", "4,3,1", "--raw-type", "u8", "--voxel-spacing", "1,2,3")
        result = self.mskit("info", *flags, "--json")
        self.assert_says(result,
                         "its voxels are 1 x 2 x 3; resampled to 4 x 6 x 3 cubes of 1 (the nearest voxel's label)")
        self.assertEqual((result.json["voxels"], result.json["stored_spacing"], result.json["resampling"]),
                         (2 * 6 * 3, [1, 2, 3], "nearest"))
        self.assertEqual((result.json["box_lo"], result.json["box_hi"]), ([0.5, -1, -1.5], [2.5, 5, 1.5]))
        record = self.mskit("generate", *flags, "-n", 2, "--json", "-o", "c.csv").json["input"]
        self.assertEqual((record["voxel_size"], record["stored_spacing"]), (1, [1, 2, 3]))
        result = self.mskit("info", *flags, "--threshold", 0.6, "--json")
        self.assert_says(result, "(linear)")
        self.assertEqual(result.json["resampling"], "linear")


class Large(Case):
    def test_a_large_volume_is_not_in_memory(self):
        """512^3 voxels of 16 bits, 268 MB and as labels 537: of both not more than a part."""
        n, grain, corner = 512, 6, 400
        with open(self.path("large.raw"), "wb") as f:
            for z, y in itertools.product(range(corner, corner + grain), repeat=2):
                f.seek(2 * ((z * n + y) * n + corner))
                f.write(struct.pack("<H", 7) * grain)
            f.truncate(2 * n**3)
        raw = ("large.raw", "--raw-size", f"{n},{n},{n}", "--raw-type", "u16")
        record = self.mskit("generate", *raw, "-n", 3, "--json", "-o", "c.csv", "--max-memory", "500M", "-j", "1").json
        self.assertEqual(record["input"]["voxels"], grain**3)
        self.assertLess(record["peak_memory_kb"], 120000)
        self.mskit("grains", *raw, "-n", 3, "-o", "all", "--max-memory", "500M")


def boxes():
    """Two labels in a volume without symmetry."""
    v = numpy.zeros(SIZE[::-1], dtype=numpy.uint8)
    v[1:4, 1:3, 2:8] = 3
    v[0:2, 4:7, 0:3] = 9
    return v


class Listed(Case):
    """Compares what is listed of a volume with that of the same voxels in .npy."""

    def setUp(self):
        super().setUp()
        self.write("truth.npy", npy([int(l) for l in boxes().flat], SIZE[::-1]))
        self.truth = self.mskit("info", "truth.npy", "--json").json

    def rows(self, name):
        return read_csv(self.read(name))

    def listed(self, *args):
        result = self.mskit("info", *args, "--json", code=None)
        if "built without" in result.err:
            self.skipTest(result.err.strip())
        self.assertEqual(result.code, 0, result)
        return result.json

    def assert_same(self, *args):
        info = self.listed(*args)
        for key in ("n", "labels"):
            self.assertEqual(info[key], self.truth[key], f"{key} of {args}")
        return info


@unittest.skipUnless(tifffile, "tifffile is not installed (package python3-tifffile)")
class Tiff(Listed):
    def test_every_type_and_layout(self):
        layouts = ({}, {"bigtiff": True}, {"byteorder": ">"}, {"compression": "zlib"}, {"rowsperstrip": 2},
                   {"tile": (16, 16)}, {"imagej": True})
        for kind in ("u1", "u2", "u4", "i1", "i2", "i4", "f4"):
            for layout in layouts:
                if "imagej" in layout and kind not in ("u1", "u2", "f4"):
                    continue  # which ImageJ does not have
                tifffile.imwrite(self.path("v.tif"), boxes().astype(kind), photometric="minisblack", **layout)
                with self.subTest(kind=kind, layout=layout):
                    self.assert_same("v.tif")

    def test_spacings_of_imagej(self):
        tifffile.imwrite(self.path("v.tif"), boxes(), imagej=True, resolution=(4, 4),
                         metadata={"spacing": 0.25, "unit": "um"})
        self.assertEqual(self.assert_same("v.tif")["spacing"], 0.25)

    def test_a_folder_of_slices(self):
        os.mkdir(self.path("slices"))
        for z, page in enumerate(boxes()):
            tifffile.imwrite(self.path(f"slices/scan {z + 8}.tif"), page, photometric="minisblack")  # 8, 9, 10, ...
        self.assert_same("slices")
        self.assert_same("slices/")
        self.mskit("grains", "slices/", "-n", 2, "-o", "clumps")
        rows = self.rows("clumps/grains.csv")
        self.assertEqual([(row["source"], row["label"], row["status"]) for row in rows],
                         [("slices/", "3", "ok"), ("slices/", "9", "ok")])
        self.assertTrue(os.path.exists(self.path("clumps/" + rows[0]["file"])), rows[0])
        self.assertIn("slices-3", rows[0]["file"])

    def test_grey_values(self):
        values = numpy.array(grey_values(), dtype=numpy.uint16).reshape(SIZE[::-1])
        tifffile.imwrite(self.path("g.tif"), values, photometric="minisblack")
        self.assertEqual([l["voxels"] for l in self.listed("g.tif", "--otsu", "--connectivity", 6)["labels"]], [36, 36])

    def test_colours_are_refused(self):
        self.assert_same_build()
        tifffile.imwrite(self.path("c.tif"), numpy.zeros((4, 4, 3), dtype=numpy.uint8), photometric="rgb")
        self.assert_refused("info", "c.tif", code=1, says=("3 channels", "colours"))

    def assert_same_build(self):
        tifffile.imwrite(self.path("v.tif"), boxes(), photometric="minisblack")
        self.assert_same("v.tif")


@unittest.skipUnless(nibabel, "nibabel is not installed (package python3-nibabel)")
class Nifti(Listed):
    def write_nifti(self, name, kind="u1", affine=None, image=None):
        affine = numpy.eye(4) if affine is None else affine
        image = (image or nibabel.Nifti1Image)(boxes().T.astype(kind), affine)  # [x][y][z]
        nibabel.save(image, self.path(name))

    def test_every_type(self):
        for kind in ("u1", "i1", "u2", "i2", "u4", "i4", "f4", "f8"):
            for name in ("v.nii", "v.nii.gz"):
                self.write_nifti(name, kind)
                with self.subTest(kind=kind, name=name):
                    self.assert_same(name)

    def test_every_way_that_axes_lead(self):
        """The centroid of a label lies where nibabel's affine puts it, and its box has the extents that it should."""
        voxels = numpy.argwhere(boxes().T == 3)
        for order in itertools.permutations(range(3)):
            for signs in itertools.product((-1, 1), repeat=3):
                affine = numpy.eye(4)
                affine[:3, :3] = 0
                for axis in range(3):
                    affine[order[axis], axis] = 0.5 * signs[axis]
                affine[:3, 3] = 10, -20, 30
                self.write_nifti("v.nii", affine=affine)
                info = self.listed("v.nii", "--label", "3")
                places = nibabel.affines.apply_affine(affine, voxels)
                for axis in range(3):
                    self.assert_close(info["centroid"][axis], places.mean(axis=0)[axis], 1e-6, f"{order} {signs}")
                    self.assert_close(info["box_lo"][axis], places.min(axis=0)[axis] - 0.25, 1e-6, f"{order} {signs}")
                    self.assert_close(info["box_hi"][axis], places.max(axis=0)[axis] + 0.25, 1e-6, f"{order} {signs}")

    def test_oblique_and_others_are_refused(self):
        affine = numpy.eye(4)
        affine[0, 1] = 0.1
        self.write_nifti("v.nii")
        self.assert_same("v.nii")
        self.write_nifti("o.nii", affine=affine)
        self.assert_refused("info", "o.nii", code=1, says=("oblique by its sform",))
        self.write_nifti("two.nii", image=nibabel.Nifti2Image)
        self.assert_refused("info", "two.nii", code=1, says=("NIfTI-2 is not read",))

    def test_names_of_packed_volumes(self):
        self.write_nifti("scan.nii.gz")
        self.listed("scan.nii.gz")
        self.mskit("grains", "scan.nii.gz", "-n", 2, "-o", "clumps")
        self.assertEqual([os.path.basename(row["file"]) for row in self.rows("clumps/grains.csv")],
                         ["scan-3.csv", "scan-9.csv"])


class Pieces(Case):
    def test_largest_piece(self):
        """Of a label in three pieces the largest alone becomes a clump; the row still says three."""
        size = (14, 6, 6)
        def label(x, y, z):
            return 5 if (x < 2 or 4 <= x < 10 or x == 13) and y < 5 and z < 5 else 0
        self.write("v.npy", npy([label(x, y, z) for z in range(6) for y in range(6) for x in range(14)], size[::-1]))
        for flags, voxels in (((), 2 * 25 + 6 * 25 + 25), (("--largest-piece",), 6 * 25)):
            name = f"clumps{len(flags)}"
            self.mskit("grains", "v.npy", "-n", 2, "-o", name, "--format", "json", *flags)
            table = self.read(name + "/grains.csv")
            row, = read_csv(table)
            header, _ = csv.reader(io.StringIO(table.decode()))
            self.assertEqual(len(header), len(row), "no two columns of one name")
            self.assertEqual((row["status"], row["shape_pieces"], float(row["volume"])), ("ok", "3", voxels))
            with open(self.path(name + "/" + row["file"]), encoding="utf-8") as f:
                record = json.load(f)["input"]
            self.assertEqual(record["voxels"], voxels)
            self.assertEqual(record.get("largest_piece"), True if flags else None)
