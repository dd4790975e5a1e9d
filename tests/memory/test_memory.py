#!/usr/bin/env python3
"""Lets the k-th allocation of a small run of each command fail: for every k, or for so many of them.

A run without that memory either succeeds, with the very output and files of a run that has it, or says why not and
ends with exit code 1; it never crashes and leaves neither a temporary file nor part of a file.

    MSKIT=build/eval/mskit FAILING_MALLOC=build/tests/memory/libfailing_malloc.so \\
        tests/memory/test_memory.py all|MOST [COMMAND...]
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

MSKIT = os.environ["MSKIT"]
LIBRARY = os.environ["FAILING_MALLOC"]
TIMEOUT = 1200  # seconds

SMALL = ["--cells", "8", "-j", "1"]
COMMANDS = {
    "shape": ["shape", "grain", "-o", "out.ply"],
    "info": ["info", "body.stl", "--json"],
    "mend": ["info", "torn.obj", "--fill-holes", "3", "--drop-bodies", "0.1", "--json"],
    "mss": ["generate", "body.stl", "-g", "mss", "-n", "4", "--json", "--curve", "curve.csv", "-o", "out.csv"] + SMALL,
    "setcover": ["generate", "body.obj", "-g", "setcover", "-n", "4", "-o", "out.json", "-o", "out.vtk"] + SMALL,
    "fcm": ["generate", "other.off", "-g", "fcm", "-n", "3", "--target-grid", "grid.vtk", "-o", "out.vtk"] + SMALL,
    "variational": ["generate", "body.ply", "-g", "variational", "-n", "3", "--set", "effort=1", "--until", "dice=0.3",
                    "-o", "out.csv"] + SMALL,
    "inscribed": ["generate", "body.stl", "-g", "variational", "-n", "3", "--protrusion", "0", "-o", "out.csv"] + SMALL,
    "cut cover": ["generate", "body.stl", "-g", "setcover", "-n", "3", "--count", "cut", "--equal-volume",
                  "-o", "out.csv"]
                 + SMALL,
    "least work": ["generate", "body.stl", "-n", "3", "--least-work", "dice=0.5", "--json", "-o", "out.csv"] + SMALL,
    "masses": ["generate", "body.stl", "-n", "4", "--correct", "--density", "2000", "-o", "out.lammps"] + SMALL,
    "volume": ["generate", "body.npy", "-n", "3", "-j", "1", "--json"],
    "score": ["score", "clump.csv", "--target", "body.stl", "--json"] + SMALL,
    "score, two threads": ["score", "clump.csv", "--target", "body.stl", "--json", "--cells", "8", "-j", "2"],
    "show": ["score", "clump.csv", "--target", "body.stl", "-o", "out.html", "-o", "out.stl", "-o", "out.png", "-o",
             "out.vtp"] + SMALL,
    "score --cut": ["score", "clump.csv", "--target", "body.stl", "--cut", "--json"] + SMALL,
    "score --curve": ["score", "clump.json", "--target", "body.stl", "--curve"] + SMALL,
    "contact": ["contact", "clump.csv", "--target", "body.stl", "--poses", "3", "--envelope", "0.3", "-j", "1",
                "--json"],
    "correct": ["correct", "clump.csv", "--target", "body.stl", "--density", "2000", "-o", "out.json",
                "--json"] + SMALL,
    "convert": ["convert", "clump.csv", "-o", "out.json", "-o", "out.vtk"],
    "compare": ["compare", "body.stl", "-n", "2,3", "-g", "mss", "-g", "setcover", "--charts", "charts",
                "-o", "out.csv"] + SMALL,
    "stability": ["stability", "body.stl", "-g", "mss", "-n", "2", "--json"] + SMALL,
    "scene": ["scene", "scene.csv", "--sieve", "curve.csv", "--budget", "8", "--max-spheres", "4", "-o", "templates",
              "--json"] + SMALL,
    "generators": ["generators", "--json"],
}

# What differs from run to run.
TIMES = [(re.compile(rb'"seconds": ?\{[^}]*\}'), b'"seconds"'),
         (re.compile(rb'"(?:peak_memory_kb|[a-z_]*seconds)": ?[-+.e0-9]+'), b""),
         (re.compile(rb"\b[-+.e0-9]+ s\b"), b"")]
TIMED_CHARTS = re.compile(r"charts/.*-time\.")


def blank_columns(data):
    """Of CSV, the columns of times and of memory."""
    rows = [line.split(b",") for line in data.split(b"\n")]
    drop = [c for c, name in enumerate(rows[0]) if b"seconds" in name or b"memory" in name or name == b"peak_kb"]
    return [[word for c, word in enumerate(row) if c not in drop] for row in rows]


def comparable(name, data):
    if name.endswith(".csv"):
        return blank_columns(data)
    if name.startswith("charts/") or name.endswith(".png"):
        return b""  # drawn by gnuplot from the CSV; times among them
    for pattern, instead in TIMES:
        data = pattern.sub(instead, data)
    return data


def snapshot(folder):
    files = {}
    for path, _folders, names in os.walk(folder):
        for name in names:
            full = os.path.join(path, name)
            short = os.path.relpath(full, folder)
            with open(full, "rb") as f:
                files[short] = comparable(short, f.read())
    return files


def run(inputs, args, fail_at):
    """Exit code, standard output, standard error, the files afterwards, the number of allocations."""
    with tempfile.TemporaryDirectory(prefix="mskit-memory-") as top:
        folder = os.path.join(top, "run")
        shutil.copytree(inputs, folder)
        count = os.path.join(top, "count")
        env = dict(os.environ, LD_PRELOAD=LIBRARY, FAIL_AT=str(fail_at), FAIL_COUNT=count, OMP_NUM_THREADS="1",
                   OMP_WAIT_POLICY="passive")  # else it starts itself anew, without the library
        process = subprocess.run([MSKIT] + args, cwd=folder, env=env, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE, timeout=TIMEOUT, check=False)
        allocations = 0
        if os.path.exists(count):
            with open(count, encoding="ascii") as f:
                allocations = int(f.read())
        return (process.returncode, comparable("", process.stdout), process.stderr.decode("utf-8", "replace"),
                snapshot(folder), allocations)


def says_which_runs_failed(good, files):
    """Of compare and stability: rows that say so stand for runs that had no memory, all other rows are as they were."""
    told = False
    for name, rows in files.items():
        if name.endswith(".csv") and rows != good.get(name):
            lost = [row for row in rows if any(b"no memory" in word for word in row)]
            if not lost or any(row not in good.get(name, []) for row in rows if row not in lost):
                return False
            told = True
    return told


def fault_of(good, got):
    """What is wrong with a run that lacked memory; empty if nothing is."""
    code, out, err, files, _ = got
    if code not in (0, 1):
        return f"exit code {code}"
    left = [name for name in files if name.endswith(".tmp")]
    if left:
        return f"left {left}"
    if code == 1:
        return "" if err else "failed without a word"
    if says_which_runs_failed(good[3], files):
        return ""
    if out != good[1]:
        return "succeeded with another output"
    changed = [name for name in set(good[3]) | set(files) if good[3].get(name) != files.get(name)]
    return f"succeeded with other files: {changed}" if changed else ""


def tear(text):
    """An OBJ with each triangle by itself, a hair away from the others; the first is lost, and a crumb lies beside."""
    vertices = [[float(w) for w in line.split()[1:]] for line in text.splitlines() if line.startswith("v ")]
    faces = [[int(w) - 1 for w in line.split()[1:]] for line in text.splitlines() if line.startswith("f ")][1:]
    vertices += [(9, 0, 0), (10, 0, 0), (9, 1, 0), (9, 0, 1)]
    n = len(vertices)
    faces += [(n - 4, n - 2, n - 3), (n - 4, n - 3, n - 1), (n - 3, n - 2, n - 1), (n - 2, n - 4, n - 1)]
    return "".join("".join("v %.17g %.17g %.17g\n" % tuple(x + 1e-8 * (k % 7) for x in vertices[v]) for v in face)
                   + "f -3 -2 -1\n" for k, face in enumerate(faces))


def make_inputs(folder):
    def mskit(*args):
        subprocess.run([MSKIT, *args], cwd=folder, check=True, stdout=subprocess.DEVNULL)

    for ending in ("stl", "obj", "off", "ply"):
        mskit("shape", "ellipsoid", "a=3", "b=2", "c=2", "fineness=4", "-o", "body." + ending)
    mskit("generate", "body.stl", "-n", "3", "--cells", "8", "-o", "clump.csv", "-o", "clump.json")
    with open(os.path.join(folder, "body.obj"), encoding="ascii") as whole:
        with open(os.path.join(folder, "torn.obj"), "w", encoding="ascii") as torn:
            torn.write(tear(whole.read()))
    os.rename(os.path.join(folder, "body.off"), os.path.join(folder, "other.off"))
    with open(os.path.join(folder, "scene.csv"), "w", encoding="ascii") as f:
        f.write("shape,count\nbody.stl,3\nother.off,1\n")
    with open(os.path.join(folder, "curve.csv"), "w", encoding="ascii") as f:
        f.write("size,passing\n1,0\n1.2,0.4\n1.4,1\n")
    solid = bytes(all(2 <= v < 8 for v in (i, j, k)) for k in range(10) for j in range(10) for i in range(10))
    header = b"{'descr': '|u1', 'fortran_order': False, 'shape': (10, 10, 10), }".ljust(117) + b"\n"
    with open(os.path.join(folder, "body.npy"), "wb") as f:
        f.write(b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header + solid)


def check(inputs, name, most, pool):
    """Faults of one command, a line each."""
    args = COMMANDS[name]
    good = run(inputs, args, 0)
    if good[0] != 0:
        return [f"{name}: exit code {good[0]} with all its memory: {good[2]}"]
    if run(inputs, args, 0)[1:4:2] != good[1:4:2]:
        return [f"{name}: two runs differ"]
    places = range(1, good[4] + 1, max(1, good[4] // most if most else 1))
    faults, failed = [], 0
    for k, got in zip(places, pool.map(lambda k: run(inputs, args, k), places)):
        fault = fault_of(good, got)
        failed += got[0] == 1
        if fault:
            last = (got[2].strip().splitlines() or [""])[-1]
            faults.append(f"{name}, allocation {k} of {good[4]}: {fault}; {last[:200]}")
    print(f"{name}: {len(places)} of {good[4]} allocations failed one at a time, {failed} runs ended with exit code 1, "
          f"{len(faults)} faults", flush=True)
    if failed == 0:
        faults.append(f"{name}: no run failed; is {LIBRARY} loaded?")
    return faults


def main():
    most = 0 if sys.argv[1] == "all" else int(sys.argv[1])
    faults = []
    with tempfile.TemporaryDirectory(prefix="mskit-memory-") as inputs, ThreadPoolExecutor(os.cpu_count()) as pool:
        make_inputs(inputs)
        for name in sys.argv[2:] or COMMANDS:
            faults += check(inputs, name, most, pool)
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
