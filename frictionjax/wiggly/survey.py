"""Sums and extremes over a long slide from a few of its slip periods."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

NODES = 17  # periods measured in a slide, unless it takes more
_FINE = 257  # points at which extremes of the fitted curves are looked for
WORK, VISCOUS, RESIDUAL = range(3)  # rows of what is summed
AHEAD, BEHIND, SURPLUS, DEFICIT = range(4)  # rows of what has extremes


class Survey(NamedTuple):
    """Curves over a slide, fitted in time to what was measured in whole slip periods.

    `low`, `high`: ends in s. `primitives` (3, n + 1): Chebyshev series of the sums since
    `low`, in J, and `whole` (3,) at `high`: work, viscous, residual. At `_FINE` times:
    `work` (fine,) since `low`, and `extremes` (4, fine): of z - path over a period, ahead
    and behind, m; of the dissipation beyond the path's, less what the work adds, surplus
    and deficit, J. `residual` since `low` at `times` (n + 2,), J. `error_*`: estimates from
    the last coefficients: of the integrals in J, of extremes in m, of surpluses in J.
    """

    low: float
    high: float
    primitives: np.ndarray
    whole: np.ndarray
    times: np.ndarray
    residual: np.ndarray
    work: np.ndarray
    extremes: np.ndarray
    error_work: float
    error_extreme: float
    error_surplus: float

    def integrals(self, times: np.ndarray) -> np.ndarray:
        """`int_low^t` of what is summed, in J, (3, times)."""
        scaled = 2 * (times - self.low) / (self.high - self.low) - 1
        found = chebyshev.chebval(scaled, self.primitives.T)
        found[RESIDUAL] = np.interp(times, self.times, self.residual)
        return found


def _residuals(low, high, middle, density) -> tuple[np.ndarray, np.ndarray]:
    """Times and running integrals of a density >= 0 that is known at `middle`.

    What steps leave of the balance is not smooth: a curve through it fell below 0, by 3e-7
    of the dissipation. Straight lines between neighbours do not.
    """
    times = np.concatenate([low[:, None], middle, high[:, None]], axis=1)
    known = np.concatenate([density[:, :1], density, density[:, -1:]], axis=1)
    parts = 0.5 * np.diff(times, axis=1) * (known[:, 1:] + known[:, :-1])
    none = np.zeros_like(low)[:, None]
    return times, np.concatenate([none, np.cumsum(parts, axis=1)], axis=1)


def nodes_of(low: float, high: float, count: int) -> np.ndarray:
    """Times of a Chebyshev-Lobatto grid: ends included, where slides change fastest."""
    x = -np.cos(np.pi * np.arange(count) / (count - 1))
    return 0.5 * (low + high) + 0.5 * (high - low) * x


def through_nodes(low, high, values: np.ndarray, times: np.ndarray) -> np.ndarray:
    """The polynomial with `values` (n, count) at the nodes of [low, high] (s, (n,)), at
    `times` (n, m)."""
    count = values.shape[1]
    matrix = chebyshev.chebvander(nodes_of(-1.0, 1.0, count), count - 1)
    series = np.linalg.solve(matrix, values.T).T
    scaled = 2 * (times - low[:, None]) / (high - low)[:, None] - 1
    basis = chebyshev.chebvander(np.clip(scaled, -1, 1), count - 1)
    return np.einsum("nmk,nk->nm", basis, series)


def _tails(series: np.ndarray) -> np.ndarray:
    """Size of the last coefficients: what a shorter series would have missed."""
    return np.max(np.abs(series[..., -3:]), axis=-1)


@lru_cache
def _fine_basis(count: int) -> np.ndarray:
    return chebyshev.chebvander(np.linspace(-1.0, 1.0, _FINE), count - 1)


def surveys_of(
    low: np.ndarray,
    high: np.ndarray,
    starts: np.ndarray,
    ends: np.ndarray,
    sums: np.ndarray,
    extremes: np.ndarray,
) -> list[Survey]:
    """Fit curves through n slip periods [starts, ends] (s) of slides over [low, high].

    `low`, `high` (slides,); `starts`, `ends` (slides, n). `sums` (slides, 3, n): over each
    period, J; `extremes` (slides, 4, n): in each. A sum over all periods is the integral of
    their density: the midpoint of a period stands for it up to its length squared. All
    slides at once: a loop over them took 0.2 ms each.
    """
    middle, length = 0.5 * (starts + ends), ends - starts
    scaled = 2 * (middle - low[:, None]) / (high - low)[:, None] - 1
    count = scaled.shape[1]
    matrix = chebyshev.chebvander(scaled, count - 1)
    with np.errstate(invalid="ignore", divide="ignore"):  # slips shorter than floats: NaN
        columns = np.concatenate([sums / length[:, None], extremes], axis=1)
    series = np.linalg.solve(matrix, columns.swapaxes(1, 2)).swapaxes(1, 2)
    half = 0.5 * (high - low)
    primitives = half[:, None, None] * chebyshev.chebint(series[:, :3], lbnd=-1, axis=2)
    whole = primitives.sum(axis=2)
    times, residual = _residuals(low, high, middle, columns[:, RESIDUAL])
    whole[:, RESIDUAL] = residual[:, -1]
    basis = _fine_basis(count + 1)
    fine = series[:, 3:] @ basis[:, :count].T
    work = primitives[:, WORK] @ basis.T
    tails = _tails(series)
    errors = 2 * half * tails[:, WORK] / count
    extreme, surplus = (np.max(tails[:, k : k + 2], axis=1) for k in (3, 5))
    return [
        Survey(*row)
        for row in zip(
            low.tolist(),
            high.tolist(),
            primitives,
            whole,
            times,
            residual,
            work,
            fine,
            errors.tolist(),
            extreme.tolist(),
            surplus.tolist(),
            strict=True,
        )
    ]
