"""Trajectory at the times of a trace, and its derivative by numbers of the profile."""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int

from ..._checks import Real
from ..._compile import Program
from ...model import BristlePotential, Scene
from ...profiles import AbstractProfile
from ...wiggly import (
    RODAS5P,
    ControlState,
    Linearised,
    StepPlan,
    TipField,
    field_of,
    judge,
    plan_steps,
    rosenbrock_step,
    step_of,
)
from .waves import Bumped, WaveProfile

_STEPS = 2**19  # at most: some 20 s
# Of a step, in periods. Iterates have ripples of small harmonics, on whose branches a
# quarter is 0.01 or less: steps were 2.6 to 3.2 times as many, and samples outside slips
# the same to 6e-5 eps at the accuracy 1e-3 (45 surfaces, three eps and gamma).
_LEAST_REACH = 0.04
_TABLEAU = RODAS5P


class Flow(NamedTuple):
    """What the dynamics give at the times: `z` in m, `speed` z' in m/s, shapes (n,).

    `by`: dz by the unknown numbers of the profile, (unknowns, n), in m. `steps`: tried.
    NaN from where the integration gave up.
    """

    z: Float[Array, " n"]
    speed: Float[Array, " n"]
    by: Float[Array, "unknowns n"]
    steps: Int[Array, ""]


def _step(field: TipField, t: Real, y: Real, length: Real) -> tuple[Real, Real]:
    """One step of Rodas5P, and its error estimate."""
    start = Linearised(*field.point(t, y)[:3])
    end, stages = rosenbrock_step(_TABLEAU, field.velocity, start, t, length, y)
    return end, stages[-1]


class _Front(NamedTuple):
    t: Real
    y: Real
    control: ControlState
    steps: Int[Array, ""]


def _march(field: TipField, plan: StepPlan, tip: Real, stops: Array) -> tuple[Array, Array]:
    """Tip at every stop, and steps tried. Step lengths are no function of the profile."""

    def to_stop(front: _Front, stop: Real) -> tuple[_Front, Real]:
        def length_of(front: _Front) -> Real:
            return step_of(front.control.level, plan.first_step)

        def under_way(front: _Front):
            alive = (front.steps < _STEPS) & (length_of(front) > plan.shortest_step)
            return (front.t < stop) & alive

        def advance(front: _Front) -> _Front:
            length = length_of(front)
            last = front.t + 1.0001 * length >= stop
            length = jnp.where(last, stop - front.t, length)
            y, error = _step(field, front.t, front.y, length)
            way, error = jax.lax.stop_gradient((jnp.abs(y - front.y), jnp.abs(error)))
            good, after = judge(
                _TABLEAU.order,
                plan.control,
                front.control,
                step=length,
                moved=way,
                error=error,
                cut=last,
            )
            end = jnp.where(last, stop, front.t + length)
            return _Front(
                jnp.where(good, end, front.t),
                jnp.where(good, y, front.y),
                after,
                front.steps + 1,
            )

        front = jax.lax.while_loop(under_way, advance, front)
        return front, front.y + jnp.where(front.t < stop, jnp.nan, 0.0)

    start = _Front(jnp.zeros_like(tip), tip, ControlState(), jnp.asarray(0))
    last, tips = jax.lax.scan(to_stop, start, stops)
    return tips, last.steps


def _start(profile: AbstractProfile, scene, eps, gamma) -> Real:
    """The tip at z0."""
    return field_of(with_profile(scene, profile), eps, gamma).start(scene.z0)


def _led(field: TipField, tip: Real) -> Real:
    """A tip at a fixed state: one Newton step that moves nothing carries its derivative.

    By the root's own rule JAX 0.12 takes a start for one that depends on the way, and so
    integrates once for each.
    """
    state, stretch = jax.jvp(field.state, (tip,), (jnp.ones_like(tip),))
    return tip - (state - jax.lax.stop_gradient(state)) / stretch


def _states(profile: AbstractProfile, start: Real, scene, eps, gamma, ts, plan):
    """`z` at the times, and beside it the speed and the steps. `start`: of the tip."""
    scene = with_profile(scene, profile)
    field = field_of(scene, eps, gamma)
    turns = jnp.clip(scene.turning_points(), 0.0, ts[-1])
    times = jnp.concatenate([ts, turns])
    order = jnp.argsort(times)
    tips, steps = _march(field, plan, _led(field, start), times[order])
    tips = tips[jnp.argsort(order)[: ts.shape[0]]]
    force, _ = jax.vmap(field.driving_force)(ts, tips)
    return jax.vmap(field.state)(tips), (force / field.viscosity, steps)


def with_profile(scene: Scene, profile: AbstractProfile) -> Any:
    """The scene on another surface, unchecked."""
    assert isinstance(scene.potential, BristlePotential)
    potential = BristlePotential(profile, scene.potential.bristle)
    return eqx.tree_at(lambda s: s.potential, scene, potential)


def waves_of_numbers(numbers: Array) -> WaveProfile:
    """The series of cos and sin, one after the other."""
    return WaveProfile(*jnp.split(numbers, 2))


@Program
def flow(numbers, scene, eps, gamma, ts, plan) -> Flow:
    """The trajectory and its derivative by the coefficients of the series."""
    start = _start(waves_of_numbers(numbers), scene, eps, gamma)

    def along(way: Array) -> tuple:
        def states(numbers: Array) -> tuple:
            return _states(waves_of_numbers(numbers), start, scene, eps, gamma, ts, plan)

        return jax.jvp(states, (numbers,), (way,), has_aux=True)

    # Values do not depend on the way: one integration carries all tangents.
    ways = jnp.eye(numbers.shape[0])
    z, by, (speed, steps) = jax.vmap(along, out_axes=(None, 0, None))(ways)
    return Flow(z, speed, by, steps)


@Program
def bumped_flow(centres, width, numbers, scene, eps, gamma, ts, plan) -> Flow:
    """The trajectory and its derivative by the sizes of local bumps at the centres."""
    waves = waves_of_numbers(numbers)
    start = _start(waves, scene, eps, gamma)

    def along(centre: Array) -> tuple:
        def states(size: Array) -> tuple:
            profile = Bumped(waves, size, centre, width)
            return _states(profile, start, scene, eps, gamma, ts, plan)

        return jax.jvp(states, (jnp.zeros(()),), (jnp.ones(()),), has_aux=True)

    z, by, (speed, steps) = jax.vmap(along, out_axes=(None, 0, None))(centres)
    return Flow(z, speed, by, steps)


@Program
def plan_of(numbers, scene, eps, gamma, accuracy) -> StepPlan:
    """Step control on the surface with these coefficients."""
    plan = plan_steps(with_profile(scene, waves_of_numbers(numbers)), eps, gamma, accuracy)
    return plan._replace(reach=jnp.maximum(plan.reach, _LEAST_REACH))
