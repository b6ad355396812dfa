"""Sums and extremes over a long slide from a few of its slip periods."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from numpy.polynomial import chebyshev

from .settings import SETTINGS

WORK, VISCOUS, RESIDUAL = range(3)  # rows of what is summed
AHEAD, BEHIND, OUTSIDE, SURPLUS, DEFICIT = range(5)  # rows of what has extremes


class SampledSlide(NamedTuple):
    """Curves over a slide, fitted in time to what was measured in whole slip periods.

    `low`, `high`: ends in s. `primitives` (3, n + 1): Chebyshev series of the sums since
    `low`, in J, and `whole` (3,) at `high`: work, viscous, residual. At `fine` times:
    `work` (fine,) since `low`, and `extremes` (5, fine): of z - path over a period, ahead
    and behind, and of the way from the strip to z, m; of the dissipation beyond the path's,
    less what the work adds, surplus and deficit, J. `residual` since `low` at `times` (n +
    2,), J. `error_*`: estimates from the last coefficients: of the integrals in J, of
    extremes in m, of surpluses in J.
    """

    low: float
    high: float
    primitives: Float[np.ndarray, "3 terms"]
    whole: Float[np.ndarray, "3"]
    times: Float[np.ndarray, " nodes"]
    residual: Float[np.ndarray, " nodes"]
    work: Float[np.ndarray, " fine"]
    extremes: Float[np.ndarray, "5 fine"]
    error_work: float
    error_viscous: float
    error_extreme: float
    error_surplus: float

    def integrals(self, times: Float[np.ndarray, " n"]) -> Float[np.ndarray, "3 n"]:
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


def nodes_of(low: float, high: float, count: int) -> Float[np.ndarray, " count"]:
    """Times of a Chebyshev-Lobatto grid: ends included, where slides change fastest."""
    x = -np.cos(np.pi * np.arange(count) / (count - 1))
    return 0.5 * (low + high) + 0.5 * (high - low) * x


def through_nodes(
    low: Float[np.ndarray, " n"],
    high: Float[np.ndarray, " n"],
    values: Float[np.ndarray, "n count"],
    times: Float[np.ndarray, "n m"],
) -> Float[np.ndarray, "n m"]:
    """The polynomial with `values` (n, count) at the nodes of [low, high] (s, (n,)), at
    `times` (n, m)."""
    count = values.shape[1]
    matrix = chebyshev.chebvander(nodes_of(-1.0, 1.0, count), count - 1)
    series = np.linalg.solve(matrix, values.T).T
    scaled = 2 * (times - low[:, None]) / (high - low)[:, None] - 1
    basis = chebyshev.chebvander(np.clip(scaled, -1, 1), count - 1)
    return np.einsum("nmk,nk->nm", basis, series)


def _tails(series: np.ndarray, fits: np.ndarray) -> np.ndarray:
    """Size of the last coefficients: what a shorter series would have missed."""
    count = fits.shape[-1]
    used = np.sum(np.any(fits != 0, axis=2), axis=1)
    last = np.maximum(used[:, None] - SETTINGS.last, 0) + np.arange(SETTINGS.last)
    found = np.abs(np.take_along_axis(series, last[:, None], axis=2)).max(axis=2)
    return np.where(used < count, SETTINGS.uncertain, 1.0)[:, None] * found


@lru_cache
def _fine_basis(count: int) -> np.ndarray:
    return chebyshev.chebvander(np.linspace(-1.0, 1.0, SETTINGS.fine), count - 1)


@lru_cache
def _places(count: int) -> np.ndarray:
    return chebyshev.chebvander(nodes_of(-1.0, 1.0, SETTINGS.places * count + 1), count - 1)


def _fit_at(scaled: np.ndarray) -> np.ndarray:
    """Matrices (n, count, count) from values at `scaled` (n, count) to Chebyshev series.

    Of as many coefficients as magnify errors little enough, the others 0. (Where
    nodes moved to whole periods are no Chebyshev points any more, interpolation swung by
    100 eps in 117 wells of which 57 were measured, with last coefficients of 2e-4 eps.)
    """
    number, count = scaled.shape
    fits = np.zeros((number, count, count))
    left, size = np.arange(number), count
    while left.size and size > 1:
        basis = chebyshev.chebvander(scaled[left], size - 1)
        # (The inverse of all takes a tenth of the time of as many pseudo-inverses.)
        apart = size == count and np.all(np.diff(scaled) > 0)
        fits[left, :size] = np.linalg.inv(basis) if apart else np.linalg.pinv(basis)
        fits[left, size:] = 0.0
        magnified = np.abs(_places(size) @ fits[left, :size]).sum(axis=2).max(axis=1)
        left = left[magnified > SETTINGS.magnified]
        size = int(SETTINGS.fewer * size)
    return fits


def _densities(means: np.ndarray, scaled, length, fits) -> np.ndarray:
    """Densities at the middles of periods, of which `means` (n, 3, count) are known.

    A mean is more by what the curvature adds to it: a relative 7e-5 of the work with 117
    wells in a third of a load's period, and of the energies dissipated there a sixteenth.
    """
    count = scaled.shape[1]
    if count < 3:
        return means
    second = chebyshev.chebder(np.eye(count), 2, axis=0)
    basis = chebyshev.chebvander(scaled, count - 3) @ (second @ fits)
    bent = means @ basis.swapaxes(1, 2)
    return means - bent * (length**2 / 24)[:, None]


def sampled_slides_of(
    low: Float[np.ndarray, " slides"],
    high: Float[np.ndarray, " slides"],
    starts: Float[np.ndarray, "slides n"],
    ends: Float[np.ndarray, "slides n"],
    sums: Float[np.ndarray, "slides 3 n"],
    extremes: Float[np.ndarray, "slides 5 n"],
) -> list[SampledSlide]:
    """Fit curves through n slip periods [starts, ends] (s) of slides over [low, high].

    `low`, `high` (slides,); `starts`, `ends` (slides, n). `sums` (slides, 3, n): over each
    period, J; `extremes` (slides, 5, n): in each. A sum over all periods is the integral of
    their density. All slides at once: a loop over them took 0.2 ms each.
    """
    middle, length = 0.5 * (starts + ends), ends - starts
    scaled = 2 * (middle - low[:, None]) / (high - low)[:, None] - 1
    count = scaled.shape[1]
    half, fits = 0.5 * (high - low), _fit_at(scaled)
    with np.errstate(invalid="ignore", divide="ignore"):  # slips shorter than floats: NaN
        means = sums / length[:, None]
        densities = _densities(means, scaled, length / half[:, None], fits)
        columns = np.concatenate([densities, extremes], axis=1)
    series = columns @ fits.swapaxes(1, 2)
    primitives = half[:, None, None] * chebyshev.chebint(series[:, :3], lbnd=-1, axis=2)
    whole = primitives.sum(axis=2)
    times, residual = _residuals(low, high, middle, means[:, RESIDUAL])
    whole[:, RESIDUAL] = residual[:, -1]
    basis = _fine_basis(count + 1)
    fine = series[:, 3:] @ basis[:, :count].T
    work = primitives[:, WORK] @ basis.T
    tails = _tails(series, fits)
    errors = 2 * half[:, None] * tails[:, :RESIDUAL] / count
    return [
        SampledSlide(
            low=float(low[k]),
            high=float(high[k]),
            primitives=primitives[k],
            whole=whole[k],
            times=times[k],
            residual=residual[k],
            work=work[k],
            extremes=fine[k],
            error_work=float(errors[k, WORK]),
            error_viscous=float(errors[k, VISCOUS]),
            error_extreme=float(tails[k, 3:6].max()),
            error_surplus=float(tails[k, 6:].max()),
        )
        for k in range(low.size)
    ]
