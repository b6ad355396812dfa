"""Fast slides of every cell, one after the other, from z0 to the end.

Where tips never rest on a slide, starts are forgotten only after hundreds to millions of
wells, and brackets from far behind cost as many. There the times of passage follow from
the slip map instead. Lanes carry the tip through what is between: turns of the load, rests
and the first wells of a slide.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..scene import Scene
from .curve import Curve
from .passage import Stretch, one_passage, pull_at, track_of, wiggles_at
from .path import Path, arrivals_at, slopes_at, states_at
from .set_off import first_wells
from .slip_map import Slides, follow

# Wells behind the tip where the slip map takes over: passages change slowly enough for
# panels of 16 wells (8 wells: tails 100 times larger).
_FIRST = 16.0
_NARROW = 0.2  # of the force beyond the fold at the start: the smallest one on the way
_OVERSHOT = 12.0  # wells after a turn, at the pace before it
_STILL = 4.0  # of them that must have been passed for the slide to go on
_CLOSED = 0.1  # wells of time: gaps of brackets at the start of a ride, at most
_LONG = 100.0  # wells of lag that are worth a slip map after the turn
_REST = (
    0.6  # share at the end of a ride below which the tip comes to rest where the path is
)
_FAST = 0.9  # share that a well leaves of a shift, where lags are many wells


class Ride(NamedTuple):
    """A fast slide of one cell.

    `curve`: when the tip passes its lattice points. At the number n the tip is at `tip` in
    the well `well + sign n`. `piece`: of the load. `error` (K,): of the tip at lattice
    points of each panel, in periods, measured by lanes.
    """

    curve: Curve
    sign: float
    well: float
    tip: float
    piece: int
    error: np.ndarray

    @property
    def begin(self) -> float:
        """Time in s from which passages are known."""
        return float(self.curve.starts[0])

    @property
    def end(self) -> float:
        """Time in s up to which passages are known."""
        return float(self.curve.starts[-1])


def last_begun(rides: np.ndarray, cell: np.ndarray, time: np.ndarray):
    """Rides of the cells, and which of them each cell began last before a time; else -1."""
    every: list[Ride] = []
    which = np.full(cell.size, -1)
    for c in np.unique(cell):
        mine = cell == c
        for ride in rides[c]:
            which[mine & (time >= ride.begin)] = len(every)
            every.append(ride)
    return every, which


class Seen(NamedTuple):
    """Tips that lanes found at wanted times, shape (n,).

    `gap`: how closely brackets have closed, in wells of time: near a fold a small way
    takes long.
    """

    well: np.ndarray
    tip: np.ndarray
    gap: np.ndarray


# Cells, begins and stops in s -> tips at the stops, by lanes that set off from the last
# ride or from brackets.
Look = Callable[[np.ndarray, np.ndarray, np.ndarray], Seen]


class Candidates(NamedTuple):
    """Slides that may be fast, shape (n,): at `time` (s) the tip is at `tip` in `well`.

    `late`: end of the piece in s. `least`: force in N beyond the fold, at least. `gap`: as
    in `Seen`.
    """

    cell: np.ndarray
    sign: np.ndarray
    time: np.ndarray
    well: np.ndarray
    tip: np.ndarray
    late: np.ndarray
    piece: np.ndarray
    least: np.ndarray
    gap: np.ndarray

    def chosen(self, which: np.ndarray) -> "Candidates":
        """Some of them."""
        return Candidates(*(column[which] for column in self))


class Rider(NamedTuple):
    """What rides of a sweep are made from.

    `eps`, `viscosity` (cells,). `folds`: tip coordinates and forces of the extreme folds of
    each cell by direction, as `{1.0: (place, force), -1.0: ...}`.
    """

    scene: Scene
    path: Path
    eps: np.ndarray
    viscosity: np.ndarray
    folds: dict[float, tuple[np.ndarray, np.ndarray]]
    accuracy: float

    def _fold(self, some: Candidates) -> tuple[np.ndarray, np.ndarray]:
        up = some.sign > 0
        pairs = zip(self.folds[1.0], self.folds[-1.0], strict=True)
        place, force = (np.where(up, a[some.cell], b[some.cell]) for a, b in pairs)
        return place, force

    def _stretch(self, some: Candidates, start, length, excess) -> Stretch:
        _, force = self._fold(some)
        return Stretch(self.eps[some.cell], start, length, some.sign, force, excess)

    def states(self, cell: np.ndarray, well: np.ndarray, tip: np.ndarray) -> np.ndarray:
        """z in m of tips."""
        offset = wiggles_at(self.scene.potential, self.eps[cell], tip)[2]
        return self.eps[cell] * (well + tip) + offset

    def _beyond(self, some: Candidates) -> np.ndarray:
        """Force in N beyond the fold where the candidates are."""
        states = self.states(some.cell, some.well, some.tip)
        pull = pull_at(self.scene, some.time, states)
        _, force = self._fold(some)
        return some.sign * (pull.load[:, 0] - pull.support[:, 0] - force)

    def _to_fold(self, some: Candidates, excess: np.ndarray):
        """Time of the next passage of a fold, and the well of that fold."""
        place, _ = self._fold(some)
        way = np.mod(some.sign * (place - some.tip), 1.0)
        track = track_of(self.scene.potential, self._stretch(some, some.tip, way, excess))
        states = self.states(some.cell, some.well, some.tip)
        pull = pull_at(self.scene, some.time, states)
        length = one_passage(track, pull, self.viscosity[some.cell])
        well = np.round(some.well + some.tip + some.sign * way - place)
        return some.time + length, well

    def rides(self, some: Candidates) -> list[Ride | None]:
        """Follow the candidates; None where a slide is slow or short."""
        beyond = self._beyond(some)
        least = np.where(some.least > 0, some.least, _NARROW * beyond)
        eps = self.eps[some.cell]
        able = np.flatnonzero((beyond > 0) & (least > 0))
        found: list[Ride | None] = [None] * some.cell.size
        if able.size == 0:
            return found
        some, least, eps = some.chosen(able), least[able], eps[able]
        place, _ = self._fold(some)
        time, well = self._to_fold(some, least)
        fits = np.isfinite(time) & (time < some.late)
        if not fits.any():
            return found
        able, some, least, eps = able[fits], some.chosen(fits), least[fits], eps[fits]
        place, time, well = place[fits], time[fits], well[fits]
        one = np.ones(able.size)
        track = track_of(self.scene.potential, self._stretch(some, place, one, least))
        origin = self.states(some.cell, well, place)
        slides = Slides(
            track, eps, self.viscosity[some.cell], origin, 0 * one, time, some.late
        )
        for i, curve in enumerate(follow(self.scene, slides, self.accuracy)):
            if curve is not None:
                sign, piece = float(some.sign[i]), int(some.piece[i])
                where = float(well[i]), float(place[i]), piece
                found[able[i]] = Ride(curve, sign, *where, curve.tail)
        return found


def _set_off(rider: Rider, cells: np.ndarray, piece: int) -> np.ndarray:
    """Seconds from a touch of the strip's edge until the first wells are passed."""
    path, scene = rider.path, rider.scene
    touch = np.array([path.touch[piece]])
    inside = touch + 1e-6 * (path.edges[piece + 1] - touch)
    state = states_at(scene, path, inside)
    speed = float(np.abs(slopes_at(scene, path, inside, state))[0])
    stiffness = float(pull_at(scene, inside, state).support[0, 1])
    times = np.full(cells.size, np.inf)
    if speed > 0:
        sign = float(path.direction[piece])
        folds = rider.folds[sign][0][cells]
        way = folds, sign, rider.viscosity[cells], speed * stiffness, stiffness
        times = first_wells(scene.potential, rider.eps[cells], *way, _FIRST)
    return times


def _touches(rider: Rider, look: Look, cells: np.ndarray, piece: int) -> np.ndarray:
    """When the pull reaches the fold where each tip rests before the slide of a piece, s.

    The path's own touch comes earlier where the slide before has lagged: the tip then
    rests short of where the path does.
    """
    touch = np.full(cells.size, rider.path.touch[piece])
    seen = look(cells, touch, touch)
    # Lanes that failed stay candidates no longer than their gap is looked at.
    states = rider.states(cells, np.nan_to_num(seen.well), np.nan_to_num(seen.tip))
    force = rider.folds[float(rider.path.direction[piece])][1][cells]
    late = np.full(cells.size, rider.path.edges[piece + 1])
    return arrivals_at(rider.scene, states, force, touch, late)


def _starting(
    rider: Rider, look: Look, cells: np.ndarray, piece: int, last: list[Ride | None]
) -> Candidates | None:
    """Candidates at the start of the slide of a piece."""
    late = rider.path.edges[piece + 1]
    wait = _set_off(rider, cells, piece)
    able = rider.path.touch[piece] + wait < late
    cells, wait = cells[able], wait[able]
    if cells.size == 0:
        return None
    touch = np.full(cells.size, rider.path.touch[piece])
    before = [last[c] for c in cells]
    lags = np.array([r is not None and r.curve.kept[-1] > _REST for r in before])
    if lags.any():
        touch[lags] = _touches(rider, look, cells[lags], piece)
    stops = touch + wait
    able = stops < late
    cells, stops, touch = cells[able], stops[able], touch[able]
    if cells.size == 0:
        return None
    seen = look(cells, touch, stops)
    none = np.zeros(cells.size)
    sign = none + rider.path.direction[piece]
    ends, pieces = none + late, np.full(cells.size, piece)
    where = cells, sign, stops, seen.well, seen.tip, ends, pieces
    return Candidates(*where, none, seen.gap).chosen(seen.gap < _CLOSED)


def _overshooting(
    rider: Rider, look: Look, cells: np.ndarray, piece: int, last: list[Ride | None]
) -> Candidates | None:
    """Candidates that slide on through the start of a piece, as before it."""
    edge = rider.path.edges[piece]
    rows = []
    for c in cells:
        ride = last[c]
        if ride is None or ride.piece != piece - 1 or ride.curve.kept[-1] < _FAST:
            continue
        pace = _pace(ride)
        well = ride.well + ride.sign * ride.curve.edges[-1]
        lag = abs(well * rider.eps[c] - rider.path.states[piece]) / rider.eps[c]
        left = (edge - ride.end) / pace
        if lag > _LONG and left < 10 * _LONG:
            rows.append((c, ride.sign, ride.end, edge + _OVERSHOT * pace))
    if not rows:
        return None
    cell, sign, begin, stops = (np.array(column) for column in zip(*rows, strict=True))
    late = rider.path.edges[piece + 1]
    many = np.stack([np.full(cell.size, edge), np.minimum(stops, late)], axis=1)
    seen = look(np.repeat(cell, 2), np.repeat(begin, 2), many.ravel())
    place = (seen.well + seen.tip).reshape(-1, 2)
    moved = sign * (place[:, 1] - place[:, 0])
    on = np.all(seen.gap.reshape(-1, 2) < _CLOSED, axis=1)
    on &= (moved > _STILL) & (stops < late)
    none = np.zeros(cell.size)
    well, tip = seen.well[1::2], seen.tip[1::2]
    ends, pieces = none + late, np.full(cell.size, piece)
    every = Candidates(cell, sign, stops, well, tip, ends, pieces, none, seen.gap[1::2])
    # After a turn the force falls until the tip is held again.
    beyond = rider._beyond(every)
    soft = rider.path.stiffness * rider.eps[cell]
    every = every._replace(least=np.minimum(np.maximum(0.02 * beyond, soft), beyond))
    return every.chosen(on)


def _pace(ride: Ride) -> float:
    """Seconds a well at the end of a ride."""
    last = ride.curve.edges[-1]
    times = ride.curve.time_of(np.array([last - 1, last]))
    return float(times[1] - times[0])


def _joins(ride: Ride | None, piece: int, direction: float, path: Path) -> bool:
    """Whether a ride through the piece's start already is the piece's slide."""
    if ride is None or ride.piece != piece or ride.sign != direction:
        return False
    return ride.begin <= path.touch[piece] + 0.5 * (
        path.edges[piece + 1] - path.touch[piece]
    )


def ride_through(
    rider: Rider,
    cells: np.ndarray,
    look: Look,
    check: Callable[[list[int], list[Ride], list[float]], list[np.ndarray]],
    keep: Callable[[int, Ride], None],
) -> None:
    """Find the rides of some cells, piece by piece; `keep` is told each as it is found.

    `look` sees the rides kept before. `check` measures errors of rides by lanes,
    from the gaps at their starts.
    """
    last: list[Ride | None] = [None] * rider.eps.size
    for piece in range(rider.path.direction.size):
        if piece > 0:
            _go(rider, _overshooting(rider, look, cells, piece, last), check, keep, last)
        direction = float(rider.path.direction[piece])
        if direction == 0:
            continue
        new = [c for c in cells if not _joins(last[c], piece, direction, rider.path)]
        if new:
            found = _starting(rider, look, np.array(new), piece, last)
            _go(rider, found, check, keep, last)


def _go(rider: Rider, some: Candidates | None, check, keep, last) -> None:
    if some is None or some.cell.size == 0:
        return
    rows = zip(some.cell, rider.rides(some), some.gap, strict=True)
    found = [(int(c), ride, float(gap)) for c, ride, gap in rows if ride is not None]
    if not found:
        return
    cells, rides, gaps = (list(column) for column in zip(*found, strict=True))
    for c, ride, error in zip(cells, rides, check(cells, rides, gaps), strict=True):
        ride = ride._replace(error=error)
        keep(c, ride)
        last[c] = ride
