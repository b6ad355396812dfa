"""Windows: short lanes from provably below and above the tip to where it is wanted."""

from typing import NamedTuple

import numpy as np

from ...model import Scene
from ...numerics import rows_of
from ..lanes import Lanes, Segments
from ..limit_path import Path, slopes_at, states_at
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
        """The windows with these indices, renumbered."""
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
    """Jobs and legs of windows, and where each window's stops are among the legs.

    `behind`, `ahead` (S,): leg of each stop in either lane, -1 where the second does not
    run. `meet_behind`, `meet_ahead` (W,): legs that end where the windows begin. `known`,
    `from_slide` (W,): as in `Starts`. `brief` (J,): jobs on a fast slide that go
    through a few wells; `calm` (J,): in a part of a slide where few wells are remembered.
    """

    jobs: Lanes
    legs: Segments
    behind: np.ndarray
    ahead: np.ndarray
    meet_behind: np.ndarray
    meet_ahead: np.ndarray
    known: np.ndarray
    from_slide: np.ndarray
    brief: np.ndarray
    calm: np.ndarray


def points_between(points: np.ndarray, low: np.ndarray, high: np.ndarray):
    """Sorted `points` strictly inside each interval: indices of intervals, and values."""
    first = np.searchsorted(points, low, side="right")
    count = np.maximum(np.searchsorted(points, high, side="left") - first, 0)
    owner = np.repeat(np.arange(low.size), count)
    offset = np.arange(owner.size) - np.repeat(np.cumsum(count) - count, count)
    return owner, points[first[owner] + offset]


def _lane_legs(windows: Brackets, starts: Starts, kinks: np.ndarray, whole: np.ndarray):
    """Legs of one lane for each window: owner, start, end, stop's index or -1 or -2.

    Legs end at kinks of the load on the way, where the window begins (-1), and at its
    stops, where `whole`; legs that end at kinks have -2.
    """
    count = windows.cell.size
    kink_owner, kink = points_between(kinks, starts.time, windows.begin)
    mine = np.flatnonzero(whole[windows.owner])
    owner = np.concatenate([kink_owner, np.arange(count), windows.owner[mine]])
    end = np.concatenate([kink, windows.begin, windows.stop[mine]])
    mark = np.concatenate([np.full(kink.size, -2), np.full(count, -1), mine])
    order = np.lexsort((mark, end, owner))
    owner, end, mark = owner[order], end[order], mark[order]
    first = np.concatenate([[True], owner[1:] != owner[:-1]])
    start = np.where(first, starts.time[owner], np.concatenate([[0.0], end[:-1]]))
    return owner, start, end, mark


def plan_brackets(
    scene: Scene, path: Path, ground: CellBounds, windows: Brackets, starts: Starts
) -> BracketPlan:
    """Jobs and legs: one lane of the bracket each; one alone from a known start."""
    kinks = path.edges[1:-1]
    count = windows.cell.size
    every = np.ones(count, dtype=bool)
    lanes = [_lane_legs(windows, starts, kinks, every)]
    second = np.flatnonzero(~starts.known)
    some = windows.chosen(second)
    part = rows_of(starts, second)
    lanes.append(_lane_legs(some, part, kinks, some.paired))
    owner, start, end, mark = (np.concatenate(c) for c in zip(*lanes, strict=True))
    split = lanes[0][0].size
    job = np.concatenate([lanes[0][0], count + lanes[1][0]])
    first = np.searchsorted(job, np.arange(count + second.size))
    past = np.searchsorted(job, np.arange(count + second.size), side="right")
    jobs = Lanes(
        cell=np.concatenate([windows.cell, some.cell]),
        origin=np.concatenate([starts.time, part.time]),
        well=np.concatenate([starts.behind_well, part.ahead_well]),
        tip=np.concatenate([starts.behind_tip, part.ahead_tip]),
        first_leg=first,
        past_leg=past,
    )
    legs = legs_of(scene, path, start, end)
    cell = np.concatenate([windows.cell[lanes[0][0]], some.cell[lanes[1][0]]])
    wells = np.abs(legs.guide1 - legs.guide0) / ground.eps[cell]
    # A lane from far outside the strip passes through wells that the path does not.
    far = np.abs(float(scene.z0) - path.states[0]) / ground.eps[cell]
    far = np.where(
        np.concatenate([starts.known[lanes[0][0]], part.known[lanes[1][0]]]), far, 0
    )
    # Nor does the path pass through those that a lane has to catch up with after a jump.
    late = np.maximum(ground.lag_plus, ground.lag_minus) / ground.eps
    late = np.minimum(late, np.minimum(path.travel[-1] / ground.eps, SETTINGS.affordable))[
        cell
    ]
    budget = (
        SETTINGS.lane_steps * (wells + far + SETTINGS.some_wells)
        + SETTINGS.steps_behind * late
    )
    legs = legs._replace(budget=budget)
    behind, ahead = np.full(windows.stop.size, -1), np.full(windows.stop.size, -1)
    meet_behind, meet_ahead = np.full(count, -1), np.full(count, -1)
    index = np.arange(mark.size)
    one, two = index < split, index >= split
    behind[mark[one & (mark >= 0)]] = index[one & (mark >= 0)]
    meet_behind[owner[one & (mark == -1)]] = index[one & (mark == -1)]
    chosen = np.flatnonzero(np.isin(windows.owner, second))
    chosen = chosen[np.argsort(windows.owner[chosen], kind="stable")]
    ahead[chosen[mark[two & (mark >= 0)]]] = index[two & (mark >= 0)]
    meet_ahead[second[owner[two & (mark == -1)]]] = index[two & (mark == -1)]
    last = np.full(count, -np.inf)
    np.maximum.at(last, windows.owner, windows.stop)
    inside = last <= starts.until
    brief = np.concatenate([inside, inside[second]])
    brief &= np.bincount(job, wells, brief.size) <= SETTINGS.brief
    return BracketPlan(
        jobs=jobs,
        legs=legs,
        behind=behind,
        ahead=ahead,
        meet_behind=meet_behind,
        meet_ahead=meet_ahead,
        known=starts.known,
        from_slide=starts.from_slide,
        brief=brief,
        calm=_calm(path, ground, jobs, legs),
    )


def _calm(path: Path, ground: CellBounds, jobs: Lanes, legs: Segments) -> np.ndarray:
    """Jobs inside a piece, on a slide that grows slower, which is slow at their start.

    Of cells with fast slides: tolerances of others are for what they remember there anyway.
    """
    has = np.array([len(own) > 0 for own in ground.fast_slides], dtype=bool)
    first, last = jobs.first_leg, jobs.past_leg - 1
    piece = path.piece_of(jobs.origin)
    inside = (path.direction[piece] != 0) & (jobs.origin > path.touch[piece])
    inside &= legs.end[last] <= path.edges[piece + 1]
    speed = np.maximum(np.abs(legs.slope0), np.abs(legs.slope1))
    start = np.abs(legs.slope0[first])
    slower = np.maximum.reduceat(speed, first) <= start
    lag = np.maximum(ground.lag_plus, ground.lag_minus)[jobs.cell] / ground.eps[jobs.cell]
    memory = 2 * SETTINGS.faster * lag * (start / (path.speed or 1.0)) ** 2
    return has[jobs.cell] & inside & slower & (memory <= 0.5 * SETTINGS.brief)


def legs_of(scene: Scene, path: Path, start: np.ndarray, end: np.ndarray) -> Segments:
    """Legs with the path as their guide; slopes from inside each leg."""
    length = np.maximum(end - start, 0.0)
    guides = states_at(scene, path, np.concatenate([start, end]))
    aside = SETTINGS.aside * length
    inside = np.concatenate([start + aside, end - aside])
    slopes = slopes_at(scene, path, inside, guides)
    (guide0, guide1), (slope0, slope1) = np.split(guides, 2), np.split(slopes, 2)
    middle = path.piece_of(0.5 * (start + end))
    friction = np.where(path.direction[middle] != 0, path.rho[middle], 0.0)
    none = np.zeros(start.size)
    return Segments(start, end, guide0, guide1, slope0, slope1, friction, budget=none)
