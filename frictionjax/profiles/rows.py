"""Rows of a map of heights: one period for all, moved into phase."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from jaxtyping import Complex

from .._checks import is_masked, known_numbers, numbers_of, require, require_whole
from .alignment import moved, shifts_into_phase, variance_of_shift
from .heights import SeriesFit, find_period, fit_heights, require_left, require_repeated
from .settings import SETTINGS
from .steepest import SampledWaves


def fit_map(
    x: Any,
    heights: Any,
    period: float | None,
    harmonics: int,
    smoothing: float | None = None,
) -> SeriesFit:
    """Fit of a map (rows, n): the mean of its rows; see `Fourier.from_heights`."""
    fits = fit_rows_in_phase(x, heights, period, harmonics, smoothing)
    if len(fits) == 1:  # a trace: its phase is kept
        return fits[0]
    mean = mean_in_phase([complex_series(fit) for fit in fits])
    explained = float(np.mean([fit.explained for fit in fits]))
    return SeriesFit(mean.real, -mean.imag, fits[0].period, explained, mean_waves(fits))


def fit_rows_in_phase(
    x: Any,
    heights: Any,
    period: float | None,
    harmonics: int,
    smoothing: float | None = None,
) -> list[SeriesFit]:
    """A fit for each row of a map, with one period, found on all rows if None.

    Raises `ValueError` as `Fourier.from_heights`.
    """
    rows = heights if is_masked(heights) else numbers_of("heights", heights)
    good = np.ndim(rows) == 2 and np.size(rows) > 0
    require(good, "heights", np.shape(rows), "heights of a map, shape (rows, n)")
    if is_masked(rows):
        hidden = np.ma.getmaskarray(rows).sum(axis=1)
        for row, count in enumerate(hidden):
            require_left(f"heights, row {row}", int(count), rows.shape[1] - int(count))
    if period is None and len(rows) > 1:
        period = _common_period(known_numbers(x), _whole_rows(rows), harmonics)
    return [fit_heights(x, row, period, harmonics, smoothing) for row in rows]


def _whole_rows(rows: Any) -> np.ndarray:
    """The rows in which nothing is masked: they decide on the period of all."""
    if not is_masked(rows):
        return rows
    whole = ~np.ma.getmaskarray(rows).any(axis=1)
    require(whole.any(), "period", "None", "a period in m: every row is masked somewhere")
    return np.ma.getdata(rows)[whole].astype(float)


def _common_period(x: np.ndarray, rows: np.ndarray, harmonics: int) -> float | None:
    """The period of all rows; None where `fit_heights` will refuse a row, by name."""
    good = x.shape == rows.shape[1:] and x.size >= 8 and bool(np.all(np.isfinite(x)))
    if not (good and np.all(np.diff(x) > 0)):
        return None
    require_whole("harmonics", harmonics)
    require(np.all(np.isfinite(rows)), "heights", rows, "finite heights")
    period = find_period(x.astype(float), rows, harmonics)
    require_repeated(x, rows, period, harmonics)
    return period


def complex_series(fit: SeriesFit) -> Complex[np.ndarray, " harmonics"]:
    """Coefficients of `Re sum_n c_n exp(2 pi i n y)`, shape (harmonics,)."""
    return fit.cos - 1j * fit.sin


def mean_in_phase(
    series: Sequence[Complex[np.ndarray, " harmonics"]],
) -> Complex[np.ndarray, " harmonics"]:
    """Mean of complex coefficients of series that differ in phase."""
    return moved(np.array(series), shifts_into_phase(series)).mean(axis=0)


def mean_waves(fits: Sequence[SeriesFit]) -> SampledWaves:
    """Mean of all waves that the rows tell apart, moved into phase, and its noise.

    The noise is what rows leave of their own, or the scatter over blocks of rows where
    that is larger: rows may differ, and neighbours are not independent. With it what the
    mean loses where noise moves rows out of phase.
    """
    asked = [complex_series(fit) for fit in fits]
    rows = moved(np.array([fit.waves.c for fit in fits]), shifts_into_phase(asked))
    blocks = np.array_split(rows, min(SETTINGS.blocks, len(fits)))
    means = np.array([block.mean(axis=0) for block in blocks])
    between = np.var(means, axis=0, ddof=1) / (2 * len(blocks))
    single = np.mean([fit.waves.noise**2 for fit in fits], axis=0)
    mean = rows.mean(axis=0)
    lost = _lost(mean, np.sqrt(single), asked[0].size)
    noise = np.sqrt(np.maximum(single / len(fits), between) + lost**2)
    return SampledWaves(mean, noise, fits[0].waves.gain)


def _lost(mean: np.ndarray, noise: np.ndarray, harmonics: int) -> np.ndarray:
    """Of each wave of the mean, where the shifts of rows err by what noise leaves open."""
    variance = variance_of_shift(mean[:harmonics], noise[:harmonics])
    n = np.arange(1, mean.size + 1)
    return -np.expm1(-0.5 * (2 * np.pi * n) ** 2 * variance) * np.abs(mean)
