"""Shapes from voxels.

Arrays go the way of files: as the bytes of an .npy in memory, so that there is one reader, one set of checks and one
result to the last bit.
"""
from __future__ import annotations

import io
import os
from typing import Any, Iterator, List, Optional, Sequence, Union

import numpy

from ._errors import ArgumentError, FormatError, LimitError, as_array, call, encode, flag, number, show, whole
from ._library import ffi, lib
from ._shapes import Bytes, Shape

Spacing = Union[float, Sequence[float]]
Threshold = Union[None, float, str]


class Scan:
    """A volume that is open, and its labels; freed with the object."""

    def __init__(self, name: str, spacing: Optional[Spacing], origin: Sequence[float], threshold: Threshold,
                 connectivity: int) -> None:
        self.name = name
        self.options = ffi.new("ms_scan_options *", lib.ms_scan_defaults())
        self.kept: List[Any] = []  # what the scan borrows, and so its end does
        self.scan = ffi.gc(ffi.new("ms_scan *"), lambda scan, kept=self.kept: lib.ms_scan_close(scan))
        self.labels = ffi.gc(ffi.new("ms_labels *"), lib.ms_labels_free)
        self.origin = _three("origin", origin, -1e300)
        if spacing is not None:
            self.options.spacing = _three("spacing", spacing, 1e-300)[::-1]
        self.options.connectivity = whole("connectivity", connectivity, 6, 26)
        if self.options.connectivity not in (6, 18, 26):
            raise ArgumentError(f"connectivity={show(connectivity)} is none of 6, 18 and 26")
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

    def open_file(self, path: bytes) -> "Scan":
        """Maps a file."""
        self.kept.append(ffi.new("char[]", path))
        call(lib.ms_scan_open, self.scan, self.kept[0], self.options, _max_scan())
        self.find_labels()
        return self

    def open_array(self, array: Any) -> "Scan":
        """As a file in memory; its index is [z, y, x], whatever the order of its bytes."""
        array = as_array(array)
        if array.ndim != 3 or array.size == 0 or array.dtype.kind not in "biuf":
            raise ArgumentError(f"a volume is an array of numbers [z, y, x], not of shape {array.shape} and type "
                                f"{array.dtype}")
        if array.nbytes > lib.ms_target_default_bytes():
            raise LimitError(f"an array of {array.shape} takes {array.nbytes / 1e9:.3g} GB, more than is allowed; "
                             "give the path of a file, of which the boxes of grains alone are read")
        head = io.BytesIO()
        numpy.lib.format.write_array_header_1_0(head, {"descr": numpy.lib.format.dtype_to_descr(array.dtype),
                                                       "fortran_order": False, "shape": array.shape})
        length = len(head.getvalue())
        data = numpy.zeros(length + array.nbytes + 1, numpy.uint8)
        data[:length] = numpy.frombuffer(head.getvalue(), numpy.uint8)
        data[length:-1].view(array.dtype).reshape(array.shape)[...] = array
        self.kept += [Bytes(data), ffi.new("char[]", b"array.npy")]
        call(lib.ms_scan_parse, self.scan, self.kept[0].c, self.kept[1], self.options, _max_scan())
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
    values = [value] * 3 if as_array(value).ndim == 0 else list(value)
    if len(values) != 3:
        raise ArgumentError(f"{name}={show(value)} is neither one number nor three")
    return [number(name, each, low, 1e300) for each in values]


def open_volume(source: Any, spacing: Optional[Spacing], origin: Sequence[float], threshold: Threshold,
                connectivity: int) -> Scan:
    """An array, or the file of a path."""
    if isinstance(source, (str, bytes, os.PathLike)):
        path = encode(source)
        return Scan(os.fsdecode(path), spacing, origin, threshold, connectivity).open_file(path)
    return Scan("array.npy", spacing, origin, threshold, connectivity).open_array(source)


def volume(array: Any, *, spacing: Optional[Spacing] = None, origin: Sequence[float] = (0, 0, 0),
           label: Optional[int] = None, threshold: Threshold = None, connectivity: int = 26) -> Shape:
    """A shape from voxels.

    array: labels [z, y, x], 0 outside: bools, integers, or floats that are whole numbers; with a threshold, grey
    values. spacing: edge of a voxel, or three along the axes of the array (z, y, x); voxels that are no cubes are
    resampled. origin: x, y, z of the centre of voxel [0, 0, 0]. label: which; None: the only one. threshold: what is
    above it is inside, and its components are the labels; "otsu" finds one. connectivity: of components, 6, 18 or 26.

    >>> import numpy
    >>> mskit.volume(numpy.ones((4, 3, 2), bool), spacing=0.5).volume
    3.0
    """
    return open_volume(array, spacing, origin, threshold, connectivity).choose(label)


def grains(source: Any, *, spacing: Optional[Spacing] = None, origin: Sequence[float] = (0, 0, 0),
           threshold: Threshold = None, connectivity: int = 26, min_voxels: int = 1,
           border: bool = True) -> Iterator[Shape]:
    """Every grain of a labelled array [z, y, x], or of a volume's file, one after the other by label.

    As `volume`. min_voxels: smaller ones are passed over. border: False passes over those that the border may have cut.

    >>> import numpy
    >>> labels = numpy.zeros((9, 5, 5), int)
    >>> labels[1:4, 1:4, 1:4], labels[5:8, 1:4, 1:4] = 7, 9
    >>> [(grain.label, grain.voxels) for grain in mskit.grains(labels)]
    [(7, 27), (9, 27)]
    """
    opened = open_volume(source, spacing, origin, threshold, connectivity)
    least, whole_ones_alone = whole("min_voxels", min_voxels, 1, 2**53), not flag("border", border)

    def each() -> Iterator[Shape]:
        for at in range(opened.labels.count):
            entry = opened.labels.entry + at
            if entry.voxels >= least and not (whole_ones_alone and entry.cut):
                yield opened.shape(entry)

    return each()
