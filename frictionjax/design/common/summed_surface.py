"""Several tips on one root as one tip on a surface of its own."""

import jax
import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from ...profiles import AbstractProfile


class SummedSurface(AbstractProfile):
    """`sum_i weight_i w(y + offset_i)`: what an upright bristle makes of a rigid array.

    Its `W = alpha w` is linear in `w`, so potentials add as surfaces do. `offsets` in
    periods and `weights`, shape (n,). Every tip is evaluated: thousands take seconds and
    gigabytes.
    """

    single: AbstractProfile
    offsets: Float[Array, " n"]
    weights: Float[Array, " n"]

    def __call__(self, y: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        y = jnp.asarray(y)[..., None]
        # Whole periods go first: large offsets would lose digits.
        own = jax.lax.broadcast_to_rank(self.offsets - jnp.floor(self.offsets), y.ndim)
        phases = y - jnp.floor(y) + own
        return self.single(phases) @ self.weights

    @property
    def points(self) -> int:
        return self.single.points
