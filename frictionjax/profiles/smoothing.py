"""The Gaussian filter of surface metrology."""

import math
from typing import Any

import numpy as np

from .._checks import no_more, require, require_real
from .settings import SETTINGS


def gaussian_gain(length: Any, period: float, harmonics: int) -> np.ndarray:
    """What a Gaussian filter of cut-off `length` lets through of harmonics 1, 2, ...

    `2^-(length/wavelength)^2`: half of a wave as long as the cut-off (ISO 16610-21, whose
    weights are Gaussian with alpha = sqrt(ln 2/pi)). A periodic surface has no ends, so
    the filter is exact. `length`, `period`: in one unit.

    Raises `ValueError` for a length that is not positive, or longer than 2.5 periods.
    """
    most = period * math.sqrt(-math.log2(SETTINGS.least_left))
    require_real("smoothing", length, "a length > 0", lambda size: size > 0)
    needs = f"smoothing <= {no_more(most)}: a longer one leaves less than 1% of the surface"
    require(float(length) <= most, "smoothing", length, needs)
    waves = np.arange(1, harmonics + 1) * (float(length) / period)
    return np.exp2(-(waves**2))
