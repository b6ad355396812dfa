"""Times of passage of slides as Chebyshev series on panels of wells."""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from .settings import SETTINGS


class TransitTimes(NamedTuple):
    """Times of passage of one slide.

    `edges` (K+1,): numbers of lattice points. `starts` (K+1,): times there, s. `series`
    (K, degree + 1): of T less the panel's start. `tail` (K,): its last coefficients,
    in wells. `kept` (K,): share of a shift that a well leaves of it; `last`: at the end.
    """

    edges: np.ndarray
    starts: np.ndarray
    series: np.ndarray
    tail: np.ndarray
    kept: np.ndarray
    last: float

    def time_of(self, number: np.ndarray) -> np.ndarray:
        """Time in s at which each lattice point is passed, numbers need not be whole."""
        return ManyTransitTimes([self]).time_of(np.zeros(number.size, dtype=int), number)

    def number_at(self, time: np.ndarray) -> np.ndarray:
        """Lattice point that is passed at each time between the ends."""
        return ManyTransitTimes([self]).number_at(np.zeros(time.size, dtype=int), time)


class ManyTransitTimes:
    """Curves of many slides, asked all at once: a call for each took 0.2 ms."""

    def __init__(self, curves: list[TransitTimes]):
        self.edges = np.concatenate([c.edges[:-1] for c in curves])
        self.wells = np.concatenate([np.diff(c.edges) for c in curves])
        self.starts = np.concatenate([c.starts[:-1] for c in curves])
        self.lengths = np.concatenate([np.diff(c.starts) for c in curves])
        self.series = np.concatenate([c.series for c in curves])
        self._numbers = _Ranks([c.edges for c in curves])
        self._times = _Ranks([c.starts for c in curves])

    def panel_of(self, which: np.ndarray, number: np.ndarray) -> np.ndarray:
        """Panel, of all, on which each lattice point of the curve `which` is."""
        return self._numbers.find(which, number)

    def time_of(self, which: np.ndarray, number: np.ndarray) -> np.ndarray:
        """As that of each curve."""
        start, since = self._times_of(which, number)
        return start + since

    def rounded_times(
        self, which: np.ndarray, number: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """`time_of`, and by how much rounding has made these times too late, in s.

        Far below the spacing of floats there: the series count from the panel's start.
        """
        start, since = self._times_of(which, number)
        time = start + since
        part = time - start
        return time, ((time - part) - start) + (part - since)  # exact (Knuth's TwoSum)

    def _times_of(self, which: np.ndarray, number: np.ndarray):
        """Starts of the panels of lattice points, and times since then, in s."""
        panel = self.panel_of(which, number)
        part = np.clip((number - self.edges[panel]) / self.wells[panel], 0.0, 1.0)
        order = np.arange(self.series.shape[1])
        # `T_k(2 p - 1) - T_k(-1) = -2 (-1)^k sin^2(k arcsin sqrt(p))`: small terms a few
        # wells behind the start of 1e7. (Cosines cancelled there, to 0.02 of a spacing.)
        waves = np.sin(np.arcsin(np.sqrt(part))[:, None] * order) ** 2
        since = np.sum(self.series[panel] * (-2 * (-1.0) ** order) * waves, axis=1)
        return self.starts[panel], since

    def number_at(self, which: np.ndarray, time: np.ndarray) -> np.ndarray:
        """As that of each curve."""
        panel = self._times.find(which, time)
        since, whole = time - self.starts[panel], self.lengths[panel]
        x = np.clip(2 * since / whole - 1, -1.0, 1.0)
        series, order = self.series[panel], np.arange(self.series.shape[1])
        slopes = chebyshev.chebder(series.T).T
        for _ in range(SETTINGS.number_sweeps):
            waves = np.cos(np.arccos(x)[:, None] * order)
            value = np.sum(series * waves, axis=1)
            slope = np.sum(slopes * waves[:, :-1], axis=1)
            before, x = x, np.clip(x - (value - since) / slope, -1.0, 1.0)
            if np.all(np.abs(x - before) <= SETTINGS.settled):
                break
        return self.edges[panel] + 0.5 * (x + 1) * self.wells[panel]


class _Ranks:
    """Rows of rising numbers, one after the other, and which interval holds a value."""

    def __init__(self, rows: list[np.ndarray]):
        self._low = np.array([row[0] for row in rows])
        self._whole = np.array([row[-1] for row in rows]) - self._low
        counts = np.array([row.size - 1 for row in rows])
        self._past = np.cumsum(counts)
        self._first = self._past - counts
        owner = np.repeat(np.arange(counts.size), counts)
        inner = np.concatenate([row[:-1] for row in rows])
        # Shares of each row's way, one row above the other.
        self._keys = owner + (inner - self._low[owner]) / self._whole[owner]

    def find(self, which: np.ndarray, value: np.ndarray) -> np.ndarray:
        """Index, of all intervals, in the row `which`."""
        share = np.clip((value - self._low[which]) / self._whole[which], 0.0, 1.0)
        found = np.searchsorted(self._keys, which + share, side="right") - 1
        return np.clip(found, self._first[which], self._past[which] - 1)
