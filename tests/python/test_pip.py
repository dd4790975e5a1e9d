"""`pip install .` into a virtual environment, as docs/python.md has it, from a copy of the tree: minutes of
compiling."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
MSKIT = os.environ["MSKIT"]


class Pip(unittest.TestCase):
    def run_in(self, folder, *command, code=0):
        clean = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "LD_LIBRARY_PATH")}
        done = subprocess.run(command, cwd=folder, env=clean, text=True, capture_output=True)
        self.assertEqual(done.returncode, code, done.stdout[-3000:] + done.stderr[-3000:])
        return done.stdout

    def test_install_use_remove(self):
        with tempfile.TemporaryDirectory() as folder:
            tree, python = os.path.join(folder, "tree"), os.path.join(folder, "venv", "bin", "python")
            shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns("build*", ".git", ".mesonpy*"))
            self.run_in(folder, sys.executable, "-m", "venv", "--system-site-packages", "venv")
            pip = (python, "-m", "pip")
            self.run_in(tree, *pip, "install", "--no-build-isolation", "--no-index", ".")
            said = self.run_in(folder, python, "-c", "import mskit; print(mskit.__file__)\nclump = mskit.generate("
                               "mskit.body('grain', fineness=8), 'mss', spheres=9, "
                               "cells=20)\nclump.write('module.csv')\n"
                               "print(len(clump._repr_html_()))")
            self.assertIn("site-packages", said)
            self.run_in(folder, MSKIT, "shape", "grain", "fineness=8", "-o", "grain.ply")
            self.run_in(folder, MSKIT, "generate", "grain.ply", "-g", "mss", "-n", "9", "--cells", "20",
                        "-o", "program.csv")
            with open(os.path.join(folder, "module.csv"), "rb") as one, \
                    open(os.path.join(folder, "program.csv"), "rb") as two:
                self.assertEqual(one.read(), two.read())
            self.run_in(folder, *pip, "uninstall", "--yes", "mskit")
            self.run_in(folder, python, "-c", "import mskit", code=1)


if __name__ == "__main__":
    unittest.main()
