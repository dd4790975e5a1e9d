"""The kinds of particles of a scene, and their files: templates, and the scripts of engines."""
from __future__ import annotations

import math
import os
from contextlib import contextmanager, suppress
from typing import Any, Dict, Iterator, List, NamedTuple, NoReturn, Optional, Sequence, Tuple

import numpy

from ._clumps import Clump, c_particle_of, lend, list_files, try_file, try_files, write_as
from ._errors import (TINY, ArgumentError, FileError, OutOfMemoryError, Path, as_floats, call, encode, find, number,
                      remark, show, whole, word)
from ._library import ffi, lib
from ._scene_rows import name_row
from ._shapes import Grid, Shape

_WIDEST = 1e100  # of a vessel, so that the area of its floor is a number


class Kind(NamedTuple):
    """One kind of particles of a scene.

    shape: of which they are; its name is that of the files, and may be set before `Scene.write`.
    particles: how many in the scene.
    size: diameter of the ball of its volume, in the unit of the shape; NaN: as the shape is.
    clump: its template, in its size.
    dice: (m,): D of the templates of 1, 2, ... spheres; NaN where a search has not made them.
    factor: its size / that of the shape.
    grid: on which the templates were made.
    remarks: on the template, of the method and of a scale far from 1; "" without.
    """
    shape: Shape
    particles: int
    size: float
    clump: Clump
    dice: numpy.ndarray
    factor: float
    grid: Grid
    remarks: str

    @property
    def name(self) -> str:
        """What messages call it."""
        return name_row(self.shape, self.size)

    def tell(self) -> None:
        """Warns of what the method remarks."""
        if self.remarks:
            remark(f"{self.name}: {self.remarks}")


def _find_formats(names: Any) -> List[Any]:
    if not isinstance(names, Sequence) or not names:
        raise ArgumentError(f"format={show(names)} is neither a format nor a list of them")
    found: List[Any] = []
    for name in names:
        row = find(lib.ms_write_format_find, word("format", name))
        if row in found:
            raise ArgumentError(f"format {name!r} is given twice")
        found.append(row)
    return found


def _vessel(formats: List[Any], box: Any, cylinder: Any) -> Any:
    made = ffi.new("ms_scene_vessel *")
    if box is not None and cylinder is not None:
        raise ArgumentError("there is one vessel: give box or cylinder")
    if box is None and cylinder is None:
        return made
    if all(row.scene.suffix == ffi.NULL for row in formats):
        raise ArgumentError("box and cylinder are of scripts; give format liggghts, lammps or yade")
    widths = as_floats([cylinder, cylinder] if box is None else box)
    if widths.shape != (2,):
        raise ArgumentError(f"cylinder={show(cylinder)} is no diameter" if box is None else
                            f"box={show(box)} is not two widths x, y")
    name = "cylinder" if box is None else "box"
    made.width = [number(name, width, TINY, _WIDEST) for width in widths.tolist()]
    made.is_round = box is None
    return made


def _take(path: Any) -> bytes:
    """One that the library made."""
    if path == ffi.NULL:
        raise OutOfMemoryError("no memory for the names of the files")
    made = bytes(ffi.string(path))
    lib.free(path)
    return made


def _path(kind: Kind, folder: bytes, format: Any) -> bytes:
    """Of its template."""
    size = "" if math.isnan(kind.size) else f"-{kind.size:.6g}"
    path = _take(lib.ms_write_path(folder, encode(kind.shape.name), size.encode(), format))
    call(lib.ms_write_check_path, path, format)
    return path


def _refuse_twice(path: bytes, before: Optional[Kind], kind: Kind) -> NoReturn:
    file, name = os.fsdecode(path), kind.shape.name
    if before is None:
        raise ArgumentError(f"the script of the scene and a file of {name} would both be {file}; rename the shape "
                            "(shape.name)")
    if before.shape is kind.shape:
        raise ArgumentError(f"{name} in the sizes {before.size!r} and {kind.size!r}: the templates would both be "
                            f"{file}; sizes of one shape have to differ within six digits")
    raise ArgumentError(f"the templates of {before.shape.name} and {name} would both be {file}; rename one of the "
                        "shapes (shape.name)")


def _check_files(kinds: List[Kind], formats: List[Any], paths: List[List[bytes]], scripts: List[bytes]) -> None:
    """Is none written twice? The frame is that of the kind in all formats."""
    taken: Dict[bytes, Tuple[Optional[Kind], bool]] = {script: (None, False) for script in scripts}
    for format, files in zip(formats, paths):
        for kind, path in zip(kinds, files):
            for file, is_frame in list_files(path, format):
                mine = (kind, is_frame)
                before = taken.setdefault(file, mine)
                if before is not mine and not (before[0] is kind and before[1] and is_frame):
                    _refuse_twice(file, before[0], kind)


class _Lent:
    """The kinds as the library takes them; what it looks at is kept."""

    def __init__(self, kinds: List[Kind]) -> None:
        lent = [lend(kind.clump) for kind in kinds]
        self.kinds, self.clumps = kinds, [clump for clump, _ in lent]
        self.particles = [c_particle_of(kind.clump.particle) for kind in kinds]
        self.names = [ffi.new("char[]", encode(kind.name)) for kind in kinds]
        self._kept = [kept for _, kept in lent]

    def check(self, format: Any) -> None:
        """Can it hold each template?"""
        for kind, clump, particle in zip(self.kinds, self.clumps, self.particles):
            content = ffi.new("ms_content *", {"clump": clump, "particle": particle})
            call(lib.ms_write_check, content, format, name=kind.name)

    def as_scene(self, paths: List[bytes]) -> Any:
        self._paths = [ffi.new("char[]", path) for path in paths]
        return ffi.new("ms_scene_kind[]", [
            {"clump": clump, "particle": particle, "name": name, "path": path,
             "count": whole(f"{kind.name}: particles", kind.particles, 1, lib.MS_MANIFEST_MAX_PARTICLES)}
            for kind, clump, particle, name, path in zip(self.kinds, self.clumps, self.particles, self.names,
                                                         self._paths)])


@contextmanager
def _open_folder(folder: bytes) -> Iterator[None]:
    """Makes it if it is not there; then it does not stay if nothing could be written."""
    is_there = os.path.isdir(folder)
    try:
        if not is_there:
            os.mkdir(folder)
    except OSError as failure:
        if not os.path.isdir(folder):  # else another thread has made it meanwhile
            raise FileError(f"the folder '{os.fsdecode(folder)}' cannot be made: {failure.strerror}; name one within a "
                            "folder that exists") from None
    try:
        yield
    finally:
        if not is_there:
            with suppress(OSError):  # something is in it
                os.rmdir(folder)


def write_scene(kinds: List[Kind], folder: Path, names: Any, box: Optional[Any], cylinder: Any) -> List[str]:
    """As Scene.write."""
    place, formats = encode(folder), _find_formats(names)
    if not kinds:
        raise ArgumentError("the scene has no kinds of particles; there is nothing to write")
    vessel, lent = _vessel(formats, box, cylinder), _Lent(kinds)
    paths = [[_path(kind, place, format) for kind in kinds] for format in formats]
    scripts = [_take(lib.ms_scene_script_path(place, format)) for format in formats
               if format.scene.suffix != ffi.NULL]
    _check_files(kinds, formats, paths, scripts)
    for format, files in zip(formats, paths):
        lent.check(format)
        if format.scene.suffix != ffi.NULL:
            call(lib.ms_scene_script_check, lent.as_scene(files), len(kinds), vessel)
    with _open_folder(place):
        for format, files in zip(formats, paths):
            for path in files:
                try_files(path, format)
        for script in scripts:
            try_file(script)
        for at, kind in enumerate(kinds):
            for format, files in zip(formats, paths):
                write_as(kind.clump, files[at], format)
        for format, files in zip(formats, paths):
            if format.scene.suffix != ffi.NULL:
                call(lib.ms_scene_script_write, lent.as_scene(files), len(kinds), vessel, place, format)
    return [os.fsdecode(files[at]) for at in range(len(kinds)) for files in paths] + list(map(os.fsdecode, scripts))
