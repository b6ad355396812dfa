"""Fast slides whose passages are known from the slip map.

Where tips never rest on a slide, starts are forgotten only after hundreds to millions of
wells, and brackets from far behind cost as many. There the times of passage follow from
the slip map instead.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...model import TabulatedScene
from ...numerics import concatenated, rows_of
from ..limit_path import SETTINGS as PATH_SETTINGS
from ..limit_path import Path
from .map import follow
from .recursion import Slides
from .settings import SETTINGS
from .transit import one_transit_time, pull_at
from .transit_times import TransitTimes
from .well_pull import WellArc, WellPull, well_pull_of, wiggles_at


class FastSlide(NamedTuple):
    """A fast slide of one cell.

    `curve`: when the tip passes its lattice points. At the number n the tip is at `tip` in
    the well `well + sign n`. `piece`: of the load. `measured`: waits for lanes that
    measure the errors.
    """

    curve: TransitTimes
    sign: float
    well: float
    tip: float
    piece: int
    measured: Callable[[], np.ndarray]

    @property
    def error(self) -> np.ndarray:
        """Of the tip at lattice points of each panel, in periods, (K,)."""
        return self.measured()

    @property
    def begin(self) -> float:
        """Time in s from which passages are known."""
        return float(self.curve.starts[0])

    @property
    def end(self) -> float:
        """Time in s up to which passages are known."""
        return float(self.curve.starts[-1])

    @property
    def lags(self) -> bool:
        """Whether the tip is behind the path where the slide ends, by more than a slip."""
        return bool(self.curve.last > PATH_SETTINGS.rests)


def _not_measured() -> np.ndarray:
    raise RuntimeError("a fast slide is used before its errors are measured")


def none_known(count: int) -> np.ndarray:
    """Of so many cells: no fast slides, an empty tuple for each."""
    known = np.empty(count, dtype=object)
    known[:] = [()] * count
    return known


def last_begun(slides: np.ndarray, cell: np.ndarray, time: np.ndarray):
    """Slides of the cells, and which of them each began last before a time; else -1."""
    every: list[FastSlide] = []
    which = np.full(cell.size, -1)
    for c in np.unique(cell):
        mine = cell == c
        for slide in slides[c]:
            which[mine & (time >= slide.begin)] = len(every)
            every.append(slide)
    return every, which


class FoundTips(NamedTuple):
    """Tips that lanes found at wanted times, shape (n,).

    `gap`: how closely brackets have closed, in wells of time: near a fold a small way
    takes long.
    """

    well: np.ndarray
    tip: np.ndarray
    gap: np.ndarray


class Candidates(NamedTuple):
    """Slides that may be fast, shape (n,): at `time` (s) the tip is at `tip` in `well`.

    `late`: end of the piece in s. `least`: force in N beyond the fold, at least. `gap`: as
    in `FoundTips`.
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


class FastSlideFinder(NamedTuple):
    """What fast slides of a sweep are made from.

    `eps`, `viscosity`, `lag` (wells, of the fastest slide): shape (cells,). `folds`: tip
    coordinates and forces of the extreme folds of each cell by direction, as
    `{1.0: (place, force), -1.0: ...}`. `slow` (cells, pieces): slides that should end
    slow. `tail`: as of `follow`.
    """

    scene: TabulatedScene
    path: Path
    eps: np.ndarray
    viscosity: np.ndarray
    lag: np.ndarray
    folds: dict[float, tuple[np.ndarray, np.ndarray]]
    slow: np.ndarray
    tail: float
    accuracy: float

    def fold(self, cell: np.ndarray, sign: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Place and force in N of the extreme folds of cells that slide that way."""
        pairs = zip(self.folds[1.0], self.folds[-1.0], strict=True)
        place, force = (np.where(sign > 0, a[cell], b[cell]) for a, b in pairs)
        return place, force

    def _stretch(self, some: Candidates, start, length, excess) -> WellArc:
        _, force = self.fold(some.cell, some.sign)
        return WellArc(self.eps[some.cell], start, length, some.sign, force, excess)

    def states(self, cell: np.ndarray, well: np.ndarray, tip: np.ndarray) -> np.ndarray:
        """z in m of tips."""
        offset = wiggles_at(self.scene.potential, self.eps[cell], tip)[2]
        return self.eps[cell] * (well + tip) + offset

    def beyond(self, some: Candidates) -> np.ndarray:
        """Force in N beyond the fold where the candidates are."""
        states = self.states(some.cell, some.well, some.tip)
        pull = pull_at(self.scene, some.time, states)
        _, force = self.fold(some.cell, some.sign)
        return some.sign * (pull.load[:, 0] - pull.support[:, 0] - force)

    def _way(self, some: Candidates) -> tuple[np.ndarray, np.ndarray]:
        """Tip coordinate of the next fold, and periods until there."""
        place, _ = self.fold(some.cell, some.sign)
        return place, np.mod(some.sign * (place - some.tip), 1.0)

    def _tracks(self, some: Candidates, excess: np.ndarray) -> tuple[WellPull, WellPull]:
        """Force on the ways to the next fold, and through the wells from there on."""
        place, way = self._way(some)
        parts = (
            self._stretch(some, some.tip, way, excess),
            self._stretch(some, place, np.ones_like(way), excess),
        )
        # Both at once: each took 4 ms of a sweep for its small programs.
        both = concatenated(parts)
        track = well_pull_of(self.scene.potential, both, self._rough(some.cell))
        count = some.cell.size
        return rows_of(track, slice(count)), rows_of(track, slice(count, None))

    def _rough(self, cell: np.ndarray) -> float:
        """How roughly passages may be resolved, so that errors that add up stay small."""
        memory = 2 * np.max(self.lag[cell])
        allowed = np.sqrt(SETTINGS.of_accuracy * self.accuracy / max(memory, 1.0))
        return float(np.clip(allowed, SETTINGS.rough, SETTINGS.roughest))

    def _to_fold(self, some: Candidates, track: WellPull):
        """Time of the next passage of a fold, and the well of that fold."""
        place, way = self._way(some)
        states = self.states(some.cell, some.well, some.tip)
        pull = pull_at(self.scene, some.time, states)
        length = one_transit_time(track, pull, self.viscosity[some.cell])
        wells = np.round(some.tip + some.sign * way - place)  # `some.well` may be no whole
        well = some.well + wells
        return some.time + length, well

    def fast_slides(self, some: Candidates) -> list[FastSlide | None]:
        """Follow the candidates; None where a slide is slow or short."""
        beyond = self.beyond(some)
        least = np.where(some.least > 0, some.least, SETTINGS.narrow * beyond)
        able = np.flatnonzero((beyond > 0) & (least > 0))
        found: list[FastSlide | None] = [None] * some.cell.size
        if able.size == 0:
            return found
        some = rows_of(some, able)
        to_fold, track = self._tracks(some, least[able])
        time, well = self._to_fold(some, to_fold)
        fits = np.isfinite(time) & (time < some.late)
        if not fits.any():
            return found
        able, some, time, well = able[fits], rows_of(some, fits), time[fits], well[fits]
        track = rows_of(track, fits)
        place, _ = self.fold(some.cell, some.sign)
        slides = Slides(
            track=track,
            eps=self.eps[some.cell],
            viscosity=self.viscosity[some.cell],
            origin=self.states(some.cell, well, place),
            first=np.zeros(able.size),
            time=time,
            late=some.late,
        )
        for i, curve in enumerate(follow(self.scene, slides, self.tail)):
            if curve is not None:
                found[able[i]] = FastSlide(
                    curve=curve,
                    sign=float(some.sign[i]),
                    well=float(well[i]),
                    tip=float(place[i]),
                    piece=int(some.piece[i]),
                    measured=_not_measured,
                )
        return found
