"""Where the segments of a chain end: often enough for their cubics to follow the path."""

from typing import NamedTuple

import numpy as np

from ..lanes import guide_of
from ..limit_path import Path
from .brackets import segments_of
from .settings import SETTINGS


class Cut(NamedTuple):
    """A cell's chain: where its stretches open, and where its segments end, times in s."""

    opening: np.ndarray
    stops: np.ndarray


def stretches_of(opening: np.ndarray, stops: np.ndarray) -> np.ndarray:
    """The stretch of each stop: where one opens, stops belong to the one before."""
    return np.searchsorted(opening, stops, side="left") - 1


def follow_path(path: Path, eps: np.ndarray, accuracy: float, cuts: list[Cut]) -> list[Cut]:
    """With more stops where cubics of segments would leave the path; a cut for each eps.

    What it is off is added to the deviation of z. (Segments of 16 wells before a turn of
    the load: suprema up to 19 times the accuracy off. A rise by 0.04 N within 6 ms: 0.4
    eps.)
    """
    allowed = np.maximum(
        SETTINGS.guide * accuracy * eps, SETTINGS.rounded * _rounding_of(path)
    )
    segments = [_segments_between(cut) for cut in cuts]
    owner = np.repeat(np.arange(len(cuts)), [starts.size for starts, _ in segments])
    starts, ends = (np.concatenate(side) for side in zip(*segments, strict=True))
    owners, middles = [], []
    for _ in range(SETTINGS.leg_halvings):
        off = _off_path(path, starts, ends) > allowed[owner]
        if not off.any():
            break
        owner, starts, ends = owner[off], starts[off], ends[off]
        middle = 0.5 * (starts + ends)
        owners.append(owner)
        middles.append(middle)
        owner = np.tile(owner, 2)
        starts, ends = np.append(starts, middle), np.append(middle, ends)
    if not owners:
        return cuts
    owner, middle = np.concatenate(owners), np.concatenate(middles)
    return [
        cut._replace(stops=np.union1d(cut.stops, middle[owner == i]))
        for i, cut in enumerate(cuts)
    ]


def _rounding_of(path: Path) -> float:
    """Of the path's states in m: their own, and that of times and forces."""
    largest = np.max(np.abs(path.states))
    force = path.stiffness * largest + max(path.rho_plus, -path.rho_minus)
    return float(
        np.spacing(largest)
        + path.speed * np.spacing(path.edges[-1])
        + np.spacing(force) / path.stiffness
    )


def _segments_between(cut: Cut) -> tuple[np.ndarray, np.ndarray]:
    """Starts and ends in s of the segments between stops."""
    opens = cut.opening[stretches_of(cut.opening, cut.stops)]
    starts = np.maximum(opens, np.concatenate([[0.0], cut.stops[:-1]]))
    long = cut.stops > starts
    return starts[long], cut.stops[long]


def _off_path(path: Path, starts: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """How far the cubics of segments are off the path at some times inside, in m."""
    share = np.array(SETTINGS.leg_places)[:, None]
    times = starts + share * (ends - starts)
    guide = guide_of(segments_of(path, starts, ends))
    return np.max(np.abs(guide(times) - path.states_at(times)), axis=0)
