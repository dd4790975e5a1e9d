"""The kinds of particles of a scene, and their files: templates, and the scripts of engines."""
from __future__ import annotations

import math
import os
from typing import Any, List, NamedTuple, Optional, Sequence

import numpy

from ._clumps import Clump, c_particle_of, lend, write_as
from ._errors import (ArgumentError, FileError, OutOfMemoryError, Path, as_floats, call, encode, find, number, remark,
                      show, word)
from ._library import ffi, lib
from ._shapes import Grid, Shape

_WIDEST = 1e100  # of a vessel, so that the area of its floor is a number


class Kind(NamedTuple):
    """One kind of particles of a scene."""
    shape: Shape
    particles: int
    size: float  # diameter of the ball of its volume, in the unit of the shape; NaN: as the shape is
    clump: Clump  # its template, in its size
    dice: numpy.ndarray  # (m,): D of the templates of 1, 2, ... spheres; NaN where a search has not made them
    factor: float  # its size / that of the shape
    grid: Grid  # on which the templates were made
    remarks: str  # of the method on the template; "" without

    @property
    def name(self) -> str:
        """What messages call it."""
        return self.shape.name if math.isnan(self.size) else f"{self.shape.name}, size {self.size:g}"

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
    made.width = [number(name, width, 1e-300, _WIDEST) for width in widths.tolist()]
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
    size = "" if math.isnan(kind.size) else f"-{kind.size:.6g}"
    return _take(lib.ms_write_path(folder, os.fsencode(kind.shape.name), size.encode(), format))


def _name_files(kinds: List[Kind], folder: bytes, format: Any) -> List[bytes]:
    """The template of each kind."""
    paths: List[bytes] = []
    for kind in kinds:
        path = _path(kind, folder, format)
        if path in paths:
            other = kinds[paths.index(path)].shape.name
            raise ArgumentError(f"the templates of {other} and {kind.shape.name} would both be {os.fsdecode(path)}; "
                                "rename one of the shapes")
        call(lib.ms_write_check_path, path, format)
        paths.append(path)
    return paths


class _Lent:
    """The kinds as the library takes them; what it looks at is kept."""

    def __init__(self, kinds: List[Kind]) -> None:
        lent = [lend(kind.clump) for kind in kinds]
        self.kinds, self.clumps = kinds, [clump for clump, _ in lent]
        self.particles = [c_particle_of(kind.clump.particle) for kind in kinds]
        self.names = [ffi.new("char[]", os.fsencode(kind.name)) for kind in kinds]
        self._kept = [kept for _, kept in lent]

    def check(self, format: Any) -> None:
        """Can it hold each template?"""
        for kind, clump, particle in zip(self.kinds, self.clumps, self.particles):
            content = ffi.new("ms_content *", {"clump": clump, "particle": particle})
            call(lib.ms_write_check, content, format, name=kind.name)

    def as_scene(self, paths: List[bytes]) -> Any:
        self._paths = [ffi.new("char[]", path) for path in paths]
        return ffi.new("ms_scene_kind[]", [
            {"clump": clump, "particle": particle, "name": name, "path": path, "count": kind.particles}
            for kind, clump, particle, name, path in zip(self.kinds, self.clumps, self.particles, self.names,
                                                         self._paths)])


def write_scene(kinds: List[Kind], folder: Path, names: Any, box: Optional[Any], cylinder: Any) -> List[str]:
    """As Scene.write."""
    place, formats = encode(folder), _find_formats(names)
    vessel, lent = _vessel(formats, box, cylinder), _Lent(kinds)
    paths = [_name_files(kinds, place, format) for format in formats]
    for format, files in zip(formats, paths):
        lent.check(format)
        if format.scene.suffix != ffi.NULL:
            call(lib.ms_scene_script_check, lent.as_scene(files), len(kinds), vessel)
    try:
        os.makedirs(place, exist_ok=True)
    except OSError as failure:
        raise FileError(f"the folder '{os.fsdecode(place)}' cannot be made: {failure.strerror}") from None
    written: List[bytes] = []
    for at, kind in enumerate(kinds):
        for format, files in zip(formats, paths):
            write_as(kind.clump, files[at], format)
            written.append(files[at])
    for format, files in zip(formats, paths):
        if format.scene.suffix != ffi.NULL:
            call(lib.ms_scene_script_write, lent.as_scene(files), len(kinds), vessel, place, format)
            written.append(_take(lib.ms_scene_script_path(place, format)))
    return [os.fsdecode(path) for path in written]
