"""Names of shapes, clumps and files are data in every file that any command writes."""
import ast
import csv
import glob
import io
import json
import os
import re
import shutil
import subprocess
import unittest
import xml.etree.ElementTree

from support import Case, box_obj

RUN = ("--cells", "12", "-n", "6", "-j", "1")
NAMES = {"quote": "O'Brien", "double quote": 'say "no"', "backtick": "a'`touch PWNED`",
         "dollar": "$(touch PWNED)$x${y}", "newline": "a\nshell touch PWNED\nsystem('touch PWNED')\n#", "blank": "a b",
         "percent": "100%s%n%d", "hash": "#a", "formula": "=cmd|'touch PWNED'!A1", "plus": "+1",
         "minus": "-1", "at": "@SUM(1)", "backslash": "a\\n\\'b",
         "python": "b');__import__('os').system('touch PWNED')#", "gnuplot": "a'; system('touch PWNED'); #",
         "pipe": "< touch PWNED", "markup": "a_{b}^c&<d>", "continued": "a &", "latin": b"lat\xe9in",
         "letter": "\u00fc\u7c92"}



class Hostile(Case):
    """Runs a check on a shape of each name."""

    def each(self, check):
        for what, name in NAMES.items():
            with self.subTest(what):
                for old in [*glob.glob(os.path.join(glob.escape(self.dir), "*")),
                            *glob.glob(os.path.join(self.dir, ".*"))]:
                    shutil.rmtree(old) if os.path.isdir(old) else os.unlink(old)
                name = name if isinstance(name, bytes) else name.encode()
                shape = name + b".obj"
                with open(os.path.join(os.fsencode(self.dir), shape), "w", encoding="ascii") as f:
                    f.write(box_obj((0, 0, 0), (3, 2, 1)))
                check(shape)
                self.assertNotIn("PWNED", os.listdir(self.dir), "a name was run")
                self.assertEqual(glob.glob(os.path.join(self.dir, "*", "PWNED")), [], "a name was run")

    def texts(self, folder="."):
        """Of all files but shapes and pictures, by name; all are UTF-8."""
        found = {}
        for name in os.listdir(os.path.join(self.dir, folder)):
            path = os.path.join(self.dir, folder, name)
            if os.path.isfile(path) and not name.endswith((".obj", ".png")):
                with open(path, "rb") as f:
                    found[name] = f.read().decode("utf-8")
        return found

    def check_lines(self, texts):
        """No line of a script begins with what stands in a name behind an end of line, in no form of a name."""
        for name, text in texts.items():
            self.assertNotRegex(text, r"(?m)^(shell|system)", name)
            self.assertNotRegex(name, "[\n\"$`\\\\<>|*?]", "a generated name")


class Templates(Hostile):
    def test_generate(self):
        def check(shape):
            formats = [w for f in ("csv", "json", "vtk", "lammps", "liggghts", "yade", "deme", "kratos", "mfix", "pfc")
                       for w in ("--format", f)]
            self.mskit("generate", *RUN, "--correct", "--density", "2650", *formats, "--curve", "curve.csv",
                       "--target-grid", "grid.vtk", "--", shape, code=0)
            os.unlink(self.path("grid.vtk"))
            texts = self.texts()
            self.check_lines(texts)
            by_ending = {name.rsplit(".", 1)[1]: (name, text) for name, text in texts.items()}
            self.check_scripts(by_ending)
            record = json.loads(by_ending["json"][1] if not by_ending["json"][0].endswith("frame.json")
                                else next(t for n, t in texts.items() if n.endswith("-variational.json")))
            self.assertEqual(record["input"]["path"], shape.decode("utf-8", "replace").replace("\ufffd", "?"))

        self.each(check)

    def check_scripts(self, files):
        tree = ast.parse(files["py"][1])
        imports = [n.names[0].name for n in ast.walk(tree) if isinstance(n, (ast.Import, ast.ImportFrom))]
        self.assertEqual(sorted(imports), ["math", "random", "sys", "ymport"])
        read = [n.args[0].value for n in ast.walk(tree) if isinstance(n, ast.Call)
                and getattr(n.func, "attr", "") == "text"]
        self.assertEqual(read, [files["yade"][0]], "Python reads the name of the file")
        self.assertEqual([line for line in files["pfc"][1].splitlines() if line.count('"') not in (0, 2)], [])
        self.assertTrue(files["pfc"][1].startswith('clump template create name "'))
        lines = files["clu"][1].splitlines()
        self.assertEqual((lines[0], lines[3]), ("Name", "Begin centers_and_radii"))
        self.assertEqual(len(lines[1].split()), 1)
        for vtk in (files["vtk"][1],):
            self.assertRegex(vtk, r"\A# vtk DataFile Version 3.0\nclump by mskit [^\n]*\nASCII\n")

    def test_names_that_scripts_cannot_hold(self):
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))
        for name in ("a\nb", "\"'", b"lat\xe9in"):
            for ending in ("lammps", "liggghts"):
                output = (name if isinstance(name, bytes) else name.encode()) + b"." + ending.encode()
                self.assert_refused("generate", "box.obj", *RUN, "--correct", "--density", "1", "-o", output, code=1,
                                    says=("no script",))

    def test_scene(self):
        def check(shape):
            self.mskit("scene", "-g", "mss", "--knee", "0.3", "--max-spheres", "3", "--cells", "10", "-o", "t",
                       "--format", "json", "--", shape)
            self.check_lines(self.texts("t"))
            for text in self.texts("t").values():
                json.loads(text)

        self.each(check)

    def test_json_of_all_commands(self):
        def check(shape):
            wanted = shape.decode("utf-8", "replace").replace("\ufffd", "?")
            self.assertEqual(self.mskit("info", "--json", "--", shape).json["path"], wanted)
            self.mskit("generate", *RUN, "-o", "c.csv", "--", shape)
            self.assertEqual(self.mskit("score", "--json", "--cells", "10", "--target", b"./" + shape,
                                        "c.csv").json["target"]["path"], "./" + wanted)
            run = self.mskit("stability", "--json", "-g", "mss", "-n", "2", "--cells", "8", "--perturb", "seed",
                             "--runs", "1", "--", shape).json
            self.assertEqual(run[0]["shape"], wanted)
            os.unlink(self.path("stability.csv"))

        self.each(check)


class Tables(Hostile):
    def check_csv(self, name, shape, column="shape"):
        with open(self.path(name), newline="", encoding="utf-8") as f:
            rows = list(csv.DictReader(f))
        self.assertTrue(rows)
        for row in rows:
            for cell in row.values():
                self.assertNotRegex(cell, r"\A[=+@]|\A-(?![0-9.])", "a spreadsheet would run it")
            self.assertEqual(row[column], self.cell(shape))
            if "?" not in row[column]:
                self.assertTrue(os.path.exists(self.path(row[column])), "the cell names the file")

    @staticmethod
    def cell(shape):
        text = re.sub("[\x00-\x1f]", "?", shape.decode("utf-8", "replace").replace("\ufffd", "?"))
        return "./" + text if text[0] in "=+-@" else text

    def test_compare(self):
        has_gnuplot = shutil.which("gnuplot")
        def check(shape):
            shutil.copy(os.path.join(os.fsencode(self.dir), shape), self.path("c.obj"))
            self.mskit("generate", "c.obj", *RUN, "-o", "c.csv")
            other = shape[:-4] + b".xyz"
            os.rename(self.path("c.csv"), os.path.join(os.fsencode(self.dir), other))
            self.mskit("compare", "-g", "mss", "-n", "3", "--cells", "8", "--clump", b"+other=" + other,
                       "--charts", "c", "-o", "t.csv", "-j", "1", "--", shape, code=0 if has_gnuplot else 1)
            self.check_csv("t.csv", shape)
            self.check_lines(self.texts("c"))
            if has_gnuplot:
                self.check_pictures("c")

        self.each(check)

    def check_pictures(self, folder):
        names = os.listdir(self.path(folder))
        stems = {name[:-3] for name in names if name.endswith(".gp") and not name.endswith("-sheet.gp")}
        self.assertTrue(stems)
        for stem in stems:
            xml.etree.ElementTree.parse(os.path.join(self.dir, folder, stem + ".svg"))
            self.assertIn(stem + ".png", names)
        self.assertTrue(any(name.endswith("-sheet.png") for name in names), names)

    def test_stability(self):
        has_gnuplot = shutil.which("gnuplot")
        def check(shape):
            self.mskit("stability", "-g", "mss", "-n", "2", "--cells", "8", "--perturb", "noise", "--runs", "2", "-o",
                       "t.csv", "--charts", "c", "-j", "1", "--", shape, code=0 if has_gnuplot else 1)
            self.check_csv("t.csv", shape)
            self.check_lines(self.texts("c"))
            if has_gnuplot:
                self.assertTrue(glob.glob(self.path("c/*-all.png")))

        self.each(check)

    def test_causes(self):
        """Messages begin with the name of the file."""
        for name in ("=1", "+1", "-1", "@1"):
            self.write(name + ".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
            self.mskit("compare", "-g", "mss", "-n", "1", "--cells", "8", "-o", f"t{name}.csv", "--", name + ".obj",
                       code=1)
            rows = list(csv.DictReader(io.StringIO(self.read(f"t{name}.csv").decode())))
            self.assertTrue(rows[0]["cause"].startswith(("'" + name, "./" + name)), rows[0]["cause"])


class Charts(Case):
    @unittest.skipUnless(shutil.which("gnuplot"), "gnuplot is not installed")
    def test_a_plain_apostrophe(self):
        self.shape("cube", name="O'Brien.stl")
        self.mskit("compare", "O'Brien.stl", "-g", "mss", "-n", "1,3", "--cells", "8", "--charts", "c")
        for name in ("O'Brien-dice.svg", "O'Brien-dice.png", "O'Brien-sheet.png"):
            self.assertGreater(os.path.getsize(self.path("c/" + name)), 1000)
        self.assertIn("O'Brien: ",
                      self.read("c/O'Brien-dice.svg").decode().replace("&apos;", "'").replace("&#39;", "'"))
        done = subprocess.run(["gnuplot", "O'Brien-dice.gp"], cwd=self.path("c"), check=False)
        self.assertEqual(done.returncode, 0, "the script draws it again, by hand")
