"""The chain of a cell: everything outside the inner parts of slides, in tiles."""

from typing import NamedTuple

import numpy as np

from .bracket_rows import BracketRows
from .requirements import tiles_at
from .sampled_parts import CellSlides, Parts, uneven_pieces
from .segment_ends import Cut, follow_path, stretches_of
from .settings import SETTINGS


class Chains(NamedTuple):
    """Stops of each cell that follow each other, and at which of them requested times are.

    `stops`: their numbers, in time, for each cell. `hit` (cells, n): the stop at each
    requested time, -1 at none.
    """

    stops: list[np.ndarray]
    hit: np.ndarray


def chains_of(
    slides: CellSlides,
    parts: Parts,
    ts: np.ndarray,
    accuracy: float,
    summed: bool,
    rows: BracketRows,
) -> Chains:
    """Tiles outside the inner `parts` of slides, which are added to `rows`."""
    path, eps, needs = slides.path, slides.eps, slides.needs
    fast_slides = slides.fast_slides
    output = np.full((eps.size, ts.size), -1)
    # Beside fast slides brackets of a few wells each lead to the times.
    chained = [c for c in range(eps.size) if summed or not fast_slides[c]]
    # Guides of long segments are coarse, which counts in sums only: long lanes need no
    # stops.
    stopped = [c for c in chained if summed or np.isfinite(needs.tile[c])]
    lattice_cell, lattice_time = _lattice(slides, parts, stopped)
    edges = np.concatenate([path.edges[1:], path.touch[path.touch < path.edges[-1]]])
    steep = np.unique(path.probes.times[uneven_pieces(path)])
    apart = np.diff(steep, prepend=-np.inf) > SETTINGS.apart * path.edges[-1]
    fixed = np.unique(np.concatenate([edges, ts, steep[apart]]))
    cuts = [
        _cut(parts, cell, fixed, lattice_time[lattice_cell == cell]) for cell in chained
    ]
    if summed:
        cuts = follow_path(path, eps[chained], accuracy, cuts)
    # Of all cells at once: a call each took 0.1 ms.
    times = [t for cut in cuts for t in cut]
    every = path.motion_at(np.concatenate([*times, np.zeros(0)])).ways
    ways = np.split(every, np.cumsum([t.size for t in times]))
    chain = [np.zeros(0, dtype=int)] * eps.size
    for k, (cell, (opening, stops)) in enumerate(zip(chained, cuts, strict=True)):
        stretch = stretches_of(opening, stops)
        opened, passed = (
            tiles_at(path, needs, at, cell) / eps[cell] for at in ways[2 * k : 2 * k + 2]
        )
        tile = np.floor(passed - opened[stretch] - 1e-9)
        tile += _on_slides(fast_slides[cell], stops)
        tile += np.searchsorted(path.edges[1:][needs.restarts[cell]], stops)
        begins = stops > opening[stretch]
        stops, stretch, tile = stops[begins], stretch[begins], tile[begins]
        first, sizes = _tiles(stretch, tile)
        fresh = np.diff(stretch[first], prepend=-1) != 0
        begin = np.where(fresh, opening[stretch[first]], stops[first - 1])
        if not summed:
            shown = np.logical_or.reduceat(np.isin(stops, ts), first)
            stops = stops[np.repeat(shown, sizes)]
            begin, sizes = begin[shown], sizes[shown]
        whose = np.full(sizes.size, cell)
        chain[cell] = rows.add(whose, begin, False, stops, sizes)
        which = np.searchsorted(stops, ts)
        hit = np.append(stops, np.nan)[which] == ts
        output[cell, hit] = chain[cell][which[hit]]
    return Chains(chain, output)


def _lattice(slides: CellSlides, parts: Parts, chosen: list[int]):
    """Cell and time of each segment's end on slides of cells, outside inner parts."""
    path, eps = slides.path, slides.eps
    lows, highs = (slides.path.states_at(times) for times in (parts.low, parts.high))
    cells, pieces, wells = [], [], []
    for cell in chosen:
        segment = float(slides.needs.leg[cell])
        of_cell = parts.cell == cell
        for piece in np.flatnonzero(path.direction).tolist():
            way = abs(path.states[piece + 1] - path.states[piece]) / eps[cell]
            way -= slides.needs.lattice_offset[cell, piece]
            mine = of_cell & (parts.low < path.edges[piece + 1])
            mine &= parts.high > path.touch[piece]
            origin = path.states[piece]
            edges = (path.states[piece], path.states[piece + 1])
            low, high = (
                np.abs(np.clip(side[mine], min(edges), max(edges)) - origin) / eps[cell]
                for side in (lows, highs)
            )
            at = _outside(segment, way, low, high)
            cells.append(np.full(at.size, cell))
            pieces.append(np.full(at.size, piece))
            wells.append(at)
    if not cells:
        return np.zeros(0, dtype=int), np.zeros(0)
    whose = np.concatenate(cells)
    return whose, slides.times_at_wells(
        whose, np.concatenate(pieces), np.concatenate(wells)
    )


def _outside(segment: float, way: float, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Wells of a slide at which segments end: none inside its inner parts, in wells too."""
    if low.size == 0:
        return np.arange(segment, way, segment)
    order = np.argsort(low)
    opens = np.concatenate([[0.0], high[order]])
    closes = np.concatenate([low[order], [way]])
    gaps = [
        np.arange(np.ceil(a) + segment, b - 0.5, segment)
        for a, b in zip(opens, closes, strict=True)
    ]
    return np.concatenate(gaps)


def _cut(parts: Parts, cell: int, fixed: np.ndarray, lattice: np.ndarray) -> Cut:
    """A cell's chain. Inner parts are left out: a stretch begins where one ends."""
    mine = np.flatnonzero(parts.cell == cell)
    mine = mine[np.argsort(parts.low[mine])]
    low, high = parts.low[mine], parts.high[mine]
    # Where one hole follows another there is nothing to be measured between.
    stops = np.unique(np.concatenate([fixed, lattice, low[~np.isin(low, high)]]))
    hole = np.searchsorted(low, stops) - 1  # of those that begin before
    inside = (hole >= 0) & (stops < np.append(high, 0.0)[hole])
    stops = stops[~inside & (stops > 0)]
    return Cut(np.concatenate([[0.0], high]), stops)


def _tiles(stretch: np.ndarray, tile: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First stops of brackets, each of one stretch and one tile of it, and how many."""
    cut = (np.diff(stretch) != 0) | (np.diff(tile) > 0)
    first = np.flatnonzero(np.append(stretch.size > 0, cut))
    return first, np.diff(first, append=stretch.size)


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
