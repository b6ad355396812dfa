"""How well heights that somebody measured determine the steepest slope of a surface.

An interpolant answers with its own steepest slope, which is no estimate of its error: a
cubic spline and a Fourier series overshoot a corner by the same factor at any number of
samples, so more samples, or half of them, agree with each other and are wrong. What does
not overshoot is the mean slope of a window (a chord). The longest of the chords over one,
two and three spacings go to the steepest slope of a smooth surface as even powers of the
spacing, and equal it on a straight flank: so their extrapolation is right for both. Noise
raises all of them: so they are taken of the waves alone that stand out of the noise. It is
taken for white, another one at every sample: noise that neighbours share has the long waves
of a surface, and one period cannot tell the two apart.
"""

import math
from typing import NamedTuple

import numpy as np

from .settings import SETTINGS


class SampledWaves(NamedTuple):
    """`w(y) = Re sum_k c_k exp(2 pi i k y)`, k from 1, as the samples give it.

    `c`: complex, shape (harmonics,), as many as the samples tell apart. `noise`: standard
    deviation of real and imaginary part each, the same shape. `gain`: what a filter lets
    through of each, applied to both.
    """

    c: np.ndarray
    noise: np.ndarray
    gain: np.ndarray

    def mirrored(self) -> "SampledWaves":
        """Of the surface upside down."""
        return self._replace(c=-self.c)


class Steepest(NamedTuple):
    """An estimate of the steepest slope upwards and its own error."""

    slope: float
    error: float


def series_values(c: np.ndarray, count: int, order: int = 0) -> np.ndarray:
    """`Re sum_k c_k exp(2 pi i k y)`, or a derivative, at y = 0, 1/count, ..."""
    k = np.arange(1, c.size + 1)
    spectrum = np.zeros(count, complex)
    # On so few places waves that differ by `count` are the same.
    np.add.at(spectrum, k % count, count * c * (2j * np.pi * k) ** order)
    return np.fft.ifft(spectrum).real


def steepest(waves: SampledWaves, samples: np.ndarray | None = None) -> Steepest:
    """Steepest slope that the samples support, by windows, with its error.

    `samples`: where the waves are their interpolant, whose windows are then theirs. Of
    several numbers of harmonics the one of the smallest error: few have little noise, many
    resolve corners.
    """
    most, last = waves.c.size, last_of_note(waves)
    found = []
    for used in sorted({most, *(min(most, factor * last) for factor in SETTINGS.ladder)}):
        c, noise = (part[:used] * waves.gain[:used] for part in (waves.c, waves.noise))
        k = np.arange(1, used + 1)
        deviation = 2 * np.pi * math.sqrt(float(np.sum((k * noise) ** 2)))
        whole = samples is not None and used == most
        heights = samples if whole else series_values(c, used + 1)
        found.append(_by_windows(np.asarray(heights), SETTINGS.let_through * deviation))
        found.append(_by_waves(c, noise, deviation))
    return min(found, key=lambda one: one.error)


def _by_waves(c: np.ndarray, noise: np.ndarray, deviation: float) -> Steepest:
    """From the waves themselves: what is beyond them is about as steep as their last half.

    Of a corner's slopes every octave holds as much as the next, of a smooth surface's the
    last next to nothing. (Without, one of two harmonics, known to 1e-6 of its range by
    samples that are rounded alike in every period, was called open by 25%: rounding stood
    out of a noise that was smaller still, up to the last wave.)
    """
    top = _largest_slope(c)
    rivals = int(np.sum(series_values(c, 2 * c.size, order=1) > top - 2 * deviation))
    seen = np.maximum(np.abs(c) - SETTINGS.certain * noise, 0.0)
    last = 2 * np.pi * float(np.sum((np.arange(1, c.size + 1) * seen)[c.size // 2 :]))
    beyond = SETTINGS.octaves * last
    if beyond > SETTINGS.resolved * top:
        return Steepest(top, math.inf)
    return Steepest(top, _of_noise(rivals, deviation) + beyond)


def _of_noise(rivals: int, deviation: float) -> float:
    """What noise adds to the largest of so many, and its scatter."""
    return (math.sqrt(2 * math.log(max(rivals, 1))) + SETTINGS.certain) * deviation


def last_of_note(waves: SampledWaves) -> int:
    """The last harmonic that stands out of the noise with its neighbours; 1 at least."""
    energy = np.abs(waves.c / np.maximum(waves.noise, 1e-300)) ** 2
    summed = np.append(0.0, np.cumsum(energy))
    k = np.arange(1, energy.size + 1)
    ends = np.minimum(k + np.maximum(1, k // 3), energy.size)
    size = ends - k + 1
    # Of `size` harmonics in noise the energy is 2 size, give or take 2 sqrt(size).
    most = 2 * size + 2 * SETTINGS.apart * np.sqrt(size) + SETTINGS.a_little
    stands = summed[ends] - summed[k - 1] > most
    return int(max(k[stands], default=1))


def _by_windows(heights: np.ndarray, deviation: float) -> Steepest:
    """From windows of 1, 2 and 3 spacings; `deviation`: standard, of a slope, by noise.

    `lost`: a flank that two windows see has a third of their slope less in three (`fall`),
    and may be of any slope: it is as if all of it lay at the sample between them.
    """
    count = heights.size
    slopes = [(np.roll(heights, -j) - heights) * count / j for j in (1, 2, 3)]
    one, two, three = (_summit(slope) for slope in slopes)
    if one <= 0:
        return Steepest(one, math.inf)
    fourth, sixth = (4 * one - two) / 3, 1.5 * one - 0.6 * two + 0.1 * three
    fall = max(0.0, 1 - three / one)
    lost = 0.5 * one * (SETTINGS.few * fall) ** 3 if fall < SETTINGS.too_few else math.inf
    noise = _of_noise(int(np.sum(slopes[0] > one - 2 * deviation)), deviation)
    return Steepest(sixth, 0.5 * abs(sixth - fourth) + lost + noise)


def _summit(values: np.ndarray) -> float:
    """Largest value of a periodic sequence, between its entries too.

    By the parabola, as bent as the flattest of three: a plateau has no summit beside it.
    """
    top = int(np.argmax(values))
    near = values[np.arange(top - 2, top + 3) % values.size]
    bends = 2 * near[1:-1] - near[:-2] - near[2:]
    bend = float(np.min(bends))
    if bend <= 0:
        return float(values[top])
    shift = np.clip((near[3] - near[1]) / (2 * bends[1]), -0.5, 0.5)
    return float(values[top] + 0.5 * bend * shift**2)


def slopes_of_waves(c: np.ndarray) -> tuple[float, float]:
    """Largest and smallest slope of `Re sum_k c_k exp(2 pi i k y)`."""
    return _largest_slope(c), -_largest_slope(-c)


def _largest_slope(c: np.ndarray) -> float:
    count = SETTINGS.fine * max(2, c.size)
    slopes = series_values(c, count, order=1)
    turns = 2j * np.pi * np.arange(1, c.size + 1)
    y = int(np.argmax(slopes)) / count
    for _ in range(SETTINGS.newton):
        waves = c * turns**2 * np.exp(turns * y)
        bend, next_bend = np.sum(waves).real, np.sum(waves * turns).real
        y -= float(np.clip(bend / min(next_bend, -1e-300), -0.5 / count, 0.5 / count))
    return max(float(np.max(slopes)), float(np.sum(c * turns * np.exp(turns * y)).real))


def error_of(slope: float, reference: Steepest) -> float:
    """Error of an interpolant's steepest slope upwards."""
    return SETTINGS.share * abs(slope - reference.slope) + reference.error


def noise_of(samples: np.ndarray) -> float:
    """Standard deviation of the noise of heights of one period, from what is finest.

    The smaller of two: the last quarter of the spectrum, which few smooth waves reach, and
    the median difference of order 6, of which few are at corners.
    """
    count = samples.size
    spectrum = 2 / count * np.fft.rfft(samples)
    tail = np.abs(spectrum[3 * count // 8 + 1 : (count + 1) // 2])
    by_waves = math.sqrt(count / 4 * np.mean(tail**2)) if tail.size else math.inf
    order = 6 if count >= 12 else 4
    fine = np.concatenate([samples, samples[:order]])
    scale = 0.6745 * math.sqrt(math.comb(2 * order, order))
    by_differences = float(np.median(np.abs(np.diff(fine, order)))) / scale
    return max(min(by_waves, by_differences), SETTINGS.noise_floor * float(np.ptp(samples)))
