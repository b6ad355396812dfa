"""Radau IIA with three stages, of order 5 (E. Hairer and G. Wanner, Solving Ordinary
Differential Equations II, section IV.8), and the inverse that its steps need."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

_ROOT = 6**0.5
RADAU_PLACES = np.array([(4 - _ROOT) / 10, (4 + _ROOT) / 10, 1.0])
"""Of the stages in a step."""
RADAU_WEIGHTS = np.array(
    [
        [(88 - 7 * _ROOT) / 360, (296 - 169 * _ROOT) / 1800, (-2 + 3 * _ROOT) / 225],
        [(296 + 169 * _ROOT) / 1800, (88 + 7 * _ROOT) / 360, (-2 - 3 * _ROOT) / 225],
        [(16 - _ROOT) / 36, (16 + _ROOT) / 36, 1 / 9],
    ]
)


def inverse_of_three(m: Float[Array, "3 3"]) -> Float[Array, "3 3"]:
    """By cofactors: lanes side by side, where LAPACK takes one at a time."""
    first = jnp.cross(m[:, 1], m[:, 2])
    second = jnp.cross(m[:, 2], m[:, 0])
    third = jnp.cross(m[:, 0], m[:, 1])
    return jnp.stack([first, second, third]) / jnp.dot(m[:, 0], first)
