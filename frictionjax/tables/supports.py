"""A support as a power series over the states that a scene reaches."""

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float
from numpy.polynomial import chebyshev

from .._checks import Real
from .._compile import Interpreted
from ..numerics import bracketed_root, power_integral, power_sum
from ..supports import AbstractSupport
from .settings import SETTINGS

_COUNT = 2 * SETTINGS.support_terms
_NODES = np.cos(np.pi * (np.arange(_COUNT) + 0.5) / _COUNT)
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(_NODES, _COUNT - 1))


class SeriesSupport(AbstractSupport):
    """`Phi'` (N) as a power series in `(z - middle) per_way`, Phi its integral.

    Of states between `low` and `high` (m). `level`: Phi at the middle, J.
    """

    terms: Float[Array, " terms"]
    per_way: Real
    middle: Real
    level: Real
    low: Real
    high: Real

    def energy(self, z: Real) -> Real:
        return self.level + power_integral(self.terms, self.per_way, z - self.middle)

    def force(self, z: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        return power_sum(self.terms, (jnp.asarray(z) - self.middle) * self.per_way)

    def stiffness_at(self, z: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        z = jnp.asarray(z)
        return jax.jvp(self.force, (z,), (jnp.ones_like(z),))[1]

    def state_of(self, force: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        return jnp.vectorize(self._state_of)(force)

    def _state_of(self, force: Real) -> Real:
        return bracketed_root(lambda z: self.force(z) - force, self.low, self.high)


@Interpreted
def _state(support: AbstractSupport, force: Array) -> Array:
    return support.state_of(force)


@Interpreted
def _at_states(support: AbstractSupport, states: Array) -> tuple[Array, Array]:
    return jax.vmap(support.force)(states), jax.vmap(support.energy)(states)


def support_table(
    support: AbstractSupport, least: float, largest: float
) -> AbstractSupport:
    """A known support for forces (N) between these and somewhat beyond, as a series.

    Itself where no series meets it.
    """
    more = SETTINGS.beyond * (largest - least)
    low, high = (_state(support, np.asarray(f)) for f in (least - more, largest + more))
    half, middle = 0.5 * (high - low), 0.5 * (high + low)
    forces, energies = _at_states(support, middle + half * np.append(_NODES, 0.0))
    series = _TO_SERIES @ forces[:-1]
    left_out = np.max(np.abs(series[SETTINGS.support_terms :]))
    if not left_out <= SETTINGS.least * np.max(np.abs(forces)) or half <= 0:
        return support
    terms = chebyshev.cheb2poly(series[: SETTINGS.support_terms])
    terms = np.pad(terms, (0, SETTINGS.support_terms - terms.size))
    numbers = (1 / half, middle, energies[-1], low, high)
    return SeriesSupport(*map(jnp.asarray, (terms, *numbers)))
