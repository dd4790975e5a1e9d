"""The table of measures, and scores by it."""
from __future__ import annotations

from typing import Any, Dict, NamedTuple

import numpy

from ._errors import text
from ._library import ffi, lib


class Measure(NamedTuple):
    """One measure of a clump, as the library's table has it."""
    name: str
    label: str
    unit: str
    source: str
    help: str


def _read_table() -> Dict[str, Any]:
    rows, at = {}, 0
    while lib.ms_measures[at].name != ffi.NULL:
        rows[text(lib.ms_measures[at].name)] = ffi.addressof(lib.ms_measures[at])
        at += 1
    return rows


_ROWS = _read_table()

#: All measures by name: the keys of scores and curves.
measures: Dict[str, Measure] = {name: Measure(name, text(row.label), text(row.unit), text(row.source), text(row.help))
                                for name, row in _ROWS.items()}


def scores_of(metrics: Any) -> Dict[str, float]:
    """All measures of an ms_metrics."""
    scores: Dict[str, float] = {"spheres": int(metrics.spheres)}
    for name, row in _ROWS.items():
        value = row.of_metrics(metrics)
        scores[name] = int(value) if row.kind == lib.MS_MEASURE_KIND_COUNT else value
    return scores


def curve_of(scores: Any, count: int) -> Dict[str, numpy.ndarray]:
    """An array of each measure of `count` ms_score that is known of one of them."""
    curve = {"spheres": numpy.arange(1, count + 1)}
    for name, row in _ROWS.items():
        if lib.ms_measure_is_of_score(row):
            curve[name] = numpy.array([row.of_score(ffi.addressof(scores, n)) for n in range(count)])
    return {name: values for name, values in curve.items() if not numpy.isnan(values).all()}
