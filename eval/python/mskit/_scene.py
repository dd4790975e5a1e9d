"""Whole scenes: how many spheres each shape is worth, its template, and the scripts of engines."""
from __future__ import annotations

import math
from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy

from ._clumps import from_c
from ._errors import (TINY, ArgumentError, Error, LimitError, Path, call, find, flag, number, show, use_threads,
                      whole, word)
from ._expect import find_expectation
from ._generate import Listener, Run, give_masses, read_masses, watched
from ._library import ffi, lib
from ._methods import DEFAULT, find_generator
from ._scene_files import Kind, write_scene
from ._scene_rows import Row, Rows, read_rows
from ._shapes import Shape, make_grid, voxels_within

_MOST_SPHERES = 1000


class Scene(NamedTuple):
    """The templates chosen, and what they come to.

    kinds: of particles, a `Kind` for each row.
    particles: in the whole scene.
    spheres: of all particles.
    mean_dice: over the particles.
    least_gain: the least that each sphere of the scene given back adds to the sum of D over the particles.
    slack: no other choice is better by more, of a budget in mean D, of mean_dice in spheres; 0: the best.
    """
    kinds: List[Kind]
    particles: int
    spheres: int
    mean_dice: float
    least_gain: float
    slack: float

    def correct(self, *, density: float, unit: str = "m", scale: Optional[float] = None, properties: str = "shape",
                axes: str = "principal", least_mass: Optional[float] = None, most_mass: Optional[float] = None,
                centre_tolerance: Optional[float] = None, carriers: bool = False,
                carrier_depth: Optional[float] = None) -> "Scene":
        """The scene with masses in each template, as engines take them: as `mskit.correct` of each."""
        how = read_masses(density, unit, scale, properties, axes, least_mass, most_mass, centre_tolerance, carriers,
                          carrier_depth)
        kinds = []
        for kind in self.kinds:
            body = ffi.new("ms_body *", kind.shape.c_body(kind.grid))
            lib.ms_inertia_scale(body, kind.factor)
            kinds.append(kind._replace(clump=give_masses(kind.clump, body, how, kind.name)))
        return self._replace(kinds=kinds)

    def write(self, folder: Path, format: Union[str, Sequence[str]] = "csv", *,
              box: Optional[Sequence[float]] = None, cylinder: Optional[float] = None) -> List[str]:
        """Writes each template, by the name of its shape, and of "liggghts", "lammps" and "yade" a script.

        The script inserts all particles into a vessel, lets them come to rest and prints figures of the bed: the files
        of `mskit scene -o`, byte for byte. The folder is made if it is not there.
        format: a key of `formats`, or several; templates of engines take masses (`correct`). box: inner widths along x
        and y, or cylinder: inner diameter, in the unit of the shapes; neither: a box as wide as the bed is high.

        Returns the paths of templates, then of scripts.
        """
        return write_scene(self.kinds, folder, [format] if isinstance(format, str) else format, box, cylinder)


class _Goal(NamedTuple):
    """What the templates have to reach, or may cost."""
    kind: str  # budget, mean_dice, knee or tolerance
    value: float  # of tolerance NaN where each row has its own, or a length is given
    measure: Any = None  # of tolerance
    length: float = 0  # of tolerance: mean distance of the surfaces; 0: none is given


class _Made(NamedTuple):
    """What was made of a row."""
    row: Row
    run: Run
    c: Any  # ms_templates, which rows of one shape share
    factor: float  # from the shape's own size to that of the row
    chosen: int  # number of spheres; 0: all rows together say

    def dice(self) -> numpy.ndarray:
        return numpy.frombuffer(ffi.buffer(self.c.dice, 8 * self.c.most)).copy()


def _read_tolerance(tolerance: Any) -> _Goal:
    if not hasattr(tolerance, "items") or len(tolerance) != 1:
        raise ArgumentError(f"tolerance={show(tolerance)} is no dict of one measure, as {{'dice': 0.05}}")
    (name, value), = tolerance.items()
    return _Goal("tolerance", number(f"tolerance {name}", value, 0, 1),
                 find(lib.ms_measure_find_goal, word("tolerance", name)))


def _read_goal(rows: List[Row], **given: Any) -> _Goal:
    """What keywords and rows say together."""
    asked = {name: value for name, value in given.items() if value is not None}
    tolerances = sum(not math.isnan(row.tolerance) for row in rows)
    dice = ffi.addressof(lib.ms_measures, lib.MS_MEASURE_DICE)
    if len(asked) > 1:
        raise ArgumentError(f"{', '.join(given)} exclude one another; give one")
    if not asked and tolerances < len(rows):
        raise ArgumentError(f"no goal; give one of {', '.join(given)}, or a tolerance in each row")
    (name, value), = asked.items() or [("rows", None)]
    if tolerances and name not in ("rows", "tolerance", "tolerance_length"):
        raise ArgumentError("the tolerances of rows go with tolerance, tolerance_length or alone; leave them out")
    if name == "rows":
        return _Goal("tolerance", math.nan, dice)
    if name == "tolerance":
        return _read_tolerance(value)
    if name == "tolerance_length":
        return _Goal("tolerance", math.nan, dice, number(name, value, TINY, 1e300))
    if name == "budget":
        particles = sum(row.particles for row in rows)
        budget = whole(name, value, 1, 10**15)
        if budget < particles:
            raise LimitError(f"a budget of {budget} spheres is less than one for each of {particles} particles; raise "
                             "it")
        return _Goal(name, budget)
    return _Goal(name, number(name, value, *((0, 1) if name == "mean_dice" else (1e-9, 1))))


def _first_number(shape: Shape, target: Any, goal: _Goal, value: float, most: int) -> int:
    """That the tolerance is expected to take; where nothing is expected, a quarter of the most."""
    wanted = most / 4
    if goal.measure == ffi.addressof(lib.ms_measures, lib.MS_MEASURE_DICE) and value > 0:
        try:
            expected = find_expectation(shape, ffi.addressof(target, "grid"))
            wanted = math.ceil(min(most, lib.ms_expect_spheres(expected, lib.MS_EXPECT_FREE, value)))
        except Error:
            pass
    return int(min(wanted, most))


def _least(made: _Made, goal: _Goal, value: float, surface: float) -> int:
    """The least number of spheres that reaches the tolerance of a row."""
    best = ffi.new("double *")
    least = int(lib.ms_templates_least(best, made.c, goal.measure, value))
    if least == 0:
        name, asked, have = ffi.string(goal.measure.name).decode(), value, best[0]
        if goal.length and math.isnan(made.row.tolerance):
            name, asked = "a mean distance of", goal.length
            have = lib.ms_templates_length(have, surface, made.factor)
        raise LimitError(f"{made.row.name}: no template of up to {made.c.most} spheres has {name} {asked:.6g}, the "
                         f"best has {have:.6g}; raise max_spheres, use more cells or another method, or ease the "
                         "tolerance")
    return least


def _knee(made: _Made, part: float) -> int:
    knee = int(lib.ms_allocate_knee(_share(made), part))
    if knee == 0:
        raise LimitError(f"{made.row.shape.name}: up to the last of {made.c.most} spheres each takes away {part:.6g} "
                         "of D or more; raise max_spheres or the part")
    return knee


def _make(rows: List[Row], run: Run, goal: _Goal, equal_volume: bool, progress: Listener) -> List[_Made]:
    """The templates of one shape, which stands in all these rows; and what the goal says of each row alone."""
    shape, searched = rows[0].shape, goal.kind == "tolerance" and not run.nested
    templates = ffi.gc(ffi.new("ms_templates *"), lib.ms_templates_free)
    surface, reached, made = ffi.new("double *"), ffi.new("size_t *"), []
    with watched(shape.name, progress) as watch:
        held = shape.c_target(run.grid, run.need)  # not freed before this ends
        target = ffi.new("ms_target *", held[0])  # others may work on the same voxels now
        target.count_cut = run.cut
        body = ffi.addressof(target, "body")
        c_run = run.c_run(target, watch)
        how = ffi.new("ms_templates_how *", {"generator": run.row, "run": c_run, "max_voxels": voxels_within(
            run.grid, run.need), "equal": body if equal_volume else ffi.NULL})
        if goal.length:
            call(lib.ms_templates_surface, surface, target, name=shape.name)
        if searched:
            call(lib.ms_templates_alloc, templates, run.stop.spheres)
        else:
            call(lib.ms_templates_make, templates, how, name=shape.name)
        for row in rows:
            factor = 1.0 if math.isnan(row.size) else lib.ms_inertia_factor(body, row.size)
            value = lib.ms_templates_dice(goal.length, surface[0], factor) if goal.length else goal.value
            value = value if math.isnan(row.tolerance) else row.tolerance
            one = _Made(row, run, templates, factor, 0)
            if searched:
                first = _first_number(shape, target, goal, value, templates.most)
                call(lib.ms_templates_search, templates, reached, how, goal.measure, value, first, name=shape.name)
                one = one._replace(chosen=int(reached[0]))
            if goal.kind == "tolerance" and not one.chosen:
                one = one._replace(chosen=_least(one, goal, value, surface[0]))
            elif goal.kind == "knee":
                one = one._replace(chosen=_knee(one, goal.value))
            made.append(one)
    return made


def _share(made: _Made) -> Any:
    return ffi.new("ms_share *", {"particles": made.row.particles, "most": made.c.most, "error": made.c.dice})


def _choose(made: List[_Made], goal: _Goal) -> Tuple[List[int], Any, float]:
    """Numbers of spheres, what they come to, and what the least useful sphere brings."""
    count, shares = len(made), ffi.new("ms_share[]", [_share(each)[0] for each in made])
    n, done = ffi.new("size_t[]", [each.chosen for each in made]), ffi.new("ms_allocation *")
    if goal.kind == "budget":
        call(lib.ms_allocate_budget, n, done, shares, count, int(goal.value))
    elif goal.kind == "mean_dice":
        call(lib.ms_allocate_error, n, done, shares, count, goal.value)
    else:
        done[0] = lib.ms_allocate_sum(shares, n, count)
    if goal.kind == "tolerance" and not made[0].run.nested:  # of a search one number below that chosen is known
        gain = min((each.c.dice[k - 2] - each.c.dice[k - 1] for each, k in zip(made, n) if k > 1), default=0.0)
    else:
        gain = float(lib.ms_allocate_gain(shares, n, count))
    return list(n), done, gain


def _kind(made: _Made, n: int) -> Kind:
    """With the template of n spheres, in the size of the row."""
    scaled = ffi.gc(ffi.new("ms_clump *"), lib.ms_clump_free)
    call(lib.ms_clump_scale, scaled, ffi.addressof(made.c.clump, n - 1), made.factor)
    clump = from_c(scaled)
    clump.run, clump.stopped_by = made.run, "spheres"
    clump.shape = made.row.shape if math.isnan(made.row.size) else None
    said = ffi.string(made.c.remarks[n - 1].text).decode(errors="replace")
    return Kind(made.row.shape, made.row.particles, made.row.size, clump, made.dice(), made.factor, made.run.grid, said)


def scene(rows: Rows, *, budget: Optional[int] = None, tolerance: Optional[Dict[str, float]] = None,
          tolerance_length: Optional[float] = None, mean_dice: Optional[float] = None, knee: Optional[float] = None,
          generator: str = DEFAULT, max_spheres: int = 100, min_radius: Optional[float] = None,
          equal_volume: bool = False, cells: Optional[int] = None, deq: Optional[float] = None,
          voxel_size: Optional[float] = None, max_voxels: Optional[float] = None, rule: str = "half",
          max_memory: Optional[float] = None, seed: int = 1, threads: Optional[int] = None, progress: Listener = None,
          **options: Any) -> Scene:
    """How many spheres each shape of a scene is worth, and its template: the same as by `mskit scene`.

    rows: for each kind of particles (shape, count), or a dict of shape, count and, if wanted, size: diameter of the
    ball of the particle's volume, in the unit of the shape, to which it is scaled about the origin of its frame; and
    tolerance, of this row. A shape is what `generate` takes; in several sizes it is one object, or one path. Or rows is
    the path of a manifest; `sieve` makes rows by a sieve curve.
    One of: budget, spheres in the whole scene, for the least mean D that they pay for; tolerance, as {"dice": 0.05},
    for the fewest spheres of each row that reach it; tolerance_length, mean distance of the surfaces of template and
    particle, likewise; mean_dice, over all particles, for the fewest spheres in the whole scene; knee, the part of its
    D that a further sphere has to take away.
    max_spheres: of the largest template. equal_volume: each template is scaled until its union has the shape's volume,
    which a method that can holds before. The rest as for `generate`.

    >>> torus = mskit.body("torus", fineness=8)
    >>> rows = [(mskit.body("cube"), 1000)] + [{"shape": torus, "count": 10, "size": size} for size in (1, 4)]
    >>> found = mskit.scene(rows, tolerance_length=0.16, generator="mss", max_spheres=12, cells=12)
    >>> [(kind.particles, len(kind.clump)) for kind in found.kinds], found.spheres
    ([(1000, 1), (10, 2), (10, 11)], 1130)
    """
    read = read_rows(rows)
    goal = _read_goal(read, budget=budget, tolerance=tolerance, tolerance_length=tolerance_length, mean_dice=mean_dice,
                      knee=knee)
    grid = make_grid(cells, deq, voxel_size, max_voxels, rule, max_memory)
    stop = ffi.new("ms_stop *", {"spheres": whole("max_spheres", max_spheres, 1, _MOST_SPHERES)})
    if min_radius is not None:
        stop.radius = number("min_radius", min_radius, 1e-300, 1e300)
        if not all(math.isnan(row.size) for row in read):
            raise ArgumentError("min_radius is of shapes in their own size, since all sizes of a shape share its "
                                "templates; drop it or the sizes")
    held_by = find_generator(generator).volume_by
    if flag("equal_volume", equal_volume) and held_by != ffi.NULL:
        options = {ffi.string(held_by).decode().replace("-", "_"): True, **options}
    run = Run(generator, stop, seed, grid, options,
              cut=goal.measure == ffi.addressof(lib.ms_measures, lib.MS_MEASURE_COVERAGE_CUT))
    made: Dict[int, _Made] = {}
    with use_threads(threads):
        for first in range(len(read)):
            if first not in made:
                places = [at for at in range(first, len(read)) if read[at].shape is read[first].shape]
                made.update(zip(places, _make([read[at] for at in places], run, goal, equal_volume, progress)))
                if not read[first].given:
                    read[first].shape.drop_voxels()
        in_order = [made[at] for at in range(len(read))]
        n, done, gain = _choose(in_order, goal)
    kinds = [_kind(one, k) for one, k in zip(in_order, n)]
    for kind in kinds:
        kind.tell()
    return Scene(kinds, int(done.particles), sum(kind.particles * len(kind.clump) for kind in kinds), done.error, gain,
                 done.slack)
