"""Completion of the command line: what the program answers, and what bash and zsh make of it, typed into them for
real."""
import os
import pty
import re
import select
import shutil
import signal
import subprocess
import time

from support import MSKIT, TIMEOUT, Case

COMMANDS = ("generate", "score", "contact", "correct", "convert", "info", "shape", "compare", "stability", "scene",
            "grains", "generators", "help", "version", "completion")


class Words(Case):
    """The words that the program offers for the last one, which are those that it takes."""

    def words(self, *line):
        return self.mskit("completion", "words", "--", *line).out.split("\n")[:-1]

    def test_commands(self):
        self.assertEqual(sorted(self.words("")), sorted(COMMANDS + ("--help", "--version")))
        self.assertEqual(self.words("gen"), ["generate", "generators"])
        self.assertEqual(self.words("nonsense", ""), [])

    def test_flags_are_those_of_the_help(self):
        for command in COMMANDS:
            listed = re.findall(r"(?m)^  .{4}(--[a-z-]+)", self.mskit(command, "--help").out)
            offered = self.words(command, "-")
            self.assertEqual(offered[:len(listed) - 1] + ["--help"], listed, command)
        self.assertIn("--spacing", self.words("generate", "--sp"))

    def test_flags_that_are_offered_are_taken(self):
        """Each is one that mskit knows; one that it does not know keeps it from running."""
        for command in COMMANDS:
            for flag in self.words(command, "--"):
                if flag != "--help":
                    result = self.mskit(command, flag, "x", "--nonsense", code=2)
                    self.assertNotIn(f"no flag '{flag}'", result.err)

    def test_generators_and_options(self):
        names = [g["name"] for g in self.mskit("generators", "--json").json]
        options = {o["name"] for name in names for o in self.mskit("help", name, "--json").json["options"]}
        for line in (("generate", "-g", ""), ("generate", "x.stl", "--generator", ""), ("compare", "-g", "")):
            self.assertEqual(self.words(*line), names)
        self.assertEqual(set(self.words("scene", "--set", "")), {name + "=" for name in options})
        self.assertEqual(self.words("generate", "--order", "g"), ["gain"])

    def test_closed_lists(self):
        for line, words in (
            (("generate", "--rule", ""), ["half", "centre"]),
            (("generate", "--rule=c"), ["--rule=centre"]),
            (("correct", "--unit", ""), ["m", "mm", "um"]),
            (("correct", "--axes=p"), ["--axes=principal"]),
            (("generate", "--until", ""), ["eta=", "dice=", "coverage=", "inertia=", "coverage_cut=", "radius="]),
            (("scene", "--tolerance", ""), ["eta=", "dice=", "coverage=", "inertia=", "coverage_cut="]),
            (("scene", "--mean-tolerance", ""), ["dice="]),
            (("generate", "--least-work", ""), ["dice="]),
            (("convert", "--format", "l"), ["liggghts", "lammps"]),
            (("stability", "--perturb", "r"), ["rotation", "resolution", "refine"]),
            (("stability", "c"), ["cube", "cone", "cavity", "corners", "/"]),
            (("shape", "to"), ["torus"]),
            (("shape", "ball", ""), ["r=", "fineness="]),
            (("completion", ""), ["bash", "zsh"]),
            (("help", "v"), ["version", "variational"]),
        ):
            with self.subTest(line=line):
                self.assertEqual(self.words(*line), words)

    def test_files_are_said(self):
        for line in (("generate", ""), ("generate", "-o", ""), ("generate", "--output=x"), ("score", "a", "-t", "b"),
                     ("info", "x"), ("generate", "--refine", ""), ("compare", "--charts", "")):
            self.assertEqual(self.words(*line), ["/"], line)
        for line in (("generate", "-n", ""), ("generate", "--cells", "1"), ("version", ""), ("generators", "")):
            self.assertEqual(self.words(*line), [], line)

    def test_wrong_usage(self):
        self.assert_refused("completion", code=2, says=("shell",))
        self.assert_refused("completion", "bsh", code=2, says=("'bsh'", "did you mean bash?", "zsh"))
        self.assert_refused("completion", "words", code=2, says=("'words'", "bash, zsh"))


class Terminal:
    """A shell in a terminal, for which a program types."""

    def __init__(self, command, folder):
        environment = {"PATH": os.path.dirname(os.path.abspath(MSKIT)) + ":/usr/bin:/bin", "TERM": "dumb",
                       "HOME": folder, "LC_ALL": "C"}
        master, slave = pty.openpty()
        self.process = subprocess.Popen(command, stdin=slave, stdout=slave, stderr=slave, cwd=folder, env=environment,
                                        start_new_session=True)
        os.close(slave)
        self.master = master
        self.said = ""

    def type(self, text):
        os.write(self.master, text.encode())

    def wait_for(self, pattern):
        """Reads on until what was said since the last call has this; returns the match."""
        end = time.monotonic() + TIMEOUT
        while not re.search(pattern, self.said):
            ready = select.select([self.master], [], [], max(0, end - time.monotonic()))[0]
            if not ready:
                raise AssertionError(f"the shell never said {pattern!r} but {self.said!r}")
            self.said += os.read(self.master, 65536).decode("utf-8", "replace")
            self.said = re.sub("[\r\a]", "", self.said)
        match = re.search(pattern, self.said)
        self.said = self.said[match.end():]
        return match

    def close(self):
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        os.close(self.master)


class Shells(Case):
    """Each line is typed with a tabulator behind it, and printed as the shell has completed it."""

    LINES = (
        ("mskit vers", "mskit version "),
        ("mskit generate --until", "mskit generate --until "),
        ("mskit generate x.stl --max-m", "mskit generate x.stl --max-memory "),
        ("mskit generate x.stl -g vari", "mskit generate x.stl -g variational "),
        ("mskit generate x.stl --rule=c", "mskit generate x.stl --rule=centre "),
        ("mskit generate x.stl --until dic", "mskit generate x.stl --until dice="),
        ("mskit shape torus fin", "mskit shape torus fineness="),
        ("mskit info gra", "mskit info grain.stl "),
        ("mskit score c.csv --target=gra", "mskit score c.csv --target=grain.stl "),
        ("mskit stability spe", "mskit stability speck "),
    )

    def complete(self, shell, command, start):
        if not shutil.which(shell):
            self.skipTest(f"{shell} is not installed")
        if os.path.basename(MSKIT) != "mskit":
            self.skipTest(f"{MSKIT} is not called mskit")
        self.write("grain.stl", "")
        terminal = Terminal(command, self.dir)
        self.addCleanup(terminal.close)
        terminal.type(start + "; PS1='>'\"> \"; PROMPT='>'\"> \"; echo rea''dy\n")
        terminal.wait_for("ready\n")
        for line, completed in self.LINES:
            terminal.wait_for(">> ")
            terminal.type(line + "\t")
            terminal.wait_for(re.escape(completed.rstrip(" ")))
            # The line is sent back as a text, so that a blank behind it is seen, too.
            terminal.type("\x01echo 'LINE<\x05>'\n")
            said = terminal.wait_for(r"\nLINE<(.*)>\n").group(1)
            # zsh takes its blank away again when the line goes on with something else
            self.assertEqual(said, completed if shell == "bash" else completed.rstrip(" "))

    def test_bash(self):
        self.complete("bash", ["bash", "--norc", "--noprofile", "-i"],
                      "bind 'set enable-bracketed-paste off'; source <(mskit completion bash)")

    def test_zsh(self):
        self.complete("zsh", ["zsh", "-f", "-i"],
                      "unsetopt zle_bracketed_paste; bindkey -e; autoload -U compinit; compinit -u -D; "
                      "source <(mskit completion zsh)")
