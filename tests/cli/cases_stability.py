"""mskit stability: what a result owes to things that should not matter."""
import base64
import csv
import io
import json
import math
import os
import re
import shutil

from support import Case, box_obj, npy, read_obj

KINDS = ("axes", "rotation", "shift", "lattice", "resolution", "noise", "refine", "decimate", "seed", "order",
         "threads")


def rows_of(text):
    return list(csv.DictReader(io.StringIO(text)))


class Stability(Case):
    def rows(self, *args, **more):
        """The rows of a run as dictionaries of text."""
        if "s.csv" in self.files():
            os.unlink(self.path("s.csv"))
        self.mskit("stability", *args, "-o", "s.csv", **more)
        return rows_of(self.read("s.csv").decode())

    def test_rows_are_those_asked_for(self):
        rows = self.rows("cube", "-g", "mss", "-n", "4", "--cells", "12", "--runs", "3")
        wanted = ["none"] + [kind for kind in KINDS for _ in range(2 if kind == "refine" else 3)]
        self.assertEqual([row["perturbation"] for row in rows], wanted)
        for row in rows:
            self.assertIsNone(row.get(None), "a field more than there are columns")
            self.assertNotIn(None, row.values(), "a field less than there are columns")
            self.assertEqual((row["shape"], row["generator"], row["options"], row["n_asked"]), ("cube", "mss", "", "4"))

    def test_judged_as_score_does(self):
        """D of the unchanged shape is that of score, on the same grid."""
        self.shape("tetrahedron", name="t.ply")
        self.mskit("generate", "t.ply", "-g", "setcover", "-n", "6", "--cells", "15", "-o", "c.csv")
        score = self.mskit("score", "c.csv", "--target", "t.ply", "--cells", "15", "--json").json["scores"]
        row = self.rows("t.ply", "-g", "setcover", "-n", "6", "--cells", "15", "--perturb", "seed", "--runs", "1")[0]
        self.assertEqual(row["perturbation"], "none")
        for column in ("eta", "dice", "coverage", "overshoot", "off_volume", "smallest_radius_ratio", "pieces"):
            self.assertEqual(float(row[column]), score[column], column)
        self.assertEqual(float(row["inertia_error"]), score["inertia_error"]["weighted_mean"])

    def test_spheres_are_moved_back(self):
        """The first turn, half a turn about y, made here by hand: mesh turned, clump made, turned back, scored."""
        def turn(point):
            return (-point[0], point[1], -point[2])
        self.shape("grain", "fineness=8", name="g.obj")
        vertices, triangles = read_obj(self.read("g.obj").decode())
        self.write("t.obj", "".join("v %r %r %r\n" % turn(v) for v in vertices) +
                   "".join("f %d %d %d\n" % tuple(c + 1 for c in t) for t in triangles))
        row = self.rows("g.obj", "-g", "setcover", "-n", "6", "--cells", "15", "--perturb", "axes", "--runs", "1")[1]
        self.assertEqual((row["perturbation"], row["level"]), ("axes", "1"))
        self.mskit("generate", "t.obj", "-g", "setcover", "-n", "6", "--voxel-size", row["voxel_size"], "-o", "t.csv")
        self.write("g.csv", "".join("%r,%r,%r,%r\n" % (*turn(s), s[3]) for s in self.spheres("t.csv")))
        score = self.mskit("score", "g.csv", "--target", "g.obj", "--cells", "15", "--json").json["scores"]
        self.assertEqual(float(row["dice"]), score["dice"])
        self.assertEqual(float(row["inertia_error"]), score["inertia_error"]["weighted_mean"])

    def test_a_turned_cube_is_the_same_cube(self):
        """The rotations of a cube leave it as it is, and MSS keeps its symmetry: D is that of the unchanged one."""
        rows = self.rows("cube", "-g", "mss", "-n", "9", "--cells", "14", "--perturb", "axes", "--runs", "23")
        self.assertEqual(len({row["level"] for row in rows}), 24)
        self.assertEqual(len({row["dice"] for row in rows}), 1)

    def test_what_must_not_matter_does_not(self):
        """Threads, and for MSS seed, order and refined faces of a box: the same spheres to the last bit."""
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))
        rows = self.rows("box.obj", "-g", "mss", "-n", "5", "--cells", "12", "--runs", "2", "--perturb", "threads",
                         "--perturb", "seed", "--perturb", "order", "--perturb", "refine")
        self.assertEqual(len(rows), 9)
        self.assertEqual(len({row["spheres_fnv1a"] for row in rows}), 1)
        self.assertEqual([row["threads"] for row in rows if row["perturbation"] == "threads"], ["1", "2"])

    def test_another_seed_gives_other_spheres_where_numbers_are_drawn(self):
        rows = self.rows("speck", "-g", "fcm:filling=500", "-n", "5", "--perturb", "seed", "--runs", "2")
        self.assertEqual([row["seed"] for row in rows], ["1", "2", "3"])
        self.assertEqual(len({row["spheres_fnv1a"] for row in rows}), 3)

    def test_threads_make_no_difference_and_a_killed_run_goes_on(self):
        """Rows of one and of three threads, and of a table cut at any place and taken up, are the same but for
        times."""
        args = ("stability", "cube", "speck", "-g", "mss", "-g", "fcm:tries=10", "-n", "4", "--cells", "12",
                "--runs", "2", "--perturb", "rotation", "--perturb", "noise", "--json")
        def known(name):
            return [{k: v for k, v in row.items() if k not in ("seconds", "beside")}
                    for row in rows_of(self.read(name).decode())]
        one = self.mskit(*args, "-j", 1, "-o", "one.csv").json
        self.assertEqual(one, self.mskit(*args, "-j", 3, "-o", "three.csv").json)
        self.assertEqual(known("one.csv"), known("three.csv"))
        text = self.read("one.csv")
        ends = [at for at, byte in enumerate(text) if byte == ord("\n")]
        for size in (0, 5, ends[0] + 1, ends[0] + 40, ends[3], ends[3] + 1, ends[12] + 9, len(text)):
            self.write("cut.csv", text[:size])
            self.assertEqual(self.mskit(*args, "--resume", "-o", "cut.csv").json, one, f"cut after {size} bytes")
            self.assertEqual(known("cut.csv"), known("one.csv"))
        for other in (("cube",), ("speck", "cube"), ("cube", "speck", "-n", "5"),
                      ("cube", "speck", "--perturb", "seed"),
                      ("cube", "speck", "--rule", "centre"), ("cube", "speck", "--weld", "1e-3"),
                      ("cube", "speck", "--seed", "7"), ("cube", "speck", "--until-dice", "0.2")):
            more = [word for word in args[1:] if word not in ("cube", "speck")]
            result = self.mskit("stability", *more, *other, "--resume", "-o", "one.csv", code=1)
            self.assert_says(result, "one.csv", "other")
            self.assertEqual(self.read("one.csv"), text)

    def test_a_damaged_row_is_refused(self):
        args = ("stability", "cube", "-g", "mss", "-n", "4", "--cells", "10", "--perturb", "seed", "--runs", "1",
                "--until-dice", "0.2", "--json")
        groups = self.mskit(*args, "-o", "one.csv").json
        self.assertEqual({group["n_until"]["count"] for group in groups}, {1})
        for column, wrong in (("n_until", "1e300"), ("n_until", "-1"), ("n_until", "two"), ("status", "fine")):
            with self.subTest(column=column, wrong=wrong):
                header, first, *others = csv.reader(io.StringIO(self.read("one.csv").decode()))
                first[header.index(column)] = wrong
                self.write("cut.csv", "".join(",".join(line) + "\n" for line in (header, first, *others)))
                self.assert_refused(*args, "--resume", "-o", "cut.csv", code=1,
                                    says=("cut.csv: line 2", f"{column} cannot be '{wrong}'"))

    def test_levels(self):
        """Ladders in equal ratios from end to end; the voxels go with the resolution."""
        rows = self.rows("cube", "-g", "mss", "-n", "1", "--cells", "10", "--runs", "3", "--perturb", "resolution",
                         "--perturb", "noise", "--perturb", "decimate")
        for kind, ladder in (("resolution", (0.5, 1, 2)), ("noise", (0.001, math.sqrt(3e-5), 0.03)),
                             ("decimate", (0.02, math.sqrt(0.004), 0.2))):
            levels = [float(row["level"]) for row in rows if row["perturbation"] == kind]
            for level, truth in zip(levels, ladder, strict=True):
                self.assert_close(level, truth, 1e-12, kind)
        for row in rows:
            factor = float(row["level"]) if row["perturbation"] == "resolution" else 1
            self.assert_close(float(row["voxel_size"]), 0.1 / factor, 1e-12, "voxel size")

    def test_the_number_at_fixed_mismatch(self):
        """It is the number with which generate ends by the same rule."""
        self.shape("cone", "fineness=8", name="c.ply")
        run = self.generate("c.ply", "-g", "setcover", "--cells", "15", "--until", "dice=0.3", "-o", "x.csv")
        rows = self.rows("c.ply", "-g", "setcover", "-n", "10", "--cells", "15", "--until-dice", "0.3", "--perturb",
                         "seed", "--runs", "1")
        self.assertEqual(run["stopped_by"], "dice")
        self.assertEqual({row["n_until"] for row in rows}, {str(run["scores"]["spheres"])})
        rows = self.rows("c.ply", "-g", "setcover", "-n", "1", "--cells", "15", "--until-dice", "0.0001", "--perturb",
                         "seed", "--runs", "1")
        self.assertEqual({row["n_until"] for row in rows}, {""})

    def test_min_radius_holds_in_every_run(self):
        args = ("cube", "-g", "mss", "-n", "30", "--cells", "10", "--perturb", "seed", "--runs", "1")
        free, bound = self.rows(*args), self.rows(*args, "--min-radius", "0.2")
        self.assertEqual({row["stopped_by"] for row in free}, {"spheres"})
        for row in bound:
            self.assertEqual((row["stopped_by"], row["flags"].split()[-1]), ("radius", "min-radius=0.2"))
            self.assertLess(int(row["n"]), 30)

    def test_a_failure_is_a_row_with_its_cause(self):
        """fcm that may draw 10 centres cannot touch the nodes: named, counted, and the others go on."""
        result = self.mskit("stability", "speck", "-g", "fcm:tries=10", "-g", "mss", "-n", "3", "--perturb", "seed",
                            "--runs", "2", "-o", "s.csv")
        rows = rows_of(self.read("s.csv").decode())
        for row in rows[:3]:
            self.assertEqual((row["status"], row["dice"], row["n"]), ("failed", "", ""))
            self.assertIn("random centres", row["cause"])
        self.assertEqual([row["status"] for row in rows[3:]], ["ok"] * 3)
        self.assertIn("2 failed, 0 unusable: 10 random centres", result.out)

    def test_a_run_without_one_row_fails(self):
        """The rows are written and told all the same."""
        args = ("stability", "speck", "-g", "fcm:tries=10", "-n", "3", "--perturb", "seed", "--runs", "2")
        says = "mskit stability: not one of 3 rows succeeded; the first failed because of this: 10 random centres"
        result = self.mskit(*args, "-o", "s.csv", code=1)
        self.assert_says(result, says)
        self.assertIn("2 failed, 0 unusable", result.out)
        self.assertEqual([row["status"] for row in rows_of(self.read("s.csv").decode())], ["failed"] * 3)
        result = self.mskit(*args, "-o", "t.csv", "--json", code=1)
        self.assert_says(result, says)
        self.assertEqual([group["failed"] for group in result.json], [1, 2])

    def test_a_shape_that_cannot_be_used_is_no_failure_of_the_method(self):
        """Twice the cells do not fit the memory allowed."""
        groups = self.mskit("stability", "cube", "-g", "mss", "-n", "2", "--cells", "40", "--max-memory", "4M",
                            "--perturb", "resolution", "--runs", "2", "--json", "-o", "s.csv").json
        rows = rows_of(self.read("s.csv").decode())
        self.assertEqual([row["status"] for row in rows if row["perturbation"] == "resolution"][1], "unusable")
        self.assertIn("more than the memory allowed", rows[2]["cause"])
        self.assertEqual([(g["runs"], g["failed"], g["unusable"]) for g in groups], [(1, 0, 0), (1, 0, 1)])

    def test_a_mesh_that_decimation_opens_is_unusable(self):
        """Two sheets of the rough grain fall onto each other; of equal triangles one is kept."""
        rows = self.rows("rough", "-g", "mss", "-n", "1", "--deq", "15", "--perturb", "decimate", "--runs", "3")
        self.assertEqual([row["status"] for row in rows], ["ok", "ok", "ok", "unusable"])
        self.assertIn("the mesh is open", rows[3]["cause"])

    def test_summary_is_that_of_the_rows(self):
        """Least, median, most and deviation, computed here."""
        groups = self.mskit("stability", "cube", "speck", "-g", "mss", "-n", "3", "--runs", "4", "--cells", "10",
                            "--perturb", "rotation", "--json", "-o", "s.csv").json
        rows = rows_of(self.read("s.csv").decode())
        self.assertEqual([(g["shape"], g["perturbation"]) for g in groups],
                         [("cube", "none"), ("cube", "rotation"), ("speck", "none"), ("speck", "rotation"),
                          (None, "none"), (None, "rotation")])
        for group in (groups[1], groups[3]):
            dice = sorted(float(r["dice"]) for r in rows
                          if r["shape"] == group["shape"] and r["perturbation"] == "rotation")
            mean = sum(dice) / 4
            truth = {"count": 4, "min": dice[0], "median": (dice[1] + dice[2]) / 2, "max": dice[3],
                     "deviation": math.sqrt(sum((d - mean)**2 for d in dice) / 3)}
            for key, value in truth.items():
                self.assert_close(group["dice"][key], value, 1e-9, key)
        unchanged = {r["shape"]: float(r["dice"]) for r in rows if r["perturbation"] == "none"}
        ratios = [(float(r["dice"]) / unchanged[r["shape"]], r["shape"]) for r in rows
                  if r["perturbation"] == "rotation"]
        self.assert_close(groups[5]["dice_ratio"]["max"], max(ratios)[0], 1e-12, "largest ratio")
        self.assertEqual(groups[5]["worst"], max(ratios)[1] if max(ratios)[0] > 1 else None)

    def test_threads_give_the_same_rows(self):
        args = ("speck", "cube", "-n", "3", "--cells", "8", "-g", "mss", "-g", "variational", "-g", "setcover",
                "--perturb", "rotation", "--perturb", "noise", "--runs", "1")
        runs = [self.rows(*args, "-j", threads) for threads in ("1", "2")]
        for one, two in zip(*runs, strict=True):
            for column in one:
                if column not in ("seconds", "beside"):
                    self.assertEqual(one[column], two[column], column)

    def test_rows_on_standard_output(self):
        result = self.mskit("stability", "speck", "-g", "mss", "-n", "2", "--perturb", "seed", "--runs", "1", "-o", "-")
        self.assertEqual(len(rows_of(result.out)), 2)
        self.assertIn("unusable", result.err)
        self.assertEqual(self.files(), [])

    def test_built_in_shapes(self):
        """Every one is made and judged: the open mesh is open, the speck a few voxels across."""
        rows = self.rows("-g", "mss", "-n", "1", "--perturb", "threads", "--runs", "1")
        names = [row["shape"] for row in rows if row["perturbation"] == "none"]
        self.assertEqual(names, ["plate", "needle", "cube", "tetrahedron", "shell", "torus", "dumbbell", "cone",
                                 "rough", "speck", "open", "bowl", "limbs", "cavity", "corners", "pair"])
        self.assertEqual({row["status"] for row in rows}, {"ok"})

    def test_charts(self):
        """Every run stands in the chart of all; the lines over the noise are ratios of D, from the least level up."""
        if not shutil.which("gnuplot"):
            self.skipTest("gnuplot is not installed here")
        os.mkdir(self.path("charts"))
        self.write("charts/1-mss-variant-paper-resolution.svg", "of a run before")
        rows = self.rows("speck", "cube", "-g", "mss:variant=paper", "-n", "3", "--cells", "8", "--runs", "3",
                         "--perturb", "noise", "--perturb", "seed", "--charts", "charts")
        stems = ("1-mss-variant-paper-all", "1-mss-variant-paper-noise")
        self.assertEqual(sorted(os.listdir(self.path("charts"))),
                         sorted(stem + ending for stem in stems for ending in (".dat", ".gp", ".png", ".svg")))
        unchanged = {row["shape"]: float(row["dice"]) for row in rows if row["perturbation"] == "none"}
        blocks = self.blocks("charts/1-mss-variant-paper-all.dat")
        self.assertEqual([(name, len(points)) for name, points in blocks], [("none", 2), ("noise", 6), ("seed", 6)])
        for name, points in blocks:
            for (x, y), row in zip(points, [row for row in rows if row["perturbation"] == name], strict=True):
                self.assert_close(x, unchanged[row["shape"]], 1e-8, "D of the unchanged shape")
                self.assert_close(y, float(row["dice"]), 1e-8, "D of the changed shape")
        blocks = self.blocks("charts/1-mss-variant-paper-noise.dat")
        self.assertEqual([name for name, _ in blocks], ["speck", "cube"])
        for name, points in blocks:
            own = [row for row in rows if row["shape"] == name and row["perturbation"] == "noise"]
            for (x, y), row in zip(points, own, strict=True):
                self.assert_close(x, float(row["level"]), 1e-8, "level")
                self.assert_close(y, float(row["dice"]) / unchanged[name], 1e-8, "ratio")
        svg = self.read("charts/1-mss-variant-paper-noise.svg").decode()
        for word in ("mss:variant=paper", "speck", "cube", "amplitude of the noise / d_eq",
                     "D / D of the unchanged shape"):
            self.assertIn(word, svg)

    def test_without_gnuplot(self):
        """All scripts and the page are there; it names the charts that are missing."""
        run = self.mskit("stability", "cube", "-g", "mss", "-n", "2", "--cells", "8", "--runs", "2",
                         "--perturb", "noise", "--charts", "charts", "--report", "r.html", "-o", "s.csv", code=1,
                         env={**os.environ, "PATH": self.dir})
        self.assert_says(run, "gnuplot-nox")
        scripts = [name for name in sorted(os.listdir(self.path("charts"))) if name.endswith(".gp")]
        self.assertEqual(scripts, ["1-mss-all.gp", "1-mss-noise.gp"])
        page = self.read("r.html").decode()
        self.assertEqual(re.findall("<p>not drawn: charts/(.*?); charts need gnuplot", page), scripts)
        self.assertIn("<tr data-scene", page)

    def blocks(self, name):
        """The series of a chart: name and points."""
        found = []
        for block in self.read(name).decode().strip().split("\n\n\n"):
            head, *lines = block.splitlines()
            found.append((head.split("'")[1], [tuple(float(w) for w in line.split()[:2]) for line in lines]))
        return found

    def test_report(self):
        """All rows; of each shape and method two clumps, the unchanged one and the worst, with as many spheres as
        theirs."""
        args = ("speck", "pair", "-g", "mss", "-n", "3", "--deq", "10", "--perturb", "noise", "--perturb", "seed",
                "--runs", "2", "-o", "s.csv", "--report", "r.html")
        self.mskit("stability", *args)
        rows = rows_of(self.read("s.csv").decode())
        page = self.read("r.html").decode()
        table = re.findall(r"<tr( data-scene=\"(\d+)\")?><td>(speck|pair)", page)
        self.assertEqual([shape for *_, shape in table], [row["shape"] for row in rows])
        shown = [row for (_, scene, _), row in zip(table, rows, strict=True) if scene]
        wanted = []
        for shape in ("speck", "pair"):
            own = [row for row in rows if row["shape"] == shape]
            wanted += [own[0], max(own[1:], key=lambda row: float(row["dice"]))][:2 if any(
                float(row["dice"]) > float(own[0]["dice"]) for row in own) else 1]
        self.assertEqual(shown, wanted)
        scenes = json.loads(re.search(r'id="scenes">(.*?)</script>', page, re.S).group(1))
        self.assertEqual([scene["name"] for scene in scenes],
                         [f"{row['shape']}, mss, {row['perturbation']} {float(row['level']):g}, {row['n']} spheres"
                          for row in wanted])
        for scene, row in zip(scenes, wanted):
            self.assertEqual(len(base64.b64decode(scene["spheres"])), 16 * int(row["n"]))
            self.assertIn("mesh", scene)
        self.mskit("stability", *args, "--resume")
        self.assertNotIn("<tr data-scene", self.read("r.html").decode(), "clumps of a run before are not known")

    def test_help_names_every_perturbation(self):
        refused = self.mskit("stability", "cube", "--perturb", "nonsense", code=2).err
        known = refused.split("choose from ")[1].split("\n")[0].split(", ")
        self.assertEqual(known, [kind for kind in KINDS if kind != "none"])
        text = self.mskit("stability", "--help").out
        for kind in known:
            self.assertRegex(text, rf"[ ,]{kind}\b")

    def test_wrong_usage(self):
        for args, says in (
            (("-g", "nonsense"), ("'nonsense'", "mss", "fcm")),
            (("-g", "mss:nonsense=1"), ("'nonsense'", "spacing")),
            (("-g", "mss:boost=10"), ("boost", "0 to 9")),
            (("-g", "mss:plane"), ("a,b,c,d",)),
            (("-g", "mss:plane=0,0,1,0"), ("mss", "planes")),
            (("-g", "mss", "-g", "mss"), ("mss is there twice",)),
            (("--perturb", "nonsense"), ("'nonsense'", *KINDS)),
            (("--perturb", "none"), ("'none'",)),
            (("--runs", "0"), ("--runs", "1 to 1000")),
            (("--until-dice", "2"), ("--until-dice", "1e-09 to 1")),
            (("--until-dice", "0"), ("--until-dice", "1e-09 to 1")),
            (("-n", "0"), ("--spheres",)),
            (("--json", "-o", "-"), ("standard output",)),
            (("--report", "r.html", "-o", "-"), ("--report", "-o")),
        ):
            with self.subTest(args=args):
                self.assert_refused("stability", "cube", *args, code=2, says=says)

    def test_shapes_are_tried_before_the_work(self):
        self.write("scan.npy", npy([1] * 1000, (10, 10, 10)))
        self.write("open.obj", box_obj((0, 0, 0), (3, 2, 1), skip=1))
        self.assert_refused("stability", "cube", "missing.stl", code=1, says=("missing.stl", "cannot be opened"))
        self.assert_refused("stability", "cube", "scan.npy", code=1, says=("volume",))
        self.assert_refused("stability", "cube", "-o", "no/such/s.csv", code=1, says=("no/such/s.csv",))
        self.assert_refused("stability", "cube", "--charts", "no/such", code=1, says=("no/such",))
        self.shape("ball", "fineness=4")
        before = self.read("ball.stl")
        self.assert_refused("stability", "cube", "ball.stl", "-o", "./ball.stl", code=1, says=("ball.stl",))
        self.assertEqual(self.read("ball.stl"), before)
        self.mskit("stability", "open.obj", "-o", "s.csv", code=1)
        self.assertEqual(rows_of(self.read("s.csv").decode()), [])

    def test_a_full_disk_is_named(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("no /dev/full here")
        self.assert_refused("stability", "speck", "-g", "mss", "-n", "1", "--perturb", "seed", "-o", "/dev/full",
                            code=1, says=("is the disk full?",))

    def test_formats_name_every_column(self):
        path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "formats.md")
        with open(path, encoding="utf-8") as f:
            text = f.read()
        row = self.rows("speck", "-g", "mss", "-n", "1", "--perturb", "seed", "--runs", "1")[0]
        os.unlink(self.path("s.csv"))
        groups = self.mskit("stability", "speck", "cube", "-g", "mss", "-n", "1", "--cells", "8", "--perturb", "seed",
                            "--runs", "1", "--json", "-o", "s.csv").json
        keys = set(row).union(*(set(g) | set(g["inertia_error_spread"]) for g in groups))
        for key in keys | set(KINDS):
            self.assertIn(f"`{key}`", text, f"formats.md does not explain '{key}'")
        self.assertEqual(json.dumps(groups).count("dice_ratio"), 2)
