"""What the tests of the program share: a folder for each test, running mskit, small input files.

Truth in the tests is a formula or a count made here in Python, never what mskit printed before.
"""
import csv
import io
import json
import math
import os
import resource
import struct
import subprocess
import tempfile
import unittest

MSKIT = os.environ.get("MSKIT", "mskit")
SHARED = os.environ.get("MSKIT_SHARED", "")
TIMEOUT = 1200  # seconds; what takes longer hangs, however busy the machine is


class Result:
    """What a run gave; output as text unless it was asked for as bytes. Seconds are of the processor."""

    def __init__(self, args, process, seconds):
        self.args = args
        self.code = process.returncode
        self.out_bytes = process.stdout
        self.out = process.stdout.decode("utf-8", "replace")
        self.err = process.stderr.decode("utf-8", "replace")
        self.seconds = seconds

    def __str__(self):
        line = " ".join(["mskit"] + [str(a) for a in self.args])
        return f"$ {line}\nexit code {self.code}\n--- stdout\n{self.out[:2000]}\n--- stderr\n{self.err[:2000]}"

    @property
    def json(self):
        return json.loads(self.out)


def seconds_of_children():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Case(unittest.TestCase):
    """Runs in a temporary folder of its own."""

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="mskit-cli-")
        self.dir = self._folder.name
        self.addCleanup(self._folder.cleanup)

    def path(self, name):
        return os.path.join(self.dir, name)

    def mskit(self, *args, code=0, stdin=subprocess.DEVNULL, **more):
        """Runs mskit and checks its exit code; None: any but a crash. `stdin`: a file, open, or the bytes that it reads
        there."""
        args = [os.fsencode(str(a)) if not isinstance(a, bytes) else a for a in args]
        start = seconds_of_children()
        more.update({"input": stdin} if isinstance(stdin, bytes) else {"stdin": stdin})
        process = subprocess.run([MSKIT] + args, cwd=self.dir, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                 timeout=TIMEOUT, check=False, **more)
        result = Result([os.fsdecode(a) for a in args], process, seconds_of_children() - start)
        wanted = (0, 1, 2) if code is None else (code,)
        self.assertIn(result.code, wanted, f"exit code should be {wanted}\n{result}")
        return result

    def assert_says(self, result, *words):
        for word in words:
            self.assertIn(word, result.err, f"stderr should say '{word}'\n{result}")

    def assert_refused(self, *args, code, says=(), **more):
        """Fails with this code, says why on stderr beginning with "mskit", prints no result, leaves no file."""
        before = self.files()
        result = self.mskit(*args, code=code, **more)
        self.assertEqual(result.out, "", f"a refusal prints nothing on stdout\n{result}")
        self.assert_says(result, "mskit", *says)
        self.assertEqual(self.files(), before, f"a refusal leaves no file behind\n{result}")
        return result

    def files(self):
        return sorted(os.listdir(self.dir))

    def write(self, name, data):
        with open(self.path(name), "wb") as f:
            f.write(data if isinstance(data, bytes) else data.encode())
        return name

    def read(self, name):
        with open(self.path(name), "rb") as f:
            return f.read()

    def shape(self, kind, *parameters, name=None):
        name = name or kind + ".stl"
        self.mskit("shape", kind, *parameters, "-o", name)
        return name

    def generate(self, *args, **more):
        """The record of a run, from --json; one thread, since the runs are small."""
        return self.mskit("generate", "--json", "-j", "1", *args, **more).json

    def spheres(self, name):
        return parse_spheres(self.read(name).decode())

    def curve(self, clump, target, *grid):
        """The rows of score --curve as dictionaries of numbers."""
        out = self.mskit("score", clump, "--target", target, "--curve", *grid).out
        return self.rows_of_curve(out)

    @staticmethod
    def rows_of_curve(text):
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(io.StringIO(text))]

    def assert_close(self, value, truth, relative, what=""):
        error = abs(value - truth) / (abs(truth) or 1)
        self.assertLessEqual(error, relative, f"{what}: {value} should be {truth} within {relative}")


def parse_spheres(text):
    lines = text.splitlines()
    if lines[0] != "x,y,z,r":
        raise AssertionError(f"header is '{lines[0]}', not 'x,y,z,r'")
    return [tuple(float(word) for word in line.split(",")) for line in lines[1:]]


def fnv1a(data):
    value = 14695981039346656037
    for byte in data:
        value = (value ^ byte) * 1099511628211 % 2**64
    return f"{value:016x}"


def npy(labels, shape, kind="<u2", fortran=False):
    """A NumPy file, version 1.0, of a flat list in memory order."""
    head = f"{{'descr': '{kind}', 'fortran_order': {fortran}, 'shape': {tuple(shape)}, }}"
    head += " " * (-(10 + len(head) + 1) % 64) + "\n"
    body = struct.pack(f"<{len(labels)}H", *labels)
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode("latin-1") + body


def box_obj(lo, hi, skip=0):
    """A cuboid of 12 triangles wound outward, without the first `skip` of them."""
    text = ""
    for corner in range(8):
        text += "v " + " ".join(repr(float((lo, hi)[corner >> axis & 1][axis])) for axis in range(3)) + "\n"
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    faces = [t for q in quads for t in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]
    return text + "".join("f %d %d %d\n" % tuple(v + 1 for v in face) for face in faces[skip:])


def read_obj(text):
    """Vertices and triangles of an OBJ that mskit wrote."""
    vertices, triangles = [], []
    for line in text.splitlines():
        words = line.split()
        if words and words[0] == "v":
            vertices.append(tuple(float(w) for w in words[1:4]))
        elif words and words[0] == "f":
            triangles.append(tuple(int(w.split("/")[0]) - 1 for w in words[1:4]))
    return vertices, triangles


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _segment_distance(p, a, b):
    ab = sub(b, a)
    t = max(0.0, min(1.0, dot(sub(p, a), ab) / dot(ab, ab)))
    return math.dist(p, (a[0] + t * ab[0], a[1] + t * ab[1], a[2] + t * ab[2]))


def triangle_distance(p, a, b, c):
    """Distance of a point from a triangle: to its plane if the foot lies within, else to its edges."""
    normal = cross(sub(b, a), sub(c, a))
    if all(dot(cross(sub(v, u), sub(p, u)), normal) >= 0 for u, v in ((a, b), (b, c), (c, a))):
        return abs(dot(sub(p, a), normal)) / math.sqrt(dot(normal, normal))
    return min(_segment_distance(p, a, b), _segment_distance(p, b, c), _segment_distance(p, c, a))


def solid_angle(p, a, b, c):
    """Of a triangle seen from p, signed; over a closed mesh the sum is 4 pi inside and 0 outside (van Oosterom
    1983)."""
    u, v, w = sub(a, p), sub(b, p), sub(c, p)
    lu, lv, lw = (math.sqrt(dot(q, q)) for q in (u, v, w))
    return 2 * math.atan2(dot(u, cross(v, w)), lu * lv * lw + dot(u, v) * lw + dot(v, w) * lu + dot(w, u) * lv)


def shared_file(*parts):
    """Path of a file of the shared data; skips the test where it is missing."""
    path = os.path.join(SHARED, "data", *parts)
    if not SHARED or not os.path.exists(path):
        raise unittest.SkipTest(f"no shared data here: {path} is missing (MSKIT_SHARED names the folder)")
    return path
