"""Periodic cubic spline."""

from typing import Any, ClassVar

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from .._checks import Asked, as_jax, as_real, is_concrete, is_known, known_numbers, require
from .slope_errors import (
    AbstractSampled,
    SlopeErrors,
    of_heights,
    require_once,
    require_slope_error,
    warn_of,
    with_taken,
)
from .smoothing import gaussian_gain


class Spline(AbstractSampled):
    """Periodic cubic spline through `heights` at y = 0, 1/n, ..., (n-1)/n.

    `heights`: in periods, shape (n,), n >= 4; the point y = 1 is the first one again and
    is not repeated. C^2 everywhere, the seam included, by construction.

    The leaf is the B-spline coefficients, so evaluation solves nothing; gradients with
    respect to heights go through the constructor.

    A spline through samples of corners, or through noise, is steeper than what was
    measured: `.slope_errors()` says by how much, and 16 heights or more that leave a
    steepest slope open by more than 10% are a `SlopesUndetermined` warning. (Fewer are
    taken for points of a design.) Noise is told from the surface where it is white; noise
    that neighbours share is not, and the errors are far too small then. `slope_error`: of
    omega_plus and omega_minus, where they are known better than the heights tell, shape
    (2,); `slope_taken`: what of it a smoothing filter has taken off.

    Raises `ValueError` for fewer than 4 heights, a wrong shape, heights that are not
    finite or all equal, or the first one again at the end.

    >>> y = np.arange(16) / 16
    >>> surface = fx.profiles.Spline(0.02 * np.sin(2 * np.pi * y))
    >>> law = fx.friction(surface, scene.bristle)
    >>> print(f"{law.omega_plus:.4f}, of the sine {0.04 * np.pi:.4f}")
    0.1256, of the sine 0.1257
    """

    asked: ClassVar = {
        "heights": Asked("periods", "a list of 4 or more, not all equal", row=True),
        "slope_error": Asked("no unit", "two numbers >= 0", row=True),
        "slope_taken": Asked("no unit", "two numbers >= 0", row=True),
    }

    coefficients: Float[Array, " n"]
    slope_error: Float[Array, "2"] | None = None
    slope_taken: Float[Array, "2"] | None = None

    def __init__(self, heights: Any, slope_error: Any = None, slope_taken: Any = None):
        heights = as_real(heights)
        if is_known(heights):
            _require_heights(heights)
        self.slope_error = None if slope_error is None else as_real(slope_error)
        require_slope_error(self.slope_error)
        self.slope_taken = None if slope_taken is None else as_real(slope_taken)
        require_slope_error(self.slope_taken, "slope_taken")
        # By NumPy: 14 programs for a few steps of known numbers took 0.5 s to compile.
        concrete = is_concrete(heights)
        known = np.asarray(heights) if concrete else heights
        self.coefficients = as_real(_coefficients(known, np if concrete else jnp))
        if concrete:
            warn_of(self.slope_errors(), heights.shape[0], stacklevel=5)  # equinox calls

    @classmethod
    def smoothed(cls, heights: Any, length: float) -> "Spline":
        """The spline through heights that a Gaussian filter has smoothed.

        `length`: its cut-off in periods; waves of that length are halved (ISO 16610-21).
        The filter lowers the slopes: `.slope_errors()` holds an estimate of what it takes
        off (`.taken_plus`, `.taken_minus`), which is part of their errors, beside the noise
        that the heights show before. It is a `SlopesUndetermined` warning where the errors
        are more than 10%.

        Raises `ValueError` as `Spline`, and for a length that is not in (0, 2.5].
        """
        _require_heights(heights)
        known = known_numbers(heights).astype(float)
        gain = gaussian_gain(length, 1.0, known.size // 2)
        spectrum = np.fft.rfft(known) * np.append(1.0, gain)
        smooth = np.fft.irfft(spectrum, known.size)
        errors = of_heights(known, _steepest(_coefficients(smooth, np)), gain)
        if errors is None:
            return cls(smooth)
        return cls(smooth, errors[2:4], errors[4:])

    def slope_errors(self) -> SlopeErrors | None:
        """How far the steepest slopes may be off, if the heights are samples.

        None for fewer than 8 heights, and for traced ones.
        """
        if not is_concrete(self):
            return None
        slopes = _steepest(np.asarray(self.coefficients))
        if self.slope_error is not None:
            return with_taken(slopes, self.slope_error, self.slope_taken)
        return of_heights(_heights(np.asarray(self.coefficients), np), slopes)

    def __check_init__(self):
        if is_known(self.coefficients):
            _require_heights(self.coefficients)

    @property
    def heights(self) -> Float[Array, " n"]:
        """The interpolated heights, shape (n,)."""
        if is_concrete(self.coefficients):
            return as_jax(_heights(np.asarray(self.coefficients), np))
        return _heights(self.coefficients, jnp)

    def __call__(self, y: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        y = jnp.asarray(y)
        count = self.coefficients.shape[0]
        place = (y - jnp.floor(y)) * count
        knot = jnp.floor(place)
        s = place - knot
        index = knot.astype(jnp.int32)
        weights = (
            (1 - s) ** 3 / 6,
            (3 * s**3 - 6 * s**2 + 4) / 6,
            (-3 * s**3 + 3 * s**2 + 3 * s + 1) / 6,
            s**3 / 6,
        )
        terms = [
            weight * self.coefficients[(index + shift - 1) % count]
            for shift, weight in enumerate(weights)
        ]
        return sum(terms[1:], terms[0])

    @property
    def points(self) -> int:
        return 16 * max(16, self.coefficients.shape[0])


def _coefficients(heights: Any, xp: Any) -> Any:
    # c_{k-1} + 4 c_k + c_{k+1} = 6 h_k is circulant: diagonal after an FFT.
    count = heights.shape[0]
    symbol = (4 + 2 * np.cos(2 * np.pi * np.arange(count // 2 + 1) / count)) / 6
    return xp.fft.irfft(xp.fft.rfft(heights) / symbol, count)


def _heights(c: Any, xp: Any) -> Any:
    return (xp.roll(c, 1) + 4 * c + xp.roll(c, -1)) / 6


def _steepest(c: np.ndarray) -> tuple[float, float]:
    """Largest and smallest slope: w' is a parabola between knots, w'' a line."""
    count = c.size
    slope = 0.5 * count * (np.roll(c, -1) - np.roll(c, 1))
    bend = count * (np.roll(c, -1) - 2 * c + np.roll(c, 1))
    after = np.roll(bend, -1)
    turns = bend * after < 0
    share = np.where(turns, bend / np.where(turns, bend - after, 1.0), 0.0)
    slopes = np.concatenate([slope, slope + 0.5 * share * bend])
    return float(slopes.max()), float(slopes.min())


def _require_heights(given: Any) -> None:
    heights = known_numbers(given)
    enough = heights.ndim == 1 and heights.size >= 4
    require(enough, "profile.heights", given, "4 or more heights, shape (n,)")
    require(np.all(np.isfinite(heights)), "profile.heights", heights, "finite heights")
    require(np.ptp(heights) > 0, "profile.heights", heights, "heights that vary")
    require_once(heights)
