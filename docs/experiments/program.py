"""The program, for the experiments: MSKIT names it, build/eval/mskit otherwise."""
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
MSKIT = os.path.abspath(os.environ.get("MSKIT", os.path.join(HERE, "..", "..", "build", "eval", "mskit")))


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
