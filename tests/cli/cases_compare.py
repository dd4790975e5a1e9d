"""mskit compare: rows that agree with score, runs that are killed and taken up again, what the charts hold."""
import csv
import io
import math
import os
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import time
import unittest
import xml.etree.ElementTree as ElementTree
import zlib

from support import MSKIT, TIMEOUT, Case, box_obj, fnv1a, npy

TIMES = ("seconds_read", "seconds_voxelize", "seconds_distance", "seconds_describe", "seconds_generate",
         "seconds_least", "seconds_most", "seconds_score", "seconds_correct", "peak_memory_kb", "beside")
RUN = ("-g", "mss", "-g", "setcover", "-g", "variational", "-n", "3,6", "--cells", "12",
       "-j", "1")


def parse(text):
    return list(csv.DictReader(io.StringIO(text)))


def without_times(rows):
    return [{key: value for key, value in row.items() if key not in TIMES} for row in rows]


class Compare(Case):
    def setUp(self):
        super().setUp()
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))

    def rows(self, name="compare.csv"):
        return parse(self.read(name).decode())

    def compare(self, *args, **more):
        self.mskit("compare", *args, **more)
        return self.rows()


class Rows(Compare):
    def test_order_and_what_was_asked(self):
        self.write("cube.obj", box_obj((0, 0, 0), (1, 1, 1)))
        rows = self.compare("box.obj", "cube.obj", "-g", "mss", "-g", "mss:boost=2,plane=0,0,1,0.4,confine", "-n",
                            "40,20,40", "--cells", "14,10", "-j", "1", "--repeat", "2", "--seed", "7")
        wanted = [(shape, cells, options, n) for shape in ("box.obj", "cube.obj") for cells in ("10", "14")
                  for options in ("", "boost=2,plane=0,0,1,0.4,confine") for n in ("20", "40")]
        self.assertEqual([(r["shape"], r["cells"], r["options"], r["n_asked"]) for r in rows], wanted)
        for row in rows:
            self.assertEqual((row["generator"], row["seed"], row["repeats"], row["threads"]), ("mss", "7", "2", "1"))
            self.assertEqual(row["checksum"], fnv1a(self.read(row["shape"])))
            self.assertGreater(float(row["peak_memory_kb"]), 1000)
            for column in TIMES:
                self.assertGreaterEqual(float(row[column]), 0)
        self.assertNotEqual(rows[1]["dice"], rows[3]["dice"], "the options count")

    def check_scores(self, row, scores):
        for column in ("eta", "dice", "coverage", "overshoot", "off_volume", "protrusion_max", "protrusion_rms",
                       "gap_max", "gap_rms", "normal_median", "normal_95", "edge_part", "edge_normal_median",
                       "edge_normal_95", "smallest_radius_ratio", "work", "pieces"):
            self.assertEqual(float(row[column]), scores[column], column)
        self.assertEqual(float(row["inertia_union"]), scores["inertia_error"]["weighted_mean"])

    def test_rows_agree_with_generate_score_and_correct(self):
        grid = ("--cells", "12")
        for row in self.compare("box.obj", *RUN):
            n = row["n_asked"]
            self.mskit("generate", "box.obj", "-g", row["generator"], "-n", n, *grid, "-o", "one.csv")
            self.check_scores(row, self.mskit("score", "one.csv", "--target", "box.obj", *grid, "--json")
                              .json["scores"])
            self.assertEqual(row["n"], str(len(self.spheres("one.csv"))))
            result = self.mskit("correct", "one.csv", "--target", "box.obj", "--density", "1", "--json", code=None)
            if result.code:
                self.assertEqual(row["epsilon"], "")
                self.assertIn("centre of mass", row["cause"])
                continue
            masses = result.json["masses"]
            self.assert_close(float(row["epsilon"]), masses["epsilon"], 1e-9)
            moments = (5, 10, 13)  # of a box 3 x 2 x 1, over mass / 12
            weighted = sum(abs(e) * m for e, m in zip(masses["error_moments"], moments)) / sum(moments)
            self.assertLess(abs(float(row["inertia_corrected"]) - weighted), 1e-9)

    def test_threads_do_not_matter(self):
        found = []
        self.write("cube.obj", box_obj((0, 0, 0), (1, 1, 1)))
        for threads in ("1", "3"):
            self.mskit("compare", "box.obj", "cube.obj", "-g", "mss", "-g", "variational", "-n", "5,9",
                       "--cells", "12,16", "-j", threads, "-o", threads + ".csv")
            rows = self.rows(threads + ".csv")
            self.assertEqual({row["threads"] for row in rows}, {"1"}, "each run has one, side by side")
            self.assertEqual({row["beside"] for row in rows}, {str(int(threads) - 1)})
            found.append(without_times(rows))
        self.assertEqual(*found)
        self.assertEqual(len(found[0]), 16)

    def test_runs_go_in_turn_where_times_are_the_result(self):
        rows = self.compare("box.obj", "-g", "mss", "-n", "5", "--cells", "12,16", "--repeat", "2", "-j", "2")
        self.assertEqual({(row["threads"], row["beside"]) for row in rows}, {("2", "0")})
        self.assertTrue(all(row["peak_memory_kb"] for row in rows))

    def test_a_large_run_is_alone(self):
        """12 cells fit into a third of the memory allowed, 24 only into all of it."""
        rows = self.compare("box.obj", "-g", "mss", "-g", "variational", "-n", "5", "--cells", "12,24", "-j", "3",
                            "--max-memory", "5M")
        self.assertEqual([(row["cells"], row["threads"], row["beside"], row["cause"]) for row in rows],
                         [("12", "1", "2", "")] * 2 + [("24", "3", "0", "")] * 2)

    def test_tables_of_the_documents(self):
        """The script beside the documents: every D stands in its place."""
        rows = self.compare("box.obj", "-g", "mss", "-g", "setcover", "-n", "2,5000", "--cells", "12")
        script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "comparison-tables.py")
        process = subprocess.run([sys.executable, script, "compare.csv", "2", "5000"], cwd=self.dir, check=True,
                                 stdout=subprocess.PIPE)
        line = next(line for line in process.stdout.decode().split("\n") if line.startswith("| box |"))
        self.assertEqual(line.strip("| ").split(" | ")[1:],
                         [f"{float(r['dice']):.4f}" + ("*" if r["n_asked"] == "5000" else "") for r in rows])

    def test_too_many_asked_for(self):
        rows = self.compare("box.obj", "-g", "mss", "-n", "2,5000", "--cells", "12")
        self.assertEqual([r["stopped_by"] for r in rows], ["spheres", "exhausted"])
        self.assertLess(int(rows[1]["n"]), 5000)

    def test_clump_of_another_tool(self):
        """Two balls within a box of 6: their volume is known, and their D up to voxels."""
        self.write("two.csv", "1,1,0.5,0.5\n2,1,0.5,0.5\n")
        row = self.compare("box.obj", "--clump", "mine=two.csv", "-g", "mss", "-n", "3", "--cells", "60")[0]
        self.assertEqual((row["generator"], row["options"], row["n_asked"], row["n"], row["seconds_generate"]),
                         ("mine", "two.csv", "", "2", ""))
        volume = 2 * math.pi / 6
        self.assert_close(float(row["coverage"]), volume / 6, 0.01)
        self.assert_close(float(row["dice"]), 1 - 2 * volume / (6 + volume), 0.01)
        self.mskit("score", "two.csv", "--target", "box.obj", "--cells", "60")

    def test_min_radius_binds_methods_and_not_clumps(self):
        """Each method but the one of another tool keeps to it, and generate's clump is that of the row."""
        self.write("two.csv", "1,1,0.5,0.5\n2,1,0.5,0.25\n")
        args = ("box.obj", "--clump", "mine=two.csv", "-g", "mss", "-g", "variational", "-n", "24", "--cells", "12")
        free = self.compare(*args, "-o", "compare.csv")
        words = self.mskit("compare", *args, "--min-radius", "0.4", "-o", "bound.csv")
        bound = self.rows("bound.csv")
        self.assert_says(words, "mine: 1 of its 2 spheres are below --min-radius 0.4")
        self.assertEqual([r["flags"] for r in bound], ["min-radius=0.4"] * 3)
        self.assertEqual(free[0]["dice"], bound[0]["dice"], "it is judged as it is")
        r_eq = math.cbrt(3 * 6 / (4 * math.pi))
        for row, before in zip(bound[1:], free[1:]):
            self.assertLess(float(before["smallest_radius_ratio"]) * r_eq, 0.4)
            self.assertGreaterEqual(float(row["smallest_radius_ratio"]) * r_eq, 0.4 - 1e-9)
            made = self.generate("box.obj", "-g", row["generator"], "-n", "24", "--cells", "12", "--min-radius", "0.4",
                                 "-o", "own.csv")
            self.assertEqual(float(row["dice"]), made["scores"]["dice"])
        result = self.mskit("compare", *args, "--resume", "-o", "bound.csv", code=1)
        self.assert_says(result, "another comparison", "flags")

    def test_rule_is_that_of_generate(self):
        self.shape("cube", name="cube.stl")
        args = ("cube.stl", "-g", "mss", "-n", "4", "--cells", "7", "--rule", "centre")
        self.mskit("compare", *args, "-o", "centre.csv")
        self.mskit("compare", *args[:-2], "-o", "half.csv")
        centre, half = self.rows("centre.csv")[0], self.rows("half.csv")[0]
        self.assertNotEqual(centre["dice"], half["dice"])
        self.assertEqual(float(centre["dice"]), self.generate(*args, "-o", "own.csv")["scores"]["dice"])
        self.assertEqual((centre["flags"], half["flags"]), ("rule=centre", ""))

    def test_volume(self):
        self.write("scan.npy", npy([3] * 500 + [4] * 500, (10, 10, 10)))
        rows = self.compare("scan.npy", "-g", "mss", "-n", "2", "--label", "4", "--cells", "20,40")
        self.assertEqual([(r["label"], r["cells"], r["voxel_size"], r["protrusion_max"]) for r in rows],
                         [("4", "", "1", "")])

    def test_all_methods_by_default_and_baselines_by_name(self):
        listed = self.mskit("generators", "--json").json
        for names, flags in (([g["name"] for g in listed if not g["baseline"]], []),
                             ([g["name"] for g in listed if g["baseline"]],
                              [word for g in listed if g["baseline"] for word in ("-g", g["name"])])):
            name = f"{len(flags)}.csv"
            self.mskit("compare", "box.obj", *flags, "-n", "6", "--cells", "12", "-o", name)
            rows = self.rows(name)
            self.assertGreater(len(names), 2)
            self.assertEqual([r["generator"] for r in rows], names)
            self.assertTrue(all(r["dice"] for r in rows), rows)

    def test_a_run_without_one_row_fails(self):
        """Of the new rows, which are written and told all the same."""
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))
        self.write("open.obj", box_obj((0, 0, 0), (3, 2, 1), skip=1))
        args = ("-g", "mss", "-n", "1,2", "--cells", "8", "--json")
        says = ("mskit compare: not one of 2 rows succeeded; the first failed because of this: "
                "open.obj: the mesh is open")
        result = self.mskit("compare", "open.obj", *args, code=1)
        self.assert_says(result, says)
        self.assertEqual([row["dice"] for row in result.json], [None, None])
        self.mskit("compare", "open.obj", *args, "--resume")  # of no new row none has failed
        self.mskit("compare", "box.obj", *args, "-o", "two.csv")
        self.assert_says(self.mskit("compare", "box.obj", "open.obj", *args, "-o", "two.csv", "--resume", code=1), says)
        self.mskit("compare", "box.obj", "open.obj", *args, "-o", "both.csv")

    def test_failures_are_rows(self):
        self.write("open.obj", box_obj((0, 0, 0), (3, 2, 1), skip=1))
        self.write("odd, name.obj", "v 0 0 0\nf 1 2\n")
        result = self.mskit("compare", "open.obj", "odd, name.obj", "box.obj", "-g", "mss", "-g",
                            "mss:plane=0,0,1,-100", "-n", "1", "--cells", "8")
        rows = self.rows()
        self.assertEqual(len(rows), 6)
        for row, cause in zip(rows, ("the mesh is open", "the mesh is open", "line 2", "line 2")):
            self.assertIn(cause, row["cause"])
            self.assertEqual((row["n"], row["dice"]), ("", ""))
        self.assertGreater(float(rows[4]["coverage"]), 0.1)
        self.assertIn("cause", result.out)
        self.mskit("compare", "open.obj", "odd, name.obj", "box.obj", "-g", "mss", "-g", "mss:plane=0,0,1,-100", "-n",
                   "1", "--cells", "8", "--resume")
        self.assertEqual(self.rows(), rows, "there is nothing left to do")


class Resume(Compare):
    def test_killed_and_taken_up(self):
        args = ("compare", "box.obj", "-g", "fcm", "-g", "mss", "-g", "setcover", "-n", "3,6,9", "--cells", "20", "-j",
                "1", "--repeat", "2")
        self.mskit(*args, "-o", "whole.csv")
        whole = self.rows("whole.csv")
        for rows_there in (1, 4):
            process = subprocess.Popen([MSKIT, *args, "-o", "killed.csv"], cwd=self.dir, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            deadline = time.monotonic() + TIMEOUT
            while time.monotonic() < deadline and process.poll() is None:
                if os.path.exists(self.path("killed.csv")) and self.read("killed.csv").count(b"\n") > rows_there:
                    break
                time.sleep(0.001)
            process.send_signal(signal.SIGKILL)
            process.wait()
            self.assertEqual(process.returncode, -signal.SIGKILL, "it should have been at work still")
            there = self.read("killed.csv")
            self.mskit(*args, "-o", "killed.csv", "--resume")
            self.assertTrue(self.read("killed.csv").startswith(there[:there.rindex(b"\n") + 1]), "times and all")
            self.assertEqual(without_times(self.rows("killed.csv")), without_times(whole))
            os.remove(self.path("killed.csv"))

    def test_cut_anywhere(self):
        """Within the header, a row, a quoted field: the rows in the end are those of the whole run."""
        args = ("compare", "box.obj", "-g", "mss:boost=2,confine", "-n", "1,2,3", "--cells", "8", "-j", "1")
        self.mskit(*args)
        text = self.read("compare.csv")
        whole = without_times(self.rows())
        ends = [m.end() for m in re.finditer(b"\n", text)]
        for size in (0, 5, ends[0] - 1, ends[0], ends[0] + 1, ends[1] + 60, ends[2] - 1, ends[2], len(text)):
            self.write("compare.csv", text[:size])
            self.mskit(*args, "--resume")
            self.assertEqual(without_times(self.rows()), whole, f"cut after {size} bytes")
        self.assertIn('"boost=2,confine"', self.read("compare.csv").decode())

    def test_another_comparison_is_refused(self):
        args = ("compare", "box.obj", "-g", "mss", "-n", "1,2", "--cells", "8")
        self.mskit(*args)
        text = self.read("compare.csv")
        self.assert_refused(*args, code=1, says=("compare.csv", "exists", "--resume"))
        for other in (("-n", "3"), ("--cells", "6"), ("--seed", "2"), ("-g", "fcm")):
            self.mskit("compare", "box.obj", *(("-g", "mss") if other[0] != "-g" else ()), "-n", "1", *other,
                       "--cells", "8", "--resume", code=1)
        for other in (("--weld", "1e-3"), ("--fill-holes", "4"), ("--drop-bodies", "0.1"), ("--allow-open",),
                      ("--max-voxels", "300")):
            self.assert_says(self.mskit(*args, *other, "--resume", code=1), "line 2", other[0][2:], "flags")
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 2)))
        result = self.mskit(*args, "--resume", code=1)
        self.assert_says(result, "line 2", "another comparison")
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))
        self.assert_says(self.mskit("compare", "box.obj", "-g", "mss", "-n", "1", "--cells", "8", "--resume", code=1),
                         "1 rows of another comparison")
        self.assertEqual(self.read("compare.csv"), text, "what was there is as it was")
        self.write("other.csv", "x,y,z,r\n")
        self.assert_refused(*args, "-o", "other.csv", "--resume", code=1, says=("something else",))
        self.write("short.csv", text.split(b"\n")[0] + b"\nbox.obj,1\n")
        self.assert_refused(*args, "-o", "short.csv", "--resume", code=1, says=("line 2",))

    def test_full_disk(self):
        """A limit of the file size stands for it: the rows that fit are whole, and the run can go on."""
        def small():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (2800, 2800))
        args = ("compare", "box.obj", "-g", "mss", "-n", "1,2,3,4,5,6", "--cells", "8", "-j", "1")
        result = self.mskit(*args, code=1, preexec_fn=small)
        self.assert_says(result, "compare.csv", "could not be written", "intact")
        there = self.read("compare.csv")
        self.assertTrue(there.endswith(b"\n"))
        rows = self.rows()
        self.assertGreaterEqual(len(rows), 1)
        self.assertTrue(all(row["version"] for row in rows))
        self.mskit(*args, "--resume")
        self.assertTrue(self.read("compare.csv").startswith(there))
        self.assertEqual(len(self.rows()), 6)


class Refusals(Compare):
    def test_wrong_usage(self):
        for args, says in (
                ((), "shapes"),
                (("box.obj", "-g", "none"), "no generator 'none'"),
                (("box.obj", "-g", "mss:none=1"), "no option 'none'"),
                (("box.obj", "-g", "mss:boost=x"), "boost=x"),
                (("box.obj", "-g", "mss", "-g", "mss"), "twice"),
                (("box.obj", "-n", "3,"), "--spheres"),
                (("box.obj", "-n", "0"), "--spheres"),
                (("box.obj", "--cells", "1.5"), "--cells"),
                (("box.obj", "--repeat", "0"), "--repeat"),
                (("box.obj", "--clump", "box.obj"), "NAME=FILE"),
                (("box.obj", "--clump", "a=missing.csv"), "missing.csv"),
                (("box.obj", "box.obj", "-n", "1"), "box.obj is there twice"),
                (("box.obj", "two.obj", "--clump", "a=two.csv"), "a clump of one shape")):
            with self.subTest(args=args):
                self.write("two.csv", "1,1,0.5,0.5\n")
                self.assert_refused("compare", *args, code=2, says=(says,))

    def test_files(self):
        run = ("-g", "mss", "-n", "1", "--cells", "8")
        self.assert_refused("compare", "box.obj", "missing.stl", *run, code=1, says=("missing.stl",))
        self.assert_refused("compare", "box.obj", *run, "-o", "no/such.csv", code=1, says=("no/such.csv",))
        self.assert_refused("compare", "box.obj", *run, "-o", "", code=2, says=("--output ''",))
        self.assert_refused("compare", "box.obj", *run, "-o", "-", code=1, says=("go to a file",))
        self.assert_refused("compare", "box.obj", *run, "--charts", "no/such", code=1, says=("no/such",))
        self.assert_refused("compare", "box.obj", *run, "-o", "/dev/full", "--resume", code=1, says=("device",))

    def test_unwritable_folder(self):
        if os.getuid() == 0:
            self.skipTest("root may write everywhere")
        os.mkdir(self.path("locked"), 0o500)
        self.assert_refused("compare", "box.obj", "-g", "mss", "-n", "1", "--cells", "8", "-o", "locked/a.csv", code=1,
                            says=("locked/a.csv", "may be written to"))


class Charts(Compare):
    """Read as XML, and by what the data and scripts hold."""

    def svg(self, name):
        root = ElementTree.fromstring(self.read(name))
        titles = [e.text for e in root.iter("{http://www.w3.org/2000/svg}title")]
        texts = ["".join(e.itertext()).strip() for e in root.iter("{http://www.w3.org/2000/svg}text")]
        return [t for t in titles if not t.startswith(("Gnuplot", "gnuplot_plot"))], texts

    def blocks(self, name):
        """Points of each series: x, y, label."""
        found = []
        for block in self.read(name).decode().split("\n\n\n")[:-1]:
            lines = [line.split(" ") for line in block.strip("\n").split("\n") if not line.startswith("#")]
            found.append([(float(x), float(y), label.strip('"')) for x, y, label in lines])
        return found

    def check_axes(self, name, points):
        """Both axes are finite and hold every point."""
        script = self.read(name).decode()
        for axis in (0, 1):
            lo, hi = (float(v) for v in re.search(rf"set {'xy'[axis]}range \[(.*):(.*)\]", script).groups())
            self.assertTrue(math.isfinite(lo) and math.isfinite(hi) and 0 < lo < hi, name)
            for point in points:
                self.assertTrue(lo < point[axis] < hi, name)

    @unittest.skipUnless(shutil.which("gnuplot"), "gnuplot is not installed (package gnuplot-nox)")
    def test_what_they_hold(self):
        methods = ["mss", "mss:boost=2,confine", "setcover", "o'dd"]
        self.write("two.csv", "1,1,0.5,0.5\n2,1,0.5,0.5\n")
        rows = self.compare("box.obj", "-g", methods[0], "-g", methods[1], "-g", methods[2], "--clump", "o'dd=two.csv",
                            "-n", "3,6,9", "--cells", "10,14", "--charts", "charts")
        rows = [r for r in rows if r["cells"] == "14"]
        for kind, column in (("dice", "dice"), ("inertia", "inertia_union"), ("normal_median", "normal_median"),
                             ("corrected", "inertia_corrected")):
            titles, texts = self.svg(f"charts/box-{kind}.svg")
            blocks = self.blocks(f"charts/box-{kind}.dat")
            if kind == "dice":
                self.assertEqual(titles.pop(0), "expected least")
                expected = sorted({(float(r["n"]), float(r["expected"])) for r in rows})
                for (x, y, _), (n, value) in zip(blocks[0], expected):
                    self.assertEqual(x, n)
                    self.assert_close(y, value, 1e-8)
                self.assertEqual(len(blocks.pop(0)), len(expected))
            points = [(float(r["n"]), float(r[column])) for r in rows if r[column]]
            self.assertEqual(len(titles), len(blocks))
            self.assertEqual(sum(len(b) for b in blocks), len(points))
            for (x, y, _), (n, value) in zip((p for b in blocks for p in b), points):
                self.assertEqual(x, n)
                self.assert_close(y, max(value, 1e-6), 1e-8)
            if kind != "corrected":
                self.assertEqual(titles, methods)
            self.assertIn("number of spheres", texts)
            self.assertTrue(set(titles) <= set(texts), "the legend names them")
            self.check_axes(f"charts/box-{kind}.gp", [p for b in blocks for p in b])
        self.check_front("time", "seconds_generate", methods[:3] + ["o'dd, 2 spheres, no time"], rows)
        self.check_front("work", "work", methods, rows)
        self.assertEqual(len(self.svg("charts/box-resolution.svg")[0]), 4)
        self.check_sheet(columns=5, rows=3)
        for png in ("sheet", "dice", "time", "work", "inertia", "normal_median", "corrected", "resolution"):
            self.assertEqual(self.read(f"charts/box-{png}.png")[:8], b"\x89PNG\r\n\x1a\n")

    def check_front(self, kind, column, methods, rows):
        """Every point has its number of spheres; the front is the one found here by brute force."""
        titles, texts = self.svg(f"charts/box-{kind}.svg")
        front, *blocks = self.blocks(f"charts/box-{kind}.dat")
        if kind == "time":  # a clump from a file took no time that is known: a line across the chart
            line = blocks.pop()
            self.assertEqual({y for _, y, _ in line}, {float(f"{float(rows[-1]['dice']):.9g}")})
            self.assertIn(f"{rows[0]['machine']}; threads: {rows[0]['threads']}; single runs", texts)
        points = [p for b in blocks for p in b]
        self.assertEqual(titles, ["Pareto front"] + methods)
        self.assertEqual([p[2] for p in points], [r["n"] for r in rows if r[column]])
        for (x, y, label), row in zip(points, (r for r in rows if r[column])):
            self.assert_close(x, float(row[column]), 1e-8)
            self.assert_close(y, float(row["dice"]), 1e-8)
            self.assertIn(label, texts)
        best = sorted(p[:2] for p in points if not any(q[0] <= p[0] and q[1] <= p[1] and q[:2] != p[:2]
                                                       for q in points))
        self.assertEqual([p[:2] for p in front], best)
        self.check_axes(f"charts/box-{kind}.gp", points)

    def check_sheet(self, columns, rows):
        """Grey pixels by the standard of PNG; something is on each tile, the clump of another tool is there once."""
        data = self.read("charts/box-tiles.png")
        parts, at = {}, 8
        while at < len(data):
            size, = struct.unpack(">I", data[at:at + 4])
            parts[data[at + 4:at + 8]] = data[at + 8:at + 8 + size]
            self.assertEqual(struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0],
                             zlib.crc32(data[at + 4:at + 8 + size]))
            at += 12 + size
        width, height, *kind = struct.unpack(">IIBBBBB", parts[b"IHDR"])
        self.assertEqual((width, height, kind), (220 * columns, 246 * rows, [8, 0, 0, 0, 0]))
        pixels = zlib.decompress(parts[b"IDAT"])
        self.assertEqual(len(pixels), (width + 1) * height)
        for row in range(rows):
            for column in range(columns):
                dark = sum(value < 255 for y in range(246 * row, 246 * row + 220) for value in
                           pixels[y * (width + 1) + 1 + 220 * column:y * (width + 1) + 1 + 220 * (column + 1)])
                is_there = row == 0 or 0 < column < columns - 1
                self.assertEqual(dark > 2000, is_there, f"tile {column}, {row}")
        script = self.read("charts/box-sheet.gp").decode()
        for word in ("mss:boost=2,confine", "setcover", "asked for: 3", "asked for: 6", "asked for: 9"):
            self.assertIn(f"set label '{word}'", script)
        places = re.findall(r"set label '(?:asked for|n =).* at [\d.]+,([\d.]+) ", script)
        self.assertGreaterEqual(len(places), 2 * rows)
        for y in places:
            self.assertGreater((246 * rows - float(y)) % 246, 220, "on a tile and not below it")
        self.assertIn(r'set label "o\047dd"', script)

    def test_without_gnuplot(self):
        """A clear error; results and scripts are there, and the page, which says that charts are missing."""
        result = self.mskit("compare", "box.obj", "-g", "mss", "-n", "3,4", "--cells", "8", "--charts", "charts",
                            "--report", "r.html", code=1, env={**os.environ, "PATH": self.dir})
        self.assert_says(result, "gnuplot-nox", "box-sheet.gp")
        page = self.read("r.html").decode()
        self.assertIn("not drawn: charts/box-dice.gp; charts need gnuplot (package gnuplot-nox)", page)
        self.assertEqual((page.count("not drawn: "), page.count("data-scene=")), (page.count("charts/box-"), 2))
        self.assertEqual(len(self.rows()), 2)
        names = sorted(os.listdir(self.path("charts")))
        sheet = ["box-mss-3.csv", "box-mss-4.csv", "box-sheet.gp", "box-tiles.png"]
        masses = sum(row["epsilon"] != "" for row in self.rows())
        kinds = ["dice", "normal_median", "time", "work", "inertia"] + (["corrected"] if masses == 2 else [])
        self.assertEqual(names, sorted(sheet + [f"box-{k}.{e}" for k in kinds for e in ("dat", "gp")]))

    @unittest.skipUnless(shutil.which("gnuplot"), "gnuplot is not installed (package gnuplot-nox)")
    def test_a_point_is_no_chart(self):
        """It is said in words; points of times have bars from the fastest run to the slowest, of which one is the
        median. What a run before drew goes from folder and page."""
        os.mkdir(self.path("charts"))
        before = [f"charts/{name}.svg" for name in ("box-dice", "box-resolution")]
        for name in before:
            self.write(name, "of a run before")
        result = self.mskit("compare", "box.obj", "-g", "mss", "-g", "fcm", "-n", "3", "--cells", "8", "--repeat", "3",
                            "--charts", "charts", "--report", "r.html")
        rows = self.rows()
        said = "; ".join(f"{r['generator']}: number of spheres 3, mismatch D {float(r['dice']):.4g}" for r in rows)
        self.assertIn(f"no chart charts/box-dice, but words: {said}\n", result.out)
        for name in before:
            self.assertFalse(os.path.exists(self.path(name)), name)
        self.assertEqual(re.findall(r'class="chart" alt="([^"]*)"', self.read("r.html").decode()),
                         ["box-time.svg", "box-work.svg"])
        bars = [line.split(" ") for line in self.read("charts/box-time.dat").decode().splitlines()
                if line.count(" ") == 4]
        for bar, row in zip((bar for bar in bars if bar[0] != "#"), rows, strict=True):
            for value, column in zip((bar[0], bar[3], bar[4]), ("seconds_generate", "seconds_least", "seconds_most")):
                self.assert_close(float(value), float(row[column]), 1e-8)
            self.assertTrue(float(row["seconds_least"]) <= float(row["seconds_generate"]) <= float(row["seconds_most"]))
        self.assertIn("medians of 3 runs; bars: least to most, 75 % confidence",
                      self.read("charts/box-time.svg").decode())

    def test_same_names(self):
        os.mkdir(self.path("other"))
        self.write("other/box.obj", box_obj((0, 0, 0), (1, 1, 1)))
        self.assert_refused("compare", "box.obj", "other/box.obj", "-g", "mss", "-n", "1", "--cells", "8", "--charts",
                            "charts", code=1, says=("two shapes are called box",))
