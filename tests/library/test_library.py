"""The library as it is installed: what it exports, its headers, its pkg-config file, the program of docs/library.md."""

import os
import re
import shlex
import shutil
import subprocess
import tempfile
import unittest

BUILD = os.environ["MSKIT_BUILD"]
DOCS = os.environ["MSKIT_DOCS"]
CC = shlex.split(os.environ["MSKIT_CC"])  # with the flags that a sanitizer takes
CXX = shlex.split(os.environ["MSKIT_CXX"])  # empty: there is none
COMPILER = ("__", "mangle_path", ".gomp_critical_user_.")  # sanitizers, coverage, unnamed locks of clang
STRICT = ["-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]


def run(*command, **more):
    done = subprocess.run(command, text=True, capture_output=True, **more)
    if done.returncode != 0:
        raise AssertionError(f"{shlex.join(command)}\n{done.stdout}{done.stderr}")
    return done.stdout


def without_bodies(text):
    """Without what stands in braces, the innermost first; extern "C" keeps what is in it."""
    text = re.sub(r'extern "C" \{', "", text)
    while True:
        shorter = re.sub(r"\{[^{}]*\}", "{}" if "{" not in text else " ", text)
        if shorter == text:
            return text
        text = shorter


def declared(preprocessed):
    """Names of the functions and data with external linkage that the mskit headers declare."""
    ours, mine = [], False
    for line in preprocessed.splitlines():
        mark = re.match(r'# \d+ "(.*)"', line)
        if mark:
            mine = "/include/mskit/" in mark[1]
        elif mine:
            ours.append(line)
    text = re.sub(r"__attribute__\s*\(\((?:[^()]|\([^()]*\))*\)\)", "", without_bodies("\n".join(ours)))
    names = set()
    for declaration in re.sub(r"static inline[^;]*?\)\s(?=\s*\S)", "", text).split(";"):
        if re.match(r"\s*(typedef|static)\b", declaration):
            continue
        found = (re.match(r"[\w\s*]*?\b(\w+)\s*\(", declaration)
                 or re.match(r"\s*extern\b[^=]*?\b(\w+)\s*\[", declaration))
        if found:
            names.add(found[1])
    return names


class Library(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="installed-", dir=BUILD)
        run(os.environ["MESON"], "install", "--no-rebuild", "--quiet", "-C", BUILD, "--destdir", cls.folder)
        found = [os.path.dirname(os.path.join(at, "mskit.pc")) for at, _, names in os.walk(cls.folder) if
                 "mskit.pc" in names]
        cls.lib = os.path.dirname(found[0])
        cls.environment = {**os.environ, "PKG_CONFIG_PATH": found[0], "LD_LIBRARY_PATH": cls.lib}
        cls.cflags = cls.pkg_config("--cflags")
        cls.include = next(flag[2:] for flag in cls.cflags if flag.endswith("/include"))
        cls.headers = sorted(os.path.relpath(os.path.join(at, name), cls.include)
                             for at, _, names in os.walk(os.path.join(cls.include, "mskit")) for name in names)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def pkg_config(cls, *flags):
        return shlex.split(run("pkg-config", "--define-prefix", *flags, "mskit", env=cls.environment))

    def test_exports_are_what_the_headers_declare(self):
        source = "".join(f"#include <{header}>\n" for header in self.headers)
        names = declared(run(*CC, "-E", "-x", "c", *self.cflags, "-", input=source))
        listed = run("nm", "-D", "--defined-only", os.path.join(self.lib, "libmskit.so"))
        exported = {line.split()[-1] for line in listed.splitlines()}
        exported = {name for name in exported if not name.startswith(COMPILER)}
        self.assertGreater(len(names), 80)
        self.assertEqual(exported, names)

    def test_names_that_leave_a_file_have_the_prefix(self):
        for archive in ("common/libcommon.a", "generators/libgenerators.a"):
            for line in run("nm", "-g", "--defined-only", os.path.join(BUILD, archive)).splitlines():
                words = line.split()
                if len(words) == 3 and not words[2].startswith(COMPILER):
                    self.assertRegex(words[2], "^ms_", archive)

    def test_nothing_of_gsl_that_allocates(self):
        """Where there is no memory it would call GSL's error handler, which aborts."""
        used = re.findall(r"\bgsl_\w+", run("nm", "-D", "--undefined-only", os.path.join(self.lib, "libmskit.so")))
        self.assertIn("gsl_eigen_symmv", used)
        self.assertEqual([name for name in used if re.search("alloc|free|read|clone", name)], [])

    def test_each_header_stands_alone(self):
        for header in self.headers:
            with self.subTest(header=header):
                source = f"#include <{header}>\ntypedef int header_is_alone;\n"
                run(*CC, "-std=c11", *STRICT, "-x", "c", *self.cflags, "-", input=source)
                if CXX:
                    run(*CXX, "-std=c++11", *STRICT, "-x", "c++", *self.cflags, "-", input=source)

    def test_umbrella_includes_all_but_dev(self):
        with open(os.path.join(self.include, "mskit", "mskit.h"), encoding="utf-8") as file:
            included = re.findall(r'#include "(.*)"', file.read())
        public = [header[len("mskit/"):] for header in self.headers if not header.startswith("mskit/dev/")]
        self.assertEqual(sorted(included), sorted(set(public) - {"mskit.h"}))

    def test_docs_name_each_header(self):
        with open(os.path.join(DOCS, "library.md"), encoding="utf-8") as file:
            text = file.read()
        for header in self.headers:
            self.assertIn(header if header == "mskit/mskit.h" else f"`{header[len('mskit/'):]}`", text)

    def test_pkg_config_names_openmp_once(self):
        self.assertEqual(self.pkg_config("--libs", "--static").count("-fopenmp"), 1)
        self.assertIn("-lmskit", self.pkg_config("--libs"))

    def test_program_of_the_docs(self):
        with open(os.path.join(DOCS, "library.md"), encoding="utf-8") as file:
            source = re.search(r"```c\n(.*?)```", file.read(), re.S)[1]
        self.assertLessEqual(len(source.splitlines()), 40)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "clump.c")
            with open(path, "w", encoding="utf-8") as file:
                file.write(source)
            program = os.path.join(folder, "clump")
            run(*CC, "-std=c11", "-Wall", "-Wextra", "-Werror", path, "-o", program,
                *self.pkg_config("--cflags", "--libs"))
            mskit = os.environ["MSKIT"]
            run(mskit, "shape", "grain", "fineness=12", "-o", "grain.stl", cwd=folder)
            said = run(program, "grain.stl", "library.csv", cwd=folder, env=self.environment)
            self.assertRegex(said, r"^50 spheres, mismatch 0\.0\d+\n$")
            run(mskit, "generate", "grain.stl", "-o", "program.csv", cwd=folder)
            with open(os.path.join(folder, "library.csv"), "rb") as one, \
                    open(os.path.join(folder, "program.csv"), "rb") as two:
                self.assertEqual(one.read(), two.read())
            failed = subprocess.run([program, "none.stl", "none.csv"], cwd=folder, env=self.environment, text=True,
                                    capture_output=True)
            self.assertEqual((failed.returncode, failed.stdout), (1, ""))
            self.assertIn("none.stl", failed.stderr)


if __name__ == "__main__":
    unittest.main()
