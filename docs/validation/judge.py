"""Clumps and their D by the independent judge of SHARED/tools, for the scripts beside this one."""
import json
import os
import subprocess
import sys


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stderr}")
    return done.stdout


class Judge:
    def __init__(self, shared, folder):
        self.shared, self.folder = shared, folder
        self.program = os.path.join(folder, "score")
        run("cc", "-O2", "-w", "-o", self.program, os.path.join(shared, "tools/score.c"), "-lm")

    def mesh(self, shape):
        """The mesh's own file and one that the judge reads; None where it is missing."""
        path = os.path.join(self.shared, "data", shape)
        if not os.path.exists(path):
            print(f"skipped: no {path}", file=sys.stderr)
            return None
        stl = path
        if not shape.endswith(".stl"):
            stl = os.path.join(self.folder, os.path.basename(shape) + ".stl")
            run(sys.executable, os.path.join(self.shared, "tools/tostl.py"), path, stl)
        return path, stl

    def spheres(self, path, n, method, options=()):
        """The lines of a clump of up to n spheres, by 100 cells."""
        clump = os.path.join(self.folder, "clump.csv")
        run(os.environ.get("MSKIT", "mskit"), "generate", path, "-g", method, "--cells", 100, "-n", n, "-o", clump,
            *options)
        with open(clump) as lines:
            return lines.read().splitlines()[1:]

    def dice(self, stl, lines):
        clump = os.path.join(self.folder, "prefix.csv")
        with open(clump, "w") as out:
            out.write("\n".join(["x,y,z,r", *lines]) + "\n")
        return json.loads(run(self.program, stl, clump, 200))["D"]
