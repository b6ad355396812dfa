"""One lane: a short integration of the wiggly system, step by step, along a guide."""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Int

from ..._checks import Real
from ...loads import AbstractPull
from ...model import AbstractPotential
from ...supports import AbstractSupport
from ..equation import (
    Balance,
    Point,
    Status,
    TipField,
    advance,
    arrival,
    slopes_between,
)
from ..rosenbrock import Linearised, Tableau, rosenbrock_step
from ..stepping import (
    SETTINGS,
    Control,
    ControlState,
    StepVerdict,
    judge,
    materialise,
    step_of,
)
from .fold_steps import foothold, pause_of
from .running_extrema import Extent, Guide, StepCurve, widened

_LOWEST_LEVEL = SETTINGS.lowest_octave * SETTINGS.per_octave


class LaneCells(NamedTuple):
    """What all lanes of a cell share, shape (cells,): eps, eps^gamma and step control."""

    eps: Any
    viscosity: Any
    first_step: Any
    tolerance: Any
    loosest: Any
    pace: Any
    reach: Any

    @property
    def control(self) -> Control:
        """What steers their steps."""
        return Control(*self[2:])


class LaneScene(eqx.Module):
    """What a lane simulates: the parts of the field, without the times of the scene.

    `load`: what of it is not straight on legs; the rest is in their rows.
    `rho_plus`, `rho_minus`: pulls (N) on the edges of the strip.
    """

    potential: AbstractPotential
    support: AbstractSupport
    load: AbstractPull
    rho_plus: Any
    rho_minus: Any


class LaneTask(NamedTuple):
    """What stays the same on a leg; `stop` in s since `origin`, `budget` in steps.

    `past_leg`: where the legs of its job end. `left`: steps for them. `level`, `rate`: of
    the straight part of the load, N where the leg starts and N/s.
    """

    leg: Int[Array, ""]
    past_leg: Int[Array, ""]
    cell: LaneCells
    origin: Real
    guide: Guide
    well: Real
    stop: Real
    budget: Real
    left: Real
    level: Real
    rate: Real


class LaneState(NamedTuple):
    """What moves on a leg; `time` in s since the task's origin, `unseen`: what rounding has
    left out of it."""

    tip: Real
    time: Real
    unseen: Real
    point: Point
    control: ControlState
    sums: Balance
    extent: Extent
    steps: Real
    rejected: Real
    code: Real


class _LegLoad(AbstractPull):
    """A load on one leg: `bent` and a straight line from `start` (s) on."""

    bent: AbstractPull
    start: Real
    level: Real
    rate: Real

    def __call__(self, t: Real) -> Real:
        return self.bent(t) + (self.level + self.rate * (t - self.start))

    def slope(self, t: Real) -> Real:
        return self.bent.slope(t) + self.rate


def field_of_lane(scene: LaneScene, task: LaneTask) -> TipField:
    start = task.origin + task.guide.start
    load = _LegLoad(scene.load, start, task.level, task.rate)
    cell, parts = task.cell, (scene.potential, scene.support, load)
    return TipField(*parts, cell.eps, cell.viscosity, well=task.well, origin=task.origin)


def keep(condition: Bool[Array, "*lanes"], new: Any, old: Any) -> Any:
    return jax.tree_util.tree_map(lambda a, b: jnp.where(condition, a, b), new, old)


def is_live(task: LaneTask, motion: LaneState) -> Bool[Array, "*lanes"]:
    """Whether neither the stop nor a failure has made an end of it."""
    return (motion.time < task.stop) & (motion.code == 0)


def _try_step(
    scene: LaneScene, tableau: Tableau, task: LaneTask, motion: LaneState
) -> tuple[LaneState, Real, StepVerdict]:
    """Where a step ends, sums and extremes left as they are, its length and its verdict."""
    field = field_of_lane(scene, task)
    full = step_of(motion.control.level, task.cell.first_step)
    pause = pause_of(motion.point, task.origin + motion.time, _drag(task, motion.point))
    waits = full < pause
    full = jnp.where(waits, pause, full)
    left = task.stop - motion.time - motion.unseen
    cut = full >= left
    step = jnp.where(is_live(task, motion), jnp.where(cut, left, full), 1.0)
    step = materialise(step, task.cell.eps)
    point, width = motion.point, scene.rho_plus - scene.rho_minus
    place = foothold(step, point, task.origin + motion.time, _drag(task, point), width)
    start = Linearised(place.velocity(), *motion.point[1:3])
    tip, stages = rosenbrock_step(
        tableau, field.velocity, start, motion.time, step, motion.tip
    )
    tip = jnp.where(waits, motion.tip, tip)
    time, unseen = _later(motion, step)
    time = jnp.where(cut, task.stop, time)
    end = materialise(field.point(time, tip), task.cell.eps)
    error = jnp.where(waits, 0.0, place.beyond_rounding(jnp.abs(stages[-1]), end))
    way, cell = tip - motion.tip, task.cell
    uneven = place.uneven(end, way, cell.pace, cell.tolerance)
    judged = judge(
        tableau.order,
        task.cell.control,
        motion.control,
        step=step,
        moved=jnp.abs(way),
        error=error,
        cut=cut,
        overgrown=jnp.maximum(place.overgrown(), uneven),
        shifts=place.resolves(end),
    )
    unseen = jnp.where(cut, 0.0, unseen)
    return motion._replace(tip=tip, time=time, unseen=unseen, point=end), step, judged


def step_of_lane(
    scene: LaneScene, tableau: Tableau, summed: bool, task: LaneTask, motion: LaneState
) -> LaneState:
    """One step of one lane; a lane that has reached its stop stays as it is.

    `summed`: whether energies and extremes of the way are added up. (Extremes alone would
    be a loop of their own to compile, for steps that are little shorter.)
    """
    field = field_of_lane(scene, task)
    after, step, judged = _try_step(scene, tableau, task, motion)
    live = is_live(task, motion)
    accepted = judged.accepted & live
    if summed:
        tip = jnp.where(accepted, after.tip, motion.tip)
        arrived = arrival(field, motion.time, step, after.point)
        sums = advance(
            field,
            motion.sums,
            motion.time,
            step,
            motion.tip,
            tip,
            motion.point,
            arrived,
            task.guide.__call__,
        )
        extent = _extent(scene, task, motion, step, after.time, tip, arrived, sums)
        after = after._replace(sums=sums, extent=extent)
    failure = jnp.where(judged.after.level < _LOWEST_LEVEL, float(Status.NOT_FINITE), 0.0)
    failure = jnp.where(motion.steps >= task.budget, float(Status.MAX_STEPS), failure)
    return keep(accepted, after, motion)._replace(
        control=keep(live, judged.after, motion.control),
        steps=motion.steps + live,
        rejected=motion.rejected + (live & ~judged.accepted),
        code=jnp.where(live, failure, motion.code),
    )


def _later(motion: LaneState, step: Real) -> tuple[Real, Real]:
    """The time after a step, and what rounding leaves out of it.

    Short steps add up: at a fold, eps = 1e-12, the load was never seen to go on, where
    every step was shorter than the spacing of floats at t.
    """
    gone = motion.unseen + step
    time = motion.time + gone
    return time, gone - (time - motion.time)


def _drag(task: LaneTask, point: Point) -> Real:
    """N over periods a second."""
    return task.cell.viscosity * task.cell.eps * point.stretch


def _extent(
    scene: LaneScene,
    task: LaneTask,
    motion: LaneState,
    step: Real,
    time: Real,
    tip: Real,
    end: Point,
    sums: Balance,
) -> Extent:
    guide, cell = task.guide, task.cell
    slopes = slopes_between(motion.point, end, step, tip - motion.tip)

    def curves(t: Real, point: Point, slope: Real, spent: Real) -> tuple:
        """Values and rates at one end of the step of what has extremes."""
        place, pace = guide(t), guide.slope(t)
        speed = cell.eps * point.stretch * slope
        beyond = spent - guide.friction * guide.way(t)
        rate = cell.viscosity * speed**2 - guide.friction * pace
        outside = _outside(scene, cell, point, place, speed)
        return (point.state - place, speed - pace), outside, (beyond, rate)

    begun = curves(motion.time, motion.point, slopes[0], motion.sums.viscous)
    ended = curves(time, end, slopes[1], sums.viscous)
    courses = (
        StepCurve(*zip(*both, strict=True)) for both in zip(begun, ended, strict=True)
    )
    return widened(motion.extent, step, *courses)


def _outside(
    scene: LaneScene, cell: LaneCells, point: Point, guide: Real, speed: Real
) -> tuple[Real, Real]:
    """How far z is outside the strip in m, and how fast it goes away.

    Inside not above 0, and its size means nothing.
    """
    support, z = scene.support, point.state
    here = support.force(z)
    under, over = point.load - scene.rho_plus, point.load - scene.rho_minus
    # By forces: only the edge that z is nearer to is near enough to be found from it, as
    # the other may be where the support is far softer or stiffer.
    below = under - here > here - over
    held = jnp.where(below, under, over)
    # Where the guide slides it is the edge; where it rests, the edge is near z outside.
    off = jnp.abs(held - support.force(guide)) <= jnp.abs(held - here)
    edge = support.state_near(held, jnp.where(off, guide, z))
    # An edge that z has passed is between them, however soft the support is at the guide.
    between = jnp.clip(edge, jnp.minimum(guide, z), jnp.maximum(guide, z))
    edge = support.state_near(held, between)
    gap = jnp.where(below, edge - z, z - edge)
    gap = jnp.where(jnp.maximum(under - here, here - over) > 0, gap, jnp.minimum(gap, 0.0))
    slope = point.by_time * cell.viscosity * cell.eps * point.stretch
    away = slope / support.stiffness_at(edge) - speed
    # The guide is inside.
    return jnp.minimum(gap, jnp.abs(guide - z)), jnp.where(below, away, -away)
