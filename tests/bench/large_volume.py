#!/usr/bin/env python3
"""Peak memory and time of listing and of making all grains of a label volume that is larger than they should need.

    MSKIT=build/eval/mskit tests/bench/large_volume.py [EXTENT=2048] [FOLDER=.]

The volume, EXTENT^3 voxels of 16 bits without a header, is a sparse file with 400 balls of 28 voxels' radius, labels 1
to 400: it reads like a full one and takes some 4 GB on the disk, since of each row that a ball touches a block is
there.
"""
import os
import resource
import struct
import subprocess
import sys
import tempfile
import time

RADIUS, CELL, BALLS = 28, 64, 400


def write_ball(stream, label, first, extent):
    half = CELL / 2 - 0.5
    for z in range(CELL):
        for y in range(CELL):
            rest = RADIUS**2 - (z - half) ** 2 - (y - half) ** 2
            xs = [x for x in range(CELL) if (x - half) ** 2 < rest]
            if xs:
                row = (first[2] + z) * extent + first[1] + y
                stream.seek(2 * (row * extent + first[0] + xs[0]))
                stream.write(struct.pack("<H", label) * len(xs))


def write_volume(path, extent):
    cells = extent // CELL
    step = max(1, cells**3 // BALLS)
    with open(path, "wb") as stream:
        for label in range(1, min(BALLS, cells**3) + 1):
            at = (label - 1) * step
            first = [CELL * (at // cells**a % cells) for a in range(3)]
            write_ball(stream, label, first, extent)
        stream.truncate(2 * extent**3)


def run(*args):
    """Peak memory is that of the largest child so far: the small one goes first."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.time()
    subprocess.run(args, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    user = after.ru_utime - before.ru_utime
    print(f"{args[1]}: peak {after.ru_maxrss / 1024:.0f} MB, {time.time() - start:.0f} s, user {user:.0f} s",
          flush=True)


def main():
    extent = int(sys.argv[1]) if len(sys.argv) > 1 else 2048
    mskit = os.path.abspath(os.environ.get("MSKIT", "mskit"))
    with tempfile.TemporaryDirectory(dir=sys.argv[2] if len(sys.argv) > 2 else ".") as folder:
        volume = os.path.join(folder, "balls.raw")
        write_volume(volume, extent)
        raw = (volume, "--raw-size", f"{extent},{extent},{extent}", "--raw-type", "u16")
        run(mskit, "info", *raw, "--label", "5")
        run(mskit, "grains", *raw, "-g", "mss", "-n", "5", "-j", "2", "-o", os.path.join(folder, "clumps"))


if __name__ == "__main__":
    main()
