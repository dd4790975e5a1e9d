#!/usr/bin/env python3
"""No test ends, or fails, because others want the machine, too: time-outs are against hangs, and long.

    tests/habits/test_timeouts.py BUILD
"""
import glob
import json
import os
import re
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
LEAST = 1200  # seconds; the longest test takes about 150 on two idle cores


def faults_of_meson(build):
    faults = []
    for name in ("tests", "benchmarks"):
        with open(os.path.join(build, "meson-info", f"intro-{name}.json"), encoding="utf-8") as f:
            listed = json.load(f)
        if not listed:
            faults.append(f"{name}: meson lists none")
        faults += [f"{test['name']}: timeout of {test['timeout']} s in its meson.build" for test in listed
                   if 0 < test["timeout"] < LEAST]
    return faults


def faults_of_python():
    """A number behind timeout=, wait( or deadline of the clock."""
    faults, seen = [], 0
    for path in glob.glob("tests/**/*.py", root_dir=ROOT, recursive=True):
        with open(os.path.join(ROOT, path), encoding="utf-8") as f:
            text = f.read()
        for found in re.finditer(r"(?:(?i:timeout) ?= ?|\.wait\(|monotonic\(\) \+ )(\d+)", text):
            seen += 1
            if int(found.group(1)) < LEAST:
                faults.append(f"{path}:{text.count(chr(10), 0, found.start()) + 1}: {found.group(0)}")
    return faults if seen else ["no time-out is found in any test: this one looks for them in a wrong way"]


def main():
    faults = faults_of_meson(sys.argv[1]) + faults_of_python()
    print("\n".join(faults) or f"all time-outs are {LEAST} s or more")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
