"""A trajectory of a rod that turns over: phases one after the other, from stop to stop."""

from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from ..._checks import quiet_where_extreme, viscosity_of
from ..._compile import Program
from ...effects import NapFlip
from ...model import BristlePotential, Scene, tabulated_scene
from ...turning import BentForce, FlippingRod, bent_force, flipping_rod
from ..equation import (
    PullRange,
    Status,
    SteppedParts,
    StepPlan,
    plan_steps,
    pull_between,
)
from ..stepping import Control
from .phases import Begun, Ended, slide, turn
from .settings import SETTINGS
from .sides import SceneParts


class HybridMotion(NamedTuple):
    """At the times asked for, (n,): `z` and the `root` u in m, `mode`, `dissipation` and
    `residual` in J. `gap`: between two values of the dissipation at the end, in J."""

    z: np.ndarray
    root: np.ndarray
    mode: np.ndarray
    dissipation: np.ndarray
    residual: np.ndarray
    gap: float
    status: int
    steps: int
    rejected: int
    tolerance: float


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
) -> HybridMotion:
    """Of a scene with known numbers, from z0 as the rod stands at first, to ts[-1].

    `budget`: steps in all. Raises `ValueError` as `flipping_rod` does.
    """
    course = _course(scene, effect, eps, gamma, accuracy, budget)
    turns = tabulated_scene(scene, eps).turning_points
    if np.any(np.isnan(turns)):
        return _nothing(ts.size, Status.TOO_MANY_TURNS)
    stops = np.unique(np.concatenate([[0.0], ts, turns[turns < ts[-1]]]))
    number, inside = course.parts.potential(jnp.ones(())).tip(scene.z0, eps)
    at = _At(0.0, 1, float(number + inside))
    rows = [_row(course, at)]
    sums = np.zeros(3)  # lost, viscous, residual
    lost = [sums]
    steps = rejected = code = 0
    for stop in stops[1:]:
        while code == 0 and at.time < stop:
            ended = _phase(course, at, stop, steps)
            sums = sums + np.array([ended.lost, ended.viscous, ended.residual])
            steps += int(ended.steps)
            rejected += int(ended.rejected)
            code = int(ended.code)
            at = _next(course, at, ended)
        rows.append(_row(course, at) if code == 0 else (np.nan, 0))
        lost.append(sums if code == 0 else np.full(3, np.nan))
    asked = np.searchsorted(stops, ts)
    z, mode = (np.array(column)[asked] for column in zip(*rows, strict=True))
    spent, viscous, residual = np.array(lost)[asked].T
    slip = eps * (course.law.standing.rho_with + course.law.standing.rho_against)
    if code == 0 and residual[-1] > SETTINGS.residual * (slip + viscous[-1]):
        code = int(Status.UNBALANCED)
    return HybridMotion(
        z=z,
        root=z + course.law.reach,
        mode=mode,
        dissipation=spent,
        residual=residual,
        gap=float(abs(spent[-1] - viscous[-1])),
        status=code,
        steps=steps,
        rejected=rejected,
        tolerance=float(course.plans[1].tolerance),
    )


def _nothing(count: int, status: Status) -> HybridMotion:
    none, modes = np.full(count, np.nan), np.zeros(count, int)
    return HybridMotion(none, none, modes, none, none, np.nan, int(status), 0, 0, np.nan)


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


@Program
def _planned(
    parts: SceneParts, side, rho_plus, rho_minus, edges, duration, z0, eps, gamma, accuracy
) -> StepPlan:
    held, load = parts.held(side), parts.pulled(side)
    pull: PullRange = pull_between(load, held, edges, rho_plus, rho_minus)
    start = side * (z0 + held.shift)
    stepped = SteppedParts(parts.potential(side), held, duration, start)
    return plan_steps(stepped, eps, gamma, accuracy, pull)


def _phase(course: _Course, at: _At, stop: float, steps: int) -> Ended:
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
        found = slide(*cell, np.asarray(float(at.mode)), begun)
    else:
        found = turn(*cell, at.rod, np.asarray(at.above), begun)
    known = Ended(*(float(value) for value in found))
    # A stop that is reached is that time, to the last digit.
    time = stop if known.out == 0 else at.time + known.time
    return known._replace(time=time, place=known.place + well)


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


@Program
def _stance(parts: SceneParts, side: Any, place: Any, eps: Any) -> tuple[Any, Any]:
    """The state z, and the height of the surface under the tip, in m."""
    potential = parts.potential(side)
    state = eps * place + potential.offset(place, eps)
    return parts.held(side).place(state), eps * potential.profile(place)


def _row(course: _Course, at: _At) -> tuple[float, int]:
    if at.mode == 0:
        return course.eps * at.place, 0
    return float(_stance(course.parts, *_numbers(course, at))[0]), at.mode
