"""Periodic profile of a measured surface."""

from collections.abc import Sequence

from .._checks import as_real, require, require_whole
from ..profiles import Fourier, HeightsFit, SeriesFit, complex_series, mean_in_phase
from ..profiles import fit_rows_in_phase as fit_rows_of
from .files import Measured


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
    heights = measured.heights
    if row is not None:
        require_whole("row", row, 0)
        rows = heights.shape[0]
        require(row < rows, "row", row, f"0 <= row <= {rows - 1}")
        heights = heights[row]
    return Fourier.from_heights(measured.x, heights, period, harmonics, smoothing)


def fit_rows(
    measured: Measured,
    period: float | None,
    harmonics: int,
    smoothing: float | None = None,
) -> list[SeriesFit]:
    """A fit of each row, with one period (m), found on all rows together if None."""
    return fit_rows_of(measured.x, measured.heights, period, harmonics, smoothing)


def row_profile(fit: SeriesFit) -> Fourier:
    """The profile of one row, for its friction alone."""
    return Fourier(as_real(fit.cos), as_real(fit.sin))


def mean_profile(fits: Sequence[SeriesFit]) -> Fourier:
    """Mean of profiles that differ in phase."""
    mean = mean_in_phase([complex_series(fit) for fit in fits])
    return Fourier(as_real(mean.real), as_real(-mean.imag))
