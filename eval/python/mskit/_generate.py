"""Runs: generators, scores, curves and masses."""
from __future__ import annotations

import json
import math
from contextlib import contextmanager
from types import TracebackType
from typing import Any, Callable, Dict, Iterator, NamedTuple, Optional, Tuple, Type, Union

import numpy

from ._clumps import Clump, as_clump, from_c, lend, new_c_clump, own
from ._errors import TINY, ArgumentError, call, choice, flag, number, remark, show, text, use_threads, whole, word
from ._library import ffi, lib
from ._measures import curve_of, scores_of
from ._methods import DEFAULT, find_generator, generators, make_settings
from ._shapes import Grid, Shape, make_grid, voxels_within
from ._sources import as_shape

_DEFAULT_SPHERES = 50
_UNITS = {"m": 1.0, "mm": 1e-3, "um": 1e-6}


class Progress(NamedTuple):
    """How far a run has come.

    stage: what the run is at.
    share: of it all that is done, from 0 to 1; NaN where that is not known.
    spheres: so many so far, of methods that choose one after the other.
    dice: mismatch D of those; NaN where it is not known.
    """
    stage: str
    share: float
    spheres: int
    dice: float


Listener = Union[None, bool, Callable[[Progress], Any]]


class _Watch:
    """Who is told of a run. What is raised meanwhile, KeyboardInterrupt too, ends the run and is raised after it."""

    def __init__(self, listener: Callable[[Progress], Any]) -> None:
        self.listener, self.stage = listener, ""
        self.failure: Optional[BaseException] = None
        self.kept: Any = None

    def tell(self, stage: Optional[str], share: float, spheres: int, dice: float) -> int:
        if self.failure is None:
            self.stage = self.stage if stage is None else stage
            self.listener(Progress(self.stage, share, spheres, dice))
        return self.failure is not None


def _keep_failure(kind: Type[BaseException], failure: BaseException, trace: TracebackType) -> None:
    ffi.from_handle(trace.tb_frame.f_locals["context"]).failure = failure


@ffi.def_extern(error=1, onerror=_keep_failure)
def tell_progress(context: Any, spheres: int, dice: float) -> int:
    return ffi.from_handle(context).tell(None, math.nan, spheres, dice)


@ffi.def_extern(error=1, onerror=_keep_failure)
def tell_stage(context: Any, stage: Any, share: float) -> int:
    return ffi.from_handle(context).tell(text(stage), share, 0, math.nan)


@ffi.def_extern(onerror=_keep_failure)
def tell_remark(context: Any, sentence: Any) -> None:
    remark(text(sentence))


class _Bar:
    """A bar by tqdm."""

    def __init__(self, name: str) -> None:
        try:
            from tqdm.auto import tqdm
        except ImportError:
            raise ArgumentError("progress=True takes tqdm, which is not installed; or give a function") from None
        self.bar = tqdm(total=1.0, desc=name, bar_format="{l_bar}{bar}| {elapsed}")

    def __call__(self, now: Progress) -> None:
        if now.stage:
            self.bar.set_description_str(now.stage, refresh=False)
        if not math.isnan(now.share):
            self.bar.n = now.share
        if now.spheres:
            self.bar.set_postfix_str(f"{now.spheres} spheres", refresh=False)
        self.bar.update(0)


@contextmanager
def watched(name: str, progress: Listener) -> Iterator[_Watch]:
    """What was raised while the run was told of is raised when it is over, in place of what the run says."""
    bar = _Bar(name) if progress is True else None
    listener = bar or (progress if callable(progress) else None)
    if listener is None and progress is not None and progress is not False:
        raise ArgumentError(f"progress={show(progress)} is neither a function nor True")
    watch = _Watch(listener or (lambda now: None))
    try:
        yield watch
    except Exception:
        if watch.failure is None:
            raise
    finally:
        if bar is not None:
            bar.bar.close()
    if watch.failure is not None:
        raise watch.failure


class Run:
    """How a clump was made, so that it can be repeated."""

    def __init__(self, generator: str, stop: Any, seed: int, grid: Grid, options: Dict[str, Any], *,
                 cut: bool = False) -> None:
        self.row = find_generator(generator)
        self.settings = make_settings(self.row, options)
        self.stop, self.seed, self.grid, self.options = stop, whole("seed", seed, 0, 2**53), grid, options
        self.cut = cut or stop.coverage_cut > 0
        self.need = lib.ms_generator_need(self.row, self.settings, self.cut)
        self.nested = bool(lib.ms_generator_is_nested(self.row, self.settings))

    def record(self) -> str:
        """As JSON, for files."""
        options = {name: value if isinstance(value, (bool, int, float, str)) else repr(value)
                   for name, value in self.options.items()}
        grid = {name: value for name, value in self.grid._asdict().items() if value is not None}
        return json.dumps({"generator": text(self.row.name), "options": options, "seed": self.seed, "grid": grid})

    def c_run(self, target: Any, watch: _Watch) -> Any:
        """For the library; what it points to is kept by the watch."""
        handle = ffi.new_handle(watch)
        run = ffi.new("ms_run *", {
            "target": target, "stop": self.stop[0], "settings": self.settings, "seed": self.seed,
            "progress": lib.tell_progress, "progress_context": handle, "stage": lib.tell_stage, "stage_context": handle,
            "remark": lib.tell_remark, "remark_context": handle})
        watch.kept = (handle, target)
        return run


def _make_stop(spheres: Optional[int], until: Optional[Dict[str, float]], min_radius: Optional[float]) -> Any:
    stop = ffi.new("ms_stop *")
    if spheres is not None:
        stop.spheres = whole("spheres", spheres, 1, lib.MS_CLUMP_MAX_SPHERES)
    if min_radius is not None:
        stop.radius = number("min_radius", min_radius, 1e-300, 1e300)
    if until is not None and not hasattr(until, "items"):
        raise ArgumentError(f"until={show(until)} is no dict of measures, as {{'dice': 0.05}}")
    for measure, value in (until or {}).items():
        asked = number(f"until {measure}", value, 0, 1e300)
        call(lib.ms_stop_set, stop, word("until", measure), asked)
    if lib.ms_stop_is_none(stop):
        stop.spheres = _DEFAULT_SPHERES
    return stop


def generate(shape: Any, generator: str = DEFAULT, *, spheres: Optional[int] = None,
             until: Optional[Dict[str, float]] = None, min_radius: Optional[float] = None, cells: Optional[int] = None,
             deq: Optional[float] = None, voxel_size: Optional[float] = None, max_voxels: Optional[float] = None,
             rule: str = "half", max_memory: Optional[float] = None, seed: int = 1, threads: Optional[int] = None,
             progress: Listener = None, **options: Any) -> Clump:
    """Makes a clump for a shape: the same, to the last bit, as `mskit generate`.

    shape: a Shape, the path of a mesh or a volume, (vertices, faces), an object that has both, or a labelled array
    [z, y, x], whose voxels are of size 1 (`volume` takes others).
    spheres: at most so many; 50 where nothing else is asked for. until: measures to be reached, as {"dice": 0.03}; the
    names are those of `measures`. min_radius: no smaller sphere, in the unit of the shape.
    cells: voxels along the shortest side of a mesh's box (100), or deq: along the diameter of the ball of equal
    volume, or voxel_size: in the unit of the shape. max_voxels: of the whole grid. rule: a voxel is inside if more
    than "half" of it is, or its "centre". max_memory: larger grids are refused, in bytes (3/4 of the machine's).
    threads: of OpenMP; None: all cores. progress: a function of a `Progress`, or True for a bar by tqdm; what it raises
    ends the run, and so does Ctrl-C.

    Options of the methods, by keyword:
    """
    shape = as_shape(shape)
    grid = make_grid(cells, deq, voxel_size, max_voxels, rule, max_memory)
    run = Run(generator, _make_stop(spheres, until, min_radius), seed, grid, options)
    made, reason = new_c_clump(), ffi.new("ms_stop_reason *")
    with use_threads(threads), watched(shape.name, progress) as watch:
        target = shape.c_target(grid, run.need)
        call(lib.ms_generator_run, made, reason, run.row, run.c_run(target, watch), name=shape.name)
    if reason[0] == lib.MS_STOP_INTERRUPTED:
        raise KeyboardInterrupt
    clump = from_c(made)
    clump.shape, clump.run, clump.stopped_by = shape, run, text(lib.ms_stop_name(reason[0]))
    return clump


generate.__doc__ = (generate.__doc__ or "") + "\n\n".join(
    "    " + str(generator).replace("\n", "\n      ") for generator in generators.values()) + "\n"


def _shape_for(clump: Clump, shape: Any) -> Shape:
    """The one that is given, or for which the clump was made."""
    if shape is not None:
        return as_shape(shape)
    if clump.shape is None:
        raise ArgumentError("the clump was made for no shape that is known; give the shape")
    return clump.shape


def _target_for(clump: Clump, shape: Any, grid: Grid) -> Tuple[Any, int]:
    """The voxels to judge on, of the run unless others are asked for; and how many a union may take."""
    need = ffi.new("ms_target_need *")[0]
    if grid == Grid() and clump.run is not None:
        grid, need = clump.run.grid, clump.run.need
    return _shape_for(clump, shape).c_target(grid, need), voxels_within(grid, need)


def score(clump: Any, shape: Any = None, *, cells: Optional[int] = None, deq: Optional[float] = None,
          voxel_size: Optional[float] = None, max_voxels: Optional[float] = None, rule: str = "half",
          max_memory: Optional[float] = None, cut: bool = False, threads: Optional[int] = None) -> Dict[str, float]:
    """All measures of a clump against a shape; NaN where one does not apply. Keys: those of `measures`, and spheres.

    clump: a Clump, the path of a file, or rows x, y, z, r. shape: as for `generate`; None: for which it was made.
    cut: coverage_cut is counted, too, which takes as long as all else. The rest as for `generate`; nothing of it: the
    voxels on which the clump was made.

    >>> ball = mskit.body("ball", r=2)
    >>> mskit.score([(0, 0, 0, 2)], ball, cells=50)["dice"] < 0.005
    True
    """
    clump = as_clump(clump)
    grid = make_grid(cells, deq, voxel_size, max_voxels, rule, max_memory)
    metrics = ffi.new("ms_metrics *")
    with use_threads(threads):
        target, most = _target_for(clump, shape, grid)
        c, kept = lend(clump)
        judged = ffi.new("ms_target *", target[0])  # others may work on the same voxels now
        judged.count_cut = flag("cut", cut)
        call(lib.ms_metrics_compute, metrics, ffi.NULL, judged, c, most)
        del kept
    return scores_of(metrics)


def curve(clump: Any, shape: Any = None, *, cells: Optional[int] = None, deq: Optional[float] = None,
          voxel_size: Optional[float] = None, max_voxels: Optional[float] = None, rule: str = "half",
          max_memory: Optional[float] = None, threads: Optional[int] = None,
          progress: Listener = None) -> Dict[str, numpy.ndarray]:
    """Scores of the clumps of 1, 2, ... spheres: (n,) arrays by measure, and "spheres".

    Of a clump whose first k spheres are a clump, these are its own. Of others as by variational each is a run of its
    own, by the same options, from the most spheres down; then shape and grid are those of the run. As for `score`.
    """
    clump = as_clump(clump)
    grid = make_grid(cells, deq, voxel_size, max_voxels, rule, max_memory)
    scores = ffi.new("ms_score[]", len(clump))
    if not clump.ordered and (shape is not None or grid != Grid()):
        raise ArgumentError("each clump of this curve is a run of its own, on shape and grid of the first: give none")
    with use_threads(threads), watched("curve", progress) as watch:
        target, most = _target_for(clump, shape, grid)
        c, kept = lend(clump)
        if clump.ordered:
            call(lib.ms_metrics_score_clump, ffi.new("ms_score *"), scores, target, c, most)
        else:
            run = clump.run
            call(lib.ms_curve_compute, scores, c, run.row, run.c_run(target, watch), most)
        del kept
    return curve_of(scores, len(clump))


def _body_for(clump: Clump, shape: Any) -> Tuple[Shape, Any]:
    """The shape, and its volume, centre and inertia: the integrals over a closed mesh need no voxels."""
    chosen = _shape_for(clump, shape)
    return chosen, chosen.c_body(clump.run.grid if shape is None and clump.run is not None else Grid())


def correct(clump: Any, shape: Any = None, *, density: float, unit: str = "m", scale: Optional[float] = None,
            properties: str = "shape", axes: str = "principal", least_mass: Optional[float] = None,
            most_mass: Optional[float] = None, centre_tolerance: Optional[float] = None, carriers: bool = False,
            carrier_depth: Optional[float] = None) -> Clump:
    """The clump with masses that sum to mass, centre and inertia of the particle, as `mskit correct`.

    density: kg/m^3. unit: of length, "m", "mm" or "um"; or scale: metres in one. properties: the particle is the
    "shape", or the "union" of the spheres, which takes no shape. axes: of the equations, "principal" or "input".
    least_mass, most_mass: of a sphere / that of the particle. centre_tolerance: how far the centre may be off / radius
    of gyration. carriers: small spheres inside others, of mass and without contact, make all sums exact; carrier_depth:
    below the surface, in the unit of the clump.

    >>> clump = mskit.generate(mskit.body("grain", fineness=12), "mss", spheres=40, cells=30)
    >>> heavy = mskit.correct(clump, density=2650, unit="mm")
    >>> abs(heavy.masses.sum() / heavy.particle.mass - 1) < 1e-9
    True
    """
    clump = as_clump(clump)
    how = read_masses(density, unit, scale, properties, axes, least_mass, most_mass, centre_tolerance, carriers,
                      carrier_depth)
    if how.of_union and shape is not None:
        raise ArgumentError("correct takes either a shape or properties='union'")
    if how.of_union:
        return give_masses(clump, ffi.NULL, how)
    chosen, solid = _body_for(clump, shape)
    done = give_masses(clump, ffi.addressof(solid), how)
    done.shape = chosen
    return done


class Masses(NamedTuple):
    """How masses are given."""
    density: float
    metres: float  # in a unit of length
    of_union: bool  # and not of the shape
    options: Any  # ms_carriers_options
    carriers: bool


def read_masses(density: float, unit: str, scale: Optional[float], properties: str, axes: str,
                least_mass: Optional[float], most_mass: Optional[float], centre_tolerance: Optional[float],
                carriers: bool, carrier_depth: Optional[float]) -> Masses:
    """Checks what `correct` is given."""
    choice("properties", properties, ("shape", "union"))
    choice("axes", axes, ("principal", "input"))
    if not flag("carriers", carriers) and carrier_depth is not None:
        raise ArgumentError("carrier_depth takes carriers=True beside it")
    if choice("unit", unit, _UNITS) != "m" and scale is not None:
        raise ArgumentError("unit and scale exclude one another")
    metres = _UNITS[unit] if scale is None else number("scale", scale, TINY, 1e300)

    def bound(name: str, value: Optional[float], low: float, high: float) -> float:
        return 0 if value is None else max(TINY, number(name, value, low, high))  # 0 would be "not asked for"

    options = ffi.new("ms_carriers_options *", {"masses": {
        "input_frame": axes == "input", "least": bound("least_mass", least_mass, TINY, 1),
        "most": bound("most_mass", most_mass, TINY, 1),
        "centre_tolerance": bound("centre_tolerance", centre_tolerance, 0, 1e300)},
        "depth": bound("carrier_depth", carrier_depth, TINY, 1e300)})
    return Masses(number("density", density, TINY, 1e300), metres, properties == "union", options, carriers)


def union_body(c: Any) -> Any:
    """The ms_body of the union of the spheres of an ms_clump."""
    body = ffi.new("ms_body *")
    call(lib.ms_particle_union, body, c, voxels_within(Grid(), ffi.new("ms_target_need *")[0]))
    return body


def give_masses(clump: Clump, body: Any, how: Masses, name: str = "") -> Clump:
    """Those of the particle with this ms_body."""
    particle, report, made = ffi.new("ms_particle *"), ffi.new("ms_density_report *"), own(clump)
    if how.of_union:
        body = union_body(made)
    call(lib.ms_particle_from_body, particle, body, how.density, how.metres, name=name)
    if how.carriers:
        call(lib.ms_carriers_solve, made, report, particle, how.options, name=name)
    else:
        call(lib.ms_density_solve, made, report, particle, ffi.addressof(how.options, "masses"), name=name)
    done = from_c(made, clump, particle)
    done.mass_report = {name: _plain(getattr(report, name)) for name, _ in ffi.typeof("ms_density_report").fields}
    return done


def _plain(value: Any) -> Any:
    return value if isinstance(value, (int, float)) else list(value)


def equal_volume(clump: Any, shape: Any = None) -> Clump:
    """The clump scaled about the centroid of the shape until the union of its spheres has the shape's volume.

    Of variational `mskit generate --equal-volume` has held the volume before: `generate(..., hold_volume=True)`.
    Warns with a Remark of a scale beyond a tenth, where spheres lie off the shape.
    """
    clump = as_clump(clump)
    chosen, solid = _body_for(clump, shape)
    made = own(clump)
    scaled, said = ffi.new("ms_equal_volume *"), ffi.new("ms_error *")
    call(lib.ms_equal_volume_scale, made, scaled, ffi.addressof(solid))
    lib.ms_equal_volume_remark(said, scaled)
    if text(said.text):
        remark(text(said.text))
    done = from_c(made, clump)
    done.shape = chosen
    return done
