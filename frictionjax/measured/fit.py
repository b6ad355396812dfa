"""Periodic profile of a measured surface."""

import numpy as np

from ..arguments import as_real, require
from ..profiles import Fourier
from ..profiles.heights import HeightsFit, SeriesFit, find_period, fit_heights
from ..profiles.slope_errors import warn_of
from ..profiles.steepest import Waves
from .files import Measured

_BLOCKS = 10  # of neighbouring rows, which are not independent of each other


def fit_profile(
    measured: Measured,
    period: float | None = None,
    harmonics: int = 8,
    row: int | None = None,
    smoothing: float | None = None,
) -> HeightsFit[Fourier]:
    """One periodic profile of a measured surface, as `Fourier.from_heights` returns it.

    `row`: which row, from 0; None: the mean over all rows, each moved so that its
    fundamental is in phase first, since grooves cross the rows of a map at an angle.
    `smoothing`: cut-off in m of a Gaussian filter along the rows; None: no filter.

    Raises `ValueError` as `Fourier.from_heights`, and for a row that is not there.
    """
    x, heights = measured
    rows = heights.shape[0]
    if row is not None:
        require(0 <= row < rows, "row", row, f"0 <= row <= {rows - 1}")
    if row is not None or rows == 1:
        trace = heights[row or 0]
        return Fourier.from_heights(x, trace, period, harmonics, smoothing)
    fits = fit_rows(measured, period, harmonics, smoothing)
    explained = float(np.mean([fit.explained for fit in fits]))
    mean = _mean_waves([row_series(fit) for fit in fits])
    profile, slopes = Fourier.of_measured(mean.real, -mean.imag, mean_waves(fits))
    warn_of(slopes)
    return HeightsFit(profile, fits[0].period, explained, slopes, smoothing)


def fit_rows(
    measured: Measured,
    period: float | None,
    harmonics: int,
    smoothing: float | None = None,
) -> list[SeriesFit]:
    """A fit of each row, with one period (m), found on all rows together if None."""
    x, heights = measured
    if period is None:
        period = find_period(x, heights, harmonics)
    return [fit_heights(x, row, period, harmonics, smoothing) for row in heights]


def row_profile(fit: SeriesFit) -> Fourier:
    """The profile of one row, for its friction alone."""
    return Fourier(as_real(fit.cos), as_real(fit.sin))


def row_series(fit: SeriesFit) -> np.ndarray:
    """Coefficients of `Re sum_n c_n exp(2 pi i n y)`, shape (harmonics,)."""
    return fit.cos - 1j * fit.sin


def mean_profile(fits: list[SeriesFit]) -> Fourier:
    """Mean of profiles that differ in phase."""
    mean = _mean_waves([row_series(fit) for fit in fits])
    return Fourier(as_real(mean.real), as_real(-mean.imag))


def mean_waves(fits: list[SeriesFit]) -> Waves:
    """Mean of all waves that the rows tell apart, moved into phase, and its noise.

    The noise is what rows leave of their own, or the scatter over blocks of rows where
    that is larger: rows may differ, and neighbours are not independent.
    """
    rows = np.array([_in_phase(fit.waves.c) for fit in fits])
    blocks = np.array_split(rows, min(_BLOCKS, len(fits)))
    means = np.array([block.mean(axis=0) for block in blocks])
    between = np.var(means, axis=0, ddof=1) / (2 * len(blocks))
    own = np.mean([fit.waves.noise**2 for fit in fits], axis=0) / len(fits)
    noise = np.sqrt(np.maximum(own, between))
    return Waves(rows.mean(axis=0), noise, fits[0].waves.gain)


def _mean_waves(rows: list[np.ndarray]) -> np.ndarray:
    return np.mean([_in_phase(row) for row in rows], axis=0)


def _in_phase(waves: np.ndarray) -> np.ndarray:
    """Moved so that `c_1` is positive."""
    turn = np.exp(-1j * np.angle(waves[0]))
    return waves * turn ** np.arange(1, waves.size + 1)
