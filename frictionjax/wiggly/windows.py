"""Windows: short lanes from provably below and above the tip to where it is wanted."""

from typing import NamedTuple

import numpy as np

from ..scene import Scene
from .curve import Curves
from .job_queue import Jobs, Legs
from .path import Path, slopes_at, states_at, times_at
from .rides import Ride, last_begun
from .tolerance import Folds

_ASIDE = 1e-6  # of a leg: where one-sided slopes are taken
_GAP = 1e-6  # of a well: rounding of z/eps
# Steps are 10 to 200 a well; lags let lanes pass through more wells than the path.
_STEPS_A_WELL, _SOME_WELLS = 2000, 100
_FASTER = 1.5  # how much slides may have been faster, squared, where lanes set off
# Wells: lags that are longer are taken at the speed of the moment. (At the largest speed
# always: lanes of 300 wells in slow parts of slides at gamma = 0.4, where ten do.)
_LONG_LAG = 5.0
_BRIEF = 20.0  # wells of a lane whose errors hardly add up
_WHOLE = 1e-4  # wells: rounding of times, in numbers of wells


class Ground(NamedTuple):
    """What windows need to know of each cell, shape (cells,) each.

    `lag_plus`, `lag_minus`: how far in m a steady slide stays behind the strip's edge, at
    most. `shift_plus`, `shift_minus`: by how much in m folds at this eps differ from rho.
    `relaxed`: time in s from which on a start outside the strip is forgotten, by Lemma 7.
    `rides`: tuples of `Ride`, in time.
    """

    eps: np.ndarray
    folds: Folds
    lag_plus: np.ndarray
    lag_minus: np.ndarray
    shift_plus: np.ndarray
    shift_minus: np.ndarray
    start_well: np.ndarray
    start_tip: np.ndarray
    relaxed: np.ndarray
    rides: np.ndarray


class Windows(NamedTuple):
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

    def chosen(self, which: np.ndarray) -> "Windows":
        """The windows with these indices, renumbered."""
        place = np.full(self.cell.size, -1)
        place[which] = np.arange(which.size)
        mine = place[self.owner] >= 0
        owner, stop = place[self.owner[mine]], self.stop[mine]
        order = np.argsort(owner, kind="stable")
        rows = self.cell[which], self.begin[which], self.paired[which]
        return Windows(*rows, owner[order], stop[order])


class Starts(NamedTuple):
    """Where lanes of windows set off, shape (W,).

    `time` in s. `known`: from the known z0; `ridden`: from a ride, as closely as its error
    says, which ends at `until` (s); `lagging`: behind one, with the largest lag there is.
    `behind_*` and `ahead_*`: well and tip of the two lanes of the bracket.
    """

    time: np.ndarray
    known: np.ndarray
    ridden: np.ndarray
    lagging: np.ndarray
    until: np.ndarray
    behind_well: np.ndarray
    behind_tip: np.ndarray
    ahead_well: np.ndarray
    ahead_tip: np.ndarray


class Plan(NamedTuple):
    """Jobs and legs of windows, and where each window's stops are among the legs.

    `behind`, `ahead` (S,): leg of each stop in either lane, -1 where the second does not
    run. `meet_behind`, `meet_ahead` (W,): legs that end where the windows begin. `known`,
    `ridden` (W,): as in `Starts`. `brief` (J,): jobs on a ride that go through a few wells.
    """

    jobs: Jobs
    legs: Legs
    behind: np.ndarray
    ahead: np.ndarray
    meet_behind: np.ndarray
    meet_ahead: np.ndarray
    known: np.ndarray
    ridden: np.ndarray
    brief: np.ndarray


def way_at(scene: Scene, path: Path, times: np.ndarray) -> np.ndarray:
    """Way in m that the path has come at each time."""
    piece = path.piece_of(times)
    states = states_at(scene, path, times)
    return path.travel[piece] + np.abs(states - path.states[piece])


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
    scene: Scene,
    path: Path,
    ground: Ground,
    cell: np.ndarray,
    begin: np.ndarray,
    wells,
    back,
) -> Starts:
    """Starts at least `wells` of the path's way before each window, or `back` of a ride's.

    On a slide the tip cannot be past the first fold beyond the strip's edge: it would have
    had to climb it against a force. Nor can it be further behind than a steady slide at
    the largest speed of the scene; where that is many wells, of the moment. Both hold once
    the path has come further than the lag of the slide before in the other direction.
    Where no such place is left, lanes start from z0; from a ride where one is nearer.
    """
    eps = ground.eps[cell]
    lag = np.maximum(ground.lag_plus, ground.lag_minus)[cell]
    wanted = way_at(scene, path, begin) - wells * eps
    # A start outside the strip rests where it has relaxed to, off the path by this much.
    astray = path.speed * ground.relaxed[cell]
    clear = (lag + astray + 2 * eps)[:, None] - _run_up(path)
    opens = path.travel[:-1] + np.maximum(clear, 0.0)
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
    time[slide] = times_at(scene, path, piece[slide], level[slide])
    known |= time < ground.relaxed[cell]
    time[known] = 0.0
    slide = np.flatnonzero(~known)
    share = np.ones(begin.size)
    share[slide] = slow_share(scene, path, time[slide], level[slide])
    share = np.where(lag > _LONG_LAG * eps, share, 1.0)
    before = rides, which = last_begun(ground.rides, cell, begin)
    lagging = _still_lagging(path, rides, which, time)
    share = np.where(lagging, 1.0, share)
    lanes = _brackets(ground, cell, direction, level, known, share)
    none = np.zeros(begin.size, dtype=bool)
    plain = Starts(time, known, none, lagging, np.full(begin.size, -np.inf), *lanes)
    reach = wells * eps + 2 * share * lag
    return _ridden(scene, path, before, begin, plain, back, reach)


def _still_lagging(path: Path, rides: list[Ride], which: np.ndarray, time: np.ndarray):
    """Whether a slide that its ride left at full speed may still lag as that did, (W,).

    Lags are not those of the moment there. (Brackets of these left the tip out: 6e-2 eps,
    16 wells behind a ride.)
    """
    some = np.flatnonzero(which >= 0)
    lagging = np.zeros(which.size, dtype=bool)
    if some.size:
        fast = np.array([ride.lags for ride in rides])[which[some]]
        turns = np.array([path.edges[ride.piece + 1] for ride in rides])[which[some]]
        lagging[some] = fast & (time[some] <= turns)
    return lagging


def _ridden(scene: Scene, path: Path, before: tuple, begin, plain: Starts, back, way):
    """The same starts, from the last ride where it holds the window or ends nearer to it.

    `before`: as `last_begun` says. `way` (W,): m that a lane of the bracket goes until the
    window begins, its lag included.
    """
    rides, which = before
    some = np.flatnonzero(which >= 0)
    if some.size == 0:
        return plain
    ridden, inside = _on_rides(rides, which[some], begin[some], back[some])
    late, early = np.split(way_at(scene, path, np.append(begin[some], ridden.time)), 2)
    nearer = plain.known[some] | inside | (late - early <= way[some])
    starts = Starts(*(column.copy() for column in plain))
    for column, row in zip(starts, ridden, strict=True):
        column[some[nearer]] = row[nearer]
    return starts


def _on_rides(rides: list[Ride], which: np.ndarray, begin, back):
    """Starts at lattice points of rides, their errors behind and ahead; and what holds
    `begin`."""
    curves = Curves([ride.curve for ride in rides])
    rows = [(r.sign, r.well, r.tip, r.curve.edges[0], r.end) for r in rides]
    sign, well, tip, first, end = np.array(rows)[which].T
    number = np.floor(curves.number_at(which, np.minimum(begin, end)) + _WHOLE) - back
    number = np.maximum(number, first)
    errors = np.concatenate([ride.error for ride in rides])
    error = sign * errors[curves.panel_of(which, number)]
    time = np.minimum(curves.time_of(which, number), begin)
    none, well = np.zeros(which.size, dtype=bool), well + sign * number
    lanes = well, tip - error, well, tip + error
    starts = Starts(time, none, ~none, none, end, *lanes)
    return starts, begin <= end


def slow_share(scene: Scene, path: Path, time: np.ndarray, state: np.ndarray) -> np.ndarray:
    """Share of the lag and memory of the fastest slide that there is at these times.

    Both grow with the square of the speed; slides may have been faster a moment before.
    """
    before = time - _ASIDE * path.edges[-1]  # a slide may end at full speed, in a kink
    both = [slopes_at(scene, path, t, state) for t in (time, np.maximum(before, 0.0))]
    share = np.max(np.abs(both), axis=0) / (path.speed or 1.0)  # nothing slides at 0
    return np.minimum(_FASTER * share**2, 1.0)


def _brackets(ground: Ground, cell, direction, level, known, share):
    """Well and tip of the lanes behind and ahead of the edge at `level`."""
    up, eps, folds = direction > 0, ground.eps[cell], ground.folds

    def side(plus, minus) -> np.ndarray:
        return np.where(up, np.asarray(plus)[cell], np.asarray(minus)[cell])

    place = side(folds.place_plus, folds.place_minus)
    fold = side(folds.state_plus, folds.state_minus)
    shift = side(ground.shift_plus, ground.shift_minus)
    lag = share * side(ground.lag_plus, ground.lag_minus)
    # Mirrored for slides to the left, so that the tip moves up in both.
    sign = np.where(up, 1.0, -1.0)
    at = sign * (level - fold) / eps
    ahead = np.ceil(at + shift / eps + _GAP)
    behind = np.floor(at - (shift + lag) / eps - _GAP) - 1
    start_well, start_tip = ground.start_well[cell], ground.start_tip[cell]
    tip = np.where(known, start_tip, place)
    return (
        np.where(known, start_well, sign * behind),
        tip,
        np.where(known, start_well, sign * ahead),
        tip,
    )


def points_between(points: np.ndarray, low: np.ndarray, high: np.ndarray):
    """Sorted `points` strictly inside each interval: indices of intervals, and values."""
    first = np.searchsorted(points, low, side="right")
    count = np.maximum(np.searchsorted(points, high, side="left") - first, 0)
    owner = np.repeat(np.arange(low.size), count)
    offset = np.arange(owner.size) - np.repeat(np.cumsum(count) - count, count)
    return owner, points[first[owner] + offset]


def _lane_legs(windows: Windows, starts: Starts, kinks: np.ndarray, whole: np.ndarray):
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


def plan_windows(
    scene: Scene, path: Path, ground: Ground, windows: Windows, starts: Starts
) -> Plan:
    """Jobs and legs: one lane of the bracket each; one alone from a known start."""
    kinks = path.edges[1:-1]
    count = windows.cell.size
    every = np.ones(count, dtype=bool)
    lanes = [_lane_legs(windows, starts, kinks, every)]
    second = np.flatnonzero(~starts.known)
    some = windows.chosen(second)
    part = Starts(*(a[second] for a in starts))
    lanes.append(_lane_legs(some, part, kinks, some.paired))
    owner, start, end, mark = (np.concatenate(c) for c in zip(*lanes, strict=True))
    split = lanes[0][0].size
    job = np.concatenate([lanes[0][0], count + lanes[1][0]])
    first = np.searchsorted(job, np.arange(count + second.size))
    past = np.searchsorted(job, np.arange(count + second.size), side="right")
    jobs = Jobs(
        cell=np.concatenate([windows.cell, some.cell]),
        origin=np.concatenate([starts.time, part.time]),
        well=np.concatenate([starts.behind_well, part.ahead_well]),
        tip=np.concatenate([starts.behind_tip, part.ahead_tip]),
        first_leg=first,
        past_leg=past,
    )
    legs = _legs(scene, path, start, end)
    cell = np.concatenate([windows.cell[lanes[0][0]], some.cell[lanes[1][0]]])
    wells = np.abs(legs.guide1 - legs.guide0) / ground.eps[cell]
    # A lane from far outside the strip passes through wells that the path does not.
    far = np.abs(float(scene.z0) - path.states[0]) / ground.eps[cell]
    far = np.where(
        np.concatenate([starts.known[lanes[0][0]], part.known[lanes[1][0]]]), far, 0
    )
    legs = legs._replace(budget=_STEPS_A_WELL * (wells + far + _SOME_WELLS))
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
    marks = behind, ahead, meet_behind, meet_ahead
    last = np.full(count, -np.inf)
    np.maximum.at(last, windows.owner, windows.stop)
    inside = last <= starts.until
    brief = np.concatenate([inside, inside[second]])
    brief &= np.bincount(job, wells, brief.size) <= _BRIEF
    return Plan(jobs, legs, *marks, starts.known, starts.ridden, brief)


def _legs(scene: Scene, path: Path, start: np.ndarray, end: np.ndarray) -> Legs:
    """Legs with the path as their guide; slopes from inside each leg."""
    length = np.maximum(end - start, 0.0)
    guides = states_at(scene, path, np.concatenate([start, end]))
    aside = _ASIDE * length
    inside = np.concatenate([start + aside, end - aside])
    slopes = slopes_at(scene, path, inside, guides)
    (guide0, guide1), (slope0, slope1) = np.split(guides, 2), np.split(slopes, 2)
    middle = path.piece_of(0.5 * (start + end))
    friction = np.where(path.direction[middle] != 0, path.rho[middle], 0.0)
    none = np.zeros(start.size)
    return Legs(start, end, guide0, guide1, slope0, slope1, friction, budget=none)
