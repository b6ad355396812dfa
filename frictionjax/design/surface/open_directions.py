"""What coefficients leave open: directions in the space of surfaces, and surfaces."""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from ..._checks import Real
from ...effects import RigidArray
from ..common import AbstractLaw
from .barrier import at, peaks, reach, waves_of_heights, with_extreme_slopes
from .exchange import shares_seen, times_shares
from .settings import SETTINGS


class CoefficientIdentifiability(NamedTuple):
    """What the coefficients see of a surface and of free bristle parameters.

    `sensitivities`: of log rho_plus, log -rho_minus of every target to `cos`, `sin` and the
    free parameters (in shares of their bounds), shape (2 targets, unknowns).
    `singular_values` of it, `rank`, and `open_directions`: an orthonormal basis of what no
    coefficient sees to first order, shape (unknowns - rank, unknowns), smoothest first.
    """

    sensitivities: np.ndarray
    singular_values: np.ndarray
    rank: int
    open_directions: np.ndarray


@eqx.filter_jit
def _sensitivities(
    law: AbstractLaw, cos: Array, sin: Array, free: Array, shares: Array | None
) -> Array:
    found = peaks(waves_of_heights(*_seen(cos, sin, shares)))
    turns = 2 * jnp.pi * jnp.arange(1, cos.size + 1)[None]

    def coefficients(unknowns: Array) -> Array:
        c, s = _seen(unknowns[: cos.size], unknowns[cos.size : 2 * cos.size], shares)
        phase = turns * found.places[:, None]
        # The places are where slopes are extreme: their motion adds nothing.
        slopes = turns * (jnp.cos(phase) * s[None] - jnp.sin(phase) * c[None])
        plus, low = slopes @ jnp.ones(cos.size)
        rho = law.coefficients(plus, -low, unknowns[2 * cos.size :])
        return jnp.log(jnp.abs(rho)).ravel()

    return jax.jacfwd(coefficients)(jnp.concatenate([cos, sin, free]))


def _seen(cos: Array, sin: Array, shares: Array | None) -> tuple[Array, Array]:
    """Heights whose every wave is multiplied by a complex share; None: as they are."""
    return (cos, sin) if shares is None else times_shares(cos, sin, shares)


def identifiability(
    law: AbstractLaw,
    cos: Array,
    sin: Array,
    free: Array,
    array: RigidArray | None = None,
) -> CoefficientIdentifiability:
    """What the coefficients see at this surface and these parameters.

    `array`: the tips that see it, upright ones at different phases.
    """
    shares: Any = None if array is None else shares_seen(array, np.size(cos))
    pulls = np.asarray(_sensitivities(law, cos, sin, free, shares))
    _, values, vectors = np.linalg.svd(pulls)
    rank = int(np.sum(values > SETTINGS.rank * values[0]))
    unseen = vectors[rank:]
    stiffness = np.zeros(pulls.shape[1])
    count = np.size(cos)
    stiffness[: 2 * count] = np.tile((2.0 * np.pi * np.arange(1, count + 1)) ** 4, 2)
    _, turn = np.linalg.eigh(unseen * stiffness @ unseen.T)
    return CoefficientIdentifiability(pulls, values, rank, turn.T @ unseen)


@eqx.filter_jit
def members(
    waves: Array, keys: Array, size: Real, curvature: Real, height: Real
) -> tuple[Array, Array]:
    """Surfaces with the same extreme slopes, and whether each is within the bounds.

    A random direction that leaves both extreme slopes to first order, of bending energy
    `size`^2 times that of the surface; then exactly, by the least change. Halved while
    that breaks a bound.
    """
    found = peaks(waves)
    plus, minus = found.values[0], -found.values[1]
    decay = jnp.tile(jnp.arange(1.0, waves.size // 2 + 1), 2)
    seen = jax.vmap(lambda y: at(jnp.eye(waves.size), y))(found.places)
    span = jnp.linalg.qr(seen.T)[0]

    def one(key: Array) -> tuple[Array, Array]:
        way = jax.random.normal(key, (waves.size,)) / decay
        way = way - span @ (span.T @ way)
        way = size * jnp.linalg.norm(waves) * way / jnp.linalg.norm(way)
        steps = 0.5 ** jnp.arange(SETTINGS.halvings)
        tries = jax.vmap(lambda part: with_extreme_slopes(waves + part * way, plus, minus))(
            steps
        )
        reached = jax.vmap(reach)(tries)
        exact = jnp.abs(reached.plus - plus) + jnp.abs(reached.minus - minus)
        good = exact <= SETTINGS.exact * (plus + minus)
        good &= (reached.curvature <= curvature) & (reached.height <= height)
        first = jnp.argmax(good)
        return tries[first], good[first]

    return jax.vmap(one)(keys)
