"""Periodic profile of a measured surface."""

from ..arguments import require
from ..profiles import Fourier
from ..profiles.heights import HeightsFit, find_period
from ..profiles.rows import mean_in_phase
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
    x, heights = measured.x, measured.heights
    rows = heights.shape[0]
    if row is not None:
        require(0 <= row < rows, "row", row, f"0 <= row <= {rows - 1}")
        return Fourier.from_heights(x, heights[row], period, harmonics)
    return Fourier.from_heights(x, heights, period, harmonics)


def fit_rows(
    measured: Measured, period: float | None, harmonics: int
) -> list[HeightsFit[Fourier]]:
    """A profile for each row, with one period (m), found on all rows together if None."""
    x, heights = measured.x, measured.heights
    if period is None:
        period = find_period(x, heights, harmonics)
    return [Fourier.from_heights(x, row, period, harmonics) for row in heights]


def mean_profile(fits: list[HeightsFit[Fourier]]) -> Fourier:
    """Mean of profiles that differ in phase."""
    return Fourier(*mean_in_phase([(f.profile.cos, f.profile.sin) for f in fits]))
