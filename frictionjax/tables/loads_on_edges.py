"""Loads of all classes as one: lines between their kinks and turns, and what is bent."""

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from .._checks import Real
from .._compile import Interpreted
from ..loads import AbstractLoad, AbstractPull
from .loads import bent_part, straight_part
from .settings import SETTINGS


class LoadOnEdges(AbstractLoad):
    """A load whose kinks and turns are `edges` (n,) in s: one class for all tables.

    What is straight between them: `values` (n,) in N there, and `rates` (n,) in N/s from
    there on. Edges rise from 0 to the duration, which fills the room.
    """

    bent: AbstractPull
    edges: Float[Array, " n"]
    values: Float[Array, " n"]
    rates: Float[Array, " n"]

    def __call__(self, t: Real) -> Real:
        k = self._before(t)
        return self.bent(t) + (self.values[k] + self.rates[k] * (t - self.edges[k]))

    def slope(self, t: Real) -> Real:
        return self.bent.slope(t) + self.rates[self._before(t)]

    def _before(self, t: Real) -> Int[Array, ""]:
        few = self.edges.shape[0] <= SETTINGS.few_edges
        method = "compare_all" if few else "scan_unrolled"
        found = jnp.searchsorted(self.edges, t, side="right", method=method)
        return jnp.maximum(found - 1, 0)

    @property
    def steepest(self) -> Real | None:
        """Where a function is known to be steepest, s."""
        return getattr(self.bent, "steepest", None)

    def turning_count(self, duration: float) -> int:
        return self.edges.shape[0] - 1

    def turning_points(self, duration: Real, count: int) -> Float[Array, " count"]:
        return jnp.minimum(self.edges[1:], duration)


@Interpreted
def _lines(straight: AbstractPull, edges: Array) -> tuple[Array, Array]:
    return jax.vmap(straight)(edges), jax.vmap(straight.slope)(edges)


def load_on_edges(table: AbstractPull, edges: Float[np.ndarray, " n"]) -> LoadOnEdges:
    """A table, or a function, of a load that has its kinks and turns at known edges (s)."""
    lines = (jnp.asarray(column) for column in _lines(straight_part(table), edges))
    return LoadOnEdges(bent_part(table), jnp.asarray(edges), *lines)
