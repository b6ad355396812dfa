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
    over a grid that holds the inflections of H, so that H turns once in a cell at most,
    with the few cells in which it does split at the turning point.
    """
    if isinstance(potential, BristlePotential):
        a, alpha, profile = potential.a(), potential.alpha(), potential.profile

        def primitive(y: Real) -> Real:
            w = profile(y)
            return xi * (y + a * w) - alpha * w
    else:

        def primitive(y: Real) -> Real:
            return xi * y - potential.W(y)

    slope = jax.grad(primitive)
    edges = _with_inflections(slope, 2 * potential.points)
    values, slopes = jax.vmap(jax.value_and_grad(primitive))(edges)

    def variation(
        left: Array,
        right: Array,
        start: Array,
        end: Array,
        slope_start: Array,
        slope_end: Array,
    ) -> Array:
        turns = slope_start * slope_end < 0
        share = slope_start / jnp.where(turns, slope_start - slope_end, 1.0)
        secant = left + (right - left) * jnp.clip(share, 0.0, 1.0)

        def newton(_: Any, y: Real) -> Real:
            value, bend = jax.jvp(slope, (y,), (jnp.ones_like(y),))
            return jnp.clip(y - value / jnp.where(bend == 0, 1.0, bend), left, right)

        # H' is zero at the turn, so what is left of its place enters squared.
        place = jax.lax.stop_gradient(jax.lax.fori_loop(0, SETTINGS.newton, newton, secant))
        turn = primitive(place)
        split = jnp.abs(turn - start) + jnp.abs(end - turn)
        return jnp.where(turns, split, jnp.abs(end - start))

    pieces = jax.vmap(variation)(
        edges[:-1], edges[1:], values[:-1], values[1:], slopes[:-1], slopes[1:]
    )
    return jnp.sum(pieces)


def _with_inflections(slope: Callable[[Real], Real], cells: int) -> Array:
    """Grid of a period, each cell halved: where `slope'` has its zero, if it has one."""
    edges = jnp.arange(cells + 1) / cells
    bend = jax.grad(slope)
    bends = jax.vmap(bend)(edges)
    turns = bends[:-1] * bends[1:] < 0
    share = bends[:-1] / jnp.where(turns, bends[:-1] - bends[1:], 1.0)
    middle = edges[:-1] + jnp.where(turns, share, 0.5) / cells
    inner = jnp.stack([edges[:-1], middle], axis=1).ravel()
    return jax.lax.stop_gradient(jnp.append(inner, 1.0))
