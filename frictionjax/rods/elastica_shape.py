"""The shape of a rod that is bent between hinges."""

from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from .._checks import require
from .._compile import Program
from .elastica import parameter_of


@Program
def _parameter(short: Any) -> Any:
    """Compiled once: pictures ask for one shape after the other."""
    return parameter_of(short)


def bent_shape(
    length: float, chord: float, count: int = 101
) -> Float[np.ndarray, "2 count"]:
    """Points of the rod of `length` (m) whose ends are `chord` (m) apart: along, across.

    From one end to the other, in m; across is >= 0. With `phi` from pi/2 to 3 pi/2 and
    `lambda = sqrt(P/B) = 2 K/L` they are `(2 (E(phi) - E) - (F(phi) - K))/lambda` and
    `-2 sqrt(m) cos(phi)/lambda` (Love, chapter XIX). Straight where the chord is as long.

    Raises `ValueError` for a chord that is not > 0 and at most the length.
    """
    from scipy.special import ellipeinc, ellipkinc

    slack = 1e-9 * length
    allowed = f"0 < chord <= {length:.6g}"
    require(0 < chord <= length + slack, "chord", chord, allowed)
    short = jnp.asarray(max(1 - chord / length, 0.0))
    m = max(float(_parameter(short)), 0.0)
    phi = np.linspace(0.5 * np.pi, 1.5 * np.pi, count)
    first, second = ellipkinc(phi, m), ellipeinc(phi, m)
    scale = length / (first[-1] - first[0])
    along = 2 * (second - second[0]) - (first - first[0])
    return scale * np.array([along, -2 * np.sqrt(m) * np.cos(phi)])
