"""The rows of a scene: shapes, how many there are of each, and in which size."""
from __future__ import annotations

import math
import os
from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy

from ._errors import ArgumentError, Error, Path, as_floats, call, encode, number, show, whole
from ._library import ffi, lib
from ._shapes import Bytes, Shape
from ._sources import as_shape

_COLUMNS = ("shape", "count", "tolerance", "size")

#: Of a scene: (shape, count), or a dict of shape, count, tolerance, size, each; or the path of a manifest.
Rows = Union[Path, Sequence[Any]]


class Row(NamedTuple):
    """One kind of particles, as it was asked for."""
    shape: Shape
    particles: int
    tolerance: float  # NaN: none is given
    size: float  # NaN: as the shape is
    given: bool  # as a Shape, with which its voxels stay

    @property
    def name(self) -> str:
        return self.shape.name if math.isnan(self.size) else f"{self.shape.name}, size {self.size:g}"


def _named(row: Any, at: int) -> Dict[str, Any]:
    """A row by its columns."""
    if hasattr(row, "keys"):
        fields = dict(row)
    elif isinstance(row, (tuple, list)) and len(row) == 2:
        fields = {"shape": row[0], "count": row[1]}
    else:
        raise ArgumentError(f"row {at}: {show(row)} is neither (shape, count) nor a dict of shape, count, tolerance, "
                            "size")
    for name in fields:
        if name not in _COLUMNS:
            raise ArgumentError(f"row {at}: there is no column {show(name)}, but {', '.join(_COLUMNS)}")
    for name in _COLUMNS[:2]:
        if name not in fields:
            raise ArgumentError(f"row {at} has no {name}")
    return fields


def _read_row(row: Any, at: int, known: List[Tuple[Any, Shape]]) -> Row:
    """known: sources before and their shapes; what stands in several rows is one shape."""
    fields = _named(row, at)
    source, count = fields["shape"], whole(f"row {at}: count", fields["count"], 1, lib.MS_MANIFEST_MAX_PARTICLES)
    tolerance, size = fields.get("tolerance"), fields.get("size")
    tolerance = math.nan if tolerance is None else number(f"row {at}: tolerance", tolerance, 0, 1)
    size = math.nan if size is None else number(f"row {at}: size", size, lib.MS_MANIFEST_LEAST_SIZE,
                                                                       lib.MS_MANIFEST_MOST_SIZE)
    for before, shape in known:
        if source is before or (isinstance(source, (str, bytes, os.PathLike)) and type(before) is type(source)
                                and source == before):
            return Row(shape, count, tolerance, size, shape is source)
    try:
        shape = as_shape(source)
    except Error as failure:
        raise type(failure)(f"row {at}: {failure}") from None
    known.append((source, shape))
    return Row(shape, count, tolerance, size, shape is source)


def _read_manifest(path: Path) -> List[Dict[str, Any]]:
    manifest = ffi.gc(ffi.new("ms_manifest *"), lib.ms_manifest_free)
    call(lib.ms_manifest_read, manifest, encode(path))
    rows = []
    for at in range(manifest.count):
        row = manifest.row[at]
        rows.append({"shape": os.fsdecode(ffi.string(row.path)), "count": int(row.particles),
                     "tolerance": None if math.isnan(row.tolerance) else row.tolerance,
                     "size": None if math.isnan(row.size) else row.size})
    return rows


def _list_rows(rows: Any) -> Sequence[Any]:
    if isinstance(rows, (str, bytes, os.PathLike)):
        return _read_manifest(rows)
    if not isinstance(rows, Sequence) or not rows:
        raise ArgumentError(f"rows={show(rows)} is neither a list of rows (shape, count) nor the path of a manifest")
    return rows


def read_rows(rows: Rows) -> List[Row]:
    """Checks them, and reads what are no shapes yet."""
    known: List[Tuple[Any, Shape]] = []
    read: List[Row] = []
    places: Dict[Tuple[int, Optional[float]], int] = {}
    for at, row in enumerate(_list_rows(rows)):
        one = _read_row(row, at, known)
        place = (id(one.shape), None if math.isnan(one.size) else one.size)
        if place in places:
            raise ArgumentError(f"row {at}: {one.shape.name} stands twice"
                                f"{'' if math.isnan(one.size) else ' in this size'}; add up the counts")
        places[place] = at
        read.append(one)
    return read


class Sieved(NamedTuple):
    """The rows of a scene by a sieve curve, and its classes by ascending size."""
    rows: List[Dict[str, Any]]  # for `scene`
    sizes: numpy.ndarray  # (k,): diameter of the ball of a particle's volume
    counts: numpy.ndarray  # (k,): of particles of each class
    asked: numpy.ndarray  # (k,): its share of the mass, by the curve
    have: numpy.ndarray  # (k,): the share that its whole number of particles has


def _read_curve(curve: Any, classes: int) -> Any:
    """Arrays go the way of files: one set of checks."""
    made = ffi.gc(ffi.new("ms_sieve *"), lib.ms_sieve_free)
    if isinstance(curve, (str, bytes, os.PathLike)):
        call(lib.ms_sieve_read, made, encode(curve), classes)
        return made
    pairs = as_floats(curve)
    if pairs.ndim != 2 or pairs.shape[1] != 2:
        raise ArgumentError(f"curve={show(curve)} is neither rows size, passing nor the path of a sieve curve")
    lines = "".join(f"{size!r},{passing!r}\n" for size, passing in pairs.tolist())
    data = Bytes(numpy.frombuffer(f"size,passing\n{lines}\0".encode(), numpy.uint8))
    call(lib.ms_sieve_parse, made, data.c, b"the sieve curve", classes)
    return made


def sieve(rows: Rows, curve: Any, classes: Optional[int] = None) -> Sieved:
    """Gives the particles of a scene sizes by a sieve curve by mass, as `mskit scene --sieve`.

    rows: as for `scene`, without sizes. curve: (n, 2) numbers, by ascending size the share of the mass that is finer,
    from 0 to 1; or the path of a .csv with the header size,passing. classes: so many of equal mass; None: one between
    each row of the curve and the next.

    >>> found = mskit.sieve([(mskit.body("cube"), 1000)], [(1, 0), (2, 0.5), (4, 1)])
    >>> [(row["count"], round(row["size"], 3)) for row in found.rows]
    [(889, 1.334), (111, 2.669)]
    """
    classes = 0 if classes is None else whole("classes", classes, 1, lib.MS_SIEVE_MAX_CLASSES)
    given, made = [_named(row, at) for at, row in enumerate(_list_rows(rows))], _read_curve(curve, classes)
    if any(row.get("size") is not None for row in given):
        raise ArgumentError("rows have sizes, and so has the sieve curve; drop one of them")
    names = [ffi.new("char[]", str(at).encode()) for at in range(len(given))]
    asked = ffi.new("ms_manifest_row[]", [
        {"path": name, "particles": whole(f"row {at}: count", row["count"], 1, lib.MS_MANIFEST_MAX_PARTICLES)}
        for at, (name, row) in enumerate(zip(names, given))])
    manifest = ffi.new("ms_manifest *", {"row": asked, "count": len(given)})
    spread = ffi.gc(ffi.new("ms_manifest *"), lib.ms_manifest_free)
    call(lib.ms_sieve_apply, spread, made, manifest)
    sized = [{**given[int(ffi.string(spread.row[at].path))], "count": int(spread.row[at].particles),
              "size": spread.row[at].size} for at in range(spread.count)]
    size, counts, share, have = (numpy.array([getattr(made.of[c], name) for c in range(made.count)])
                                 for name in ("size", "count", "share", "mass"))
    return Sieved(sized, size, counts, share, have)
