"""Brackets: short lanes from provably below and above the tip to where it is wanted."""

from typing import NamedTuple

import numpy as np

from ...numerics import rows_of
from ..lanes import Lanes, Segments
from ..limit_path import Path
from .settings import SETTINGS
from .starts import CellBounds, Starts


class Brackets(NamedTuple):
    """Stretches of time to be measured, W of them, each with its stops.

    `cell`, `begin` (s), shape (W,); `owner` and `stop` (s), shape (S,), sorted by owner and
    time. `paired`: whether both lanes of the bracket run to the last stop, or the second
    one to `begin` only, where the bracket is checked.
    """

    cell: np.ndarray
    begin: np.ndarray
    paired: np.ndarray
    owner: np.ndarray
    stop: np.ndarray

    def chosen(self, which: np.ndarray) -> "Brackets":
        """The brackets with these indices, renumbered."""
        place = np.full(self.cell.size, -1)
        place[which] = np.arange(which.size)
        mine = place[self.owner] >= 0
        owner, stop = place[self.owner[mine]], self.stop[mine]
        order = np.argsort(owner, kind="stable")
        return Brackets(
            cell=self.cell[which],
            begin=self.begin[which],
            paired=self.paired[which],
            owner=owner[order],
            stop=stop[order],
        )


class BracketPlan(NamedTuple):
    """Jobs and segments of brackets, and where each bracket's stops are among the segments.

    `behind`, `ahead` (S,): segment of each stop in either lane, -1 where the second does
    not run. `meet_behind`, `meet_ahead` (W,): segments that end where the brackets begin.
    `known_start`, `from_slide`, `pace` (W,): as in `Starts`. `brief` (J,): jobs on a fast
    slide that go through a few wells; `forgetful` (J,): in a part of a slide where few
    wells are remembered.
    """

    jobs: Lanes
    segments: Segments
    behind: np.ndarray
    ahead: np.ndarray
    meet_behind: np.ndarray
    meet_ahead: np.ndarray
    known_start: np.ndarray
    from_slide: np.ndarray
    pace: np.ndarray
    brief: np.ndarray
    forgetful: np.ndarray

    @property
    def owner(self) -> np.ndarray:
        """Which job each segment is of, (S,)."""
        return np.repeat(np.arange(self.jobs.cell.size), self.jobs.legs)


def points_between(points: np.ndarray, low: np.ndarray, high: np.ndarray):
    """Sorted `points` strictly inside each interval: indices of intervals, and values."""
    first = np.searchsorted(points, low, side="right")
    count = np.maximum(np.searchsorted(points, high, side="left") - first, 0)
    owner = np.repeat(np.arange(low.size), count)
    offset = np.arange(owner.size) - np.repeat(np.cumsum(count) - count, count)
    return owner, points[first[owner] + offset]


def _lane_segments(
    brackets: Brackets, starts: Starts, kinks: np.ndarray, whole: np.ndarray
):
    """Segments of one lane for each bracket: owner, start, end, stop's index or -1 or -2.

    Segments end at kinks of the load on the way, as they know its straight part as one
    line; where the bracket begins (-1), and at its stops, where `whole`; segments that end
    at other kinks have -2.
    """
    count = brackets.cell.size
    mine = np.flatnonzero(whole[brackets.owner])
    owner = np.concatenate([np.arange(count), brackets.owner[mine]])
    end = np.concatenate([brackets.begin, brackets.stop[mine]])
    last = np.full(count, -np.inf)
    np.maximum.at(last, owner, end)
    kink_owner, kink = points_between(kinks, starts.time, last)
    inside = ~np.isin(kink_owner + 1j * kink, owner + 1j * end)
    kink_owner, kink = kink_owner[inside], kink[inside]
    owner, end = np.concatenate([kink_owner, owner]), np.concatenate([kink, end])
    mark = np.concatenate([np.full(kink.size, -2), np.full(count, -1), mine])
    order = np.lexsort((mark, end, owner))
    owner, end, mark = owner[order], end[order], mark[order]
    first = np.concatenate([[True], owner[1:] != owner[:-1]])
    start = np.where(first, starts.time[owner], np.concatenate([[0.0], end[:-1]]))
    return owner, start, end, mark


def plan_brackets(
    path: Path,
    ground: CellBounds,
    brackets: Brackets,
    starts: Starts,
) -> BracketPlan:
    """Jobs and segments: one lane of the bracket each; one alone from a known start."""
    kinks = path.edges[1:-1]
    count = brackets.cell.size
    every = np.ones(count, dtype=bool)
    lanes = [_lane_segments(brackets, starts, kinks, every)]
    second = np.flatnonzero(~starts.known_start)
    second_brackets = brackets.chosen(second)
    second_starts = rows_of(starts, second)
    lanes.append(
        _lane_segments(second_brackets, second_starts, kinks, second_brackets.paired)
    )
    owner, start, end, mark = (np.concatenate(c) for c in zip(*lanes, strict=True))
    split = lanes[0][0].size
    job = np.concatenate([lanes[0][0], count + lanes[1][0]])
    first = np.searchsorted(job, np.arange(count + second.size))
    past = np.searchsorted(job, np.arange(count + second.size), side="right")
    jobs = Lanes(
        cell=np.concatenate([brackets.cell, second_brackets.cell]),
        origin=np.concatenate([starts.time, second_starts.time]),
        well=np.concatenate([starts.behind_well, second_starts.ahead_well]),
        tip=np.concatenate([starts.behind_tip, second_starts.ahead_tip]),
        first_leg=first,
        past_leg=past,
    )
    segments = segments_of(path, start, end)
    cell = np.concatenate([brackets.cell[lanes[0][0]], second_brackets.cell[lanes[1][0]]])
    wells = np.abs(segments.guide1 - segments.guide0) / ground.eps[cell]
    # A lane from far outside the strip passes through wells that the path does not.
    known = np.concatenate([starts.known_start[lanes[0][0]], np.zeros(lanes[1][0].size)])
    far = known * path.outside / ground.eps[cell]
    # Nor does the path pass through those that a lane has to catch up with after a jump.
    late = np.minimum(path.travel[-1] / ground.eps, ground.affordable)
    late = np.minimum(ground.longest_lag, late)[cell]
    budget = (
        SETTINGS.lane_steps * (wells + far + SETTINGS.some_wells)
        + SETTINGS.steps_behind * late
    )
    segments = segments._replace(budget=budget)
    behind, ahead = np.full(brackets.stop.size, -1), np.full(brackets.stop.size, -1)
    meet_behind, meet_ahead = np.full(count, -1), np.full(count, -1)
    index = np.arange(mark.size)
    one, two = index < split, index >= split
    behind[mark[one & (mark >= 0)]] = index[one & (mark >= 0)]
    meet_behind[owner[one & (mark == -1)]] = index[one & (mark == -1)]
    chosen = np.flatnonzero(np.isin(brackets.owner, second))
    chosen = chosen[np.argsort(brackets.owner[chosen], kind="stable")]
    ahead[chosen[mark[two & (mark >= 0)]]] = index[two & (mark >= 0)]
    meet_ahead[second[owner[two & (mark == -1)]]] = index[two & (mark == -1)]
    last = np.full(count, -np.inf)
    np.maximum.at(last, brackets.owner, brackets.stop)
    inside = last <= starts.until
    brief = np.concatenate([inside, inside[second]])
    brief &= np.bincount(job, wells, brief.size) <= SETTINGS.brief
    return BracketPlan(
        jobs=jobs,
        segments=segments,
        behind=behind,
        ahead=ahead,
        meet_behind=meet_behind,
        meet_ahead=meet_ahead,
        known_start=starts.known_start,
        from_slide=starts.from_slide,
        pace=starts.pace,
        brief=brief,
        forgetful=_forgetful(path, ground, jobs, segments),
    )


def _forgetful(
    path: Path, ground: CellBounds, jobs: Lanes, segments: Segments
) -> np.ndarray:
    """Jobs inside a piece, on a slide that grows slower, which is slow at their start.

    Of cells with fast slides: tolerances of others are for what they remember there anyway.
    """
    has = np.array([len(slides) > 0 for slides in ground.fast_slides], dtype=bool)
    first, last = jobs.first_leg, jobs.past_leg - 1
    piece = path.piece_of(jobs.origin)
    inside = (path.direction[piece] != 0) & (jobs.origin > path.touch[piece])
    inside &= segments.end[last] <= path.edges[piece + 1]
    speed = np.maximum(np.abs(segments.slope0), np.abs(segments.slope1))
    start = np.abs(segments.slope0[first])
    slower = np.maximum.reduceat(speed, first) <= start
    direction = path.direction[piece]
    share = (start / (path.speed or 1.0)) ** ground.power(jobs.cell, direction)
    memory = SETTINGS.faster * share * ground.memory(jobs.cell, direction)
    return has[jobs.cell] & inside & slower & (memory <= 0.5 * SETTINGS.brief)


def segments_of(path: Path, start: np.ndarray, end: np.ndarray) -> Segments:
    """Segments with the path as their guide; slopes from inside each segment."""
    length = np.maximum(end - start, 0.0)
    aside = SETTINGS.aside * length
    inside = np.concatenate([start + aside, end - aside])
    motion = path.motion_at(np.concatenate([start, end]), beside=inside)
    guide0, guide1 = np.split(motion.states, 2)
    slope0, slope1 = np.split(motion.speeds, 2)
    middle = path.piece_of(0.5 * (start + end))
    friction = np.where(path.direction[middle] != 0, path.rho[middle], 0.0)
    none = np.zeros(start.size)
    line = np.split(motion.levels, 2)[0], np.split(motion.rates, 2)[0]
    return Segments(start, end, guide0, guide1, slope0, slope1, friction, none, *line)
