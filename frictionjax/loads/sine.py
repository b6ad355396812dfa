"""Sinusoidal load."""

import equinox as eqx
from jaxtyping import Array, Float

from .._checks import Real, as_real, require_real
from ..numerics import sin_cos
from .load import AbstractLoad, periodic_turning_count, periodic_turning_points


class Sine(AbstractLoad):
    """`l(t) = amplitude sin(2 pi t/period)`; `amplitude` in N, `period` in s.

    Raises `ValueError` for a period that is not positive or values that are not finite.
    """

    amplitude: Real = eqx.field(converter=as_real)
    period: Real = eqx.field(converter=as_real)

    def __check_init__(self):
        require_real("load.amplitude", self.amplitude, "any amplitude")
        require_real("load.period", self.period, "period > 0", lambda p: p > 0)

    def __call__(self, t: Real) -> Real:
        return self.amplitude * sin_cos(t / self.period)[0]

    def turning_count(self, duration: float) -> int:
        return periodic_turning_count(float(self.period) / 4, duration)

    def turning_points(self, duration: Real, count: int) -> Float[Array, " count"]:
        return periodic_turning_points(self.period / 4, duration, count)
