"""mskit info on every file of the shared data: what MANIFEST.md there says of it."""
import os

from support import Case, shared_file

# File, volume, area, box and Wadell's sphericity as MANIFEST.md gives them, made by another program.
MESHES = (
    ("asteroid_castalia.obj", 0.6678, 4.256, (1.626, 0.9981, 0.8431), 0.868),
    ("boulder_SP2B.stl", 0.6805, 4.509, (1.593, 0.8827, 1.314), 0.830),
    ("bunny.ply", 0.0007539, 0.05821, (0.1558, 0.1544, 0.1208), 0.688),
    ("ellipsoid_2_1_1.stl", 8.373, 21.47, (4, 2, 2), 0.929),
    ("human_femur.stl", 1.256e5, 1.794e4, (75.88, 63.29, 124), 0.676),
    ("lithic_flake2.ply", 2.282e4, 5935, (40.86, 75.52, 22.56), 0.656),
    ("octahedron.stl", 1.333, 6.928, (2, 2, 2), 0.846),
    ("pear.stl", 299.1, 237.1, (8.168, 7.928, 12.4), 0.912),
    ("powder_ma165_03636.stl", 1.641e4, 3915, (40.9, 35.76, 29.73), 0.798),
    ("sand_grain.stl", 5.598e5, 3.591e4, (117.8, 134.3, 87.11), 0.915),
    ("torus.stl", 59.18, 118.4, (8, 8, 2), 0.620),
)

# Broken files that must be refused, and words that the message needs.
REFUSED = (
    ("01_truncated_binary.stl", ("617 of 1000", "50084", "30957")),
    ("04_count_4294967295.stl", ("4294967295", "5084")),
    ("05_ascii_junk.stl", ("line 4", "abc")),
    ("06_nan_inf.stl", ("3 of 1000", "not finite")),
    ("07_zero_triangles_binary.stl", ("no triangles",)),
    ("20_empty.stl", ("empty",)),
    ("21_bad_header.ply", ("line 2", "format")),
    ("26_points_only.ply", ("no faces", "5 points")),
    ("v1_all_background.npy", ("no label",)),
    ("v3_grey_float_nan.npy", ("no label", "labels of grey values")),
    ("v4_truncated.npy", ("16000", "8872")),
    ("v7_missing_raw.mhd", ("does_not_exist.raw",)),
)

# Odd files that must load: what to look for, volume, remarks.
LOADED = (
    ("09_degenerate_duplicate_tris.stl", {"closed": True, "bodies": 1}, 5.598e5, ("degenerate", "duplicate")),
    ("10_inverted_normals.stl", {"closed": True, "turned": 1000}, 5.598e5, ("turned 1000",)),
    ("15_two_disjoint_bodies.stl", {"closed": True, "bodies": 2}, 6.298e5, ("2 separate bodies",)),
    ("17_offset_1e9_double.obj", {"closed": True, "triangles": 1000}, 5.598e5, ()),
    ("24_binary_starting_with_solid.stl", {"closed": True, "triangles": 1000}, 5.598e5, ()),
    ("12_open_mesh.stl", {"closed": False, "open_edges": 36}, None, ()),
)


# Inputs of data/cases that passed without a word, and words that the message needs; right answers as MANIFEST.md there.
CASES_REFUSED = (
    ("comp_badsum.mha", ("info", "comp_badsum.mha"), ("checksum",)),
    ("sp_tiny.mha", ("info", "sp_tiny.mha"), ("spacing", "1e-300")),
    ("up.mhd", ("info", "up.mhd"), ("line 5", "passwd", "folder")),
    ("h06_diameter_header.csv", ("score", "h06_diameter_header.csv", "--target", "h00_dimer.obj", "--cells", "20"),
     ("line 1", "'diameter'")),
    ("c_cols.json", ("score", "c_cols.json", "--target", "h00_dimer.obj", "--cells", "20"), ("columns", "x, y, z, r")),
)


class Data(Case):
    def test_cases_are_refused(self):
        for name, command, says in CASES_REFUSED:
            folder = os.path.dirname(shared_file("cases", name))
            args = [os.path.join(folder, word) if os.path.exists(os.path.join(folder, word)) else word
                    for word in command]
            with self.subTest(file=name):
                self.assert_refused(*args, code=1, says=(name, *says))

    def test_cases_that_are_read(self):
        info = self.mskit("info", shared_file("cases", "gz2.nrrd"), "--json").json
        self.assertEqual((info["voxels"], info["pieces"]), (140, 1))
        path = shared_file("cases", "g04_three_phase.npy")
        self.assertEqual(self.mskit("info", path, "--label", "2", "--json").json["pieces"], 2)
        self.assertRegex(self.mskit("info", path, "--label", "2").out, "pieces +2 ")

    def test_cases_that_are_mended(self):
        """Corners that stand several times, up to 1e-7 of the length apart in each coordinate, and bytes behind the
        last."""
        for name, remark, joined in (("b01_seam_1e-7.stl", "joined 1318 corners", 1318),
                                     ("a11_tail_newline.stl", "2 bytes behind the last of its 528 triangles", 0)):
            result = self.mskit("info", shared_file("cases", name), "--json")
            self.assert_says(result, name, remark)
            self.assertEqual((result.json["closed"], result.json["joined"], result.json["vertices"]),
                             (True, joined, 266))
            self.assert_close(result.json["volume"], 4.0706, 2e-5, "volume, of which five digits are known")
        self.assertFalse(self.mskit("info", shared_file("cases", "b01_seam_1e-7.stl"), "--weld", "0",
                                    "--json").json["closed"])

    def test_meshes(self):
        for name, volume, area, box, sphericity in MESHES:
            path = shared_file(name)
            with self.subTest(file=name):
                info = self.mskit("info", path, "--json").json
                self.assertTrue(info["closed"])
                self.assert_close(info["volume"], volume, 6e-4, "volume, of which four digits are known")
                self.assert_close(info["area"], area, 6e-4, "area")
                self.assertAlmostEqual(info["sphericity"], sphericity, delta=1e-3)
                for axis in range(3):
                    self.assert_close(info["box_hi"][axis] - info["box_lo"][axis], box[axis], 2e-3, "box")

    def test_refused(self):
        for name, says in REFUSED:
            path = shared_file("bad", name)
            with self.subTest(file=name):
                for command in ("info", "generate"):
                    result = self.assert_refused(command, path, code=1, says=(name, *says))
                    self.assertEqual(len(result.err.splitlines()), 1, f"one sentence\n{result}")

    def test_loaded(self):
        for name, facts, volume, remarks in LOADED:
            path = shared_file("bad", name)
            with self.subTest(file=name):
                result = self.mskit("info", path, "--json")
                self.assert_says(result, *remarks)
                for key, value in facts.items():
                    self.assertEqual(result.json[key], value, f"{key}\n{result}")
                if volume:
                    self.assert_close(result.json["volume"], volume, 6e-4, "volume")

    def test_open_mesh(self):
        path = shared_file("bad", "12_open_mesh.stl")
        self.assert_refused("generate", path, code=1, says=("36 edges", "--allow-open", "--fill-holes 36"))
        info = self.mskit("info", path, "--fill-holes", 36, "--json").json
        self.assertTrue(info["closed"])
        self.assertEqual((info["filled_holes"], info["triangles"]), (1, 800 + 34))
        record = self.generate(path, "--allow-open", "--cells", "30", "-n", "5", "-o", "c.csv")
        self.assertFalse(record["input"]["closed"])
        self.assertEqual(len(self.spheres("c.csv")), 5)

    def test_far_from_the_origin(self):
        """The same grain 1e9 away gives the same clump there, within the rounding of such coordinates (1e-7)."""
        near = self.generate(shared_file("bad", "24_binary_starting_with_solid.stl"), "--cells", "30", "-n", "5", "-o",
                             "near.csv")
        far = self.generate(shared_file("bad", "17_offset_1e9_double.obj"), "--cells", "30", "-n", "5", "-o", "far.csv")
        self.assert_close(far["scores"]["dice"], near["scores"]["dice"], 0.01, "D")
        for a, b in zip(self.spheres("near.csv"), self.spheres("far.csv")):
            self.assert_close(b[3], a[3], 0.01, "radius")
            self.assertGreater(max(abs(c) for c in b[:3]), 0.9e9)

    def test_concave_polygons(self):
        """An L of hexagons has the area of an L, and the gap that the same L of triangles has."""
        self.write("c.csv", "x,y,z,r\n0.5,0.5,0.5,0.5\n2.5,0.5,0.5,0.5\n0.5,2.5,0.5,0.5\n")
        gaps = []
        for name in ("d02_L_ngon.obj", "d12_L_tri.obj"):
            path = shared_file("cases", name)
            info = self.mskit("info", path, "--json").json
            self.assert_close(info["area"], 22, 1e-12, "area")
            self.assert_close(info["volume"], 5, 1e-12, "volume")
            score = self.mskit("score", "c.csv", "--target", path, "--cells", 20, "--json").json["scores"]
            gaps.append(score["gap_max"])
        self.assert_close(gaps[0], gaps[1], 0.01, "gap")
