"""What a smoothing filter takes off the steepest slopes of a measured surface."""

import math

import numpy as np

from .settings import SETTINGS
from .steepest import SampledWaves, series_values, slopes_of_waves, steepest


def taken_off(
    waves: SampledWaves, samples: np.ndarray | None = None
) -> tuple[float, float]:
    """What the filter takes off the steepest slope upwards and downwards, both >= 0.

    `waves`: with the filter's gain; `samples`: the heights before it, where the waves are
    their interpolant. See `_taken`.
    """
    below = None if samples is None else -samples
    return _taken(waves, samples), _taken(waves.mirrored(), below)


def _taken(waves: SampledWaves, samples: np.ndarray | None) -> float:
    """Two estimates: by filtering once more, and from the waves before the filter.

    The first, `S1^2/S2 - S1` of the slopes after one and two filters, hardly knows of noise
    and is exact for one wave, but sees nothing of what the first filter has left nothing
    of. So it counts for no less, and no more, than the waves that stand out of the noise
    say, within their error. (`S1 - S2` is 13% to 60% lower, at a cut-off of 0.3 periods.)
    """
    once, twice = (slopes_of_waves(waves.c * waves.gain**times)[0] for times in (1, 2))
    again = once * (once / twice - 1) if twice > 0 else math.inf
    before = steepest(waves._replace(gain=np.ones(waves.gain.size)), samples)
    smooth = None if samples is None else series_values(waves.gain * waves.c, samples.size)
    less = before.slope - steepest(waves, smooth).slope
    if not math.isfinite(before.error):
        return max(again, 0.0)
    known = before.error < SETTINGS.known * before.slope
    least = less + (SETTINGS.margin if known else -1.0) * before.error
    return max(0.0, min(max(again, least), less + before.error))
