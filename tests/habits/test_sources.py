#!/usr/bin/env python3
"""Every list of C files and of the program's cases in the meson files is sorted, without doubles and complete: each
file of the tree is in one.

    tests/habits/test_sources.py
"""
import glob
import os
import re
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")

# Not in a list: made by name in a loop, or alone.
BY_NAME = re.compile(r"tests/(fuzz/fuzz_|bench/bench_|engines/tumble|memory/failing_malloc)")


def lists(text):
    """The runs of lines that hold a quoted path and nothing else, as lists of paths."""
    found, current = [], []
    for line in text.splitlines() + [""]:
        words = re.fullmatch(r"\s*'([\w./-]+\.[ch]|[\w-]+/test_\w+|cli/cases_\w+\.py)',", line)
        if words:
            current.append(words.group(1))
            continue
        if current:
            found.append(current)
        current = []
    return found


def faults_of(folder, name):
    """Faults of the lists of one meson file, and the paths in them."""
    with open(os.path.join(ROOT, folder, name), encoding="utf-8") as f:
        text = f.read()
    faults, paths = [], []
    for files in lists(text):
        paths += files
        if files != sorted(files):
            first = next(a for a, b in zip(files, sorted(files)) if a != b)
            faults.append(f"{folder}/{name}: the list is not sorted at '{first}'")
        for twice in sorted({path for path in files if files.count(path) > 1}):
            faults.append(f"{folder}/{name}: '{twice}' stands twice")
    return faults, paths


def main():
    faults, listed = [], set()
    for folder in ("common", "generators", "eval", "tests"):
        wrong, paths = faults_of(folder, "meson.build")
        faults += wrong
        paths = [path if re.search(r"\.([ch]|py)$", path) else path + ".c" for path in paths]
        for path in paths:
            if not os.path.exists(os.path.join(ROOT, folder, path)):
                faults.append(f"{folder}/meson.build: there is no '{path}'")
        listed |= {os.path.join(folder, path) for path in paths}
    sources = glob.glob("*/**/*.c", root_dir=ROOT, recursive=True) + glob.glob("tests/cli/cases_*.py", root_dir=ROOT)
    for source in sorted(sources):
        of_tree = source.split("/")[0] in ("common", "generators", "eval", "tests")
        if of_tree and source not in listed and not BY_NAME.match(source) and not is_a_key(source):
            faults.append(f"{source} is in no list of {source.split('/')[0]}/meson.build")
    print("\n".join(faults) or f"{len(listed)} files, each in its list")
    return 1 if faults else 0


def is_a_key(source):
    """Tests that name their sources: 'room/test_x': [...] in tests/meson.build."""
    with open(os.path.join(ROOT, "tests", "meson.build"), encoding="utf-8") as f:
        return f"'{source[len('tests/'):-2]}': [" in f.read()


if __name__ == "__main__":
    sys.exit(main())
