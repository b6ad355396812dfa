"""Sums and extremes over a long slide from a few of its slip periods."""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

_FINE = 257  # points at which extremes of the fitted curves are looked for


class Survey(NamedTuple):
    """Curves over a slide, fitted in time to what was measured in whole slip periods.

    `low`, `high`: ends in s. `work`, `viscous`, `residual`: Chebyshev series of J/s.
    `ahead`, `behind`: of the extremes of z - path over a period, m. `surplus`, `deficit`:
    of those of the dissipation beyond the path's, less what the work adds, J. `error_*`:
    estimates from the last coefficients: of the integrals in J, of extremes in m and J.
    """

    low: float
    high: float
    work: np.ndarray
    viscous: np.ndarray
    residual: np.ndarray
    ahead: np.ndarray
    behind: np.ndarray
    surplus: np.ndarray
    deficit: np.ndarray
    error_work: float
    error_extreme: float
    error_surplus: float

    def _scaled(self, times: np.ndarray) -> np.ndarray:
        return 2 * (times - self.low) / (self.high - self.low) - 1

    def integral(self, series: np.ndarray, times: np.ndarray) -> np.ndarray:
        """`int_low^t` of a series in J/s at each time."""
        primitive = chebyshev.chebint(series)
        values = chebyshev.chebval(self._scaled(times), primitive)
        start = chebyshev.chebval(-1.0, primitive)
        return 0.5 * (self.high - self.low) * (values - start)

    def curve(self, series: np.ndarray, times: np.ndarray) -> np.ndarray:
        """Values of a series at each time."""
        return chebyshev.chebval(self._scaled(times), series)

    def fine(self) -> np.ndarray:
        """Times at which extremes are looked for."""
        return np.linspace(self.low, self.high, _FINE)


def nodes_of(low: float, high: float, count: int) -> np.ndarray:
    """Times of a Chebyshev-Lobatto grid: ends included, where slides change fastest."""
    x = -np.cos(np.pi * np.arange(count) / (count - 1))
    return 0.5 * (low + high) + 0.5 * (high - low) * x


def _tail(series: np.ndarray) -> float:
    """Size of the last coefficients: what a shorter series would have missed."""
    return float(np.max(np.abs(series[-3:]), initial=0.0))


def survey_of(
    low: float,
    high: float,
    starts: np.ndarray,
    ends: np.ndarray,
    sums: dict[str, np.ndarray],
    extremes: dict[str, np.ndarray],
) -> Survey:
    """Fit curves through slip periods [starts, ends] (s) of a slide over [low, high].

    `sums`: work, viscous, residual over each period, J. `extremes`: ahead, behind,
    surplus, deficit in each. A sum over all periods is the integral of their density: the
    midpoint of a period stands for it up to its length squared.
    """
    middle, length = 0.5 * (starts + ends), ends - starts
    scaled = 2 * (middle - low) / (high - low) - 1
    matrix = chebyshev.chebvander(scaled, scaled.size - 1)
    columns = [v / length for v in sums.values()] + list(extremes.values())
    found = np.linalg.solve(matrix, np.stack(columns, axis=1)).T
    names = [*sums, *extremes]
    series = dict(zip(names, found, strict=True))
    return Survey(
        low=low,
        high=high,
        **series,
        error_work=(high - low) * _tail(series["work"]) / scaled.size,
        error_extreme=max(_tail(series["ahead"]), _tail(series["behind"])),
        error_surplus=max(_tail(series["surplus"]), _tail(series["deficit"])),
    )
