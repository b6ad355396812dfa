"""Which stretches of time each cell measures: all of them, or a few periods of slides."""

from typing import NamedTuple

import numpy as np

from ...model import Scene
from ..limit_path import Path, states_at, times_at
from ..slip_map import ManyTransitTimes, last_begun
from .brackets import Brackets
from .requirements import Requirements, wells_a_leg
from .sampled_parts import Parts, inner_parts, level_at, sampled, uneven_pieces
from .segment_ends import Cut, follow_path, segments_of
from .settings import SETTINGS
from .starts import way_at


class SampledPeriods(NamedTuple):
    """The inner part of a slide of one cell, of which only some periods are measured.

    `low`, `high`: its ends, s. `starts`, `ends`: times of the periods, s. `stops`: where
    they end, among the stops of the windows. `way`: of the path from low to high, m.
    """

    cell: int
    piece: int
    low: float
    high: float
    way: float
    starts: np.ndarray
    ends: np.ndarray
    stops: np.ndarray


class Layout(NamedTuple):
    """Windows of all cells, and what they are for.

    `chain`: for each cell, the stops that follow each other through everything that is
    not inside a slide, in time. `slides`: of all cells. `output` (cells, n): the stop at
    each requested time. `whole`: whether chain and slides cover [0, T].
    """

    windows: Brackets
    chain: list[np.ndarray]
    slides: list[SampledPeriods]
    output: np.ndarray
    whole: bool


def _lattice(scene: Scene, path: Path, eps, needs: Requirements, parts: Parts, chosen):
    """Cell and time of every leg's end on slides of chosen cells, outside inner parts."""
    legs = wells_a_leg(path, eps)
    lows, highs = (states_at(scene, path, t) for t in (parts.low, parts.high))
    cells, pieces, wells = [], [], []
    for cell in chosen:
        leg = float(legs[cell])
        own = parts.cell == cell
        for slide in np.flatnonzero(path.direction).tolist():
            way = abs(path.states[slide + 1] - path.states[slide]) / eps[cell]
            way -= needs.lattice_offset[cell, slide]
            mine = own & (parts.low < path.edges[slide + 1])
            mine &= parts.high > path.touch[slide]
            at = _outside(path, slide, eps[cell], leg, way, lows[mine], highs[mine])
            cells.append(np.full(at.size, cell))
            pieces.append(np.full(at.size, slide))
            wells.append(at)
    if not cells:
        return np.zeros(0, dtype=int), np.zeros(0)
    whose, piece, well = (np.concatenate(a) for a in (cells, pieces, wells))
    return whose, times_at(
        scene, path, piece, level_at(path, eps, needs, whose, piece, well)
    )


def _outside(path: Path, slide: int, eps: float, leg: float, way: float, lows, highs):
    """Wells of a slide at which legs end: none inside its inner parts, in m of the path."""
    if lows.size == 0:
        return np.arange(leg, way, leg)
    ends = path.states[slide], path.states[slide + 1]
    starts = np.abs(np.clip(lows, *sorted(ends)) - ends[0]) / eps
    stops = np.abs(np.clip(highs, *sorted(ends)) - ends[0]) / eps
    order = np.argsort(starts)
    opens = np.concatenate([[0.0], stops[order]])
    closes = np.concatenate([starts[order], [way]])
    gaps = [
        np.arange(np.ceil(a) + leg, b - 0.5, leg)
        for a, b in zip(opens, closes, strict=True)
    ]
    return np.concatenate(gaps)


def _cut(parts: Parts, cell: int, fixed: np.ndarray, lattice: np.ndarray) -> Cut:
    """A cell's chain. Inner parts are left out: a segment begins where one ends."""
    mine = np.flatnonzero(parts.cell == cell)
    mine = mine[np.argsort(parts.low[mine])]
    low, high = parts.low[mine], parts.high[mine]
    # Where one hole follows another there is nothing to be measured between.
    own = np.unique(np.concatenate([fixed, lattice, low[~np.isin(low, high)]]))
    hole = np.searchsorted(low, own) - 1  # of those that begin before
    inside = (hole >= 0) & (own < np.append(high, 0.0)[hole])
    own = own[~inside & (own > 0)]
    return Cut(np.concatenate([[0.0], high]), own)


def _tiles(segment: np.ndarray, tile: np.ndarray) -> list[np.ndarray]:
    """Stops of a chain that one window holds: of one segment and one tile of it."""
    cut = (np.diff(segment) != 0) | (np.diff(tile) > 0)
    return np.split(np.arange(segment.size), np.flatnonzero(cut) + 1)


def _on_slides(slides: tuple, times: np.ndarray) -> np.ndarray:
    """Blocks of wells on fast slides that are passed before each time.

    Tiles end there: lanes set off from fast slides anywhere, and what waits for the longest
    tile at gamma = 1/4, eps = 1e-8 took 7 s of 9.
    """
    passed = np.zeros(times.size)
    for slide in slides:
        held = np.clip(times, slide.begin, slide.end)
        passed += np.floor(slide.curve.number_at(held) / SETTINGS.most_wells_a_leg)
    return passed


class _Rows:
    """Windows as they are added: cell, begin, paired and stops of each."""

    def __init__(self) -> None:
        self._cells: list[np.ndarray] = []
        self._begins: list[np.ndarray] = []
        self._paired: list[np.ndarray] = []
        self._sizes: list[np.ndarray] = []
        self._stops: list[np.ndarray] = []
        self._count = 0

    def add(self, cell, begin, paired: bool, stops: np.ndarray, sizes=None) -> np.ndarray:
        """Add windows; the numbers of their stops among all.

        `cell`, `begin`, `sizes`: of each, so many of the stops as its size; of one window
        with all the stops where there are no sizes.
        """
        sizes = np.array([stops.size]) if sizes is None else sizes
        self._cells.append(np.atleast_1d(cell))
        self._begins.append(np.atleast_1d(begin))
        self._paired.append(np.full(sizes.size, paired))
        self._sizes.append(sizes)
        self._stops.append(stops)
        self._count += stops.size
        return np.arange(self._count - stops.size, self._count)

    def windows(self) -> Brackets:
        """All of them."""
        sizes = np.concatenate(self._sizes)
        owner = np.repeat(np.arange(sizes.size), sizes)
        parts = self._cells, self._begins, self._paired, self._stops
        cell, begin, paired, stops = (np.concatenate(part) for part in parts)
        return Brackets(cell, begin, paired, owner, stops)


def lay_out(
    scene: Scene,
    path: Path,
    eps: np.ndarray,
    ts: np.ndarray,
    needs: Requirements,
    fast_slides: np.ndarray,
    accuracy: float,
    summed: bool = True,
) -> Layout:
    """Windows that give every requested time, and sums and extremes over [0, T].

    Legs are short enough for extremes good to `accuracy`, in eps.

    Outside the inner parts of slides everything is measured, in tiles that follow each
    other; inside, some periods, and one window for each requested time. Where nothing is
    `summed`, only windows with requested times are left.
    """
    summed = summed or not np.any(ts > 0)
    parts = inner_parts(scene, path, eps, needs, fast_slides)
    rows = _Rows()
    cells = _Cells(scene, path, eps, needs, fast_slides)
    chain, hit = _chains(cells, accuracy, parts, ts, summed, rows)
    measured = parts if summed else Parts(*(column[:0] for column in parts))
    slides = _slides(cells, measured, rows)
    shown = _shown(cells, ts, hit, rows)
    return Layout(rows.windows(), chain, slides, shown, summed)


class _Cells(NamedTuple):
    """What is to be laid out, as in `lay_out`."""

    scene: Scene
    path: Path
    eps: np.ndarray
    needs: Requirements
    fast_slides: np.ndarray


def _chains(
    cells: _Cells, accuracy: float, parts: Parts, ts: np.ndarray, summed: bool, rows: _Rows
) -> tuple[list[np.ndarray], np.ndarray]:
    """Tiles outside the inner parts of slides: the stops of each cell that follow each
    other, and at which of them each requested time is, -1 at none."""
    scene, path, eps, needs, fast_slides = cells
    output = np.full((eps.size, ts.size), -1)
    # Beside fast slides windows of a few wells each lead to the times.
    chained = [c for c in range(eps.size) if summed or not fast_slides[c]]
    # Guides of long legs are coarse, which counts in sums only: long lanes need no stops.
    stopped = [c for c in chained if summed or np.isfinite(needs.tile[c])]
    lattice_cell, lattice_time = _lattice(scene, path, eps, needs, parts, stopped)
    edges = np.concatenate([path.edges[1:], path.touch[path.touch < path.edges[-1]]])
    steep = np.unique(path.probes.times[uneven_pieces(path)])
    apart = np.diff(steep, prepend=-np.inf) > SETTINGS.apart * path.edges[-1]
    fixed = np.unique(np.concatenate([edges, ts, steep[apart]]))
    cuts = [
        _cut(parts, cell, fixed, lattice_time[lattice_cell == cell]) for cell in chained
    ]
    if summed:
        cuts = follow_path(scene, path, eps[chained], accuracy, cuts)
    # Of all cells at once: a call each took 0.1 ms.
    times = [t for cut in cuts for t in cut]
    every = way_at(scene, path, np.concatenate([*times, np.zeros(0)]))
    ways = np.split(every, np.cumsum([t.size for t in times]))
    chain = [np.zeros(0, dtype=int)] * eps.size
    for k, (cell, (opening, own)) in enumerate(zip(chained, cuts, strict=True)):
        segment = segments_of(opening, own)
        since = (ways[2 * k + 1] - ways[2 * k][segment]) / eps[cell]
        tile = np.floor(since / needs.tile[cell] - 1e-9) + _on_slides(
            fast_slides[cell], own
        )
        tile += np.searchsorted(path.edges[1:][needs.restarts[cell]], own)
        begins = own > opening[segment]
        own, segment, tile = own[begins], segment[begins], tile[begins]
        tiles = _tiles(segment, tile)
        if not summed:
            wanted = np.isin(own, ts)
            tiles = [group for group in tiles if wanted[group].any()]
        numbers = [np.zeros(0, dtype=int)]
        for group in tiles:
            first = group[0]
            fresh = first == 0 or segment[first] != segment[first - 1]
            begin = opening[segment[first]] if fresh else own[first - 1]
            numbers.append(rows.add(cell, begin, False, own[group]))
        own = own[np.concatenate([*tiles, np.zeros(0, dtype=int)])]
        chain[cell] = np.concatenate(numbers)
        which = np.searchsorted(own, ts)
        hit = np.append(own, np.nan)[which] == ts
        output[cell, hit] = chain[cell][which[hit]]
    return chain, output


def _slides(cells: _Cells, parts: Parts, rows: _Rows) -> list[SampledPeriods]:
    """A window for each period that is measured inside a slide."""
    scene, path, eps, needs, fast_slides = cells
    who, starts, ends = sampled(scene, path, eps, needs, parts, fast_slides)
    lows, highs = (states_at(scene, path, t) for t in (parts.low, parts.high))
    slides = []
    for i in range(parts.cell.size):
        own = np.flatnonzero(who == i)
        one = np.ones(own.size, dtype=int)
        stops = rows.add(parts.cell[i] * one, starts[own], True, ends[own], one)
        slide = SampledPeriods(
            cell=parts.cell[i],
            piece=parts.piece[i],
            low=parts.low[i],
            high=parts.high[i],
            way=highs[i] - lows[i],
            starts=starts[own],
            ends=ends[own],
            stops=stops,
        )
        slides.append(slide)
    return slides


def _shown(cells: _Cells, ts: np.ndarray, hit: np.ndarray, rows: _Rows) -> np.ndarray:
    """The stop at each requested time: one of `hit`, or in a window of its own."""
    scene, path, eps, needs, fast_slides = cells
    cell, shown = np.nonzero((hit < 0) & (ts > 0))
    begin = _period_before(scene, path, eps, needs, cell, ts[shown])
    begin = _fast_period_before(fast_slides, cell, ts[shown], begin)
    order, sizes = _rests_together(path, cell, ts[shown])
    cell, shown, begin = cell[order], shown[order], begin[order]
    first = np.cumsum(sizes) - sizes
    output = hit.copy()
    output[cell, shown] = rows.add(cell[first], begin[first], True, ts[shown], sizes)
    return output


def _rests_together(
    path: Path, cell: np.ndarray, times: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Times, by their indices, and how many follow each other into one window.

    Those of one rest of the path share a window.
    """
    piece = path.piece_of(times)
    slides = times > path.touch[piece]
    order = np.lexsort((times, piece, cell))
    same = (np.diff(cell[order]) == 0) & (np.diff(piece[order]) == 0)
    cut = ~same | slides[order[1:]] | slides[order[:-1]]
    opens = np.flatnonzero(np.append(order.size > 0, cut))
    return order, np.diff(np.append(opens, order.size))


def _period_before(scene, path, eps, needs, cell, times) -> np.ndarray:
    """Start of the slip period of the path that holds each time."""
    piece = path.piece_of(times)
    way = np.abs(states_at(scene, path, times) - path.states[piece])
    well = np.maximum(np.ceil(way / eps[cell] - needs.lattice_offset[cell, piece]) - 1, 0)
    inside = (path.direction[piece] != 0) & (times > path.touch[piece])
    begin = times.copy()
    slide = np.flatnonzero(inside)
    levels = level_at(path, eps, needs, cell[slide], piece[slide], well[slide])
    begin[slide] = times_at(scene, path, piece[slide], levels)
    return np.minimum(begin, times)


def _fast_period_before(fast_slides: np.ndarray, cell, times, begin) -> np.ndarray:
    """Start of the fast slide's period that holds each time; as it was where none does."""
    every, which = last_begun(fast_slides, cell, times)
    mine = np.flatnonzero(which >= 0)
    if mine.size == 0:
        return begin
    ends = np.array([slide.end for slide in every])
    mine = mine[times[mine] < ends[which[mine]]]
    curves = ManyTransitTimes([slide.curve for slide in every])
    number = np.floor(curves.number_at(which[mine], times[mine]))
    begin = begin.copy()
    begin[mine] = np.minimum(curves.time_of(which[mine], number), times[mine])
    return begin
