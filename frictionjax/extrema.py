"""Maximum and minimum of a smooth 1-periodic function, differentiable in its parameters."""

from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp

from .arguments import Real
from .roots import bracketed_root


class Extrema(NamedTuple):
    """Places (in [-1, 2]) and values of the largest maximum and the smallest minimum."""

    argmax: Real
    max: Real
    argmin: Real
    min: Real


def _polish(fn: Callable[[Real], Real], place: Real, width: float) -> Real:
    """Move a scanned maximum of `fn` to the zero of `fn'` beside it."""

    def uphill(y):
        return -jax.jvp(fn, (y,), (jnp.ones_like(y),))[1]

    frozen = jax.lax.stop_gradient(bracketed_root(uphill, place - width, place + width))
    # Flat tops and unresolved kinks: a scan point that beats the root is kept.
    frozen = jnp.where(fn(frozen) >= fn(place), frozen, place)
    frozen = jax.lax.stop_gradient(frozen)
    # One Newton step that moves nothing carries the place's derivative, so that second
    # derivatives are right too; the value's first is the envelope theorem.
    value, slope = jax.jvp(uphill, (frozen,), (jnp.ones_like(frozen),))
    known = slope > 1e-8 * (1.0 + jnp.abs(fn(frozen)))
    step = jnp.where(known, value / jnp.where(known, slope, 1.0), 0.0)
    return frozen - (step - jax.lax.stop_gradient(step))


def periodic_extrema(fn: Callable[[Real], Real], points: int) -> Extrema:
    """Extrema of the 1-periodic `fn`: dense scan, then Newton on `fn'`.

    `points` a period must resolve `fn`; the scan only has to pick the right bump.
    """
    grid = jnp.arange(points) / points
    values = jax.lax.stop_gradient(jax.vmap(fn)(grid))
    top = _polish(fn, grid[jnp.argmax(values)], 1 / points)
    bottom = _polish(lambda y: -fn(y), grid[jnp.argmin(values)], 1 / points)
    return Extrema(top, fn(top), bottom, fn(bottom))
