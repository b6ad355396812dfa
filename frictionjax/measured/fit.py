"""Periodic profile of a measured surface."""

import numpy as np

from ..arguments import require, require_whole
from ..profiles import Fourier
from ..profiles.heights import HeightsFit, find_period
from .files import Measured


def fit_profile(
    measured: Measured,
    period: float | None = None,
    harmonics: int = 8,
    row: int | None = None,
) -> HeightsFit[Fourier]:
    """One periodic profile of a measured surface, with `.period` and `.explained`.

    `row`: which row, from 0; None: the mean over all rows, each moved so that its
    fundamental is in phase first, since grooves cross the rows of a map at an angle.

    Raises `ValueError` as `Fourier.from_heights`, and for a row that is not there.
    """
    x, heights = measured
    rows = heights.shape[0]
    if row is not None:
        require_whole("row", row, 0)
        require(row < rows, "row", row, f"0 <= row <= {rows - 1}")
        return Fourier.from_heights(x, heights[row], period, harmonics)
    if rows == 1:
        return Fourier.from_heights(x, heights[0], period, harmonics)
    fits = fit_rows(measured, period, harmonics)
    explained = float(np.mean([fit.explained for fit in fits]))
    return HeightsFit(mean_profile(fits), fits[0].period, explained)


def fit_rows(
    measured: Measured, period: float | None, harmonics: int
) -> list[HeightsFit[Fourier]]:
    """A profile for each row, with one period (m), found on all rows together if None."""
    x, heights = measured
    if period is None:
        period = find_period(x, heights, harmonics)
    return [Fourier.from_heights(x, row, period, harmonics) for row in heights]


def mean_profile(fits: list[HeightsFit[Fourier]]) -> Fourier:
    """Mean of profiles that differ in phase."""
    waves = np.mean([_in_phase(fit.profile) for fit in fits], axis=0)
    return Fourier(waves.real, -waves.imag)


def _in_phase(profile: Fourier) -> np.ndarray:
    """Coefficients of `sum_n c_n exp(2 pi i n y)`, moved so that `c_1` is positive."""
    waves = np.asarray(profile.cos) - 1j * np.asarray(profile.sin)
    turn = np.exp(-1j * np.angle(waves[0]))
    return waves * turn ** np.arange(1, waves.size + 1)
