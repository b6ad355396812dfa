"""Points of rods and of coils, to be drawn as lines."""

import numpy as np

from ...rods import bent_shape

_TURNS = 7  # of a coil, where there is room
_TURN = 0.8  # widths: the way of a turn at least, or a coil is a blot
_LEAD = 0.12  # of its way, straight at each end of a coil


def rod_between(
    root: np.ndarray, tip: np.ndarray, length: float, side: int = 0
) -> np.ndarray:
    """Points (2, n) from the tip to the root, both (2,), in m.

    Straight, or where `side` is 1 or -1 the elastica of `length` (m) between hinges, bent
    to the left of the way from tip to root, or to its right.
    """
    if side == 0:
        return np.stack([tip, root], axis=1)
    along = root - tip
    chord = float(np.hypot(*along))
    shape = bent_shape(length, min(chord, length))
    along = along / chord
    aside = np.array([-along[1], along[0]])  # to the left
    return tip[:, None] + np.outer(along, shape[0]) + side * np.outer(aside, shape[1])


def turns_within(length: float, width: float) -> int:
    """How many turns of a coil, 1 at least, can be told apart on so long a way, in m."""
    return int(np.clip(length / (_TURN * width), 1, _TURNS))


def coil(
    start: np.ndarray, end: np.ndarray, width: float, turns: int = _TURNS
) -> np.ndarray:
    """Points (2, n) of a spring between two places (2,), so wide, in m.

    Narrower where it is shorter than a turn should be.
    """
    along = end - start
    length = float(np.hypot(*along))
    ahead = along / length if length else np.array([1.0, 0.0])
    inner = np.linspace(_LEAD, 1 - _LEAD, 4 * turns + 1)
    aside = np.append(np.tile([0.0, 0.5, 0.0, -0.5], turns), 0.0)
    shares = np.concatenate([[0.0], inner, [1.0]])
    width = min(width, length / (_TURN * turns))
    across = width * np.concatenate([[0.0], aside, [0.0]])
    normal = np.array([-ahead[1], ahead[0]])
    return start[:, None] + np.outer(along, shares) + np.outer(normal, across)
