"""Sinusoidal profile."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from .._checks import Asked, Real, as_real, require_real
from ..numerics import sin_cos
from .profile import AbstractProfile


class Sine(AbstractProfile):
    """`w(y) = slope/(2 pi) sin(2 pi y)`, so `omega_plus = -omega_minus = |slope|`.

    `slope`: largest slope of the surface, dimensionless, not 0.

    Raises `ValueError` for a slope that is 0 or not finite.

    >>> law = fx.friction(fx.profiles.Sine(slope=0.1), scene.bristle)
    >>> print(f"slopes from {law.omega_minus:.2f} to {law.omega_plus:.2f}")
    slopes from -0.10 to 0.10
    """

    asked: ClassVar = {"slope": Asked("no unit", "not 0")}

    slope: Real = eqx.field(converter=as_real)

    def __check_init__(self):
        require_real("profile.slope", self.slope, "slope != 0", lambda s: s != 0)

    def __call__(self, y: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        return self.slope / (2 * jnp.pi) * sin_cos(y)[0]

    @property
    def points(self) -> int:
        return 256
