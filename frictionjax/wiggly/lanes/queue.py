"""A queue of jobs for lanes side by side: each takes the next when it is through."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
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
    is_live,
    keep,
    step_of_lane,
)
from .running_extrema import Extent, Guide
from .settings import SETTINGS


class Lanes(NamedTuple):
    """Where lanes start, shape (jobs,), and the range of legs that each runs through.

    At the time `origin` (s) the tip is at `tip` in the well number `well`. After so many
    steps on all of them as its `patience` a lane gives up.
    """

    cell: Any
    origin: Any
    well: Any
    tip: Any
    first_leg: Any
    past_leg: Any
    patience: Any = np.inf

    @property
    def legs(self) -> Any:
        """How many each runs through, (jobs,)."""
        return self.past_leg - self.first_leg


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
    jobs: Any  # Float[Array, "jobs 7"]
    legs: Any  # Float[Array, "legs 8"]
    waiting: Any  # Int[Array, ""], jobs in the queue


class _Work(NamedTuple):
    """All lanes under way, the next job of the queue, and what has been found.

    `found` has a row more than there are legs: for lanes before their first.
    """

    task: LaneTask
    motion: LaneState
    next_job: Int[Array, ""]
    found: Float[Array, "rows 14"]


def _waiting(width: int, legs: int) -> tuple[LaneTask, LaneState]:
    """Lanes before their first leg."""
    zero, one = jnp.zeros(width), jnp.ones(width)
    none = jnp.full(width, legs, dtype=int)
    cells, guide = LaneCells(*[one] * len(LaneCells._fields)), Guide(*[one] * 7)
    task = LaneTask(none, none, cells, zero, guide, *[zero] * 6)
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


def _report(task: LaneTask, motion: LaneState) -> Float[Array, "1 14"]:
    """The row of `SegmentEnds` of one lane; NaN where it has failed."""
    blank = jnp.where(motion.code == 0, 0.0, jnp.nan)
    speed = task.cell.eps * motion.point.stretch * motion.point.velocity
    values = (task.well, motion.tip, speed, *motion.sums, *motion.extent)
    counts = (motion.steps, motion.rejected, motion.code)
    return jnp.stack([*(v + blank for v in values), *counts])[None]


def _row(table: Array, index: Int[Array, ""]) -> Array:
    """One row; an index that cannot be negative needs no look whether it is."""
    return jax.lax.dynamic_index_in_dim(table, index.astype(jnp.uint32), keepdims=False)


def _with_row(table: Array, index: Int[Array, ""], row: Array) -> Array:
    return jax.lax.dynamic_update_index_in_dim(table, row, index.astype(jnp.uint32), 0)


def _next_leg(
    tables: Tables, next_job: Int[Array, ""], task: LaneTask, motion: LaneState
) -> tuple[LaneTask, LaneState, Bool[Array, ""]]:
    """What one lane is to do next, and whether it takes the next job for that.

    A lane for which there is nothing left has a leg beyond all rows.
    """
    legs, last_job = tables.legs.shape[0], tables.jobs.shape[0] - 1
    same = task.leg + 1 < task.past_leg
    fresh = ~same & (next_job < tables.waiting)
    job = Lanes(*_row(tables.jobs, jnp.minimum(next_job, last_job)))
    first, past = job.first_leg.astype(int), job.past_leg.astype(int)
    leg = jnp.where(same, task.leg + 1, jnp.where(fresh, first, legs + 1))
    own = Segments(*_row(tables.legs, jnp.minimum(leg, legs - 1)))
    cell = LaneCells(*_row(tables.cells, job.cell.astype(int)))
    origin = jnp.where(fresh, job.origin, task.origin)
    length = jnp.where(own.end > own.start, own.end - own.start, 1.0)
    own = own._replace(start=own.start - origin, end=own.end - origin)
    # Positions are counted from the nearest well, so that `tip` keeps its digits.
    tip = jnp.where(fresh, job.tip, motion.tip)
    left = jnp.where(fresh, job.patience, task.left - motion.steps)
    shift = jnp.where(jnp.isfinite(tip), jnp.round(tip), 0.0)
    following = LaneTask(
        leg=leg,
        past_leg=jnp.where(fresh, past, task.past_leg),
        cell=keep(fresh, cell, task.cell),
        origin=origin,
        guide=guide_of(own, length),
        well=jnp.where(fresh, job.well, task.well) + shift,
        stop=jnp.where(leg <= legs, own.end, -1.0),
        budget=jnp.minimum(own.budget, left),
        left=left,
        level=own.level,
        rate=own.rate,
    )
    zero, empty = jnp.zeros_like(tip), jnp.full_like(tip, jnp.inf)
    set_off = motion._replace(
        tip=tip - shift,
        time=jnp.where(fresh, 0.0, motion.time),
        unseen=jnp.where(fresh, 0.0, motion.unseen),
        control=keep(fresh, ControlState(), motion.control),
        sums=Balance(zero, zero, zero),
        extent=Extent(-empty, empty, -empty, zero, zero),
        steps=zero,
        rejected=zero,
        code=jnp.where(fresh, 0.0, motion.code),
    )
    return following, set_off, fresh


@Program
def run_queue(
    scene: LaneScene, tableau: Tableau, summed: bool, width: int, tables: Tables
) -> Float[Array, "rows 14"]:
    """Rows of `SegmentEnds` of all legs, and one more.

    Lanes that are through with a leg are served one by one, with slices of a single row:
    XLA compiles a loop with a scatter as a list of kernels, which two threads hand to each
    other at every look. (Steps took 1.3 times as long, and both cores.)
    """
    step = jax.vmap(lambda task, motion: step_of_lane(scene, tableau, summed, task, motion))
    legs = tables.legs.shape[0]

    def waits(task: LaneTask, motion: LaneState) -> Bool[Array, " width"]:
        return (task.leg <= legs) & ~is_live(task, motion)

    def go_on(work: _Work) -> Bool[Array, ""]:
        return jnp.any(work.task.leg <= legs)

    def serve(lane: Int[Array, ""], work: _Work) -> _Work:
        both = work.task, work.motion
        task, motion = jax.tree_util.tree_map(lambda column: _row(column, lane), both)
        found = _with_row(work.found, task.leg, _report(task, motion))
        task, motion, fresh = _next_leg(tables, work.next_job, task, motion)
        # From the right of a kink on which the last leg ended.
        begin = field_of_lane(scene, task).point(motion.time, motion.tip)
        task, motion = jax.tree_util.tree_map(
            lambda column, row: _with_row(column, lane, row),
            both,
            (task, motion._replace(point=begin)),
        )
        return _Work(task, motion, work.next_job + fresh, found)

    def look(work: _Work) -> _Work:
        rank = jnp.cumsum(waits(work.task, work.motion))
        work = jax.lax.fori_loop(
            0, rank[-1], lambda k, work: serve(jnp.sum(rank <= k), work), work
        )
        task = work.task
        most = SETTINGS.idle * jnp.sum(task.leg <= legs)

        def goes(motion: LaneState) -> Bool[Array, ""]:
            return jnp.any(is_live(task, motion)) & (jnp.sum(waits(task, motion)) <= most)

        motion = jax.lax.while_loop(goes, lambda motion: step(task, motion), work.motion)
        return work._replace(motion=motion)

    found = jnp.full((legs + 1, len(SegmentEnds._fields)), jnp.nan)
    start = _Work(*_waiting(width, legs), jnp.zeros((), dtype=int), found)
    return jax.lax.while_loop(go_on, look, start).found
