"""Standard input, as -, where a mesh or a clump is read: the same as from a file, once a command, and never more than
is allowed."""
import json
import os
import resource
import subprocess

from support import MSKIT, TIMEOUT, Case, box_obj, npy

GRID = ("--cells", 12)


class Input(Case):
    def setUp(self):
        super().setUp()
        for ending in ("stl", "obj", "ply", "off"):
            self.shape("grain", "fineness=6", name="grain." + ending)
        self.mskit("generate", "grain.stl", "-g", "mss", "-n", 6, *GRID, "-o", "c.csv", "-o", "c.json")

    def same(self, *args, name):
        """What a command prints of a file and of the same bytes on standard input, but for the name of the file."""
        def run(word, **more):
            words = [word if arg is None else arg for arg in args]
            out = self.mskit(*words, **more).out
            return out.replace("standard input", name)
        self.assertEqual(run("-", stdin=self.read(name)), run(name))

    def test_meshes_by_content(self):
        self.write("comment.obj", "# made by hand\n\n" + box_obj((0, 0, 0), (1, 2, 3)))
        self.write("coff.off", self.read("grain.off").replace(b"OFF", b"# a comment\nCOFF", 1))
        facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
        self.write("ascii.stl", "  solid a\n" + facet + "endsolid a\n")
        self.write("solid.stl", b"solid binary".ljust(80) + self.read("grain.stl")[80:])
        for name in ("grain.stl", "grain.obj", "grain.ply", "grain.off", "comment.obj", "coff.off", "ascii.stl",
                     "solid.stl"):
            with self.subTest(name=name):
                self.same("info", None, name=name)

    def test_each_command_that_reads_a_mesh(self):
        self.same("score", "c.csv", "--target", None, *GRID, "--json", name="grain.stl")
        self.same("generate", None, *GRID, "-g", "mss", "-n", 4, "-o", "-", name="grain.obj")
        self.same("correct", "c.csv", "--target", None, "--density", 1000, "-o", "-", name="grain.ply")
        self.same("info", None, "--json", name="grain.off")
        scene = ("scene", "-", "-g", "mss", "--knee", 0.3, "--max-spheres", 4, *GRID, "-o", "t")
        self.assertIn("wrote t/stdin.csv", self.mskit(*scene, stdin=self.read("grain.stl")).out)

    def test_each_command_that_reads_a_clump(self):
        for name in ("c.csv", "c.json"):
            self.same("score", None, "--target", "grain.stl", *GRID, "--json", name=name)
            self.same("convert", None, "-o", "-", name=name)
            self.same("correct", None, "--target", "grain.stl", "--density", 1000, *GRID, "-o", "-", name=name)
            self.same("generate", "grain.stl", *GRID, "-g", "variational", "--refine", None, "-n", 6, "-o", "-",
                      name=name)
        self.mskit("compare", "grain.stl", "--clump", "tool=-", *GRID, "-o", "x.csv", stdin=self.read("c.csv"))
        self.assertIn(b",tool,\"standard input\",", self.read("x.csv"))

    def test_names_of_outputs(self):
        self.mskit("generate", "-", "-g", "mss", "-n", 2, *GRID, stdin=self.read("grain.stl"))
        self.mskit("convert", "-", "--format", "vtk", stdin=self.read("c.csv"))
        self.assertLessEqual({"stdin-mss.csv", "stdin-mss.json", "stdin-mss.vtk", "stdin.vtk"}, set(self.files()))

    def test_a_pipe_of_three(self):
        line = ('"$M" shape grain fineness=6 -o - | "$M" generate - -g mss -n 5 --cells 12 -o - | '
                '"$M" score - --target grain.off --cells 12 --json')
        done = subprocess.run(["sh", "-c", line], cwd=self.dir, env={**os.environ, "M": MSKIT}, check=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=TIMEOUT)
        self.mskit("generate", "grain.off", "-g", "mss", "-n", 5, *GRID, "-o", "d.csv")
        scores = self.mskit("score", "d.csv", "--target", "grain.off", *GRID, "--json").json["scores"]
        self.assertEqual(json.loads(done.stdout)["scores"], scores)

    def test_twice(self):
        for args in (("score", "-", "--target", "-"), ("correct", "-", "--target", "-", "--density", 1, "-o", "x.csv"),
                     ("generate", "-", "-g", "variational", "--refine", "-"),
                     ("scene", "-", "--knee", 0.1, "-g", "variational", "--refine", "-")):
            with self.subTest(args=args):
                self.assert_refused(*args, code=2, says=("- is given for 2 inputs", "read once"),
                                    stdin=self.read("c.csv"))
        for more in (("--clump", "b=-"), ("-g", "variational:refine=-")):
            self.assert_refused("compare", "grain.stl", "--clump", "a=-", *more, code=2, stdin=self.read("c.csv"),
                                says=("standard input: is empty", "- is given once"))
        for command in ("compare", "stability"):
            self.assert_refused(command, "-", code=2, says=("and - once", "name the file"),
                                stdin=self.read("grain.stl"))

    def test_where_it_is_not_read(self):
        self.assert_refused("convert", "c.csv", "--frame", "-", "-o", "x.json", code=1, stdin=self.read("c.json"),
                            says=("standard input is not read here",))
        self.write("m.csv", "shape,count\n-,1\n")
        self.assert_refused("scene", "m.csv", "--knee", 0.1, code=1, says=("line 2", "not standard input"))

    def test_volumes_are_not_read(self):
        for data in (npy([1], (1, 1, 1)), b"NRRD0004\ntype: uint8\n", b"ObjectType = Image\nNDims = 3\n"):
            self.assert_refused("info", "-", code=1, stdin=data, says=("standard input: is a volume", "name the file"))

    def test_bad_bytes(self):
        for data, says in ((b"", "is empty"), (b"\n\n", "STL, OBJ, PLY and OFF"),
                           (b"x,y,z,r\n1,1,1,1\n", "does not begin"),
                           (bytes(range(256)), "binary STL"), (b"\xff" * 200, "does not begin"),
                           (b"ply\n", "end_header"),
                           (b"OFF 99999999999 9 9\n", "line 1"), (b"solid\n", "endsolid")):
            with self.subTest(data=data[:20]):
                self.assert_refused("info", "-", code=1, stdin=data, says=("standard input", says))
        for data in (b"", b"{", b"{}", b"\0" * 99, b"OFF\n", b"1,2,3\n"):
            with self.subTest(data=data):
                self.assert_refused("convert", "-", "-o", "x.csv", code=1, stdin=data, says=("standard input: ",))
        with open(self.path("c.csv"), "ab") as nothing_to_read:
            self.assert_refused("info", "-", code=1, stdin=nothing_to_read, says=("standard input: cannot be read",))
        closed = subprocess.run(["sh", "-c", '"$M" info - <&-'], env={**os.environ, "M": MSKIT}, check=False,
                                stderr=subprocess.PIPE, timeout=TIMEOUT)
        self.assertEqual((closed.returncode, b"is empty" in closed.stderr), (1, True))

    def test_input_without_end(self):
        """Of meshes as much as --max-memory, of clumps 268 MB; the memory that the process may take holds that."""
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))
        with open("/dev/zero", "rb") as zeros:
            for args, most in ((("info", "-", "--max-memory", "5M"), "5 MB"),
                               (("convert", "-", "-o", "x.csv"), "268 MB"),
                               (("score", "c.csv", "--target", "-", "--max-memory", "70M"), "70 MB")):
                self.assert_refused(*args, code=1, stdin=zeros, preexec_fn=limit,
                                    says=("standard input: is longer than the " + most,))
            self.assert_refused("info", "-", "--max-memory", "1T", code=1, stdin=zeros, preexec_fn=limit,
                                says=("standard input: no memory",))

    def test_a_device_is_told_the_way(self):
        self.assert_refused("info", "/dev/null", code=1, says=("- for standard input",))
