"""The last digits: slopes and parameters that meet the targets, and a surface with them."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array

from ...._checks import Real
from .constraints import FitShape
from .extreme_slopes import Reach, peaks, reach, with_extreme_slopes
from .iterates import FitTask, coefficient_residuals
from .settings import SETTINGS


class Settled(NamedTuple):
    """A surface (waves, in units of the task), parameters and how they do.

    `wanted`: the extreme slopes that are best, bounds aside: (omega_plus, -omega_minus).
    `met`: whether the coefficients are the best there are, bounds aside, and the bounds
    hold too. `residuals`: scaled, of the surface as it is.
    """

    waves: Array
    free: Array
    reach: Reach
    wanted: Array
    residuals: Array
    met: Array


def settle(layout: FitShape, task: FitTask, x: Array) -> Settled:
    """The optimum of the barrier with its last digits.

    Gauss-Newton steps of least length on the extreme slopes and the free parameters, which
    keep to what the targets see; then the least change of the surface that has those
    slopes. Where that leaves the bounds the optimum of the barrier stays.
    """
    point = layout.split(x)
    before = peaks(point.waves).values
    wanted = jnp.concatenate([before * jnp.array([1.0, -1.0]), point.free])

    def misfit(z: Array) -> Array:
        return coefficient_residuals(task, z[0], z[1], z[2:])

    # Short steps in parameters near their bounds: what lies on a bound stays there.
    ease = jnp.minimum(point.free, 1 - point.free)
    scale = jnp.concatenate([wanted[:2], ease])

    def gauss_newton(_: Any, z: Array) -> Array:
        pull = jax.jacfwd(misfit)(z) * scale[None, :]
        return z - scale * (jnp.linalg.pinv(pull, rtol=SETTINGS.rank) @ misfit(z))

    best = jax.lax.fori_loop(0, SETTINGS.polish_steps, gauss_newton, wanted)
    sizes = jnp.maximum(jnp.abs(wanted), SETTINGS.smallest)
    near = jnp.all(jnp.abs(best - wanted) <= SETTINGS.near * sizes)
    safe = jnp.where(near, best, wanted)
    both = jnp.stack([point.waves, with_extreme_slopes(point.waves, safe[0], safe[1])])
    reached = jax.vmap(reach)(both)
    old, new = (jax.tree_util.tree_map(lambda v, i=i: v[i], reached) for i in (0, 1))
    gap = jnp.abs(new.plus - safe[0]) + jnp.abs(new.minus - safe[1])
    good = near & (gap <= SETTINGS.exact * (safe[0] + safe[1]))
    good &= least_room(layout, task, new, safe[2:]) >= 0
    waves = jnp.where(good, both[1], both[0])
    free = jnp.where(good, safe[2:], point.free)
    found = jax.tree_util.tree_map(lambda o, n: jnp.where(good, n, o), old, new)
    left = coefficient_residuals(task, found.plus, found.minus, free)
    return Settled(waves, free, found, best[:2], left, good)


def rooms(layout: FitShape, task: FitTask, found: Reach, free: Array) -> dict[str, Real]:
    """How far each bound is, in shares of itself: >= 0 inside.

    Free parameters in shares of the width of their bounds.
    """
    known = task.law.at(free)
    upper = known.upper / task.slope
    lower = -known.lower / task.slope
    limits = jnp.minimum(1 - found.plus / upper, 1 - found.minus / lower)
    # The slopes allowed are an open interval.
    out = {"slopes": jnp.min(jnp.where(limits > 0, limits, -1.0))}
    if layout.sharp:
        out["curvature"] = 1 - found.curvature / task.curvature
    if layout.high:
        out["height"] = 1 - found.height / task.height
    if layout.free:
        out["free"] = jnp.min(jnp.minimum(free, 1 - free))
    return out


def least_room(layout: FitShape, task: FitTask, found: Reach, free: Array) -> Real:
    """The least of `rooms`."""
    return jnp.min(jnp.stack(list(rooms(layout, task, found, free).values())))
