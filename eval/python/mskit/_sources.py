"""What may stand for a shape."""
from __future__ import annotations

import os
from typing import Any, Dict

from ._errors import ArgumentError, FormatError, Path, as_array, encode, text
from ._library import lib
from ._meshes import mesh, read_mesh
from ._shapes import Shape
from ._volumes import open_volume, volume


def read(path: Path, **options: Any) -> Shape:
    """A shape from a file: a mesh (.stl, .obj, .ply, .off) or a volume (.npy, .mhd, .nrrd, .tif, .nii, ...).

    options: those of `mesh` or of `volume`.
    """
    name = encode(path)
    if lib.ms_volume_is_volume_path(name):
        of_volume = {"spacing": None, "origin": (0, 0, 0), "threshold": None, "connectivity": 26}
        label = options.pop("label", None)
        return open_volume(path, **_take(options, of_volume)).choose(label)
    of_mesh = {"weld": lib.MS_MESH_WELD, "fill_holes": 0, "drop_bodies": 0, "allow_open": False}
    taken = _take(options, of_mesh)
    if not lib.ms_mesh_read_is_mesh_path(name):
        raise FormatError(f"{os.fsdecode(name)}: its ending names no shape; meshes are read from .stl, .obj, .ply and "
                          f".off, volumes from {text(lib.ms_volume_endings())}")
    return read_mesh(name, **taken)


def _take(options: Dict[str, Any], defaults: Dict[str, Any]) -> Dict[str, Any]:
    for name in options:
        if name not in defaults:
            raise ArgumentError(f"'{name}' is no option of this kind of shape, which has {', '.join(defaults)}")
    return {**defaults, **options}


def as_shape(source: Any) -> Shape:
    """What may stand for a shape: itself, a path, vertices and faces, an object that has them, or a volume's array."""
    if isinstance(source, Shape):
        return source
    if isinstance(source, (str, bytes, os.PathLike)):
        return read(source)
    if hasattr(source, "vertices") and hasattr(source, "faces"):
        return mesh(source.vertices, source.faces)
    if isinstance(source, (tuple, list)) and len(source) == 2:
        return mesh(*source)
    if as_array(source).ndim == 3:
        return volume(source)
    raise ArgumentError(f"{type(source).__name__} is no shape: give a path, (vertices, faces) or an array [z, y, x]")
