"""How far graphs of two functions of time are apart, where they jump a little later."""

import numpy as np
from jaxtyping import Float

from .settings import SETTINGS

_Column = Float[np.ndarray, " n"]


def graph_distance(times: _Column, first: _Column, second: _Column, speed: float) -> float:
    """Hausdorff distance in m of two graphs {(t, z)}, completed by vertical segments.

    `times` (s) do not fall, `first` and `second` (m) are the values there: at a jump a time
    stands twice, with the values before and after. A point of one graph is d from the other
    one where that, at times up to `d/speed` away, comes up to d near: `speed` (m/s) says
    what a time is worth. Where nothing jumps and nothing moves faster than `speed`, it is
    at most sup |first - second| and at least half of it. (The metric of Skorokhod's M2
    topology: W. Whitt, Stochastic-Process Limits, 2002, section 11.5.) NaN of NaNs.
    """
    apart = np.abs(first - second)
    if apart.size == 0 or not np.isfinite(apart).all():
        return float("nan")
    low, high = 0.0, float(np.max(apart))
    for _ in range(SETTINGS.halvings if high > 0 else 0):
        middle = 0.5 * (low + high)
        if _within(speed * times, first, second, apart > middle, middle):
            high = middle
        else:
            low = middle
    return high


def _within(
    places: _Column, first: _Column, second: _Column, wanted: np.ndarray, distance: float
) -> bool:
    """Whether the `wanted` points of each graph are as near to the other one."""
    rows = np.flatnonzero(wanted)
    begin, end = places[rows] - distance, places[rows] + distance
    low, high = np.searchsorted(places, begin), np.searchsorted(places, end, side="right")
    for one, other in ((first, second), (second, first)):
        sides = [np.interp(ends, places, other) for ends in (begin, end)]
        for sign in (1.0, -1.0):
            most = _largest(sign * other, low, high)
            most = np.maximum(most, np.maximum(*(sign * side for side in sides)))
            if np.any(sign * one[rows] > most + distance):
                return False
    return True


def _largest(values: _Column, low: np.ndarray, high: np.ndarray) -> _Column:
    """Of `values[low:high]`, each: from windows of 1, 2, 4 ... values."""
    found = np.empty(low.size)
    level = np.frexp(high - low)[1] - 1
    for power in range(int(level.max(initial=-1)) + 1):
        rows, width = np.flatnonzero(level == power), 2**power
        found[rows] = np.maximum(values[low[rows]], values[high[rows] - width])
        values = np.maximum(values[:-width], values[width:])
    return found
