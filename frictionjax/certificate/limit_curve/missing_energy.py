"""What the energy balance of a sampled curve misses, however it moves between samples."""

import jax
import numpy as np
from jaxtyping import Array, Float

from ..._compile import Interpreted
from ...numerics import THREE_NODES, THREE_WEIGHTS
from ...supports import AbstractSupport

_Column = Float[np.ndarray, " k"]


@Interpreted
def forces_at(support: AbstractSupport, states: Array) -> Array:
    """`Phi'` in N at states in m, (n,)."""
    return jax.vmap(support.force)(states)


def missing_energy(
    support: AbstractSupport,
    z: Float[np.ndarray, " n"],
    rho: _Column,
    loads: tuple[_Column, _Column],
    ends: tuple[_Column, _Column],
) -> float:
    """`int |Phi'(z) + rho - l| |dz|` in J, l the nearest that there was on the way.

    Of gaps between samples z: the friction `rho` of the move (N), the least and the
    largest of its `loads` (N), and the states that such a move comes to under these
    (`ends`, m). On slides of a solution l is Phi'(z) + rho, so that nothing is missing.
    """
    low, high = np.minimum(z[:-1], z[1:]), np.maximum(z[:-1], z[1:])
    least, largest = loads
    below, above = ends
    over = _between(support, np.clip(above, low, high), high, largest - rho)
    under = _between(support, low, np.clip(below, low, high), least - rho)
    return float(np.sum(over) - np.sum(under))


def _between(
    support: AbstractSupport, start: _Column, end: _Column, held: _Column
) -> _Column:
    """`int (Phi'(z) - held) dz` from start to end."""
    width = end - start
    places = start[:, None] + width[:, None] * THREE_NODES
    forces = forces_at(support, places.ravel()).reshape(places.shape)
    return width * ((forces - held[:, None]) @ THREE_WEIGHTS)
