"""mskit generate: what a run does, where it stops, that it repeats to the last bit."""
import itertools
import json
import math

from support import TIMEOUT, Case, box_obj, fnv1a, read_obj, solid_angle, triangle_distance

ELLIPSOID = ("ellipsoid", "a=2.1", "b=1.2", "c=0.9", "fineness=12")
GRAIN = ("grain", "fineness=8")
GRID = ("--cells", "40")
MSS = ("-g", "mss")


class Generate(Case):
    def setUp(self):
        super().setUp()
        self.grain = self.shape(*GRAIN)

    def clump(self, *args, name="x.csv"):
        """The spheres of a run of mss."""
        self.mskit("generate", self.grain, *MSS, *GRID, "-j", "1", "-o", name, *args)
        return self.spheres(name)


class Record(Generate):
    """The JSON file holds all that is needed to repeat the run, and what it gave."""

    def test_record(self):
        name = self.shape(*ELLIPSOID)
        self.mskit("generate", name, *MSS, "-n", "6", "--voxel-size", "0.05", "--seed", "17", "--until", "radius=0.01",
                   "-j", "1", "--spacing", "2.5", "-o", "c.json", "-o", "c.csv")
        record = json.loads(self.read("c.json"))
        self.assertEqual("mskit " + record["mskit"] + "\n", self.mskit("--version").out)
        self.assertEqual(record["generator"], "mss")
        self.assertEqual(float(record["options"]["spacing"]), 2.5)
        self.assertEqual((record["options"]["confine"], record["options"]["plane"]), ("off", []))
        self.assertEqual(record["seed"], 17)
        self.assertEqual(record["until"], {"spheres": 6, "radius": 0.01})
        self.assertEqual(record["stopped_by"], "spheres")
        self.assertEqual(record["threads"], 1)
        self.assertGreater(record["peak_memory_kb"], 100)
        self.assertEqual(set(record["seconds"]), {"read", "voxelize", "distance", "generate", "score", "cpu"})
        for phase, seconds in record["seconds"].items():
            self.assertTrue(0 <= seconds < TIMEOUT, f"{phase} took {seconds} s")
        self.check_input(record["input"], name)
        self.assertEqual(record["columns"], ["x", "y", "z", "r"])
        self.assertEqual([tuple(s) for s in record["spheres"]], self.spheres("c.csv"), "JSON and CSV, to the last bit")
        self.assertEqual(record["scores"]["spheres"], 6)

    def check_input(self, record, name):
        self.assertEqual(record["path"], name)
        self.assertEqual(record["fnv1a"], fnv1a(self.read(name)))
        self.assertEqual((record["rule"], record["closed"], record["voxel_size"]), ("half", True, 0.05))
        for axis, semi_axis in enumerate((2.1, 1.2, 0.9)):
            low = record["grid_origin"][axis]
            high = low + record["voxel_size"] * (record["grid"][axis] - 1)
            self.assertLess(low, -semi_axis, "the grid holds the body")
            self.assertGreater(high, semi_axis, "the grid holds the body")
        # 2 % for the mesh of fineness 12 and the voxels of 0.05: the ellipsoid has 75,000 of them.
        self.assert_close(record["voxels"] * 0.05**3, 4 / 3 * math.pi * 2.1 * 1.2 * 0.9, 0.02, "volume of the voxels")

    def test_scores_on_stdout_are_those_of_the_file(self):
        printed = self.generate(self.grain, *GRID, "-n", "5", "-o", "c.json")
        filed = json.loads(self.read("c.json"))
        self.assertEqual(printed["scores"], filed["scores"])
        self.assertEqual(printed["options"], filed["options"])

    def test_planes_are_recorded_as_unit_normals(self):
        run = self.generate(self.grain, *GRID, "-n", "2", "--plane", "0,0,2,1", "--plane", "3,4,0,10", "-o", "c.csv")
        self.assertEqual(run["options"]["plane"], [[0, 0, 1, 0.5], [0.6, 0.8, 0, 2]])

    def test_ellipsoid_is_scored_as_the_geometry_says(self):
        """The first sphere of MSS as published is the largest inscribed one: its volume by formula is the coverage."""
        name = self.shape("ellipsoid", "a=1.5", "b=1.5", "c=1")
        scores = self.generate(name, *MSS, "--variant", "paper", "--cells", "80", "-n", "1", "-o", "c.csv")["scores"]
        # The radius lacks up to a voxel (1/40): 2.5 % of it, 7.5 % of the volume.
        self.assert_close(scores["coverage"], 1 / 1.5**2, 0.076, "coverage")
        self.assertEqual((scores["overshoot"], scores["pieces"]), (0, 1))
        self.assertLess(scores["protrusion_max"], 1 / 40, "at most a voxel")
        self.assertAlmostEqual(scores["eta"], 1 - scores["coverage"], places=12)
        self.assertAlmostEqual(scores["dice"], 1 - 2 * scores["coverage"] / (1 + scores["coverage"]), places=12)
        self.assertAlmostEqual(scores["off_volume"], scores["coverage"], places=12)


class Default(Generate):
    """Without -g it is the method of the least mismatch."""

    def test_least_mismatch(self):
        run = self.generate(self.grain, *GRID, "-n", "8", "-o", "c.csv")
        self.assertEqual(run["generator"], "variational")
        for method in ("mss", "setcover", "fcm"):
            scores = self.generate(self.grain, *GRID, "-g", method, "-n", "8", "-o", "d.csv")["scores"]
            self.assertLess(run["scores"]["dice"], scores["dice"], method)
        self.mskit("generate", self.grain, *GRID, "-g", "variational", "-n", "8", "-o", "e.csv")
        self.assertEqual(self.read("c.csv"), self.read("e.csv"))

    def test_it_is_told(self):
        self.assertRegex(self.mskit("generate", "--help").out, r"--generator \S+ +[^-]*\(variational\)")
        self.assertRegex(self.mskit("scene", "--help").out, r"--generator \S+ +[^-]*\(variational\)")
        self.assertEqual([line.split()[0] for line in self.mskit("generators").out.splitlines()
                          if "the default" in line],
                         ["variational"])

    def test_option_of_another_method(self):
        self.assert_refused("generate", self.grain, "--confine", code=2,
                            says=("variational has no option 'confine'", "-g mss beside"))
        self.assert_refused("generate", self.grain, "--set", "radius-offset=1", code=2, says=("-g mss or -g fcm",))
        self.assert_refused("scene", self.grain, "--knee", "0.1", "--order", "gain", code=2, says=("-g mss",))

    def test_prefixes_are_no_clumps(self):
        """Where prefixes of the clump are scored, it is said that they are none of the method's."""
        for command in ("generate", "score"):
            self.assertRegex(self.mskit(command, "--help").out,
                             r"(?s)--curve.*variational.*no clumps|no clumps.*variational")


class Stop(Generate):
    """Which measure ends a run, and that it ends there and not later."""

    MEASURES = ("eta", "dice", "coverage", "inertia")

    def measure(self, scores, name):
        return scores["inertia_error"]["weighted_mean"] if name == "inertia" else scores[name]

    def reached(self, scores, name, value):
        have = self.measure(scores, name)
        return have >= value if name == "coverage" else have <= value

    def test_number_of_spheres(self):
        longest = self.clump("-n", "20")
        self.assertEqual(len(longest), 20)
        for n in (1, 2, 3, 7, 19):
            self.assertEqual(self.clump("-n", n), longest[:n], f"-n {n} gives the first {n} of -n 20")

    def test_default_is_50_spheres(self):
        run = self.generate(self.grain, *GRID, "-o", "c.csv")
        self.assertEqual(run["until"], {"spheres": 50})
        self.assertLessEqual(run["scores"]["spheres"], 50)

    def test_each_measure(self):
        for name, value in (("eta", 0.2), ("dice", 0.12), ("coverage", 0.8), ("inertia", 0.3)):
            with self.subTest(measure=name):
                run = self.generate(self.grain, *MSS, *GRID, "--until", f"{name}={value}", "-o", "c.csv")
                n = run["scores"]["spheres"]
                self.assertEqual(run["stopped_by"], name)
                self.assertEqual(run["until"], {name: value})
                self.assertTrue(self.reached(run["scores"], name, value), f"{name} {value} at {n} spheres")
                self.assertGreater(n, 1)
                before = self.generate(self.grain, *MSS, *GRID, "-n", n - 1, "-o", "c.csv")["scores"]
                self.assertFalse(self.reached(before, name, value), f"{name} {value} already at {n - 1} spheres")

    def test_curve_of_nested_method(self):
        self.mskit("generate", self.grain, *MSS, *GRID, "-n", "20", "-o", "c.csv", "--curve", "curve.csv")
        score = self.mskit("score", "c.csv", "--target", self.grain, "--curve", *GRID).out
        self.assertEqual(self.read("curve.csv").decode(), score)

    def test_curve_of_method_without_prefixes(self):
        """Better at each number than the prefixes of one clump, and at the last it is that clump."""
        self.mskit("generate", self.grain, *GRID, "-n", "12", "-o", "c.csv", "--curve", "curve.csv")
        rows = self.rows_of_curve(self.read("curve.csv").decode())
        prefixes = self.curve("c.csv", self.grain, *GRID)
        self.assertEqual([row["n"] for row in rows], list(range(1, 13)))
        self.assertEqual(rows[-1], prefixes[-1])
        for row, prefix in zip(rows[:-1], prefixes):
            self.assertLess(row["dice"], prefix["dice"], f"{row['n']:g} spheres")
        for fewer, more in zip(rows, rows[1:]):
            self.assertLess(more["dice"], fewer["dice"], f"{more['n']:g} spheres")

    def test_curve_to_bad_places(self):
        self.assert_refused("generate", self.grain, *GRID, "-o", "c.csv", "--curve", "none/curve.csv", code=1,
                            says=("none/curve.csv",))
        self.assert_refused("generate", self.grain, *GRID, "-o", "-", "--curve", "-", code=2, says=("standard output",))

    def test_every_combination_ends_at_the_first(self):
        """The scores of all prefixes, from score --curve, say where each combination has to end."""
        limits = {"spheres": 9, "eta": 0.22, "dice": 0.125, "coverage": 0.7, "inertia": 0.35}
        self.clump("-n", "20", name="long.csv")
        curve = self.curve("long.csv", self.grain, *GRID)
        first = {"spheres": limits["spheres"]}
        for name in ("eta", "dice", "coverage"):
            first[name] = next(int(row["n"]) for row in curve if self.reached(row, name, limits[name]))
        first["inertia"] = self.generate(self.grain, *MSS, *GRID, "--until", f"inertia={limits['inertia']}", "-o",
                                         "c.csv")["scores"]["spheres"]
        self.assertGreater(len(set(first.values())), 2, f"limits should differ: {first}")
        for count in range(2, len(limits) + 1):
            for names in itertools.combinations(limits, count):
                flags = [w for name in names for w in
                         (("-n", limits[name]) if name == "spheres" else ("--until", f"{name}={limits[name]}"))]
                run = self.generate(self.grain, *MSS, *GRID, *flags, "-o", "c.csv")
                least = min(first[name] for name in names)
                self.assertEqual(run["scores"]["spheres"], least, f"{names} of {first}")
                self.assertIn(run["stopped_by"], [name for name in names if first[name] == least])
                self.assertEqual(run["until"], {name: limits[name] for name in names})

    def test_least_radius(self):
        for least in (0.25, 0.4):
            run = self.generate(self.grain, *MSS, *GRID, "--variant", "paper", "--until", f"radius={least}",
                                "-o", "c.csv")
            radii = [r for *_, r in self.spheres("c.csv")]
            self.assertEqual(run["stopped_by"], "radius")
            self.assertGreaterEqual(min(radii), least)
        self.assertGreater(len(self.clump("--variant", "paper", "-n", "30")), len(radii),
                           "without the rule there are more")

    def test_least_radius_holds_beside_other_rules(self):
        spheres = self.clump("--until", "radius=0.3", "-n", "4", "--until", "coverage=0.99", "--confine")
        self.assertLessEqual(len(spheres), 4)
        self.assertGreaterEqual(min(r for *_, r in spheres), 0.3)

    def test_min_radius_is_the_same_rule(self):
        for method in (MSS, ("-g", "variational")):
            rule, flag = (self.clump(*method, "-n", "8", *words) for words in
                          (("--until", "radius=0.58"), ("--min-radius", "0.58")))
            self.assertEqual(rule, flag)
            self.assertGreaterEqual(min(r for *_, r in flag), 0.58)
        self.assertLess(min(r for *_, r in self.clump("-g", "variational", "-n", "8")), 0.58)

    def test_unreachable(self):
        """A measure that cannot be reached ends with all spheres that there is room for, and says so."""
        result = self.mskit("generate", self.grain, *MSS, "--cells", "12", "--until", "eta=1e-9", "-j", "1", "--json",
                            "-o", "c.csv")
        self.assertEqual(result.json["stopped_by"], "exhausted")
        self.assert_says(result, "no place for a further sphere")

    def test_no_room_for_any(self):
        for words in (("--until", "radius=99"), ("--min-radius", "99")):
            self.assert_refused("generate", self.grain, "--cells", "12", *words, "-o", "c.csv", code=1,
                                says=("placed no sphere", "least radius"))


class Options(Generate):
    def test_set_is_the_same_as_the_flag(self):
        plain = self.clump("-n", "12")
        for name, value in (("spacing", "9"), ("boost", "1"), ("variant", "paper"), ("plane", "0,0,1,0.2"),
                            ("plane", "-1,0,0,-0.1")):
            with self.subTest(option=name, value=value):
                by_set = self.clump("-n", "12", "--set", f"{name}={value}")
                self.assertNotEqual(by_set, plain, "the option changes something")
                self.assertEqual(self.clump("-n", "12", f"--{name}", value), by_set)
                self.assertEqual(self.clump("-n", "12", f"--{name}={value}"), by_set)

    def test_flags_of_a_generator(self):
        confined = self.clump("-n", "12", "--confine")
        self.assertNotEqual(confined, self.clump("-n", "12"))
        for text in ("confine", "confine=on", "confine=1", "confine=yes", "confine=true"):
            self.assertEqual(self.clump("-n", "12", "--set", text), confined, text)
        for text in ("confine=off", "confine=0", "confine=no", "confine=false"):
            self.assertEqual(self.clump("-n", "12", "--set", text), self.clump("-n", "12"), text)

    def test_no_sphere_crosses_a_plane(self):
        planes = ((0.0, 0.0, 2.0, 0.3), (3.0, 4.0, 0.0, -1.2))
        flags = [w for p in planes for w in ("--plane", ",".join(map(str, p)))]
        spheres = self.clump("-n", "20", *flags)
        self.assertGreater(len(spheres), 3)
        for a, b, c, d in planes:
            length = math.sqrt(a * a + b * b + c * c)
            for x, y, z, r in spheres:
                away = abs(a * x + b * y + c * z - d) / length
                self.assertLessEqual(r, away * (1 + 1e-12) + 1e-12, f"({x}, {y}, {z}) r {r} crosses {a},{b},{c},{d}")

    def test_confined_spheres_stay_inside(self):
        """Against a brute-force distance from every triangle, which shares nothing with mskit."""
        name = self.shape("grain", "fineness=5", "noise=0.3", name="rough.obj")
        vertices, triangles = read_obj(self.read(name).decode())
        run = self.generate(name, *MSS, *GRID, "-n", "15", "--confine", "-o", "c.csv")
        self.assertLessEqual(run["scores"]["protrusion_max"], 1e-9)
        for x, y, z, r in self.spheres("c.csv"):
            corners = [[vertices[v] for v in t] for t in triangles]
            turns = sum(solid_angle((x, y, z), *t) for t in corners) / (4 * math.pi)
            self.assertAlmostEqual(turns, 1, places=6, msg=f"({x}, {y}, {z}) should lie inside")
            room = min(triangle_distance((x, y, z), *t) for t in corners)
            self.assertLessEqual(r, room + 1e-9, f"({x}, {y}, {z}) with radius {r} reaches out")

    def test_confine_needs_a_closed_mesh(self):
        self.write("open.obj", box_obj((0, 0, 0), (3, 2, 1), skip=1))
        self.assert_refused("generate", "open.obj", *MSS, "--allow-open", "--cells", "20", "--confine", code=1,
                            says=("confine", "closed mesh"))


class Remarks(Generate):
    """What a method says of its input goes to standard error, once, and changes no result."""

    def test_spheres_outside_the_shape(self):
        flags = ("-g", "variational", *GRID, "-n", "3", "-j", "1")
        self.write("in.json", json.dumps({"spheres": [[0, 0, 0, 0.4]]}))
        self.write("mixed.csv", "0,0,0,0.4\n50,0,0,0.4\n")
        self.write("out.csv", "50,0,0,0.4\n60,0,0,0.4\n")
        self.mskit("generate", self.grain, *flags, "--refine", "in.json", "-o", "in.csv")
        result = self.mskit("generate", self.grain, *flags, "--refine", "mixed.csv", "-o", "c.csv", "--curve", "k.csv")
        self.assertEqual(result.err.count("variational: 1 of the 2 spheres of refine lie outside the shape"), 1, result)
        self.assertEqual(self.read("c.csv"), self.read("in.csv"))
        self.assert_refused("generate", self.grain, *flags, "--refine", "out.csv", "-o", "d.csv", code=1,
                            says=("refine", "none of its 2 spheres reaches the shape"))

    def test_long_edges(self):
        self.write("box.obj", box_obj((0, 0, 0), (1, 1, 1)))
        for name, says in (("box.obj", True), (self.shape("cube"), False)):
            result = self.mskit("generate", name, "-g", "fcm", "--cells", "20", "-n", "20", "-j", "1", "-o", "c.csv")
            self.assertEqual("fcm: the edges of the mesh are long" in result.err, says, result)

    def test_spheres_that_cover_nothing(self):
        """A wall of 0.6 voxels; between its faces no sphere covers more than half a voxel."""
        name = self.shape("hollow", "r=0.97", "fineness=12")
        self.assert_refused("generate", name, "-g", "setcover", "--cells", "40", "-n", "10", "-o", "c.csv", code=1,
                            says=("setcover", "cover no voxel of the shape", "more cells"))
        self.assertGreater(self.generate(name, "-g", "setcover", "--cells", "200", "-n", "10", "-o",
                                         "c.csv")["scores"]["coverage"], 0)


class Repeat(Generate):
    def test_threads_do_not_change_a_bit(self):
        for ending in ("csv", "vtk"):
            runs = []
            for i, threads in enumerate((("-j", "1"), ("-j", "2"), ("-j", "3"), (), ())):
                name = f"{i}.{ending}"
                self.mskit("generate", self.grain, *GRID, "-n", "20", *threads, "-o", name)
                runs.append(self.read(name))
            self.assertEqual(len(set(runs)), 1, f"{ending}: one file for all numbers of threads")

    def test_scores_do_not_depend_on_threads(self):
        one, two = (self.mskit("generate", self.grain, *GRID, "-n", "9", "-j", j, "-o", "c.csv", "--json").json
                    for j in ("1", "2"))
        self.assertEqual(one["scores"], two["scores"])
        self.assertEqual((one["threads"], two["threads"]), (1, 2))


class Open(Generate):
    def setUp(self):
        super().setUp()
        self.write("closed.obj", box_obj((0, 0, 0), (3, 2, 1)))
        self.write("open.obj", box_obj((0, 0, 0), (3, 2, 1), skip=1))

    def test_refused_with_the_number_of_open_edges(self):
        for command in (("generate", "open.obj", "-n", "3"), ("score", "c.csv", "--target", "open.obj")):
            self.write("c.csv", "1,1,0.5,0.5\n")
            self.assert_refused(*command, code=1, says=("open.obj", "open", "3 edges", "--allow-open"))

    def test_allowed(self):
        """One triangle less out of twelve: the parities along the other axes still give the cuboid."""
        scores = []
        for name, more in (("closed.obj", ("--rule", "centre")), ("open.obj", ("--allow-open",))):
            result = self.mskit("generate", name, *more, *GRID, "-n", "5", "-j", "1", "--json", "-o", "c.csv")
            scores.append(result.json["scores"])
            self.assertEqual(result.json["input"]["closed"], name == "closed.obj")
        self.assert_says(result, "3 open edges", "disagreed")
        self.assert_close(scores[1]["volume"], scores[0]["volume"], 0.02, "volume of the union")
        self.assertIsNone(scores[1]["protrusion_max"], "an open mesh has no outside")

    def test_deq_needs_a_volume(self):
        self.assert_refused("generate", "open.obj", "--allow-open", "--deq", "50", code=1, says=("--deq", "--cells"))


class Resolution(Generate):
    def test_voxel_size(self):
        """Of a cuboid of 3 x 2 x 1."""
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))
        for flags, size in ((("--cells", "25"), 1 / 25), (("--voxel-size", "0.03"), 0.03),
                            (("--deq", "60"), (36 / math.pi) ** (1 / 3) / 60), (("--cells", "1"), 1)):
            run = self.generate("box.obj", *flags, "-n", "1", "-o", "c.csv")
            self.assert_close(run["input"]["voxel_size"], size, 1e-12, str(flags))

    def test_default_is_100_cells_along_the_shortest_side(self):
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))
        run = self.generate("box.obj", "-n", "1", "-o", "c.csv")
        self.assertEqual(run["input"]["voxel_size"], 0.01)
        self.assertEqual(run["input"]["voxels"], 300 * 200 * 100)

    def test_rule(self):
        for rule in ("half", "centre"):
            run = self.generate(self.grain, *GRID, "--rule", rule, "-n", "1", "-o", "c.csv")
            self.assertEqual(run["input"]["rule"], rule)

    def test_a_grid_without_voxels(self):
        self.assert_refused("generate", self.grain, "--voxel-size", "1e300", code=1, says=("no voxel", "inside"))
