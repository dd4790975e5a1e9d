#!/usr/bin/env python3
"""Grains as a job array of a real Slurm, by the script of docs/cluster.md: tasks are killed and requeued, and the
merged result is that of one run.

    MSKIT=build/eval/mskit MSKIT_DOCS=docs tests/cluster/test_cluster.py [-v]

It starts munged, slurmctld and slurmd on this machine, on the loopback alone, and ends them; `meson test` leaves it
out, `meson test --setup all --suite cluster` runs it.
"""
import csv
import os
import signal
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cli"))
from slurm_node import Node, is_running, until, what_is_missing  # noqa: E402
from support import MSKIT, box_obj  # noqa: E402

DOCS = os.environ.get("MSKIT_DOCS", os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs"))
GRAINS = 48
PARTS = 4
ARGS = ("stones", "-g", "mss", "-n", "20", "--cells", "70")


class Cluster(unittest.TestCase):
    PROCTRACK = "proctrack/pgid"

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="mskit-cluster-")
        self.addCleanup(folder.cleanup)
        self.dir = folder.name
        os.chmod(self.dir, 0o755)  # munge wants all above its socket to be reached
        os.mkdir(self.path("slurm"))
        self.node = Node(self.path("slurm"), self.PROCTRACK)
        self.node.env["PATH"] = os.path.dirname(os.path.abspath(MSKIT)) + ":" + self.node.env["PATH"]
        self.addCleanup(self.node.stop)
        self.node.start()
        os.mkdir(self.path("stones"))
        for k in range(GRAINS):
            with open(self.path(f"stones/{k:02d}.obj"), "w", encoding="utf-8") as f:
                f.write(box_obj((0, 0, 0), (1 + k / GRAINS, 1.3, 2)))

    def path(self, name):
        return os.path.join(self.dir, name)

    def mskit(self, *args):
        return self.node.call("mskit", *args, cwd=self.dir)

    def submit(self, array, out="out"):
        return self.node.call("sbatch", "--parsable", "--array=" + array, "--cpus-per-task=1", "--mem=2G",
                              os.path.join(DOCS, "grains-array.sh"), *ARGS, "-o", out, cwd=self.dir).strip()

    def log(self, job, task):
        with open(self.path(f"grains-{job}-{task}.log"), encoding="utf-8") as f:
            return f.read()

    def rows(self, name):
        with open(self.path(name), encoding="utf-8", newline="") as f:
            return [{key: value for key, value in row.items() if key not in ("seconds", "beside")}
                    for row in csv.DictReader(f)]

    def clumps(self, out):
        found = {}
        for folder, _, names in os.walk(self.path(out)):
            for name in names:
                path = os.path.join(folder, name)
                if not name.startswith("grains"):
                    with open(path, "rb") as f:
                        found[os.path.relpath(path, self.path(out))] = f.read()
        return found

    def count_rows(self, task):
        try:
            return len(self.rows(f"out/grains-{task}-of-{PARTS}.csv"))
        except OSError:
            return 0

    def find_program(self, task):
        """The process of mskit of a task."""
        for pid in filter(str.isdigit, os.listdir("/proc")):
            try:
                with open(f"/proc/{pid}/cmdline", "rb") as f:
                    words = f.read().decode("utf-8", "replace").split("\0")
                if f"{task}/{PARTS}" in words and os.path.samefile(f"/proc/{pid}/cwd", self.dir) and \
                        os.path.basename(words[0]) == "mskit":
                    return int(pid)
            except OSError:
                continue
        return 0

    def await_work(self, task):
        """Some rows are done, and some are not; the process and its shell."""
        until(f"task {task} has no rows", lambda: self.count_rows(task) >= 2)
        program = self.find_program(task)
        self.assertTrue(program, f"task {task} is done before it could be disturbed")
        with open(f"/proc/{program}/stat", encoding="utf-8") as f:
            return program, int(f.read().rsplit(")", 1)[1].split()[1])

    def check_merged(self):
        """One run gives the same rows but for times, and the same clumps."""
        self.mskit("grains", "--merge", "out", "-o", "out")
        self.mskit("grains", *ARGS, "-o", "whole")
        self.assertEqual(self.rows("out/grains.csv"), self.rows("whole/grains.csv"))
        whole, merged = self.clumps("whole"), self.clumps("out")
        self.assertEqual(len(whole), GRAINS)
        self.assertEqual({name: merged.get(name) for name in whole}, whole)


class Requeued(Cluster):
    def test_array_of_which_tasks_are_killed(self):
        """Task 1 is left alone; the shell of 2 and the program of 3 are killed; 4 is near its time limit."""
        job = self.submit(f"1-{PARTS}")
        program, shell = self.await_work(2)
        os.kill(shell, signal.SIGKILL)
        os.kill(self.await_work(3)[0], signal.SIGKILL)
        self.await_work(4)
        self.node.call("scancel", "--batch", "--signal=USR1", f"{job}_4")
        self.node.await_state(job, 2, "FAILED")
        until("the program of a killed shell goes on", lambda: not is_running(program))
        self.assertLess(self.count_rows(2), GRAINS // PARTS)
        for task in (3, 4):
            self.node.await_state(job, task, "COMPLETED")
        self.assertEqual(self.node.state(job, 2), "FAILED", "Slurm leaves it at that")
        self.node.call("scontrol", "requeue", f"{job}_2")
        for task in range(1, PARTS + 1):
            self.node.await_state(job, task, "COMPLETED")
        self.assertNotIn("queued again", self.log(job, 1) + self.log(job, 2))
        self.assertIn("killed by signal 9: queued again", self.log(job, 3))
        self.assertIn("time limit: queued again", self.log(job, 4))
        self.check_merged()

    def test_tasks_that_are_not_all_parts(self):
        job = self.submit("2-3")
        self.node.await_state(job, 3, "FAILED")
        self.assertIn("PARTS=", self.log(job, 3))
        self.assertFalse(os.path.exists(self.path("out")))


class Orphaned(Cluster):
    """Slurm that loses the children of a killed shell."""
    PROCTRACK = "proctrack/linuxproc"

    def test_attempt_beside_a_program_that_goes_on(self):
        job = self.submit(f"1-{PARTS}")
        program, shell = self.await_work(2)
        self.addCleanup(lambda: is_running(program) and os.kill(program, signal.SIGKILL))
        os.kill(shell, signal.SIGKILL)
        until("the shell is not killed", lambda: not is_running(shell))
        os.kill(program, signal.SIGSTOP)  # not before: a stopped child gets SIGHUP when its shell ends
        self.node.await_state(job, 2, "FAILED")
        self.assertTrue(is_running(program), "it should be lost: then this test has no sense")
        self.node.call("scontrol", "requeue", f"{job}_2")
        until("the second attempt is not refused", lambda: "another run is writing it" in self.log(job, 2))
        self.node.await_state(job, 2, "FAILED")
        os.kill(program, signal.SIGCONT)
        until("the first attempt does not end", lambda: not is_running(program))
        self.assertEqual(self.count_rows(2), GRAINS // PARTS)
        self.node.call("scontrol", "requeue", f"{job}_2")
        for task in range(1, PARTS + 1):
            self.node.await_state(job, task, "COMPLETED")
        self.check_merged()


if __name__ == "__main__":
    missing = what_is_missing()
    if missing:
        print("skipped:", missing)
        sys.exit(77)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that what was started is ended
    unittest.main(failfast=True)
