"""The line on a terminal: what is at work, its share and time left; wiped in the end, and nothing of it in a pipe."""
import os
import pty
import re
import signal
import subprocess

from support import MSKIT, TIMEOUT, Case

WIPE = "\r\x1b[K"


class Progress(Case):
    def on_terminal(self, *args, enough=lambda said: False):
        """What the run draws on a terminal, as text; standard output goes elsewhere. It is ended where that is
        'enough'."""
        main, terminal = pty.openpty()
        with open(self.path("out.txt"), "wb") as out:
            process = subprocess.Popen([MSKIT, *map(str, args)], cwd=self.dir, stdin=subprocess.DEVNULL, stdout=out,
                                       stderr=terminal)
        os.close(terminal)
        said = b""
        while True:
            try:
                part = os.read(main, 65536)
            except OSError:  # how Linux says that the last one has closed it
                break
            if not part:
                break
            said += part
            if enough(said.decode(errors="replace")):
                process.kill()
                process.wait(TIMEOUT)
                os.close(main)
                return said.decode(errors="replace")
        os.close(main)
        self.assertEqual(process.wait(TIMEOUT), 0, said)
        text = said.decode()
        self.assertEqual(text.split(WIPE)[-1].count(" left"), 0, "the last line is wiped")
        return text

    def lines(self, text):
        """Cut at each drawing."""
        drawn = [part.rstrip() for part in text.split(WIPE)[1:] if "\n" not in part]
        for line in drawn:
            self.assertLess(len(line), 80, "else it could not be wiped")
        return [line for line in drawn if line]

    def assert_of_long_work(self, command, check, *sizes, whole=False):
        """A line is drawn of work that lasts, and how much that is depends on the machine: 'check' must hold of the
        lines of 'command(size)' for one of the sizes, which rise. Unless they are to be those of the 'whole' run, it is
        ended as soon as it does."""
        def holds(text):
            try:
                check(self.lines(text))
                return True
            except AssertionError:
                return False

        for size in sizes:
            text = self.on_terminal(*command(size), enough=lambda said: not whole and holds(said))
            if holds(text):
                return
        check(self.lines(text))

    def assert_drawn(self, lines, *patterns):
        for pattern in patterns:
            self.assertTrue(any(re.search(pattern, line) for line in lines), f"'{pattern}' among {lines}")

    def assert_shares_rise(self, lines):
        shares = [int(found.group(1)) for found in (re.search(r", (\d+) %", line) for line in lines) if found]
        self.assertGreater(len(set(shares)), 1, lines)
        self.assertEqual(shares, sorted(shares), lines)
        self.assertLessEqual(shares[-1], 100)

    def test_variational(self):
        grain = self.shape("grain")

        def check(lines):
            self.assert_drawn(lines, r"^variational: fit of \d+ spheres, \d+ %, about \d+ s left$")
            self.assert_shares_rise([line for line in lines if "fit" in line])

        self.assert_of_long_work(lambda n: ("generate", grain, "-n", n, "--cells", "110", "-j", "1", "-o", "c.csv"),
                                 check, 250, 1000, whole=True)

    def test_sought_number(self):
        """Of several runs, whose number is not known, there is no share."""
        grain = self.shape("grain")

        def check(lines):
            self.assert_drawn(lines, r"^variational: .*spheres.*, \d+ s$")
            self.assertEqual([line for line in lines if "%" in line or "left" in line], [])

        self.assert_of_long_work(lambda limit: ("generate", grain, "--until", f"dice={limit}", "--cells", "60", "-j",
                                                "1", "-o", "c.csv"), check, 0.02, 0.01)

    def test_setcover_before_its_first_sphere(self):
        grain = self.shape("grain")

        def check(lines):
            self.assert_drawn(lines[:1], "^setcover: candidate spheres, 1 s$")
            self.assert_drawn(lines, r"^setcover: \d+ spheres, D 0.\d+, \d+ %, \d+ s$")

        self.assert_of_long_work(lambda deq: ("generate", grain, "-g", "setcover", "--skeleton-deq", deq, "-n", "40",
                                              "--cells", "60", "-j", "1", "-o", "c.csv"), check, 120, 200)

    def test_mss_and_fcm(self):
        grain = self.shape("grain")
        self.assert_of_long_work(lambda cells: ("generate", grain, "-g", "mss", "-n", "60000", "--cells", cells, "-j",
                                                "1", "-o", "c.csv"),
                                 lambda lines: self.assert_drawn(lines, r"^mss: \d+ spheres, D 0.\d+, 0 %, \d+ s$"),
                                 120, 240)
        self.assert_of_long_work(lambda n: ("generate", grain, "-g", "fcm", "-n", n, "--cells", "60", "-j", "1", "-o",
                                            "c.csv"),
                                 lambda lines: self.assert_drawn(lines, r"^fcm: clusters, \d+ s$"), 300, 1200)

    def test_curve(self):
        grain = self.shape("grain")

        def check(lines):
            self.assert_drawn(lines, r"^k.csv: curve, \d+ %, about \d+ s left$")
            self.assert_shares_rise([line for line in lines if line.startswith("k.csv")])

        self.assert_of_long_work(lambda n: ("generate", grain, "-n", n, "--cells", "60", "-j", "1", "-o", "c.csv",
                                            "--curve", "k.csv"), check, 25, 50, 100, whole=True)

    def test_reading(self):
        """Texts of 720,000 triangles and more."""
        self.assert_of_long_work(lambda fine: ("info", self.shape("grain", f"fineness={fine}", name="large.obj")),
                                 lambda lines: self.assert_drawn(lines, r"^large.obj: reading, \d+ s$"), 300, 600)

    def test_voxels(self):
        grain = self.shape("grain")
        self.assert_of_long_work(lambda cells: ("generate", grain, "-g", "mss", "-n", "1", "--cells", cells, "-j", "1",
                                                "-o", "c.csv"),
                                 lambda lines: self.assert_drawn(lines, r"^grain.stl: (voxels|distances), \d+ s$"),
                                 260, 400)

    def test_commands_of_many_runs(self):
        grain = self.shape("grain")
        self.assert_of_long_work(
            lambda n: ("compare", grain, "-g", "variational", "-g", "mss", "-n", f"{n},{n + 10}", "--cells", "110",
                       "-j", "1"),
            lambda lines: self.assert_drawn(lines, r"^grain.stl variational: fit of .* s left$",
                                            r"^2 of 3 runs, \d+ s left$"), 240, 1000)
        self.assert_of_long_work(
            lambda cells: ("stability", grain, "-g", "variational", "-n", "40", "--cells", cells, "-j", "1",
                           "--perturb", "noise", "--runs", "3"),
            lambda lines: self.assert_drawn(lines, r"^2 of 4 runs, \d+ s left$"), 60, 120)
        self.shape("grain", "seed=2", name="other.stl")
        self.write("scene.csv", "shape,count\ngrain.stl,2\nother.stl,3\n")
        self.assert_of_long_work(
            lambda n: ("scene", "scene.csv", "--knee", "0.1", "--max-spheres", n, "--cells", "60", "-j", "1"),
            lambda lines: self.assert_drawn(lines, r"^other.stl \(2 of 2\): curve, \d+ %, about \d+ s left$"),
            15, 30, 60)

    def test_remarks_stand_on_lines_of_their_own(self):
        self.write("far.csv", "0,0,0,0.4\n50,0,0,0.4\n")
        text = self.on_terminal("generate", self.shape("grain"), "-n", "250", "--cells", "110", "-j", "1", "--refine",
                                "far.csv", "-o", "c.csv")
        self.assertRegex(text, r"(?m)^(.*\r\x1b\[K)?variational: 1 of the 2 spheres of refine lie outside[^\r]*\r?$")

    def test_nothing_in_a_pipe(self):
        grain = self.shape("grain")
        for args in (("generate", grain, "-n", "250", "--cells", "110", "-j", "1", "-o", "c.csv"),
                     ("compare", grain, "-g", "setcover", "-n", "10", "--cells", "60", "-j", "1")):
            said = self.mskit(*args).err
            self.assertRegex(said, r"\Agrid: [^\r\x1b]*\n\Z")

    def test_interrupted_at_work(self):
        """The thread that draws takes no signals from the one that works."""
        main, terminal = pty.openpty()
        with subprocess.Popen([MSKIT, "generate", self.shape("grain"), "-n", "60000", "--cells", "150"], cwd=self.dir,
                              stdout=subprocess.DEVNULL, stderr=terminal) as process:
            os.close(terminal)
            while b"variational" not in os.read(main, 65536):
                pass
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(TIMEOUT), -signal.SIGINT)
        os.close(main)
