"""Angles as errors tell them: in rad, and what one is that was meant in degrees."""

import math
from typing import Any

import numpy as np

from .._checks import is_known

_DEGREES = 2.0, 360.0  # as numbers: beyond a right angle in rad, and of use in degrees


def in_radians(allowed: str, angle: Any) -> str:
    """What is `allowed` of an angle, with its unit."""
    told = f"{allowed} in rad"
    if not is_known(angle) or np.ndim(angle):
        return told
    degrees = float(angle)
    if not _DEGREES[0] <= abs(degrees) <= _DEGREES[1]:
        return told
    return f"{told} ({degrees:.6g} degrees are {math.radians(degrees):.4g} rad)"
