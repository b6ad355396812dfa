"""Which times of a solution a moving picture shows."""

import numpy as np

_TIME = 0.5  # share of the frames that go by time; the others by the way gone
_LEAST = 1e-9
_ROUNDING = 1e-9  # of a frame


def frame_rows(time: np.ndarray, places: np.ndarray, count: int) -> np.ndarray:
    """Rows of a solution that are frames: `count`, or all where there are no more.

    Half by time (n,), half by the way that `places` (n, 2) go, all together: a slip is a
    few frames, though it takes no time. First and last are among them, none twice: a step
    between rows that goes further than from frame to frame is one frame.
    """
    if time.size <= count:
        return np.arange(time.size)
    # No step is 0, or rows at one time and place could be too many to be parted.
    steps = _TIME * np.diff(time) / (time[-1] - time[0]) + _LEAST
    way = np.hypot(*np.diff(places, axis=0).T)
    if way.sum() > 0:
        steps = steps + (1 - _TIME) * way / way.sum()
    share = _largest_share(steps, count - 1)
    passed = np.concatenate([[0.0], np.cumsum(np.minimum(steps, share) / share)])
    rows = np.searchsorted(passed, np.arange(count) - _ROUNDING)
    rows[0], rows[-1] = 0, time.size - 1
    spread = np.arange(count)  # where rounding puts two into one step
    rows = np.maximum.accumulate(rows - spread) + spread
    return np.minimum(rows, time.size - count + spread)


def _largest_share(steps: np.ndarray, parts: int) -> float:
    """s > 0 such that the steps, each at most s, add up to `parts` s; there are more."""
    ordered = np.sort(steps)
    # Were those up to here, and no others, at most s: what they add up to is `left` s.
    left = parts - np.arange(steps.size)[::-1]
    shares = np.full(steps.size, np.inf)
    np.divide(np.cumsum(ordered), left, out=shares, where=left > 0)
    greater = np.append(ordered[1:], np.inf)
    fits = (left > 0) & (ordered <= shares) & (shares <= greater)
    return float(shares[np.argmax(fits)])
