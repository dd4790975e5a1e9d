"""Nothing is lost: inputs and outputs are held against each other before the work, and what was found is written."""
import csv
import io
import json
import os
import resource
import signal
import subprocess
import time

from support import MSKIT, TIMEOUT, Case, box_obj, parse_spheres

RUN = ("--cells", "10", "-n", "4", "-j", "1")
MASSES = ("--density", "2650")


class Lost(Case):
    def setUp(self):
        super().setUp()
        self.write("g.obj", box_obj((0, 0, 0), (3, 2, 1)))

    def content(self):
        """Of all files, whatever folder they are in."""
        found = {}
        for folder, _, names in os.walk(self.dir):
            for name in names:
                path = os.path.join(folder, name)
                if os.path.isfile(path):
                    with open(path, "rb") as f:
                        found[os.path.relpath(path, self.dir)] = f.read()
        return found

    def assert_kept(self, *args, says):
        before = self.content()
        result = self.mskit(*args, code=1)
        self.assert_says(result, *says)
        self.assertEqual(self.content(), before, f"nothing is changed, nothing added\n{result}")
        self.assertNotIn("D 0", result.out, "before any work")

    def clump(self):
        self.mskit("generate", "g.obj", "-n", "8", "--cells", "20", "-o", "c.csv", "-j", "1")
        return "c.csv"


class Inputs(Lost):
    INPUT = ("is the input itself", "not overwritten")

    def spellings(self, name):
        """One file, by path, by a symbolic and by a hard link."""
        os.makedirs(self.path("d"), exist_ok=True)
        os.symlink(os.path.join("..", name), self.path("d/soft"))
        os.link(self.path(name), self.path("d/hard"))
        os.symlink("..", self.path("d/up"))
        return name, "./" + name, "d/../" + name, self.path(name), "d/up/" + name, "d/soft", "d/hard"

    def test_generate(self):
        for output in self.spellings("g.obj"):
            for flags in (("-o", output, "--format", "csv"), ("-o", "a.csv", "--curve", output),
                          ("-o", "a.csv", "--target-grid", output)):
                with self.subTest(flags=flags):
                    self.assert_kept("generate", "g.obj", *RUN, *flags, says=(output, *self.INPUT))

    def test_refine(self):
        self.write("q.csv", "1.5 1 .5 .4\n")
        for name in ("-o", "--curve"):
            self.assert_kept("generate", "g.obj", "-g", "variational", "--set", "refine=q.csv", *RUN, "-o", "a.csv",
                             name, "./q.csv", says=self.INPUT)

    def test_data_file_of_a_header(self):
        self.write("x.raw", b"\1" * 64)
        self.write("s.mhd", "ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\n"
                   "ElementDataFile = x.raw\n")
        self.write("s.nhdr", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\ndata file: x.raw\n")
        clump = self.clump()
        for shape in ("s.mhd", "s.nhdr"):
            self.assert_kept("generate", shape, "-n", "2", "-o", "x.raw", "--format", "csv", says=self.INPUT)
            self.assert_kept("correct", clump, "--target", shape, *MASSES, "-o", "x.raw", "--format", "csv",
                             says=self.INPUT)
            self.assert_kept("compare", shape, "-g", "mss", "-n", "1", "-o", "x.raw", "--resume", says=self.INPUT)

    def test_correct(self):
        clump = self.clump()
        for output in ("g.obj", "c.csv"):
            self.assert_kept("correct", clump, "--target", "g.obj", *MASSES, "-o", output, "--format", "csv",
                             says=(output, *self.INPUT))

    def test_convert(self):
        clump = self.clump()
        self.write("p.json", json.dumps({"particle": {"scale": 1, "density": 1, "mass": 1, "centre": [0, 0, 0],
                                                      "inertia": [[1, 0, 0], [0, 2, 0], [0, 0, 2.5]]}}))
        for output in (clump, "p.json", "./p.json"):
            self.assert_kept("convert", clump, "--frame", "p.json", "-o", output, "--format", "csv", says=self.INPUT)

    def test_the_frame_beside_a_template(self):
        """Its name is not on the command line."""
        self.write("p.frame.json", json.dumps({"particle": {"scale": 1, "density": 1, "mass": 1, "centre": [0, 0, 0],
                                                            "inertia": [[1, 0, 0], [0, 2, 0], [0, 0, 2.5]]}}))
        self.assert_kept("convert", self.clump(), "--frame", "p.frame.json", "-o", "p.deme", says=self.INPUT)

    def test_compare(self):
        clump = self.clump()
        run = ("-g", "mss", "-n", "1", "--cells", "8")
        for output in ("g.obj", clump, "./c.csv"):
            self.assert_kept("compare", "g.obj", *run, "--clump", "x=c.csv", "-o", output, "--resume", says=self.INPUT)
        os.mkdir(self.path("charts"))
        os.rename(self.path(clump), self.path("charts/g-mss-1.csv"))
        self.assert_kept("compare", "g.obj", *run, "--clump", "x=charts/g-mss-1.csv", "--charts", "charts",
                         says=self.INPUT)

    def test_stability(self):
        self.assert_kept("stability", "g.obj", "-g", "mss", "-n", "1", "--cells", "8", "--perturb", "seed", "-o",
                         "./g.obj", says=self.INPUT)

    def test_scene(self):
        self.mskit("shape", "cube", "-o", "s.stl")
        self.write("s.csv", "shape,count\ng.obj,1\ns.stl,2\n")
        self.assert_kept("scene", "s.csv", "-g", "mss", "--knee", "0.3", "--max-spheres", "2", "--cells", "8",
                         "-o", ".", says=self.INPUT)


class Outputs(Lost):
    def test_two_of_one_file(self):
        os.symlink(".", self.path("here"))
        for flags in (("-o", "a.csv", "-o", "a.csv"), ("-o", "a.csv", "-o", "./a.csv"),
                      ("-o", "a.csv", "-o", "here/a.csv"),
                      ("-o", "a.csv", "--curve", "a.csv"), ("-o", "a.vtk", "--target-grid", self.path("a.vtk")),
                      ("-o", "b.csv", "--curve", "a.csv", "--target-grid", "a.csv")):
            with self.subTest(flags=flags):
                self.assert_kept("generate", "g.obj", *RUN, *flags, says=("lost",))

    def test_parts_of_a_template(self):
        for flags in (("-o", "a.frame.json", "-o", "a.deme"), ("-o", "a.deme", "--curve", "a.frame.json"),
                      ("-o", "a.yade", "--curve", "a.yade.py"), ("-o", "a.liggghts", "--curve", "./a.liggghts.in"),
                      ("-o", "m.mercury", "--curve", "m.mercury/Clump/Clump.txt")):
            with self.subTest(flags=flags):
                os.makedirs(self.path("m.mercury/Clump"), exist_ok=True)
                self.assert_kept("generate", "g.obj", *RUN, "--correct", *MASSES, *flags, says=("lost",))

    def test_frames_of_one_clump_may_meet(self):
        self.mskit("generate", "g.obj", "-n", "1", "--cells", "20", "-o", "c.csv", "-j", "1")
        self.mskit("correct", "c.csv", "--properties", "union", *MASSES, "-o", "a.deme", "-o", "a.pfc", "-o", "a.yade")
        self.assertTrue({"a.deme", "a.pfc", "a.yade", "a.yade.py", "a.frame.json"} <= set(self.files()))

    def test_table_and_charts(self):
        self.assert_kept("compare", "g.obj", "-g", "mss", "-n", "1", "--cells", "8", "--charts", ".",
                         "-o", "g-mss-1.csv", says=("lost",))
        self.assert_kept("stability", "g.obj", "-g", "mss", "-n", "1", "--cells", "8", "--perturb", "seed",
                         "--charts", ".", "-o", "1-mss-all.dat", says=("lost",))

    def test_streams_may_be_named_twice(self):
        self.mskit("generate", "g.obj", *RUN, "-o", "/dev/null", "--format", "csv", "--curve", "/dev/null",
                   "--target-grid", "/dev/null")

    def test_links_that_lead_nowhere(self):
        os.symlink("nothing", self.path("a.csv"))
        os.symlink("missing/x.stl", self.path("a.stl"))
        says = ("symbolic link", "leads to no file")
        self.assert_kept("generate", "g.obj", *RUN, "-o", "a.csv", says=says)
        self.assert_kept("shape", "cube", "-o", "a.stl", says=says)
        self.assert_kept("compare", "g.obj", "-g", "mss", "-n", "1", "--cells", "8", "-o", "a.csv", says=says)
        self.assert_kept("stability", "g.obj", "-g", "mss", "-n", "1", "--cells", "8", "-o", "a.csv", says=says)
        self.assertTrue(os.path.islink(self.path("a.csv")))


class Limits(Lost):
    """The size of files is limited; the signal that comes of it is not ignored beforehand."""

    @staticmethod
    def limit(size):
        def apply():
            signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
        return apply

    def test_commands(self):
        run = ("-g", "mss", "-n", "1", "--cells", "8")
        for args in (("generate", "g.obj", *RUN, "-o", "a.json"), ("shape", "ball", "-o", "a.stl"),
                     ("generate", "g.obj", *RUN, "-o", "/dev/null", "--format", "csv", "--target-grid", "a.vtk")):
            with self.subTest(args=args):
                before = self.files()
                result = self.mskit(*args, code=1, preexec_fn=self.limit(1100))
                self.assert_says(result, "a.", "could not be written",
                                 "is the disk full, or the size of files limited?")
                self.assertEqual(self.files(), before)
        for command in ("compare", "stability"):
            result = self.mskit(command, "g.obj", *run, "-o", "t.csv", code=1, preexec_fn=self.limit(20))
            self.assert_says(result, "t.csv", "could not be written", "File too large")
            self.assertNotIn("t.csv", self.files())

    def test_whole_rows(self):
        """What fits stands, to the last whole row."""
        run = ("stability", "g.obj", "-g", "mss", "-n", "1", "--cells", "8", "--runs", "2", "--perturb", "noise",
               "-j", "1")
        self.mskit(*run, "-o", "whole.csv")
        lines = self.read("whole.csv").splitlines(keepends=True)
        self.assertEqual(len(lines), 4)
        room = len(lines[0]) + len(lines[1]) + len(lines[2]) // 2
        result = self.mskit(*run, "-o", "t.csv", code=1, preexec_fn=self.limit(room))
        self.assert_says(result, "t.csv", "1 rows before are intact")
        kept = self.read("t.csv").splitlines(keepends=True)
        self.assertEqual(len(kept), 2)
        self.assertTrue(kept[1].endswith(b"\n"))
        self.assertEqual(kept[0], lines[0])


class Tables(Lost):
    def test_stability_does_not_write_over_its_table(self):
        run = ("stability", "g.obj", "-g", "mss", "-n", "1", "--cells", "8", "--perturb", "seed", "--runs", "1")
        self.mskit(*run)
        for flags in ((), ("-o", "./stability.csv")):
            self.assert_kept(*run, *flags, says=("stability.csv", "exists already", "another file"))

    def test_two_runs_on_one_table(self):
        """The second is refused; the first goes on, and each row is there once."""
        self.shape("grain")
        run = [MSKIT, "compare", "grain.stl", "-g", "variational", "-n", ",".join(map(str, range(1, 30))),
               "--cells", "40", "-j", "1", "-o", "t.csv"]
        with subprocess.Popen(run, cwd=self.dir, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as first:
            first.stdout.readline()  # it has written a row
            result = self.mskit(*run[1:], "--resume", code=1)
            self.assertIsNone(first.poll(), "the first still runs")
            first.communicate(timeout=TIMEOUT)
        self.assert_says(result, "t.csv", "another run")
        rows = list(csv.DictReader(io.StringIO(self.read("t.csv").decode())))
        self.assertEqual([row["n_asked"] for row in rows], [str(n) for n in range(1, 30)])


class Unfinished(Lost):
    def test_clump_without_masses(self):
        """Two spheres of at most 1/100 of the mass each are no particle."""
        run = ("generate", "g.obj", "--cells", "10", "-n", "2", "-j", "1")
        self.mskit(*run, "-o", "plain.csv")
        hopeless = ("--correct", *MASSES, "--most-mass", "0.01")
        result = self.mskit(*run, *hopeless, "-o", "a.csv", "-o", "a.json", "-o", "a.lammps", code=1)
        self.assert_says(result, "without masses", "a.lammps is not written")
        self.assertEqual(self.read("a.csv"), self.read("plain.csv"))
        self.assertEqual(len(json.loads(self.read("a.json"))["spheres"]), 2)
        self.assertNotIn("a.lammps", self.files())
        self.mskit(*run, *hopeless, "-o", "p.liggghts", code=1)
        self.assertIn(b" mass 15900 ", self.read("p.liggghts.in"), "the body's own mass does not hang on the spheres'")
        self.mskit(*run, *hopeless, "-o", "b.lammps", code=1)
        self.assertEqual(self.read("b.lammps.csv"), self.read("plain.csv"),
                         "where no output takes it, behind the first")
        self.assertEqual(self.mskit(*run, *hopeless, "--json", "-o", "c.csv", code=1).json["scores"]["spheres"], 2)

    LONG = ("generate", "grain.stl", "--cells", "150", "-j", "1")

    def interrupt(self, generator, number, seconds):
        """Starts a long run, sends the signal so long after its grid is told, and returns it with its messages."""
        self.shape("grain")
        with subprocess.Popen([MSKIT, *self.LONG, "-g", generator, "-n", "60000", "-o", "a.csv"], cwd=self.dir,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as process:
            process.stderr.readline()  # the size of the grid
            time.sleep(seconds)
            process.send_signal(number)
            err = process.communicate(timeout=TIMEOUT)[1].decode()
        return process.returncode, err

    def time_first_sphere(self, generator):
        """When, after its grid is told, a run begins with its method, and how long that takes to the first sphere."""
        seconds = self.mskit(*self.LONG, "-g", generator, "-n", "1", "--json").json["seconds"]
        return seconds["voxelize"] + seconds["distance"], seconds["generate"]

    def test_interrupted(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            for seconds in (1, 3, 9, 30, 120):  # until there are spheres, however busy the machine is
                code, err = self.interrupt("mss", number, seconds)
                if code != -number:
                    break
            self.assertEqual(code, 1, err)
            spheres = parse_spheres(self.read("a.csv").decode())
            self.assertIn(f"interrupted; the {len(spheres)} spheres so far are written", err)
            self.mskit("generate", "grain.stl", "-g", "mss", "-n", str(len(spheres)), "--cells", "150", "-o", "b.csv")
            self.assertEqual(self.read("a.csv"), self.read("b.csv"), "what the method gives when asked for as many")

    def test_interrupted_while_it_writes(self):
        """No file is left half written, under whatever name."""
        for number in (signal.SIGHUP, signal.SIGINT, signal.SIGABRT, signal.SIGPIPE, signal.SIGTERM):
            for _ in range(10):  # until the signal comes before the end
                with subprocess.Popen([MSKIT, "shape", "ball", "fineness=500", "-o", "ball.stl"], cwd=self.dir,
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
                    while process.poll() is None and not any(f.endswith(".tmp") for f in self.files()):
                        pass
                    process.send_signal(number)
                    code = process.wait(TIMEOUT)
                if code:
                    break
            self.assertEqual(code, -number)
            self.assertEqual([f for f in self.files() if f.endswith(".tmp")], [])

    def test_interrupted_before_there_is_a_clump(self):
        """Of setcover the search for candidates takes long: the signal must not wait for the first sphere."""
        self.shape("grain")
        for generator in ("variational", "setcover"):
            for _ in range(5):  # until it comes between begin and first sphere, however busy the machine is
                begin, takes = self.time_first_sphere(generator) if generator == "setcover" else (1, 0)
                code, _ = self.interrupt(generator, signal.SIGINT, begin + 0.3 * takes)
                if code == -signal.SIGINT:
                    break
            self.assertEqual(code, -signal.SIGINT)
            self.assertEqual([f for f in self.files() if "a.csv" in f], [])
