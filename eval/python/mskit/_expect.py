"""What is to be expected of a shape before any clump is made."""
from __future__ import annotations

from typing import Any, Callable, Optional, Sequence, Tuple, Union

import numpy

from ._errors import ArgumentError, ShapeError, as_array, call, flag, number, show, use_threads
from ._library import ffi, lib
from ._shapes import Shape
from ._sources import as_shape

Numbers = Union[float, Sequence[float], numpy.ndarray]


class Expectation:
    """The least mismatch D to be expected of the clumps of a shape: an estimate, not a bound (docs/expected.md).

    range: the least D known of measured shapes was 1/range to range times it from 10 spheres on, and 1/range_many to
    range_many from 100 on.
    """
    range: float = lib.MS_EXPECT_RANGE
    range_many: float = lib.MS_EXPECT_RANGE_MANY

    def __init__(self, c: Any) -> None:
        self._c = c  # ms_expect

    def dice(self, spheres: Numbers, *, inscribed: bool = False) -> Any:
        """D by number of spheres, 1 or more: a float, or an array like that of the numbers."""
        return _each("spheres", spheres, 1, lambda n: float(lib.ms_expect_dice(self._c, _kind(inscribed), n)))

    def spheres(self, dice: Numbers, *, inscribed: bool = False) -> Any:
        """Numbers of spheres by D above 0, rounded up to three digits; inf above 10^9."""
        return _each("dice", dice, 1e-300, lambda wanted: float(
            lib.ms_expect_round(lib.ms_expect_spheres(self._c, _kind(inscribed), wanted))))

    def least_spheres(self, *, inscribed: bool = False) -> float:
        """The least number with which no more than a tenth of the body is better left without any."""
        return float(lib.ms_expect_round(lib.ms_expect_least_spheres(self._c, _kind(inscribed))))

    def __reduce__(self) -> Tuple[Any, ...]:
        return _restore, (ffi.buffer(self._c)[:],)

    def __repr__(self) -> str:
        return f"<mskit.Expectation: D of 10 and 100 spheres {self.dice(10):.2g}, {self.dice(100):.2g}>"


def _restore(data: bytes) -> Expectation:
    c = ffi.new("ms_expect *")
    ffi.buffer(c)[:] = data
    return Expectation(c)


def _kind(inscribed: bool) -> int:
    return int(lib.MS_EXPECT_INSCRIBED if flag("inscribed", inscribed) else lib.MS_EXPECT_FREE)


def _each(name: str, values: Numbers, low: float, function: Callable[[float], float]) -> Any:
    array = as_array(values)
    if array.dtype.kind not in "iuf" or array.size == 0:
        raise ArgumentError(f"{name}={show(values)} is neither a number nor an array of numbers")
    if array.ndim == 0:
        return function(number(name, values, low, 1e300))
    return numpy.array([function(number(name, value, low, 1e300)) for value in array.ravel()]).reshape(array.shape)


def _refuse_open(shape: Shape) -> None:
    if shape.is_mesh and (not shape.closed or shape.overlapping):
        what = "passes through itself" if shape.closed else "is open"
        raise ShapeError(f"{shape.name}: of a mesh that {what} nothing can be expected")


def find_expectation(shape: Shape, grid: Any = None) -> Any:
    """The ms_expect of a shape. grid: the voxels of a volume, where they are at hand."""
    made = ffi.new("ms_expect *")
    _refuse_open(shape)
    if shape.is_mesh:
        call(lib.ms_expect_mesh, made, shape._mesh, name=shape.name)
    else:
        call(lib.ms_expect_grid, made, shape.c_grid() if grid is None else grid, name=shape.name)
    return made


def expect(shape: Any, *, threads: Optional[int] = None) -> Expectation:
    """The least mismatch D to be expected by number of spheres, as `mskit info --expect`.

    shape: as for `generate`; a closed mesh that does not pass through itself, or a volume.

    >>> expected = mskit.expect(mskit.body("torus", R=3, r=1))
    >>> expected.dice([10, 20, 40]).round(3)  # 11.72 / n^2 by the law of tubes
    array([0.113, 0.028, 0.007])
    >>> expected.spheres(0.05)
    16.0
    """
    shape = as_shape(shape)
    with use_threads(threads):
        return Expectation(find_expectation(shape))
