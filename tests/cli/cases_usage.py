"""Which commands and flags there are, and what wrong ones are told. Wrong usage is exit code 2."""
import re
import shlex
import shutil

from support import Case, box_obj

COMMANDS = ("generate", "score", "contact", "correct", "convert", "info", "shape", "compare", "stability", "scene",
            "grains", "generators", "help", "version", "completion")


class Help(Case):
    def test_no_command(self):
        self.assert_refused(code=2, says=("usage:", "COMMAND"))

    def test_overview_lists_the_commands(self):
        for args in (("--help",), ("-h",), ("help",)):
            out = self.mskit(*args).out
            for command in COMMANDS:
                self.assertRegex(out, rf"(?m)^  {command} +\w")

    def test_overview_lists_no_other_commands(self):
        """A new command has to be added to the list above, and so is tested by what follows."""
        listed = re.findall(r"(?m)^  (\w+)  ", self.mskit("--help").out)
        self.assertEqual(sorted(listed), sorted(COMMANDS))

    def test_version(self):
        for word in ("--version", "-V", "version"):
            self.assertRegex(self.mskit(word).out, r"^mskit \d+\.\d+\.\d+\n$")

    def test_too_many_words(self):
        for args, takes in ((("version", "x"), "no words"), (("generators", "x"), "no words"),
                            (("generate", "a.stl", "x", "y"), "one shape"), (("info", "a.stl", "x"), "one shape"),
                            (("scene", "a.stl", "x"), "one shape"), (("score", "a.csv", "x"), "one clump file"),
                            (("correct", "a.csv", "x"), "one clump file"), (("help", "mss", "x"), "one generator"),
                            (("contact", "a.csv", "x"), "one clump file"), (("completion", "bash", "x"), "a shell"),
                            (("convert", "a.csv", "x"), "one clump file")):
            self.assert_refused(*args, code=2, says=(takes, "'x' is one too many"))
        self.assert_refused("info", code=2, says=("mskit info: takes one shape\n",))

    def test_empty_names(self):
        """Of every command, and of each of its flags that takes a file or a folder."""
        flags = 0
        for command in COMMANDS:
            self.assert_refused(command, "", code=2, says=(f"mskit {command}: word 1 is empty",))
            for flag in re.findall(r"(?m)^ .*--([a-z-]+) (?:FILE|SHAPE|DIR)\b", self.mskit(command, "--help").out):
                self.assert_refused(command, "--" + flag, "", code=2, says=(f"--{flag} '' is an empty name",))
                flags += 1
        self.assertGreater(flags, 15)
        self.assert_refused("generate", self.shape("cube"), "-n", "1", "--set", "refine=", code=2,
                            says=("the name of the file to read is empty",))

    def test_value_of_a_flag_that_takes_none(self):
        self.assert_refused("generate", "a.stl", "--connected=0", code=2, says=("--set connected=0 is off",))
        self.assert_refused("generate", "a.stl", "--json=0", code=2, says=("--json takes no argument (",))

    def test_help_of_every_command(self):
        for command in COMMANDS:
            for args in ((command, "--help"), (command, "-h"), ("help", command)):
                result = self.mskit(*args)
                self.assertIn(f"usage: mskit {command} ", result.out)
                self.assertIn("example: ", result.out)
                self.assertEqual(result.err, "")

    def test_examples_of_the_help_work(self):
        """Every example is run as it stands, in a folder that holds what it names."""
        self.shape("grain", "fineness=8", name="grain.stl")
        self.mskit("generate", "grain.stl", "-n", "30", "--cells", "20", "-o", "grain.csv")
        for command in COMMANDS:
            example = re.search(r"example: mskit (.+)", self.mskit(command, "--help").out).group(1)
            if "--charts" in example and not shutil.which("gnuplot"):
                print(f"gnuplot is not installed (package gnuplot-nox): not run: mskit {example}")
                continue
            with self.subTest(example=example):
                self.mskit(*shlex.split(example))

    def test_flags_of_the_usage_line_are_in_the_help(self):
        for command in COMMANDS:
            out = self.mskit(command, "--help").out
            for flag in re.findall(r"(--?[a-z][a-z-]*)", out.split("usage:")[1].splitlines()[0]):
                self.assertRegex(out, rf"(?m)^ .*{flag}\b.* \S", f"{command}: {flag} is not explained")

    def test_generators(self):
        listed = self.mskit("generators", "--json").json
        table = self.mskit("generators").out
        self.assertIn("mss", [g["name"] for g in listed])
        for generator in listed:
            self.assertEqual(set(generator), {"name", "summary", "source", "nested", "baseline"})
            self.assertIn(generator["name"], table)
            about = self.mskit("help", generator["name"]).out
            self.assertIn(generator["source"], about)
            self.assertIn("options", about)


class WrongUsage(Case):
    """Each is refused before any work, and told what could be chosen, or of flags, which are many, where they stand."""

    def setUp(self):
        super().setUp()
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))
        self.write("c.csv", "x,y,z,r\n1.5,1,0.5,0.5\n")

    def test_choices_are_listed(self):
        generate = ("generate", "box.obj")
        mss = (*generate, "-g", "mss")
        for args, says in (
            (("nonsense",), ("'nonsense'", "generate", "score", "shape")),
            (("",), ("''", "generate")),
            (("--nonsense",), ("--nonsense", "--help", "--version", "mskit generate --help")),
            ((*generate, "--nonsense"), ("no flag --nonsense", "mskit generate --help")),
            ((*generate, "-z"), ("no flag -z", "mskit generate --help")),
            ((*generate, "--c", "1"), ("--c may be short for", "--correct")),
            (("score", "c.csv", "--nonsense"), ("no flag --nonsense", "mskit score --help")),
            (("info", "--nonsense"), ("no flag --nonsense", "mskit info --help")),
            (("shape", "--nonsense"), ("no flag --nonsense", "mskit shape --help")),
            (("generators", "--nonsense"), ("no flag --nonsense", "mskit generators --help")),
            (("help", "--nonsense"), ("--nonsense", "--help")),
            ((*generate, "--cells"), ("--cells", "argument")),
            ((*generate, "--confine=on"), ("--confine", "argument")),
            ((*generate, "-g", "nonsense"), ("'nonsense'", "mss")),
            ((*generate, "-gnonsense"), ("'nonsense'", "mss")),
            ((*generate, "--gen", "nonsense"), ("'nonsense'", "mss")),
            ((*mss, "--set", "nonsense=1"), ("'nonsense'", "spacing", "confine", "plane")),
            ((*generate, "--set", ""), ("name=value",)),
            ((*generate, "--set", "=1"), ("name=value",)),
            ((*mss, "--order", "nonsense"), ("nonsense", "radius, gain")),
            ((*mss, "--set", "confine=perhaps"), ("perhaps", "on", "off")),
            ((*generate, "--format", "nonsense"), ("'nonsense'", "csv", "json", "vtk")),
            ((*generate, "-o", "clump.nonsense"), ("clump.nonsense", "csv", "json", "vtk", "--format")),
            ((*generate, "-o", "clump"), ("clump", "csv", "json", "vtk", "--format")),
            ((*generate, "-o", "."), ("csv", "json", "vtk")),
            ((*generate, "-o", ""), ("--output ''",)),
            ((*generate, "--rule", "nonsense"), ("nonsense", "half", "centre")),
            ((*generate, "--until", "nonsense=1"), ("'nonsense'", "eta", "dice", "coverage", "inertia", "radius")),
            ((*generate, "--until", "nonsense"), ("'nonsense'", "eta", "dice", "coverage", "inertia", "radius")),
            ((*generate, "--until", "dice"), ("'dice'", "MEASURE=VALUE")),
            ((*generate, "--until", "dice="), ("'dice='", "MEASURE=VALUE")),
            ((*generate, "--until", "=1"), ("name=value",)),
            (("help", "nonsense"), ("'nonsense'", "mss")),
            (("shape", "nonsense", "-o", "x.stl"), ("'nonsense'", "ball", "torus", "grain")),
            (("shape", "ball", "R=1", "-o", "x.stl"), ("R=1", "--list")),
            (("shape", "ball", "r", "-o", "x.stl"), ("'r'", "--list")),
            (("shape", "ball", "-o", "x.nonsense"), (".stl", ".obj", ".ply", ".off")),
            (("shape", "ball", "-o", ""), ("--output ''",)),
        ):
            with self.subTest(args=args):
                self.assert_refused(*args, code=2, says=says)

    def test_ranges_are_named(self):
        for flag, values, says in (
            ("-n", ("0", "-5", "1e99", "nan", "inf", "", "70000", "five", "0x10"), ("--spheres", "1 to 65534")),
            ("-n", ("2.5",), ("whole",)),
            ("--cells", ("0", "-1", "1e5", "", "nan"), ("--cells", "32767")),
            ("--deq", ("0", "-3", "nan"), ("--deq",)),
            ("--voxel-size", ("0", "-1", "nan", "inf", "1 mm"), ("--voxel-size",)),
            ("-j", ("0", "-1", "1025", "two"), ("--threads", "1 to 1024")),
            ("--seed", ("-1", "99999999999999999999", ""), ("--seed", "9007199254740992")),
            ("--label", ("0", "-1", "4294967296"), ("--label", "1 to 4294967295")),
            ("--max-memory", ("", "G", "8GB", "-3", "nan", "inf", "1e18T"), ("--max-memory", "500M or 8G")),
            ("--until", ("dice=2", "dice=-1", "dice=nan", "eta=1.5", "coverage=1.1", "inertia=-0.1", "coverage=0"),
             ("above 0, up to 1",)),
            ("--until", ("dice=0", "eta=0", "inertia=0"), ("above 0, up to 1", "1e-9")),
            ("--until", ("radius=-1", "radius=inf", "radius=nan", "radius=0"), ("above 0",)),
            ("--min-radius", ("0", "-1", "nan", "inf", "1 mm"), ("--min-radius",)),
            ("--spacing", ("-1", "1e9", "", "nan"), ("spacing", "0 to 1000")),
            ("--radius-offset", ("-3", "3"), ("radius-offset", "-2 to 2")),
            ("--plane", ("1,0,0", "1,0,0,0,", "1,0,0,0,0", "nan,0,0,1", "a,b,c,d", "1 0 0 0", ""), ("a,b,c,d",)),
            ("--plane", ("0,0,0,1",), ("direction",)),
        ):
            for value in values:
                with self.subTest(flag=flag, value=value):
                    self.assert_refused("generate", "box.obj", "-g", "mss", flag, value, code=2, says=says)

    def test_number_of_words(self):
        for args, says in (
            (("generate",), ("one shape",)),
            (("generate", "box.obj", "box.obj"), ("one shape",)),
            (("info",), ("one shape",)),
            (("info", "box.obj", "box.obj"), ("one shape",)),
            (("score",), ("--target",)),
            (("score", "c.csv"), ("--target",)),
            (("score", "--target", "box.obj"), ("one clump file",)),
            (("shape",), ("-o FILE",)),
            (("shape", "ball"), ("-o FILE",)),
            (("shape", "-o", "x.stl"), ("kind of shape",)),
            (("generators", "mss"), ("no words",)),
            (("help", "mss", "mss"), ("one generator",)),
        ):
            with self.subTest(args=args):
                self.assert_refused(*args, code=2, says=(*says, "usage: mskit " + args[0]))

    def test_flags_that_exclude_one_another(self):
        for args in (("--cells", "9", "--deq", "9"), ("--cells", "9", "--voxel-size", "0.1"),
                     ("--deq", "9", "--voxel-size", "0.1"), ("--cells", "9", "--deq", "9", "--voxel-size", "0.1")):
            for command in (("generate", "box.obj"), ("score", "c.csv", "--target", "box.obj")):
                with self.subTest(command=command, args=args):
                    self.assert_refused(*command, *args, code=1, says=("--cells, --deq and --voxel-size exclude",))

    def test_only_one_may_have_standard_output(self):
        for args in (("--json", "-o", "-"), ("-o", "-", "-o", "-"), ("--json", "--target-grid", "-"),
                     ("-o", "-", "--target-grid", "-")):
            with self.subTest(args=args):
                self.assert_refused("generate", "box.obj", *args, code=2, says=("standard output",))
        self.assert_refused("score", "c.csv", "--target", "box.obj", "--json", "--curve", code=2, says=("--curve",))

    def test_a_label_is_for_volumes(self):
        self.assert_refused("info", "box.obj", "--label", "1", code=1, says=("is a mesh", "--label"))
        self.assert_refused("generate", "box.obj", "--label", "1", code=1, says=("is a mesh", "--label"))

    def test_the_last_of_equal_flags_counts(self):
        run = self.generate("box.obj", "--cells", "9", "--cells", "20", "-n", "1", "-n", "2", "-o", "x.csv")
        self.assertEqual(run["until"]["spheres"], 2)
        self.assertEqual(run["input"]["voxel_size"], 1 / 20)

    def test_flags_may_stand_anywhere(self):
        before = self.generate("-n", "2", "--cells", "20", "box.obj", "-o", "x.csv")
        after = self.generate("box.obj", "-o", "x.csv", "--cells", "20", "-n", "2")
        self.assertEqual(before["scores"], after["scores"])

    def test_options_may_stand_before_the_generator(self):
        run = self.generate("--set", "spacing=3", "box.obj", "--cells", "20", "-n", "2", "-o", "x.csv", "-g", "mss")
        self.assertEqual(float(run["options"]["spacing"]), 3)
