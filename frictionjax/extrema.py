"""Maximum and minimum of a smooth 1-periodic function, differentiable in its parameters."""

from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array

from .arguments import Real
from .roots import find_root

_BUMPS = 8  # scanned maxima that are polished


class Extrema(NamedTuple):
    """Places (in [-1, 2]) and values of the largest maximum and the smallest minimum."""

    argmax: Real
    max: Real
    argmin: Real
    min: Real


def _downhill(fn: Callable[[Real], Real]) -> Callable[[Real], Real]:
    return lambda y: -jax.jvp(fn, (y,), (jnp.ones_like(y),))[1]


def _summit(fn: Callable[[Real], Real], place: Real, width: float) -> Real:
    """Move a scanned maximum of `fn` to the zero of `fn'` beside it."""
    root = find_root(_downhill(fn), place - width, place + width)
    # Flat tops and unresolved kinks: a scan point that beats the root is kept.
    return jax.lax.stop_gradient(jnp.where(fn(root) >= fn(place), root, place))


def _carry(fn: Callable[[Real], Real], frozen: Real) -> Real:
    """One Newton step that moves nothing carries the derivative of the place.

    So second derivatives of the value are right too; its first is the envelope theorem.
    """
    value, slope = jax.jvp(_downhill(fn), (frozen,), (jnp.ones_like(frozen),))
    known = slope > 1e-8 * jnp.abs(fn(frozen))
    step = jnp.where(known, value / jnp.where(known, slope, 1.0), 0.0)
    return frozen - (step - jax.lax.stop_gradient(step))


def periodic_extrema(fn: Callable[[Real], Real], points: int) -> Extrema:
    """Extrema of the 1-periodic `fn`: dense scan, then Newton on `fn'`.

    `points` a period must resolve `fn`; the scan only has to pick the right bump.
    """
    grid = jnp.arange(points) / points
    values = jax.lax.stop_gradient(jax.vmap(fn)(grid))
    top = _highest(fn, grid, values)
    bottom = _highest(lambda y: -fn(y), grid, -values)
    return Extrema(top, fn(top), bottom, fn(bottom))


def _highest(fn: Callable[[Real], Real], grid: Array, values: Array) -> Real:
    """Place of the largest maximum: the scan's highest bumps, each polished.

    Samples of two bumps can stand in the wrong order by a part in 1000.
    """
    bump = (values >= jnp.roll(values, 1)) & (values >= jnp.roll(values, -1))
    best = jax.lax.top_k(jnp.where(bump, values, -jnp.inf), _BUMPS)[1]
    width = 1 / grid.shape[0]
    places = jax.vmap(lambda place: _summit(fn, place, width))(grid[best])
    heights = jax.lax.stop_gradient(jax.vmap(fn)(places))
    return _carry(fn, places[jnp.argmax(heights)])


def smallest(values: Array) -> Real:
    """The minimum, NaN where any value is: `jnp.min` loses NaNs of long arrays."""
    return jnp.where(jnp.any(jnp.isnan(values)), jnp.nan, jnp.min(values))
