"""What is written about the module: its docstrings, docs/python.md and the example run; nothing is left out."""
import contextlib
import doctest
import importlib
import inspect
import io
import os
import re
import runpy
import shutil
import subprocess
import sys
import typing
import unittest

import mskit
import numpy
from support_python import PythonCase

DOCS = os.environ["MSKIT_DOCS"]
NAMES = ("_allocate", "_clumps", "_contact", "_errors", "_expect", "_generate", "_measures", "_meshes", "_methods",
         "_scene", "_scene_files", "_scene_rows", "_shapes", "_sources", "_view", "_volumes")


def document(name):
    with open(os.path.join(DOCS, name), encoding="utf-8") as stream:
        return stream.read()


class Docs(PythonCase):
    def setUp(self):
        super().setUp()
        before = os.getcwd()
        os.chdir(self.dir)
        self.addCleanup(os.chdir, before)

    def test_docstrings(self):
        tried = 0
        for module in [mskit] + [importlib.import_module("mskit." + name) for name in NAMES]:
            said = doctest.testmod(module, globs={"mskit": mskit})
            self.assertEqual(said.failed, 0, module.__name__)
            tried += said.attempted
        self.assertGreater(tried, 15)

    def test_page(self):
        code = "\n".join(re.findall(r"```python\n(.*?)```", document("python.md"), re.S))
        with contextlib.redirect_stdout(io.StringIO()) as said:
            exec(compile(code, "python.md", "exec"), {})
        self.assertRegex(said.getvalue(), r"^\(60, 3\) 0\.\d+ 0\.0\d+ spheres\n")
        self.assertTrue(os.path.exists("grain.lammps"))
        self.assertRegex(said.getvalue(), r"\n\[\d+, \d+\] \d+ 0\.0\d+\n$")
        self.assertTrue({"torus-2.5.yade", "scene.liggghts.in", "scene.yade.py"} <= set(os.listdir("bed")))

    def test_example(self):
        with contextlib.redirect_stdout(io.StringIO()) as said:
            made = runpy.run_path(os.path.join(DOCS, "python-example.py"))
        words = said.getvalue()
        for pattern in (r"grain 1: 1\.4\d\d mm\^3, D = 0\.0", r"mss: D of 10", r"grain 2: 3\.\d+ mg",
                        r"\d+ and \d+ spheres: mean D = 0\.0\d+; ten each: 0\.0\d+",
                        r"poses: \d\.\d+ spheres at once, e = 0\."):
            self.assertRegex(words, pattern)
        self.assertIn("<iframe", made["clumps"][1]._repr_html_())
        for name in ("grain-1.lammps", "grain-2.lammps", "grain-1.html"):
            self.assertTrue(os.path.exists(name), name)

    def test_every_public_name(self):
        """Has a docstring and hints of all that it takes and gives, and stands in the page."""
        page = document("python.md")
        for name in mskit.__all__:
            item = getattr(mskit, name)
            if isinstance(item, dict):
                self.assertIn(f"`{name}`", page)
                continue
            self.assertTrue(inspect.getdoc(item), name)
            self.assertRegex(page, rf"`(mskit\.)?{name}\b" if name not in ("Generator", "Measure", "Option", "Particle")
                             else ".")
            if inspect.isfunction(item):
                self.expect_hints(item)
            for part, method in inspect.getmembers(item, inspect.isfunction):
                if not part.startswith("_") and method.__module__.startswith("mskit"):
                    self.assertTrue(method.__doc__, f"{name}.{part}")
                    self.expect_hints(method)

    def expect_hints(self, function):
        hints = typing.get_type_hints(function,
                                      {"Shape": mskit.Shape, "Run": object, **vars(sys.modules[function.__module__])})
        for parameter in inspect.signature(function).parameters:
            if parameter != "self":
                self.assertIn(parameter, hints, function.__qualname__)
        self.assertIn("return", hints, function.__qualname__)

    def test_help_has_every_option(self):
        said = inspect.getdoc(mskit.generate)
        taken = set(inspect.signature(mskit.generate).parameters)
        for generator in mskit.generators.values():
            for option in generator.options.values():
                self.assertIn(f"{option.name}=", said)
                self.assertIn(option.help, said)
                self.assertNotIn(option.name, taken, "an option that generate takes for itself")

    def test_version(self):
        self.assertEqual(self.mskit("--version").out.split()[1].rstrip(","), mskit.__version__)

    def test_defaults_of_options_are_taken(self):
        """What the table says as default gives the same as nothing."""
        for name, generator in mskit.generators.items():
            options = {k: o.default for k, o in generator.options.items() if o.type not in ("plane", "clump")}
            made = [mskit.generate(self.path(self.grain), name, spheres=3, cells=16, **given)
                    for given in ({}, options)]
            self.assertTrue((made[0].spheres == made[1].spheres).all(), name)
            self.assertIsInstance(made[0].spheres, numpy.ndarray)

    @unittest.skipUnless(shutil.which("mypy"), "mypy is not installed")
    def test_hints_are_right(self):
        run = subprocess.run(["mypy", "--disallow-untyped-defs", "--ignore-missing-imports", "--cache-dir",
                              os.devnull, os.path.dirname(mskit.__file__)], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stdout)


if __name__ == "__main__":
    unittest.main()
