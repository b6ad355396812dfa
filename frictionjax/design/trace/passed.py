"""What slips say: where the tip has passed, the surface did not hold it."""

from typing import Any, NamedTuple

import numpy as np

from ...model import Scene
from ...wiggly import pulls_at
from .settings import SETTINGS
from .start import wiggle


class Passages(NamedTuple):
    """Places that the tip passed: states `z` in m and `bound` in N, (m,); `side` 1 or -1.

    On a way to the right `V_eps' = l - Phi' - eps^gamma z' < max l - Phi'`, over the time
    between two samples; to the left the other way round. No speed is needed, and no
    surface that gives the trace breaks it.
    """

    z: np.ndarray
    bound: np.ndarray
    side: np.ndarray


class Held(NamedTuple):
    """Excess over the bounds, `r` >= 0 in N, and its derivative `by`, (m, unknowns)."""

    r: np.ndarray
    by: np.ndarray


def passages_of(scene: Any, ts: np.ndarray, z: np.ndarray, sd: np.ndarray, eps: float):
    """Ways between samples that are further apart than their errors."""
    turns = np.asarray(scene.turning_points())
    highest, lowest = _load_range(scene, ts, turns)
    states, bounds, sides = [], [], []
    for i in range(ts.size - 1):
        side = np.sign(z[i + 1] - z[i])
        less = side * SETTINGS.shorter
        begin, end = z[i] + less * sd[i], z[i + 1] - less * sd[i + 1]
        count = int(np.floor(side * (end - begin) / (SETTINGS.apart * eps)))
        if count < 1:
            continue
        count = min(count, SETTINGS.most_places)  # of a trace in nm, 1e9
        states.append(np.linspace(begin, end, count + 1))
        bounds.append(np.full(count + 1, highest[i] if side > 0 else lowest[i]))
        sides.append(np.full(count + 1, side))
    if not states:
        return Passages(np.zeros(0), np.zeros(0), np.zeros(0))
    every = [np.concatenate(parts) for parts in (states, bounds, sides)]
    count = min(every[0].size, SETTINGS.most_places)
    keep = np.linspace(0, every[0].size - 1, count).astype(int)
    places, loads, side = (part[keep] for part in every)
    force = pulls_at(scene, np.zeros_like(places), places).force
    return Passages(places, loads - force, side)


def _load_range(scene: Scene, ts: np.ndarray, turns: np.ndarray):
    """Largest and smallest load between each two samples."""
    times = np.concatenate([ts, turns])
    known = pulls_at(scene, times, np.zeros_like(times)).load
    ends, corners = known[: ts.size], known[ts.size :]
    high, low = np.maximum(ends[1:], ends[:-1]), np.minimum(ends[1:], ends[:-1])
    place = np.searchsorted(ts, turns) - 1
    for i, value in zip(place, corners, strict=True):
        if 0 <= i < high.size:
            high[i], low[i] = max(high[i], value), min(low[i], value)
    return high, low


def held(passages: Passages, scene: Any, eps: Any, numbers: np.ndarray) -> Held:
    """How far the wiggle force of the surface would have held the tip where it passed."""
    if passages.z.size == 0:
        return Held(np.zeros(0), np.zeros((0, numbers.size)))
    force, _, by = wiggle(numbers, scene, eps, passages.z)
    excess = passages.side * (force - passages.bound)
    over = excess > 0
    rows = np.where(over[:, None], passages.side[:, None] * by, 0.0)
    return Held(np.where(over, excess, 0.0), rows)


def unbounded(numbers: np.ndarray, rough: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    """No bounds: what `Problem.held` gives where there are none."""
    return np.zeros(0), np.zeros((0, numbers.size))
