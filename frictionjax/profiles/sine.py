"""Sinusoidal profile."""

import equinox as eqx
import jax.numpy as jnp

from ..arguments import Real, as_real, require_real
from .profile import AbstractProfile


class Sine(AbstractProfile):
    """`w(y) = slope/(2 pi) sin(2 pi y)`, so `omega_plus = -omega_minus = |slope|`.

    `slope`: largest slope of the surface, dimensionless, not 0.

    Raises `ValueError` for a slope that is 0 or not finite.
    """

    slope: Real = eqx.field(converter=as_real)

    def __check_init__(self):
        require_real("profile.slope", self.slope, "slope != 0", lambda s: s != 0)

    def __call__(self, y: Real) -> Real:
        phase = 2 * jnp.pi * (y - jnp.round(y))
        return self.slope / (2 * jnp.pi) * jnp.sin(phase)

    @property
    def points(self) -> int:
        return 256
