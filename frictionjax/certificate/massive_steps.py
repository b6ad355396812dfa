"""The equation of a tip with mass in steps, linear near states that are known.

Radau IIA (`numerics.RADAU_WEIGHTS`), which forgets a speed that is forgotten within one
step.
`y' = u/G`, `u' = (f - eps^gamma eps u)/(m eps)`, y the tip in periods, `u = z'/eps`.
"""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from .._checks import Real
from .._compile import Program, in_chunks
from ..numerics import RADAU_PLACES, RADAU_WEIGHTS, inverse_of_three
from .forces import Force
from .settings import SETTINGS


class MassiveEquation(eqx.Module):
    """`m z'' + viscosity z' = f(t, z)`; `mass` in kg, `viscosity` in N s/m."""

    force: Force
    mass: Real
    viscosity: Real


class MassiveSteps(NamedTuple):
    """Columns of steps: start and length in s, the well from which tips are counted, in
    periods, and at the start and at the stages, (k,) and (k, 3), the tip and u in 1/s."""

    start: Any
    length: Any
    well: Any
    tip: Any
    speed: Any
    tips: Any
    speeds: Any


class SolvedStages(NamedTuple):
    """Stages that solve the linear equations, (k, 3), the last at the end of the step, and
    how they change with the start: by its tip and by its speed."""

    tips: Any
    speeds: Any
    tips_by_tip: Any
    speeds_by_tip: Any
    tips_by_speed: Any
    speeds_by_speed: Any


class _Rates(NamedTuple):
    """At the stages, (3,): of tip and speed, and how they change."""

    tip: Array
    speed: Array
    tip_by_tip: Array
    tip_by_speed: Array
    speed_by_tip: Array


def _rates(equation: MassiveEquation, well: Real, t: Array, y: Array, u: Array) -> _Rates:
    force, eps = equation.force, equation.force.eps

    def at(t: Array, y: Array) -> tuple:
        def pull(s: Array) -> tuple[Array, Array]:
            driven = force.driven(t, well, s)
            return driven.force, driven.stretch / eps

        return jax.jvp(pull, (y,), (jnp.ones_like(y),))

    (value, stretch), (slope, bend) = jax.vmap(at)(t, y)
    heavy = equation.mass * eps
    return _Rates(
        tip=u / stretch,
        speed=value / heavy - equation.viscosity / equation.mass * u,
        tip_by_tip=-u * bend / stretch**2,
        tip_by_speed=1 / stretch,
        speed_by_tip=slope / heavy,
    )


def _solved(equation: MassiveEquation, step: MassiveSteps) -> SolvedStages:
    """Newton's step for the stages of one step; speeds are eliminated."""
    times = step.start + jnp.asarray(RADAU_PLACES) * step.length
    weights = step.length * jnp.asarray(RADAU_WEIGHTS)
    rates = _rates(equation, step.well, times, step.tips, step.speeds)
    forgotten = equation.viscosity / equation.mass
    damped = inverse_of_three(jnp.eye(3) + forgotten * weights)
    pulled = damped @ (weights * rates.speed_by_tip[None])
    moved = weights * rates.tip_by_speed[None]
    bent = weights * rates.tip_by_tip[None]
    left = inverse_of_three(jnp.eye(3) - bent - moved @ pulled)

    def changes(tip: Array, speed: Array) -> tuple[Array, Array]:
        late = damped @ speed
        tips = left @ (tip + moved @ late)
        return tips, late + pulled @ tips

    one, none = jnp.ones(3), jnp.zeros(3)
    tips, speeds = changes(
        step.tip + weights @ rates.tip - step.tips,
        step.speed + weights @ rates.speed - step.speeds,
    )
    known = step.tips + tips, step.speeds + speeds
    return SolvedStages(*known, *changes(one, none), *changes(none, one))


@Program
def _all_solved(equation: MassiveEquation, *columns: Array) -> SolvedStages:
    return jax.vmap(lambda *row: _solved(equation, MassiveSteps(*row)))(*columns)


def solved_stages(equation: MassiveEquation, steps: MassiveSteps) -> SolvedStages:
    """Of all steps, each for itself; NumPy arrays out."""
    columns = tuple(np.asarray(c, float) for c in steps)
    return in_chunks(_all_solved, SETTINGS.steps, (equation,), columns)
