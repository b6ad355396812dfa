"""Errors of the steepest slopes of a surface that is known by samples."""

import abc
import math
import warnings
from typing import Any, NamedTuple

import numpy as np

from .._checks import as_text, is_known, known_numbers, require
from .filtered import taken_off
from .profile import AbstractProfile
from .settings import SETTINGS
from .steepest import SampledWaves, error_of, noise_of, series_values, steepest

ADVICE = (
    "Straight flanks with corners are profiles.Polyline(x, heights, radius); noise asks "
    "for smoothing of a stated length: Fourier.from_heights(..., smoothing=), --smoothing "
    "or profiles.Spline.smoothed(heights, length)"
)
SHORTER = "Most of it is taken off by the filter: a shorter smoothing takes off less"
REPEATED = "the point y = 1 is the first one again and is not repeated"


class SlopesUndetermined(UserWarning):
    """Samples that determine a steepest slope, and so friction, to 10% or worse.

    It is no error at any size: the profile is a surface all the same, if not the one that
    was measured, and what is said of it is right.

    >>> import warnings
    >>> x = np.arange(64) / 64
    >>> with warnings.catch_warnings(record=True, action="always") as told:
    ...     sawtooth = fx.profiles.Spline(np.minimum(x / 16, (1 - x) / 4))
    >>> print(told[0].message)
    the samples leave the steepest slopes open: omega_plus = 0.12 +- 0.063, ...
    """

    advice = ADVICE  # that its messages give, in terms of Python


class SlopeErrors(NamedTuple):
    """Steepest slopes of a profile made of samples, and how far off they may be.

    `omega_plus`, `omega_minus`: of the profile. `error_plus`, `error_minus`: of these, as
    estimates of the measured surface's: what corners, too few samples, noise and smoothing
    leave open, about 95% of the time; inf where a flank is hardly longer than a spacing.
    `taken_plus`, `taken_minus`: part of these errors, what a smoothing filter has taken
    off; 0 without one. Both are >= 0.

    Noise means white noise, another one at every sample: noise that neighbours share looks
    like the surface, of which one period cannot tell it, and the errors are far too small.

    >>> y = np.arange(16) / 16
    >>> fx.profiles.Spline(0.02 * np.sin(2 * np.pi * y)).slope_errors().message
    'omega_plus = 0.126 +- 1.9e-05, omega_minus = -0.126 +- 1.9e-05'
    """

    omega_plus: float
    omega_minus: float
    error_plus: float
    error_minus: float
    taken_plus: float = 0.0
    taken_minus: float = 0.0

    @property
    def relative(self) -> float:
        """The larger of the two errors, in terms of its slope."""
        parts = (self.error_plus, self.omega_plus), (self.error_minus, self.omega_minus)
        return max(e / abs(s) if s else math.inf for e, s in parts)

    @property
    def determined(self) -> bool:
        """Whether both slopes are known to better than 10%."""
        return self.relative <= SETTINGS.warned

    @property
    def message(self) -> str:
        """Both slopes with their errors, and what mends them where they are large."""
        plus = f"omega_plus = {self.omega_plus:.3g} +- {self.error_plus:.2g}"
        minus = f"omega_minus = {self.omega_minus:.3g} +- {self.error_minus:.2g}"
        text = f"{plus}, {minus}{self._filter_text()}"
        if self.determined:
            return text
        return f"the samples leave the steepest slopes open: {text}. {self._advice()}"

    def _filter_text(self) -> str:
        taken = self.taken_plus, self.taken_minus
        if not any(taken):
            return ""
        return f" (of which the filter takes off {taken[0]:.2g} and {taken[1]:.2g})"

    def _advice(self) -> str:
        """What mends the larger part of the larger error."""
        sides = (
            (self.error_plus, self.omega_plus, self.taken_plus),
            (self.error_minus, self.omega_minus, self.taken_minus),
        )
        error, _, taken = max(sides, key=lambda s: s[0] / max(abs(s[1]), 1e-300))
        return SHORTER if taken > 0.5 * error else ADVICE


class AbstractSampled(AbstractProfile):
    """A profile that may stand for a measured surface, known by samples.

    >>> known = fx.profiles.Fourier(cos=[0.0], sin=[0.02], slope_error=[0.01, 0.01])
    >>> known.slope_errors().message
    'omega_plus = 0.126 +- 0.01, omega_minus = -0.126 +- 0.01'
    """

    @abc.abstractmethod
    def slope_errors(self) -> SlopeErrors | None:
        """How far its steepest slopes may be off; None where nothing says so."""


def require_slope_error(given: Any, name: str = "slope_error") -> None:
    """Check `slope_error` or `slope_taken` of a profile: None, or two numbers >= 0."""
    if given is None or not is_known(given):
        return
    error = known_numbers(given)
    good = error.shape == (2,) and bool(np.all(error >= 0))
    require(good, f"profile.{name}", given, "two numbers >= 0, or None")


def with_taken(slopes: tuple[float, float], error: Any, taken: Any) -> SlopeErrors:
    """Errors that a profile keeps; `taken`: None without a filter."""
    taken_plus, taken_minus = (0.0, 0.0) if taken is None else taken
    return SlopeErrors(
        omega_plus=slopes[0],
        omega_minus=slopes[1],
        error_plus=float(error[0]),
        error_minus=float(error[1]),
        taken_plus=float(taken_plus),
        taken_minus=float(taken_minus),
    )


def of_waves(slopes: tuple[float, float], waves: SampledWaves, samples=None) -> SlopeErrors:
    """Errors of the largest and the smallest slope of a profile, from what was measured.

    `waves`, `samples`: as `taken_off` takes them, `samples` before any filter.

    What a filter takes off is added to the rest. (In quadrature the errors held of 75%
    to 84% of noisy surfaces, which this raised to 88% to 96%: a filter errs on one side.)
    """
    filtered = bool(np.any(waves.gain != 1.0))
    taken = taken_off(waves, samples) if filtered else (0.0, 0.0)
    if filtered and samples is not None:
        samples = series_values(waves.gain * waves.c, samples.size)
    below = None if samples is None else -samples
    error_plus = error_of(slopes[0], steepest(waves, samples)) + taken[0]
    error_minus = error_of(-slopes[1], steepest(waves.mirrored(), below)) + taken[1]
    return with_taken(slopes, (error_plus, error_minus), taken)


def of_heights(
    heights: np.ndarray, slopes: tuple[float, float], gain: np.ndarray | None = None
) -> SlopeErrors | None:
    """Errors of the slopes of an interpolant of heights at y = 0, 1/n, ...

    `gain`: of a filter on harmonics 1, 2, ... between heights and interpolant. None for
    fewer than 8 heights.
    """
    count = heights.size
    if count < SETTINGS.fewest_heights:
        return None
    c = (2 / count * np.fft.rfft(heights))[1 : (count + 1) // 2]
    noise = np.full(c.size, noise_of(heights) * math.sqrt(2 / count))
    passed = np.ones(c.size) if gain is None else gain[: c.size]
    return of_waves(slopes, SampledWaves(c, noise, passed), heights)


def warn_of(
    errors: SlopeErrors | None, count: int | None = None, stacklevel: int = 3
) -> None:
    """Warn where `count` samples, or enough of them, leave a steepest slope open."""
    many = count is None or count >= SETTINGS.designed
    if errors is not None and many and not errors.determined:
        warnings.warn(errors.message, SlopesUndetermined, stacklevel=stacklevel)


def require_once(heights: np.ndarray) -> None:
    """Check that the last heights are not the first ones again, from y = 1 on.

    One is the point y = 1; several, in their order, go on into the next period. What is
    said of one below: of several that are first ones again to 1e-9 of the range, and vary,
    it is an error, and to 2% a warning where the seam is smoother by far without them.
    """
    if heights.size < 5:
        return
    _require_not_on(heights)
    _require_not_again(heights)


def _require_not_on(heights: np.ndarray) -> None:
    """Of several, the most first, as a surface of 8 heights or more has them once."""
    size = np.ptp(heights)
    for count in range(min(SETTINGS.ends, heights.size // 4), 1, -1):
        first, last = heights[:count], heights[-count:]
        apart, varies = np.max(np.abs(last - first)), np.ptp(first)
        least = SETTINGS.other * max(apart, SETTINGS.same * size)
        if apart > SETTINGS.alike * size or varies <= least:
            continue
        smoother = _seam(heights[:-count]) / max(_seam(heights), 1e-300)
        said = f"{as_text(first)} at both ends"
        # Without one of several whole periods the seam is as sharp as with it.
        copied = apart <= SETTINGS.same * size and smoother < SETTINGS.clearly
        require(not copied, "profile.heights", said, f"one period: {REPEATED}")
        if smoother < SETTINGS.smoother:
            _warn_of_ends(said, count)
            return


def _require_not_again(heights: np.ndarray) -> None:
    """Of one.

    It is where the two agree, no other neighbours do, and the seam is smoother without
    the last one: a `ValueError`. A warning where it may be: as sharp without it, at a
    corner, or nearly equal and smoother by far, measured again.
    """
    size, apart = np.ptp(heights), np.abs(np.diff(heights, append=heights[0]))
    if apart[-1] > SETTINGS.alike * size:
        return
    smoother = _seam(heights[:-1]) / max(_seam(heights), 1e-300)
    alone = apart[-1] <= SETTINGS.same * size < np.min(apart[:-1])
    said = f"{heights[0]:.6g} and {heights[-1]:.6g} at its ends"
    copied = alone and smoother < 1
    require(not copied, "profile.heights", said, f"one period: {REPEATED}")
    if smoother < SETTINGS.smoother or (alone and smoother < SETTINGS.as_sharp):
        _warn_of_ends(said, 1)


def _warn_of_ends(said: str, count: int) -> None:
    last = "last if it is" if count == 1 else f"last {count} if they go on from"
    text = f"profile.heights = {said}: leave out the {last} y = 1: {REPEATED}"
    warnings.warn(text, SlopesUndetermined, stacklevel=8)  # below `Spline(...)`


def _seam(heights: np.ndarray) -> float:
    """The largest third difference across the seam."""
    near = np.concatenate([heights[-3:], heights[:3]])
    return float(np.max(np.abs(np.diff(near, 3))))
