"""The program, for the experiments: MSKIT names it, build/eval/mskit otherwise."""
import argparse
import math
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
MSKIT = os.path.abspath(os.environ.get("MSKIT", os.path.join(HERE, "..", "..", "build", "eval", "mskit")))


def read_count(text):
    """An argument that is a whole number from 0 on."""
    if not (text.isascii() and text.isdigit()):
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from 0 on")
    return int(text)


def read_counts(text):
    return [read_count(word) for word in text.split(",")]


def read_positive(text):
    """An argument that is a number above 0."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not (value > 0 and math.isfinite(value)):
        raise argparse.ArgumentTypeError(f"'{text}' is not a number above 0")
    return value


def run_mskit(*words):
    """What it prints. Ends here, with its own sentence, where it fails."""
    try:
        done = subprocess.run([MSKIT, *map(str, words)], check=False, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              encoding="utf-8")
    except OSError as error:
        sys.exit(f"{MSKIT}: {error.strerror}; build the program, or name it by MSKIT")
    if done.returncode:
        sys.exit(done.stderr.strip())
    return done.stdout


def ask_version():
    return run_mskit("--version").strip()
