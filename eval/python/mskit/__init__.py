"""mskit: multi-sphere clumps for discrete element (DEM) simulation.

>>> import mskit
>>> grain = mskit.body("grain", seed=3, fineness=12)
>>> clump = mskit.generate(grain, "mss", spheres=20, cells=30)
>>> clump.centres.shape, clump.radii.shape
((20, 3), (20,))
>>> clump.scores["dice"] < 0.1
True

Lengths are in the unit of the shape, angles in degrees, masses in kg. Errors are `mskit.Error`. More: docs/python.md.
"""
import os as _os

# Threads that spin while they wait lose where others want the cores, too: these look for some ten microseconds and then
# sleep. OpenMP reads its policy when it is loaded, so it is set before the library is.
if "OMP_WAIT_POLICY" not in _os.environ and "GOMP_SPINCOUNT" not in _os.environ:
    _os.environ.update(OMP_WAIT_POLICY="passive", GOMP_SPINCOUNT="500")

from ._allocate import Allocation, allocate
from ._clumps import Clump, Particle, formats, read_clump, write
from ._contact import contact
from ._errors import (ArgumentError, Error, FileError, FormatError, LimitError, OutOfMemoryError, Remark, ShapeError)
from ._expect import Expectation, expect
from ._generate import Progress, correct, curve, equal_volume, generate, score
from ._library import ffi as _ffi
from ._library import lib as _lib
from ._measures import Measure, measures
from ._methods import Generator, Option, generators
from ._meshes import body, mesh
from ._scene import Scene, scene
from ._scene_files import Kind
from ._scene_rows import Sieved, sieve
from ._shapes import Shape
from ._sources import read
from ._volumes import grains, volume

__version__: str = _ffi.string(_lib.ms_version()).decode()
__all__ = [
    "Allocation", "ArgumentError", "Clump", "Error", "Expectation", "FileError", "FormatError", "Generator",
    "Kind", "LimitError", "Measure", "Option", "OutOfMemoryError", "Particle", "Progress", "Remark", "Scene", "Shape",
    "ShapeError", "Sieved",
    "allocate", "body", "contact", "correct", "curve", "equal_volume", "expect", "formats", "generate", "generators",
    "grains", "measures", "mesh", "read", "read_clump", "scene", "score", "sieve", "volume", "write",
]

# Forked while OpenMP has threads, a child waits for them for ever: its runs take the one thread that it has.
_os.register_at_fork(after_in_child=lambda: _lib.omp_set_num_threads(1))
