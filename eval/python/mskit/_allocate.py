"""How many spheres each shape of a scene is worth."""
from __future__ import annotations

from typing import Any, List, NamedTuple, Optional, Sequence, Tuple

import numpy

from ._errors import ArgumentError, LimitError, as_floats, call, number, show, whole
from ._library import ffi, lib

_MOST_PARTICLES = 10**9


class Allocation(NamedTuple):
    """Numbers of spheres, and what they come to.

    spheres: (k,): of the template of each shape.
    total: spheres in the whole scene.
    mean_dice: over the particles.
    least_gain: the least that each sphere of the scene given back adds to the sum of D over the particles.
    slack: no other choice is better by more, of a budget in mean D, of mean_dice in spheres; 0: the best.
    """
    spheres: numpy.ndarray
    total: int
    mean_dice: float
    least_gain: float
    slack: float


def _listed(values: Any) -> Optional[List[Any]]:
    """None for what is no list; so is an array without dimensions, which has a length that cannot be asked for."""
    if isinstance(values, (str, bytes)) or not hasattr(values, "__len__") or getattr(values, "ndim", 1) == 0:
        return None
    return list(values)


def _read_curves(curves: Any, particles: Any) -> Tuple[Any, List[numpy.ndarray]]:
    """As the library takes them; the second value keeps what it looks at."""
    listed = _listed(curves)
    if not listed:
        raise ArgumentError(f"curves={show(curves)} is no list of curves of D")
    counts = [1] * len(listed) if particles is None else _listed(particles)
    if counts is None or len(counts) != len(listed):
        raise ArgumentError(f"particles={show(particles)} is not a number for each of {len(listed)} shapes")
    kept = [as_floats(curve) for curve in listed]
    for at, curve in enumerate(kept):
        if curve.ndim != 1 or curve.size == 0 or not (numpy.isfinite(curve) & (curve >= 0)).all():
            raise ArgumentError(f"curve {at} is no array of D of the clumps of 1, 2, ... spheres")
    shares = ffi.new("ms_share[]", [
        {"particles": whole("particles", count, 1, _MOST_PARTICLES), "most": curve.size,
         "error": ffi.from_buffer("double[]", curve)} for count, curve in zip(counts, kept)])
    return shares, kept


def _find_knees(n: Any, shares: Any, count: int, part: float) -> None:
    for s in range(count):
        n[s] = lib.ms_allocate_knee(ffi.addressof(shares, s), part)
        if n[s] == 0:
            raise LimitError(f"curve {s}: up to the last of {shares[s].most} spheres each takes away {part:.6g} of D "
                             "or more; give a longer curve, or raise the part")


def allocate(curves: Sequence[Any], particles: Optional[Sequence[int]] = None, *, budget: Optional[int] = None,
             mean_dice: Optional[float] = None, knee: Optional[float] = None) -> Allocation:
    """How many spheres each shape of a scene is worth, as `mskit scene` chooses by the same curves.

    curves: for each shape D of its clumps of 1, 2, ... spheres, as curve(clump)["dice"]. particles: how many there are
    of each; None: one.
    One of: budget, spheres in the whole scene, for the least mean D that they pay for; mean_dice, over all particles,
    for the fewest spheres in the whole scene; knee, the part of its D that a further sphere has to take away.

    >>> clumps = [mskit.generate(mskit.body(kind), "mss", spheres=8, cells=20) for kind in ("ellipsoid", "cube")]
    >>> curves = [mskit.curve(clump)["dice"] for clump in clumps]
    >>> found = mskit.allocate(curves, [1000, 10], budget=5000)
    >>> [len(clump[:n]) for clump, n in zip(clumps, found.spheres)], found.total
    ([4, 8], 4080)
    """
    given = [name for name, value in (("budget", budget), ("mean_dice", mean_dice), ("knee", knee))
             if value is not None]
    if len(given) != 1:
        raise ArgumentError("one of budget, mean_dice and knee is to be given")
    shares, kept = _read_curves(curves, particles)
    count = len(kept)
    n, done = ffi.new("size_t[]", count), ffi.new("ms_allocation *")
    if budget is not None:
        call(lib.ms_allocate_budget, n, done, shares, count, whole("budget", budget, 1, 10**15))
    elif mean_dice is not None:
        call(lib.ms_allocate_error, n, done, shares, count, number("mean_dice", mean_dice, 0, 1))
    else:
        _find_knees(n, shares, count, number("knee", knee, 1e-9, 1))
        done[0] = lib.ms_allocate_sum(shares, n, count)
    gain = lib.ms_allocate_gain(shares, n, count)
    return Allocation(numpy.array(list(n)), int(done.spheres), done.error, gain, done.slack)
