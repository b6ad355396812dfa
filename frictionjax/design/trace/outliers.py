"""Samples of a trace that its neighbours contradict."""

import numpy as np

from .settings import SETTINGS


def outliers_of(values: np.ndarray, start: float | None = None) -> np.ndarray:
    """Indices of samples far off all their neighbours and beyond all others, (k,).

    A slip takes the force from one end of its range to the other, so that a single sample
    inside the range may be right. `start`: the value where the scene starts, from which the
    first samples may be on their way into the range.
    """
    low, high = np.percentile(values, [2, 98])
    beyond = np.maximum(low - values, values - high) > SETTINGS.beyond_others * (high - low)
    bends = np.abs(np.diff(values, 2, prepend=values[:1], append=values[-1:])) / np.sqrt(
        6.0
    )
    scatter = 1.4826 * float(np.median(bends))
    if start is not None:
        on_the_way = _begin(values, beyond, start, SETTINGS.scatters * scatter)
        beyond = beyond & (np.arange(values.size) >= on_the_way)
    found = []
    for index in np.flatnonzero(beyond):
        near = slice(max(0, index - SETTINGS.around), index + SETTINGS.around + 1)
        others = values[near][~beyond[near]]
        most = SETTINGS.scatters * scatter
        if others.size and np.min(np.abs(others - values[index])) > most:
            found.append(index)
    return np.array(found, dtype=int)


def _begin(values: np.ndarray, beyond: np.ndarray, start: float, most: float) -> int:
    """How many first samples are beyond, and on one way from the start to all others.

    In a well that is far from its start a tip relaxes, and does not come back there.
    """
    count = int(np.argmin(beyond))
    way = np.concatenate([[start], values[: count + 1]])
    steps = (np.sign(way[-1] - start) or 1.0) * np.diff(way)
    return count if np.all(steps >= -most) else 0
