"""The wiggly potential and its force at places of one period."""

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .._checks import Real
from .._compile import Program, in_chunks
from ..model import AbstractPotential, tabulated_potentials
from .settings import SETTINGS


@Program
def _sampled(
    potential: AbstractPotential, eps: Real, Y: Float[Array, " n"]
) -> tuple[Float[Array, " n"], Float[Array, " n"]]:
    def at(phase: Real) -> tuple[Real, Real]:
        y = potential.well_coordinate(phase - jnp.round(phase), eps)
        return potential.tip_energy(y, eps), potential.tip_force(y, eps)[0]

    return jax.vmap(at)(Y)


def sampled_potential(
    potential: AbstractPotential, eps: float, Y: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """`V_eps` in J and `V_eps'` in N at the states `z = eps Y` (periods), any shape."""
    table, _ = tabulated_potentials(potential, eps)
    fixed = table, np.asarray(eps, dtype=float)
    found = in_chunks(_sampled, SETTINGS.sampled, fixed, (np.ravel(Y).astype(float),))
    energy, force = (np.reshape(values, np.shape(Y)) for values in found)
    return energy, force
