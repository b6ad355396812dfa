"""Fast slides of a sweep: what slip maps ask of lanes, answered by lanes.

What they want to know is said by `slip_map.asking_for_slides`; here it is found out."""

import functools
from collections.abc import Callable
from concurrent.futures import Future
from typing import NamedTuple

import numpy as np

from ..._compile import crew
from ..lanes import SegmentEnds
from ..slip_map import SETTINGS as MAP_SETTINGS
from ..slip_map import (
    FastSlide,
    FastSlideFinder,
    FoundTips,
    LookAt,
    ManyTransitTimes,
    Measure,
    asking_for_slides,
)
from .brackets import BracketPlan, Brackets
from .close import run_ups
from .closeness import wells_between
from .marching import BracketContext, BracketRound, Effort, no_effort
from .requirements import Requirements
from .settings import SETTINGS
from .starts import Starts


class FoundSlides(NamedTuple):
    """Fast slides of all cells, tuples in time of shape (cells,).

    `looks`: what lanes took that led to them. `measuring`: lanes that may still be under
    way, of which slides wait for their errors.
    """

    slides: np.ndarray
    looks: Effort
    measuring: tuple[Future[BracketRound], ...]

    def effort(self) -> Effort:
        """What all lanes took, once those that measure have arrived."""
        whole = self.looks
        for lanes in self.measuring:
            whole = whole.more(lanes.result().effort)
        return whole


def find_fast_slides(rounds: BracketContext, needs: Requirements) -> FoundSlides:
    """The fast slides of all cells, whose errors are still being measured."""
    looks = rounds
    measuring: tuple[Future[BracketRound], ...] = ()
    asking = asking_for_slides(_finder_of(rounds, needs))
    try:
        wanted = next(asking)
        while True:
            if isinstance(wanted, LookAt):
                tips, effort = _seen(looks, needs, wanted)
                looks = looks._replace(effort=effort)
                wanted = asking.send(tips)
            else:
                lanes, waiting = _measuring(rounds, wanted)
                measuring = (*measuring, lanes)
                wanted = asking.send(waiting)
    except StopIteration as end:
        return FoundSlides(end.value, looks.effort, measuring)


def _finder_of(rounds: BracketContext, needs: Requirements) -> FastSlideFinder:
    """What slip maps need to know of the cells."""
    ground, folds = rounds.ground, rounds.ground.folds
    tail = MAP_SETTINGS.tail if rounds.summed else MAP_SETTINGS.bare_tail
    return FastSlideFinder(
        scene=rounds.scene,
        path=rounds.path,
        eps=ground.eps,
        viscosity=rounds.cells.viscosity,
        lag=ground.longest_lag,
        folds={
            1.0: (np.asarray(folds.place_plus), np.asarray(folds.force_plus)),
            -1.0: (np.asarray(folds.place_minus), np.asarray(folds.force_minus)),
        },
        slow=needs.restarts,
        tail=tail * rounds.accuracy,
        accuracy=rounds.accuracy,
    )


def _seen(
    rounds: BracketContext, needs: Requirements, wanted: LookAt
) -> tuple[FoundTips, Effort]:
    """Where lanes find the tips that are asked for, and what has been taken up to then."""
    cells = rounds.cells
    closer = cells._replace(
        tolerance=SETTINGS.tight_look * cells.tolerance,
        loosest=SETTINGS.tight_look * cells.loosest,
    )
    ground = rounds.ground._replace(fast_slides=wanted.known)
    looks = rounds._replace(ground=ground, cells=closer, brief=None, looking=True)
    count = wanted.cells.size
    paired, one = np.ones(count, dtype=bool), np.arange(count)
    begins = np.minimum(wanted.begins, wanted.stops)
    brackets = Brackets(wanted.cells, begins, paired, one, wanted.stops)
    found, open_ = FoundTips._make(np.full((3, count), np.inf)), one
    if wanted.tips is not None:
        told = np.flatnonzero(wanted.tips.gap <= SETTINGS.set_off * rounds.accuracy)
        starts = _from_tips(begins[told], wanted.tips.well[told], wanted.tips.tip[told])
        plan, arrived, effort = looks.march_from(brackets.chosen(told), starts)
        looks = looks._replace(effort=effort)
        well, tip, gap = _at_stops(looks, plan, arrived)
        gap = np.maximum(gap, wanted.tips.gap[told])
        for column, part in zip(found, (well, tip, gap), strict=True):
            column[told] = part
        open_ = one[~(found.gap <= SETTINGS.set_off * rounds.accuracy)]
    # They have to close to less than others.
    wells = np.maximum(run_ups(looks, brackets, needs.run_up), SETTINGS.margin + 1)
    back = np.ones(count)
    for _ in range(SETTINGS.rounds):
        if open_.size == 0:
            break
        open_brackets = brackets.chosen(open_)
        plan, arrived, effort = looks.run(open_brackets, wells[open_], back[open_])
        looks = looks._replace(effort=effort)
        for column, part in zip(found, _at_stops(looks, plan, arrived), strict=True):
            column[open_] = part
        open_ = one[~(found.gap <= SETTINGS.set_off * rounds.accuracy)]
        wells[open_], back[open_] = (
            wells[open_] * SETTINGS.earlier,
            back[open_] * SETTINGS.earlier,
        )
    return found, looks.effort


def _from_tips(begin: np.ndarray, well: np.ndarray, tip: np.ndarray) -> Starts:
    """Starts of one lane alone from each known tip."""
    every, count = np.ones(tip.size, dtype=bool), tip.size
    return Starts(
        time=begin,
        known_start=every,
        from_slide=~every,
        lagging=every,
        until=np.full(count, -np.inf),
        pace=np.full(count, np.inf),
        behind_well=well,
        behind_tip=tip,
        ahead_well=well,
        ahead_tip=tip,
    )


def _at_stops(rounds: BracketContext, plan: BracketPlan, ends: SegmentEnds):
    """Well, tip and gap in wells of time at the one stop of each bracket."""
    a, b = plan.behind, np.maximum(plan.ahead, 0)
    way = wells_between(ends.well[a], ends.tip[a], ends.well[b], ends.tip[b])
    gap = np.where(plan.ahead >= 0, np.abs(way), 0.0)
    pace = np.abs(ends.speed[a]) / rounds.path.speed
    gap = np.where(np.isnan(gap), np.inf, gap / np.clip(pace, 1e-300, 1.0))
    return ends.well[a], ends.tip[a], gap


def _wells_checked(rounds: BracketContext, cell: int, slide: FastSlide) -> np.ndarray:
    """Wells that lanes go through on each panel: more where rounding adds up."""
    curve = slide.curve
    length = np.diff(curve.starts) / np.diff(curve.edges)
    noise = SETTINGS.of_loads * np.finfo(float).eps * curve.starts[1:] / length
    memory = 1 / np.maximum(np.abs(1 - curve.kept), 1e-12)
    wanted = noise * memory / (SETTINGS.noise * rounds.accuracy)
    return np.minimum(
        np.clip(np.ceil(wanted), 2, SETTINGS.most_checked), np.diff(curve.edges)
    )


def _measuring(
    rounds: BracketContext, wanted: Measure
) -> tuple[Future[BracketRound], list[Callable[[], np.ndarray]]]:
    """Lanes that have set off, and what waits for the errors that they find of each slide.

    Errors in the tip on the slide's panels: what lanes find in some wells, summed up.
    Counted in wells of time, which are as many periods of the tip as it is slow there.
    """
    known_slides, cells, slides, gaps = wanted
    wells = [_wells_checked(rounds, c, s) for c, s in zip(cells, slides, strict=True)]
    sizes = [on_slide.size for on_slide in wells]
    count, who = np.concatenate(wells), np.repeat(np.arange(len(slides)), sizes)
    number = np.concatenate([slide.curve.edges[:-1] for slide in slides])
    curves = ManyTransitTimes([slide.curve for slide in slides])
    both, late = curves.rounded_times(np.tile(who, 2), np.append(number, number + count))
    begin, stop = np.split(both, 2)
    sign, first, tip = np.array([(s.sign, s.well, s.tip) for s in slides])[who].T
    well, aim = first + sign * number, first + sign * (number + count)
    whose, every = np.array(cells)[who], np.ones(tip.size, dtype=bool)
    starts = _from_tips(begin, well, tip)
    exact = _exact(rounds, known_slides)
    brackets = Brackets(whose, begin, every, np.arange(tip.size), stop)
    # Planned here: two threads that plan wait for each other.
    plan = exact.planned(brackets, starts)
    # While brackets are laid out.
    lanes = crew("measuring", 1).submit(exact.through, plan)

    @functools.cache
    def summed() -> list[np.ndarray]:
        ends, at = lanes.result().ends, plan.behind
        place = wells_between(aim, tip, ends.well[at], ends.tip[at])
        # In wells of time: at its fold the tip is far slower than on the average.
        pace = np.abs(ends.speed[at]) * (stop - begin) / (count * rounds.ground.eps[whose])
        # The lane sets off, and is asked, at rounded times.
        off = np.diff(np.split(late, 2), axis=0)[0] * count / (stop - begin)
        drift = np.abs(sign * place / np.maximum(pace, 1e-300) - off) / count
        cuts = np.cumsum(sizes)[:-1]
        parts = zip(slides, np.split(drift, cuts), np.split(pace, cuts), gaps, strict=True)
        return [
            _summed(rounds, slide, drift=own_drift, pace=own_pace, gap=gap)
            for slide, own_drift, own_pace, gap in parts
        ]

    return lanes, [lambda k=k: summed()[k] for k in range(len(slides))]


def _exact(rounds: BracketContext, known: np.ndarray) -> BracketContext:
    """For lanes that measure, whatever others of their cells have taken.

    Where their cell has an earlier slide, those that `brackets` calls forgetful keep the
    looser tolerance `brief` (`BracketContext._steered`), not the tight one.
    """
    usual = np.asarray(rounds.cells.tolerance)
    tight = np.minimum(
        np.maximum(SETTINGS.tight_measure * usual, SETTINGS.tightest_measure), usual
    )
    cells = rounds.cells._replace(tolerance=tight, loosest=tight)
    ground = rounds.ground._replace(fast_slides=known)
    return rounds._replace(ground=ground, cells=cells, effort=no_effort(usual.size))


def _summed(
    rounds: BracketContext, slide: FastSlide, drift, pace, gap: float
) -> np.ndarray:
    """Errors that grow by `drift` a well and are forgotten as shifts in time are."""
    curve = slide.curve
    error, errors = max(gap, SETTINGS.set_off * rounds.accuracy), []
    for k, wells in enumerate(np.diff(curve.edges)):
        left = curve.kept[k] ** wells
        grown = (1 - left) / (1 - curve.kept[k]) if curve.kept[k] != 1 else wells
        after = error * left + drift[k] * grown + curve.tail[k]
        # NaN of a lane that failed stays: `max` would lose it.
        errors.append(np.max((error, after, SETTINGS.least_error * rounds.accuracy)))
        error = after
    return np.array(errors) * np.minimum(pace, 1.0)
