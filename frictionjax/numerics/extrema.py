"""Maximum and minimum of a smooth 1-periodic function, differentiable in its parameters."""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int

from .._checks import Real
from .roots import find_root
from .settings import SETTINGS


class Extrema(NamedTuple):
    """Places (in [-1, 2]) and values of the largest maximum and the smallest minimum."""

    argmax: Real
    max: Real
    argmin: Real
    min: Real


def slope_of(fn: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """`fn'` of an `fn` that acts on each entry."""
    return lambda y: jax.jvp(fn, (y,), (jnp.ones_like(y),))[1]


def _carry(fn: Callable[[Real], Real], side: Real, frozen: Real) -> Real:
    """One Newton step that moves nothing carries the derivative of the place.

    So second derivatives of the value are right too; its first is the envelope theorem.
    """
    slope, curve = jax.jvp(slope_of(fn), (frozen,), (jnp.ones_like(frozen),))
    known = -side * curve > SETTINGS.bent * jnp.abs(fn(frozen))
    step = jnp.where(known, slope / jnp.where(known, curve, 1.0), 0.0)
    return frozen - (step - jax.lax.stop_gradient(step))


def periodic_extrema(
    fn: Callable[[Real], Real], points: int, differentiable: bool = True
) -> Extrema:
    """Extrema of the 1-periodic `fn`: dense scan, then Newton on `fn'`.

    `points` a period must resolve `fn`; the scan only has to pick the right bump. Both
    sides go through the same loop: half the time to trace it. Places that need not be
    `differentiable` are the same numbers, without two more derivatives to trace.
    """
    fn = jax.jit(fn)  # each of its derivatives is traced once
    grid = jnp.arange(points) / points
    sides = jnp.array([1.0, -1.0])
    values = jax.lax.stop_gradient(jax.vmap(fn)(grid))
    frozen = jax.lax.stop_gradient(_summits(fn, grid, sides[:, None] * values[None]))
    places = frozen
    if differentiable:
        places = jax.vmap(lambda side, place: _carry(fn, side, place))(sides, frozen)
    (top, bottom), (high, low) = places, jax.vmap(fn)(places)
    return Extrema(top, high, bottom, low)


def _summits(
    fn: Callable[[Real], Real], grid: Float[Array, " n"], values: Float[Array, "2 n"]
) -> Float[Array, "2"]:
    """Places of the largest maxima of `fn` and `-fn`: the highest bumps, each polished.

    `values`: of both on the grid. Samples of two bumps can stand in the wrong order by a
    part in 1000, tops of parabolas through three of them by one in 1e5. (In the order of
    samples the highest of 100 bumps was none of eight.)
    """
    right, left = jnp.roll(values, -1, axis=1), jnp.roll(values, 1, axis=1)
    bump = (values >= left) & (values >= right)
    bent = 2 * values - left - right
    top = values + (right - left) ** 2 / (8 * jnp.where(bent > 0, bent, jnp.inf))
    tops, best = _highest(jnp.where(bump, top, -jnp.inf))
    known = jnp.take_along_axis(values, best, axis=1)
    heights = jnp.where(jnp.isfinite(tops), known, -jnp.inf)
    # What is no bump has no root to be found: 45 halvings that all others wait for.
    scanned, width = grid[best], jnp.where(jnp.isfinite(heights), 1 / grid.shape[0], 0.0)
    side = jnp.array([[1.0], [-1.0]])
    every = jax.vmap(jax.vmap(fn))
    slope = slope_of(every)
    roots = find_root(lambda y: -side * slope(y), scanned - width, scanned + width)
    polished = side * every(roots)
    # Flat tops and unresolved kinks: a scan point that beats the root is kept.
    better = polished >= heights
    found = jnp.where(better, roots, scanned)
    chosen = jnp.argmax(jnp.where(better, polished, heights), axis=1)
    return jnp.take_along_axis(found, chosen[:, None], axis=1)[:, 0]


def _highest(
    values: Float[Array, "2 n"],
) -> tuple[Float[Array, "2 bumps"], Int[Array, "2 bumps"]]:
    """The largest entries of each row and where they are; of neighbours the largest only.

    `jax.lax.top_k` sorts whole rows, 0.4 ms of 0.7 for 1024 points. Of a quarter of them it
    takes 0.1; a scan over argmax the same.
    """
    count = values.shape[1]
    near = SETTINGS.near
    near = near if count % near == 0 and count > 16 * near else 1
    parts = values.reshape(2, -1, near)
    heights, part = jax.lax.top_k(jnp.max(parts, axis=2), SETTINGS.bumps)
    inside = jnp.take_along_axis(jnp.argmax(parts, axis=2), part, axis=1)
    return heights, near * part + inside


def smallest(values: Float[Array, "*shape"]) -> Real:
    """The minimum, NaN where any value is: `jnp.min` loses NaNs of long arrays."""
    return jnp.where(jnp.any(jnp.isnan(values)), jnp.nan, jnp.min(values))
