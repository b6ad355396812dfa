"""One step of the tip's equation, as long as its error allows."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..._checks import Real
from ...numerics import RADAU_PLACES, RADAU_WEIGHTS, cubic, inverse_of_three
from ..forces import AbstractForce
from .settings import SETTINGS


class Follower(NamedTuple):
    """At `time` in s the tip at well + `tip`, which may be off by `doubt`, in periods; the
    next step and the time at which it ends, in s."""

    time: Real
    tip: Real
    doubt: Real
    step: Real
    well: Real
    end: Real


class _Solved(NamedTuple):
    """The tip after a step, what Newton's last round changed, and growth on the way."""

    tip: Real
    left: Real
    growth: Real


def _solved(
    force: AbstractForce, viscosity: Real, well: Real, start: tuple[Real, Real], step: Real
) -> _Solved:
    """Radau IIA from (time, tip); Newton's method from a tip that stays."""
    time, tip = start
    weights = step * jnp.asarray(RADAU_WEIGHTS)
    times = time + step * jnp.asarray(RADAU_PLACES)

    def at(t: Array, y: Array) -> tuple[Array, Array, Array]:
        def driven(s: Array) -> tuple[Array, Array]:
            found = force.driven(t, well, s)
            return found.force, viscosity * found.stretch

        (f, g), (f_y, g_y) = jax.jvp(driven, (y,), (jnp.ones_like(y),))
        return f / g, (f_y - f * g_y / g) / g, f_y / g

    def newton(number: int, known: tuple[Array, _Solved]) -> tuple[Array, _Solved]:
        tips, _ = known
        rates, slopes, by_state = jax.vmap(at)(times, tips)
        inverse = inverse_of_three(jnp.eye(3) - weights * slopes[None])
        change = inverse @ (tip + weights @ rates - tips)
        tips = tips + change
        left = jnp.max(jnp.abs(change))
        return tips, _Solved(tips[-1], left, weights[-1] @ by_state)

    none = jnp.zeros_like(tip)
    guess = jnp.full(3, tip), _Solved(tip, none, none)
    return jax.lax.fori_loop(0, SETTINGS.rounds, newton, guess)[1]


def _rate(force: AbstractForce, viscosity: Real, well: Real, time: Real, tip: Real) -> Real:
    """Of the tip, in periods per s."""
    found = force.driven(time, well, tip)
    return found.force / (viscosity * found.stretch)


def try_step(
    force: AbstractForce, viscosity: Real, stops: Float[Array, " s"], at: Follower
) -> list[Follower]:
    """As one step and as two of half the length: where it is now and, if both agree, after
    each of the two; else where it was.

    No step goes over a time of `stops`, in s, at which the load turns: what it carries a
    tip over just before would be gone again at its end.
    """
    done = at.time >= at.end
    stop = stops[jnp.searchsorted(stops, at.time, side="right", method="compare_all")]
    end = jnp.minimum(at.end, stop)
    step = jnp.minimum(at.step, end - at.time)

    def part(halfway: Real, share: tuple) -> tuple[Real, _Solved]:
        offset, length = share
        start = at.time + offset * step, jnp.where(offset > 0, halfway, at.tip)
        found = _solved(force, viscosity, at.well, start, length * step)
        return found.tip, found

    shares = jnp.array([0.0, 0.0, 0.5]), jnp.array([1.0, 0.5, 0.5])
    _, found = jax.lax.scan(part, at.tip, shares)
    tip = found.tip[2]
    error = jnp.maximum(jnp.abs(tip - found.tip[0]) / 7, jnp.max(found.left))
    rates = [_rate(force, viscosity, at.well, at.time, at.tip)]
    rates += [_rate(force, viscosity, at.well, at.time + step, tip)]
    between = at.tip + cubic(0.5, tip - at.tip, step * rates[0], step * rates[1])
    astray = jnp.abs(between - found.tip[1])
    agree = (error <= SETTINGS.error) & (astray <= SETTINGS.between)
    agree &= jnp.abs(tip - at.tip) <= SETTINGS.farthest
    # A load that jumps is gone over in a step that no float makes shorter.
    shortest = SETTINGS.shortest * (jnp.abs(at.time) + jnp.abs(at.end))
    taken = ~done & (agree | ((step <= shortest) & jnp.isfinite(tip)))
    longer = (SETTINGS.error / jnp.maximum(error, 1e-30)) ** (1 / 6)
    longer = jnp.minimum(longer, (SETTINGS.between / jnp.maximum(astray, 1e-30)) ** 0.25)
    longer = jnp.where(jnp.isfinite(longer), longer, 0.0)
    factor = jnp.clip(0.9 * longer, 0.2, jnp.where(taken, 4.0, 0.5))
    ends = step >= end - at.time
    at = at._replace(step=jnp.where(done, at.step, step * factor))
    # Errors part as solutions do.
    doubt = at.doubt * jnp.exp(found.growth[1]) + error
    halfway = at._replace(time=at.time + 0.5 * step, tip=found.tip[1], doubt=doubt)
    after = at._replace(
        time=jnp.where(ends, end, at.time + step),
        tip=tip,
        doubt=doubt * jnp.exp(found.growth[2]) + error,
    )

    def if_taken(new: Follower) -> Follower:
        return Follower(*(jnp.where(taken, *both) for both in zip(new, at, strict=True)))

    return [at, if_taken(halfway), if_taken(after)]
