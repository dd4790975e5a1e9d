"""Failures of the library as exceptions, with its own sentence; and what all modules check and convert."""
from __future__ import annotations

import math
import os
import sys
import warnings
from contextlib import contextmanager
from typing import Any, Iterable, Iterator, NoReturn, Optional, Union

import numpy

from ._library import ffi, lib

TINY = sys.float_info.min  #: The least normal double.
Path = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]


class Error(Exception):
    """What all failures of mskit are; its text is one sentence that says what to do."""


class ArgumentError(Error, ValueError):
    """An argument is not what it has to be."""


class OutOfMemoryError(Error, MemoryError):
    """There is no memory for what was asked."""


class FileError(Error, OSError):
    """A file cannot be read or written."""


class FormatError(Error, ValueError):
    """A file, or an array, does not hold what it should."""


class ShapeError(Error, ValueError):
    """The shape cannot be used, as an open mesh."""


class LimitError(Error, ValueError):
    """A limit would be exceeded, as that of memory."""


class Remark(UserWarning):
    """What about the input, though allowed, makes the result worse than it could be."""


_CLASSES = {lib.MS_ERR_ARG: ArgumentError, lib.MS_ERR_NOMEM: OutOfMemoryError, lib.MS_ERR_IO: FileError,
            lib.MS_ERR_FORMAT: FormatError, lib.MS_ERR_SHAPE: ShapeError, lib.MS_ERR_LIMIT: LimitError}


def fail(status: int, err: Any, name: str = "") -> NoReturn:
    """Raises what the library has said. `name`: of the shape, put in front of a sentence that does not know it."""
    text = ffi.string(err.text).decode(errors="replace")
    raise _CLASSES.get(status, Error)(f"{name}: {text}" if name else text)


def call(function: Any, *arguments: Any, name: str = "") -> None:
    """Calls a function of the library that gives a status and takes a message last."""
    err = ffi.new("ms_error *")
    status = function(*arguments, err)
    if status != lib.MS_OK:
        fail(status, err, name)


def find(function: Any, *arguments: Any) -> Any:
    """Calls a function that gives a row of a table, or NULL and a message."""
    err = ffi.new("ms_error *")
    row = function(*arguments, err)
    if row == ffi.NULL:
        fail(lib.MS_ERR_ARG, err)
    return row


def remark(sentence: str) -> None:
    """Warns, at the line that called mskit."""
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and frame.f_globals.get("__name__", "").split(".")[0] == __package__:
        frame, level = frame.f_back, level + 1
    warnings.warn(sentence, Remark, stacklevel=level)


def encode(path: Path) -> bytes:
    """A path as the library takes it."""
    try:
        name = os.fsencode(path)
    except (TypeError, UnicodeEncodeError):
        raise ArgumentError(f"{show(path)} is no path") from None
    if not name or b"\0" in name:
        raise ArgumentError(f"{show(path)} names no file")
    return name


def text(pointer: Any) -> str:
    """A text of a table; empty for none."""
    return "" if pointer == ffi.NULL else str(ffi.string(pointer).decode())


def show(value: Any) -> str:
    """A value within a sentence: its repr, on one line and not long."""
    return f"{' '.join(repr(value).split()):.100}"


def word(name: str, value: Any) -> bytes:
    """A name as the library takes it."""
    if not isinstance(value, str) or "\0" in value:
        raise ArgumentError(f"{name}={show(value)} is no name")
    return value.encode(errors="replace")


def choice(name: str, value: Any, words: Iterable[str]) -> str:
    """One of some words."""
    if not isinstance(value, str) or value not in words:
        raise ArgumentError(f"{name}={show(value)} is none of {', '.join(map(repr, words))}")
    return value


def flag(name: str, value: Any) -> bool:
    """True or False."""
    if not isinstance(value, (bool, numpy.bool_)):
        raise ArgumentError(f"{name}={show(value)} is neither True nor False")
    return bool(value)


def as_array(values: Any) -> numpy.ndarray:
    """Itself or as an array; empty, (0,), for what makes none, as rows of unequal lengths."""
    try:
        return numpy.asarray(values)
    except (TypeError, ValueError, OverflowError):
        return numpy.empty(0)


def as_floats(values: Any) -> numpy.ndarray:
    """A copy as float64; empty, (0,), for what are no real numbers."""
    array = as_array(values)
    return array.astype(numpy.float64) if array.dtype.kind in "biuf" else numpy.empty(0)


def _within(value: Any, low: float, high: float) -> float:
    """As a float; NaN for what is none within bounds."""
    try:
        wide = math.nan if isinstance(value, (str, bytes)) else float(value)
    except (TypeError, ValueError, OverflowError):
        return math.nan
    return wide if low <= wide <= high else math.nan


def number(name: str, value: Any, low: float, high: float) -> float:
    """A finite number within bounds."""
    wide = _within(value, low, high)
    if math.isnan(wide):
        raise ArgumentError(f"{name}={show(value)} is not a number from {low:g} to {high:g}")
    return wide


def whole(name: str, value: Any, low: int, high: int) -> int:
    """A whole number within bounds."""
    if not _within(value, low, high).is_integer():
        raise ArgumentError(f"{name}={show(value)} is not a whole number from {low} to {high}")
    return int(value)


@contextmanager
def use_threads(count: Optional[int]) -> Iterator[None]:
    """So many threads of OpenMP for what this thread runs; None: as it is."""
    before = lib.omp_get_max_threads()
    if count is not None:
        lib.omp_set_num_threads(whole("threads", count, 1, 1024))
    try:
        yield
    finally:
        lib.omp_set_num_threads(before)
