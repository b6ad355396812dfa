"""Where lanes set off: provably below and above the tip, from z0, or from a fast slide."""

from typing import NamedTuple

import numpy as np

from ...numerics import rows_of
from ..equation import WiggleFolds
from ..limit_path import Path
from ..slip_map import FastSlide, ManyTransitTimes, last_begun
from .settings import SETTINGS


class CellBounds(NamedTuple):
    """What brackets need to know of each cell, shape (cells,) each.

    Of slides to the right and to the left, (cells, 2): `lags`: how far in m steady ones
    stay behind the strip's edge, at most. `powers`: of the speed that lags grow with.
    `memories`: way in m in which they forget all but 1/e. `shifts`: by how much in m folds
    at this eps differ from rho. `landed`: wells beyond a fold at which tips are half a well
    further, at most.
    `phase`: how far ahead on the surface the bristle stands, in periods: its wells have
    numbers less by that.
    `relaxed`: time in s from which on a start outside the strip is forgotten, by Lemma 7.
    `affordable`: wells that one lane alone may go through.
    `fast_slides`: tuples of `FastSlide`, in time.
    `at_turns`: what steps of lanes may err by that go over a kink of the path, in periods,
    (cells, kinks).
    """

    eps: np.ndarray
    folds: WiggleFolds
    lags: np.ndarray
    powers: np.ndarray
    memories: np.ndarray
    shifts: np.ndarray
    landed: np.ndarray
    start_well: np.ndarray
    start_tip: np.ndarray
    relaxed: np.ndarray
    affordable: np.ndarray
    phase: np.ndarray
    fast_slides: np.ndarray
    at_turns: np.ndarray

    def power(self, cell: np.ndarray, direction: np.ndarray) -> np.ndarray:
        """Of slides of cells in a direction."""
        return self.powers[cell, side_column(direction)]

    def memory(self, cell: np.ndarray, direction: np.ndarray) -> np.ndarray:
        """Of the fastest slides of cells in a direction, in wells."""
        return self.memories[cell, side_column(direction)] / self.eps[cell]

    def is_affordable(self, path: Path) -> np.ndarray:
        """Whether one lane alone may go through all of the path, (cells,)."""
        return (path.travel[-1] / self.eps <= self.affordable) & ~self.is_far(path)

    def is_far(self, path: Path) -> np.ndarray:
        """Whether z0 is too far from the strip for a lane to come from there, (cells,)."""
        return path.outside / self.eps > SETTINGS.farthest

    def has_few_wells(self, path: Path) -> np.ndarray:
        """Whether the path has no more wells than one lane usually goes through."""
        return path.travel[-1] / self.eps <= SETTINGS.affordable

    @property
    def longest_memory(self) -> np.ndarray:
        """Of both directions, in wells, (cells,)."""
        return self.memories.max(axis=1) / self.eps

    @property
    def longest_lag(self) -> np.ndarray:
        """Of both directions, in wells, (cells,)."""
        return self.lags.max(axis=1) / self.eps


def side_column(direction: np.ndarray) -> np.ndarray:
    """The column of slides in a direction."""
    return (direction <= 0).astype(int)


class Starts(NamedTuple):
    """Where lanes of brackets set off, shape (W,).

    `time` in s. `known_start`: from the known z0; `from_slide`: from a fast slide, as
    closely as its error says, which ends at `until` (s) and has the speed `pace` (m/s)
    where the bracket begins; `lagging`: behind one, with the largest lag there is.
    `behind_*` and `ahead_*`: well and tip of the two lanes of the bracket.
    """

    time: np.ndarray
    known_start: np.ndarray
    from_slide: np.ndarray
    lagging: np.ndarray
    until: np.ndarray
    pace: np.ndarray
    behind_well: np.ndarray
    behind_tip: np.ndarray
    ahead_well: np.ndarray
    ahead_tip: np.ndarray


def _run_up(path: Path) -> np.ndarray:
    """Way in m that the path has come in a piece's direction before it, (P,).

    Rests between do not count as a turn, nor does what was before t = 0.
    """
    before = np.zeros(path.direction.size)
    came, heading = 0.0, 0.0
    for i, direction in enumerate(path.direction):
        if direction not in (0.0, heading):
            came, heading = 0.0, direction
        before[i] = came
        came += path.travel[i + 1] - path.travel[i]
    return before


def starts_of(
    path: Path,
    ground: CellBounds,
    cell: np.ndarray,
    begin: np.ndarray,
    wells,
    back,
    measured: bool = True,
) -> Starts:
    """Starts at least `wells` of the path's way before each bracket, or `back` of a slide.

    On a slide the tip cannot be past the first fold beyond the strip's edge: it would have
    had to climb it against a force. Nor can it be further behind than a steady slide at
    the largest speed of the scene; where that is many wells, of the moment. Both hold once
    the path has come further than the lag of the slide before in the other direction. Two
    wells later in the same piece, on a slow slide, the tip has been through every slip that
    is over by `landed`: both lanes set off in the well where it rests (with the other bound
    the lane behind went through two slips first, half of all steps at small eps; counted
    from before a rest, tips of a load that lets go every 0.06 wells were a well behind).
    Where no such place is left, lanes start from z0; from a fast slide where one is nearer.
    Where not `measured`, errors of fast slides are not waited for: both lanes start there.
    """
    eps = ground.eps[cell]
    lag = ground.lags.max(axis=1)[cell]
    wanted = path.motion_at(begin).ways - wells * eps
    # A start outside the strip rests where it has relaxed to, off the path by this much.
    astray = path.speed * ground.relaxed[cell]
    clear = (lag + astray + 2 * eps)[:, None] - _run_up(path)
    opens = path.travel[:-1] + np.maximum(clear, 0.0)
    settled = opens + SETTINGS.settling * eps[:, None]
    closes = path.travel[1:]
    usable = (path.direction != 0) & (opens <= closes) & (opens <= wanted[:, None])
    last = opens.shape[1] - 1 - np.argmax(usable[:, ::-1], axis=1)
    known = ~np.any(usable, axis=1)
    piece = np.where(known, 0, last)
    way = np.minimum(wanted, closes[piece])
    direction = path.direction[piece]
    level = path.states[piece] + direction * (way - path.travel[piece])
    slide = np.flatnonzero(~known)
    time = np.zeros(begin.size)
    time[slide] = path.times_at(piece[slide], level[slide])
    known |= time < ground.relaxed[cell]
    time[known] = 0.0
    slide = np.flatnonzero(~known)
    share = np.ones(begin.size)
    power = ground.power(cell[slide], direction[slide])
    share[slide] = slow_share(path, time[slide], power)
    share = lag_share(ground, cell, share)
    slides, which = last_begun(ground.fast_slides, cell, begin)
    lagging = _still_lagging(path, slides, which, time)
    share = np.where(lagging, 1.0, share)
    rests = ~lagging & (way >= settled[np.arange(way.size), piece])
    lane_wells, lane_tips = _bracket(ground, cell, direction, level, known, share, rests)
    plain = Starts(
        time=time,
        known_start=known,
        from_slide=np.zeros(begin.size, dtype=bool),
        lagging=lagging,
        until=np.full(begin.size, -np.inf),
        pace=np.full(begin.size, np.inf),
        behind_well=lane_wells[0],
        behind_tip=lane_tips[0],
        ahead_well=lane_wells[1],
        ahead_tip=lane_tips[1],
    )
    # Way in m that a lane goes until the bracket begins, its lag included.
    reach = wells * eps + 2 * share * lag
    after_slide = np.flatnonzero(which >= 0)
    if after_slide.size == 0:
        return plain
    near, inside = _on_slides(
        slides, which[after_slide], begin[after_slide], back[after_slide], measured
    )
    near = near._replace(pace=np.where(inside, near.pace * eps[after_slide], np.inf))
    late, early = np.split(path.motion_at(np.append(begin[after_slide], near.time)).ways, 2)
    nearer = known[after_slide] | inside | (late - early <= reach[after_slide])
    return _replaced(plain, after_slide[nearer], rows_of(near, nearer))


def _still_lagging(
    path: Path, slides: list[FastSlide], which: np.ndarray, time: np.ndarray
):
    """Whether tips still lag as at the end of a fast slide that ended at full speed, (W,).

    Lags are not those of the moment there. (Brackets of these left the tip out: 6e-2 eps,
    16 wells behind a fast slide.)
    """
    after_slide = np.flatnonzero(which >= 0)
    lagging = np.zeros(which.size, dtype=bool)
    if after_slide.size:
        fast = np.array([slide.lags for slide in slides])[which[after_slide]]
        turns = np.array([path.edges[slide.piece + 1] for slide in slides])[
            which[after_slide]
        ]
        lagging[after_slide] = fast & (time[after_slide] <= turns)
    return lagging


def _replaced(starts: Starts, which: np.ndarray, others: Starts) -> Starts:
    """The starts with others in the rows `which`."""
    found = Starts._make(column.copy() for column in starts)
    for column, other in zip(found, others, strict=True):
        column[which] = other
    return found


def _on_slides(slides: list[FastSlide], which: np.ndarray, begin, back, measured: bool):
    """Starts at lattice points of fast slides, their errors behind and ahead, with the
    pace in wells a second; and which hold `begin`."""
    curves = ManyTransitTimes([slide.curve for slide in slides])
    rows = [(r.sign, r.well, r.tip, r.curve.edges[0], r.end) for r in slides]
    sign, well, tip, first, end = np.array(rows)[which].T
    number = (
        np.floor(curves.number_at(which, np.minimum(begin, end)) + SETTINGS.whole) - back
    )
    number = np.maximum(number, first)
    period = curves.time_of(which, number + 1) - curves.time_of(which, number)
    error = np.zeros(which.size)
    if measured:
        errors = np.concatenate([slide.error for slide in slides])
        error = sign * errors[curves.panel_of(which, number)]
    none, well = np.zeros(which.size, dtype=bool), well + sign * number
    starts = Starts(
        time=np.minimum(curves.time_of(which, number), begin),
        known_start=none,
        from_slide=~none,
        lagging=none,
        until=end,
        pace=1 / np.maximum(period, 1e-300),
        behind_well=well,
        behind_tip=tip - error,
        ahead_well=well,
        ahead_tip=tip + error,
    )
    return starts, begin <= end


def slow_share(path: Path, time: np.ndarray, power: np.ndarray) -> np.ndarray:
    """Share of the lag and memory of the fastest slide that there is at these times.

    Both grow with a `power` of the speed: its square where folds have a curvature, less
    where they are flat. Slides may have been faster a moment before.
    """
    # A slide may end at full speed, in a kink.
    before = time - SETTINGS.aside * path.edges[-1]
    both = np.append(time, np.maximum(before, 0.0))
    speeds = np.abs(path.speeds_at(both))
    # Nothing slides at 0.
    share = np.maximum(*np.split(speeds, 2)) / (path.speed or 1.0)
    return np.minimum(SETTINGS.faster * share**power, 1.0)


def lag_share(ground: CellBounds, cell: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Share of the largest lag that brackets count with, where slides have that share."""
    return np.where(ground.longest_lag[cell] > SETTINGS.long_lag, share, 1.0)


def _bracket(ground: CellBounds, cell, direction, level, known, share, rests):
    """Wells and tips of the lanes behind and ahead of the edge at `level`, (2, W) each.

    `rests`: where the tip has been through all slips that should be over.
    """
    eps, folds = ground.eps[cell], ground.folds
    places = np.stack([folds.place_plus, folds.place_minus], axis=1)
    states = np.stack([folds.state_plus, folds.state_minus], axis=1)
    own = cell, side_column(direction)
    place, fold = places[own], states[own]
    shift, lag = ground.shifts[own] / eps, share * ground.lags[own] / eps
    landed = np.where(rests, ground.landed[own], np.inf)
    # Mirrored for slides to the left, so that the tip moves up in both.
    sign = np.where(direction > 0, 1.0, -1.0)
    at = sign * (level - fold) / eps
    ahead = np.ceil(at + shift + SETTINGS.gap)
    slow = np.isfinite(landed)
    behind = np.floor(at - shift - np.where(slow, landed, lag) - SETTINGS.gap) - ~slow
    behind_tip = place + np.where(slow, 0.5 * sign, 0.0)
    start, tip = ground.start_well[cell], ground.start_tip[cell]
    phase = ground.phase[cell]
    wells = np.where(known, start, sign * np.stack([behind, ahead]) - phase)
    return wells, np.where(known, tip, np.stack([behind_tip, place]))
