"""The planar elastica: a rod between hinged ends, bent beyond its critical load."""

from typing import NamedTuple

import jax.numpy as jnp

from .._checks import Real
from ..numerics import bracketed_root
from .buckling import hinged_load
from .elliptic import complete_elliptic

# Chords from this share of the length on: at -0.9 the parameter m is a spacing of floats
# from 1, and the rod one loop with straight ends.
_LEAST = -0.8
_BEYOND = -1e-3  # shortenings as far below 0 still have the analytic continuation


class Elastica(NamedTuple):
    """`thrust` P in N that holds the ends at their chord, and energy of bending in J."""

    thrust: Real
    energy: Real


def bent_between_hinges(
    bending_stiffness: Real | float, length: Real | float, chord: Real
) -> Elastica:
    """The rod of `length` (m) bent so that its hinged ends are `chord` (m) apart.

    `bending_stiffness` in N m^2. The first mode, for chords from -0.8 to 1 lengths, the
    ends crossed below 0; NaN outside. `P/P_cr = (2 K(m)/pi)^2`,
    `chord/L = 2 E(m)/K(m) - 1`, energy `8 B/L K (E - (1 - m) K)`, of which -P is the
    derivative by the chord. Both are analytic up to chord = L, where P is P_cr and the rod
    straight: `U = P_cr (L - chord) + ...`. (A. E. H. Love, A Treatise on the Mathematical
    Theory of Elasticity, chapter XIX.)
    """
    short = 1 - chord / length
    inside = (short >= _BEYOND) & (short <= 1 - _LEAST)
    held = jnp.where(inside, short, 0.5)
    found = complete_elliptic(parameter_of(held))
    critical = hinged_load(bending_stiffness, length)
    share = (2 * found.K / jnp.pi) ** 2
    energy = 2 * critical * length * share * found.bend
    return Elastica(
        jnp.where(inside, critical * share, jnp.nan), jnp.where(inside, energy, jnp.nan)
    )


def parameter_of(short: Real) -> Real:
    """m of a rod whose ends have come closer by so many lengths: `2 (K - E)/K = short`."""
    short = jnp.asarray(short, dtype=float)

    def root(one: Real) -> Real:
        return bracketed_root(
            lambda m: complete_elliptic(m).short - one, 2 * _BEYOND, 1 - 1e-15
        )

    return jnp.vectorize(root)(short) if short.ndim else root(short)
