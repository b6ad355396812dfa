"""Steady slides of one scene at many speeds in one compiled call."""

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..._checks import Real
from ..._compile import Program, in_chunks
from ...model import AbstractPotential, tabulated_potentials
from .settings import SETTINGS
from .slide_friction import Sides, one_side


@Program
def _at_speeds(
    potential: AbstractPotential,
    eps: Real,
    gamma: Real,
    stiffness: Real,
    speeds: Float[Array, " n"],
) -> Sides:
    def one(speed: Real) -> Sides:
        rate = stiffness * jnp.abs(speed)
        return one_side(potential, eps, gamma, rate, stiffness, jnp.sign(speed))

    return jax.vmap(one)(speeds)


def slides_at_speeds(
    potential: AbstractPotential,
    speeds: Float[np.ndarray, " n"],
    *,
    eps: float,
    gamma: float,
    stiffness: float,
) -> Sides:
    """Forces (N) of slides whose support moves at `speeds` (m/s, none 0), arrays (n,).

    `eps` in m, `stiffness` of the spring in N/m; known numbers, within the bristle's reach.
    Where springs are so soft that errors are hardly forgotten the code is `OPEN_BRACKET`.
    """
    _, table = tabulated_potentials(potential, eps)
    fixed = table, np.asarray(eps), np.asarray(gamma), np.asarray(stiffness)
    return in_chunks(_at_speeds, SETTINGS.lanes, fixed, (speeds,))
