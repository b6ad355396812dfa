"""A bristle as power series over the heights that its tip meets."""

from collections.abc import Sequence
from typing import Any

import jax
import numpy as np
from jaxtyping import Array, Float

from .._checks import ByIdentity, Real, exchanged
from .._compile import Interpreted
from ..bristles import AbstractBristle, Rod
from ..numerics import power_integral, power_sum
from .settings import SETTINGS, size_for

Numbers = Array | np.ndarray

_NODES = np.cos(np.pi * (np.arange(SETTINGS.nodes) + 0.5) / SETTINGS.nodes)
_TO_SERIES = np.linalg.inv(np.polynomial.chebyshev.chebvander(_NODES, SETTINGS.nodes - 1))

# Rows: Chebyshev polynomials as powers.
_TO_POWERS = np.stack(
    [
        np.pad(np.polynomial.chebyshev.cheb2poly(row[: n + 1]), (0, row.size - n - 1))
        for n, row in enumerate(np.eye(SETTINGS.nodes))
    ]
)


class SeriesBristle(AbstractBristle):
    """`A'` and `F'` as power series in `eta per_height`, A and F their integrals.

    Two square roots and an arc tangent a stage, which XLA does not vectorise, become a
    handful of products: 3 times less time for a step of the angular spring. (Divided by a
    height instead: a quarter more for every step.) `rods`: slope and reach of the rod that
    it is, shape (2, terms); None where it is none, or nobody asks.
    """

    ahead: Float[Numbers, " terms"]
    climb: Float[Numbers, " terms"]
    per_height: Float[Numbers, ""]
    rods: Float[Numbers, "2 terms"] | None = None

    def offset(self, eta: Real) -> Real:
        return power_integral(self.ahead, self.per_height, eta)

    def energy(self, eta: Real) -> Real:
        return power_integral(self.climb, self.per_height, eta)

    def with_slopes(self, eta: Real) -> tuple[Real, Real, Real]:
        # As they are: as derivatives of integrals programs are a tenth larger.
        x = eta * self.per_height
        return self.offset(eta), power_sum(self.ahead, x), power_sum(self.climb, x)

    def rod(self, eta: Real) -> Rod | None:
        """The rod that has to clear the surface ahead of a tip at height `eta` (m)."""
        if self.rods is None:
            return None
        x = eta * self.per_height
        return Rod(power_sum(self.rods[0], x), power_sum(self.rods[1], x))


@Interpreted
def _slopes(bristle: AbstractBristle, etas: Array) -> tuple[Array, Array]:
    """A' and F' at heights (n,) in m."""
    ahead, climb = jax.vmap(jax.grad(bristle.offset)), jax.vmap(jax.grad(bristle.energy))
    return ahead(etas), climb(etas)


@Interpreted
def _rods(bristle: AbstractBristle, etas: Array) -> Any:
    return jax.vmap(bristle.rod)(etas)


def bristle_at_rest(bristle: AbstractBristle) -> SeriesBristle:
    """The bristle for eps -> 0: `A'(0)` and `F'(0)` are all that is left of it."""
    ahead, climb = _slopes(bristle, np.zeros(1))
    return SeriesBristle(ahead, climb, np.asarray(1.0))


_SERIES = ByIdentity()  # of bristles that are known: the last height, and the series


def bristle_series(
    bristle: AbstractBristle, highest: float, with_rods: bool = False
) -> AbstractBristle:
    """The bristle as a series for |eta| <= `highest` (m); itself where none converges.

    `with_rods`: those too, where the bristle is a rod.
    """
    highest = max(highest, SETTINGS.lowest)
    known = _SERIES.get(bristle)
    if known is None or known[0] != highest:
        etas = _NODES * highest
        slopes, rods = _powers(_slopes(bristle, etas)), _rods(bristle, etas)
        if slopes is None:
            return bristle
        known = highest, SeriesBristle(slopes[0], slopes[1], np.asarray(1 / highest)), rods
        _SERIES.put(bristle, known)
    _, series, rods = known
    if not with_rods or rods is None:
        return series
    terms = _powers(rods)
    return bristle if terms is None else exchanged(series, {"rods": terms})


def _powers(values: Sequence[np.ndarray]) -> np.ndarray | None:
    """Power series of functions by their values at the nodes; None without one."""
    rows = np.stack(values)
    series = rows @ _TO_SERIES.T
    sizes = np.maximum(np.max(np.abs(rows), axis=1, keepdims=True), 1e-300)
    used = np.abs(series) > SETTINGS.least * sizes
    needed = int(np.max(np.flatnonzero(np.any(used, axis=0)), initial=0))
    degree = size_for(needed, SETTINGS.degrees)
    if degree is None or not np.all(np.isfinite(rows)):
        return None
    # Of a line nothing is left but a line, whatever the height that it was found for.
    powers = series[:, : needed + 1] @ _TO_POWERS[: needed + 1, : needed + 1]
    return np.pad(powers, ((0, 0), (0, degree - needed)))


def in_one_size(bristle: AbstractBristle) -> AbstractBristle:
    """A series with zeros up to the largest size, for programs whose steps cost more."""
    if not isinstance(bristle, SeriesBristle):
        return bristle
    more = SETTINGS.degrees[-1] + 1 - bristle.ahead.shape[0]
    series = {
        name: np.pad(getattr(bristle, name), (0, more)) for name in ("ahead", "climb")
    }
    return exchanged(bristle, series)
