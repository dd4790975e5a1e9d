"""Shapes from triangles.

Arrays go the way of files: as the bytes of a PLY in memory, so that there is one reader, one set of checks and one
result to the last bit.
"""
from __future__ import annotations

import os
from typing import Any

import numpy

from ._errors import (ArgumentError, LimitError, ShapeError, as_array, call, find, flag, number, remark, text, whole,
                      word)
from ._library import ffi, lib
from ._shapes import Bytes, Shape

_MOST_ROWS = 2**31 - 1
_BYTES_OF_ROW = 100  # of three doubles: a copy, its bytes, the PLY, and what is read from that
_SIDES = (1e-50, 1e50)  # inertia goes with the fifth power of a length, which must neither overflow nor vanish


def _check_side(name: str, mesh: Any) -> None:
    lo, hi = ffi.new("double[3]"), ffi.new("double[3]")
    lib.ms_mesh_box(lo, hi, mesh)
    side = max(hi[k] - lo[k] for k in range(3))
    if not _SIDES[0] <= side <= _SIDES[1]:
        raise ArgumentError(f"{name}: the mesh is {side:g} long, and {_SIDES[0]:g} to {_SIDES[1]:g} is allowed; choose "
                            "another unit")


def _finish_mesh(name: str, mesh: Any, weld: float, fill_holes: int, drop_bodies: float, allow_open: bool) -> Shape:
    """Mends a mesh, and takes the volume, centre and inertia of a closed one."""
    how = ffi.new("ms_mesh_mending *", {
        "weld": number("weld", weld, 0, 0.1), "fill_holes": whole("fill_holes", fill_holes, 0, 2**32 - 1),
        "drop_bodies": number("drop_bodies", drop_bodies, 0, 1)})
    shape = Shape(name, mesh=mesh)
    report = ffi.new("ms_mesh_report *")
    _check_side(name, mesh)
    call(lib.ms_mesh_mend, mesh, report, how, name=name)
    shape._report = report
    if report.closed:
        shape._solid = ffi.new("ms_solid *")
        call(lib.ms_solid_mesh, shape._solid, mesh, name=name)
    elif not flag("allow_open", allow_open):
        raise ShapeError(f"{name}: the mesh is open: {report.open_edges} edges belong to one triangle only, "
                         f"{report.odd_edges} to an odd number; close it, fill its holes ({report.holes}, the largest "
                         f"of {report.largest_hole} edges) with fill_holes={report.largest_hole}, or use "
                         "allow_open=True")
    return shape


def _new_mesh() -> Any:
    return ffi.gc(ffi.new("ms_mesh *"), lib.ms_mesh_free)


def _check_rows(name: str, rows: Any, kinds: str) -> numpy.ndarray:
    array = as_array(rows)
    if array.ndim != 2 or array.shape[1] != 3 or len(array) == 0 or array.dtype.kind not in kinds:
        what = "numbers" if "f" in kinds else "whole numbers"
        raise ArgumentError(f"{name} are not rows of three {what}, but of shape {array.shape} and type {array.dtype}")
    if len(array) > _MOST_ROWS:
        raise LimitError(f"{len(array)} {name} are more than {_MOST_ROWS}; simplify the mesh")
    if len(array) * _BYTES_OF_ROW > lib.ms_target_default_bytes():
        raise LimitError(f"{len(array)} {name} take {len(array) * _BYTES_OF_ROW / 1e9:.3g} GB on their way, more than "
                         "is allowed; simplify the mesh")
    return array


def mesh(vertices: Any, faces: Any, *, weld: float = lib.MS_MESH_WELD, fill_holes: int = 0, drop_bodies: float = 0,
         allow_open: bool = False) -> Shape:
    """A shape from triangles.

    vertices: (n, 3) numbers in the unit of length of the particle. faces: (m, 3) indices from 0.
    weld: corners of open edges within this part of the longest side are joined; vertices at one place always are.
    fill_holes: holes of at most so many edges are filled. drop_bodies: pieces smaller than this part of the largest are
    left out. allow_open: a mesh with holes is taken; its voxels are by majority of three axes.

    >>> corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> round(mskit.mesh(corners, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]).volume, 6)
    0.166667
    """
    corners, triangles = _check_rows("vertices", vertices, "fiu"), _check_rows("faces", faces, "iu")
    corners = corners.astype(numpy.float64)
    lost = numpy.flatnonzero(~numpy.isfinite(corners).all(axis=1))
    if lost.size:
        raise ArgumentError(f"vertex {lost[0]} is not finite: {corners[lost[0]].tolist()}")
    lost = numpy.flatnonzero(((triangles < 0) | (triangles >= len(corners))).any(axis=1))
    if lost.size:
        raise ArgumentError(f"face {lost[0]} is {triangles[lost[0]].tolist()}, "
                            f"and vertices are 0 to {len(corners) - 1}")
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(corners)}\n"
            f"property double x\nproperty double y\nproperty double z\nelement face {len(triangles)}\n"
            "property list uchar uint vertex_indices\nend_header\n")
    rows = numpy.empty(len(triangles), [("n", "u1"), ("corner", "<u4", 3)])
    rows["n"], rows["corner"] = 3, triangles
    parts = [numpy.frombuffer(part, numpy.uint8) for part in
             (head.encode(), corners.astype("<f8").tobytes(), rows.tobytes(), b"\0")]
    data = Bytes(numpy.concatenate(parts))
    made = _new_mesh()
    call(lib.ms_mesh_parse, made, ffi.NULL, data.c, b"vertices and faces.ply")
    return _finish_mesh("the mesh", made, weld, fill_holes, drop_bodies, allow_open)


def body(kind: str, **parameters: float) -> Shape:
    """A body to test with, by the names and parameters of `mskit shape --list`: ball, ellipsoid, torus, grain, ...

    >>> ball = mskit.body("ball", r=2, fineness=40)
    >>> abs(ball.volume / (4 / 3 * 3.14159265 * 8) - 1) < 0.002
    True
    """
    row = find(lib.ms_shape_find, word("kind", kind))
    known, at = {}, 0
    while row.parameters[at].name != ffi.NULL:
        known[text(row.parameters[at].name)] = row.parameters[at].fallback
        at += 1
    for name, value in parameters.items():
        if name not in known:
            raise ArgumentError(f"{kind} has no parameter '{name}', but {', '.join(known)}")
        known[name] = number(name, value, -1e300, 1e300)
    made = _new_mesh()
    call(lib.ms_shape_make, made, row, list(known.values()))
    return _finish_mesh(kind, made, 0, 0, 0, False)


def read_mesh(path: bytes, weld: float, fill_holes: int, drop_bodies: float, allow_open: bool) -> Shape:
    """As `mesh`, from a file."""
    data, said, made = ffi.gc(ffi.new("ms_bytes *"), lib.ms_file_free), ffi.new("ms_error *"), _new_mesh()
    call(lib.ms_file_read, data, path)
    call(lib.ms_mesh_parse, made, said, data, path)
    if said.text[0] != b"\0":
        remark(text(said.text))
    return _finish_mesh(os.fsdecode(path), made, weld, fill_holes, drop_bodies, allow_open)
