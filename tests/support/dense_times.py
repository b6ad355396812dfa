"""Times around the largest values of a curve: a few there in place of many everywhere."""

import numpy as np


def finer(ts, values, places=12, count=101):
    """Times around the largest of these values, between their neighbours in even `ts`."""
    at = ts[np.argsort(values)[-places:]]
    times = at[:, None] + (ts[1] - ts[0]) * np.linspace(-1, 1, count)
    return np.unique(np.clip(times, ts[0], ts[-1]))
