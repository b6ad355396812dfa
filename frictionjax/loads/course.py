"""Where a load given as a function turns, has kinks and is steepest: its course."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .._checks import Real
from ..intervals import Enclosure, NoRuleError, TooMuchWorkError, enclosure_of
from .cells import Kind, LoadCells, LoadPoint, by_bounds, halves, needle, proved_cells
from .needles import kinks_of, require_numbers_inside
from .sampled_cells import Samples, sampled_cells
from .settings import SETTINGS


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
    at: LoadPoint

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
    try:
        return _proved_course(fn, bounds, duration)
    except TooMuchWorkError:
        return _sampled_course(fn, duration, "bounds over short stretches are wide")


def _proved_course(fn: Callable, bounds: Enclosure, duration: float) -> Course:
    """By bounds alone; raises `TooMuchWorkError`."""
    cells, at = proved_cells(bounds, duration), by_bounds(bounds)
    bounds.allow(SETTINGS.most_numbers)
    require_numbers_inside(fn, bounds, cells)
    if np.any(cells.kind == Kind.OPEN):
        raise TooMuchWorkError
    turns, kinks = _events(cells, at, duration)
    steepest = _steepest(bounds, at, duration)
    bounds.allow(np.inf)
    return Course(turns, kinks, steepest, "", 0.0, cells.size, at)


def _sampled_course(fn: Callable, duration: float, why: str) -> Course:
    samples = Samples(fn)
    cells = sampled_cells(samples, duration)
    turns, kinks = _events(cells, samples, duration)
    middles = 0.5 * (cells.lo + cells.hi)
    steepest = float(middles[np.argmax(np.abs(samples(middles)[1]))])
    hidden = duration / samples.cells
    return Course(turns, kinks, steepest, why, hidden, cells.size, samples)


def _events(
    cells: LoadCells, at: LoadPoint, duration: float
) -> tuple[np.ndarray, np.ndarray]:
    """Turning points, and kinks at which the load does not turn."""
    kinks = kinks_of(cells, at, duration)
    cells = _unbent(cells, at)
    turns = _turns(cells, kinks, at)
    others = kinks[_gaps(kinks, turns) > SETTINGS.together * duration]
    first, last = SETTINGS.together * duration, (1 - SETTINGS.together) * duration
    inside = (others > first) & (others < last)
    return turns[(turns > first) & (turns < last)], others[inside]


def _gaps(times: np.ndarray, others: np.ndarray) -> np.ndarray:
    """From each time to the nearest of the others, which increase."""
    edges = np.concatenate([[-np.inf], others, [np.inf]])
    right = np.searchsorted(edges, times)
    return np.minimum(edges[right] - times, times - edges[right - 1])


def _unbent(cells: LoadCells, at: LoadPoint) -> LoadCells:
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
    return LoadCells(lows[order], highs[order], kind[order], cells.size)


def _roots(at: LoadPoint, lo: np.ndarray, hi: np.ndarray) -> np.ndarray:
    """Where l' is zero in each [lo, hi], by Chandrupatla's method.

    Halving takes 50 looks where this takes 8, which is most of the time of a load that
    turns often.
    """
    x1, x2, f1, f2 = hi, lo, at(hi)[1], at(lo)[1]
    share = np.full(lo.size, 0.5)
    for _ in range(SETTINGS.most_looks):
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


def _turns(cells: LoadCells, kinks: np.ndarray, at: LoadPoint) -> np.ndarray:
    """Times between a rise and a fall: in the rest between, where there is one."""
    moving = np.flatnonzero(np.abs(cells.kind) == 1)
    sign = cells.kind[moving]
    change = np.flatnonzero(sign[1:] != sign[:-1])
    ends, begins = cells.hi[moving[change]], cells.lo[moving[change + 1]]
    flat = np.append(0, np.cumsum(cells.kind == Kind.FLAT))
    rests = flat[moving[change + 1]] > flat[moving[change]]
    found = ends.copy()
    # Where nothing moves by more than its rounding, l' says where it turns.
    unsure = np.flatnonzero((begins > ends) & ~rests)
    if unsure.size:
        found[unsure] = _roots(at, ends[unsure], begins[unsure])
    if kinks.size == 0:
        return found
    kinks = np.sort(kinks)
    first = kinks[np.minimum(np.searchsorted(kinks, ends), kinks.size - 1)]
    return np.where((first >= ends) & (first <= begins), first, found)


def _steepest(bounds: Enclosure, at: LoadPoint, duration: float) -> float:
    """A time at which |l'| is within 2% of its largest, by bounds of it."""
    edges = np.linspace(0.0, duration, 65)
    lo, hi, place, best = edges[:-1], edges[1:], 0.5 * duration, 0.0
    bounds.allow(SETTINGS.steepest_share * SETTINGS.most_numbers)
    while lo.size:
        try:
            whole = bounds(lo, hi)
            sizes = np.abs(at(0.5 * (lo + hi))[1])
        except TooMuchWorkError:
            break
        middles = 0.5 * (lo + hi)
        k = int(np.argmax(sizes))
        if sizes[k] > best:
            place, best = float(middles[k]), float(sizes[k])
        away = 0.5 * (hi - lo) * whole.bend.size
        with np.errstate(invalid="ignore"):
            from_middle = np.where(whole.seam, np.inf, sizes + away)
        most = np.fmin(whole.slope.size, from_middle)
        open_ = (most > SETTINGS.steepest * best) & (hi - lo > needle(duration))
        lo, hi = halves(lo[open_], hi[open_])
    return place
