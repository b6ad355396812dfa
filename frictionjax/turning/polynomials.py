"""The force of a rod in between as a polynomial: what loops evaluate."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array
from numpy.polynomial import Chebyshev

from .._checks import Real
from .._compile import Interpreted
from ..rods import TurningRod
from .settings import SETTINGS


@Interpreted
def _forces(rod: TurningRod, places: Array) -> Array:
    return jax.vmap(rod.force)(places)


def turning_force(rod: TurningRod) -> Chebyshev:
    """The force in N of the rod in between, over how far its root is ahead of its tip (m).

    It is analytic, as the chord is never 0: interpolated to rounding.
    """
    reach = float(rod.reach)
    degree = SETTINGS.degree
    while True:
        nodes = np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1)) * reach
        values = np.asarray(_forces(rod, nodes))
        found = Chebyshev.fit(nodes, values, degree, domain=[-reach, reach])
        left = np.max(np.abs(found.coef[-2:])) / np.max(np.abs(found.coef))
        if left < SETTINGS.left or degree >= SETTINGS.most:
            return found
        degree *= 2


class BentForce(NamedTuple):
    """Chebyshev polynomials in `x/reach`, x in m: force in N, energy in J; (n,) each.

    The energy is counted from where the root is above the tip.
    """

    reach: Any
    of_force: Any
    of_energy: Any

    def force(self, ahead: Real) -> Real:
        """What pulls the root back, in N, with the root `ahead` (m) of the tip."""
        return _clenshaw(self.of_force, ahead / self.reach)

    def energy(self, ahead: Real) -> Real:
        """Stored in J."""
        return _clenshaw(self.of_energy, ahead / self.reach)


def bent_force(rod: TurningRod) -> BentForce:
    """Of a rod with known numbers; as many coefficients for all rods."""
    force = turning_force(rod)
    energy = force.integ()
    size = SETTINGS.most + 2
    padded = [np.pad(p.coef, (0, size - p.coef.size)) for p in (force, energy)]
    return BentForce(np.asarray(float(rod.reach)), *padded)


def _clenshaw(coefficients: Array, x: Real) -> Real:
    zero = jnp.zeros_like(x)

    def step(carry: tuple[Real, Real], c: Real) -> tuple[tuple[Real, Real], None]:
        first, second = carry
        return (c + 2 * x * first - second, first), None

    (first, second), _ = jax.lax.scan(step, (zero, zero), coefficients[:0:-1])
    return coefficients[0] + x * first - second
