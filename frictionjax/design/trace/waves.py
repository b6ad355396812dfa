"""Fourier series for programs that carry tangents of all coefficients."""

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax.custom_derivatives import SymbolicZero
from jaxtyping import Array, Float

from ..._checks import Real
from ...numerics import sin_cos
from ...profiles import AbstractProfile


class WaveProfile(AbstractProfile):
    """`profiles.Fourier`, its harmonics as one array instead of one after the other.

    With the tangents of 16 coefficients and Rosenbrock stages around it, a program with
    the harmonics written out takes 18 s to trace and compile, this one 3 s; both run
    equally long. `points`: 64 a wave of harmonic 8, as `Fourier`.
    """

    cos: Float[Array, " harmonics"]
    sin: Float[Array, " harmonics"]

    def __call__(self, y: Any) -> Float[Array, "*shape"]:
        rows = (jnp.arange(1, self.cos.shape[0] + 1), self.cos, self.sin)
        order, cos, sin = (jax.lax.broadcast_to_rank(row, jnp.ndim(y) + 1) for row in rows)
        sine, cosine = sin_cos(order * (y - jnp.floor(y))[..., None])
        return jnp.sum(cos * cosine + sin * sine, axis=-1)

    @property
    def points(self) -> int:
        return 64 * max(4, self.cos.shape[0])


# Steepest slope of (1 - u^2)^4, at u = 1/sqrt(7).
_STEEPEST = 8 * (6 / 7) ** 3 / 7**0.5


_BUMP = np.poly1d([-1.0, 0.0, 1.0]) ** 4 / _STEEPEST


def _bump(share: Real, order: int) -> Real:
    """Derivative `order` of `(1 - u^2)^4` on |u| < 1, of steepest slope 1."""
    inside = jnp.polyval(np.polyder(_BUMP, order).coeffs, share, unroll=16)
    return jnp.where(jnp.abs(share) < 1, inside, 0.0)


@partial(jax.custom_jvp, nondiff_argnums=(0,))
def _unseen(order: int, size: Real, centre: Real, width: Real, y: Real) -> Real:
    """Derivative `order` of a bump of size 0, which is 0; its tangents are not."""
    return jnp.zeros_like(y)


def _unseen_jvp(order: int, primals: tuple, tangents: tuple) -> tuple[Array, Array]:
    size, centre, width, y = primals
    size_dot, _, _, y_dot = tangents
    # The value by its name, not as 0: an outer derivative by the size goes through it.
    value = _unseen(order, size, centre, width, y)
    change = jnp.zeros_like(y)
    if not isinstance(y_dot, SymbolicZero):
        change = _unseen(order + 1, size, centre, width, y) * y_dot
    if not isinstance(size_dot, SymbolicZero):
        away = y - centre
        share = (away - jnp.round(away)) / width
        change = change + size_dot * _bump(share, order) * width ** (1 - order)
    return value, change


_unseen.defjvp(_unseen_jvp, symbolic_zeros=True)


class Bumped(AbstractProfile):
    """A series with one smooth bump of size 0: for derivatives by that size.

    A bump is `(1 - u^2)^4` on |u| < 1, `width` periods to either side of `centre`: C^3 and
    local. `size`: the steepest slope that it adds. Values do not depend on the centre, so
    a `vmap` over centres integrates once (bumps with sizes as an array: 12 s for 1.5 s).
    """

    waves: WaveProfile
    size: Real
    centre: Real
    width: Real

    def __call__(self, y: Any) -> Float[Array, "*shape"]:
        return self.waves(y) + _unseen(0, self.size, self.centre, self.width, y)

    @property
    def points(self) -> int:
        return self.waves.points
