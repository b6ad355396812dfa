"""Triangular load."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from .._checks import Real, as_real, require_real
from .load import AbstractLoad, periodic_turning_count, periodic_turning_points
from .settings import SETTINGS


class Triangle(AbstractLoad):
    """0, `amplitude`, `-amplitude`, 0 at 0, 1/4, 3/4 and 1 of a period, linear between.

    `amplitude` in N, `period` in s.

    Raises `ValueError` for a period that is not positive or values that are not finite.
    """

    amplitude: Real = eqx.field(converter=as_real)
    period: Real = eqx.field(converter=as_real)

    def __check_init__(self):
        require_real("load.amplitude", self.amplitude, "any amplitude")
        require_real("load.period", self.period, "period > 0", lambda p: p > 0)

    def __call__(self, t: Real) -> Real:
        halves = 2 * t / self.period
        piece = jnp.floor(halves + 0.5 + SETTINGS.slack * (1 + jnp.abs(halves)))
        sign = 1 - 2 * jnp.mod(piece, 2)
        return self.amplitude * sign * 2 * (halves - piece)

    def turning_count(self, duration: float) -> int:
        return periodic_turning_count(float(self.period) / 4, duration)

    def turning_points(self, duration: Real, count: int) -> Float[Array, " count"]:
        return periodic_turning_points(self.period / 4, duration, count)
