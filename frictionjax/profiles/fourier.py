"""Finite Fourier series."""

from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from .._checks import Asked, as_real, is_concrete, is_known, known_numbers, require
from ..numerics import fourier_sum
from .heights import HeightsFit, fit_heights
from .rows import fit_map
from .slope_errors import (
    AbstractSampled,
    SlopeErrors,
    of_waves,
    require_slope_error,
    warn_of,
    with_taken,
)
from .steepest import SampledWaves, slopes_of_waves


class Fourier(AbstractSampled):
    """`w(y) = sum_n cos_n cos(2 pi n y) + sin_n sin(2 pi n y)`, n = 1, 2, ...

    `cos`, `sin`: coefficients in periods, shape (harmonics,) each. `slope_error`: of
    omega_plus and omega_minus, shape (2,), where the series stands for a measured surface
    (`from_heights`); None where it is exact. `slope_taken`: what of it a smoothing filter
    has taken off; None without one.

    Raises `ValueError` where the shapes differ, a coefficient is not finite or all are 0.

    >>> surface = fx.profiles.Fourier(cos=[0.0, 0.004], sin=[0.015, 0.003])
    >>> law = fx.friction(surface, scene.bristle)
    >>> print(f"slopes from {law.omega_minus:.3f} to {law.omega_plus:.3f}")
    slopes from -0.117 to 0.150
    """

    asked: ClassVar = {
        "cos": Asked("periods", "a list, not all 0 in both", row=True),
        "sin": Asked("periods", "a list, as long as cos", row=True),
        "slope_error": Asked("no unit", "two numbers >= 0", row=True),
        "slope_taken": Asked("no unit", "two numbers >= 0", row=True),
    }

    cos: Float[Array, " harmonics"] = eqx.field(converter=as_real)
    sin: Float[Array, " harmonics"] = eqx.field(converter=as_real)
    slope_error: Float[Array, "2"] | None = eqx.field(
        default=None, converter=lambda error: None if error is None else as_real(error)
    )

    slope_taken: Float[Array, "2"] | None = eqx.field(
        default=None, converter=lambda taken: None if taken is None else as_real(taken)
    )

    def __check_init__(self):
        if not is_known(self.cos, self.sin):
            return
        cos, sin = known_numbers(self.cos), known_numbers(self.sin)
        flat = cos.ndim == 1 and cos.size > 0
        require(flat, "profile.cos", self.cos, "coefficients, shape (harmonics,)")
        same = sin.shape == cos.shape
        require(same, "profile.sin", self.sin, f"shape {cos.shape} of cos")
        require(np.all(np.isfinite(cos)), "profile.cos", cos, "finite coefficients")
        require(np.all(np.isfinite(sin)), "profile.sin", sin, "finite coefficients")
        require(np.any(cos) or np.any(sin), "profile.cos", cos, "a coefficient != 0")
        require_slope_error(self.slope_error)
        require_slope_error(self.slope_taken, "slope_taken")

    def __call__(self, y: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        return fourier_sum(self.cos, self.sin, jnp.asarray(y))

    @property
    def points(self) -> int:
        return 64 * max(4, self.cos.shape[0])

    def slope_errors(self) -> SlopeErrors | None:
        """How far the steepest slopes may be off; None where nothing says so."""
        if self.slope_error is None or not is_concrete(self):
            return None
        slopes = slopes_of_waves(np.asarray(self.cos) - 1j * np.asarray(self.sin))
        return with_taken(slopes, self.slope_error, self.slope_taken)

    @classmethod
    def from_heights(
        cls,
        x: Any,
        heights: Any,
        period: float | None = None,
        harmonics: int = 8,
        smoothing: float | None = None,
    ) -> "HeightsFit[Fourier]":
        """Periodic profile of a measured trace, or of a map.

        `x`: positions in m, increasing, shape (n,). `heights`: in m, shape (n,); of a map,
        (rows, n): the mean over its rows, each moved into phase by all harmonics
        first, since grooves cross the rows at an angle (`.explained`: their mean).
        `period`: in m; found in the data where it is None. `harmonics`: how many.
        `smoothing`: cut-off in m of a Gaussian filter, by which waves of that length are
        halved (ISO 16610-21); None: no filter. It lowers the slopes: an estimate of what it
        takes off is `.slopes.taken_plus` and `.taken_minus`, a part of their errors.

        A straight trend and all harmonics are fitted together by least squares, which
        averages over the periods in the trace. Returns `.profile`, `.period` in m,
        `.explained`, the share of the detrended variance that the periodic profile
        explains, `.slopes`, the steepest slopes with their errors (corners that so few
        harmonics overshoot, noise, too few samples, the filter), and `.smoothing`. `w` =
        height/period, so slopes are those measured. Noise is told from the surface where it
        is white; of noise that neighbours share the errors know too little, and of one
        that repeats with the period nothing.

        Samples that are masked (`numpy.ma`) in either are left out.

        Warns (`SlopesUndetermined`) where a steepest slope, and so friction, is open by
        more than 10%. Raises `ValueError` for wrong shapes, values that are not finite,
        less than 1.5 periods, more harmonics than the samples can tell apart, parts of a
        period that are masked in every one, or a filter that leaves nothing.

        >>> x = np.linspace(0.0, 1e-4, 201)
        >>> heights = 3e-7 * np.sin(2 * np.pi * x / 2e-5)
        >>> fit = fx.profiles.Fourier.from_heights(x, heights, harmonics=2)
        >>> print(f"period {fit.period:.2e} m, slopes up to {fit.slopes.omega_plus:.4f}")
        period 2.00e-05 m, slopes up to 0.0942
        """
        fit = fit_series(x, heights, period, harmonics, smoothing)
        warn_of(fit.slopes)
        return fit

    @classmethod
    def of_measured(
        cls,
        cos: Float[np.ndarray, " harmonics"],
        sin: Float[np.ndarray, " harmonics"],
        waves: SampledWaves,
    ) -> "tuple[Fourier, SlopeErrors]":
        """A series in periods with the errors that measured waves leave to its slopes."""
        errors = of_waves(slopes_of_waves(cos - 1j * sin), waves)
        taken = as_real(errors[4:]) if any(errors[4:]) else None
        return cls(as_real(cos), as_real(sin), as_real(errors[2:4]), taken), errors


def fit_series(
    x: Any, heights: Any, period: float | None, harmonics: int, smoothing: float | None
) -> HeightsFit[Fourier]:
    """As `Fourier.from_heights`, whose warning is left to the caller."""
    fit_all = fit_map if np.ndim(heights) == 2 else fit_heights
    fit = fit_all(x, heights, period, harmonics, smoothing)
    profile, slopes = Fourier.of_measured(fit.cos, fit.sin, fit.waves)
    return HeightsFit(profile, fit.period, fit.explained, slopes, smoothing)
