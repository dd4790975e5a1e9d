"""Runs: progress, Ctrl-C, threads, memory."""
import contextlib
import ctypes
import gc
import io
import math
import os
import pickle
import re
import signal
import subprocess
import sys
import threading
import time
import unittest

import mskit
import numpy
from support_python import TIMEOUT, PythonCase, labelled

try:
    import tqdm
except ImportError:
    tqdm = None


class Mallinfo(ctypes.Structure):
    """mallinfo2 of glibc."""
    _fields_ = [(name, ctypes.c_size_t) for name in
                "arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost".split()]


def allocated():
    """Bytes that malloc has given out and that were not given back."""
    look = ctypes.CDLL(None).mallinfo2
    look.restype = Mallinfo
    now = look()
    return now.uordblks + now.hblkhd


class Runs(PythonCase):
    def test_progress(self):
        told = []
        mskit.generate(self.path(self.grain), "mss", spheres=6, cells=20, progress=told.append)
        self.assertEqual({now.spheres for now in told if now.spheres}, set(range(1, 7)))
        self.assertEqual(max(told, key=lambda now: now.spheres).spheres, told[-1].spheres)
        told.clear()
        mskit.generate(self.path(self.grain), spheres=6, cells=20, progress=told.append)
        self.assertTrue(any("fit of" in now.stage for now in told))
        shares = [now.share for now in told if not math.isnan(now.share)]
        self.assertEqual(shares, sorted(shares))

    def test_what_progress_raises_ends_the_run(self):
        told = []

        def end(now):
            told.append(now)
            if len(told) == 3:
                raise RuntimeError("enough")

        for name in mskit.generators:
            told.clear()
            with contextlib.suppress(RuntimeError):
                mskit.generate(self.path(self.grain), name, spheres=9, cells=20, progress=end)
                self.assertLess(len(told), 3, name)  # told less often
            self.assertLessEqual(len(told), 3, "nobody is told any more")
        with self.assertRaisesRegex(RuntimeError, "enough"):
            told.clear()
            mskit.generate(self.path(self.grain), "mss", spheres=9, cells=20, progress=end)

    @unittest.skipUnless(tqdm, "tqdm is not installed (package python3-tqdm)")
    def test_bar(self):
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            mskit.generate(self.path(self.grain), spheres=6, cells=20, progress=True)
        self.assertIn("fit of 6 spheres", said.getvalue())

    def interrupt_after(self, seconds, generator, **options):
        """Seconds of the processor that a run takes until it ends by a SIGINT."""
        shape = mskit.read(self.path(self.grain))
        timer = threading.Timer(seconds, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        start = time.process_time()
        with self.assertRaises(KeyboardInterrupt):
            mskit.generate(shape, generator, threads=1, **options)
        return time.process_time() - start

    def test_interrupt(self):
        """A run that would take long ends soon, and the next one is whole."""
        for generator, options in [("mss", {"spheres": 3000, "cells": 60, "spacing": 1}),
                                   ("variational", {"spheres": 250})]:
            with self.subTest(generator=generator):
                self.assertLess(self.interrupt_after(0.3, generator, **options), 3)
                self.assertEqual(len(mskit.generate(self.path(self.grain), generator, spheres=3, cells=12)), 3)

    def test_other_threads_go_on(self):
        """The lock of the interpreter is free while the library works."""
        ticks, done = [], threading.Event()

        def tick():
            while not done.is_set():
                ticks.append(time.perf_counter())
                time.sleep(0.001)

        thread = threading.Thread(target=tick)
        thread.start()
        start = time.perf_counter()
        shape = mskit.read(self.path(self.grain))
        mskit.score(mskit.generate(shape, "mss", spheres=3, cells=100), cells=150)
        end = time.perf_counter()
        done.set()
        thread.join()
        longest = max(numpy.diff([start, *(t for t in ticks if start < t < end), end]))
        self.assertLess(longest, (end - start) / 2)

    def test_threads_of_python_side_by_side(self):
        alone = mskit.generate(self.path(self.grain), "mss", spheres=8, cells=30)
        found = []
        threads = [threading.Thread(target=lambda: found.append(
            mskit.generate(self.path(self.grain), "mss", spheres=8, cells=30))) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual([(c.spheres == alone.spheres).all() for c in found], [True] * 4)

    def test_one_shape_in_many_threads(self):
        """With other grids, so that one thread lets go of the voxels that another works on."""
        shape, found = mskit.read(self.path(self.grain)), {}

        def run(cells):
            clump = mskit.generate(shape, "mss", spheres=5, cells=cells)
            found[cells] = clump.spheres.tobytes(), clump.scores["dice"]

        threads = [threading.Thread(target=run, args=(cells,)) for cells in (20, 24, 28, 32)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for cells in list(found):
            kept = found[cells]
            run(cells)
            self.assertEqual(found[cells], kept)
        self.assertEqual(len(found), 4)

    def test_voxels_that_another_thread_lets_go_of_at_once(self):
        """Each run works on its own all the same."""
        shape = mskit.read(self.path(self.grain))
        alone = mskit.generate(shape, "mss", spheres=5, cells=20)
        shape.__class__ = type("Raced", (mskit.Shape,), {"_made": property(lambda self: None, lambda self, made: None)})
        self.assertTrue((mskit.generate(shape, "mss", spheres=5, cells=20).spheres == alone.spheres).all())

    def test_to_another_process(self):
        clump = mskit.correct(mskit.generate(self.path(self.grain), "mss", spheres=5, cells=20), density=7,
                              carriers=True)
        again = pickle.loads(pickle.dumps(clump))
        for name in ("spheres", "masses"):
            self.assertTrue((getattr(again, name) == getattr(clump, name)).all())
        self.assertEqual(again.particle.mass, clump.particle.mass)
        again.write(self.path("again.lammps"))
        clump.write(self.path("clump.lammps"))
        self.assertEqual(self.read("again.lammps"), self.read("clump.lammps"))

    def test_same_bits_at_any_number_of_threads(self):
        made = [mskit.generate(self.path(self.grain), name, spheres=12, cells=40, threads=threads).spheres.tobytes()
                for name in ("mss", "variational") for threads in (1, 2, 3)]
        self.assertEqual([len(set(made[:3])), len(set(made[3:]))], [1, 1])

    def script(self, text, **environment):
        """What a new interpreter prints."""
        more = {k: v for k, v in os.environ.items() if not k.startswith(("OMP_", "GOMP_"))}
        return subprocess.run([sys.executable, "-c", text], env={**more, **environment}, check=True, text=True,
                              capture_output=True, timeout=TIMEOUT, cwd=self.dir)

    def test_threads_soon_sleep_while_they_wait(self):
        """By what OpenMP of gcc says when it is loaded: how often a thread looks before it sleeps."""
        def spins(**environment):
            found = re.search(r"GOMP_SPINCOUNT = '(\d+)'",
                              self.script("import mskit", OMP_DISPLAY_ENV="verbose", **environment).stderr)
            if not found:
                self.skipTest("another OpenMP than gcc's")
            return int(found[1])

        self.assertEqual(spins(), 500)
        self.assertGreater(spins(OMP_WAIT_POLICY="active"), 0, "who asks for another policy gets it")
        self.assertEqual(spins(GOMP_SPINCOUNT="77"), 77)

    def test_forked_child(self):
        said = self.script(
            "import multiprocessing, mskit\n"
            "run = lambda _=0: mskit.generate(mskit.body('ball', fineness=8), 'mss', spheres=3, "
            "cells=50).spheres.tobytes()\n"
            "def child(k): return run()\n"
            "before = run()\n"
            "with multiprocessing.get_context('fork').Pool(2) as pool:\n"
            "    print(set(pool.map(child, range(3))) == {before})\n", OMP_NUM_THREADS="2")
        self.assertEqual(said.stdout, "True\n")

    def test_pool_of_shapes(self):
        """Forked and spawned children get shapes and send clumps."""
        self.write("work.py", "import mskit\n"
                   "def run(shape): return mskit.generate(shape, 'mss', spheres=3, cells=20)\n")
        said = self.script(
            "import multiprocessing, mskit, work\n"
            "shapes = [mskit.body('ball', fineness=8), mskit.body('torus', fineness=8)]\n"
            "if __name__ == '__main__':\n"
            "    before = [work.run(shape).spheres.tobytes() for shape in shapes]\n"
            "    for how in ('fork', 'spawn'):\n"
            "        with multiprocessing.get_context(how).Pool(2) as pool:\n"
            "            print([c.spheres.tobytes() for c in pool.map(work.run, shapes)] == before)\n")
        self.assertEqual(said.stdout, "True\nTrue\n")

    def test_memory_of_pickled_shapes_is_given_back(self):
        data = [pickle.dumps(mskit.body("torus", fineness=8)), pickle.dumps(mskit.volume(labelled(), label=3))]

        def use():
            return [pickle.loads(each).volume for each in data]

        self.assertLess(self.growth(use, 20, 50), 500)

    def test_arrays_outlive_what_they_come_from(self):
        shape = mskit.read(self.path(self.grain))
        clump = mskit.generate(shape, "mss", spheres=5, cells=20)
        kept = [shape.vertices, shape.faces, clump.centres, clump.radii, shape.centroid, shape.inertia]
        before = [array.copy() for array in kept]
        del shape, clump
        gc.collect()
        mskit.generate(self.path(self.grain), "mss", spheres=50, cells=30)
        for array, copy in zip(kept, before):
            self.assertEqual(array.tobytes(), copy.tobytes())

    def test_target_outlives_a_shape_in_use(self):
        clump = mskit.generate(mskit.mesh(mskit.body("torus").vertices, mskit.body("torus").faces), "mss", spheres=4,
                               cells=12)
        gc.collect()
        self.assertEqual(clump.scores["spheres"], 4)

    def growth(self, use, warm, runs):
        """Bytes that stay of a call."""
        for _ in range(warm):
            use()
        gc.collect()
        before = allocated()
        for _ in range(runs):
            use()
        gc.collect()
        return (allocated() - before) / runs

    def test_memory_of_runs_is_given_back(self):
        """A single target that stayed would be 3 MB, and each call makes several."""
        labels = labelled()

        def use():
            shape = mskit.read(self.path(self.grain))
            clump = mskit.generate(shape, "mss", spheres=4, cells=60)
            mskit.curve(clump)
            with contextlib.suppress(mskit.Error):
                mskit.generate(shape, "mss", min_radius=100, cells=60)
            return [mskit.generate(grain, "mss", spheres=2) for grain in mskit.grains(labels)]

        self.assertLess(self.growth(use, 3, 8), 2000)

    def test_memory_of_objects_is_given_back(self):
        """Of what is small and made often: less than the smallest of its arrays."""
        tetrahedron = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
        mskit.Clump(numpy.random.default_rng(3).random((50, 3)), numpy.ones(50)).write(self.path("c.csv"))

        def use():
            clump = mskit.read_clump(self.path("c.csv"))
            shape = mskit.mesh(*tetrahedron)
            mskit.correct(clump[:3], shape, density=1)
            with contextlib.suppress(mskit.Error):
                mskit.generate(shape, "mss", spacing=-1, plane=(1, 0, 0, 1))

        self.assertLess(self.growth(use, 50, 400), 50)


if __name__ == "__main__":
    unittest.main()
