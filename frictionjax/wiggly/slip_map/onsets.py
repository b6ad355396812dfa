"""Where fast slides begin, and in which order they are found.

Lanes carry the tip through what is between two fast slides: turns of the load, rests and
the first wells of a slide. They are asked for by value: generators here yield what they
want to know, and are sent it. Where the slide before ends slow, it need not be known: those
slides are followed all at once, the others one after the other.
"""

from collections.abc import Callable, Generator
from typing import Any, NamedTuple, TypeVar

import numpy as np

from ...numerics import rows_of
from ..limit_path import Path, arrivals_at
from .fast_slides import Candidates, FastSlide, FastSlideFinder, FoundTips, none_known
from .settings import SETTINGS
from .slow_flow import first_wells


class LookAt(NamedTuple):
    """Asks for the tips of `cells` at `stops` in s, shape (n,); the answer: `FoundTips`.

    By lanes to brackets that begin at `begins`, which may set off from slides in `known`
    (cells of the sweep,), tuples of `FastSlide`; or from the `tips` that were found
    there (n,).
    """

    known: np.ndarray
    cells: np.ndarray
    begins: np.ndarray
    stops: np.ndarray
    tips: FoundTips | None = None


class Measure(NamedTuple):
    """Asks for the errors of `slides` of `cells`; the answer: `FastSlide.measured` of each.

    `known`: as in `LookAt`. `gaps`: at the starts of the slides, wells of time.
    """

    known: np.ndarray
    cells: list[int]
    slides: list[FastSlide]
    gaps: list[float]


_T = TypeVar("_T")
Waiting = list[Callable[[], np.ndarray]]
Asking = Generator[LookAt | Measure, Any, _T]


def _look(
    known: np.ndarray, cells, begins, stops, tips: FoundTips | None = None
) -> Asking[FoundTips]:
    seen: FoundTips = yield LookAt(known, cells, begins, stops, tips)
    return seen


def _set_off(finder: FastSlideFinder, cell: np.ndarray, piece: np.ndarray) -> np.ndarray:
    """Seconds from touches of the strip's edge until the first wells are passed, (n,)."""
    path, scene = finder.path, finder.scene
    own, which = np.unique(piece, return_inverse=True)
    touch = path.touch[own]
    inside = touch + 1e-6 * (path.edges[own + 1] - touch)
    motion = path.motion_at(inside)
    speed, stiffness = np.abs(motion.speeds)[which], motion.stiffness[which]
    moves = speed > 0
    cell, sign = cell[moves], path.direction[piece[moves]]
    times = np.full(moves.size, np.inf)
    times[moves] = first_wells(
        potential=scene.potential,
        eps=finder.eps[cell],
        fold=finder.fold(cell, sign)[0],
        side=sign,
        viscosity=finder.viscosity[cell],
        rate=(speed * stiffness)[moves],
        stiffness=stiffness[moves],
        wells=SETTINGS.first,
    )
    return times


def _touches(
    finder: FastSlideFinder, known: np.ndarray, cell: np.ndarray, piece: np.ndarray
) -> Asking[tuple[np.ndarray, np.ndarray, FoundTips]]:
    """When the pull reaches the fold where each tip rests before the slide of a piece, s.

    The path's own touch comes earlier where the slide before has lagged: the tip then
    rests short of where the path does. And when tips were looked at, s, and where they are.
    """
    touch = _over(finder, known, cell, piece)
    seen = yield from _look(known, cell, touch, touch)
    # Lanes that failed stay candidates no longer than their gap is looked at.
    states = finder.states(cell, np.nan_to_num(seen.well), np.nan_to_num(seen.tip))
    _, force = finder.fold(cell, finder.path.direction[piece])
    late = finder.path.edges[piece + 1]
    return arrivals_at(finder.scene, states, force, touch, late), touch, seen


def _over(
    finder: FastSlideFinder, known: np.ndarray, cell: np.ndarray, piece: np.ndarray
) -> np.ndarray:
    """The path's touches of pieces, or where slides the other way end later, s, (n,).

    (Lanes that set off from the touch itself went 20,000 to 50,000 wells back and forth in
    6e6 to 1.7e7 steps each: 40 s for a tip that took a second to follow.)
    """
    touch = finder.path.touch[piece].copy()
    for i, (own, at) in enumerate(zip(known[cell], piece, strict=True)):
        if own and own[-1].sign != finder.path.direction[at]:
            touch[i] = max(touch[i], own[-1].end)
    return touch


def _starting(
    finder: FastSlideFinder,
    known: np.ndarray,
    cell: np.ndarray,
    piece: np.ndarray,
    lags: np.ndarray,
) -> Asking[tuple[Candidates | None, np.ndarray]]:
    """Candidates at the starts of the slides of pieces, and which these are of.

    `lags` (n,): where the slide before has left the tip behind the path.
    """
    path = finder.path
    wait = _set_off(finder, cell, piece)
    touch, late = path.touch[piece].copy(), path.edges[piece + 1]
    lags = lags & (touch + wait < late)
    # A second look goes on where the first one has come to.
    begin, tips = touch.copy(), None
    if lags.any():
        looked = yield from _touches(finder, known, cell[lags], piece[lags])
        touch[lags], begin[lags], seen = looked
        nowhere = np.full((3, cell.size), np.nan)
        nowhere[:, lags] = seen
        tips = FoundTips(*nowhere)
    able = np.flatnonzero(touch + wait < late)
    if able.size == 0:
        return None, able
    cell, piece, late = cell[able], piece[able], late[able]
    stops = (touch + wait)[able]
    tips = None if tips is None else rows_of(tips, able)
    seen = yield from _look(known, cell, begin[able], stops, tips)
    candidates = Candidates(
        cell=cell,
        sign=path.direction[piece],
        time=stops,
        well=seen.well,
        tip=seen.tip,
        late=late,
        piece=piece,
        least=np.zeros(able.size),
        gap=seen.gap,
    )
    closed = seen.gap < SETTINGS.closed
    return rows_of(candidates, closed), able[closed]


def _overshooting(
    finder: FastSlideFinder, known: np.ndarray, piece: int
) -> Asking[Candidates | None]:
    """Candidates that slide on through the start of a piece, as before it."""
    edge = finder.path.edges[piece]
    rows = []
    for c in range(known.size):
        slide = _last(known[c])
        if slide is None or slide.piece != piece - 1 or slide.curve.last < SETTINGS.fast:
            continue
        pace = _pace(slide)
        well = slide.well + slide.sign * slide.curve.edges[-1]
        lag = abs(well * finder.eps[c] - finder.path.states[piece]) / finder.eps[c]
        left = (edge - slide.end) / pace
        if lag > SETTINGS.long_lag and left < 10 * SETTINGS.long_lag:
            rows.append((c, slide.sign, slide.end, edge + SETTINGS.overshot * pace))
    if not rows:
        return None
    cell, sign, begin, stops = (np.array(column) for column in zip(*rows, strict=True))
    late = finder.path.edges[piece + 1]
    many = np.stack([np.full(cell.size, edge), np.minimum(stops, late)], axis=1)
    seen = yield from _look(known, np.repeat(cell, 2), np.repeat(begin, 2), many.ravel())
    place = (seen.well + seen.tip).reshape(-1, 2)
    moved = sign * (place[:, 1] - place[:, 0])
    on = np.all(seen.gap.reshape(-1, 2) < SETTINGS.closed, axis=1)
    on &= (moved > SETTINGS.still) & (stops < late)
    every = Candidates(
        cell=cell,
        sign=sign,
        time=stops,
        well=seen.well[1::2],
        tip=seen.tip[1::2],
        late=np.full(cell.size, late),
        piece=np.full(cell.size, piece),
        least=np.zeros(cell.size),
        gap=seen.gap[1::2],
    )
    # After a turn the force falls until the tip is held again.
    beyond = finder.beyond(every)
    soft = finder.path.stiffness * finder.eps[cell]
    every = every._replace(least=np.minimum(np.maximum(0.02 * beyond, soft), beyond))
    return rows_of(every, on)


def _pace(slide: FastSlide) -> float:
    """Seconds a well at the end of a slide."""
    last = slide.curve.edges[-1]
    times = slide.curve.time_of(np.array([last - 1, last]))
    return float(times[1] - times[0])


def _last(own: tuple[FastSlide, ...]) -> FastSlide | None:
    return own[-1] if own else None


def _joins(slide: FastSlide | None, piece: int, direction: float, path: Path) -> bool:
    """Whether a slide through the piece's start already is the piece's slide."""
    if slide is None or slide.piece != piece or slide.sign != direction:
        return False
    return slide.begin <= path.touch[piece] + 0.5 * (
        path.edges[piece + 1] - path.touch[piece]
    )


def _foreseen(finder: FastSlideFinder) -> tuple[np.ndarray, np.ndarray]:
    """Cells and pieces of slides whose slide before should end slow, or has none before."""
    path = finder.path
    slides = np.flatnonzero(path.direction)
    first = np.ones((1, finder.eps.size), dtype=bool)
    slow = finder.slow[:, slides[:-1]].T
    which, cell = np.nonzero(np.concatenate([first, slow]))
    return cell, slides[which]


def _followed(
    finder: FastSlideFinder, known: np.ndarray, some: Candidates
) -> Asking[list[FastSlide | None]]:
    """The fast slides of candidates; their errors are measured meanwhile."""
    slides = finder.fast_slides(some)
    rows = zip(some.cell, slides, some.gap, strict=True)
    found = [(int(c), slide, float(gap)) for c, slide, gap in rows if slide is not None]
    if not found:
        return slides
    cells, new, gaps = (list(column) for column in zip(*found, strict=True))
    waiting: Waiting = yield Measure(known, cells, new, gaps)
    measured = iter(waiting)
    return [s if s is None else s._replace(measured=next(measured)) for s in slides]


def _at_once(finder: FastSlideFinder) -> Asking[dict]:
    """Slides, or None, of cells and pieces that are found without those before."""
    if not finder.path.direction.any():
        return {}
    cell, piece = _foreseen(finder)
    none = none_known(finder.eps.size)
    lags = np.zeros(cell.size, dtype=bool)
    some, which = yield from _starting(finder, none, cell, piece, lags)
    if some is None or which.size == 0:
        return {}
    slides = yield from _followed(finder, none, some)
    return dict(zip(zip(cell[which], piece[which], strict=True), slides, strict=True))


def _with(known: np.ndarray, cells, slides: list[FastSlide | None]) -> np.ndarray:
    """What is known of each cell, later slides of `cells` included."""
    more = known.copy()
    for cell, slide in zip(cells, slides, strict=True):
        if slide is not None:
            more[cell] = (*more[cell], slide)
    return more


def _on_piece(
    finder: FastSlideFinder, known: np.ndarray, ready: dict, piece: int
) -> Asking[np.ndarray]:
    """What is known of each cell after the slides that begin on a piece.

    `ready`: those found without what was before, which count where it does not lag.
    """
    direction, last = float(finder.path.direction[piece]), [_last(own) for own in known]
    cells = range(known.size)
    new = [c for c in cells if not _joins(last[c], piece, direction, finder.path)]
    lags = [slide is not None and slide.lags for slide in last]
    found = [c for c in new if (c, piece) in ready and not lags[c]]
    known = _with(known, found, [ready[c, piece] for c in found])
    left = np.array([c for c in new if c not in found], dtype=int)
    if left.size == 0:
        return known
    some, _ = yield from _starting(
        finder, known, left, np.full(left.size, piece), np.array(lags)[left]
    )
    if some is None or not some.cell.size:
        return known
    slides = yield from _followed(finder, known, some)
    return _with(known, some.cell, slides)


def asking_for_slides(finder: FastSlideFinder) -> Asking[np.ndarray]:
    """Find the fast slides of all cells: tuples of them, in time, shape (cells,).

    Whoever drives this generator answers what it asks for.
    """
    known = none_known(finder.eps.size)
    ready = yield from _at_once(finder)
    for piece, direction in enumerate(finder.path.direction):
        if piece > 0:
            over = yield from _overshooting(finder, known, piece)
            if over is not None and over.cell.size:
                slides = yield from _followed(finder, known, over)
                known = _with(known, over.cell, slides)
        if direction != 0:
            known = yield from _on_piece(finder, known, ready, piece)
    return known
