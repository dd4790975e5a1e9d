"""A page that shows a clump and its shape, with the program's own viewer: eval/view says what it takes."""
from __future__ import annotations

import base64
import hashlib
import html
import json
import math
import os
from typing import TYPE_CHECKING, Any, Dict, Tuple

import numpy

from ._errors import ArgumentError, FileError, call
from ._library import ffi, lib
from ._measures import measures
from ._shapes import copy_mesh, lend_mesh

if TYPE_CHECKING:
    from ._clumps import Clump

_MOST_TRIANGLES = 100000
_FRAME_HEIGHT = 760  # pixels


def _read(name: str) -> str:
    with open(os.path.join(os.path.dirname(__file__), name), encoding="utf-8") as stream:
        return stream.read()


def _pack(values: numpy.ndarray, kind: str) -> str:
    return base64.b64encode(numpy.ascontiguousarray(values, kind).tobytes()).decode()


def surface_of_voxels(inside: numpy.ndarray) -> Tuple[numpy.ndarray, numpy.ndarray]:
    """The faces between voxels inside and outside, as triangles wound outward: vertices (n, 3) x, y, z in voxels, the
    centre of voxel [0, 0, 0] at 0; faces (m, 3)."""
    padded = numpy.pad(inside.transpose(2, 1, 0), 1)
    quads = []
    for axis in range(3):
        along, across = numpy.eye(3)[axis] / 2, [numpy.eye(3)[(axis + k) % 3] / 2 for k in (1, 2)]
        for sign in (1, -1):
            at = numpy.argwhere(padded & ~numpy.roll(padded, -sign, axis)) - 1.0
            turn = [(-1, -1), (1, -1), (1, 1), (-1, 1)][::sign]
            quads.append(numpy.stack([at + sign * along + u * across[0] + v * across[1] for u, v in turn], axis=1))
    corners, index = numpy.unique(numpy.concatenate(quads).reshape(-1, 3), axis=0, return_inverse=True)
    quad = index.reshape(-1, 4)
    return corners, numpy.concatenate((quad[:, [0, 1, 2]], quad[:, [0, 2, 3]]))


def decimate(vertices: numpy.ndarray, faces: numpy.ndarray, most: int) -> Tuple[numpy.ndarray, numpy.ndarray]:
    """At most so many triangles, as in the program's pages."""
    if len(faces) <= most:
        return vertices, faces
    few = ffi.gc(ffi.new("ms_mesh *"), lib.ms_mesh_free)
    call(lib.ms_mesh_decimate, few, lend_mesh(vertices, faces), most)
    return copy_mesh(few)


def _mesh(vertices: numpy.ndarray, faces: numpy.ndarray, centre: numpy.ndarray, scale: float) -> Dict[str, Any]:
    of = len(faces)
    vertices, faces = decimate(vertices, faces, _MOST_TRIANGLES)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    span = numpy.where(high > low, high - low, 1)
    return {"of": of, "low": ((low - centre) / scale).tolist(), "high": ((high - centre) / scale).tolist(),
            "corners": _pack(65535 * (vertices - low) / span + 0.5, "<u2"),
            "faces": _pack(faces, "<u4" if len(vertices) > 65536 else "<u2")}


def scene(clump: "Clump") -> Dict[str, Any]:
    """What eval/view/ms_view_scene.h describes, but for the distances between spheres and shape."""
    surface = clump.shape.surface() if clump.shape is not None else (numpy.empty((0, 3)), numpy.empty((0, 3), int))
    with numpy.errstate(over="ignore", invalid="ignore"):
        radii = clump.radii[:, None]
        ends = numpy.concatenate((clump.centres - radii, clump.centres + radii, surface[0]))
        centre = (ends.min(axis=0) + ends.max(axis=0)) / 2
        reach = numpy.linalg.norm(clump.centres - centre, axis=1) + clump.radii
        scale = max([reach.max(), *numpy.linalg.norm(surface[0] - centre, axis=1)])
    if not math.isfinite(scale):
        raise ArgumentError("what is to be shown reaches too far; choose another unit")
    made = {"ordered": clump.ordered, "scale": scale, "centre": centre.tolist(),
            "name": "the clump alone" if clump.shape is None else clump.shape.name,
            "spheres": _pack(numpy.column_stack(((clump.centres - centre) / scale, clump.radii / scale)), "<f4")}
    if clump.masses is not None:
        made["mass"] = _pack(clump.masses, "<f4")
    if len(surface[1]):
        made["mesh"] = _mesh(*surface, centre, scale)
    return made


def _table(scores: Dict[str, float]) -> str:
    labels = {**{name: row.label for name, row in measures.items()}, "inertia": "error of the moments, weighted mean"}
    rows = [f'<tr title="{html.escape(measures[name].help)}"><th>{html.escape(labels[name])}'
            f'<td class="number">{value:.5g}<td>{html.escape(measures[name].unit)}\n'
            for name, value in scores.items() if name in measures and math.isfinite(value)]
    return f'<h2>measures</h2>\n<table id="measures">\n{"".join(rows)}</table>\n'


def page(clump: "Clump", title: str, with_scores: bool) -> str:
    """A page that needs no other file and no network, and allows none."""
    script, style = _read("shaders.js") + _read("viewer.js"), _read("viewer.css")
    hashes = [base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in (script, style)]
    about = _table(clump.scores) if with_scores and clump.shape is not None else ""
    scenes = json.dumps([scene(clump)]).replace("<", "\\u003c")
    return (f'<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n'
            f"<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
            f"script-src 'sha256-{hashes[0]}'; style-src 'sha256-{hashes[1]}'; img-src data:; base-uri 'none'; "
            f"form-action 'none'\">\n"
            f'<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            f"<title>{html.escape(title)}</title>\n<style>{style}</style>\n<h1>{html.escape(title)}</h1>\n"
            f"<main>\n{_read('viewer.html')}\n"
            f'<div id="about">\n{about}</div>\n</main>\n<script type="application/json" id="scenes">{scenes}</script>\n'
            f"<script>{script}</script>\n</html>\n")


def frame(clump: "Clump") -> str:
    """The page within another, as Jupyter's."""
    whole = html.escape(page(clump, f"{len(clump)} spheres", with_scores=False))
    return (f'<iframe srcdoc="{whole}" style="width: 100%; height: {_FRAME_HEIGHT}px; border: 0" '
            'sandbox="allow-scripts"></iframe>')


def write_page(clump: "Clump", path: str) -> None:
    """The page as a file, under a temporary name that is then renamed."""
    text, temporary = page(clump, os.path.basename(path), with_scores=True), f"{path}.{os.getpid()}.part"
    try:
        try:
            with open(temporary, "x", encoding="utf-8") as stream:
                stream.write(text)
            os.replace(temporary, path)
        finally:
            if os.path.exists(temporary):
                os.unlink(temporary)
    except OSError as failure:
        raise FileError(f"{path}: cannot be written: {failure.strerror}") from None
