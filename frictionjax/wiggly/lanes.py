"""Lanes: many short integrations of the wiggly system, side by side in one loop."""

import contextlib
import threading
from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from ..arguments import Real
from ..loads import AbstractLoad
from ..potentials import AbstractPotential
from ..programs import Program
from ..supports import AbstractSupport
from .balance import Balance, advance, end_slope
from .extent import Extent, Guide, spend, widen
from .field import Point, TipField
from .rosenbrock import Linearised, Tableau, rosenbrock_step
from .status import Status
from .step_sizes import PER_OCTAVE, level_below, log2, step_of

# Lanes side by side. Seconds of one lane and step, one core: 0.09 us at 64; at 256, where
# XLA splits the arrays over threads, 0.17. A few jobs go through the narrow loop, whose
# steps take less time.
WIDTH, NARROW = 64, 8
# Steps between two looks at which lanes are done: a look costs about two steps, and a
# lane that is done idles for half of this.
_CHUNK = 16
_LOWEST_LEVEL = -900 * PER_OCTAVE


class Cells(NamedTuple):
    """What all lanes of a cell share, shape (cells,): step control and eps^gamma."""

    eps: Any
    viscosity: Any
    tolerance: Any
    reach: Any
    first_step: Any


class Jobs(NamedTuple):
    """Where lanes start, shape (jobs,), and the range of legs that each runs through.

    At the time `origin` (s) the tip is at `tip` in the well number `well`.
    """

    cell: Any
    origin: Any
    well: Any
    tip: Any
    first_leg: Any
    past_leg: Any


class Legs(NamedTuple):
    """Stretches of a lane's way between two stops, shape (legs,).

    `start`, `end`: times in s. The guide goes from the state `guide0` (m) with the slope
    `slope0` (m/s) to `guide1` with `slope1`, and dissipates `friction` (N per m). `budget`:
    steps after which a lane gives up.
    """

    start: Any
    end: Any
    guide0: Any
    guide1: Any
    slope0: Any
    slope1: Any
    friction: Any
    budget: Any


class Arrivals(NamedTuple):
    """What lanes found at the end of each leg and on the way, shape (legs,).

    `well`, `tip`, `speed` (m/s): at the stop. `work`: int l' (z - guide), `viscous` and
    `residual` as in `Balance`, J. The rest as in `Extent`, and counts.
    """

    well: Any
    tip: Any
    speed: Any
    work: Any
    viscous: Any
    residual: Any
    ahead: Any
    behind: Any
    surplus: Any
    deficit: Any
    steps: Any
    rejected: Any
    code: Any


class LaneScene(eqx.Module):
    """What a lane simulates: the parts of the field, without the times of the scene."""

    potential: AbstractPotential
    support: AbstractSupport
    load: AbstractLoad


class _Task(NamedTuple):
    """What stays the same on a leg; `stop` in s since `origin`, `budget` in steps."""

    job: Int[Array, ""]
    leg: Int[Array, ""]
    cell: Cells
    origin: Real
    guide: Guide
    well: Real
    stop: Real
    budget: Real


class _Motion(NamedTuple):
    """What moves on a leg; `time` in s since the task's origin."""

    tip: Real
    time: Real
    point: Point
    level: Real
    before: Real
    sums: Balance
    extent: Extent
    steps: Real
    rejected: Real
    code: Real


def _field(scene: LaneScene, task: _Task) -> TipField:
    eps, viscosity, *_ = task.cell
    parts = scene.potential, scene.support, scene.load
    return TipField(*parts, eps, viscosity, well=task.well, origin=task.origin)


def _next_level(
    tableau: Tableau, cell: Cells, before: Real, step: Real, moved: Real, error: Real
) -> tuple[Bool[Array, ""], Real, Real]:
    """Whether a step is accepted, the next level, and log2 of error over tolerance.

    PI control with gains 0.7 and 0.4: a pure I controller loses 35% of the steps at folds,
    this 15%. A step that moves the tip further than `reach` is rejected whatever its
    error: see `WellGuard`.
    """
    excess = moved / cell.reach
    finite = (excess < 20.0) & (error < 1e300)
    excess = jnp.where(finite, excess, 20.0)
    error = jnp.where(finite, jnp.maximum(error, 1e-5 * cell.tolerance), cell.tolerance)
    size = log2(error) - log2(cell.tolerance)
    too_far = tableau.order * log2(1.1 * jnp.maximum(excess, 1e-3))
    size = jnp.where(excess > 1, jnp.maximum(size, too_far), size)
    accepted = size <= 0
    change = np.log2(0.9) - (0.7 * size - 0.4 * before) / tableau.order
    change = jnp.clip(change, np.log2(0.1), jnp.where(accepted, np.log2(5.0), -0.125))
    level = jnp.floor(PER_OCTAVE * (log2(step) + change) + 1e-4)
    return accepted, level, size


def _keep(condition: Real, new: Any, old: Any) -> Any:
    return jax.tree_util.tree_map(lambda a, b: jnp.where(condition, a, b), new, old)


def _step(
    scene: LaneScene, tableau: Tableau, balanced: bool, task: _Task, motion: _Motion
) -> _Motion:
    """One step of one lane; a lane that has reached its stop stays as it is."""
    field = _field(scene, task)
    live = (motion.time < task.stop) & (motion.code == 0)
    full, left = step_of(motion.level), task.stop - motion.time
    cut = full >= left
    step = jnp.where(live, jnp.where(cut, left, full), 1.0)
    start = Linearised(*motion.point[:3])
    tip, stages = rosenbrock_step(
        tableau, field.velocity, start, motion.time, step, motion.tip
    )
    moved, error = jnp.abs(tip - motion.tip), jnp.abs(stages[-1])
    fits, level, size = _next_level(tableau, task.cell, motion.before, step, moved, error)
    # A step cut short by its stop says nothing about the next one.
    level = jnp.where(fits & cut, jnp.maximum(level, motion.level), level)
    size = jnp.where(cut, motion.before, size)
    accepted = fits & live
    tip = jnp.where(accepted, tip, motion.tip)
    time = jnp.where(cut, task.stop, motion.time + step)
    end = field.point(time, tip)
    sums = motion.sums
    if balanced:
        sums = advance(
            field,
            sums,
            motion.time,
            step,
            motion.tip,
            tip,
            motion.point,
            end,
            task.guide.__call__,
        )
    after = _Motion(
        tip=tip,
        time=time,
        point=end,
        level=level,
        before=size,
        sums=sums,
        extent=_extent(task, motion, step, time, end, sums),
        steps=motion.steps,
        rejected=motion.rejected,
        code=motion.code,
    )
    failure = jnp.where(level < _LOWEST_LEVEL, float(Status.NOT_FINITE), 0.0)
    failure = jnp.where(motion.steps >= task.budget, float(Status.MAX_STEPS), failure)
    return _keep(accepted, after, motion)._replace(
        level=jnp.where(live, level, motion.level),
        steps=motion.steps + live,
        rejected=motion.rejected + (live & ~fits),
        code=jnp.where(live, failure, motion.code),
    )


def _extent(
    task: _Task, motion: _Motion, step: Real, time: Real, end: Point, sums: Balance
) -> Extent:
    guide, eps = task.guide, task.cell.eps
    pace = guide.rise / guide.length
    points = motion.point, end
    slopes = [eps * p.stretch * end_slope(p, step)[0] - pace for p in points]
    gaps = motion.point.state - guide(motion.time), end.state - guide(time)
    extent = widen(motion.extent, step, gaps, (slopes[0], slopes[1]))
    return spend(extent, sums.viscous - guide.friction * guide.way(time))


class _Tables(NamedTuple):
    """Jobs, legs and cells as rows of numbers: one gather fetches a row."""

    cells: Any  # Float[Array, "cells 5"]
    jobs: Any  # Float[Array, "jobs 6"]
    legs: Any  # Float[Array, "legs 8"]
    waiting: Any  # Int[Array, ""], jobs in the queue


class _Work(NamedTuple):
    """All lanes under way, the next job of the queue, and what has been found."""

    task: _Task
    motion: _Motion
    next_job: Int[Array, ""]
    found: Float[Array, "legs 13"]


def _idle(tables: _Tables, width: int) -> tuple[_Task, _Motion]:
    zero, one = jnp.zeros(width), jnp.ones(width)
    none = jnp.full(width, tables.jobs.shape[0], dtype=int)
    past = jnp.full(width, tables.legs.shape[0], dtype=int)
    task = _Task(
        none, past, Cells(*[one] * 5), zero, Guide(*[one] * 7), zero, zero, budget=zero
    )
    motion = _Motion(
        tip=zero,
        time=zero,
        point=Point(*[zero] * 5),
        level=zero,
        before=zero,
        sums=Balance(*[zero] * 3),
        extent=Extent(*[zero] * 4),
        steps=zero,
        rejected=zero,
        code=zero,
    )
    return task, motion


def _report(task: _Task, motion: _Motion) -> Float[Array, "width 13"]:
    """Rows of `Arrivals` for all lanes; NaN where a lane has failed."""
    blank = jnp.where(motion.code == 0, 0.0, jnp.nan)
    speed = task.cell.eps * motion.point.stretch * motion.point.velocity
    values = (task.well, motion.tip, speed, *motion.sums, *motion.extent)
    counts = (motion.steps, motion.rejected, motion.code)
    return jnp.stack([*(v + blank for v in values), *counts], axis=-1)


def _refill(tables: _Tables, work: _Work) -> tuple[_Task, _Motion, Int[Array, ""]]:
    """Give lanes that are through their leg the next one, or the next job."""
    task, motion = work.task, work.motion
    jobs, legs, cells, count = tables.jobs, tables.legs, tables.cells, tables.waiting
    idle = task.job >= count
    done = idle | (motion.time >= task.stop) | (motion.code != 0)
    past_leg = jobs[jnp.minimum(task.job, jobs.shape[0] - 1), 5]
    same_job = done & ~idle & (task.leg + 1 < past_leg)
    wants = done & ~same_job
    turn = work.next_job + jnp.cumsum(wants) - 1
    job = jnp.where(wants, jnp.minimum(turn, count), task.job)
    fresh = wants & (job < count)
    next_job = jnp.minimum(work.next_job + jnp.sum(wants), count)
    cell, origin, well, tip, first_leg, _ = jobs[jnp.minimum(job, jobs.shape[0] - 1)].T
    cell_row = Cells(*cells[cell.astype(int)].T)
    leg = jnp.where(same_job, task.leg + 1, task.leg)
    leg = jnp.where(fresh, first_leg.astype(int), leg)
    leg = jnp.where(wants & ~fresh, legs.shape[0], leg)
    start, end, guide0, guide1, slope0, slope1, friction, budget = legs[
        jnp.minimum(leg, legs.shape[0] - 1)
    ].T
    length = jnp.where(end > start, end - start, 1.0)
    change = same_job | fresh
    rise = guide1 - guide0
    origin = jnp.where(fresh, origin, task.origin)
    guide = Guide(start - origin, length, guide0, rise, slope0, slope1, friction)
    # Positions are counted from the nearest well, so that `tip` keeps its digits.
    tip = jnp.where(fresh, tip, motion.tip)
    shift = jnp.where(jnp.isfinite(tip), jnp.round(tip), 0.0)
    moved = _Task(
        job=job,
        leg=leg,
        cell=_keep(fresh, cell_row, task.cell),
        origin=origin,
        guide=_keep(change, guide, task.guide),
        well=jnp.where(fresh, well, task.well) + shift,
        budget=jnp.where(change, budget, task.budget),
        stop=jnp.where(change, end - origin, jnp.where(wants, -1.0, task.stop)),
    )
    zero = jnp.zeros_like(tip)
    empty = jnp.full_like(tip, jnp.inf)
    nothing = Extent(-empty, empty, zero, zero)
    time = jnp.where(fresh, 0.0, motion.time)
    set_off = motion._replace(
        tip=tip - shift,
        time=time,
        level=jnp.where(fresh, level_below(cell_row.first_step), motion.level),
        before=jnp.where(fresh, 0.0, motion.before),
        sums=_keep(change, Balance(zero, zero, zero), motion.sums),
        extent=_keep(change, nothing, motion.extent),
        steps=jnp.where(change, 0.0, motion.steps),
        rejected=jnp.where(change, 0.0, motion.rejected),
        code=jnp.where(fresh, 0.0, motion.code),
    )
    return moved, set_off, next_job


@Program
def _march(
    scene: LaneScene, tableau: Tableau, balanced: bool, width: int, tables: _Tables
) -> Float[Array, "legs 13"]:
    step = jax.vmap(lambda task, motion: _step(scene, tableau, balanced, task, motion))
    point = jax.vmap(lambda task, time, tip: _field(scene, task).point(time, tip))

    def look(work: _Work) -> _Work:
        task, motion, next_job = _refill(tables, work)
        # From the right of a kink on which the last leg ended.
        motion = motion._replace(point=point(task, motion.time, motion.tip))
        motion = jax.lax.fori_loop(0, _CHUNK, lambda _, m: step(task, m), motion)
        through = (motion.time >= task.stop) | (motion.code != 0)
        place = jnp.where(through & (task.job < tables.waiting), task.leg, past)
        found = work.found.at[place].set(_report(task, motion), mode="drop")
        return _Work(task, motion, next_job, found)

    def go_on(work: _Work) -> Bool[Array, ""]:
        task, motion = work.task, work.motion
        past_leg = tables.jobs[jnp.minimum(task.job, tables.jobs.shape[0] - 1), 5]
        stands = (motion.time >= task.stop) | (motion.code != 0)
        ended = (task.job >= tables.waiting) | (stands & (task.leg + 1 >= past_leg))
        return (work.next_job < tables.waiting) | ~jnp.all(ended)

    past = tables.legs.shape[0]
    found = jnp.full((past, len(Arrivals._fields)), jnp.nan)
    start = _Work(*_idle(tables, width), jnp.zeros((), dtype=int), found)
    return jax.lax.while_loop(go_on, look, start).found


class Room(NamedTuple):
    """Rows of the tables of a compiled loop."""

    cells: int
    jobs: int
    legs: int

    def holds(self, needed: "Room") -> bool:
        """Whether that many rows fit, and not into a hundredth of the legs."""
        fits = all(a >= b for a, b in zip(self, needed, strict=True))
        return fits and self.legs <= _SPARE * max(needed.legs, _ROOM.legs)


# Each size of the tables costs 0.4 s to trace and load, 2 s to compile, an empty row
# nothing: so few sizes, and a loop that is there already is taken where it is larger.
_ROOM, _SPARE = Room(64, 2048, 4096), 16


def room_for(needed: Room) -> Room:
    """Room for that many rows: all sizes grow together, by fours."""
    size = _ROOM
    while not all(a >= b for a, b in zip(size, needed, strict=True)):
        size = Room(*(4 * rows for rows in size))
    return size


def _padded(rows: np.ndarray, size: int) -> np.ndarray:
    padded = np.ones((size, rows.shape[1]))
    padded[: rows.shape[0]] = rows
    return padded


class _Loops:
    """Loops compiled so far, by what they simulate; two threads compile one once."""

    def __init__(self) -> None:
        self._known: dict[Any, dict[Room, threading.Lock]] = {}
        self._lock = threading.Lock()
        self._done: set = set()

    def run(self, program: tuple, needed: Room, fill: Callable[[Room], _Tables]) -> Array:
        """Run the loop on tables of a room that `fill` makes."""
        kind = _kind(program)
        with self._lock:
            rooms = self._known.setdefault(kind, {})
            fitting = [room for room in rooms if room.holds(needed)]
            room = min(fitting, key=lambda r: r.legs) if fitting else room_for(needed)
            compiling = rooms.setdefault(room, threading.Lock())
        if (kind, room) in self._done:
            return _march(*program, fill(room))
        with compiling:
            found = _march(*program, fill(room))
            self._done.add((kind, room))
            return found


def _kind(program: tuple) -> tuple:
    """What a compiled loop depends on, numbers left out."""
    leaves, structure = jax.tree_util.tree_flatten(program)
    shapes = (x.shape if eqx.is_array(x) else x for x in leaves)
    return structure, *shapes


_LOOPS = _Loops()


def prepare(
    scene: LaneScene, tableau: Tableau, needed: Room, balanced: bool = True
) -> None:
    """Compile the loop that `march` will want, in the background; a guess may be wrong."""

    def nothing(room: Room) -> _Tables:
        widths = (len(Cells._fields), len(Jobs._fields), len(Legs._fields))
        tables = (np.ones((n, w)) for n, w in zip(room, widths, strict=True))
        return _Tables(*tables, waiting=np.asarray(0))

    def compile_quietly() -> None:
        # What cannot be compiled fails again in `march`, where somebody hears of it.
        with contextlib.suppress(Exception):
            _LOOPS.run((scene, tableau, balanced, WIDTH), needed, nothing)

    threading.Thread(target=compile_quietly).start()


def march(
    scene: LaneScene,
    cells: Cells,
    jobs: Jobs,
    legs: Legs,
    tableau: Tableau,
    balanced: bool = True,
) -> Arrivals:
    """Run all jobs side by side; each lane takes the next job when it is through.

    NumPy arrays in and out. What a lane finds does not depend on the others.
    """
    tables = [np.stack([np.asarray(c, float) for c in t], -1) for t in (cells, jobs, legs)]
    needed = Room(*(len(t) for t in tables))

    def fill(room: Room) -> _Tables:
        rows = (_padded(t, size) for t, size in zip(tables, room, strict=True))
        return _Tables(*rows, waiting=np.asarray(needed.jobs))

    width = NARROW if needed.jobs <= NARROW else WIDTH
    found = _LOOPS.run((scene, tableau, balanced, width), needed, fill)
    return Arrivals(*np.asarray(found)[: needed.legs].T)
