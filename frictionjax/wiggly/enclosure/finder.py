"""Rides of a sweep: the slip map between looks through lanes, and measured by lanes."""

import functools
from collections.abc import Callable

import numpy as np

from ..._compile import crew
from ..lanes import SegmentEnds
from ..slip_map import (
    BARE_TAIL,
    TAIL,
    FastSlide,
    FastSlideFinder,
    FoundTips,
    ManyTransitTimes,
    fast_slide_through,
)
from .brackets import BracketPlan, Brackets
from .close import EARLIER, ROUNDS, BracketContext, run_ups
from .closeness import wells_between
from .requirements import Requirements
from .starts import Starts

# Tolerance of the lanes that measure a slip map, of the tolerance of others, and the
# tightest that is of use. (gamma = 1/2, eps 1e-3 to 1e-4, accuracy 1e-3: the same errors of
# maps from 1e-11 to 3e-8, in a third of the steps; others add up to as much as 0.02. At
# accuracy 1e-6 brackets of eps = 1.3e-5 stay open with 1e-10 at least.)
_TIGHT_RIDE, _TIGHTEST_RIDE = 0.05, 1e-12
# Errors of a map at its start, as lanes leave it, and at least, of the accuracy. (At 0.1
# brackets of times in the first wells of a ride stayed open where the tip was nearly in a
# slip.)
_SET_OFF, _LEAST_ERROR = 0.02, 0.01
_TIGHT_LOOK = 0.2  # of the tolerance: lanes that lead to the start of a slip map
# Share of the accuracy that rounding may take in a measurement of a slip map, wells that
# lanes go through for it at most, and what rounding of loads takes of a spacing of times.
# (eps = 1e-8, gamma = 1/4: lanes of a twentieth of the wells find the same errors, in a
# third of the steps, where the rounding of times is taken off, eight times larger ones
# where it is not; two wells everywhere find 3.5 times larger ones.)
_NOISE, _MOST_CHECKED, _OF_LOADS = 0.03, 400.0, 0.05


def find_fast_slides(rounds: BracketContext, needs: Requirements) -> Callable[[], None]:
    """Put the rides of all cells into the ground of the rounds.

    Returns what waits for the lanes that measure them, and adds up their steps.
    """
    ground, folds = rounds.ground, rounds.ground.folds
    sides = {
        1.0: (np.asarray(folds.place_plus), np.asarray(folds.force_plus)),
        -1.0: (np.asarray(folds.place_minus), np.asarray(folds.force_minus)),
    }
    cells_ = rounds.cells
    fixed = {name: _TIGHT_LOOK * getattr(cells_, name) for name in ("tolerance", "loosest")}
    closer = rounds._replace(cells=cells_._replace(**fixed), brief=None)
    lag = np.maximum(ground.lag_plus, ground.lag_minus) / ground.eps
    of_cells = ground.eps, cells_.viscosity, lag, sides
    tail = (TAIL if any(rounds.wanted) else BARE_TAIL) * rounds.accuracy
    rider = FastSlideFinder(
        rounds.scene, rounds.path, *of_cells, needs.cut, tail, rounds.accuracy
    )

    def look(cell: np.ndarray, begin: np.ndarray, stop: np.ndarray) -> FoundTips:
        paired, one = np.ones(cell.size, dtype=bool), np.arange(cell.size)
        windows = Brackets(cell, np.minimum(begin, stop), paired, one, stop)
        wells, back = run_ups(rounds, windows, needs.warm), np.ones(cell.size)
        found, open_ = FoundTips(*np.empty((3, cell.size))), one
        for _ in range(ROUNDS):
            some = windows.chosen(open_)
            plan, arrived = closer.run(some, wells[open_], back[open_])
            for column, part in zip(found, _at_stops(rounds, plan, arrived), strict=True):
                column[open_] = part
            open_ = np.flatnonzero(~(found.gap <= _SET_OFF * rounds.accuracy))
            if open_.size == 0:
                break
            wells[open_], back[open_] = wells[open_] * EARLIER, back[open_] * EARLIER
        return found

    def keep(cell: int, ride: FastSlide) -> None:
        ground.rides[cell] = (*ground.rides[cell], ride)

    spent: list[np.ndarray] = []

    def check(cells: list[int], rides: list[FastSlide], gaps: list[float]) -> list:
        blank = np.zeros_like(rounds.spent), np.zeros_like(rounds.waited)
        own = rounds._replace(spent=blank[0], waited=blank[1])
        spent.append(own.spent)
        errors = _errors(own, cells, rides, gaps)
        return [lambda k=k: errors()[k] for k in range(len(rides))]

    def wait() -> None:
        for rides in ground.rides:
            for ride in rides:
                ride.measured()
        rounds.spent[:] += sum(spent)

    fast_slide_through(rider, np.arange(ground.eps.size), look, check, keep)
    return wait


def _at_stops(rounds: BracketContext, plan: BracketPlan, found: SegmentEnds):
    """Well, tip and gap in wells of time at the one stop of each window."""
    a, b = plan.behind, np.maximum(plan.ahead, 0)
    way = wells_between(found.well[a], found.tip[a], found.well[b], found.tip[b])
    gap = np.where(plan.ahead >= 0, np.abs(way), 0.0)
    pace = np.abs(found.speed[a]) / rounds.path.speed
    gap = np.where(np.isnan(gap), np.inf, gap / np.clip(pace, 1e-300, 1.0))
    return found.well[a], found.tip[a], gap


def _wells_checked(rounds: BracketContext, cell: int, ride: FastSlide) -> np.ndarray:
    """Wells that lanes go through on each panel: more where rounding adds up."""
    curve = ride.curve
    length = np.diff(curve.starts) / np.diff(curve.edges)
    noise = _OF_LOADS * np.finfo(float).eps * curve.starts[1:] / length
    memory = 1 / np.maximum(np.abs(1 - curve.kept), 1e-12)
    wanted = noise * memory / (_NOISE * rounds.accuracy)
    return np.minimum(np.clip(np.ceil(wanted), 2, _MOST_CHECKED), np.diff(curve.edges))


def _errors(
    rounds: BracketContext, cells: list[int], rides: list[FastSlide], gaps: list[float]
) -> Callable[[], list[np.ndarray]]:
    """Errors in the tip on the panels of rides: what lanes find in some wells, summed up.

    Counted in wells of time, which are as many periods of the tip as it is slow there.
    `gaps`: of each ride's start, in wells of time. Lanes set off at once; what is returned
    waits for them.
    """
    wells = [_wells_checked(rounds, c, r) for c, r in zip(cells, rides, strict=True)]
    sizes = [own.size for own in wells]
    count, who = np.concatenate(wells), np.repeat(np.arange(len(rides)), sizes)
    number = np.concatenate([ride.curve.edges[:-1] for ride in rides])
    curves = ManyTransitTimes([ride.curve for ride in rides])
    both, late = curves.rounded_times(np.tile(who, 2), np.append(number, number + count))
    begin, stop = np.split(both, 2)
    sign, first, tip = np.array([(r.sign, r.well, r.tip) for r in rides])[who].T
    well, aim = first + sign * number, first + sign * (number + count)
    whose, known = np.array(cells)[who], np.ones(tip.size, dtype=bool)
    never = np.full(tip.size, -np.inf)
    starts = Starts(begin, known, ~known, known, never, well, tip, well, tip)
    usual = np.asarray(rounds.cells.tolerance)
    tight = np.minimum(np.maximum(_TIGHT_RIDE * usual, _TIGHTEST_RIDE), usual)
    exact = rounds._replace(cells=rounds.cells._replace(tolerance=tight, loosest=tight))
    windows = Brackets(whose, begin, known, np.arange(tip.size), stop)
    # Planned here: two threads that plan wait for each other.
    plan = exact.planned(windows, starts)
    # While windows are laid out.
    lanes = crew("measuring", 1).submit(exact.through, plan)

    @functools.cache
    def summed() -> list[np.ndarray]:
        found, at = lanes.result().found, plan.behind
        place = wells_between(aim, tip, found.well[at], found.tip[at])
        # In wells of time: at its fold the tip is far slower than on the average.
        pace = np.abs(found.speed[at]) * (stop - begin) / (count * rounds.ground.eps[whose])
        # The lane sets off, and is asked, at rounded times.
        off = np.diff(np.split(late, 2), axis=0)[0] * count / (stop - begin)
        drift = np.abs(sign * place / np.maximum(pace, 1e-300) - off) / count
        ends = np.cumsum(sizes)[:-1]
        parts = zip(rides, np.split(drift, ends), np.split(pace, ends), gaps, strict=True)
        return [_summed(rounds, *part) for part in parts]

    return summed


def _summed(rounds: BracketContext, ride: FastSlide, drift, pace, gap: float) -> np.ndarray:
    """Errors that grow by `drift` a well and are forgotten as shifts in time are."""
    curve = ride.curve
    error, errors = max(gap, _SET_OFF * rounds.accuracy), []
    for k, wells in enumerate(np.diff(curve.edges)):
        left = curve.kept[k] ** wells
        grown = (1 - left) / (1 - curve.kept[k]) if curve.kept[k] != 1 else wells
        after = error * left + drift[k] * grown + curve.tail[k]
        # NaN of a lane that failed stays: `max` would lose it.
        errors.append(np.max((error, after, _LEAST_ERROR * rounds.accuracy)))
        error = after
    return np.array(errors) * np.minimum(pace, 1.0)
