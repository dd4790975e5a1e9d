"""The table of generators and their options."""
from __future__ import annotations

from typing import Any, Dict, Iterator, NamedTuple, Sequence, Tuple

import numpy

from ._errors import ArgumentError, as_floats, call, encode, find, show, text, word
from ._library import ffi, lib

_TYPES = {lib.MS_OPTION_FLAG: "flag", lib.MS_OPTION_INTEGER: "integer", lib.MS_OPTION_REAL: "real",
          lib.MS_OPTION_CHOICE: "choice", lib.MS_OPTION_PLANE: "plane", lib.MS_OPTION_CLUMP: "clump"}


class Option(NamedTuple):
    """One option of a generator, as the library's table has it."""
    name: str
    type: str  # flag, integer, real, choice, plane or clump
    default: Any
    range: Tuple[float, float]  # of integer and real
    choices: Tuple[str, ...]
    unit: str
    help: str

    def __str__(self) -> str:
        if self.type == "plane":
            value = "(a, b, c, d)"
        elif self.type == "clump":
            value = "clump or path"
        else:
            value = f"{self.default!r}"
        within = {"choice": " or ".join(map(repr, self.choices)), "flag": "True or False"}.get(self.type, "")
        if self.type in ("integer", "real"):
            within = f"{self.range[0]:g} to {self.range[1]:g}" + (f" {self.unit}" if self.unit else "")
        return f"{self.name}={value}" + (f"  ({within})" if within else "") + f"\n    {self.help}"


class Generator(NamedTuple):
    """One method. `print` shows its options."""
    name: str
    summary: str
    source: str
    nested: bool  # the first k spheres are the clump of k, unless an option says otherwise
    baseline: bool
    options: Dict[str, Option]

    def __str__(self) -> str:
        head = f"{self.name}: {self.summary}\n{self.source}"
        return "\n".join([head] + [str(option) for option in self.options.values()])


def _read_option(row: Any) -> Option:
    kind = _TYPES[row.type]
    choices = tuple(text(row.choices).split("|")) if kind == "choice" else ()
    defaults: Dict[str, Any] = {"flag": bool(row.fallback), "integer": int(row.fallback), "real": float(row.fallback)}
    default = choices[int(row.fallback)] if kind == "choice" else defaults.get(kind)
    return Option(text(row.name).replace("-", "_"), kind, default, (row.min, row.max), choices, text(row.unit),
                  text(row.help))


def _each(table: Any) -> Iterator[Any]:
    at = 0
    while table[at] != ffi.NULL:
        yield table[at]
        at += 1


def _read_generator(row: Any) -> Generator:
    options, at = {}, 0
    while row.options[at].name != ffi.NULL:
        option = _read_option(row.options[at])
        options[option.name] = option
        at += 1
    return Generator(text(row.name), text(row.summary), text(row.source), bool(row.nested), bool(row.baseline), options)


#: All methods by name.
generators: Dict[str, Generator] = {text(row.name): _read_generator(row) for row in _each(lib.ms_generators)}

DEFAULT = text(lib.MS_GENERATOR_DEFAULT)


def find_generator(name: str) -> Any:
    """The library's row."""
    return find(lib.ms_generator_find, word("generator", name))


def _words(name: str, value: Any) -> str:
    """A value as --set takes it. repr has all digits of a float."""
    if isinstance(value, (bool, numpy.bool_)):
        return "on" if value else "off"
    if isinstance(value, (int, float, numpy.integer, numpy.floating)):
        return repr(value.item() if isinstance(value, numpy.generic) else value)
    if isinstance(value, str):
        return value
    raise ArgumentError(f"{name}={show(value)} is no number, word, True or False")


def _planes(name: str, value: Any) -> Sequence[str]:
    """One plane or several."""
    rows = as_floats(value)
    rows = rows.reshape(1, -1) if rows.ndim == 1 else rows
    if rows.ndim != 2 or rows.shape[1] != 4:
        raise ArgumentError(f"{name}={show(value)} is not four numbers a, b, c, d, or rows of them")
    return [",".join(map(repr, row.tolist())) for row in rows]


def _set(settings: Any, option: Option, value: Any) -> None:
    name = option.name.replace("_", "-").encode()
    if option.type == "plane":
        for words in _planes(option.name, value):
            call(lib.ms_option_settings_set, settings, name, words.encode())
    elif option.type == "clump" and hasattr(value, "centres"):
        for row in value.spheres:
            call(lib.ms_clump_add, ffi.addressof(settings, "clump"), ffi.new("ms_sphere *", (row[:3].tolist(), row[3])))
    else:
        given = encode(value) if option.type == "clump" else word(option.name, _words(option.name, value))
        call(lib.ms_option_settings_set, settings, name, given)


def make_settings(row: Any, options: Dict[str, Any]) -> Any:
    """The options of a generator as the library takes them; the library frees them with the object."""
    settings = ffi.gc(ffi.new("ms_settings *"), lib.ms_option_settings_free)
    call(lib.ms_option_settings_init, settings, row.options)
    known = generators[text(row.name)].options
    for name, value in options.items():
        if name not in known:  # the library says which there are
            call(lib.ms_option_settings_set, settings, name.replace("_", "-").encode(), ffi.NULL)
        _set(settings, known[name], value)
    return settings
