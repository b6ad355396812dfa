"""Times at which methods are measured."""

from typing import NamedTuple

import numpy as np

from ..limit import solve_limit
from ..model import Scene
from .settings import SETTINGS


class Instants(NamedTuple):
    """Times in s, sorted; `asked` and `slip` pick from them.

    `asked`: those the user named; `slip`: of a whole slip period, empty where none of the
    user's times begins one. `shift`: half the time around each in which a slip is looked
    for, 0 at rest.
    """

    ts: np.ndarray
    asked: np.ndarray
    slip: np.ndarray
    shift: np.ndarray

    def around(self, end: float) -> tuple[np.ndarray, np.ndarray]:
        """Times just before, at and just after each, sorted, and the way back to (3, n).

        Times that coincide stay apart: their number is one compilation.
        """
        times = np.concatenate([self.ts - self.shift, self.ts, self.ts + self.shift])
        times = np.clip(times, 0, end)
        order = np.argsort(times, kind="stable")
        return times[order], np.argsort(order, kind="stable").reshape(3, -1)

    def in_slip(self, around: np.ndarray, eps: float, end: float) -> np.ndarray:
        """Which instants are inside a slip, by the states (..., 3, n) around them, in m.

        Where a scene begins or ends only one side is known and stands for both.
        """
        cut = (self.ts < self.shift) | (self.ts > end - self.shift)
        moved = np.abs(around[..., 2, :] - around[..., 0, :])
        return np.where(cut, 2.0, 1.0) * moved > SETTINGS.moves * eps


def slips_of(scene: Scene, eps: float) -> float:
    """About how many slips a scene makes: the way of its limit in periods."""
    grid = np.linspace(0.0, float(scene.duration), 401)
    grid = np.union1d(grid, np.asarray(scene.turning_points()))
    return float(np.abs(np.diff(np.asarray(solve_limit(scene, grid).z))).sum() / eps)


def _limit_at(scene: Scene, times: np.ndarray) -> np.ndarray:
    """States of the limit in m at times in any order and shape."""
    known, place = np.unique(times, return_inverse=True)
    return np.asarray(solve_limit(scene, known).z)[place.reshape(times.shape)]


def _speeds(scene: Scene, ts: np.ndarray) -> np.ndarray:
    """Of the limit, m/s."""
    end = float(scene.duration)
    around = np.clip(ts + 1e-4 * end * np.array([[-1.0], [1.0]]), 0, end)
    z = _limit_at(scene, around)
    return np.abs(z[1] - z[0]) / (around[1] - around[0])


def _begin_whole(
    scene: Scene, eps: float, ts: np.ndarray, period: np.ndarray
) -> np.ndarray:
    """Which times (n,) have a whole period ahead: the scene goes on, and so does the slide.

    Told by the way of the limit, not by turning points: a load given by many points has a
    kink in every period.
    """
    end = float(scene.duration)
    z = _limit_at(scene, np.stack([ts, np.minimum(ts + period, end)]))
    steady = np.abs(np.abs(z[1] - z[0]) / eps - 1) < SETTINGS.other_pace
    return steady & (ts + period <= end)


def _middle_of_last(slides: np.ndarray, whole: np.ndarray) -> int | None:
    """Of the times (n,) with a whole period, the nearest to the middle of the last slide.

    Away from the ends of a slide, where the speed changes.
    """
    sliding = np.flatnonzero(slides)
    for slide in np.split(sliding, np.flatnonzero(np.diff(sliding) > 1) + 1)[::-1]:
        begin = slide[whole[slide]]
        if begin.size:
            middle = slide[(slide.size - 1) // 2]
            return int(begin[np.argmin(np.abs(begin - middle))])
    return None


def instants(scene: Scene, eps: float, ts: np.ndarray) -> Instants:
    """The user's times and those of a whole slip period in the middle of the last slide.

    The slip period begins at one of the user's times; only those count that have a whole
    one ahead of them.
    """
    speed = _speeds(scene, ts)
    slides = speed * float(scene.duration) > eps
    period = np.where(slides, eps / np.where(slides, speed, 1.0), 0.0)
    slip = np.zeros(0)
    begin = _middle_of_last(slides, slides & _begin_whole(scene, eps, ts, period))
    if begin is not None:
        share = (np.arange(SETTINGS.slip_times) + 0.5) / SETTINGS.slip_times
        slip = ts[begin] + period[begin] * share
    every = np.union1d(ts, slip)
    asked, of_slip = np.searchsorted(every, ts), np.searchsorted(every, slip)
    shift = np.zeros(every.size)
    shift[asked] = SETTINGS.shift * period
    return Instants(every, asked, of_slip, shift)
