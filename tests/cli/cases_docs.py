"""The documents: every command in the guide runs, the man page and the formats name all there is."""
import glob
import json
import os
import re
import shlex
import shutil
import subprocess
import unittest

from support import MSKIT, TIMEOUT, Case, box_obj, npy

DOCS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs")


def document(name):
    path = os.path.join(DOCS, name)
    if not os.path.exists(path):
        raise unittest.SkipTest(f"{path} is missing")
    with open(path, encoding="utf-8") as f:
        return f.read()


def keys(value):
    """All keys of nested objects."""
    if not isinstance(value, dict):
        return set()
    return set(value).union(*(keys(inner) for inner in value.values()))


class Documents(Case):
    def test_commands_of_the_guide(self):
        """In order, in one folder, which holds an open mesh, a scan with two labels, the guide's manifest and sieve
        curve, and two grains with a coarse clump each. The tables of scenes are those that the commands print."""
        self.write("open.obj", box_obj((0, 0, 0), (3, 2, 1), skip=1))
        self.write("scan.npy", npy([1] * 50 + [2] * 950, (10, 10, 10)))
        os.mkdir(self.path("grains"))
        os.mkdir(self.path("coarse"))
        for k in (1, 2):
            self.write(f"grains/box-{k}.obj", box_obj((0, 0, 0), (3, 2, k)))
            self.write(f"coarse/box-{k}.csv", "1,1,0.5,0.5\n2,1,0.5,0.5\n")
        guide = document("guide.md")
        manifest = re.search(r"(?m)^    shape,count\n(    .+\n)+", guide).group(0)
        self.write("scene.csv", manifest.replace("    ", ""))
        curve = re.search(r"(?m)^    printf '(size,passing.+)' > curve\.csv$", guide).group(1)
        self.write("curve.csv", curve.replace("\\n", "\n"))
        commands = re.findall(r"(?m)^ {4,}mskit (.+)$", guide)
        self.assertGreater(len(commands), 20)
        said = []
        for command in commands:
            if "--charts" in command and not shutil.which("gnuplot"):
                print(f"gnuplot is not installed (package gnuplot-nox): not run: mskit {command}")
                continue
            with self.subTest(command=command):
                said.append(self.mskit(*shlex.split(command, comments=True)).out)
        tables = re.findall(r"(?m)^    \S+ with \w+: .+\n(?:    .+\n)+", guide)
        self.assertGreater(len(tables), 1)
        for table in tables:
            table = re.sub(r"(?m)^    ", "", table)
            self.assertTrue(any(table in out for out in said), f"the guide shows what no command prints:\n{table}")
        self.assertEqual(self.read("one.csv"), self.read("two.csv"))
        self.assertEqual(self.read("c.csv"), self.read("d.csv"))

    def readme(self):
        """The README's blocks of commands, without comments, in order."""
        text = document(os.path.join("..", "README.md"))
        return text, [re.sub(r"  +#.*", "", line).strip()
                      for line in re.findall(r"(?m)^ {4}(?!  | *\w+/ )(\S.+)$", text)
                      if re.match(r"sh |build/|export |mskit |printf |meson ", line)]

    def test_commands_of_the_readme(self):
        """Each line pasted into one shell, from a fresh clone: what installs and builds is here already."""
        _, lines = self.readme()
        self.assertGreater(len(lines), 14)
        self.assertIn("sh docs/quickstart.sh", lines)
        self.assertIn("sh tests/run.sh", lines)
        for folder in ("docs", "tests", "build/eval"):
            os.makedirs(self.path(folder))
        program = os.path.abspath(shutil.which(MSKIT))
        os.symlink(program, self.path("build/eval/mskit"))
        quickstart = [line for line in document("quickstart.sh").replace("\\\n", "").splitlines()
                      if line.startswith(("mkdir", "build/"))]
        self.assertEqual(len(quickstart), 3)
        self.write("docs/quickstart.sh", "\n".join(["set -e", *quickstart]))
        self.write("tests/run.sh", "")
        self.write("docs/install-packages.sh", "")
        if not shutil.which("gnuplot"):
            print("gnuplot is not installed (package gnuplot-nox): charts are not drawn")
            lines = [line.split(" --charts")[0] for line in lines]
        shell = subprocess.run(["sh", "-e"], input="\n".join(lines), cwd=self.dir, capture_output=True, text=True,
                               check=False, timeout=TIMEOUT)
        self.assertEqual(shell.returncode, 0, shell.stderr[-2000:])
        for made in ("demo/grain.csv", "compare.csv", "grain.lammps", "templates", "mss.csv"):
            self.assertTrue(os.path.exists(self.path(made)), made)

    def test_links(self):
        """Of README and documents: to files and headings that are there; the picture among them."""
        documents = [os.path.join(DOCS, "..", "README.md"), *glob.glob(f"{DOCS}/**/*.md", recursive=True)]
        links = [(own, *link) for own in documents
                 for link in re.findall(r"\]\(([^)#:]*)(?:#([\w-]+))?\)", document(own))]
        self.assertIn((documents[0], "docs/grain.png", ""), links)
        self.assertGreater(len(links), 100)
        for own, path, heading in links:
            target = os.path.join(os.path.dirname(own), path) if path else own
            self.assertTrue(os.path.exists(target), f"{own}: {path}")
            if heading:
                headings = [re.sub(r"[^\w -]", "", h).strip().lower().replace(" ", "-")
                            for h in re.findall(r"(?m)^#+ (.+)$", document(target))]
                self.assertIn(heading, headings, f"{own}: {path}")

    def test_scripts_of_docs_can_be_run(self):
        scripts = [path for ending in ("sh", "py") for path in glob.glob(f"{DOCS}/**/*.{ending}", recursive=True)]
        self.assertIn(os.path.join(DOCS, "make-validation.sh"), scripts)
        for script in scripts:
            with open(script, "rb") as stream:
                if stream.read(2) == b"#!":
                    self.assertTrue(os.access(script, os.X_OK), script)

    def test_man_pages_name_every_command_and_flag(self):
        overview = document("mskit.1")
        for command in re.findall(r"(?m)^  (\w+) +\w", self.mskit("--help").out):
            self.assertRegex(overview, rf"(?m)^\.B {command}$")
            with open(os.path.join(os.path.dirname(MSKIT), "..", "docs", f"mskit-{command}.1"),
                      encoding="utf-8") as stream:
                page = stream.read().replace("\\-", "-")
            said = self.mskit(command, "--help").out
            flags = re.findall(r"(?m)^ +(?:-\w, )?(--[a-z][a-z-]*)", said)
            self.assertEqual(re.findall(r"(?m)^\\fB(?:-\w, )?(--[a-z-]+)\\fR", page), flags, command)
            self.assertIn(said.split("example: ")[1].strip(), page)

    def test_man_page_names_no_other_flags(self):
        page = document("mskit.1").replace("\\-", "-")
        known = {"--version", "--help"}
        for command in re.findall(r"(?m)^  (\w+) +\w", self.mskit("--help").out):
            known |= set(re.findall(r"--[a-z][a-z-]*", self.mskit(command, "--help").out))
        for option in re.findall(r"(?m)^  ([a-z-]+)[= ]", self.mskit("help", "mss").out):
            known.add("--" + option)
        for flag in set(re.findall(r"--[a-z][a-z-]*", page)):
            self.assertIn(flag, known, "the man page names a flag that does not exist")

    def test_formats_name_every_key(self):
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))
        self.write("scan.npy", npy([1] * 1000, (10, 10, 10)))
        text = document("formats.md")
        for shape in ("box.obj", "scan.npy"):
            grid = ("--cells", "20") if shape == "box.obj" else ()
            self.mskit("generate", shape, *grid, "-n", "2", "-o", "c.json", "-o", "c.csv")
            self.mskit("correct", "c.csv", "--target", shape, *grid, "--density", "1", "-o",
                       "d.json", "-o", "d.yade")
            records = [json.loads(self.read("c.json")), json.loads(self.read("d.json")),
                       json.loads(self.read("d.frame.json")), self.mskit("info", shape, "--json").json,
                       self.mskit("score", "c.csv", "--target", shape, *grid, "--json").json,
                       self.mskit("scene", shape, *grid, "-g", "mss", "--tolerance", "dice=0.5", "--json").json]
            records += records[-1]["shapes"]
            contact = self.mskit("contact", "c.csv", "--target", shape, "--poses", "2", "--json").json
            records += [contact, *contact["contacts"], *contact["sled"]["drags"], *contact["clump"]["poses"]]
            about, command = (self.mskit("help", name, "--json").json for name in ("mss", "score"))
            records += about["options"] + [about, command] + command["flags"] + self.mskit("generators", "--json").json
            kinds = self.mskit("shape", "--list", "--json").json
            records += kinds + kinds[0]["parameters"]
            for record in records:
                record.pop("options", None)  # those of a method are on its own page
                for key in keys(record):
                    self.assertIn(f"`{key}`", text, f"formats.md does not explain '{key}'")
        self.mskit("compare", "box.obj", "-g", "mss", "-n", "1", "--cells", "8")
        for column in self.read("compare.csv").decode().split("\n")[0].split(","):
            self.assertIn(f"`{column}`", text, f"formats.md does not explain the column '{column}'")
