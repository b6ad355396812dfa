"""Periodic part of a measured height trace by least squares."""

from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
from jaxtyping import Float

from .._checks import (
    no_more,
    numbers_of,
    require,
    require_real,
    require_whole,
    without_masked,
)
from .settings import SETTINGS
from .slope_errors import SlopeErrors
from .smoothing import gaussian_gain
from .steepest import SampledWaves
from .subharmonics import subharmonics_stand_out

_Profile = TypeVar("_Profile")


class HeightsFit(NamedTuple, Generic[_Profile]):
    """Result of `Fourier.from_heights`.

    `profile`: w. `period` in m. `explained`: share of the detrended variance, before any
    smoothing.
    `slopes`: steepest slopes of the profile, with errors. `smoothing`: cut-off in m.

    >>> x = np.linspace(0.0, 1e-4, 201)
    >>> heights = 3e-7 * np.sin(2 * np.pi * x / 2e-5) + 1e-3 * x
    >>> fit = fx.profiles.Fourier.from_heights(x, heights, harmonics=2)
    >>> print(f"{fit.explained:.0%} of the variance, period {fit.period:.2e} m")
    100% of the variance, period 2.00e-05 m
    """

    profile: _Profile
    period: float
    explained: float
    slopes: SlopeErrors | None = None
    smoothing: float | None = None


class SeriesFit(NamedTuple):
    """Fourier coefficients `cos`, `sin` in periods, smoothed; `period` in the unit of x.

    `explained`: share of the detrended variance, before any smoothing. `waves`: of more
    harmonics than were asked for, with their noise.

    >>> from frictionjax.profiles import fit_rows_in_phase
    >>> x = np.linspace(0.0, 1e-4, 201)
    >>> rows = np.outer([3e-7, 2e-7], np.sin(2 * np.pi * x / 2e-5))
    >>> fits = fit_rows_in_phase(x, rows, period=None, harmonics=2, smoothing=None)
    >>> [f"{fit.sin[0]:.4f}" for fit in fits]
    ['0.0150', '0.0100']
    """

    cos: Float[np.ndarray, " harmonics"]
    sin: Float[np.ndarray, " harmonics"]
    period: float
    explained: float
    waves: SampledWaves


def _design(x: np.ndarray, period: float, harmonics: int) -> np.ndarray:
    phases = 2 * np.pi * np.outer(x / period, np.arange(1, harmonics + 1))
    trend = np.stack([np.ones_like(x), (x - x.mean()) / np.ptp(x)], axis=1)
    return np.concatenate([trend, np.cos(phases), np.sin(phases)], axis=1)


def _detrended_variance(x: np.ndarray, heights: np.ndarray) -> float:
    return float(np.var(heights - np.polyval(np.polyfit(x, heights, 1), x)))


def _misfit(x: np.ndarray, heights: np.ndarray, period: float, harmonics: int) -> float:
    """Squared error per sample, summed over the traces of a map (rows)."""
    design = _design(x, period, harmonics)
    solution = np.linalg.lstsq(design, heights.T, rcond=None)[0]
    return float(np.mean((heights.T - design @ solution) ** 2))


def find_period(
    x: Float[np.ndarray, " n"], heights: Float[np.ndarray, "*rows n"], harmonics: int
) -> float:
    """Period of one trace (n,) or of the rows of a map (rows, n).

    The strongest fundamental on a fine frequency grid from 1.5 periods in the trace to
    4 samples a period, then a search with all harmonics inside that peak. (All harmonics
    on the grid too: prefers two grooves as one period, since it always fits better.)
    Two or three of those as one period where that halves the variance of what is left, its
    degrees of freedom counted, or lessens it by waves that stand out of the noise: the
    fundamental of a profile may be its weakest wave. (Halving alone took half the period of
    60 rows with noise of 60% whose other waves were a third of the variance left.)
    """
    span = float(np.ptp(x))
    spacing = span / (x.size - 1)
    frequencies = np.arange(1.5 / span, 0.25 / spacing, SETTINGS.frequency_step / span)
    coarse = [_misfit(x, heights, 1 / f, 1) for f in frequencies]
    best = float(frequencies[int(np.argmin(coarse))])
    period, left = _refine(x, heights, best, harmonics)
    for multiple in (2, 3):
        if best / multiple * span < SETTINGS.longest:
            break
        longer, less = _refine(x, heights, best / multiple, harmonics)
        if left <= SETTINGS.worth * np.var(heights) or less >= left:
            continue
        known = x, heights, longer / multiple, multiple
        deciding = _deciding(x, best, harmonics)
        if less < SETTINGS.halves * left or subharmonics_stand_out(*known, deciding):
            period, left = longer, less
    return period


def require_repeated(
    x: np.ndarray, heights: np.ndarray, period: float, harmonics: int
) -> None:
    """Raise where heights do not repeat, and what was found is too short for a fit."""
    most = _most_harmonics(x, period)
    if harmonics <= most:
        return
    rows = heights.reshape(-1, x.size)
    varies = float(np.mean([_detrended_variance(x, row) for row in rows]))
    explained = 1 - _misfit(x, heights, period, most) / varies if varies else 0.0
    needs = (
        f"heights that repeat, or its value: the best, {period:.3g} m, explains "
        f"{max(explained, 0.0):.0%} of their variance"
    )
    require(explained >= SETTINGS.repeats, "period", "none was found", needs)


def _most_harmonics(x: np.ndarray, period: float) -> int:
    """As many as the samples of a period tell apart, 1 at least."""
    return max(1, int(0.5 * period * (x.size - 1) / float(np.ptp(x))) - 1)


def _refine(
    x: np.ndarray, heights: np.ndarray, frequency: float, harmonics: int
) -> tuple[float, float]:
    """Best period near 1/`frequency` and the variance that it leaves."""
    span, fits = float(np.ptp(x)), _deciding(x, frequency, harmonics)
    from scipy.optimize import minimize_scalar  # 0.3 s, for measured surfaces only

    search = minimize_scalar(
        lambda period: _misfit(x, heights, period, fits),
        bounds=(1 / (frequency + 0.5 / span), 1 / max(frequency - 0.5 / span, 1.5 / span)),
        method="bounded",
        options={"xatol": SETTINGS.period_found * span},
    )
    return float(search.x), float(search.fun) / max(1e-300, 1 - (2 * fits + 2) / x.size)


def _deciding(x: np.ndarray, frequency: float, harmonics: int) -> int:
    """Harmonics that decide on a period near 1/`frequency`."""
    most = max(1, int(0.5 * (x.size - 1) / (frequency * float(np.ptp(x)))) - 1)
    return min(harmonics, SETTINGS.most_deciding, most)


def fit_heights(
    x: Any,
    heights: Any,
    period: float | None,
    harmonics: int,
    smoothing: float | None = None,
) -> SeriesFit:
    """Fit trend and harmonics of `period` to a trace; see `Fourier.from_heights`."""
    (x, heights), masked = without_masked(x, heights)
    x, heights = (numbers_of(name, v) for name, v in (("x", x), ("heights", heights)))
    if masked:
        require_left("heights", masked, x.size)
    said = f"{x.size} positions" if x.ndim == 1 else x.shape
    require(x.ndim == 1 and x.size >= 8, "x", said, "8 or more positions, shape (n,)")
    fits, shape = heights.shape == x.shape, f"shape {heights.shape}"
    require(fits, "heights", shape, f"the shape {x.shape} of x")
    require(np.all(np.isfinite(x)), "x", x, "finite positions")
    require(np.all(np.isfinite(heights)), "heights", heights, "finite heights")
    require(np.all(np.diff(x) > 0), "x", x, "increasing positions")
    require_whole("harmonics", harmonics)
    most = (x.size - 3) // 2
    require(
        harmonics <= most,
        "harmonics",
        harmonics,
        f"harmonics <= {most}, of {x.size} samples",
    )
    variance = _detrended_variance(x, heights)
    noise = SETTINGS.rounding * np.max(np.abs(heights))
    require(variance > noise**2, "heights", "a straight line", "heights that vary")
    span, spacing = float(np.ptp(x)), float(np.ptp(x)) / (x.size - 1)
    if period is None:
        period = find_period(x, heights, harmonics)
        require_repeated(x, heights, period, harmonics)
    needs = f"0 < period <= {no_more(span / 1.5)} (1.5 periods in the trace)"
    require_real("period", period, needs, lambda p: 0 < p <= span / 1.5)
    most = _most_harmonics(x, period)
    needs = f"harmonics <= {most} at {period / spacing:.3g} samples a period"
    require(harmonics <= most, "harmonics", harmonics, needs)
    if masked:
        _require_covered(x / period, harmonics, masked)
    design = _design(x, period, harmonics)
    solution = np.linalg.lstsq(design, heights, rcond=None)[0]
    left = float(np.mean((heights - design @ solution) ** 2))
    c = _complex(solution) / period
    more = max(harmonics, min(SETTINGS.beyond * harmonics, most, SETTINGS.seen))
    waves = _waves(x, heights, period, more)
    if smoothing is not None:
        gain = gaussian_gain(smoothing, period, max(harmonics, waves.c.size))
        c, waves = gain[:harmonics] * c, waves._replace(gain=gain[: waves.c.size])
    return SeriesFit(c.real, -c.imag, float(period), 1.0 - left / variance, waves)


def _complex(solution: np.ndarray) -> np.ndarray:
    """Coefficients of `Re sum_k c_k exp(2 pi i k y)` in a solution of `_design`."""
    cos, sin = np.split(solution[2:], 2)
    return cos - 1j * sin


def _waves(
    x: np.ndarray, heights: np.ndarray, period: float, harmonics: int
) -> SampledWaves:
    """All waves that the samples tell apart, and their noise, from what these leave."""
    harmonics = min(harmonics, max(1, (x.size - 3) // 3))
    design = _design(x, period, harmonics)
    solution = np.linalg.lstsq(design, heights, rcond=None)[0]
    left = float(np.sum((heights - design @ solution) ** 2))
    free = max(1, x.size - design.shape[1])
    rounding = SETTINGS.rounding * float(np.ptp(heights))
    noise = max(np.sqrt(left / free), rounding) * np.sqrt(2 / x.size) / period
    return SampledWaves(
        _complex(solution) / period, np.full(harmonics, noise), np.ones(harmonics)
    )


def require_left(name: str, masked: int, left: int) -> None:
    """Raise where masks leave too few samples of a trace."""
    said = f"{masked} of {masked + left} masked"
    require(left >= 8, name, said, "8 or more samples that are not")


def _require_covered(phases: np.ndarray, harmonics: int, masked: int) -> None:
    """Check that samples are left in every part of a period that the harmonics need."""
    places = np.sort(phases % 1.0)
    gap = float(np.max(np.diff(places, append=places[0] + 1.0)))
    largest = 1.0 / (harmonics + 1)
    needs = f"samples in every {largest:.3g} of a period, for {harmonics} harmonics"
    said = f"{masked} of {masked + phases.size} masked, none in {gap:.3g} of a period"
    require(gap <= largest, "heights", said, needs)
