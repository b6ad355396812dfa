"""Samples of a trace that its neighbours contradict."""

import numpy as np

from .settings import SETTINGS


def outliers_of(values: np.ndarray) -> np.ndarray:
    """Indices of samples far off all their neighbours and beyond all others, (k,).

    A slip takes the force from one end of its range to the other, so that a single sample
    inside the range may be right.
    """
    low, high = np.percentile(values, [2, 98])
    beyond = np.maximum(low - values, values - high) > SETTINGS.beyond_others * (high - low)
    bends = np.abs(np.diff(values, 2, prepend=values[:1], append=values[-1:])) / np.sqrt(
        6.0
    )
    scatter = 1.4826 * float(np.median(bends))
    found = []
    for index in np.flatnonzero(beyond):
        near = slice(max(0, index - SETTINGS.around), index + SETTINGS.around + 1)
        others = values[near][~beyond[near]]
        most = SETTINGS.scatters * scatter
        if others.size and np.min(np.abs(others - values[index])) > most:
            found.append(index)
    return np.array(found, dtype=int)
