#!/usr/bin/env python3
"""Names of files are data to the engines: their scripts load the template, whatever it is called, and run nothing else.

    MSKIT=build/eval/mskit tests/engines/test_names.py [-v]

Every engine that is not installed is skipped.
"""
import os
import shutil
import subprocess
import tempfile
import unittest

MSKIT = os.environ.get("MSKIT", "mskit")
TIMEOUT = 1200  # seconds
# Of shapes: the names of their templates follow from them.
SHAPES = ("a\nshell touch PWNED\n#", "b');__import__('os').system('touch PWNED')#", "c\" shell touch PWNED",
          "d & $x ${y}", "`touch PWNED`$(touch PWNED)", "=1+1 %d", "O\u2019Brien \u201cx\u201d", "\u00fcmlaut",
          "\u7c92")
# Of templates, given by --output.
TEMPLATES = ("it's", "with blank", "say \"no\"", "d & $x ${y} $(touch PWNED)", "`touch PWNED`", "# % = ' ; | \\n", "=1",
             "'; shell touch PWNED")
FORMATS = {"lammps": ((("lmp", "-in"), ("lammps", "-in")), ".in"), "liggghts": ((("liggghts", "-in"),), ".in"),
           "yade": ((("yade", "-x", "-n", "-j1"), ("yadedaily", "-x", "-n", "-j1")), ".py")}


def program_of(ending):
    for command in FORMATS[ending][0]:
        if shutil.which(command[0]):
            return list(command)
    return None


def shorten(script):
    """A few steps are enough: the template has been loaded then."""
    with open(script, encoding="utf-8") as f:
        lines = f.read().splitlines()
    with open(script, "w", encoding="utf-8") as f:
        for line in lines:
            line = "run 10" if line.startswith("run ") else "thermo 10" if line.startswith("thermo ") else line
            f.write(line.replace("range(10)", "range(1)") + "\n")
            if "O.run(" in line:
                f.write("    break\n")


class Names(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="mskit-names-")
        self.addCleanup(folder.cleanup)
        self.dir = folder.name
        self.mskit("shape", "grain", "-o", "plain.stl")

    def mskit(self, *args):
        done = subprocess.run([MSKIT, *args], cwd=self.dir, capture_output=True, timeout=TIMEOUT, check=False)
        self.assertEqual(done.returncode, 0, f"{args}: {done.stderr.decode('utf-8', 'replace')}")

    def generate(self, shape, *more):
        self.mskit("generate", "-n", "6", "--cells", "15", "--correct", "--density", "2650", "-j", "1",
                   *more, "--", shape)

    def run_script(self, ending, template):
        """Runs the script beside the template; the template must have been read and nothing else been run."""
        script = template + FORMATS[ending][1]
        shorten(os.path.join(self.dir, script))
        with open(os.path.join(self.dir, script), encoding="utf-8") as f:
            text = f.read()
        environment = {**os.environ, "OMP_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": "1"}
        done = subprocess.run(program_of(ending) + ["./" + script], cwd=self.dir, capture_output=True, timeout=TIMEOUT,
                              check=False, env=environment)
        said = (done.stdout + done.stderr).decode("utf-8", "replace")
        self.assertEqual(done.returncode, 0, f"{text}\n{said}")
        self.assertNotIn("Traceback", said, text)
        self.assertNotIn("PWNED", os.listdir(self.dir), text)

    def check(self, ending, few=None):
        if not program_of(ending):
            self.skipTest(f"{ending} is not installed")
        for name in SHAPES[:few]:
            with self.subTest(shape=name):
                before = set(os.listdir(self.dir))
                shape = name + ".stl"
                shutil.copy(os.path.join(self.dir, "plain.stl"), os.path.join(self.dir, shape))
                self.generate(shape, "--format", ending)
                made = set(os.listdir(self.dir)) - before - {shape}
                self.run_script(ending, next(f for f in made if f.endswith("." + ending)))
        for name in TEMPLATES[:few]:
            with self.subTest(template=name):
                self.generate("plain.stl", "-o", f"{name}.{ending}")
                self.run_script(ending, f"{name}.{ending}")

    def test_lammps(self):
        self.check("lammps")

    def test_liggghts(self):
        self.check("liggghts")

    def test_yade(self):
        self.check("yade", 3)  # it takes seconds to start


if __name__ == "__main__":
    unittest.main()
