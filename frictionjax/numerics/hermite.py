"""The cubic with given slopes at its ends, on [0, 1]."""

from typing import Any


def cubic(s: Any, rise: Any, slope0: Any, slope1: Any) -> Any:
    """How far it has come at `s`, of `rise` in all."""
    first, last = slope0 - rise, slope1 - rise
    return s * rise + s * (1 - s) * ((1 - s) * first - s * last)


def cubic_slope(s: Any, rise: Any, slope0: Any, slope1: Any) -> Any:
    """Its derivative at `s`."""
    first, last = slope0 - rise, slope1 - rise
    return rise + (1 - s) * (1 - 3 * s) * first + s * (3 * s - 2) * last
