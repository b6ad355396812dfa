"""Where the speed of the path has been looked at, and whether a few nodes would see it."""

from typing import NamedTuple

import numpy as np

from .survey import NODES, nodes_of, through_nodes

_INSIDE = 1e-9  # of a stretch of time: how far inside it its outer nodes are


class Probes(NamedTuple):
    """Speeds of the path on each piece, P pieces.

    `times` (P, n): s, the steepest of the load among them; `speeds` (P, n): m/s. `unseen`
    (P,): by how much a polynomial through a few nodes misses them, of the largest.
    """

    times: np.ndarray
    speeds: np.ndarray
    unseen: np.ndarray


NO_PROBES = Probes(np.zeros((0, 0)), np.zeros((0, 0)), np.zeros(0))


def nodes_inside(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Nodes of [low, high] (n,) in s, (n, NODES): at the ends from inside, where slides
    begin and pieces meet."""
    share = np.clip(nodes_of(0.0, 1.0, NODES), _INSIDE, 1 - _INSIDE)
    return low[:, None] + (high - low)[:, None] * share


def unseen_of(low, high, known, times, speeds) -> np.ndarray:
    """By how much a polynomial through `known` (n, nodes) misses speeds (n, m), at most.

    Of the largest speed there; only times in [low, high] (n,) count.
    """
    inside = (times >= low[:, None]) & (times <= high[:, None])
    long = np.where(high > low, high, low + 1.0)
    gaps = np.abs(through_nodes(low, long, known, times) - speeds) * inside
    size = np.maximum(np.abs(known).max(axis=1), np.max(np.abs(speeds) * inside, axis=1))
    return gaps.max(axis=1) / np.maximum(size, 1e-300)
