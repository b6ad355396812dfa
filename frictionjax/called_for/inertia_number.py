"""What decides whether mass matters: beta."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from .._checks import Real
from .._compile import Interpreted
from ..effects import Inertia
from ..model import AbstractPotential, potential_at_rest

_PLACES = 2048  # of a period: max |W''| to 2e-6


@Interpreted
def _steepest(potential: AbstractPotential) -> Real:
    """`max |W''|` in N."""
    places = jnp.arange(_PLACES) / _PLACES - 0.5
    slope = jax.vmap(jax.grad(jax.grad(potential._leading)))
    return jnp.max(jnp.abs(slope(places)))


def inertia_numbers(
    potential: AbstractPotential, inertia: Inertia, eps: Any, gamma: Any
) -> Float[np.ndarray, "..."]:
    """`beta = m_eps max|W''| eps^(-1 - 2 gamma)`; eps (m) and gamma of shapes that fit."""
    steepest = float(_steepest(potential_at_rest(potential)))
    eps, gamma = np.asarray(eps, float), np.asarray(gamma, float)
    return np.asarray(inertia.mass_at(eps)) * steepest * eps ** (-1 - 2 * gamma)
