"""Which way each cell goes: the one that passes through the fewest wells."""

from enum import IntEnum

import numpy as np

from .enclosure import CellBounds, Requirements, cost_of
from .limit_path import SETTINGS as PATH_SETTINGS
from .limit_path import Path
from .settings import SETTINGS


class Way(IntEnum):
    """How a cell is gone through.

    Every slip in tiles; some slips of every slide; one lane from z0 through all; or along
    slip maps, where slides turn out to be fast.
    """

    EVERY_SLIP = 0
    SAMPLED = 1
    ONE_LANE = 2
    SLIP_MAP = 3


def slides_of(path: Path, eps: np.ndarray) -> np.ndarray:
    """Pieces of the path that are long enough for slip maps, (cells, pieces)."""
    return np.abs(np.diff(path.states)) > SETTINGS.long_slide * eps[:, None]


def by_brackets(
    path: Path, eps: np.ndarray, needs: Requirements, times: int, method: str
) -> np.ndarray:
    """`EVERY_SLIP` or `SAMPLED`, per cell: where brackets close after a few wells."""
    if method == "resolved":
        sampled = np.zeros(eps.size, dtype=bool)
    elif method == "windowed":
        sampled = np.ones(eps.size, dtype=bool)
    else:
        sampled = _costs_less_sampled(path, eps, needs, times)
    return np.where(sampled, Way.SAMPLED, Way.EVERY_SLIP)


def ways_of(
    path: Path,
    ground: CellBounds,
    needs: Requirements,
    reach: np.ndarray,
    follows: np.ndarray,
    brackets: np.ndarray,
    method: str,
) -> np.ndarray:
    """The way of each cell: as `brackets` has it, but where these would remember too much.

    With few slips altogether one lane goes through all from z0, needing no bracket. So it
    does where slides are over before tips follow: no bracket closes across them, and no
    slip map ends. (Jumps within 3e-4 s, gamma = 0.3, eps = 1e-3: 3.7 s, after 18 s for maps
    and brackets in vain.) `reach` of steps in periods; `follows`: the time in s that tips
    take to, e-fold.
    """
    if method == "resolved":
        return brackets
    long = _remembers_long(needs)
    mappable = _has_mappable_slides(path, ground.eps)
    ways = np.where(long & mappable, Way.SLIP_MAP, brackets)
    if method != "auto":
        return ways
    short = _is_short(path, ground, reach) | ends_before_tips_follow(path, ground, follows)
    return np.where(long & short, Way.ONE_LANE, ways)


def _costs_less_sampled(path: Path, eps, needs: Requirements, times: int) -> np.ndarray:
    nodes = np.full(eps.size, PATH_SETTINGS.nodes)
    sampled = cost_of(path, eps, needs._replace(samples=nodes), times)
    return sampled < cost_of(path, eps, needs._replace(samples=0 * nodes), times)


def _remembers_long(needs: Requirements) -> np.ndarray:
    """Whether brackets would set off from many slips back."""
    return needs.run_up > SETTINGS.far_back


def _has_mappable_slides(path: Path, eps: np.ndarray) -> np.ndarray:
    """Whether slides are long, and no panel of a map would step over a burst."""
    slides = slides_of(path, eps)
    bursts = slides & (path.probes.unseen > SETTINGS.burst)
    return np.any(slides, axis=1) & ~np.any(bursts, axis=1)


def _is_short(path: Path, ground: CellBounds, reach: np.ndarray) -> np.ndarray:
    """Whether one lane has gone through all before slip maps are made."""
    # Steps are the shorter, the narrower the branches.
    narrow = (SETTINGS.widest / reach) ** 0.6
    way = path.travel[-1] / ground.eps * narrow
    slides = np.count_nonzero(slides_of(path, ground.eps), axis=1)
    worth = SETTINGS.worth_a_map * np.maximum(slides, 3)
    return way <= np.minimum(worth, ground.affordable)


def ends_before_tips_follow(
    path: Path, ground: CellBounds, follows: np.ndarray
) -> np.ndarray:
    """Whether a slide does, in a cell that one lane can go through."""
    slides = slides_of(path, ground.eps)
    brief = slides & (follows[:, None] > path.edges[1:] - path.touch)
    return np.any(brief, axis=1) & ground.is_affordable(path)
