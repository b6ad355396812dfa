"""Fourier series: one harmonic after the other, or all at once."""

import jax
import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from .._checks import Real
from ..numerics import fourier_sum, sin_cos
from ..profiles import AbstractProfile


class SeriesProfile(AbstractProfile):
    """`mean + sum_n cos_n cos(2 pi n y) + sin_n sin(2 pi n y)`, shape (harmonics,) each.

    Harmonics one after the other, by Horner's rule: fewest products a place.
    """

    mean: Real
    cos: Float[Array, " harmonics"]
    sin: Float[Array, " harmonics"]

    def __call__(self, y: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        return self.mean + fourier_sum(self.cos, self.sin, jnp.asarray(y))

    @property
    def points(self) -> int:
        return 64 * max(4, self.cos.shape[0])


class Waves(SeriesProfile):
    """The same with harmonics as an axis.

    For planning with up to eight harmonics: written out one by one, 8 of them take 1.4
    times as long to compile. (64 of them, at the 4096 places that they need, as an axis:
    180 ms for 64 cells; one after the other in blocks 36.)
    """

    def __call__(self, y: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        y = jnp.asarray(y)
        inside = y - jnp.round(y)
        rows = (jnp.arange(1, self.cos.shape[0] + 1), self.cos, self.sin)
        order, cos, sin = (jax.lax.broadcast_to_rank(row, y.ndim + 1) for row in rows)
        sine, cosine = sin_cos(inside[..., None] * order)
        return self.mean + jnp.sum(cos * cosine + sin * sine, axis=-1)
