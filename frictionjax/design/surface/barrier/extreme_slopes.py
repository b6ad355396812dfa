"""Extreme slopes of a series, exactly, and a small change that sets them."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array

from ...._checks import Real
from ....numerics import find_root
from .constraints import at, basis, derivatives
from .settings import SETTINGS


class Reach(NamedTuple):
    """What bounds look at: largest and smallest slope, |w''| at most, height of w."""

    plus: Real
    minus: Real
    curvature: Real
    height: Real


class Peaks(NamedTuple):
    """Places and values of the maximum and the minimum, each a pair."""

    places: Array
    values: Array


def peaks(waves: Array) -> Peaks:
    """Maximum and minimum of `v`: a scan on the rows, then Newton in brackets.

    As `periodic_extrema`, which takes 3 s to compile each time it is used on a series of
    16 waves; here nobody differentiates.
    """
    harmonics = waves.shape[-1] // 2
    count = SETTINGS.rows * max(SETTINGS.fewest_waves, harmonics)
    values = jnp.asarray(basis(harmonics, count)) @ waves
    sides = jnp.array([1.0, -1.0])
    return jax.vmap(lambda side: _peak(waves, side, side * values))(sides)


def _peak(waves: Array, side: Real, values: Array) -> Peaks:
    bump = (values >= jnp.roll(values, 1)) & (values >= jnp.roll(values, -1))
    # A series of N waves has at most N maxima; at a flat stretch nearly all tie.
    heights, best = jax.lax.top_k(jnp.where(bump, values, -jnp.inf), waves.size // 2)
    scanned = best.astype(float) / values.size
    # Brackets: on a flat stretch six of Newton's steps alone left 5e-9 of the slope.
    width = jnp.where(jnp.isfinite(heights), 1 / values.size, 0.0)
    places = find_root(lambda y: -side * at(waves, y, 1), scanned - width, scanned + width)
    polished = side * at(waves, places)
    better = polished >= heights
    found = jnp.where(better, polished, heights)
    first = jnp.argmax(found)
    return Peaks(jnp.where(better, places, scanned)[first], side * found[first])


def reach(waves: Array) -> Reach:
    """Extreme slopes, largest curvature and height of a surface."""
    slope, bend, height = jax.vmap(peaks)(derivatives(waves)).values
    return Reach(slope[0], -slope[1], jnp.max(jnp.abs(bend)), height[0] - height[1])


def with_extreme_slopes(waves: Array, plus: Real, minus: Real) -> Array:
    """The waves changed until max v = plus and min v = -minus, to rounding.

    Newton along two directions, the surface itself and a sharp bump (Fejer's kernel) at the
    steeper extremum. Both move a flat stretch at the other one as a whole: pulling at
    single places needs as many steps as it has touching points, and more.
    """
    side = jnp.where(plus >= minus, 1.0, -1.0)
    steeper = jnp.where(plus >= minus, 0, 1)
    wanted = jnp.stack([plus, -minus])

    def body(state: tuple) -> tuple:
        waves, _, count = state
        found = peaks(waves)
        gap = wanted - found.values
        bump = side * _fejer(found.places[steeper], waves.size // 2)
        pulls = jnp.stack([found.values, at(bump, found.places)], axis=1)
        scale, push = jnp.linalg.pinv(pulls, rtol=SETTINGS.rank) @ gap
        exact = jnp.max(jnp.abs(gap)) <= SETTINGS.exact_slopes * (plus + minus)
        moved = (1 + scale) * waves + push * bump
        return jnp.where(exact, waves, moved), exact, count + 1

    def go_on(state: tuple) -> Array:
        return ~state[1] & (state[2] < SETTINGS.slope_steps)

    return jax.lax.while_loop(go_on, body, (waves, False, 0))[0]


def _fejer(place: Real, harmonics: int) -> Array:
    """Waves of `sum_n (1 - n/(N+1)) cos(2 pi n (y - place))`."""
    n = jnp.arange(1, harmonics + 1)
    turns, share = 2 * jnp.pi * n, 1 - n / (harmonics + 1)
    size = share * turns / jnp.sqrt(2.0)
    return jnp.concatenate([size * jnp.cos(turns * place), size * jnp.sin(turns * place)])
