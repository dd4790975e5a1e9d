"""Shapes: meshes and volumes, from arrays and from files, and what a generator works on.

Arrays go the way of files: as the bytes of a PLY or an .npy in memory, so that there is one reader, one set of checks
and one result to the last bit.
"""
from __future__ import annotations

import io
import math
import os
from typing import Any, Dict, Iterator, NamedTuple, Optional, Sequence, Tuple, Union

import numpy

from ._errors import (ArgumentError, FormatError, LimitError, Path, ShapeError, call, encode, find, number, remark,
                      text, whole)
from ._library import ffi, lib

_DEFAULT_CELLS = 100
_MISFIT = 0.01  # of the volume: from here on it is said that voxels do not hold the shape
_SIDES = (1e-50, 1e50)  # inertia goes with the fifth power of a length, which must neither overflow nor vanish
Spacing = Union[float, Sequence[float]]


class Grid(NamedTuple):
    """The voxels that were asked for; see `generate`."""
    cells: Optional[float] = None
    deq: Optional[float] = None
    voxel_size: Optional[float] = None
    max_voxels: Optional[float] = None
    rule: str = "half"
    max_memory: Optional[float] = None


def make_grid(cells: Any, deq: Any, voxel_size: Any, max_voxels: Any, rule: Any, max_memory: Any) -> Grid:
    """Checks them."""
    if sum(value is not None for value in (cells, deq, voxel_size)) > 1:
        raise ArgumentError("cells, deq and voxel_size exclude one another")
    if rule not in ("half", "centre"):
        raise ArgumentError(f"rule={rule!r:.100} is neither 'half' nor 'centre'")
    extent = lib.MS_GRID_MAX_EXTENT
    return Grid(None if cells is None else whole("cells", cells, 1, extent),
                None if deq is None else number("deq", deq, 1, extent),
                None if voxel_size is None else number("voxel_size", voxel_size, 1e-300, 1e300),
                None if max_voxels is None else number("max_voxels", max_voxels, 1, 1e18), str(rule),
                None if max_memory is None else number("max_memory", max_memory, 1, 1e18))


def max_bytes(grid: Grid) -> float:
    """The memory allowed."""
    return float(lib.ms_target_default_bytes() if grid.max_memory is None else grid.max_memory)


def voxels_within(grid: Grid, need: Any) -> int:
    """The largest grid that the memory allowed admits."""
    return int(max_bytes(grid) / lib.ms_target_bytes([1, 1, 1], 0, need))


class Shape:
    """The shape of a particle: a mesh, or one label of a volume. `mesh`, `volume`, `read`, `body` and `grains` make them."""

    def __init__(self, name: str, mesh: Any = None, volume: Any = None, entry: Any = None) -> None:
        self.name = name
        self._mesh, self._volume = mesh, volume
        self._solid: Any = None
        self._report: Any = None
        self._entry = entry  # of the label
        self._made: Optional[Tuple[Grid, Any]] = None

    def __repr__(self) -> str:
        what = (f"{self._mesh.n_triangles} triangles" if self._mesh is not None else
                f"label {self.label}, {self.voxels} voxels")
        return f"<mskit.Shape {self.name}: {what}>"

    @property
    def is_mesh(self) -> bool:
        """False for a label of a volume."""
        return self._mesh is not None

    @property
    def closed(self) -> bool:
        """The mesh bounds a body; True for a volume."""
        return self._report is None or bool(self._report.closed)

    @property
    def report(self) -> Dict[str, int]:
        """What was found in a mesh and mended: joined, flipped, filled, ..., cavities, bodies. Empty for a volume."""
        if self._report is None:
            return {}
        names = [name for name, _ in ffi.typeof("ms_mesh_report").fields if name != "dropped_volume"]
        return {name: int(getattr(self._report, name)) for name in names}

    @property
    def vertices(self) -> numpy.ndarray:
        """(n, 3) float64, in the unit of the mesh: a copy; empty for a volume."""
        return self._copy("n_vertices", "vertex", numpy.float64)

    @property
    def faces(self) -> numpy.ndarray:
        """(m, 3) uint32, counter-clockwise seen from outside: a copy; empty for a volume."""
        return self._copy("n_triangles", "triangle", numpy.uint32)

    def _copy(self, count: str, field: str, kind: Any) -> numpy.ndarray:
        if self._mesh is None:
            return numpy.empty((0, 3), kind)
        bytes_of_rows = getattr(self._mesh, count) * 3 * numpy.dtype(kind).itemsize
        return numpy.frombuffer(ffi.buffer(getattr(self._mesh, field), bytes_of_rows), kind).reshape(-1, 3).copy()

    def surface(self) -> Tuple[numpy.ndarray, numpy.ndarray]:
        """Vertices (n, 3) and faces (m, 3) of the mesh; of a volume the sides of its voxels."""
        if self._mesh is not None:
            return self.vertices, self.faces
        from ._view import surface_of_voxels
        v = self._volume
        labels = numpy.frombuffer(ffi.buffer(v.label, 4 * v.n[0] * v.n[1] * v.n[2]), numpy.uint32)
        corners, faces = surface_of_voxels(labels.reshape(v.n[2], v.n[1], v.n[0]) == self.label)
        return corners * v.spacing + [v.origin[k] + v.spacing * v.first[k] for k in range(3)], faces

    @property
    def label(self) -> int:
        """Of a volume; 0 for a mesh."""
        return self._entry.label if self._entry is not None else 0

    @property
    def voxels(self) -> int:
        """That have the label; 0 for a mesh."""
        return self._entry.voxels if self._entry is not None else 0

    @property
    def cut(self) -> bool:
        """A voxel of the label lies on the border of the volume, which may have cut the grain."""
        return bool(self._entry.cut) if self._entry is not None else False

    @property
    def volume(self) -> float:
        """In the unit of the shape, cubed; of a closed mesh by exact integrals, else of its voxels."""
        return float(self.c_body().volume)

    @property
    def centroid(self) -> numpy.ndarray:
        """(3,): x, y, z in the unit of the shape."""
        return numpy.array(list(self.c_body().centroid))

    @property
    def inertia(self) -> numpy.ndarray:
        """(3, 3): about the centroid, of unit density, off-diagonals -sum(x y); in the unit of the shape to the fifth."""
        return numpy.array([list(row) for row in self.c_body().inertia])

    def c_body(self, grid: Grid = Grid()) -> Any:
        """Its ms_body: of the solid, or of the voxels; it is part of them."""
        if self._solid is not None:
            return self._solid.body
        return self.c_target(grid, ffi.new("ms_target_need *")[0]).body

    def c_target(self, grid: Grid, need: Any) -> Any:
        """The voxels with their distances, as generators take them; the last ones are kept."""
        if self._made is None or self._made[0] != grid:
            self._made = None  # frees them before others are made
            self._made = (grid, self._make_target(grid, need))
        return self._made[1]

    def _make_target(self, grid: Grid, need: Any) -> Any:
        # They borrow the mesh, which must outlive them.
        target = ffi.gc(ffi.new("ms_target *"), lambda made, mesh=self._mesh: lib.ms_target_free(made))
        rule = lib.MS_VOXEL_HALF if grid.rule == "half" else lib.MS_VOXEL_CENTRE
        if self._mesh is not None:
            h = self._choose_size(grid)
            extents = ffi.new("double[3]")
            lib.ms_voxelize_extents(extents, self._mesh, h)
            self._check_bytes(extents, lib.ms_mesh_area(self._mesh) / (h * h), grid, need)
            solid = ffi.NULL if self._solid is None else self._solid
            call(lib.ms_target_voxels_from_solid, target, self._mesh, solid, h, rule, name=self.name)
        else:
            box = [self._entry.hi[k] - self._entry.lo[k] + 2 * lib.MS_GRID_HULL for k in range(3)]
            self._check_bytes(box, lib.ms_target_box_squares(box), grid, need)
            call(lib.ms_target_voxels_from_volume, target, self._volume, self.label, name=self.name)
            target.rule = rule  # for the union; the voxels of the shape are given
        call(lib.ms_target_add_distance, target, name=self.name)
        self._remark_misfit(target)
        return target

    def _remark_misfit(self, target: Any) -> None:
        misfit = lib.ms_target_misfit(target)
        if abs(misfit) >= _MISFIT:
            remark(f"{self.name}: the voxels hold {100 * abs(misfit):.3g} % {'more' if misfit > 0 else 'less'} than the "
                   "shape: they are too coarse for it, and measures on them are of another body; use more cells")

    def _check_bytes(self, extents: Any, squares: float, grid: Grid, need: Any) -> None:
        taken, allowed = lib.ms_target_bytes(extents, squares, need), max_bytes(grid)
        if not taken <= allowed:
            raise LimitError(f"{self.name}: a grid of {extents[0]:.6g}x{extents[1]:.6g}x{extents[2]:.6g} voxels takes about "
                             f"{taken / 1e9:.3g} GB, more than the {allowed / 1e9:.3g} GB allowed; use fewer cells, "
                             "max_voxels, or raise max_memory")

    def _asked_size(self, grid: Grid) -> float:
        """The lattice constant but for max_voxels; 0 where that alone is given."""
        h = ffi.new("double *")
        if grid.voxel_size is not None:
            return grid.voxel_size
        if grid.deq is not None:
            if self._solid is None:
                raise ArgumentError(f"{self.name}: deq needs the volume of a closed mesh; use cells or voxel_size")
            return float(numpy.cbrt(6 * self._solid.body.volume / math.acos(-1)) / grid.deq)
        if grid.cells is not None or grid.max_voxels is None:
            call(lib.ms_voxelize_size, h, self._mesh, _DEFAULT_CELLS if grid.cells is None else grid.cells,
                 name=self.name)
        return float(h[0])

    def _choose_size(self, grid: Grid) -> float:
        """What is asked for or, if that makes too many voxels, as fine as they allow."""
        h, extents = ffi.new("double *", self._asked_size(grid)), ffi.new("double[3]")
        if grid.max_voxels is None:
            return float(h[0])
        if h[0] > 0:
            lib.ms_voxelize_extents(extents, self._mesh, h[0])
            if extents[0] * extents[1] * extents[2] <= grid.max_voxels:
                return float(h[0])
        call(lib.ms_voxelize_size_within, h, self._mesh, grid.max_voxels, name=self.name)
        return float(h[0])


class _Bytes:
    """A file in memory for the library: what the array holds, and a 0 byte behind it."""

    def __init__(self, data: numpy.ndarray) -> None:
        self.data = data
        self.c = ffi.new("ms_bytes *", {"data": ffi.from_buffer("uint8_t[]", data), "size": data.size - 1})


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
    elif not allow_open:
        raise ShapeError(f"{name}: the mesh is open: {report.open_edges} edges belong to one triangle only, "
                         f"{report.odd_edges} to an odd number; close it, fill its holes ({report.holes}, the largest of "
                         f"{report.largest_hole} edges) with fill_holes={report.largest_hole}, or use allow_open=True")
    return shape


def _new_mesh() -> Any:
    return ffi.gc(ffi.new("ms_mesh *"), lib.ms_mesh_free)


def _check_rows(name: str, rows: Any, kinds: str) -> numpy.ndarray:
    try:
        array = numpy.asarray(rows)
    except ValueError:
        array = numpy.empty(0)
    if array.ndim != 2 or array.shape[1] != 3 or len(array) == 0 or array.dtype.kind not in kinds:
        what = "numbers" if "f" in kinds else "whole numbers"
        raise ArgumentError(f"{name} are not rows of three {what}, but of shape {array.shape} and type {array.dtype}")
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
        raise ArgumentError(f"face {lost[0]} is {triangles[lost[0]].tolist()}, and vertices are 0 to {len(corners) - 1}")
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(corners)}\nproperty double x\nproperty double y\n"
            f"property double z\nelement face {len(triangles)}\nproperty list uchar uint vertex_indices\nend_header\n")
    rows = numpy.empty(len(triangles), [("n", "u1"), ("corner", "<u4", 3)])
    rows["n"], rows["corner"] = 3, triangles
    parts = [numpy.frombuffer(part, numpy.uint8) for part in
             (head.encode(), corners.astype("<f8").tobytes(), rows.tobytes(), b"\0")]
    data = _Bytes(numpy.concatenate(parts))
    made = _new_mesh()
    call(lib.ms_mesh_parse, made, ffi.NULL, data.c, b"vertices and faces.ply")
    return _finish_mesh("the mesh", made, weld, fill_holes, drop_bodies, allow_open)


def body(kind: str, **parameters: float) -> Shape:
    """A body to test with, by the names and parameters of `mskit shape --list`: ball, ellipsoid, torus, grain, ...

    >>> ball = mskit.body("ball", r=2, fineness=40)
    >>> abs(ball.volume / (4 / 3 * 3.14159265 * 8) - 1) < 0.002
    True
    """
    row = find(lib.ms_shape_find, str(kind).encode(errors="replace"))
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


class _Scan:
    """A volume that is open, and its labels; freed with the object."""

    def __init__(self, name: str, spacing: Optional[Spacing], origin: Sequence[float], threshold: Union[None, float, str],
                 connectivity: int) -> None:
        self.name = name
        self.options = ffi.new("ms_scan_options *", lib.ms_scan_defaults())
        self.scan = ffi.gc(ffi.new("ms_scan *"), lib.ms_scan_close)
        self.labels = ffi.gc(ffi.new("ms_labels *"), lib.ms_labels_free)
        self.data: Optional[_Bytes] = None
        self.origin = _three("origin", origin, -1e300)
        if spacing is not None:
            self.options.spacing = _three("spacing", spacing, 1e-300)[::-1]
        if connectivity not in (6, 18, 26):
            raise ArgumentError(f"connectivity={connectivity!r:.100} is none of 6, 18 and 26")
        self.options.connectivity = connectivity
        if isinstance(threshold, str) and threshold == "otsu":
            self.options.values = lib.MS_SCAN_OTSU
        elif threshold is not None:
            self.options.values = lib.MS_SCAN_THRESHOLD
            self.options.threshold = number("threshold", threshold, -1e300, 1e300)

    def find_labels(self) -> None:
        """Once it is open."""
        for k in range(3):
            self.scan.origin[k] += self.origin[k]
        call(lib.ms_labels_find_in_scan, self.labels, self.scan)

    def open_file(self, path: bytes) -> "_Scan":
        """Maps a file."""
        self.path = ffi.new("char[]", path)
        call(lib.ms_scan_open, self.scan, self.path, self.options, _max_scan())
        self.find_labels()
        return self

    def open_array(self, array: Any) -> "_Scan":
        """As a file in memory; its index is [z, y, x], whatever the order of its bytes."""
        array = numpy.asarray(array)
        if array.ndim != 3 or array.size == 0 or array.dtype.kind not in "biuf":
            raise ArgumentError(f"a volume is an array of numbers [z, y, x], not of shape {array.shape} and type "
                                f"{array.dtype}")
        head = io.BytesIO()
        numpy.lib.format.write_array_header_1_0(head, {"descr": numpy.lib.format.dtype_to_descr(array.dtype),
                                                       "fortran_order": False, "shape": array.shape})
        length = len(head.getvalue())
        data = numpy.zeros(length + array.nbytes + 1, numpy.uint8)
        data[:length] = numpy.frombuffer(head.getvalue(), numpy.uint8)
        data[length:-1].view(array.dtype).reshape(array.shape)[...] = array
        self.data = _Bytes(data)
        self.path = ffi.new("char[]", b"array.npy")
        call(lib.ms_scan_parse, self.scan, self.data.c, self.path, self.options, _max_scan())
        self.find_labels()
        return self

    def shape(self, entry: Any) -> Shape:
        """One label by itself."""
        crop = ffi.gc(ffi.new("ms_volume *"), lib.ms_volume_free)
        call(lib.ms_labels_crop_scan, crop, self.scan, entry, name=self.name)
        return Shape(self.name, volume=crop, entry=ffi.new("ms_label_entry *", entry[0]))

    def choose(self, label: Optional[int]) -> Shape:
        """The label that is asked for, or the only one."""
        if label is None and self.labels.count > 1:
            raise FormatError(f"{self.name}: the volume has several labels ({self.labels.entry[1].label} among them); "
                              "choose one with label=, or go through all with mskit.grains")
        wanted = self.labels.entry[0].label if label is None else whole("label", label, 1, 2**32 - 1)
        entry = lib.ms_labels_entry(self.labels, wanted)
        if entry == ffi.NULL:
            raise ArgumentError(f"{self.name}: the volume has no voxel of label {wanted}")
        return self.shape(entry)


def _max_scan() -> int:
    return int(lib.ms_target_default_bytes() / 4)


def _three(name: str, value: Any, low: float) -> Sequence[float]:
    """One number for all three axes, or three."""
    values = [value] * 3 if numpy.ndim(value) == 0 else list(value)
    if len(values) != 3:
        raise ArgumentError(f"{name}={value!r:.100} is neither one number nor three")
    return [number(name, each, low, 1e300) for each in values]


def _open(source: Any, spacing: Optional[Spacing], origin: Sequence[float], threshold: Union[None, float, str],
          connectivity: int) -> _Scan:
    if isinstance(source, (str, bytes, os.PathLike)):
        path = encode(source)
        return _Scan(os.fsdecode(path), spacing, origin, threshold, connectivity).open_file(path)
    return _Scan("array.npy", spacing, origin, threshold, connectivity).open_array(source)


def volume(array: Any, *, spacing: Optional[Spacing] = None, origin: Sequence[float] = (0, 0, 0),
           label: Optional[int] = None, threshold: Union[None, float, str] = None, connectivity: int = 26) -> Shape:
    """A shape from voxels.

    array: labels [z, y, x], 0 outside: bools, integers, or floats that are whole numbers; with a threshold, grey values.
    spacing: edge of a voxel, or three along the axes of the array (z, y, x); voxels that are no cubes are resampled.
    origin: x, y, z of the centre of voxel [0, 0, 0]. label: which; None: the only one. threshold: what is above it is
    inside, and its components are the labels; "otsu" finds one. connectivity: of components, 6, 18 or 26.

    >>> import numpy
    >>> mskit.volume(numpy.ones((4, 3, 2), bool), spacing=0.5).volume
    3.0
    """
    return _open(array, spacing, origin, threshold, connectivity).choose(label)


def grains(source: Any, *, spacing: Optional[Spacing] = None, origin: Sequence[float] = (0, 0, 0),
           threshold: Union[None, float, str] = None, connectivity: int = 26, min_voxels: int = 1,
           border: bool = True) -> Iterator[Shape]:
    """Every grain of a labelled array [z, y, x], or of a volume's file, one after the other by label.

    As `volume`. min_voxels: smaller ones are passed over. border: False passes over those that the border may have cut.

    >>> import numpy
    >>> labels = numpy.zeros((9, 5, 5), int)
    >>> labels[1:4, 1:4, 1:4], labels[5:8, 1:4, 1:4] = 7, 9
    >>> [(grain.label, grain.voxels) for grain in mskit.grains(labels)]
    [(7, 27), (9, 27)]
    """
    opened = _open(source, spacing, origin, threshold, connectivity)
    least = whole("min_voxels", min_voxels, 1, 2**53)

    def each() -> Iterator[Shape]:
        for at in range(opened.labels.count):
            entry = opened.labels.entry + at
            if entry.voxels >= least and (border or not entry.cut):
                yield opened.shape(entry)

    return each()


def read(path: Path, **options: Any) -> Shape:
    """A shape from a file: a mesh (.stl, .obj, .ply, .off) or a volume (.npy, .mhd, .nrrd, .tif, .nii, ...).

    options: those of `mesh` or of `volume`.
    """
    name = encode(path)
    if lib.ms_volume_is_volume_path(name):
        of_volume = {"spacing": None, "origin": (0, 0, 0), "threshold": None, "connectivity": 26}
        label = options.pop("label", None)
        return _open(path, **_take(options, of_volume)).choose(label)
    of_mesh = {"weld": lib.MS_MESH_WELD, "fill_holes": 0, "drop_bodies": 0, "allow_open": False}
    taken = _take(options, of_mesh)
    if not lib.ms_mesh_read_is_mesh_path(name):
        raise FormatError(f"{os.fsdecode(name)}: its ending names no shape; meshes are read from .stl, .obj, .ply and .off, "
                          f"volumes from {text(lib.ms_volume_endings())}")
    data = ffi.gc(ffi.new("ms_bytes *"), lib.ms_file_free)
    said = ffi.new("ms_error *")
    call(lib.ms_file_read, data, name)
    made = _new_mesh()
    call(lib.ms_mesh_parse, made, said, data, name)
    if said.text[0] != b"\0":
        remark(text(said.text))
    return _finish_mesh(os.fsdecode(name), made, **taken)


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
    if numpy.ndim(source) == 3:
        return volume(source)
    raise ArgumentError(f"{type(source).__name__} is no shape: give a path, (vertices, faces) or an array [z, y, x]")
