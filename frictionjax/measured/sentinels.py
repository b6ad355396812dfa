"""Numbers that stand for a missing height: -32768, 1e38, -9999."""

import numpy as np

from .samples import Samples

_LISTED = (
    *(9999.0, 99999.0, 999999.0, 1000001.0),
    *(32767.0, 32768.0, 65535.0, 2.0**31 - 1, 2.0**31, 2.0**32 - 1),
)
_HUGE = 1e30  # no height in any unit
# In ranges of all other heights. Counts of 16 bits fill a third of theirs and leave
# -32768 one range away; a plateau that an instrument rounds to one value lies ten away.
_FAR_LISTED, _FAR_REPEATED = 1.0, 100.0


def without_sentinels(samples: Samples) -> Samples:
    """Samples whose sentinels are missing ones, with a note for each."""
    heights, notes = samples.heights.copy(), []
    for value in _sentinels(heights):
        held = heights == value
        row, sample = (int(i) for i in np.argwhere(held)[0])
        place, count = samples.place(row, sample), int(held.sum())
        notes.append(f"{place} = {value:.10g}: taken as missing, as are {count} in all")
        heights[held] = np.nan
    return samples._replace(heights=heights, notes=[*samples.notes, *notes])


def _sentinels(heights: np.ndarray) -> list[float]:
    """Values at either end that are no heights."""
    found: list[float] = []
    rest = heights[np.isfinite(heights)]
    while rest.size > 2:
        ends = [v for v in (float(rest.min()), float(rest.max())) if _is_sentinel(v, rest)]
        if not ends:
            break
        found += ends[:1]
        rest = rest[rest != ends[0]]
    return found


def _is_sentinel(value: float, heights: np.ndarray) -> bool:
    if abs(value) >= _HUGE:
        return True
    others = heights[heights != value]
    if others.size < 2 or np.ptp(others) == 0:
        return False
    away = float(np.min(np.abs(others - value))) / float(np.ptp(others))
    repeated = heights.size - others.size > 1
    return away > (_FAR_LISTED if abs(value) in _LISTED else _FAR_REPEATED) and (
        repeated or abs(value) in _LISTED
    )
