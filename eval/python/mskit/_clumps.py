"""Clumps: ordered spheres as arrays, and their files."""
from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Dict, List, NamedTuple, Optional, Tuple

import numpy

from ._errors import ArgumentError, Path, as_floats, call, encode, find, remark, show, text, word
from ._library import ffi, lib

if TYPE_CHECKING:
    from ._generate import Run
    from ._shapes import Shape


class Particle(NamedTuple):
    """What a clump stands for, in SI but for its centre.

    mass: kg.
    centre: (3,): of mass, in the unit and frame of the clump.
    inertia: (3, 3): about the centre, along the axes of the clump, kg m^2.
    density: kg/m^3; 0 where it is not known.
    scale: metres in a unit of length of the clump.
    """
    mass: float
    centre: numpy.ndarray
    inertia: numpy.ndarray
    density: float
    scale: float


def _particle_of(c: Any) -> Optional[Particle]:
    inertia = numpy.array([list(row) for row in c.inertia])
    return Particle(c.mass, numpy.array(list(c.centre)), inertia, c.density, c.scale) if c.mass > 0 else None


def c_particle_of(particle: Optional[Particle]) -> Any:
    """For the library; NULL where it is not known."""
    if particle is None:
        return ffi.NULL
    return ffi.new("ms_particle *", {"mass": particle.mass, "centre": particle.centre.tolist(),
                                     "inertia": particle.inertia.tolist(), "density": particle.density,
                                     "scale": particle.scale})


class Clump:
    """Spheres in the order in which they matter. It does not change: what gives it masses or scales it makes another.

    centres: (n, 3), radii: (n,), in the unit and frame of the shape. masses: (n,) kg, or None.

    >>> pair = mskit.Clump([(0, 0, 0), (1, 0, 0)], [1, 0.5])
    >>> len(pair), pair[:1].radii
    (2, array([1.]))
    """

    def __init__(self, centres: Any, radii: Any, masses: Any = None) -> None:
        places, sizes = as_floats(centres), as_floats(radii)
        if places.ndim != 2 or places.shape[1] != 3 or sizes.shape != places.shape[:1]:
            raise ArgumentError(f"centres are not rows x, y, z with as many radii, but of shapes {places.shape} and "
                                f"{sizes.shape}")
        spheres = numpy.column_stack((places, sizes))
        lost = numpy.flatnonzero(~(numpy.isfinite(spheres).all(axis=1) & (spheres[:, 3] > 0)))
        if lost.size:
            raise ArgumentError(f"sphere {lost[0]} is x, y, z, r = {spheres[lost[0]].tolist()}: no finite numbers with "
                                "a radius above 0")
        if not 1 <= len(spheres) <= lib.MS_CLUMP_MAX_SPHERES:
            raise ArgumentError(f"a clump has 1 to {lib.MS_CLUMP_MAX_SPHERES} spheres, not {len(spheres)}")
        self._fill(spheres, None if masses is None else _check_masses(masses, len(spheres)))

    def _fill(self, spheres: numpy.ndarray, masses: Optional[numpy.ndarray]) -> None:
        self.spheres, self.masses = _freeze(spheres), None if masses is None else _freeze(masses)
        self.carriers: Optional[Clump] = None  # spheres inside others that have mass and touch nothing
        self.particle: Optional[Particle] = None
        self.mass_report: Dict[str, Any] = {}  # how well the masses stand for the particle
        self.shape: Optional["Shape"] = None  # for which it was made
        self.run: Optional["Run"] = None  # by which it was made
        self.stopped_by = ""
        self._scores: Optional[Dict[str, float]] = None

    @property
    def centres(self) -> numpy.ndarray:
        """(n, 3) float64: x, y, z; not writeable."""
        return self.spheres[:, :3]

    @property
    def radii(self) -> numpy.ndarray:
        """(n,) float64; not writeable."""
        return self.spheres[:, 3]

    @property
    def scores(self) -> Dict[str, float]:
        """All measures against the shape for which it was made, on its voxels; computed when first asked for."""
        from ._generate import score
        if self._scores is None:
            self._scores = score(self, cut=self.run is not None and self.run.cut)
        return dict(self._scores)

    @property
    def ordered(self) -> bool:
        """The first k spheres are a clump, too."""
        return self.run is None or self.run.nested

    def __len__(self) -> int:
        return len(self.spheres)

    def __getitem__(self, some: slice) -> "Clump":
        """Some of the spheres, without masses: of an ordered clump [:k] is the clump of k."""
        if not isinstance(some, slice):
            raise ArgumentError(f"a clump takes a slice, as [:5], and not [{show(some)}]")
        part = Clump(self.centres[some], self.radii[some])
        part.shape, part.run = self.shape, self.run
        return part

    def __reduce__(self) -> Tuple[Any, ...]:
        """For other processes: all but the shape and the run."""
        return _restore, (self.spheres, self.masses, self.carriers, self.particle, self.mass_report, self.stopped_by)

    def __repr__(self) -> str:
        return f"<mskit.Clump of {len(self)} spheres{' with masses' if self.masses is not None else ''}>"

    def _repr_html_(self) -> str:
        from ._view import frame
        return frame(self)

    def write(self, path: Path, format: Optional[str] = None) -> None:
        """As `mskit.write`."""
        write(self, path, format)


def _restore(spheres: numpy.ndarray, masses: Optional[numpy.ndarray], carriers: Optional[Clump],
             particle: Optional[Particle], mass_report: Dict[str, Any], stopped_by: str) -> Clump:
    clump: Clump = Clump.__new__(Clump)
    clump._fill(spheres, masses)
    clump.carriers, clump.particle, clump.mass_report, clump.stopped_by = carriers, particle, mass_report, stopped_by
    return clump


def _freeze(array: numpy.ndarray) -> numpy.ndarray:
    array = numpy.ascontiguousarray(array)
    array.flags.writeable = False
    return array


def _check_masses(masses: Any, count: int) -> numpy.ndarray:
    array = as_floats(masses)
    if array.shape != (count,) or not (numpy.isfinite(array) & (array > 0)).all():
        raise ArgumentError(f"masses are not {count} finite numbers above 0")
    return array


def new_c_clump() -> Any:
    """An empty one that the library may fill; it is freed with the object."""
    return ffi.gc(ffi.new("ms_clump *"), lib.ms_clump_free)


def own(clump: Clump) -> Any:
    """A copy for functions that change it; without masses and carriers."""
    made = new_c_clump()
    for x, y, z, r in clump.spheres.tolist():
        call(lib.ms_clump_add, made, ffi.new("ms_sphere *", ((x, y, z), r)))
    return made


def lend(clump: Clump) -> Tuple[Any, List[Any]]:
    """The same for functions that do not: the library looks at the arrays, which the second value keeps."""
    spheres, masses, carriers = clump.spheres, clump.masses, clump.carriers
    if carriers is not None and masses is not None and carriers.masses is not None:
        spheres = numpy.concatenate((spheres, carriers.spheres))
        masses = numpy.concatenate((masses, carriers.masses))
    views = [ffi.from_buffer("double[]", spheres)]
    made = ffi.new("ms_clump *", {"n_spheres": len(clump), "n_carriers": len(spheres) - len(clump),
                                  "sphere": ffi.cast("ms_sphere *", views[0])})
    if masses is not None:
        views.append(ffi.from_buffer("double[]", masses))
        made.mass = ffi.cast("double *", views[1])
    return made, views + [spheres, masses]


def _array(pointer: Any, count: int) -> numpy.ndarray:
    return numpy.frombuffer(ffi.buffer(pointer, count * 8), numpy.float64).copy()


def from_c(c: Any, like: Optional[Clump] = None, particle: Any = None) -> Clump:
    """Copies what the library made. `like`: from which it was made."""
    n, m = c.n_spheres, c.n_carriers
    rows = _array(c.sphere, 4 * (n + m)).reshape(-1, 4)
    masses = None if c.mass == ffi.NULL else _array(c.mass, n + m)
    made: Clump = Clump.__new__(Clump)
    made._fill(rows[:n], None if masses is None else masses[:n])
    if m > 0:
        made.carriers = Clump.__new__(Clump)
        made.carriers._fill(rows[n:], None if masses is None else masses[n:])
    if particle is not None:
        made.particle = _particle_of(particle)
    if like is not None:
        made.shape, made.run, made.stopped_by = like.shape, like.run, like.stopped_by
    return made


def as_clump(source: Any) -> Clump:
    """What may stand for a clump: itself, the path of a file, or rows x, y, z, r."""
    if isinstance(source, Clump):
        return source
    if isinstance(source, (str, bytes, os.PathLike)):
        return read_clump(source)
    rows = as_floats(source)
    if rows.ndim != 2 or rows.shape[1] != 4:
        raise ArgumentError(f"{type(source).__name__} is no clump: give a Clump, a path or rows x, y, z, r")
    return Clump(rows[:, :3], rows[:, 3])


def read_clump(path: Path) -> Clump:
    """A clump from a file: CSV, JSON, LAMMPS' molecules, sphere files of LIGGGHTS and YADE, any text of x y z r."""
    c, particle = new_c_clump(), ffi.new("ms_particle *")
    call(lib.ms_read_clump, c, particle, encode(path))
    return from_c(c, particle=particle)


def _read_formats() -> Dict[str, str]:
    found, at = {}, 0
    while lib.ms_formats[at].name != ffi.NULL:
        found[text(lib.ms_formats[at].name)] = text(lib.ms_formats[at].summary)
        at += 1
    return found


#: What clumps are written in: name and one line; `write` also takes "html".
formats: Dict[str, str] = _read_formats()


def write(clump: Any, path: Path, format: Optional[str] = None) -> None:
    """Writes a clump, each file under a temporary name that is then renamed.

    format: a key of `formats`, or "html" for a page that shows it; None: by the ending of the path. Templates of
    engines take masses (`correct`).
    """
    clump, name = as_clump(clump), encode(path)
    if format == "html" or (format is None and name.lower().endswith(b".html")):
        from ._view import write_page
        write_page(clump, os.fsdecode(name))
        return
    row = (find(lib.ms_write_format_of_path, name) if format is None else
           find(lib.ms_write_format_find, word("format", format)))
    try_files(name, row)
    write_as(clump, name, row)


@ffi.def_extern(error=lib.MS_ERR_NOMEM)
def take_file(context: Any, path: Any, is_frame: int, err: Any) -> int:
    ffi.from_handle(context).append((bytes(ffi.string(path)), bool(is_frame)))
    return int(lib.MS_OK)


def list_files(path: bytes, format: Any) -> List[Tuple[bytes, bool]]:
    """Those of a clump: name, and is it the frame beside it?"""
    found: List[Tuple[bytes, bool]] = []
    handle = ffi.new_handle(found)
    call(lib.ms_write_list, path, format, lib.take_file, handle)
    return found


def try_file(path: bytes) -> None:
    """Can it be written? Writing is begun and broken off."""
    output = ffi.new("ms_output *")
    call(lib.ms_output_open, output, path)
    lib.ms_output_close(output, lib.MS_ERR_IO, ffi.NULL)  # removes it


def try_files(path: bytes, format: Any) -> None:
    """Those of a clump, so that not only some are written; but what stands in a folder yet to be made."""
    for file, is_frame in list_files(path, format):
        if is_frame or not lib.ms_write_format_is_folder(format):
            try_file(file)


def write_as(clump: Clump, name: bytes, row: Any) -> None:
    """In the format of this row."""
    c, kept = lend(clump)
    particle = c_particle_of(clump.particle)
    record = ffi.NULL if clump.run is None else ffi.new("char[]", clump.run.record().encode())
    content = ffi.new("ms_content *", {"clump": c, "particle": particle, "record": record})
    call(lib.ms_write_clump, content, name, row)
    said = ffi.new("char[]", lib.MS_WRITE_REMARK)
    call(lib.ms_write_remark, said, content, row)
    del kept  # not before the library is done
    if said[0] != b"\0":
        remark(f"{os.fsdecode(name)}: {text(said)}")
