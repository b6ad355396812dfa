"""The integral over a well behind K: a variation, exact but for rounding."""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
from jaxtyping import Array

from .._checks import Real
from ..model import AbstractPotential, BristlePotential
from .settings import SETTINGS


def well_variation(potential: AbstractPotential, xi: Real) -> Real:
    """`int_0^1 |xi - W'(Y)| dY` in N, to rounding.

    In the tip coordinate the integrand is `|xi (1 + a w') - alpha w'|`, whose inside is
    the derivative of `H = xi (y + a w) - alpha w`. So this is the variation of H: summed
    over a grid that holds the inflections of H, which are those of w whatever xi is, so
    that H turns once in a cell at most; with the few cells in which it does split at the
    turning point. (All of them split: eight times the Newton steps.)
    """
    height, a, alpha = _height_of(potential)

    def primitive(y: Real) -> Real:
        w = height(y)
        return xi * (y + a * w) - alpha * w

    slope = jax.grad(primitive)
    edges = _with_inflections(height, 2 * potential.points)
    heights, climbs = jax.vmap(jax.value_and_grad(height))(edges)
    values = xi * (edges + a * heights) - alpha * heights
    slopes = xi * (1 + a * climbs) - alpha * climbs
    turns = slopes[:-1] * slopes[1:] < 0
    whole = jnp.sum(jnp.abs(jnp.diff(values)))
    room = max(turns.size // SETTINGS.cells_a_turn, 2)
    cells = jnp.nonzero(turns, size=room, fill_value=turns.size)[0]
    there = cells < turns.size
    first = jnp.minimum(cells, turns.size - 1)
    ends = (edges[first], edges[first + 1]), (values[first], values[first + 1])
    steep = slopes[first], slopes[first + 1]
    extra = jax.vmap(lambda *cell: _by_splitting(primitive, slope, *cell))(
        *ends[0], *ends[1], *steep
    )
    return whole + jnp.sum(jnp.where(there, extra, 0.0))


def _height_of(potential: AbstractPotential) -> tuple[Callable[[Real], Real], Any, Any]:
    """w, a and alpha; of what has no bristle W itself, with a = 0 and alpha = 1."""
    if isinstance(potential, BristlePotential):
        return potential.profile, potential.a(), potential.alpha()
    return potential.W, 0.0, 1.0


def _by_splitting(
    primitive: Callable[[Real], Real],
    slope: Callable[[Real], Real],
    left: Real,
    right: Real,
    start: Real,
    end: Real,
    slope_start: Real,
    slope_end: Real,
) -> Real:
    """How much the variation grows when a cell in which H turns is split there."""
    apart = slope_start - slope_end
    share = slope_start / jnp.where(apart == 0, 1.0, apart)
    secant = left + (right - left) * jnp.clip(share, 0.0, 1.0)

    def newton(_: Any, y: Real) -> Real:
        value, bend = jax.jvp(slope, (y,), (jnp.ones_like(y),))
        return jnp.clip(y - value / jnp.where(bend == 0, 1.0, bend), left, right)

    # H' is zero at the turn, so what is left of its place enters squared.
    place = jax.lax.stop_gradient(jax.lax.fori_loop(0, SETTINGS.newton, newton, secant))
    turn = primitive(place)
    return jnp.abs(turn - start) + jnp.abs(end - turn) - jnp.abs(end - start)


def _with_inflections(height: Callable[[Real], Real], cells: int) -> Array:
    """Grid of a period, each cell halved: at the inflection of w, if it has one."""
    edges = jnp.arange(cells + 1) / cells
    bends = jax.vmap(jax.grad(jax.grad(height)))(edges)
    turns = bends[:-1] * bends[1:] < 0
    share = bends[:-1] / jnp.where(turns, bends[:-1] - bends[1:], 1.0)
    middle = edges[:-1] + jnp.where(turns, share, 0.5) / cells
    inner = jnp.stack([edges[:-1], middle], axis=1).ravel()
    return jax.lax.stop_gradient(jnp.append(inner, 1.0))
