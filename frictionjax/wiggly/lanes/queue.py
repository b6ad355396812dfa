"""A queue of jobs for lanes side by side: each takes the next when it is through."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from ..._compile import Program
from ..equation import Balance, Point
from ..rosenbrock import Tableau
from ..stepping import ControlState
from .lane import (
    LaneCells,
    LaneScene,
    LaneState,
    LaneTask,
    field_of_lane,
    keep,
    step_of_lane,
)
from .running_extrema import Extent, Guide
from .settings import SETTINGS


class Lanes(NamedTuple):
    """Where lanes start, shape (jobs,), and the range of legs that each runs through.

    At the time `origin` (s) the tip is at `tip` in the well number `well`.
    """

    cell: Any
    origin: Any
    well: Any
    tip: Any
    first_leg: Any
    past_leg: Any


class Segments(NamedTuple):
    """Stretches of a lane's way between two stops, shape (legs,).

    `start`, `end`: times in s. The guide goes from the state `guide0` (m) with the slope
    `slope0` (m/s) to `guide1` with `slope1`, and dissipates `friction` (N per m). `budget`:
    steps after which a lane gives up. `level`, `rate`: of the load's straight part, N at
    the start and N/s.
    """

    start: Any
    end: Any
    guide0: Any
    guide1: Any
    slope0: Any
    slope1: Any
    friction: Any
    budget: Any
    level: Any = 0.0
    rate: Any = 0.0


def guide_of(legs: Segments, length: Any = None) -> Guide:
    """The cubics of legs, over their own lengths (s) where no others are given."""
    length = legs.end - legs.start if length is None else length
    rise = legs.guide1 - legs.guide0
    slopes = legs.slope0, legs.slope1
    return Guide(legs.start, length, legs.guide0, rise, *slopes, legs.friction)


class SegmentEnds(NamedTuple):
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
    outside: Any
    surplus: Any
    deficit: Any
    steps: Any
    rejected: Any
    code: Any


class Tables(NamedTuple):
    """Jobs, legs and cells as rows of numbers: one gather fetches a row."""

    cells: Any  # Float[Array, "cells 7"]
    jobs: Any  # Float[Array, "jobs 6"]
    legs: Any  # Float[Array, "legs 8"]
    waiting: Any  # Int[Array, ""], jobs in the queue


class _Work(NamedTuple):
    """All lanes under way, the next job of the queue, and what has been found."""

    task: LaneTask
    motion: LaneState
    next_job: Int[Array, ""]
    found: Float[Array, "legs 14"]


def _idle(tables: Tables, width: int) -> tuple[LaneTask, LaneState]:
    zero, one = jnp.zeros(width), jnp.ones(width)
    none = jnp.full(width, tables.jobs.shape[0], dtype=int)
    past = jnp.full(width, tables.legs.shape[0], dtype=int)
    cells, guide = LaneCells(*[one] * len(LaneCells._fields)), Guide(*[one] * 7)
    task = LaneTask(none, past, cells, zero, guide, zero, zero, zero, level=zero, rate=zero)
    motion = LaneState(
        tip=zero,
        time=zero,
        unseen=zero,
        point=Point(*[zero] * 6),
        control=ControlState(zero, zero),
        sums=Balance(*[zero] * 3),
        extent=Extent(*[zero] * 5),
        steps=zero,
        rejected=zero,
        code=zero,
    )
    return task, motion


def _report(task: LaneTask, motion: LaneState) -> Float[Array, "width 14"]:
    """Rows of `SegmentEnds` for all lanes; NaN where a lane has failed."""
    blank = jnp.where(motion.code == 0, 0.0, jnp.nan)
    speed = task.cell.eps * motion.point.stretch * motion.point.velocity
    values = (task.well, motion.tip, speed, *motion.sums, *motion.extent)
    counts = (motion.steps, motion.rejected, motion.code)
    return jnp.stack([*(v + blank for v in values), *counts], axis=-1)


def _refill(
    tables: Tables, work: _Work
) -> tuple[LaneTask, LaneState, Int[Array, ""], Bool[Array, " width"]]:
    """Give lanes that are through their leg the next one, or the next job; and which."""
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
    cell_row = LaneCells(*cells[cell.astype(int)].T)
    leg = jnp.where(same_job, task.leg + 1, task.leg)
    leg = jnp.where(fresh, first_leg.astype(int), leg)
    leg = jnp.where(wants & ~fresh, legs.shape[0], leg)
    own = Segments(*legs[jnp.minimum(leg, legs.shape[0] - 1)].T)
    change = same_job | fresh
    origin = jnp.where(fresh, origin, task.origin)
    length = jnp.where(own.end > own.start, own.end - own.start, 1.0)
    own = own._replace(start=own.start - origin, end=own.end - origin)
    guide = guide_of(own, length)
    # Positions are counted from the nearest well, so that `tip` keeps its digits.
    tip = jnp.where(fresh, tip, motion.tip)
    shift = jnp.where(jnp.isfinite(tip), jnp.round(tip), 0.0)
    moved = LaneTask(
        job=job,
        leg=leg,
        cell=keep(fresh, cell_row, task.cell),
        origin=origin,
        guide=keep(change, guide, task.guide),
        well=jnp.where(fresh, well, task.well) + shift,
        budget=jnp.where(change, own.budget, task.budget),
        level=jnp.where(change, own.level, task.level),
        rate=jnp.where(change, own.rate, task.rate),
        stop=jnp.where(change, own.end, jnp.where(wants, -1.0, task.stop)),
    )
    zero = jnp.zeros_like(tip)
    empty = jnp.full_like(tip, jnp.inf)
    nothing = Extent(-empty, empty, -empty, zero, zero)
    time = jnp.where(fresh, 0.0, motion.time)
    set_off = motion._replace(
        tip=tip - shift,
        time=time,
        unseen=jnp.where(fresh, 0.0, motion.unseen),
        control=keep(fresh, ControlState(), motion.control),
        sums=keep(change, Balance(zero, zero, zero), motion.sums),
        extent=keep(change, nothing, motion.extent),
        steps=jnp.where(change, 0.0, motion.steps),
        rejected=jnp.where(change, 0.0, motion.rejected),
        code=jnp.where(fresh, 0.0, motion.code),
    )
    return moved, set_off, next_job, change


def _written(
    found: Float[Array, "legs 14"],
    place: Int[Array, " width"],
    through: Bool[Array, " width"],
    rows: Array,
) -> Float[Array, "legs 14"]:
    """`found` with a row of each lane that is `through` at its place.

    Row by row: XLA compiles a loop with a scatter as a list of kernels, which two threads
    hand to each other at every look. (Steps took 1.3 times as long, and both cores.)
    """
    rank = jnp.cumsum(through)

    def put(k: Array, found: Array) -> Array:
        lane = jnp.sum(rank <= k)  # of the lanes that are through, number k
        row = jax.lax.dynamic_slice_in_dim(rows, lane, 1)
        return jax.lax.dynamic_update_slice_in_dim(found, row, place[lane], 0)

    return jax.lax.fori_loop(0, rank[-1], put, found)


@Program
def run_queue(
    scene: LaneScene, tableau: Tableau, summed: bool, width: int, tables: Tables
) -> Float[Array, "legs 14"]:
    step = jax.vmap(lambda task, motion: step_of_lane(scene, tableau, summed, task, motion))
    point = jax.vmap(lambda task, time, tip: field_of_lane(scene, task).point(time, tip))

    def under_way(task: LaneTask, motion: LaneState) -> Int[Array, ""]:
        return jnp.sum((motion.time < task.stop) & (motion.code == 0))

    def look(work: _Work) -> _Work:
        task, motion, next_job, change = _refill(tables, work)
        # From the right of a kink on which the last leg ended.
        begin = point(task, motion.time, motion.tip)
        motion = motion._replace(point=keep(change, begin, motion.point))
        most = under_way(task, motion)

        def goes(carry: tuple[Array, LaneState]) -> Bool[Array, ""]:
            few_idle = under_way(task, carry[1]) > (1 - SETTINGS.idle) * most
            return (carry[0] < SETTINGS.chunk) & few_idle

        def stepped(carry: tuple[Array, LaneState]) -> tuple[Array, LaneState]:
            return carry[0] + 1, step(task, carry[1])

        motion = jax.lax.while_loop(goes, stepped, (jnp.asarray(0), motion))[1]
        through = (motion.time >= task.stop) | (motion.code != 0)
        through &= task.job < tables.waiting
        found = _written(work.found, task.leg, through, _report(task, motion))
        return _Work(task, motion, next_job, found)

    def go_on(work: _Work) -> Bool[Array, ""]:
        task, motion = work.task, work.motion
        past_leg = tables.jobs[jnp.minimum(task.job, tables.jobs.shape[0] - 1), 5]
        stands = (motion.time >= task.stop) | (motion.code != 0)
        ended = (task.job >= tables.waiting) | (stands & (task.leg + 1 >= past_leg))
        return (work.next_job < tables.waiting) | ~jnp.all(ended)

    found = jnp.full((tables.legs.shape[0], len(SegmentEnds._fields)), jnp.nan)
    start = _Work(*_idle(tables, width), jnp.zeros((), dtype=int), found)
    return jax.lax.while_loop(go_on, look, start).found
