"""Errors of the steepest slopes of a surface that is known by samples."""

import abc
import math
import warnings
from typing import Any, NamedTuple

import numpy as np

from ..arguments import is_known, known_numbers, require
from .profile import AbstractProfile
from .steepest import Waves, error_of, noise_of, series, steepest

_WARNED = 0.1  # of a steepest slope: friction is about as wrong
_FEWEST = 8  # heights that say anything of what is between them
_DESIGNED = 16  # heights: fewer are points of a design, whose spline is what is meant
_SAME = 1e-9  # of the range: an end point that was copied
_ALIKE = 0.02  # of the range: one that was measured again
_SMOOTHER, _AS_SHARP = 0.3, 2.0  # the seam without the point, in terms of with it

ADVICE = (
    "Straight flanks with corners are profiles.Polyline(x, heights, radius); noise asks "
    "for smoothing of a stated length: Fourier.from_heights(..., smoothing=), --smoothing "
    "or profiles.Spline.smoothed(heights, length)"
)
REPEATED = "the point y = 1 is the first one again and is not repeated"


class SlopesUndetermined(UserWarning):
    """Samples that determine a steepest slope, and so friction, to 10% or worse.

    It is no error at any size: the profile is a surface all the same, if not the one that
    was measured, and what is said of it is right.
    """


class SlopeErrors(NamedTuple):
    """Steepest slopes of a profile made of samples, and how far off they may be.

    `omega_plus`, `omega_minus`: of the profile. `error_plus`, `error_minus`: of these, as
    estimates of the measured surface's: what corners, too few samples and noise leave
    open, about 95% of the time; inf where a flank is hardly longer than a spacing.
    """

    omega_plus: float
    omega_minus: float
    error_plus: float
    error_minus: float

    @property
    def relative(self) -> float:
        """The larger of the two errors, in terms of its slope."""
        parts = (self.error_plus, self.omega_plus), (self.error_minus, self.omega_minus)
        return max(e / abs(s) if s else math.inf for e, s in parts)

    @property
    def determined(self) -> bool:
        """Whether both slopes are known to better than 10%."""
        return self.relative <= _WARNED

    @property
    def message(self) -> str:
        """Both slopes with their errors, and what mends them where they are large."""
        plus = f"omega_plus = {self.omega_plus:.3g} +- {self.error_plus:.2g}"
        minus = f"omega_minus = {self.omega_minus:.3g} +- {self.error_minus:.2g}"
        if self.determined:
            return f"{plus}, {minus}"
        return f"the samples leave the steepest slopes open: {plus}, {minus}. {ADVICE}"


class AbstractSampled(AbstractProfile):
    """A profile that may stand for a measured surface, known by samples."""

    @abc.abstractmethod
    def slope_errors(self) -> SlopeErrors | None:
        """How far its steepest slopes may be off; None where nothing says so."""


def require_slope_error(given: Any) -> None:
    """Check `slope_error` of a profile: None, or two numbers >= 0."""
    if given is None or not is_known(given):
        return
    error = known_numbers(given)
    good = error.shape == (2,) and bool(np.all(error >= 0))
    require(good, "profile.slope_error", given, "two numbers >= 0, or None")


def of_waves(slopes: tuple[float, float], waves: Waves, samples=None) -> SlopeErrors:
    """Errors of the largest and the smallest slope of a profile, from what was measured.

    `waves`, `samples`: as `steepest` takes them.
    """
    below = None if samples is None else -samples
    error_plus = error_of(slopes[0], steepest(waves, samples))
    error_minus = error_of(-slopes[1], steepest(waves.mirrored(), below))
    return SlopeErrors(*slopes, error_plus, error_minus)


def of_heights(
    heights: np.ndarray, slopes: tuple[float, float], gain: np.ndarray | None = None
) -> SlopeErrors | None:
    """Errors of the slopes of an interpolant of heights at y = 0, 1/n, ...

    `gain`: of a filter on harmonics 1, 2, ... between heights and interpolant. None for
    fewer than 8 heights.
    """
    count = heights.size
    if count < _FEWEST:
        return None
    c = (2 / count * np.fft.rfft(heights))[1 : (count + 1) // 2]
    noise = np.full(c.size, noise_of(heights) * math.sqrt(2 / count))
    passed = np.ones(c.size) if gain is None else gain[: c.size]
    samples = heights if gain is None else series(passed * c, count)
    return of_waves(slopes, Waves(c, noise, passed), samples)


def warn_of(
    errors: SlopeErrors | None, count: int = _DESIGNED, stacklevel: int = 3
) -> None:
    """Warn where `count` samples leave a steepest slope open."""
    if errors is not None and count >= _DESIGNED and not errors.determined:
        warnings.warn(errors.message, SlopesUndetermined, stacklevel=stacklevel)


def require_once(heights: np.ndarray) -> None:
    """Check that the last height is not the first one again, at y = 1.

    It is where the two agree, no other neighbours do, and the seam is smoother without
    the last one: a `ValueError`. A warning where it may be: as sharp without it, at a
    corner, or nearly equal and smoother by far, measured again.
    """
    if heights.size < 5:
        return
    size, apart = np.ptp(heights), np.abs(np.diff(heights, append=heights[0]))
    if apart[-1] > _ALIKE * size:
        return
    smoother = _seam(heights[:-1]) / max(_seam(heights), 1e-300)
    alone = apart[-1] <= _SAME * size < np.min(apart[:-1])
    said = f"{heights[0]:.6g} and {heights[-1]:.6g} at its ends"
    copied = alone and smoother < 1
    require(not copied, "profile.heights", said, f"one period: {REPEATED}")
    if smoother < _SMOOTHER or (alone and smoother < _AS_SHARP):
        text = f"profile.heights = {said}: leave out the last if it is y = 1: {REPEATED}"
        warnings.warn(text, SlopesUndetermined, stacklevel=6)  # below `Spline(...)`


def _seam(heights: np.ndarray) -> float:
    """The largest third difference across the seam."""
    near = np.concatenate([heights[-3:], heights[:3]])
    return float(np.max(np.abs(np.diff(near, 3))))
