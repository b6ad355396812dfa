"""Slides of a million wells from some tens of them: slips in a steady slide are all alike.

Under a load of constant rate, on a spring, a state that has forgotten its start repeats
itself: `z(t + n T) = z(t) + n eps`, `T = eps k/rate`. And the system knows no origin: where
the load is less by `n k eps` and z by `n eps`, nothing else changes. So whole periods are
cut out of every long stretch of the load, the short system is integrated by hand, and what
was cut is put back. How many periods stay decides how well a start has been forgotten.
"""

import itertools
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import reference as ref
from by_hand import piecewise
from entry import Entry, Truth, load_of, strip_of

STAY = 40  # periods of a slide that are kept; tests compare with twice as many
_LEAST = 4
_BETWEEN = 0.37


class Cut(NamedTuple):
    """Periods cut out at a time of the whole load, which is `at` in the short one."""

    begin: float
    at: float
    period: float
    count: int
    sign: float

    @property
    def end(self) -> float:
        return self.begin + self.count * self.period


def cuts_of(one: Entry, stay: int = STAY) -> list[Cut]:
    """Whole periods that can be cut out of a piecewise linear load."""
    k = one.system.stiffness
    low, high = strip_of(one)
    points = list(zip(*load_of(one.system), strict=True))
    held = np.clip(k * one.z0, points[0][1] - high, points[0][1] - low)
    cuts, gone = [], 0.0
    for (t, load), (t2, load2) in itertools.pairwise(points):
        # A plateau repeats itself after any time, moving by nothing.
        rate = abs(load2 - load) / (t2 - t) or one.system.rate
        sign, period = float(np.sign(load2 - load)), k * one.eps / rate
        edge = held + (high if sign > 0 else low)  # where sliding begins
        rest = max(0.0, sign * (edge - load)) / (k * one.eps)
        count = int((t2 - t) / period - rest - stay) - _LEAST
        if count > 0:
            # Not a whole number of periods after the edge: a slip is there.
            begin = t + (rest + stay + _BETWEEN) * period
            cuts.append(Cut(begin, begin - gone, period, count, sign))
            gone += count * period
        held = np.clip(held, load2 - high, load2 - low)
    return cuts


def short_system(one: Entry, cuts: list[Cut]) -> ref.System:
    """The system without what was cut."""
    times, values = load_of(one.system)
    step = one.system.stiffness * one.eps
    for cut in reversed(cuts):
        later = times > cut.begin
        times = np.where(later, times - cut.count * cut.period, times)
        values = np.where(later, values - cut.sign * cut.count * step, values)
    return replace(
        one.system,
        load=piecewise(times, values),
        duration=float(times[-1]),
        kinks=tuple(times[1:-1]),
    )


def _mapped(ts: np.ndarray, cuts: list[Cut]):
    """Times in the short system, and periods of each cut that have gone before."""
    short, periods = np.array(ts, float), np.zeros((len(cuts), ts.size))
    for i, cut in enumerate(cuts):
        after = (ts > cut.begin) & (ts <= cut.end)
        n = np.where(after, np.ceil((ts - cut.begin) / cut.period), 0.0)
        n = np.where(ts > cut.end, cut.count, np.minimum(n, cut.count))
        periods[i], short = n, short - n * cut.period
    return short, periods


def _integrated(one: Entry, ts: np.ndarray) -> ref.Reference:
    period = one.eps * one.system.stiffness / one.system.rate
    return ref.solve(one.system, one.eps, one.gamma, one.z0, ts, period / 20)


def shortened_with(solve: Truth = _integrated, stay: int = STAY) -> Truth:
    """The reference of a scene with long slides; `solve`: that of the short one."""

    def truth(one: Entry, ts: np.ndarray) -> ref.Reference:
        cuts = cuts_of(one, stay)
        system = short_system(one, cuts)
        short, periods = _mapped(np.asarray(ts, float), cuts)
        short = np.clip(short, 0.0, system.duration)  # a difference that rounds
        marks = [t for cut in cuts for t in (cut.at - cut.period, cut.at)]
        every, place = np.unique(np.concatenate([short, marks]), return_inverse=True)
        found = solve(replace(one, system=system), every)
        at, ends = place[: short.size], place[short.size :].reshape(-1, 2)
        spent = np.array([np.diff(found.dissipation[pair])[0] for pair in ends])
        moved = np.array([np.diff(found.z[pair])[0] for pair in ends]) / one.eps
        signs = np.array([cut.sign for cut in cuts])
        assert np.all(np.abs(moved - signs) < 1e-5), f"not forgotten: {moved - signs}"
        return ref.Reference(
            z=found.z[at] + one.eps * signs @ periods,
            dissipation=found.dissipation[at] + spent @ periods,
            in_slip=found.in_slip[at],
        )

    return truth


shortened = shortened_with()
