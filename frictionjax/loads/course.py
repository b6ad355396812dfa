"""Where a load given as a function turns, has kinks and is steepest: its course."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..arguments import Real, require
from ..intervals import Enclosure, NoRuleError, enclosure_of
from .cells import (
    KINK,
    Cells,
    Kind,
    Point,
    affordable,
    by_bounds,
    halves,
    needle,
    proved_cells,
)
from .sampled_cells import CELLS, by_samples, sampled_cells

_JUMP = 1e-6  # of max |l|: what a load may change by within a few spacings of floats
# A change of slope that is a kink: of the slopes beside it. What l'' may do there is less.
_KINK = 1e-6
_ASIDE = 8  # shortest cells: from a place that is not smooth to what is beside it
_TOGETHER = 1e-12  # of the duration: turning points that are one
_MOST_LOOKS = 60
_STEEPEST = 1.02


class Course(NamedTuple):
    """What a load does on [0, T].

    `turns`: times in s at which l' changes sign; `kinks`: others at which it jumps.
    `steepest`: where |l'| is largest, within 2% where that is proved. `unproved`: what
    stood in the way of a proof, "" for none. `hidden`: how long in s a pulse may last that
    is in neither list, 0 where none may. `size`: largest |l| met, N; `at`: l and l' at
    times (n,).
    """

    turns: np.ndarray
    kinks: np.ndarray
    steepest: float
    unproved: str
    hidden: float
    size: float
    at: Point

    def values(self, times: np.ndarray) -> np.ndarray:
        """l in N at times (n,)."""
        return self.at(times)[0]


def course_of(fn: Callable[[Real], Real], duration: float) -> Course:
    """The course of a load on [0, duration].

    Bounds of l, l' and l'' over cells prove it, where every step of the function has a
    rule; where one has none, or too many cells are needed, samples are taken. Raises
    `ValueError` for a load that jumps or is not finite.
    """
    try:
        bounds = enclosure_of(fn)
    except NoRuleError as missing:
        return _sampled_course(fn, duration, f"{missing} has no bounds")
    cells, at = proved_cells(bounds, duration), by_bounds(bounds)
    if np.any(cells.kind == Kind.OPEN):
        return _sampled_course(fn, duration, "bounds over short stretches are wide")
    turns, kinks = _events(cells, at, duration)
    steepest = _steepest(bounds, at, duration)
    return Course(turns, kinks, steepest, "", 0.0, cells.size, at)


def _sampled_course(fn: Callable, duration: float, why: str) -> Course:
    at, edges = by_samples(fn), np.linspace(0.0, duration, CELLS + 1)
    cells = sampled_cells(at, edges[:-1], edges[1:], duration)
    turns, kinks = _events(cells, at, duration)
    middles = 0.5 * (cells.lo + cells.hi)
    steepest = float(middles[np.argmax(np.abs(at(middles)[1]))])
    return Course(turns, kinks, steepest, why, duration / CELLS, cells.size, at)


def _events(cells: Cells, at: Point, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Turning points, and kinks at which the load does not turn."""
    kinks = _kinks(cells, at, duration)
    cells = _unbent(cells, at)
    turns = _turns(cells, kinks, at)
    near = np.abs(kinks[:, None] - turns) <= _TOGETHER * duration
    others = kinks[~near.any(axis=1)]
    first, last = _TOGETHER * duration, (1 - _TOGETHER) * duration
    inside = (others > first) & (others < last)
    return turns[(turns > first) & (turns < last)], others[inside]


def _kinks(cells: Cells, at: Point, duration: float) -> np.ndarray:
    """Where l' jumps: times on the piece to the right. Raises where l itself does."""
    sharp = np.flatnonzero(cells.kind == Kind.NEEDLE)
    if sharp.size == 0:
        return np.zeros(0)
    aside = _ASIDE * needle(duration)
    starts = np.concatenate([[True], np.diff(cells.lo[sharp]) > aside])
    ends = np.append(starts[1:], True)
    lo, hi = cells.lo[sharp[starts]], cells.hi[sharp[ends]]
    before, after = np.maximum(lo - aside, 0.0), np.minimum(hi + aside, duration)
    (value0, slope0), (value1, slope1) = at(before), at(after)
    change = np.abs(value1 - value0)
    size = cells.size + 1e-300
    jump = int(np.argmax(change))
    known = f"jumps by {change[jump]:.6g} at t = {hi[jump]:.6g}"
    require(change[jump] <= _JUMP * size, "load.fn", known, "a continuous function")
    least = KINK * size / duration + _KINK * np.maximum(np.abs(slope0), np.abs(slope1))
    kink = ~(np.abs(slope1 - slope0) <= least)
    return hi[kink]


def _unbent(cells: Cells, at: Point) -> Cells:
    """Cells on which the slope grows or falls, cut where it is zero."""
    bent = np.flatnonzero(cells.kind == Kind.BENT)
    if bent.size == 0:
        return cells
    lo, hi = cells.lo[bent], cells.hi[bent]
    first, last = at(lo)[1], at(hi)[1]
    turning = first * last < 0
    root = np.where(turning, _roots(at, lo, hi), hi)
    # What does not turn does as its larger end does.
    first = np.where(turning, first, np.where(np.abs(first) > np.abs(last), first, last))
    kind = cells.kind.copy()
    kind[bent] = np.where(first == 0, int(Kind.SMALL), np.sign(first))
    lows = np.concatenate([cells.lo, root[turning]])
    highs = cells.hi.copy()
    highs[bent] = root
    highs = np.concatenate([highs, hi[turning]])
    kind = np.concatenate([kind, np.sign(last[turning]).astype(int)])
    order = np.argsort(lows, kind="stable")
    return Cells(lows[order], highs[order], kind[order], cells.size)


def _roots(at: Point, lo: np.ndarray, hi: np.ndarray) -> np.ndarray:
    """Where l' is zero in each [lo, hi], by Chandrupatla's method.

    Halving takes 50 looks where this takes 8, which is most of the time of a load that
    turns often.
    """
    x1, x2, f1, f2 = hi, lo, at(hi)[1], at(lo)[1]
    share = np.full(lo.size, 0.5)
    for _ in range(_MOST_LOOKS):
        x = x1 + share * (x2 - x1)
        f = at(x)[1]
        same = np.sign(f) == np.sign(f1)
        x3, f3 = np.where(same, x1, x2), np.where(same, f1, f2)
        x2, f2 = np.where(same, x2, x1), np.where(same, f2, f1)
        x1, f1 = x, f
        length = np.abs(x2 - x1)
        least = 2 * np.spacing(np.abs(x1))
        if np.all((length <= least) | (f1 == 0) | (f2 == 0)):
            break
        share = _next_share(x1, x2, x3, f1, f2, f3)
        edge = np.minimum(0.5 * least / np.maximum(length, least), 0.5)
        share = np.clip(share, edge, 1 - edge)
    return np.where(np.abs(f1) <= np.abs(f2), x1, x2)


def _next_share(x1, x2, x3, f1, f2, f3) -> np.ndarray:
    """By the parabola through the last three looks where it can be trusted, else a half."""
    with np.errstate(all="ignore"):
        place, height = (x1 - x2) / (x3 - x2), (f1 - f2) / (f3 - f2)
        fits = (height**2 < place) & ((1 - height) ** 2 < 1 - place)
        first = f1 / (f2 - f1) * f3 / (f2 - f3)
        second = (x3 - x1) / (x2 - x1) * f1 / (f3 - f1) * f2 / (f3 - f2)
        share = np.where(fits, first + second, 0.5)
    return np.where(np.isfinite(share), share, 0.5)


def _turns(cells: Cells, kinks: np.ndarray, at: Point) -> np.ndarray:
    """Times between a rise and a fall: in the rest between, where there is one."""
    moving = np.flatnonzero(np.abs(cells.kind) == 1)
    sign = cells.kind[moving]
    change = np.flatnonzero(sign[1:] != sign[:-1])
    ends, begins = cells.hi[moving[change]], cells.lo[moving[change + 1]]
    rests = np.array(
        [
            np.any(cells.kind[a + 1 : b] == Kind.FLAT)
            for a, b in zip(moving[change], moving[change + 1], strict=True)
        ],
        dtype=bool,
    )
    found = ends.copy()
    # Where nothing moves by more than its rounding, l' says where it turns.
    unsure = np.flatnonzero((begins > ends) & ~rests)
    if unsure.size:
        found[unsure] = _roots(at, ends[unsure], begins[unsure])
    for k, (end, begin) in enumerate(zip(ends, begins, strict=True)):
        held = kinks[(kinks >= end) & (kinks <= begin)]
        if held.size:
            found[k] = held[0]
    return found


def _steepest(bounds: Enclosure, at: Point, duration: float) -> float:
    """A time at which |l'| is within 2% of its largest, by bounds of it."""
    edges = np.linspace(0.0, duration, 65)
    lo, hi, place, best = edges[:-1], edges[1:], 0.5 * duration, 0.0
    left = affordable(bounds) // 8
    while 0 < lo.size <= left:
        middles = 0.5 * (lo + hi)
        sizes = np.abs(at(middles)[1])
        k = int(np.argmax(sizes))
        if sizes[k] > best:
            place, best = float(middles[k]), float(sizes[k])
        whole = bounds(lo, hi)
        away = 0.5 * (hi - lo) * whole.bend.size
        with np.errstate(invalid="ignore"):
            from_middle = np.where(whole.seam, np.inf, sizes + away)
        most = np.fmin(whole.slope.size, from_middle)
        open_ = (most > _STEEPEST * best) & (hi - lo > needle(duration))
        lo, hi = halves(lo[open_], hi[open_])
        left -= lo.size
    return place
