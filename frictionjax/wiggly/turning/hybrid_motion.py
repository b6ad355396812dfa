"""A trajectory of a rod that turns over: phases one after the other, from stop to stop."""

from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from ..._checks import quiet_where_extreme, viscosity_of
from ..._compile import once_a_scene
from ...effects import NapFlip
from ...model import BristlePotential, Scene, tabulated_scene
from ...numerics import concatenated
from ...turning import BentForce, FlippingRod, SceneParts, bent_force, flipping_rod
from ..equation import (
    PullRange,
    Status,
    SteppedParts,
    StepPlan,
    plan_steps,
    pull_between,
)
from ..stepping import Control
from .phases import Begun, Ended, Steps, slide, turn
from .settings import SETTINGS


class MotionSteps(NamedTuple):
    """All steps of a motion, (steps,): when each begins and ends (s), the states there
    (m), slopes of a cubic between (m/s), the dissipation there (J), and the mode."""

    begin: np.ndarray
    end: np.ndarray
    z0: np.ndarray
    z1: np.ndarray
    slope0: np.ndarray
    slope1: np.ndarray
    lost0: np.ndarray
    lost1: np.ndarray
    mode: np.ndarray


class HybridMotion(NamedTuple):
    """At the times asked for, (n,): `z`, the `root` u and the `tip` p in m, `mode`,
    `dissipation` and `residual` in J. At the end `gap`, between two values of the
    dissipation, and `left`, the residual, in J. `made`: its steps, if asked for."""

    z: np.ndarray
    root: np.ndarray
    tip: np.ndarray
    mode: np.ndarray
    dissipation: np.ndarray
    residual: np.ndarray
    gap: float
    left: float
    status: int
    steps: int
    rejected: int
    tolerance: float
    made: MotionSteps | None = None


class _At(NamedTuple):
    """Now: in s, in a mode; `place` in periods of the tip in its side's frame, or, in
    between, of the state. `above`: z in m where the root is above the pinned tip, `foot`
    the tip's place in periods, `rod` the one in between."""

    time: float
    mode: int
    place: float
    level: float = 0.0
    foot: float = 0.0
    above: float = 0.0
    rod: BentForce | None = None


class _Course(NamedTuple):
    """What all phases share. `plans`: of slides, by side."""

    parts: SceneParts
    law: FlippingRod
    eps: float
    viscosity: float
    plans: dict[int, StepPlan]
    budget: int

    def control(self, mode: int) -> Control:
        """Of a mode's steps."""
        plan = self.plans[mode if mode else 1]
        if mode:
            return plan.control
        reach = SETTINGS.stride * self.law.reach / self.eps
        return plan.control._replace(reach=np.asarray(reach), pace=np.asarray(np.inf))


@quiet_where_extreme
def integrate_turning(
    scene: Scene,
    eps: float,
    gamma: float,
    *,
    effect: NapFlip,
    ts: Float[np.ndarray, " n"],
    accuracy: float,
    budget: int,
    until: float | None = None,
    noted: bool = False,
) -> HybridMotion:
    """Of a scene with known numbers, from z0 as the rod stands at first, to ts[-1].

    `until`: a later time in s to which it goes, at which `gap` is. `budget`: steps in all.
    `noted`: whether steps are wanted. Raises `ValueError` as `flipping_rod` does.
    """
    course = _course(scene, effect, eps, gamma, accuracy, budget)
    turns = tabulated_scene(scene, eps).turning_points
    if np.any(np.isnan(turns)):
        return _nothing(ts.size, Status.TOO_MANY_TURNS)
    end = ts[-1] if until is None else max(float(until), ts[-1])
    stops = np.unique(np.concatenate([[0.0], ts, [end], turns[turns < end]]))
    at = _At(0.0, 1, float(_start(course.parts, scene.z0, np.asarray(float(eps)))))
    rows = [_row(course, at)]
    sums = np.zeros(3)  # lost, viscous, residual
    lost = [sums]
    steps = rejected = code = 0
    made: list[MotionSteps] = []
    for stop in stops[1:]:
        while code == 0 and at.time < stop:
            ended, some = _phase(course, at, stop, steps)
            if noted:
                made.append(_made(course, at, some, float(sums[0])))
            sums = sums + np.array([ended.lost, ended.viscous, ended.residual])
            steps += int(ended.steps)
            rejected += int(ended.rejected)
            code = int(ended.code)
            at = _next(course, at, ended)
        rows.append(_row(course, at) if code == 0 else (np.nan, np.nan, 0))
        lost.append(sums if code == 0 else np.full(3, np.nan))
    asked = np.searchsorted(stops, ts)
    z, tip, mode = (np.array(column)[asked] for column in zip(*rows, strict=True))
    spent, _, residual = np.array(lost)[asked].T
    slip = eps * (course.law.standing.rho_with + course.law.standing.rho_against)
    if code == 0 and sums[2] > SETTINGS.residual * (slip + sums[1]):
        code = int(Status.UNBALANCED)
    return HybridMotion(
        z=z,
        root=z + course.law.reach,
        tip=tip,
        mode=mode,
        dissipation=spent,
        residual=residual,
        gap=float(abs(sums[0] - sums[1])) if code == 0 else np.nan,
        left=float(sums[2]) if code == 0 else np.nan,
        status=code,
        steps=steps,
        rejected=rejected,
        tolerance=float(course.plans[1].tolerance),
        made=concatenated(made) if made else None,
    )


def _nothing(count: int, status: Status) -> HybridMotion:
    none, modes = np.full(count, np.nan), np.zeros(count, int)
    return HybridMotion(
        *(none, none, none, modes, none, none),
        gap=np.nan,
        left=np.nan,
        status=int(status),
        steps=0,
        rejected=0,
        tolerance=np.nan,
    )


def _course(
    scene: Scene, effect: NapFlip, eps: float, gamma: float, accuracy: float, budget: int
) -> _Course:
    law = flipping_rod(scene, effect)
    tables = tabulated_scene(scene, eps)
    assert isinstance(tables.lane_potential, BristlePotential)
    rod: Any = scene.bristle
    parts = SceneParts(
        profile=tables.lane_potential.profile,
        rod=rod,
        support=tables.support,
        load=tables.load,
        reach=jnp.asarray(law.reach),
        critical=jnp.asarray(law.critical),
    )
    edges = jnp.asarray(
        np.append(np.insert(tables.turning_points, 0, 0.0), tables.duration)
    )
    numbers = edges, tables.duration, tables.z0, eps, gamma, accuracy
    plans = {}
    for side, slides in ((1, law.standing), (-1, law.turned)):
        rho = slides.rho_with, -slides.rho_against
        args = (float(side), *rho, *numbers)
        plans[side] = _planned(parts, *map(jnp.asarray, args))
    return _Course(parts, law, eps, float(viscosity_of(eps, gamma)), plans, budget)


@once_a_scene
def _planned(
    parts: SceneParts, side, rho_plus, rho_minus, edges, duration, z0, eps, gamma, accuracy
) -> StepPlan:
    held, load = parts.held(side), parts.pulled(side)
    pull: PullRange = pull_between(load, held, edges, rho_plus, rho_minus)
    start = side * (z0 + held.shift)
    stepped = SteppedParts(parts.potential(side), held, duration, start)
    return plan_steps(stepped, eps, gamma, accuracy, pull)


def _phase(course: _Course, at: _At, stop: float, steps: int) -> tuple[Ended, Steps]:
    control = course.control(at.mode)
    well = np.rint(at.place)
    begun = Begun(
        origin=np.asarray(at.time),
        well=np.asarray(well),
        place=np.asarray(at.place - well),
        stop=np.asarray(stop - at.time),
        control=control,
        level=np.asarray(at.level),
        budget=np.asarray(float(course.budget - steps)),
    )
    cell = course.parts, np.asarray(course.eps), np.asarray(course.viscosity)
    if at.mode:
        found, made = slide(*cell, np.asarray(float(at.mode)), begun)
    else:
        found, made = turn(*cell, at.rod, np.asarray(at.above), begun)
    known = Ended(*(float(value) for value in found))
    # A stop that is reached is that time, to the last digit.
    reached = known.out == 0 and known.time == float(begun.stop)
    time = stop if reached else at.time + known.time
    return known._replace(time=time, place=known.place + well), made


def _made(course: _Course, at: _At, some: Steps, lost: float) -> MotionSteps:
    """Steps of a phase as those of the state, with all that was lost before."""
    count, mode = int(some.count), at.mode
    side, shift = (mode, (1 - mode) * course.law.reach) if mode else (1, 0.0)
    _, time, state, slope0, slope1, spent = (
        np.atleast_1d(np.asarray(c))[:count] for c in some
    )
    first = _row(course, at)[0]
    end, z1, lost1 = at.time + time, side * state - shift, lost + spent
    return MotionSteps(
        begin=np.append(at.time, end)[:-1],
        end=end,
        z0=np.append(first, z1)[:-1],
        z1=z1,
        slope0=side * slope0,
        slope1=side * slope1,
        lost0=np.append(lost, lost1)[:-1],
        lost1=lost1,
        mode=np.full(count, mode),
    )


def _next(course: _Course, at: _At, ended: Ended) -> _At:
    """Where it is after a phase, in the mode that follows."""
    there = at._replace(time=ended.time, place=ended.place, level=ended.level)
    if ended.out == 0:
        return there
    if at.mode:
        return _pinned(course, there)
    mode = int(ended.out)
    return _At(ended.time, mode, mode * at.foot)


def _pinned(course: _Course, at: _At) -> _At:
    """In between, at the end that the rod comes from."""
    z, height = (float(v) for v in _stance(course.parts, *_numbers(course, at)))
    bent = course.law.bent
    rod = bent_force(bent._replace(height=bent.height - height))
    above = z - at.mode * float(rod.reach)
    return _At(at.time, 0, z / course.eps, foot=at.mode * at.place, above=above, rod=rod)


def _numbers(course: _Course, at: _At) -> tuple[Any, ...]:
    return tuple(np.asarray(float(v)) for v in (at.mode, at.place, course.eps))


@once_a_scene
def _stance(parts: SceneParts, side: Any, place: Any, eps: Any) -> tuple[Any, Any]:
    """The state z, and the height of the surface under the tip, in m."""
    potential = parts.potential(side)
    state = eps * place + potential.offset(place, eps)
    return parts.held(side).place(state), eps * potential.profile(place)


@once_a_scene
def _start(parts: SceneParts, z0: Any, eps: Any) -> Any:
    """Where the tip of the rod as it stands at first is, in periods."""
    number, inside = parts.potential(jnp.ones_like(eps)).tip(z0, eps)
    return number + inside


def _row(course: _Course, at: _At) -> tuple[float, float, int]:
    """State and tip in m, and the mode."""
    if at.mode == 0:
        return course.eps * at.place, course.eps * at.foot, 0
    z, _ = _stance(course.parts, *_numbers(course, at))
    return float(z), course.eps * at.mode * at.place, at.mode
