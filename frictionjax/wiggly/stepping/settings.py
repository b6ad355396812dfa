"""What steers step sizes, with what lost."""

from typing import NamedTuple

import numpy as np


class Settings(NamedTuple):
    """Of the control of steps and of their sizes, in octaves unless said otherwise."""

    # Sizes (`step_sizes.py`).
    per_octave: int = 8  # costs 2% more steps
    lowest_octave: int = -900  # of the first step: lanes that get there are lost

    # Control (`step_control.py`).
    safe: float = np.log2(0.9)  # of what an error allows
    gain: float = 0.8  # of the error itself (1: a third more of the steps are rejected)
    ahead: float = 0.2  # by which the trend may exceed what the error allows
    least_change: float = np.log2(0.1)
    most_change: float = np.log2(8.0)
    rejected: float = -0.125  # most change after a step that is rejected
    # Of the tolerance: errors are counted as that at least, below is rounding noise.
    tiny: float = 1e-5
    far: float = 20.0  # reaches: whatever is further counts as that


SETTINGS = Settings()
