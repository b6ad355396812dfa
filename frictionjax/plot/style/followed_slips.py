"""Whether times are dense enough to join the states of a tip that slips by a line."""

from typing import Any

import numpy as np

_RESOLVED = 6  # times a well: joined, fewer would draw a sawtooth with slips left out
_FEW = 0.25  # of the wells that may hold fewer
DOTS: Any = {"linestyle": "", "marker": ".", "markersize": 2.5}
TOLD_OF_DOTS = "; dots: too few times to follow slips"


def follows_slips(z: np.ndarray, eps: float) -> bool:
    """Whether most wells that `z` (m), shape (time,), passes hold enough of its times."""
    # Rounded: one at rest where two wells meet would go to and fro in its last digit.
    wells = np.floor(np.round(z[np.isfinite(z)] / eps, 6))
    passed = np.abs(np.diff(wells))
    last = np.flatnonzero(passed)
    if not last.size:
        return True
    times = np.diff(last, prepend=-1)
    leapt = int(passed[last].sum()) - last.size  # wells without a time of their own
    return leapt + int(np.sum(times < _RESOLVED)) <= _FEW * (leapt + last.size)
