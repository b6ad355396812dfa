"""How closely the two lanes of a bracket have met, in way and in time."""

from typing import NamedTuple

import numpy as np

from ..lanes import SegmentEnds, Segments
from .settings import SETTINGS


class Meetings(NamedTuple):
    """How closely brackets have closed at stops; 0 from a known start.

    `gap`: in units of eps. At a stop inside a slip (ten times faster than the path) it is
    the shift in time that counts, not the way that it makes. `shift`: how far they are
    apart in time, in slip periods. A tip that creeps past a fold takes long over a small
    way: lanes that are 4e-4 eps apart there were 4e-2 eps apart in the slip that followed
    (gamma = 0.65, eps = 6e-4).
    """

    gap: np.ndarray
    shift: np.ndarray


def meetings_at(
    ends: SegmentEnds,
    segments: Segments,
    behind: np.ndarray,
    ahead: np.ndarray,
    speed: float,
    pace: float | np.ndarray = np.inf,
) -> Meetings:
    """How closely both lanes have met where these segments end.

    `speed`: the path's largest, m/s. `pace`: of fast slides, m/s, where tips are slower
    than the path, and their slips too. (Seen as no slip, in the first wells of a slide that
    lags by 4331, the sawtooth at gamma = 1/2, eps = 1e-7, 3e-5 of a period made a bracket
    of 6e-4, which stayed open.)
    """
    both = ahead >= 0
    a, b = np.where(both, ahead, 0), np.where(both, behind, 0)
    wells = wells_between(ends.well[b], ends.tip[b], ends.well[a], ends.tip[a])
    # On a path that never moves nothing counts as a slip.
    least = SETTINGS.slow_slip * speed if speed > 0 else np.inf
    usual = np.minimum(np.maximum(np.abs(segments.slope1[b]), least), pace)
    paces = np.abs(np.stack([ends.speed[a], ends.speed[b]])) / usual
    # One lane alone is no bracket, and may have failed.
    wells, paces = np.where(both, np.abs(wells), 0.0), np.where(both, paces, 1.0)
    return Meetings(
        gap=wells * SETTINGS.slip / np.maximum(paces.max(axis=0), SETTINGS.slip),
        shift=wells / np.maximum(paces.min(axis=0), SETTINGS.creep),
    )


def wells_between(well0, tip0, well1, tip1) -> np.ndarray:
    """Signed wells from the tip `tip0` in well `well0` to another one, any shapes.

    Whole wells first: added to 1e8 of them a tip is rounded to 1e-8.
    """
    return (well1 - well0) + (tip1 - tip0)
