"""Derivatives where a time asked for is a turning point of the load, or a rounding away."""

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from ..coefficients import Coefficients

# Of a turning point, relative: what `Triangle` sees as its corner is 12 roundings wide.
_ROUNDING = 16 * float(np.finfo(np.float64).eps)
_ON_EDGE = 1e-12  # of the state: how close to the edge of its strip it is on it


@jax.custom_jvp
def with_slopes_of(value: Array, moving: Array) -> Array:
    """`value` itself, with all derivatives of `moving`, which is the same but for rounding.

    Where there are no derivatives nothing is computed for them. (As a sum with
    `moving - stop_gradient(moving)` XLA fused other loops, and 11% of the values of a
    limit changed by a rounding.)
    """
    return value


@with_slopes_of.defjvp
def _along(primals: tuple, tangents: tuple) -> tuple[Array, Array]:
    return with_slopes_of(*primals), tangents[1]


def times_that_move(
    ts: Float[Array, " n"], turns: Float[Array, " turns"]
) -> tuple[Float[Array, " n"], Bool[Array, " n"]]:
    """The times in s, or the turning point that is one of them, and where there is one.

    A clip at a time that stays, with the slope right of a corner that moves away, is one
    that no solution makes: dissipation over a period of a `Triangle` had a derivative by
    the period of 0.14 J/s for -0.21, and of a `Sine` a second one of -0.57 J/s^2 for 0.22.
    A clip at the moving corner is made twice, which changes nothing.
    """
    if not turns.size:  # of a ramp
        return ts, jnp.zeros(ts.shape, bool)
    last = turns.shape[0] - 1
    after = jnp.searchsorted(turns, ts, method="sort")  # no loop beside that of the clips
    times, beside = ts, jnp.zeros(ts.shape, bool)
    # The first of several wins: what fills the room comes last, and does not move.
    for index in (jnp.minimum(after, last), jnp.maximum(after - 1, 0)):
        near = jnp.abs(ts - turns[index]) <= _ROUNDING * turns[index]
        times, beside = jnp.where(near, turns[index], times), beside | near
    return times, beside


def at_times_that_stay(
    z: Float[Array, " n"],
    dissipation: Float[Array, " n"],
    slopes: Float[Array, " n"],
    strips: tuple[Array, Array],
    strips_of_corners: tuple[Array, Array],
    found: Coefficients,
) -> tuple[Float[Array, " n"], Float[Array, " n"]]:
    """State (m) and dissipation (J) at times that stay, of those at corners that move.

    As if the corner came first: on the edge of its strip (m) that goes on ahead, where the
    load has `slopes` (N/s), else at rest. That is a derivative from one side.
    """
    stays = z
    sides = (1, found.rho_plus), (-1, found.rho_minus)
    for (sign, rho), edge, corner in zip(sides, strips, strips_of_corners, strict=True):
        width = _ON_EDGE * (jnp.abs(z) + jnp.abs(corner))
        goes_on = (sign * (z - corner) <= width) & (sign * slopes > 0)
        stays = jnp.where(goes_on, edge, stays)
        dissipation = dissipation + jnp.where(goes_on, rho * (edge - z), 0.0)
    return stays, dissipation
