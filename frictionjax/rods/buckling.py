"""Loads at which straight rods buckle."""

import jax.numpy as jnp

from .._checks import Real
from ..numerics import bracketed_root

# The root lies in [pi, 4.4934], a hinged rod's and a clamped one's; the function falls on
# all of this, through 0 once.
_BRACKET = 3.0, 4.6


def hinged_load(bending_stiffness: Real | float, length: Real | float) -> Real:
    """Euler's `pi^2 B/L^2` in N, of a rod between two hinges (N m^2, m)."""
    return jnp.pi**2 * jnp.asarray(bending_stiffness) / length**2


def sprung_load(
    bending_stiffness: Real | float, length: Real | float, stiffness: Real | float
) -> Real:
    """Load in N at which a rod buckles, on an angular spring and with a hinged tip.

    `bending_stiffness` B in N m^2, `length` L in m, `stiffness` k of the spring in N m/rad.
    `P = u^2 B/L^2`, `tan u = u/(1 + u^2/s)`, `s = k L/B`: from `pi^2` at s = 0 (two
    hinges) to 20.19 at infinity (root clamped). The ends move along the rod only
    (S. P. Timoshenko and J. M. Gere, Theory of Elastic Stability, section 2.3).
    """
    clamping = jnp.asarray(stiffness) * length
    share = clamping / (bending_stiffness + clamping)  # s/(1 + s), of any s

    def above(u: Real) -> Real:
        hinged = (share + (1 - share) * u**2) * jnp.sin(u)
        return share * u * jnp.cos(u) - hinged

    u = bracketed_root(above, *_BRACKET)
    return u**2 * bending_stiffness / length**2
