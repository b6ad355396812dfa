"""Rows of a map of heights: one period for all, moved into phase."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arguments import known_numbers, require
from .heights import SeriesFit, find_period, fit_heights


def fit_map(x: Any, heights: Any, period: float | None, harmonics: int) -> SeriesFit:
    """Fit of a map (rows, n): the mean of its rows; see `Fourier.from_heights`."""
    fits = fit_rows(x, heights, period, harmonics)
    if len(fits) == 1:  # a trace: its phase is kept
        return fits[0]
    cos, sin = mean_in_phase([(fit.cos, fit.sin) for fit in fits])
    explained = float(np.mean([fit.explained for fit in fits]))
    return SeriesFit(cos, sin, fits[0].period, explained)


def fit_rows(x: Any, heights: Any, period: float | None, harmonics: int) -> list[SeriesFit]:
    """A fit for each row of a map, with one period, found on all rows if None.

    Raises `ValueError` as `Fourier.from_heights`.
    """
    rows = known_numbers(heights)
    good = rows.ndim == 2 and rows.size > 0
    require(good, "heights", rows.shape, "heights of a map, shape (rows, n)")
    if period is None and len(rows) > 1:
        period = _common_period(known_numbers(x), rows.astype(float), harmonics)
    return [fit_heights(x, row, period, harmonics) for row in rows]


def _common_period(x: np.ndarray, rows: np.ndarray, harmonics: int) -> float | None:
    """The period of all rows; None where `fit_heights` will refuse a row, by name."""
    good = x.shape == rows.shape[1:] and x.size >= 8 and isinstance(harmonics, int)
    if not (good and np.all(np.isfinite(x)) and np.all(np.diff(x) > 0) and harmonics >= 1):
        return None
    require(np.all(np.isfinite(rows)), "heights", rows, "finite heights")
    return find_period(x.astype(float), rows, harmonics)


def mean_in_phase(coefficients: Sequence[tuple[Any, Any]]) -> tuple[Any, Any]:
    """Mean of cosine and sine coefficients of series that differ in phase."""
    waves = np.mean([_in_phase(cos, sin) for cos, sin in coefficients], axis=0)
    return waves.real, -waves.imag


def _in_phase(cos: Any, sin: Any) -> np.ndarray:
    """Coefficients of `sum_n c_n exp(2 pi i n y)`, moved so that `c_1` is positive."""
    waves = np.asarray(cos) - 1j * np.asarray(sin)
    turn = np.exp(-1j * np.angle(waves[0]))
    return waves * turn ** np.arange(1, waves.size + 1)
