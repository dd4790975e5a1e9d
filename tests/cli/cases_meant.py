"""A word with a slip is told which was meant: one case for each closed list of words that a user types."""
from support import Case, box_obj


class Meant(Case):
    def setUp(self):
        super().setUp()
        self.write("box.obj", box_obj((0, 0, 0), (3, 2, 1)))
        self.write("clump.csv", "x,y,z,r\n1.5,1,0.5,0.5\n")

    def test_each_list(self):
        generate, density = ("generate", "box.obj"), ("--density", "1000")
        correct = ("correct", "clump.csv", "--target", "box.obj", *density, "-o", "x.csv")
        for args, meant in (
            (("gnerate",), "generate"),
            (("--verison",), "--version"),
            (("help", "genrate"), "generate"),
            (("help", "mms"), "mss"),
            (("completion", "zhs"), "zsh"),
            ((*generate, "--clels", "9"), "--cells"),
            ((*generate, "--max_memory=1G"), "--max-memory"),
            ((*generate, "--spcing", "2"), "--spacing"),
            ((*generate, "-cells", "9"), "--cells"),
            (("info", "--jsno", "box.obj"), "--json"),
            ((*generate, "-g", "setcovr"), "setcover"),
            ((*generate, "-g", "vari"), "variational"),
            ((*generate, "-g", "MSS"), "mss"),
            (("compare", "box.obj", "-g", "fmc"), "fcm"),
            ((*generate, "-g", "mss", "--set", "spacng=2"), "spacing"),
            ((*generate, "-g", "mss", "--order", "gian"), "gain"),
            ((*generate, "-g", "mss", "--set", "confine=onn"), "on"),
            ((*generate, "--until", "dise=0.1"), "dice"),
            (("scene", "box.obj", "--tolerance", "covrage=0.9"), "coverage"),
            ((*generate, "--format", "jsn"), "json"),
            ((*generate, "-o", "x.cvs"), "csv"),
            ((*generate, "--rule", "center"), "centre"),
            ((*correct, "--unit", "MM"), "mm"),
            ((*correct, "--properties", "unoin"), "union"),
            ((*correct, "--axes", "principle"), "principal"),
            (("stability", "box.obj", "--perturb", "rotaton"), "rotation"),
            (("shape", "toruss", "-o", "x.stl"), "torus"),
            (("shape", "ball", "finenes=9", "-o", "x.stl"), "fineness"),
        ):
            with self.subTest(args=args):
                self.assert_refused(*args, code=2, says=(f"; did you mean {meant}?",))

    def test_an_unknown_flag_is_one_line(self):
        for flag in ("--clels", "--nonsense", "-z", "--c", "--cells"):
            result = self.assert_refused("generate", "box.obj", flag, code=2, says=("mskit generate --help",))
            self.assertEqual(result.err.count("\n"), 1)
            self.assertLess(len(result.err), 120)

    def test_files(self):
        self.write("bix\n.obj", "")
        for args, meant in (
            (("info", "bxo.obj"), "box.obj"),
            (("generate", self.path("Box.obj")), "box.obj"),
            (("score", "clmp.csv", "--target", "box.obj"), "clump.csv"),
            (("score", "clump.csv", "--target", "box.ob"), "box.obj"),
            (("correct", "clump.cvs", "--target", "box.obj", "--density", "1", "-o", "x.csv"), "clump.csv"),
            (("convert", "clump", "-o", "x.json"), "clump.csv"),
            (("compare", "bix.obj"), "box.obj"),
            (("scene", "boxx.obj", "--knee", "0.1"), "box.obj"),
            (("stability", "bx.obj"), "box.obj"),
            (("stability", "cubee"), "cube"),
        ):
            with self.subTest(args=args):
                self.assert_refused(*args, code=1, says=(f"; did you mean {meant}?",))
        self.write("m.csv", "shape,count\nbxo.obj,1\n")
        self.assert_refused("scene", "m.csv", "--knee", "0.1", code=1, says=("m.csv: line 2", "did you mean box.obj?"))

    def test_what_is_near_to_nothing(self):
        for args in (("info", "other.stl"), ("info", "none/box.obj"), ("generate", "box.obj", "-g", "nonsense"),
                     ("shape", "xyz", "-o", "x.stl"), ("generate", "box.obj", "--qqqq"), ("nonsense",)):
            self.assertNotIn("did you mean", self.mskit(*args, code=None).err, args)
