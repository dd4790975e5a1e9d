"""Names and environments that break careless programs."""
import os
import re
import stat
import subprocess

from support import MSKIT, TIMEOUT, Case, box_obj

RUN = ("--cells", "20", "-n", "3", "-j", "1")


class Names(Case):
    def test_odd_names(self):
        for name in ("with blank", "100%s%n%d", "-dash", "ümlaut", "quo'te\"", "new\nline", "a;b|c&d", "$(HOME)", "*",
                     "x" * 200, "dot.dot.dot", ".hidden", "#", "\\"):
            with self.subTest(name=name):
                shape, clump, record = (f"{name}.{ending}" for ending in ("obj", "csv", "json"))
                self.write(shape, box_obj((0, 0, 0), (3, 2, 1)))
                out = self.mskit("generate", *RUN, "-o", clump, "-o", record, "--", shape).out
                self.assertIn(f"wrote {clump}\n", out)
                self.assertEqual(len(self.spheres(clump)), 3)
                self.assertEqual(self.mskit("info", "--json", "--", shape).json["path"], shape)
                self.mskit("score", "--target", shape, "--cells", "20", "--", clump)
                self.mskit("generate", *RUN, "--", shape)
                self.assertIn(re.sub('[\n"$\\\\*|]', "_", name) + "-variational.csv", self.files())
                result = self.assert_refused("info", "--", name + "missing.stl", code=1)
                self.assertIn(name + "missing.stl: cannot be opened", result.err)

    def test_names_that_are_not_utf8(self):
        """JSON takes UTF-8 only; the run must not be lost over it."""
        shape = b"lat\xe9in.obj"
        with open(os.path.join(os.fsencode(self.dir), shape), "w", encoding="ascii") as f:
            f.write(box_obj((0, 0, 0), (3, 2, 1)))
        self.assertEqual(self.mskit("info", "--json", shape).json["path"], "lat?in.obj")
        record = self.mskit("generate", "--json", *RUN, shape, "-o", "c.json").json
        self.assertEqual(record["input"]["path"], "lat?in.obj")

    def test_upper_case_endings(self):
        self.write("BOX.OBJ", box_obj((0, 0, 0), (3, 2, 1)))
        self.mskit("generate", "BOX.OBJ", *RUN, "-o", "C.CSV")
        self.assertEqual(len(self.spheres("C.CSV")), 3)

    def test_long_missing_name(self):
        self.assert_refused("info", "x" * 5000 + ".stl", code=1)
        self.assert_refused("generate", "x" * 5000 + ".stl", code=1)


class Environment(Case):
    def setUp(self):
        super().setUp()
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))
        self.mskit("generate", "box.obj", *RUN, "-o", "a.csv")

    def test_locale(self):
        """Numbers keep their point whatever the locale says."""
        for locale in ("de_DE.UTF-8", "C", "tr_TR.UTF-8", "nonsense"):
            self.mskit("generate", "box.obj", *RUN, "-o", "b.csv", env={**os.environ, "LC_ALL": locale})
            self.assertEqual(self.read("a.csv"), self.read("b.csv"), locale)

    def test_empty_environment(self):
        self.mskit("generate", "box.obj", *RUN, "-o", "b.csv", env={})
        self.assertEqual(self.read("a.csv"), self.read("b.csv"))

    def test_threads_of_the_environment(self):
        run = self.mskit("generate", "box.obj", "--cells", "20", "-n", "3", "--json", "-o", "b.csv",
                         env={**os.environ, "OMP_NUM_THREADS": "1"}).json
        self.assertEqual(run["threads"], 1)
        self.assertEqual(self.read("a.csv"), self.read("b.csv"))

    def test_too_many_threads_in_the_environment(self):
        """The bound of -j; without it the run time ends by a signal."""
        self.assert_refused("info", "box.obj", code=2, says=("OMP_NUM_THREADS", "1024"),
                            env={**os.environ, "OMP_NUM_THREADS": "100000"})

    def test_threads_soon_sleep_while_they_wait(self):
        """As users start it, without OMP_WAIT_POLICY: what the run time says last is how the program runs."""
        env = {key: value for key, value in os.environ.items() if key not in ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT")}
        env["OMP_DISPLAY_ENV"] = "verbose"
        said = re.findall(r"GOMP_SPINCOUNT = '(\d+)'", self.mskit("--version", env=env).err)
        if not said:
            self.skipTest("this OpenMP has no GOMP_SPINCOUNT; libgomp has")
        self.assertEqual(said[-1], "500")
        said = re.findall(r"GOMP_SPINCOUNT = '(\d+)'",
                          self.mskit("--version", env={**env, "OMP_WAIT_POLICY": "active"}).err)
        self.assertGreater(int(said[-1]), 0, "what the user sets stands")

    def test_flags_behind_words_whatever_posix_says(self):
        self.mskit("generate", "box.obj", *RUN, "-o", "b.csv", env={**os.environ, "POSIXLY_CORRECT": "1"})
        self.assertEqual(self.read("a.csv"), self.read("b.csv"))

    def test_a_reader_that_stops_reading(self):
        """As head does: no message, no file left."""
        writer = subprocess.Popen([MSKIT, "shape", "ball", "-o", "-"], cwd=self.dir, stdout=subprocess.PIPE,
                                  stderr=subprocess.DEVNULL)
        writer.stdout.read(10)
        writer.stdout.close()
        self.assertNotEqual(writer.wait(TIMEOUT), 0)
        self.assertEqual(self.files(), ["a.csv", "box.obj"])

    def test_pipe_as_output(self):
        os.mkfifo(self.path("pipe"))
        with subprocess.Popen(["cat", "pipe"], cwd=self.dir, stdout=subprocess.PIPE) as reader:
            self.mskit("generate", "box.obj", *RUN, "--format", "csv", "-o", "pipe")
            self.assertEqual(reader.communicate(timeout=TIMEOUT)[0], self.read("a.csv"))
        self.assertTrue(stat.S_ISFIFO(os.stat(self.path("pipe")).st_mode), "the pipe is still one")

    def test_pipe_as_input(self):
        """Must not wait for a writer."""
        for name in ("pipe.stl", "pipe.npy", "pipe.csv"):
            os.mkfifo(self.path(name))
        for args in (("info", "pipe.stl"), ("info", "pipe.npy"), ("score", "pipe.csv", "--target", "box.obj")):
            self.assert_refused(*args, code=1, says=("pipe", "regular file"))
