"""Sinusoidal load."""

from .._checks import Real
from ..numerics import sin_cos
from .load import PeriodicLoad


class Sine(PeriodicLoad):
    """`l(t) = amplitude sin(2 pi t/period)`; `amplitude` in N, `period` in s.

    Raises `ValueError` for a period that is not positive or values that are not finite.

    >>> load = fx.loads.Sine(amplitude=1.05, period=3.0)
    >>> print(f"{load(0.75):.2f} N, {load(2.25):.2f} N")
    1.05 N, -1.05 N
    """

    def __call__(self, t: Real) -> Real:
        return self.amplitude * sin_cos(t / self.period)[0]
