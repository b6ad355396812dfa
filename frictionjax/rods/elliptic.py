"""Complete elliptic integrals of the first and second kind."""

from typing import NamedTuple

import jax.numpy as jnp

from .._checks import Real

# The mean doubles its digits at each step: at 1 - m = 1e-15 the fifth one is at rounding,
# at m = 0.83, where chords are 0, the fourth.
_STEPS = 7


class EllipticIntegrals(NamedTuple):
    """`K(m)`; and of `K (1 - m/2 - ...)`, what elastica need, as shares of K.

    `bend`: `(E - (1 - m) K)/K`, about m/2 at small m. `short`: `2 (K - E)/K`, about m.
    Neither is a difference of numbers that are nearly equal.
    """

    K: Real
    bend: Real
    short: Real

    @property
    def E(self) -> Real:
        """`E(m)`, of the second kind."""
        return self.K * (1 - 0.5 * self.short)


def complete_elliptic(m: Real) -> EllipticIntegrals:
    """K and E of the parameter `m = k^2` < 1, by the arithmetic-geometric mean.

    Analytic at m = 0 and below, differentiable to any order. With `c_0^2 = m`,
    `c_(n+1) = (a_n - b_n)/2`: `1 - E/K = sum 2^(n-1) c_n^2` (Abramowitz and Stegun,
    17.6.4), where `c_(n+1)^2 = (c_n^2/(4 a_(n+1)))^2` keeps all digits of small m.
    """
    a, b, square = jnp.ones_like(m), jnp.sqrt(1 - m), m
    weight, rest = 1.0, jnp.zeros_like(m)
    for _ in range(_STEPS):
        a, b = 0.5 * (a + b), jnp.sqrt(a * b)
        square = (square / (4 * a)) ** 2
        rest = rest + weight * square
        weight *= 2
    return EllipticIntegrals(K=0.5 * jnp.pi / a, bend=0.5 * m - rest, short=m + 2 * rest)
