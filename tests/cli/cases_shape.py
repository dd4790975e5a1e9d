"""mskit shape and mskit info: bodies whose volume and inertia are known by formula."""
import math
import re

from support import Case, box_obj

PI = math.pi

# Kind, parameters, exact volume, exact principal moments (ascending; None where not derived here).
# Vertices of curved bodies lie on the surface: the header promises volumes within 0.1 %.
KINDS = (
    ("ball", ("r=1.3",), 4 / 3 * PI * 1.3**3, [0.4 * 1.3**2] * 3),
    ("ellipsoid", ("a=2.1", "b=1.2", "c=0.7"), 4 / 3 * PI * 2.1 * 1.2 * 0.7,
     [(1.2**2 + 0.7**2) / 5, (2.1**2 + 0.7**2) / 5, (2.1**2 + 1.2**2) / 5]),
    ("hollow", ("R=1.3", "r=0.6"), 4 / 3 * PI * (1.3**3 - 0.6**3), [0.4 * (1.3**5 - 0.6**5) / (1.3**3 - 0.6**3)] * 3),
    ("tablet", ("band_radius=2", "band_height=1.1", "cap_height=0.4"),
     PI * 2**2 * 1.1 + 2 * PI * 0.4 / 6 * (3 * 2**2 + 0.4**2), None),
    ("torus", ("R=3.1", "r=0.9"), 2 * PI**2 * 3.1 * 0.9**2,
     [0.5 * 3.1**2 + 0.625 * 0.9**2] * 2 + [3.1**2 + 0.75 * 0.9**2]),
    ("needle", ("length=11", "r=0.7"), PI * 0.7**2 * (11 - 1.4) + 4 / 3 * PI * 0.7**3, None),
    ("cylinder", ("r=1.2", "h=3.1"), PI * 1.2**2 * 3.1, [1.2**2 / 2] + [(3 * 1.2**2 + 3.1**2) / 12] * 2),
    ("cone", ("r=1.2", "h=3.1"), PI * 1.2**2 * 3.1 / 3,
     [0.3 * 1.2**2] + [3 / 80 * (4 * 1.2**2 + 3.1**2)] * 2),
    ("dumbbell", ("R=1.1", "distance=3.5", "neck=0.3"), None, None),
    ("bowl", ("R=1.2", "wall=0.3"), 2 / 3 * PI * (1.2**3 - 0.9**3), None),
    ("cross", ("length=7", "width=1.5"), 3 * 7 * 1.5**2 - 2 * 1.5**3, None),
    ("cube", ("a=1.7",), 1.7**3, [1.7**2 / 6] * 3),
    ("box", ("a=3", "b=2", "c=1"), 6, [(2**2 + 1) / 12, (3**2 + 1) / 12, (3**2 + 2**2) / 12]),
    ("plate", ("a=5", "b=4", "c=0.1"), 2, [(16 + 0.01) / 12, (25 + 0.01) / 12, (25 + 16) / 12]),
    ("tetrahedron", ("a=1.7",), 1.7**3 / (6 * math.sqrt(2)), [1.7**2 / 20] * 3),
    ("octahedron", ("a=1.7",), 4 / 3 * 1.7**3, [1.7**2 / 5] * 3),
    ("grain", ("r=1.2",), 4 / 3 * PI * 1.2**3, None),
)
FLAT = ("cross", "cube", "box", "plate", "tetrahedron", "octahedron", "grain")  # a grain is scaled to its volume


def dumbbell_volume(ball, distance, neck):
    """Two balls less the two caps that lie in the neck, and the neck between the circles where they meet."""
    reach = math.sqrt(ball**2 - neck**2)
    cap = ball - reach
    return 2 * (4 / 3 * PI * ball**3 - PI * cap**2 / 3 * (3 * ball - cap)) + PI * neck**2 * (distance - 2 * reach)


class Shapes(Case):
    def test_every_kind_is_in_the_list(self):
        listed = re.findall(r"(?m)^(\w+): ", self.mskit("shape", "--list").out)
        self.assertEqual(sorted(listed), sorted(kind for kind, *_ in KINDS))

    def test_volume_and_moments(self):
        for kind, parameters, volume, moments in KINDS:
            with self.subTest(kind=kind):
                name = self.shape(kind, *parameters, name=kind + ".ply")
                info = self.mskit("info", name, "--json").json
                if kind == "dumbbell":
                    volume = dumbbell_volume(1.1, 3.5, 0.3)
                tolerance = 1e-6 if kind in FLAT else 1e-3  # 1e-6: coordinates may be written as 32-bit floats
                self.assertTrue(info["closed"])
                self.assertEqual((info["open_edges"], info["nonmanifold_edges"], info["bodies"]), (0, 0, 1))
                self.assertEqual(info["cavities"], 1 if kind == "hollow" else 0)
                self.assertEqual(info["dropped_degenerate"] + info["dropped_duplicate"] + info["turned"], 0)
                self.assert_close(info["volume"], volume, tolerance, "volume")
                self.assert_close(info["equivalent_diameter"], (6 * volume / PI) ** (1 / 3), tolerance, "diameter")
                for axis in range(3):
                    self.assertLess(abs(info["centroid"][axis]), 1e-6 * info["equivalent_diameter"])
                    if moments:
                        # A moment goes with the fifth power of a length, the volume with the third.
                        self.assert_close(info["principal_moments"][axis], moments[axis] * volume, 2 * tolerance,
                                          f"moment {axis}")

    def test_every_format_holds_the_same_mesh(self):
        infos = []
        for ending in ("stl", "obj", "ply", "off"):
            name = self.shape("torus", "fineness=6", name="torus." + ending)
            infos.append(self.mskit("info", name, "--json").json)
        self.write("stdout.off", self.mskit("shape", "torus", "fineness=6", "-o", "-").out)
        infos.append(self.mskit("info", "stdout.off", "--json").json)
        for info in infos[1:]:
            self.assertEqual(info["triangles"], infos[0]["triangles"])
            self.assertEqual(info["vertices"], infos[0]["vertices"])
            self.assert_close(info["volume"], infos[0]["volume"], 1e-6, info["path"])  # STL: 32-bit floats

    def test_the_same_seed_gives_the_same_grain(self):
        same = [self.shape("grain", "seed=7", "fineness=8", name=f"{i}.off") for i in range(2)]
        other = self.shape("grain", "seed=8", "fineness=8", name="other.off")
        self.assertEqual(self.read(same[0]), self.read(same[1]))
        self.assertNotEqual(self.read(same[0]), self.read(other))

    def test_parameters_out_of_range(self):
        for args, says in (
            (("ball", "r=0"), ("r = 0",)), (("ball", "r=-1"), ("r = -1",)), (("ball", "r=nan"), ("r = nan",)),
            (("ball", "r=inf"), ("r = inf",)), (("ball", "r=1e300"), ("1e+12",)),
            (("ball", "fineness=1"), ("fineness = 1", "2 to 512")), (("ball", "fineness=513"), ("2 to 512",)),
            (("ball", "fineness=2.5"), ("whole",)), (("torus", "R=1", "r=2"), ("r = 2", "R = 1")),
            (("hollow", "R=1", "r=1"), ("r",)), (("needle", "length=1", "r=1"), ("length",)),
            (("dumbbell", "neck=2"), ("neck",)), (("box", "a=1e6", "b=1e-3"), ("too unlike",)),
            (("grain", "noise=2"), ("noise = 2",)), (("grain", "seed=-1"), ("seed",)),
            (("grain", "degree=2.5"), ("whole",)),
        ):
            with self.subTest(args=args):
                self.assert_refused("shape", *args, "-o", "x.stl", code=1, says=says)
        self.assert_refused("shape", "ball", "r=big", "-o", "x.stl", code=2, says=("big is not a number",))
        self.assert_refused("shape", "ball", "r=", "-o", "x.stl", code=2, says=("is not a number",))


class Info(Case):
    def test_box_off_the_origin(self):
        """A cuboid of 3 x 2 x 1 that is written here, at (10, 20, 30)."""
        self.write("box.obj", box_obj((10, 20, 30), (13, 22, 31)))
        info = self.mskit("info", "box.obj", "--json").json
        moments = [6 * 5 / 12, 6 * 10 / 12, 6 * 13 / 12]  # about x, y, z
        self.assertEqual(info["path"], "box.obj")
        self.assertEqual((info["triangles"], info["vertices"], info["shells"]), (12, 8, 1))
        self.assertEqual((info["box_lo"], info["box_hi"]), ([10, 20, 30], [13, 22, 31]))
        self.assert_close(info["area"], 22, 1e-12, "area")
        self.assert_close(info["volume"], 6, 1e-12, "volume")
        self.assert_close(info["sphericity"], PI ** (1 / 3) * 36 ** (2 / 3) / 22, 1e-12, "sphericity")
        for row in range(3):
            self.assert_close(info["centroid"][row], (11.5, 21, 30.5)[row], 1e-12, "centroid")
            self.assert_close(info["principal_moments"][row], moments[row], 1e-12, "moment")
            for column in range(3):
                truth = moments[row] if row == column else 0
                self.assertAlmostEqual(info["inertia"][row][column], truth, delta=1e-11)
                self.assertAlmostEqual(abs(info["principal_axes"][row][column]), float(row == column), delta=1e-9)

    def test_table(self):
        """The table says what the JSON says."""
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))
        table = self.mskit("info", "box.obj").out
        rows = dict(re.findall(r"(?m)^  (\w[\w ()-]*?)  +(\S.*)$", table))
        self.assertEqual(table.splitlines()[0], "box.obj")
        for name, value in (("closed", "yes"), ("open edges", "0"), ("volume", "6"), ("area", "22"),
                            ("box from", "0 0 0"), ("box size", "3 2 1"), ("bodies", "1 (0 cavities)"),
                            ("centroid", "1.5 1 0.5"), ("principal moments", "2.5 5 6.5")):
            self.assertEqual(rows[name], value, f"row '{name}' of\n{table}")

    def test_open_mesh(self):
        """A cuboid of which one triangle is missing has three open edges and no volume."""
        self.write("open.obj", box_obj((0, 0, 0), (3, 2, 1), skip=1))
        info = self.mskit("info", "open.obj", "--json").json
        self.assertFalse(info["closed"])
        self.assertEqual(info["open_edges"], 3)
        self.assertNotIn("volume", info)
        self.assertIsNone(info["sphericity"])
        self.assertRegex(self.mskit("info", "open.obj").out, r"open edges +3\n")

    def test_huge_and_tiny_bodies(self):
        """Inertia goes with the fifth power of a length: what would overflow is refused, not computed forever."""
        for size in (1e-30, 1e-9, 1e9, 1e30):
            self.write("box.obj", box_obj((0, 0, 0), (3 * size, 2 * size, size)))
            info = self.mskit("info", "box.obj", "--json").json
            self.assert_close(info["volume"], 6 * size**3, 1e-12, f"volume at {size}")
            self.assert_close(info["principal_moments"][0], 2.5 * size**5, 1e-12, f"moment at {size}")
        for size in (1e-320, 1e-100, 1e100, 1e300):
            self.write("box.obj", box_obj((0, 0, 0), (3 * size, 2 * size, size)))
            self.assert_refused("info", "box.obj", code=1, says=("box.obj", "choose another unit"))
            self.assert_refused("generate", "box.obj", code=1, says=("box.obj", "choose another unit"))
