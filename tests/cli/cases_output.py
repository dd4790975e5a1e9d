"""Where results go: files that are whole or not there, clean streams, memory that is not taken."""
import json
import os
import resource
import shutil
import signal
import subprocess

from support import MSKIT, TIMEOUT, Case, box_obj, parse_spheres

RUN = ("--cells", "20", "-n", "4", "-j", "1")


class Output(Case):
    def setUp(self):
        super().setUp()
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))

    def run_box(self, *args, **more):
        return self.mskit("generate", "box.obj", *RUN, *args, **more)


class Files(Output):
    def test_default_names(self):
        os.mkdir(self.path("shapes"))
        os.mkdir(self.path("work"))
        self.write("shapes/my.box.obj", box_obj((0, 0, 0), (3, 2, 1)))
        result = self.mskit("generate", os.path.join("..", "shapes", "my.box.obj"), *RUN, code=None, preexec_fn=lambda:
                            os.chdir(self.path("work")))
        self.assertEqual(sorted(os.listdir(self.path("work"))),
                         ["my.box-variational" + ending for ending in (".csv", ".json", ".vtk")], str(result))
        self.assertEqual(os.listdir(self.path("shapes")), ["my.box.obj"], "nothing beside the shape")
        for name in os.listdir(self.path("work")):
            self.assertIn(f"wrote {name}\n", result.out)

    def test_format_without_output(self):
        self.run_box("--format", "json")
        self.assertEqual(self.files(), ["box-variational.json", "box.obj"])

    def test_format_beats_the_ending(self):
        self.run_box("--format", "csv", "-o", "a.json", "-o", "b")
        self.assertEqual(self.read("a.json"), self.read("b"))
        self.assertEqual(len(self.spheres("b")), 4)

    def test_several_outputs(self):
        self.run_box("-o", "a.csv", "-o", "b.JSON", "-o", "c.vtk", "-o", "d.csv")
        self.assertEqual(self.files(), ["a.csv", "b.JSON", "box.obj", "c.vtk", "d.csv"])
        spheres = self.spheres("a.csv")
        self.assertEqual(spheres, self.spheres("d.csv"))
        self.assertEqual(spheres, [tuple(s) for s in json.loads(self.read("b.JSON"))["spheres"]])
        self.check_vtk(self.read("c.vtk").decode().splitlines(), spheres)

    def check_vtk(self, lines, spheres):
        n = len(spheres)
        self.assertEqual(lines[0], "# vtk DataFile Version 3.0")
        self.assertEqual(lines[2:5], ["ASCII", "DATASET POLYDATA", f"POINTS {n} double"])
        points = [tuple(map(float, line.split())) for line in lines[5:5 + n]]
        radii = [float(line) for line in lines[-n:]]
        self.assertEqual([(*p, r) for p, r in zip(points, radii)], spheres)
        self.assertIn(f"POINT_DATA {n}", lines)

    def test_target_grid(self):
        """As many voxels inside as the record says."""
        record = self.run_box("--json", "-o", "a.csv", "--target-grid", "grid.vtk").json
        head, data = self.read("grid.vtk").split(b"LOOKUP_TABLE default\n", 1)
        nx, ny, nz = record["input"]["grid"]
        self.assertIn(f"DIMENSIONS {nx} {ny} {nz}\n".encode(), head)
        self.assertEqual(len(data), nx * ny * nz)
        self.assertEqual(data.count(1), record["input"]["voxels"])
        self.assertEqual(set(data), {0, 1})

    def test_numbers_survive_the_file(self):
        """CSV holds each double exactly: what is read back gives the same scores."""
        record = self.run_box("--json", "-o", "a.csv").json
        again = self.mskit("score", "a.csv", "--target", "box.obj", "--cells", "20", "--json").json
        self.assertEqual(record["scores"], again["scores"])

    def test_more_than_16_outputs(self):
        args = [w for i in range(17) for w in ("-o", f"{i}.csv")]
        self.assert_refused("generate", "box.obj", *RUN, *args, code=2, says=("16",))


class Streams(Output):
    def test_standard_output(self):
        self.run_box("-o", "a.csv", "-o", "b.json", "-o", "c.vtk")
        csv = self.run_box("-o", "-")
        self.assertEqual(csv.out_bytes, self.read("a.csv"))
        self.assert_says(csv, "Dice", "grid: ")
        self.assertEqual(self.run_box("-o", "-", "--format", "vtk").out_bytes, self.read("c.vtk"))
        record = json.loads(self.run_box("-o", "-", "--format", "json").out)
        self.assertEqual(record["spheres"], json.loads(self.read("b.json"))["spheres"])

    def test_json_parses_alone(self):
        self.write("c.csv", "1.5,1,0.5,0.5\n")
        for args in (("generate", "box.obj", *RUN, "--json"), ("info", "box.obj", "--json"), ("generators", "--json"),
                     ("score", "c.csv", "--target", "box.obj", "--cells", "20", "--json")):
            result = self.mskit(*args)
            self.assertIsInstance(json.loads(result.out), (dict, list))

    def test_table_is_on_stdout_and_remarks_on_stderr(self):
        result = self.run_box("-o", "a.csv")
        self.assertIn("D, Dice mismatch", result.out)
        self.assertEqual(result.err, "grid: 64x44x24 voxels, about 1.34 MB\n")

    def test_no_progress_and_no_escape_codes_in_pipes(self):
        for args in (("generate", "box.obj", *RUN), ("info", "box.obj"), ("--help",), ("generate", "--help"),
                     ("shape", "--list")):
            result = self.mskit(*args)
            for sign in ("\x1b", "\r", "\b"):
                self.assertNotIn(sign, result.out + result.err, f"{sign!r} in the output of {args}")
        self.assertNotIn("spheres, D", result.err)

    def test_the_shape_is_not_overwritten(self):
        self.shape("cube", name="cube.ply")
        before = self.read("cube.ply")
        for args in (("--target-grid", "cube.ply"), ("-o", "cube.ply", "--format", "csv")):
            result = self.mskit("generate", "cube.ply", "-n", "1", "--cells", "10", *args, code=1)
            self.assert_says(result, "cube.ply", "not overwritten")
            self.assertEqual(self.read("cube.ply"), before)

    def test_a_full_device_is_an_error(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("there is no /dev/full here")
        with open("/dev/full", "wb") as full:
            for args in (("--version",), ("--help",), ("info", "box.obj"), ("info", "box.obj", "--json"),
                         ("generators",), ("shape", "--list"), ("shape", "ball", "-o", "-"),
                         ("generate", "box.obj", *RUN, "-o", "-"), ("generate", "box.obj", *RUN, "-o", "a.csv")):
                process = subprocess.run([MSKIT, *args], cwd=self.dir, stdout=full, stderr=subprocess.PIPE,
                                         timeout=TIMEOUT, check=False)
                self.assertEqual(process.returncode, 1, f"{args}: {process.stderr}")
                self.assertRegex(process.stderr, b"(can|could) ?not be written", str(args))
        result = self.run_box("--format", "csv", "-o", "/dev/full", code=1)
        self.assert_says(result, "/dev/full", "could not be written")

    def test_closed_streams_do_not_end_up_in_the_file(self):
        self.run_box("-o", "a.csv")
        for number, closed in enumerate((">&-", "2>&-", ">&- 2>&-", "<&- >&- 2>&-")):
            name = f"closed{number}.csv"
            subprocess.run(["sh", "-c", f'exec "$0" generate box.obj "$@" -o {name} {closed}', MSKIT, *RUN],
                           cwd=self.dir, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                           timeout=TIMEOUT, check=False)
            self.assertEqual(self.read(name), self.read("a.csv"), f"with {closed}")


class Failures(Output):
    """Exit code 1, a sentence that names the file, nothing half-written."""

    def test_missing_shape(self):
        for name, says in (("missing.stl", ("missing.stl", "No such file")), (".", ("folder",)),
                           ("/dev/null", ("device",)), ("missing.npy", ("missing.npy",)),
                           ("box.obj/x.stl", ("box.obj/x.stl",))):
            for command in (("info", name), ("generate", name), ("score", "c.csv", "--target", name)):
                self.write("c.csv", "0,0,0,1\n")
                with self.subTest(command=command):
                    self.assert_refused(*command, code=1, says=says)

    def test_ending_that_is_no_shape(self):
        self.write("shape.xyz", "0 0 0\n")
        self.assert_refused("info", "shape.xyz", code=1, says=("shape.xyz", ".stl", ".off", ".npy", ".nhdr"))

    def test_output_that_cannot_be_written(self):
        os.mkdir(self.path("folder.csv"))
        for name, says in (("missing/a.csv", ("missing/a.csv", "cannot be written", "folder")),
                           ("folder.csv", ("folder.csv", "is a folder")), ("box.obj/a.csv", ("box.obj/a.csv",))):
            for args in (("-o", name), ("-o", "good.csv", "-o", name), ("-o", "good.csv", "--target-grid", name)):
                with self.subTest(args=args):
                    self.assert_refused("generate", "box.obj", *RUN, *args, code=1, says=says)
        self.assert_refused("shape", "ball", "-o", "missing/a.stl", code=1, says=("missing/a.stl",))

    def test_folder_without_permission(self):
        if os.geteuid() == 0:
            self.skipTest("root may write anywhere")
        os.mkdir(self.path("locked"), 0o500)
        self.assert_refused("generate", "box.obj", *RUN, "-o", "locked/a.csv", code=1, says=("locked/a.csv", "denied"))

    def test_a_refusal_leaves_no_folder(self):
        """One that was there stays; where results are, the folder is there, too."""
        folder = {"compare": "--charts", "stability": "--charts", "scene": "-o"}
        for command, *args in (("compare", "none.stl"), ("compare", "box.obj", "-o", "box.obj"),
                               ("stability", "box.obj", "-o", "box.obj"), ("generate", "none.stl"),
                               ("generate", "box.obj", *RUN, "--max-memory", "1k"), ("convert", "none.csv"),
                               ("correct", "none.csv", "--target", "box.obj", "--density", "1"),
                               ("scene", "none.stl", "--budget", "3"),
                               ("scene", "box.obj", "-g", "mss", "--cells", "8", "--max-spheres", "1",
                                "--tolerance", "dice=0.01")):
            with self.subTest(command=command, args=args):
                args = (command, *args, folder.get(command, "--all-formats"), "made")
                self.assert_refused(*args, code=1)
                os.mkdir(self.path("made"))
                self.assert_refused(*args, code=1)
                os.rmdir(self.path("made"))
        self.run_box("--all-formats", "made", "--curve", "made/curve.csv")
        self.assertIn("box-variational.csv", os.listdir(self.path("made")))
        self.assert_refused("generate", "box.obj", *RUN, "--all-formats", "no/made", code=1, says=("no/made",))
        self.assert_refused("generate", "box.obj", *RUN, "--all-formats", "new", "-o", "new/../new/box-variational.csv",
                            code=1, says=("are one file",))

    def test_failed_write_leaves_the_earlier_file(self):
        """The largest file allowed is 1500 bytes (LLVM's OpenMP itself needs one of 1024): the write fails halfway."""
        self.run_box("-o", "whole.json")
        self.assertGreater(len(self.read("whole.json")), 2000)
        self.write("a.json", "earlier\n")

        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (1500, 1500))

        result = self.run_box("-o", "a.json", code=1, preexec_fn=limit)
        self.assert_says(result, "a.json", "could not be written")
        self.assertEqual(self.read("a.json"), b"earlier\n")
        self.assertEqual(self.files(), ["a.json", "box.obj", "whole.json"], "no temporary file is left")

    def test_files_are_replaced_whole(self):
        self.write("a.csv", "earlier\n" * 1000)
        os.chmod(self.path("a.csv"), 0o644)
        self.run_box("-o", "a.csv")
        self.assertEqual(len(self.spheres("a.csv")), 4)

    def test_a_link_stays_a_link(self):
        os.mkdir(self.path("there"))
        self.write("there/real.csv", "earlier\n")
        os.symlink(os.path.join("there", "real.csv"), self.path("link.csv"))
        self.run_box("-o", "link.csv")
        self.assertTrue(os.path.islink(self.path("link.csv")))
        self.assertEqual(len(self.spheres("there/real.csv")), 4)

    def test_writers_of_one_file_do_not_mix(self):
        self.run_box("-o", "a.csv")
        args = [MSKIT, "generate", "box.obj", *RUN, "-o", "same.csv"]
        runs = [subprocess.Popen(args, cwd=self.dir, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                for _ in range(4)]
        self.assertEqual([run.wait(TIMEOUT) for run in runs], [0] * 4)
        self.assertEqual(self.read("same.csv"), self.read("a.csv"))
        self.assertEqual(self.files(), ["a.csv", "box.obj", "same.csv"])


class Memory(Output):
    def peak(self, *args):
        """Exit code, stderr, seconds of the processor and peak memory in MB."""
        with open(self.path("err.txt"), "w+b") as err:
            process = subprocess.Popen([MSKIT, *args], cwd=self.dir, stdout=subprocess.DEVNULL, stderr=err)
            _, status, usage = os.wait4(process.pid, 0)
            has_code = hasattr(os, "waitstatus_to_exitcode")
            process.returncode = os.waitstatus_to_exitcode(status) if has_code else status >> 8
            err.seek(0)
            return process.returncode, err.read().decode(), usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1000

    def test_huge_grids_are_refused_at_once(self):
        for size in ("1e-5", "1e-9", "1e-300"):
            with self.subTest(size=size):
                code, err, seconds, peak = self.peak("generate", "box.obj", "--voxel-size", size, "-o", "a.csv")
                self.assertEqual(code, 1, err)
                self.assertIn("GB", err)
                self.assertIn("--max-memory", err)
                self.assertLess(len(err), 300, err)
                self.assertLess(seconds, 5)
                self.assertLess(peak, 200, "MB taken")
        self.assertNotIn("a.csv", self.files())

    def test_beyond_the_largest_grid(self):
        code, err, _, peak = self.peak("generate", "box.obj", "--voxel-size", "1e-5", "--max-memory", "1000000T")
        self.assertEqual(code, 1, err)
        self.assertIn("more than 32767", err)
        self.assertLess(peak, 200, "MB taken")

    def test_limit(self):
        """304 x 204 x 104 voxels of 12 bytes, and 220,000 squares of the surface of 60, are 91 MB; mss takes 14 and
        120."""
        self.assert_refused("generate", "box.obj", "--max-memory", "90M", "-n", "1", code=1,
                            says=("304x204x104", "0.0906 GB", "0.09 GB", "--max-memory"))
        for size in ("117M", "117000k", "117000000", "0.117G", "1T"):
            self.mskit("generate", "box.obj", "-g", "mss", "--max-memory", size, "-n", "1", "-o", "a.csv")

    def test_the_estimate_holds(self):
        """What is announced before the run covers what the run takes beyond a small one."""
        with open(shutil.which(MSKIT), "rb") as program:
            if b"__asan_init" in program.read():
                self.skipTest("the address sanitizer takes memory of its own")
        for method, more in (("mss", 1.1),
                             ("variational", 1.2)):  # which has distances at the surface, and scores beyond
            run = ("generate", "box.obj", "-g", method, "-o", "a.csv")
            _, _, _, small = self.peak(*run, "--cells", "4", "-n", "1")
            _, err, _, large = self.peak(*run, "--cells", "130", "-n", "20")
            announced = float(err.split("about ")[1].split(" MB")[0])
            self.assertLess(large - small, announced * more, method)
