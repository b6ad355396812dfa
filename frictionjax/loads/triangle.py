"""Triangular load."""

import jax.numpy as jnp

from .._checks import Real
from .load import PeriodicLoad
from .settings import SETTINGS


class Triangle(PeriodicLoad):
    """0, `amplitude`, `-amplitude`, 0 at 0, 1/4, 3/4 and 1 of a period, linear between.

    `amplitude` in N, `period` in s.

    Raises `ValueError` for a period that is not positive or values that are not finite.

    >>> load = fx.loads.Triangle(amplitude=1.05, period=3.0)
    >>> print(f"{load(0.75):.2f} N, {load(1.0):.2f} N")
    1.05 N, 0.70 N
    """

    def __call__(self, t: Real) -> Real:
        halves = 2 * t / self.period
        piece = jnp.floor(halves + 0.5 + SETTINGS.slack * (1 + jnp.abs(halves)))
        sign = 1 - 2 * jnp.mod(piece, 2)
        return self.amplitude * sign * 2 * (halves - piece)
