"""How a clump touches a plane and its like, and how it lies."""
from __future__ import annotations

import math
from typing import Any, Dict, List, Optional, Sequence, Union

import numpy

from ._clumps import Clump, as_clump, lend
from ._errors import ArgumentError, ShapeError, as_floats, call, flag, number, show, use_threads, whole
from ._generate import union_body
from ._library import ffi, lib
from ._shapes import Shape
from ._sources import as_shape

_AGAINST = {lib.MS_CONTACT_PLANE: "plane", lib.MS_CONTACT_PARTICLE: "particle"}
_WHERE = {lib.MS_CONTACT_RANDOM: "random", lib.MS_CONTACT_POSES: "poses"}
# The numbers of a row, by the names of `mskit contact --json`.
_COLUMNS = {"overlap": "overlap", "orientations": "samples", "missed": "missed", "contacts": "mean",
            "contacts_median": "median", "contacts_most": "most", "stiffness": "stiffness",
            "stiffness_most": "most_stiffness", "damping": "damping", "damping_most": "most_damping",
            "restitution": "restitution", "restitution_least": "least_restitution", "overdamped": "overdamped"}
_DRAGS = {"friction": "friction", "jammed": "jammed", "missed": "missed", "mean": "mean", "most": "largest",
          "slope_mean": "slope_mean", "slope_most": "slope_largest"}
_MOST_ENVELOPES = 16
_FACTORS = ("modulus", "restitution", "softest", "bounciest")

_Row = Dict[str, Any]


def _fields(c: Any, names: Dict[str, str]) -> _Row:
    return {name: getattr(c, field) for name, field in names.items()}


def _head(row: Any) -> _Row:
    return {"against": _AGAINST[row.against], "where": _WHERE[row.where]}


def _row(row: Any) -> _Row:
    parts: Dict[int, float] = {}  # the samples are in the order of their numbers
    for i in range(row.samples):
        count = int(row.sample[i].touch.count)
        parts[count] = parts.get(count, 0.0) + row.sample[i].weight
    return {**_head(row), **_fields(row, _COLUMNS), "counts": {n: part / row.whole for n, part in parts.items()}}


def _sled(c: Any) -> _Row:
    drags = [{**_fields(sled, _DRAGS), "overlap": c.sled[s].overlap}
             for s in range(c.n_sleds) for sled in c.sled[s].sled]
    return {"pose": int(c.face - c.clump.pose), "drags": drags}


def _pose(c: Any, pose: Any, other: Any) -> _Row:
    made = {"down": numpy.array(list(pose.direction)), "height": pose.height / c.r_eq,
            "barrier": pose.barrier / c.r_eq, "share": pose.share}
    if other.n_poses:
        angle = ffi.new("double *")
        nearest = lib.ms_contact_nearest(angle, ffi.addressof(other), pose.direction)
        made.update(nearest=int(nearest - other.pose), angle=math.degrees(angle[0]))
    return made


def _form(c: Any, form: Any, other: Any) -> _Row:
    return {"mean_width": form.mean_width, "poses": [_pose(c, form.pose[p], other) for p in range(form.n_poses)]}


def _factors(c: Any, row: Any, single: float) -> _Row:
    factors = lib.ms_factors_of(c, row, single)
    return {**_head(row), "overlap": row.overlap, **{name: getattr(factors, name) for name in _FACTORS}}


def _told(c: Any, factors: bool, single: float) -> Dict[str, Any]:
    rows = [ffi.addressof(c.row, r) for r in range(c.n_rows)]
    told = {"r_eq": c.r_eq, "contacts": [_row(row) for row in rows], "sled": _sled(c),
            "clump": _form(c, c.clump, c.shape)}
    if c.shape.n_poses:
        told.update(shape=_form(c, c.shape, c.clump), support_rms=c.rms)
    if factors:
        told["factors"] = [_factors(c, row, single) for row in rows if row.most]
    return told


def _parts(name: str, given: Any, most: int, low: float, high: float) -> List[float]:
    """One part of r_eq, or several."""
    parts = numpy.atleast_1d(as_floats(given))
    if not 1 <= parts.size <= most or parts.ndim != 1:
        raise ArgumentError(f"{name}={show(given)} is neither a part of r_eq nor 1 to {most} of them")
    return [number(name, part, low, high) for part in parts.tolist()]


def _refuse_volume(shape: Optional[Shape]) -> None:
    if shape is not None and not shape.is_mesh:
        raise ArgumentError(f"{shape.name} is a volume, on whose steps a ball would rest: envelope takes a mesh")


def _envelopes(c: Any, clump: Any, shape: Optional[Shape], parts: List[float]) -> List[_Row]:
    radii, volume = [part * c.r_eq for part in parts], ffi.new("double *")
    of_clump, of_shape = ffi.new("ms_envelope[]", len(parts)), ffi.new("ms_envelope[]", len(parts))
    call(lib.ms_envelope_clump, of_clump, volume, clump, radii, len(radii))
    sides = [("clump", volume[0], of_clump, c.clump.mean_width)]
    if shape is not None:
        of_body = shape.c_body().volume
        call(lib.ms_envelope_mesh, of_shape, shape._mesh, of_body, radii, len(radii), name=shape.name)
        sides.append(("shape", of_body, of_shape, c.shape.mean_width))
    ball, rows = 4 * math.pi / 3 * math.pow(c.r_eq, 3), []
    for at, part in enumerate(parts):
        row = {"radius": part}
        for name, own, of, width in sides:
            row.update({f"{name}_volume": own / ball, f"{name}_envelope": of[at].volume / ball,
                        f"{name}_error": of[at].error / ball, f"{name}_width": width / (2 * c.r_eq)})
        rows.append(row)
    return rows


def _options(poses: int, overlap: Any, restitution: float, seed: int) -> Any:
    options = ffi.new("ms_contact_options *", lib.ms_contact_defaults())
    options.orientations = whole("poses", poses, 1, 10**6)
    options.restitution = number("restitution", restitution, 1e-6, 1)
    options.seed = whole("seed", seed, 0, 2**32 - 1)
    if overlap is not None:
        parts = _parts("overlap", overlap, lib.MS_CONTACT_MAX_OVERLAPS, 1e-9, lib.MS_CONTACT_MOST_OVERLAP)
        for at, part in enumerate(parts):
            options.overlap[at] = part
        options.n_overlaps = len(parts)
    return options


def _read_shape(body: Any, support: Any, shape: Shape) -> None:
    if not shape.closed:
        raise ShapeError(f"{shape.name} is not closed and has no centre of mass; mend it (fill_holes, weld)")
    body[0] = shape.c_body()
    if shape.is_mesh:
        call(lib.ms_support_from_mesh, support, shape._mesh, body.centroid, name=shape.name)
    else:
        call(lib.ms_support_from_grid, support, shape.c_grid(), body.centroid, name=shape.name)


def _read_body(body: Any, c: Any, clump: Clump) -> None:
    """Of the particle that the clump knows, or of the union of its spheres."""
    particle = clump.particle
    if particle is not None and particle.density > 0:
        body.volume = particle.mass / particle.density / particle.scale**3
        body.centroid = particle.centre.tolist()
    else:
        body[0] = union_body(c)[0]


def contact(clump: Any, shape: Any = None, *, poses: int = 1000,
            overlap: Union[None, float, Sequence[float]] = None, restitution: float = 0.5, factors: bool = False,
            envelope: Union[None, float, Sequence[float]] = None,
            seed: int = 1, threads: Optional[int] = None) -> Dict[str, Any]:
    """How a clump touches a plane and its like, and how it lies beside its shape: as `mskit contact --json`.

    clump: a Clump, the path of a file, or rows x, y, z, r. shape: as for `generate`; None: for which it was made, else
    what the clump itself knows of its particle, else the union of its spheres. poses: orientations drawn, and pairs of
    faces. overlap: the largest of a contact / r_eq, one or several (0.0005, 0.002, 0.01). restitution: of one contact.
    factors: also one modulus and one restitution that would undo it, with their price. envelope: radius of a ball /
    r_eq, one or several: also the volume that no such ball, kept outside, can enter, of the clump and of its mesh.

    A dict: "r_eq"; "contacts" and "factors", a dict for each thing touched, place and overlap; "sled"; "clump" and
    "shape" with "poses"; "envelopes", a dict for each radius; docs/formats.md has the names. What is not known is NaN.

    >>> pair = mskit.Clump([(0, 0, 0), (2, 0, 0)], [1, 1])
    >>> lying = mskit.contact(pair, poses=20, overlap=0.001)["contacts"][1]
    >>> lying["against"], lying["where"], lying["contacts_most"]
    ('plane', 'poses', 2)
    >>> [around] = mskit.contact(pair, poses=1, envelope=0.5)["envelopes"]
    >>> around["clump_envelope"] > around["clump_volume"]  # between two balls that touch no other fits
    True
    """
    clump = as_clump(clump)
    options, with_factors = _options(poses, overlap, restitution, seed), flag("factors", factors)
    radii = None if envelope is None else _parts("envelope", envelope, _MOST_ENVELOPES, 0.01, 100)
    chosen = as_shape(shape) if shape is not None else clump.shape
    if radii:
        _refuse_volume(chosen)
    body = ffi.new("ms_body *")
    support = ffi.gc(ffi.new("ms_support *"), lib.ms_support_free)
    found = ffi.gc(ffi.new("ms_contact *"), lib.ms_contact_free)
    c, kept = lend(clump)
    with use_threads(threads):
        if chosen is not None:
            _read_shape(body, support, chosen)
        else:
            _read_body(body, c, clump)
        call(lib.ms_contact_study, found, c, body, ffi.NULL if chosen is None else support, options)
        told = _told(found, with_factors, options.restitution)
        if radii:
            told["envelopes"] = _envelopes(found, c, chosen, radii)
    del kept
    return told
