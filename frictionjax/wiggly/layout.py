"""Which stretches of time each cell measures: all of them, or a few periods of slides."""

from typing import NamedTuple

import numpy as np

from ..scene import Scene
from .curve import Curves
from .path import Path, states_at, times_at
from .rides import last_begun
from .survey import nodes_of
from .windows import Windows, way_at

_WELLS_A_LEG = 16
_LEG = 0.02  # of the whole way: the guide is a cubic on each leg
# Wells of a part for each node that is measured in it. On fewer, nodes moved to whole wells
# are no Chebyshev points any more; and behind rides periods still change in shape.
_SPARSE, _FEW = 6, 20
_TAIL = 4  # wells before a turning point that are always measured


class Slide(NamedTuple):
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
    each requested time. `whole`: whether chain and
    slides cover [0, T].
    """

    windows: Windows
    chain: list[np.ndarray]
    slides: list[Slide]
    output: np.ndarray
    whole: bool


class Needs(NamedTuple):
    """What a cell's windows need, in wells, shape (cells,).

    `warm`: from a start to where it is forgotten. `settle`: from the start of a slide to
    where the slide before is forgotten. `tile`: between two cuts of the chain, infinite
    where it is not cut. `nodes`: periods measured in a slide, 0 for all. `offset` (cells,
    pieces): from the start of a slide to its first lattice point, which is half a period
    from the slips of a slow slide: what is measured should not begin in a slip.
    """

    warm: np.ndarray
    settle: np.ndarray
    tile: np.ndarray
    nodes: np.ndarray
    offset: np.ndarray


def wells_of(path: Path, eps: np.ndarray, needs: Needs) -> tuple[np.ndarray, np.ndarray]:
    """Wells of the path in each cell: outside inner parts of slides, and inside."""
    ways = np.abs(np.diff(path.states))[None, :] / eps[:, None]
    inner = _inner_wells(ways, needs)
    return np.sum(ways - inner, axis=1), np.sum(inner, axis=1)


def cost_of(path: Path, eps: np.ndarray, needs: Needs, times: int) -> np.ndarray:
    """Wells that lanes pass through in each cell, about."""
    outer, inner = wells_of(path, eps, needs)
    slides = np.sum(_inner_wells(np.abs(np.diff(path.states)) / eps[:, None], needs) > 0, 1)
    shown = times * inner / np.maximum(inner + outer, 1e-9)
    tiles = outer / needs.tile
    windows = slides * needs.nodes + shown
    # The first tile sets off from the known z0.
    run_ups = 2 * needs.warm * np.maximum(tiles - 1, 0.0)
    return outer + run_ups + 2 * (needs.warm + 2) * windows


def longest_lane(path: Path, eps: np.ndarray, needs: Needs) -> np.ndarray:
    """Wells of a tile and its run-up, at most all of them."""
    return np.minimum(path.travel[-1] / eps, needs.tile + needs.warm)


def wells_a_leg(path: Path, eps: np.ndarray) -> np.ndarray:
    """Wells between two stops of each cell's lanes, where nothing else stops them."""
    span = max(float(path.travel[-1]), 1e-300)
    return np.clip(np.floor(_LEG * span / eps), 1, _WELLS_A_LEG)


def _inner_wells(ways: np.ndarray, needs: Needs) -> np.ndarray:
    """Wells of each slide of which only some are measured, (cells, pieces)."""
    inner = np.floor(ways) - np.ceil(needs.settle)[:, None] - _TAIL - 1
    nodes = needs.nodes[:, None]
    return np.where((nodes > 0) & (inner > 2 * nodes), inner, 0.0)


class _Inner(NamedTuple):
    """Inner parts of slides: cell, piece, first and last well of the slide, times.

    `ride`: which of the cell's, with wells counted from its start; -1 where wells are those
    of the path. `nodes`: periods to be measured.
    """

    cell: np.ndarray
    piece: np.ndarray
    first: np.ndarray
    last: np.ndarray
    low: np.ndarray
    high: np.ndarray
    ride: np.ndarray
    nodes: np.ndarray


def _level(path: Path, eps: np.ndarray, needs: Needs, cell, piece, well) -> np.ndarray:
    """The path's state in m at a lattice point of a slide."""
    way = (well + needs.offset[cell, piece]) * eps[cell]
    return path.states[piece] + path.direction[piece] * way


def _path_parts(scene: Scene, path: Path, eps, needs: Needs, rides) -> _Inner:
    """Inner parts of slides that are known from brackets: all but those with rides."""
    ways = np.abs(np.diff(path.states))[None, :] / eps[:, None]
    inner = _inner_wells(ways, needs)
    for c in range(eps.size):
        inner[c, [ride.piece for ride in rides[c]]] = 0.0
    cell, piece = np.nonzero(inner)
    first = np.ceil(needs.settle)[cell]
    last = first + inner[cell, piece]
    nodes = needs.nodes[cell]
    return _between(scene, path, eps, needs, cell, piece, first, last, nodes)


def _between(scene, path, eps, needs: Needs, cell, piece, first, last, nodes) -> _Inner:
    """Parts between wells of the path."""
    levels = [_level(path, eps, needs, cell, piece, well) for well in (first, last)]
    both = times_at(scene, path, np.tile(piece, 2), np.concatenate(levels))
    low, high = np.split(both, 2)
    none = np.full(cell.size, -1)
    return _Inner(cell, piece, first, last, low, high, none, nodes)


def _ridden_parts(needs: Needs, rides: np.ndarray) -> list[tuple]:
    """Each panel of a ride that is long enough to be known from some of its wells."""
    rows = []
    for c in range(needs.nodes.size):
        # Panels hold times that are polynomials already: half the nodes do.
        count = needs.nodes[c] // 2 + 1
        for index, ride in enumerate(rides[c] if needs.nodes[c] > 0 else ()):
            edges, starts = ride.curve.edges, ride.curve.starts
            for k in np.flatnonzero(np.diff(edges) > _SPARSE * count):
                span = edges[k], edges[k + 1], starts[k], starts[k + 1]
                rows.append((c, ride.piece, *span, index, count))
    return rows


def _rests_of_slides(scene: Scene, path: Path, eps, needs: Needs, rides) -> list[tuple]:
    """Where rides end because slides turn slow: the path's wells from there on."""
    cells = [c for c in range(eps.size) if needs.nodes[c] > 0]
    last = [(c, ride) for c in cells for ride in _last_of_pieces(path, rides[c])]
    ends = np.array([ride.end for _, ride in last])
    rows = []
    for (c, ride), at in zip(last, states_at(scene, path, ends), strict=True):
        piece = ride.piece
        way = abs(path.states[piece + 1] - path.states[piece]) / eps[c]
        first = np.ceil(abs(at - path.states[piece]) / eps[c]) + _TAIL
        past = np.floor(way - needs.offset[c, piece]) - _TAIL
        if ride.end > path.touch[piece] and past - first > _FEW * needs.nodes[c]:
            # Slides turn from fast to slow there: 17 nodes leave 6e-4 eps.
            rows.append((c, piece, first, past, 2 * needs.nodes[c]))
    return rows


def _last_of_pieces(path: Path, rides: tuple) -> list:
    """The last ride of each piece, where it goes the piece's way."""
    last = {ride.piece: ride for ride in rides}
    return [r for r in last.values() if path.direction[r.piece] == r.sign]


def _inner_parts(scene: Scene, path: Path, eps, needs: Needs, rides: np.ndarray) -> _Inner:
    parts = [_path_parts(scene, path, eps, needs, rides)]
    ridden = _ridden_parts(needs, rides)
    if ridden:
        parts.append(_Inner(*(np.array(column) for column in zip(*ridden, strict=True))))
    rest = _rests_of_slides(scene, path, eps, needs, rides)
    if rest:
        columns = (np.array(column) for column in zip(*rest, strict=True))
        parts.append(_between(scene, path, eps, needs, *columns))
    return _Inner(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def _sample(scene: Scene, path: Path, eps, needs: Needs, parts: _Inner, rides: np.ndarray):
    """Wells whose passage is measured in each inner part, and times before and after."""
    wells, owner = [], []
    nodes = [
        nodes_of(float(low), float(high), int(count))
        for count, low, high in zip(parts.nodes, parts.low, parts.high, strict=True)
    ]
    states = states_at(scene, path, np.concatenate([*nodes, np.zeros(0)]))
    cuts = np.cumsum([times.size for times in nodes])
    for i, here in enumerate(np.split(states, cuts)[:-1] if nodes else []):
        if parts.ride[i] >= 0:
            at = rides[parts.cell[i]][parts.ride[i]].curve.number_at(nodes[i])
        else:
            way = np.abs(here - path.states[parts.piece[i]])
            at = way / eps[parts.cell[i]] - needs.offset[parts.cell[i], parts.piece[i]]
        at = np.clip(np.round(at), parts.first[i], parts.last[i] - 1)
        wells.append(np.unique(at))
        owner.append(np.full(wells[-1].size, i))
    if not wells:
        empty = np.zeros(0)
        return empty.astype(int), empty, empty
    at, who = np.concatenate(wells), np.concatenate(owner)
    start, end = np.empty(at.size), np.empty(at.size)
    plain = np.flatnonzero(parts.ride[who] < 0)
    cell, piece = parts.cell[who[plain]], parts.piece[who[plain]]
    levels = [_level(path, eps, needs, cell, piece, at[plain] + k) for k in (0, 1)]
    both = times_at(scene, path, np.tile(piece, 2), np.concatenate(levels))
    start[plain], end[plain] = np.split(both, 2)
    for i in np.flatnonzero(parts.ride >= 0).tolist():
        mine = np.flatnonzero(who == i)
        curve = rides[parts.cell[i]][parts.ride[i]].curve
        start[mine], end[mine] = curve.time_of(at[mine]), curve.time_of(at[mine] + 1)
    return who, start, end


def _lattice(scene: Scene, path: Path, eps, needs: Needs, parts: _Inner, chosen):
    """Cell and time of every leg's end on slides of chosen cells, outside inner parts."""
    legs = wells_a_leg(path, eps)
    lows, highs = (states_at(scene, path, t) for t in (parts.low, parts.high))
    cells, pieces, wells = [], [], []
    for cell in chosen:
        leg = float(legs[cell])
        own = parts.cell == cell
        for slide in np.flatnonzero(path.direction).tolist():
            way = abs(path.states[slide + 1] - path.states[slide]) / eps[cell]
            way -= needs.offset[cell, slide]
            mine = own & (parts.low < path.edges[slide + 1])
            mine &= parts.high > path.touch[slide]
            at = _outside(path, slide, eps[cell], leg, way, lows[mine], highs[mine])
            cells.append(np.full(at.size, cell))
            pieces.append(np.full(at.size, slide))
            wells.append(at)
    if not cells:
        return np.zeros(0, dtype=int), np.zeros(0)
    whose, piece, well = (np.concatenate(a) for a in (cells, pieces, wells))
    return whose, times_at(scene, path, piece, _level(path, eps, needs, whose, piece, well))


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


def _cuts(parts: _Inner, cell: int, fixed: np.ndarray, lattice: np.ndarray):
    """Where a cell's segments open, its stops in the chain, and the segment of each.

    Inner parts are left out: a segment begins where the one before it ends.
    """
    mine = np.flatnonzero(parts.cell == cell)
    mine = mine[np.argsort(parts.low[mine])]
    low, high = parts.low[mine], parts.high[mine]
    # Where one hole follows another there is nothing to be measured between.
    own = np.unique(np.concatenate([fixed, lattice, low[~np.isin(low, high)]]))
    hole = np.searchsorted(low, own) - 1  # of those that begin before
    inside = (hole >= 0) & (own < np.append(high, 0.0)[hole])
    own = own[~inside & (own > 0)]
    opening = np.concatenate([[0.0], high])
    return opening, own, np.searchsorted(opening, own, side="left") - 1


def _tiles(segment: np.ndarray, tile: np.ndarray) -> list[np.ndarray]:
    """Stops of a chain that one window holds: of one segment and one tile of it."""
    cut = (np.diff(segment) != 0) | (np.diff(tile) > 0)
    return np.split(np.arange(segment.size), np.flatnonzero(cut) + 1)


def _on_rides(rides: tuple, times: np.ndarray) -> np.ndarray:
    """Blocks of wells on rides that are passed before each time.

    Tiles end there: lanes set off from rides anywhere, and what waits for the longest tile
    at gamma = 1/4, eps = 1e-8 took 7 s of 9.
    """
    passed = np.zeros(times.size)
    for ride in rides:
        held = np.clip(times, ride.begin, ride.end)
        passed += np.floor(ride.curve.number_at(held) / _WELLS_A_LEG)
    return passed


def lay_out(
    scene: Scene,
    path: Path,
    eps: np.ndarray,
    ts: np.ndarray,
    needs: Needs,
    rides: np.ndarray,
    summed: bool = True,
) -> Layout:
    """Windows that give every requested time, and sums and extremes over [0, T].

    Outside the inner parts of slides everything is measured, in tiles that follow each
    other; inside, some periods, and one window for each requested time. Where nothing is
    `summed`, only windows with requested times are left.
    """
    summed = summed or not np.any(ts > 0)
    parts = _inner_parts(scene, path, eps, needs, rides)
    measured = parts if summed else _Inner(*(column[:0] for column in parts))
    who, node_start, node_end = _sample(scene, path, eps, needs, measured, rides)
    # Beside rides windows of a few wells each lead to the times.
    chained = [c for c in range(eps.size) if summed or not rides[c]]
    lattice_cell, lattice_time = _lattice(scene, path, eps, needs, parts, chained)
    edges = np.concatenate([path.edges[1:], path.touch[path.touch < path.edges[-1]]])
    fixed = np.unique(np.concatenate([edges, ts]))
    rows: list[tuple] = []  # cell, begin, paired, stops
    output = np.full((eps.size, ts.size), -1)
    count = 0
    cuts = [
        _cuts(parts, cell, fixed, lattice_time[lattice_cell == cell]) for cell in chained
    ]
    # Of all cells at once: a call each took 0.1 ms.
    times = [t for opening, own, _ in cuts for t in (opening, own)]
    every = way_at(scene, path, np.concatenate([*times, np.zeros(0)]))
    ways = np.split(every, np.cumsum([t.size for t in times]))
    chain = [np.zeros(0, dtype=int)] * eps.size
    for k, (cell, (opening, own, segment)) in enumerate(zip(chained, cuts, strict=True)):
        since = (ways[2 * k + 1] - ways[2 * k][segment]) / eps[cell]
        tile = np.floor(since / needs.tile[cell] - 1e-9) + _on_rides(rides[cell], own)
        begins = own > opening[segment]
        own, segment, tile = own[begins], segment[begins], tile[begins]
        tiles = _tiles(segment, tile)
        if not summed:
            wanted = np.isin(own, ts)
            tiles = [group for group in tiles if wanted[group].any()]
        for group in tiles:
            first = group[0]
            fresh = first == 0 or segment[first] != segment[first - 1]
            begin = opening[segment[first]] if fresh else own[first - 1]
            rows.append((cell, begin, False, own[group]))
        own = own[np.concatenate([*tiles, np.zeros(0, dtype=int)])]
        chain[cell] = count + np.arange(own.size)
        which = np.searchsorted(own, ts)
        hit = np.append(own, np.nan)[which] == ts
        output[cell, hit] = count + which[hit]
        count += own.size
    slides: list[Slide] = []
    lows, highs = (states_at(scene, path, t) for t in (parts.low, parts.high))
    for i in range(measured.cell.size):
        mine = who == i
        starts, ends = node_start[mine], node_end[mine]
        stops = count + np.arange(starts.size)
        for start, end in zip(starts, ends, strict=True):
            rows.append((parts.cell[i], start, True, np.array([end])))
        where = parts.cell[i], parts.piece[i], parts.low[i], parts.high[i]
        slides.append(Slide(*where, highs[i] - lows[i], starts, ends, stops))
        count += starts.size
    shown_cell, shown = np.nonzero((output < 0) & (ts > 0))
    begin = _period_before(scene, path, eps, needs, shown_cell, ts[shown])
    begin = _ridden_before(rides, shown_cell, ts[shown], begin)
    for group in _rests_together(path, shown_cell, ts[shown]):
        one, index = shown_cell[group[0]], shown[group]
        rows.append((one, begin[group[0]], True, ts[index]))
        output[one, index] = count + np.arange(index.size)
        count += index.size
    return Layout(_windows(rows), chain, slides, output, summed)


def _rests_together(path: Path, cell: np.ndarray, times: np.ndarray) -> list[np.ndarray]:
    """Groups of times, by their indices: those of one rest of the path share a window."""
    piece = path.piece_of(times)
    slides = times > path.touch[piece]
    order = np.lexsort((times, piece, cell))
    same = (np.diff(cell[order]) == 0) & (np.diff(piece[order]) == 0)
    cut = ~same | slides[order[1:]] | slides[order[:-1]]
    return np.split(order, np.flatnonzero(cut) + 1) if order.size else []


def _period_before(scene, path, eps, needs, cell, times) -> np.ndarray:
    """Start of the slip period of the path that holds each time."""
    piece = path.piece_of(times)
    way = np.abs(states_at(scene, path, times) - path.states[piece])
    well = np.maximum(np.ceil(way / eps[cell] - needs.offset[cell, piece]) - 1, 0)
    inside = (path.direction[piece] != 0) & (times > path.touch[piece])
    begin = times.copy()
    slide = np.flatnonzero(inside)
    levels = _level(path, eps, needs, cell[slide], piece[slide], well[slide])
    begin[slide] = times_at(scene, path, piece[slide], levels)
    return np.minimum(begin, times)


def _ridden_before(rides: np.ndarray, cell, times, begin) -> np.ndarray:
    """Start of the ride's slip period that holds each time; as it was where none does."""
    every, which = last_begun(rides, cell, times)
    mine = np.flatnonzero(which >= 0)
    if mine.size == 0:
        return begin
    ends = np.array([ride.end for ride in every])
    mine = mine[times[mine] < ends[which[mine]]]
    curves = Curves([ride.curve for ride in every])
    number = np.floor(curves.number_at(which[mine], times[mine]))
    begin = begin.copy()
    begin[mine] = np.minimum(curves.time_of(which[mine], number), times[mine])
    return begin


def _windows(rows: list[tuple]) -> Windows:
    sizes = [row[3].size for row in rows]
    return Windows(
        cell=np.array([row[0] for row in rows]),
        begin=np.array([row[1] for row in rows]),
        paired=np.array([row[2] for row in rows]),
        owner=np.repeat(np.arange(len(rows)), sizes),
        stop=np.concatenate([row[3] for row in rows]),
    )
