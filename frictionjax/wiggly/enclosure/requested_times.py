"""Brackets for requested times that no chain of stops holds."""

import numpy as np

from ..limit_path import Path
from ..slip_map import ManyTransitTimes, last_begun
from .bracket_rows import BracketRows
from .sampled_parts import CellSlides


def stops_at_times(
    slides: CellSlides, ts: np.ndarray, hit: np.ndarray, rows: BracketRows
) -> np.ndarray:
    """The stop at each requested time: one of `hit`, or in a bracket of its own.

    All of shape (cells, n); brackets are added to `rows`.
    """
    cell, shown = np.nonzero((hit < 0) & (ts > 0))
    begin = _period_before(slides, cell, ts[shown])
    begin = _fast_period_before(slides.fast_slides, cell, ts[shown], begin)
    order, sizes = _rests_together(slides.path, cell, ts[shown], begin)
    cell, shown, begin = cell[order], shown[order], begin[order]
    first = np.cumsum(sizes) - sizes
    output = hit.copy()
    paired = ~slides.needs.settles[cell[first]]
    output[cell, shown] = rows.add(cell[first], begin[first], paired, ts[shown], sizes)
    return output


def _rests_together(
    path: Path, cell: np.ndarray, times: np.ndarray, begin: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Times, by their indices, and how many follow each other into one bracket.

    Those of one rest of the path share a bracket, unless the tip still slides there and its
    period has begun before: one bracket of such a rest took 5e6 steps.
    """
    piece = path.piece_of(times)
    sliding = (times > path.touch[piece]) | (begin < times)
    order = np.lexsort((times, piece, cell))
    same = (np.diff(cell[order]) == 0) & (np.diff(piece[order]) == 0)
    cut = ~same | sliding[order[1:]] | sliding[order[:-1]]
    opens = np.flatnonzero(np.append(order.size > 0, cut))
    return order, np.diff(np.append(opens, order.size))


def _period_before(slides: CellSlides, cell, times) -> np.ndarray:
    """Start of the slip period of the path that holds each time."""
    path = slides.path
    piece = path.piece_of(times)
    way = np.abs(slides.path.states_at(times) - path.states[piece])
    offset = slides.needs.lattice_offset[cell, piece]
    well = np.maximum(np.ceil(way / slides.eps[cell] - offset) - 1, 0)
    inside = (path.direction[piece] != 0) & (times > path.touch[piece])
    begin = times.copy()
    slide = np.flatnonzero(inside)
    begin[slide] = slides.times_at_wells(cell[slide], piece[slide], well[slide])
    return np.minimum(begin, times)


def _fast_period_before(fast_slides: np.ndarray, cell, times, begin) -> np.ndarray:
    """Start of the fast slide's period that holds each time; as it was where none does."""
    begun, which = last_begun(fast_slides, cell, times)
    mine = np.flatnonzero(which >= 0)
    if mine.size == 0:
        return begin
    ends = np.array([slide.end for slide in begun])
    mine = mine[times[mine] < ends[which[mine]]]
    curves = ManyTransitTimes([slide.curve for slide in begun])
    number = np.floor(curves.number_at(which[mine], times[mine]))
    begin = begin.copy()
    begin[mine] = np.minimum(curves.time_of(which[mine], number), times[mine])
    return begin
