"""Shapes, and the voxels of them on which generators work."""
from __future__ import annotations

import math
from typing import Any, Dict, NamedTuple, Optional, Tuple

import numpy

from ._errors import ArgumentError, LimitError, call, choice, number, remark, whole
from ._library import ffi, lib

_DEFAULT_CELLS = 100
_MISFIT = 0.01  # of the volume: from here on it is said that voxels do not hold the shape


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
    extent = lib.MS_GRID_MAX_EXTENT
    return Grid(None if cells is None else whole("cells", cells, 1, extent),
                None if deq is None else number("deq", deq, 1, extent),
                None if voxel_size is None else number("voxel_size", voxel_size, 1e-300, 1e300),
                None if max_voxels is None else number("max_voxels", max_voxels, 1, 1e18),
                choice("rule", rule, ("half", "centre")),
                None if max_memory is None else number("max_memory", max_memory, 1, 1e18))


def max_bytes(grid: Grid) -> float:
    """The memory allowed."""
    return float(lib.ms_target_default_bytes() if grid.max_memory is None else grid.max_memory)


def voxels_within(grid: Grid, need: Any) -> int:
    """The largest grid that the memory allowed admits."""
    return int(max_bytes(grid) / lib.ms_target_bytes([1, 1, 1], 0, need))


class Shape:
    """The shape of a particle: a mesh, or a label of a volume. `mesh`, `volume`, `read`, `body`, `grains` make them."""

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

    def __reduce__(self) -> Tuple[Any, ...]:
        """For other processes: all but the voxels that were made of it."""
        structs = [None if c is None else ffi.buffer(c)[:] for c in (self._report, self._solid, self._entry)]
        labels = None if self._volume is None else self._labels()
        return _restore, (self.name, self.vertices, self.faces, labels, self._place(), *structs)

    @property
    def is_mesh(self) -> bool:
        """False for a label of a volume."""
        return self._mesh is not None

    @property
    def closed(self) -> bool:
        """The mesh bounds a body; True for a volume."""
        return self._report is None or bool(self._report.closed)

    @property
    def overlapping(self) -> bool:
        """A closed mesh passes through itself, and its body is the union."""
        return self._solid is not None and bool(self._solid.overlapping)

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
        return copy_mesh(self._mesh)[0]

    @property
    def faces(self) -> numpy.ndarray:
        """(m, 3) uint32, counter-clockwise seen from outside: a copy; empty for a volume."""
        return copy_mesh(self._mesh)[1]

    def surface(self) -> Tuple[numpy.ndarray, numpy.ndarray]:
        """Vertices (n, 3) and faces (m, 3) of the mesh; of a volume the sides of its voxels."""
        if self._mesh is not None:
            return self.vertices, self.faces
        from ._view import surface_of_voxels
        v = self._volume
        corners, faces = surface_of_voxels(self._labels() == self.label)
        return corners * v.spacing + [v.origin[k] + v.spacing * v.first[k] for k in range(3)], faces

    def _labels(self) -> numpy.ndarray:
        """Of a volume, [z, y, x], in the box around the label: a copy."""
        x, y, z = self._volume.n
        return numpy.frombuffer(ffi.buffer(self._volume.label, 4 * x * y * z), numpy.uint32).reshape(z, y, x).copy()

    def _place(self) -> Dict[str, Any]:
        """Where those are; empty for a mesh."""
        v = self._volume
        return {} if v is None else {"spacing": v.spacing, "origin": list(v.origin), "first": list(v.first)}

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
        """(3, 3): about the centroid, of unit density, off-diagonals -sum(x y); unit of the shape to the fifth."""
        return numpy.array([list(row) for row in self.c_body().inertia])

    def c_body(self, grid: Grid = Grid()) -> Any:
        """Its ms_body: of the solid, or of the voxels; it is part of them."""
        if self._solid is not None:
            return self._solid.body
        return self.c_target(grid, ffi.new("ms_target_need *")[0]).body

    def c_grid(self) -> Any:
        """The ms_grid of a volume's own voxels; it is part of them."""
        return ffi.addressof(self.c_target(Grid(), ffi.new("ms_target_need *")[0]), "grid")

    def c_target(self, grid: Grid, need: Any) -> Any:
        """The voxels with their distances, as generators take them; the last ones are kept."""
        made = self._made  # another thread may put others in its place meanwhile
        if made is None or made[0] != grid:
            made = self._made = None  # frees them before others are made
            made = self._made = (grid, self._make_target(grid, need))
        return made[1]

    def drop_voxels(self) -> None:
        """Frees those of the last grid, which are made again where they are asked for."""
        self._made = None

    def _make_target(self, grid: Grid, need: Any) -> Any:
        # They borrow the mesh, which must outlive them.
        target = ffi.gc(ffi.new("ms_target *"), lambda made, mesh=self._mesh: lib.ms_target_free(made))
        rule = lib.MS_VOXEL_HALF if grid.rule == "half" else lib.MS_VOXEL_CENTRE
        if self._mesh is not None:
            h = self._choose_size(grid)
            extents = ffi.new("double[3]")
            lib.ms_voxelize_extents(extents, self._mesh, h)
            self._check_bytes(extents, lib.ms_mesh_area(self._mesh) / h / h, grid, need)
            solid = ffi.NULL if self._solid is None else self._solid
            call(lib.ms_target_voxels_from_solid, target, self._mesh, solid, h, rule, name=self.name)
        else:
            if grid[:4] != Grid()[:4]:
                raise ArgumentError(f"{self.name} is a volume with voxels of its own; cells, deq, voxel_size and "
                                    "max_voxels do not apply")
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
            differs = f"{100 * abs(misfit):.3g} % {'more' if misfit > 0 else 'less'}"
            remark(f"{self.name}: the voxels hold {differs} than the shape: they are "
                   "too coarse for it, and measures on them are of another body; use more cells")

    def _check_bytes(self, extents: Any, squares: float, grid: Grid, need: Any) -> None:
        taken, allowed = lib.ms_target_bytes(extents, squares, need), max_bytes(grid)
        if not taken <= allowed:
            size = "x".join(f"{extent:.6g}" for extent in extents)
            raise LimitError(f"{self.name}: a grid of {size} voxels takes about {taken / 1e9:.3g} GB, more than the "
                             f"{allowed / 1e9:.3g} GB allowed; use fewer cells, max_voxels, or raise max_memory")

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


def copy_mesh(c: Any) -> Tuple[numpy.ndarray, numpy.ndarray]:
    """Vertices (n, 3) float64 and faces (m, 3) uint32 of an ms_mesh; empty for None."""
    def rows(count: str, field: str, kind: Any) -> numpy.ndarray:
        if c is None:
            return numpy.empty((0, 3), kind)
        size = getattr(c, count) * 3 * numpy.dtype(kind).itemsize
        return numpy.frombuffer(ffi.buffer(getattr(c, field), size), kind).reshape(-1, 3).copy()

    return rows("n_vertices", "vertex", numpy.float64), rows("n_triangles", "triangle", numpy.uint32)


def lend_mesh(vertices: numpy.ndarray, faces: numpy.ndarray) -> Any:
    """An ms_mesh for functions that do not change it."""
    corners, triangles = numpy.ascontiguousarray(vertices, numpy.float64), numpy.ascontiguousarray(faces, numpy.uint32)
    return _lend("ms_mesh *", (corners, triangles), {
        "n_vertices": len(corners), "vertex": ffi.cast("double (*)[3]", ffi.from_buffer(corners)),
        "n_triangles": len(triangles), "triangle": ffi.cast("uint32_t (*)[3]", ffi.from_buffer(triangles))})


def _restore(name: str, vertices: numpy.ndarray, faces: numpy.ndarray, labels: Optional[numpy.ndarray],
             place: Dict[str, Any], report: Optional[bytes], solid: Optional[bytes], entry: Optional[bytes]) -> Shape:
    """As it was, so that voxels and results are the same; its arrays are lent to the library."""
    if labels is None:
        shape = Shape(name, mesh=lend_mesh(vertices, faces))
    else:
        shape = Shape(name, entry=_struct("ms_label_entry *", entry), volume=_lend("ms_volume *", labels, {
            "n": labels.shape[::-1], "label": ffi.from_buffer("uint32_t[]", labels), **place}))
    shape._report, shape._solid = _struct("ms_mesh_report *", report), _struct("ms_solid *", solid)
    return shape


def _lend(kind: str, arrays: Any, fields: Dict[str, Any]) -> Any:
    """A struct that keeps the arrays that it points into."""
    return ffi.gc(ffi.new(kind, fields), lambda made, kept=arrays: None)


def _struct(kind: str, data: Optional[bytes]) -> Any:
    """As it was in another process."""
    if data is None:
        return None
    made = ffi.new(kind)
    ffi.buffer(made)[:] = data
    return made


class Bytes:
    """A file in memory for the library: what the array holds, and a 0 byte behind it."""

    def __init__(self, data: numpy.ndarray) -> None:
        self.data = data
        self.c = ffi.new("ms_bytes *", {"data": ffi.from_buffer("uint8_t[]", data), "size": data.size - 1})
