"""Periodic profile of a measured surface, and friction over its rows."""

from collections.abc import Sequence
from typing import NamedTuple

import jax
import numpy as np
from jaxtyping import Float

from .._checks import as_real, require, require_whole
from ..bristles import AbstractBristle
from ..model import friction
from ..profiles import (
    Fourier,
    HeightsFit,
    SeriesFit,
    complex_series,
    fit_rows_in_phase,
    fit_series,
    mean_in_phase,
    warn_of,
)
from .files import Measured
from .settings import SETTINGS

_LAW = (
    "rho_plus",
    "rho_minus",
    "mu_plus",
    "mu_minus",
    "omega_plus",
    "omega_minus",
    "normal_plus",
    "normal_minus",
    "alpha",
    "a",
)


def fit_profile(
    measured: Measured,
    period: float | None = None,
    harmonics: int = 8,
    row: int | None = None,
    smoothing: float | None = None,
) -> HeightsFit[Fourier]:
    """One periodic profile of a measured surface, as `Fourier.from_heights` returns it.

    `row`: which row, from 0; None: the mean over all rows, each moved into phase by all of
    its harmonics first, since grooves cross the rows of a map at an angle.
    `smoothing`: cut-off in m of a Gaussian filter along the rows; None: no filter.

    Warns and raises `ValueError` as `Fourier.from_heights`, and for a row that is not
    there.

    >>> x = np.linspace(0.0, 1e-4, 201)
    >>> groove = fx.measured.Measured(x, 3e-7 * np.sin(2 * np.pi * x / 2e-5)[None])
    >>> print(f"{fx.measured.fit_profile(groove, harmonics=2).slopes.omega_plus:.4f}")
    0.0942
    """
    heights = measured.heights
    if row is not None:
        require_whole("row", row, 0)
        rows = heights.shape[0]
        require(row < rows, "row", row, f"0 <= row <= {rows - 1}")
        heights = heights[row]
    fit = fit_series(measured.x, heights, period, harmonics, smoothing)
    warn_of(fit.slopes)
    return fit


class RowCoefficients(NamedTuple):
    """Friction of each row of a map, by name: arrays over the rows used.

    `values` in N, or without unit. `period` in m, one for all rows. `used`: indices of the
    rows used. `refused`: index and reason of the rows whose fit the bristle does not admit.
    `error`: standard error of the friction of the mean profile (rows moved into phase), by
    name; empty where it cannot be told. `profiles`: of the rows used.

    >>> x = np.linspace(0.0, 1e-4, 201)
    >>> heights = np.outer([3e-7, 2e-7], np.sin(2 * np.pi * x / 2e-5))
    >>> groove = fx.measured.Measured(x, heights)
    >>> rows = fx.measured.row_coefficients(groove, scene.bristle, harmonics=2)
    >>> print(f"{rows.mean['rho_plus']:.4f} N, over rows +- {rows.std['rho_plus']:.4f} N")
    0.0915 N, over rows +- 0.0293 N
    """

    values: dict[str, Float[np.ndarray, " rows"]]
    period: float
    used: list[int]
    refused: dict[int, str]
    error: dict[str, float]
    profiles: Sequence[Fourier] = ()

    @property
    def mean(self) -> dict[str, float]:
        """Mean over rows, by name."""
        return {name: float(np.mean(v)) for name, v in self.values.items()}

    @property
    def std(self) -> dict[str, float]:
        """Standard deviation of a row, by name; NaN for a single row."""
        return {
            name: float(np.std(v, ddof=1)) if v.size > 1 else float("nan")
            for name, v in self.values.items()
        }


def row_coefficients(
    measured: Measured,
    bristle: AbstractBristle,
    harmonics: int = 8,
    period: float | None = None,
    smoothing: float | None = None,
) -> RowCoefficients:
    """Friction coefficients of every row of a map, fitted with one period for all.

    Besides the numbers of `friction`, `ratio` = -rho_plus/rho_minus and `explained`, the
    share of a row's variance that its periodic profile explains. Noise adds to the extreme
    slopes of a row, so the mean over rows lies above the friction of the mean profile,
    whose standard error is `.error`. `smoothing`: as in `Fourier.from_heights`.

    Raises `ValueError` where the heights have no period, or no row is admissible.

    >>> x = np.linspace(0.0, 1e-4, 201)
    >>> heights = np.outer([3e-7, 2e-7], np.sin(2 * np.pi * x / 2e-5))
    >>> groove = fx.measured.Measured(x, heights)
    >>> rows = fx.measured.row_coefficients(groove, scene.bristle, harmonics=2)
    >>> print(rows.values["rho_plus"].round(4))
    [0.1123 0.0708]
    """
    x, heights = measured.x, measured.heights
    fits = fit_rows_in_phase(x, heights, period, harmonics, smoothing)
    found: list[dict[str, float]] = []
    used: list[int] = []
    profiles: list[Fourier] = []
    refused: dict[int, str] = {}
    for index, fit in enumerate(fits):
        profile = _row_profile(fit)
        try:
            found.append(_law(profile, bristle) | {"explained": fit.explained})
            used.append(index)
            profiles.append(profile)
        except ValueError as error:
            refused[index] = str(error)
    first = next(iter(refused.values()), "")
    require(bool(found), "rows", "none admissible", f"one that is; row 0: {first}")
    values = {name: np.array([law[name] for law in found]) for name in found[0]}
    error = _jackknife(fits, bristle)
    return RowCoefficients(values, fits[0].period, used, refused, error, profiles)


def _row_profile(fit: SeriesFit) -> Fourier:
    """The profile of one row, without errors of its own."""
    return Fourier(as_real(fit.cos), as_real(fit.sin))


def _mean_profile(fits: Sequence[SeriesFit]) -> Fourier:
    """Mean of profiles that differ in phase."""
    mean = mean_in_phase([complex_series(fit) for fit in fits])
    return Fourier(as_real(mean.real), as_real(-mean.imag))


def _law(profile: Fourier, bristle: AbstractBristle) -> dict[str, float]:
    law = jax.device_get(friction(profile, bristle))
    numbers = {name: float(getattr(law, name)) for name in _LAW}
    return numbers | {"ratio": -numbers["rho_plus"] / numbers["rho_minus"]}


def _jackknife(fits: list[SeriesFit], bristle) -> dict[str, float]:
    """Standard errors by leaving out one block of rows after the other."""
    count = min(SETTINGS.blocks, len(fits))
    if count < 2:
        return {}
    blocks = np.array_split(np.arange(len(fits)), count)
    kept = [[fits[i] for b in blocks if b is not left for i in b] for left in blocks]
    try:
        laws = [_law(_mean_profile(part), bristle) for part in kept]
    except ValueError:  # a mean profile that the bristle does not admit
        return {}
    shrink = np.sqrt(count - 1)
    return {n: float(shrink * np.std([law[n] for law in laws])) for n in laws[0]}
