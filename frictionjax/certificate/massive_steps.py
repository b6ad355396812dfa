"""The equation of a tip with mass in steps, linear near states that are known.

Radau IIA with three stages, of order 5, which forgets a speed that is forgotten within one
step (E. Hairer and G. Wanner, Solving Ordinary Differential Equations II, section IV.8).
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
from .forces import Force
from .settings import SETTINGS

_ROOT = 6**0.5
PLACES = np.array([(4 - _ROOT) / 10, (4 + _ROOT) / 10, 1.0])
"""Of the stages in a step."""
_WEIGHTS = np.array(
    [
        [(88 - 7 * _ROOT) / 360, (296 - 169 * _ROOT) / 1800, (-2 + 3 * _ROOT) / 225],
        [(296 + 169 * _ROOT) / 1800, (88 + 7 * _ROOT) / 360, (-2 - 3 * _ROOT) / 225],
        [(16 - _ROOT) / 36, (16 + _ROOT) / 36, 1 / 9],
    ]
)


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


def _inverse(m: Array) -> Array:
    """Of (3, 3), by cofactors: lanes side by side, where LAPACK takes one at a time."""
    first = jnp.cross(m[:, 1], m[:, 2])
    second = jnp.cross(m[:, 2], m[:, 0])
    third = jnp.cross(m[:, 0], m[:, 1])
    return jnp.stack([first, second, third]) / jnp.dot(m[:, 0], first)


def _solved(equation: MassiveEquation, step: MassiveSteps) -> SolvedStages:
    """Newton's step for the stages of one step; speeds are eliminated."""
    times = step.start + jnp.asarray(PLACES) * step.length
    weights = step.length * jnp.asarray(_WEIGHTS)
    rates = _rates(equation, step.well, times, step.tips, step.speeds)
    forgotten = equation.viscosity / equation.mass
    damped = _inverse(jnp.eye(3) + forgotten * weights)
    pulled = damped @ (weights * rates.speed_by_tip)
    moved = weights * rates.tip_by_speed
    left = _inverse(jnp.eye(3) - weights * rates.tip_by_tip - moved @ pulled)

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
