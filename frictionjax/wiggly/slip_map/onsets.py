"""Where rides begin, and in which order they are found.

Lanes carry the tip through what is between two rides: turns of the load, rests and the
first wells of a slide. Where the slide before ends slow, its ride need not be known: those
slides are followed all at once, the others one after the other.
"""

from collections.abc import Callable

import numpy as np

from ..limit_path import Path, arrivals_at, slopes_at, states_at
from .fast_slides import Candidates, FastSlide, FastSlideFinder, Look
from .slow_flow import first_wells
from .transit import pull_at

# Wells behind the tip where the slip map takes over: passages change slowly enough for
# panels of 16 wells (8 wells: tails 100 times larger).
_FIRST = 16.0
_OVERSHOT = 12.0  # wells after a turn, at the pace before it
_STILL = 4.0  # of them that must have been passed for the slide to go on
_CLOSED = 0.1  # wells of time: gaps of brackets at the start of a ride, at most
_LONG = 100.0  # wells of lag that are worth a slip map after the turn
_FAST = 0.9  # share that a well leaves of a shift, where lags are many wells

# Rides of cells and the gaps at their starts -> for each, what waits for its errors.
Check = Callable[[list[int], list[FastSlide], list[float]], list[Callable[[], np.ndarray]]]
Keep = Callable[[int, FastSlide], None]


def _set_off(rider: FastSlideFinder, cell: np.ndarray, piece: np.ndarray) -> np.ndarray:
    """Seconds from touches of the strip's edge until the first wells are passed, (n,)."""
    path, scene = rider.path, rider.scene
    own, which = np.unique(piece, return_inverse=True)
    touch = path.touch[own]
    inside = touch + 1e-6 * (path.edges[own + 1] - touch)
    state = states_at(scene, path, inside)
    speed = np.abs(slopes_at(scene, path, inside, state))[which]
    stiffness = pull_at(scene, inside, state).support[which, 1]
    moves = speed > 0
    cell, sign = cell[moves], path.direction[piece[moves]]
    where = rider.eps[cell], rider.fold(cell, sign)[0], sign
    pull = (speed * stiffness)[moves], stiffness[moves]
    times = np.full(moves.size, np.inf)
    times[moves] = first_wells(
        scene.potential, *where, rider.viscosity[cell], *pull, _FIRST
    )
    return times


def _touches(
    rider: FastSlideFinder, look: Look, cell: np.ndarray, piece: np.ndarray
) -> np.ndarray:
    """When the pull reaches the fold where each tip rests before the slide of a piece, s.

    The path's own touch comes earlier where the slide before has lagged: the tip then
    rests short of where the path does.
    """
    touch = rider.path.touch[piece]
    seen = look(cell, touch, touch)
    # Lanes that failed stay candidates no longer than their gap is looked at.
    states = rider.states(cell, np.nan_to_num(seen.well), np.nan_to_num(seen.tip))
    _, force = rider.fold(cell, rider.path.direction[piece])
    return arrivals_at(rider.scene, states, force, touch, rider.path.edges[piece + 1])


def _starting(
    rider: FastSlideFinder,
    look: Look,
    cell: np.ndarray,
    piece: np.ndarray,
    lags: np.ndarray,
) -> tuple[Candidates | None, np.ndarray]:
    """Candidates at the starts of the slides of pieces, and which these are of.

    `lags` (n,): where the slide before has left the tip behind the path.
    """
    path = rider.path
    wait = _set_off(rider, cell, piece)
    touch, late = path.touch[piece].copy(), path.edges[piece + 1]
    lags = lags & (touch + wait < late)
    if lags.any():
        touch[lags] = _touches(rider, look, cell[lags], piece[lags])
    able = np.flatnonzero(touch + wait < late)
    if able.size == 0:
        return None, able
    cell, piece, late = cell[able], piece[able], late[able]
    stops = (touch + wait)[able]
    seen = look(cell, touch[able], stops)
    none = np.zeros(able.size)
    where = cell, path.direction[piece], stops, seen.well, seen.tip, late, piece
    closed = seen.gap < _CLOSED
    return Candidates(*where, none, seen.gap).chosen(closed), able[closed]


def _overshooting(
    rider: FastSlideFinder,
    look: Look,
    cells: np.ndarray,
    piece: int,
    last: dict[int, FastSlide],
) -> Candidates | None:
    """Candidates that slide on through the start of a piece, as before it."""
    edge = rider.path.edges[piece]
    rows = []
    for c in cells:
        ride = last.get(c)
        if ride is None or ride.piece != piece - 1 or ride.curve.last < _FAST:
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
    beyond = rider.beyond(every)
    soft = rider.path.stiffness * rider.eps[cell]
    every = every._replace(least=np.minimum(np.maximum(0.02 * beyond, soft), beyond))
    return every.chosen(on)


def _pace(ride: FastSlide) -> float:
    """Seconds a well at the end of a ride."""
    last = ride.curve.edges[-1]
    times = ride.curve.time_of(np.array([last - 1, last]))
    return float(times[1] - times[0])


def _joins(ride: FastSlide | None, piece: int, direction: float, path: Path) -> bool:
    """Whether a ride through the piece's start already is the piece's slide."""
    if ride is None or ride.piece != piece or ride.sign != direction:
        return False
    return ride.begin <= path.touch[piece] + 0.5 * (
        path.edges[piece + 1] - path.touch[piece]
    )


def _foreseen(rider: FastSlideFinder, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cells and pieces of slides whose slide before should end slow, or has none before."""
    path = rider.path
    slides = np.flatnonzero(path.direction)
    first = np.ones((1, cells.size), dtype=bool)
    slow = rider.slow[cells][:, slides[:-1]].T
    which, cell = np.nonzero(np.concatenate([first, slow]))
    return cells[cell], slides[which]


def _followed(
    rider: FastSlideFinder, some: Candidates, check: Check
) -> list[FastSlide | None]:
    """The rides of candidates; their errors are measured meanwhile."""
    rides = rider.rides(some)
    rows = zip(some.cell, rides, some.gap, strict=True)
    found = [(int(c), ride, float(gap)) for c, ride, gap in rows if ride is not None]
    if not found:
        return rides
    cells, some_rides, gaps = (list(column) for column in zip(*found, strict=True))
    measured = iter(check(cells, some_rides, gaps))
    return [r if r is None else r._replace(measured=next(measured)) for r in rides]


def _at_once(rider: FastSlideFinder, cells: np.ndarray, look: Look, check: Check) -> dict:
    """Rides, or None, of cells and pieces that are found without those before."""
    cell, piece = _foreseen(rider, cells)
    some, which = _starting(rider, look, cell, piece, np.zeros(cell.size, dtype=bool))
    if some is None or which.size == 0:
        return {}
    rides = _followed(rider, some, check)
    return dict(zip(zip(cell[which], piece[which], strict=True), rides, strict=True))


def fast_slide_through(
    rider: FastSlideFinder, cells: np.ndarray, look: Look, check: Check, keep: Keep
) -> None:
    """Find the rides of some cells; `keep` is told each, those of a cell in time.

    `look` sees the rides kept before.
    """
    last: dict[int, FastSlide] = {}
    path = rider.path

    def go_on(cell: np.ndarray, rides: list[FastSlide | None]) -> None:
        for c, ride in zip(cell, rides, strict=True):
            if ride is not None:
                keep(c, ride)
                last[c] = ride

    ready = _at_once(rider, cells, look, check) if path.direction.any() else {}
    for piece in range(path.direction.size):
        if piece > 0:
            over = _overshooting(rider, look, cells, piece, last)
            if over is not None and over.cell.size:
                go_on(over.cell, _followed(rider, over, check))
        direction = float(path.direction[piece])
        if direction == 0:
            continue
        new = [c for c in cells if not _joins(last.get(c), piece, direction, path)]
        lags = {c: c in last and last[c].lags for c in new}
        known = [c for c in new if (c, piece) in ready and not lags[c]]
        go_on(np.array(known), [ready[c, piece] for c in known])
        left = np.array([c for c in new if c not in known], dtype=int)
        if left.size == 0:
            continue
        behind = np.array([lags[c] for c in left])
        some, _ = _starting(rider, look, left, np.full(left.size, piece), behind)
        if some is not None and some.cell.size:
            go_on(some.cell, _followed(rider, some, check))
