"""The parts of slides of which only some periods are measured, and which periods."""

from typing import NamedTuple

import numpy as np

from ...numerics import concatenated, rows_of, stacked
from ..limit_path import SETTINGS as PATH_SETTINGS
from ..limit_path import (
    Path,
    nodes_inside,
    nodes_of,
    probes_of,
    strictly_between,
    unseen_of,
)
from .requirements import Requirements, inner_wells, transients
from .settings import SETTINGS


class Parts(NamedTuple):
    """Inner parts of slides: cell, piece, first and last well of the slide, times.

    `fast`: which of the cell's fast slides, with wells counted from its start; -1 where
    wells are those of the path. `nodes`: periods to be measured.
    """

    cell: np.ndarray
    piece: np.ndarray
    first: np.ndarray
    last: np.ndarray
    low: np.ndarray
    high: np.ndarray
    fast: np.ndarray
    nodes: np.ndarray


class CellSlides(NamedTuple):
    """Slides of all cells, shape (cells,) each: those of the path, and the fast ones."""

    path: Path
    eps: np.ndarray
    needs: Requirements
    fast_slides: np.ndarray

    def times_at_wells(self, cell, piece, well) -> np.ndarray:
        """When the path is at lattice points of slides, in s."""
        way = (well + self.needs.lattice_offset[cell, piece]) * self.eps[cell]
        levels = self.path.states[piece] + self.path.direction[piece] * way
        return self.path.times_at(piece, levels)


class _WellRange(NamedTuple):
    """Parts of slides between wells of the path, as in `Parts`."""

    cell: np.ndarray
    piece: np.ndarray
    first: np.ndarray
    last: np.ndarray
    nodes: np.ndarray

    def timed(self, slides: CellSlides) -> Parts:
        """With their times."""
        cell, piece = np.tile(self.cell, 2), np.tile(self.piece, 2)
        ends = np.concatenate([self.first, self.last])
        low, high = np.split(slides.times_at_wells(cell, piece, ends), 2)
        none = np.full(self.cell.size, -1)
        return Parts(low=low, high=high, fast=none, **self._asdict())


def _path_parts(slides: CellSlides) -> Parts:
    """Inner parts of slides that are known from brackets: all but the fast ones."""
    needs = slides.needs
    ways = np.abs(np.diff(slides.path.states))[None, :] / slides.eps[:, None]
    inner = inner_wells(ways, needs)
    for c in range(slides.eps.size):
        inner[c, [slide.piece for slide in slides.fast_slides[c]]] = 0.0
    cell, piece = np.nonzero(inner)
    first = transients(needs)[cell, piece]
    last = first + inner[cell, piece]
    return _WellRange(cell, piece, first, last, needs.samples[cell]).timed(slides)


def _fast_parts(slides: CellSlides) -> list[Parts]:
    """Each panel of a fast slide that is long enough to be known from some of its wells."""
    samples, rows = slides.needs.samples, []
    for c in range(samples.size):
        # Panels hold times that are polynomials already: half the nodes do.
        count = samples[c] // 2 + 1
        for index, slide in enumerate(slides.fast_slides[c] if samples[c] > 0 else ()):
            edges, starts = slide.curve.edges, slide.curve.starts
            for k in np.flatnonzero(np.diff(edges) > SETTINGS.sparse * count):
                part = Parts(
                    cell=np.asarray(c),
                    piece=slide.piece,
                    first=edges[k],
                    last=edges[k + 1],
                    low=starts[k],
                    high=starts[k + 1],
                    fast=np.asarray(index),
                    nodes=count,
                )
                rows.append(part)
    return rows


def _slow_ends(slides: CellSlides) -> list[_WellRange]:
    """Where fast slides turn slow: the path's wells from there on."""
    path, samples = slides.path, slides.needs.samples
    last = [
        (c, slide)
        for c in np.flatnonzero(samples > 0).tolist()
        for slide in _last_of_pieces(path, slides.fast_slides[c])
    ]
    states = slides.path.states_at(np.array([slide.end for _, slide in last]))
    rows = []
    for (c, slide), at in zip(last, states, strict=True):
        piece = slide.piece
        way = abs(path.states[piece + 1] - path.states[piece]) / slides.eps[c]
        first = np.ceil(abs(at - path.states[piece]) / slides.eps[c]) + SETTINGS.tail
        past = np.floor(way - slides.needs.lattice_offset[c, piece]) - SETTINGS.tail
        if (
            slide.end > path.touch[piece]
            and past - first > SETTINGS.sparse_behind * samples[c]
        ):
            # Slides turn from fast to slow there: 17 nodes leave 6e-4 eps. Chebyshev's
            # points less than a well apart mean nothing: 129 in 3800 wells left 6e3 m.
            most = max(SETTINGS.dense * np.sqrt(past - first), 2 * SETTINGS.least_nodes)
            nodes = np.minimum(2 * samples[c], most).astype(int)
            rows.append(_WellRange(np.asarray(c), piece, first, past, nodes))
    return rows


def _last_of_pieces(path: Path, fast_slides: tuple) -> list:
    """The last fast slide of each piece, where it goes the piece's way."""
    last = {slide.piece: slide for slide in fast_slides}
    return [r for r in last.values() if path.direction[r.piece] == r.sign]


def inner_parts(slides: CellSlides) -> Parts:
    """All inner parts; on other slides none hides a fast stretch between nodes.

    (Fast slides are known from panels that follow the slide wherever they are fast.)
    """
    parts = [_path_parts(slides)]
    if fast := _fast_parts(slides):
        parts.append(stacked(fast))
    if ends := _slow_ends(slides):
        parts.append(stacked(ends).timed(slides))
    every = concatenated(parts)
    uneven = uneven_pieces(slides.path)[every.piece] & (every.fast < 0)
    if not uneven.any():
        return every
    graded = _graded(slides, rows_of(every, uneven))
    return concatenated([rows_of(every, ~uneven), *graded])


def wells_outside(slides: CellSlides, parts: Parts) -> np.ndarray:
    """Wells of the path that inner parts leave, (cells,)."""
    low, high = (slides.path.states_at(times) for times in (parts.low, parts.high))
    inside = np.bincount(parts.cell, np.abs(high - low), slides.eps.size)
    return np.maximum(slides.path.travel[-1] - inside, 0.0) / slides.eps


def uneven_pieces(path: Path) -> np.ndarray:
    """Pieces on which the path speeds up and slows down between a few nodes, (P,)."""
    return path.probes.unseen > SETTINGS.even


def _graded(slides: CellSlides, parts: Parts) -> list[Parts]:
    """Parts halved until their nodes see the path's speed; short ones are left out.

    A load that rises by 0.04 N within 6 ms of 3 s was stepped over by all 17 nodes, and
    the largest deviation was a twelfth of what it is there. Where the speed of a part is a
    multiple elsewhere, its nodes in time are less than a well apart: beside a burst within
    0.2 ms, suprema were 6% off, and twice as large in other scenes.
    """
    done = []
    for _ in range(SETTINGS.part_halvings):
        parts = rows_of(parts, parts.last - parts.first > SETTINGS.sparse * parts.nodes)
        if parts.cell.size == 0:
            break
        even = _is_even(slides.path, parts)
        done.append(rows_of(parts, even))
        left = rows_of(parts, ~even)
        middle = np.floor(0.5 * (left.first + left.last))
        halves = _WellRange(
            cell=np.tile(left.cell, 2),
            piece=np.tile(left.piece, 2),
            first=np.concatenate([left.first, middle]),
            last=np.concatenate([middle, left.last]),
            nodes=np.tile(left.nodes, 2),
        )
        parts = halves.timed(slides)
    return done


def _is_even(path: Path, parts: Parts) -> np.ndarray:
    """Whether nodes of each part see the path's speed, which is much the same there."""
    low, high = parts.low, parts.high
    nodes = path.speeds_at(nodes_inside(low, high))
    own = probes_of(path, low, high, PATH_SETTINGS.fewer_samples)
    times = np.concatenate([own, path.probes.times[parts.piece]], axis=1)
    probes = [path.speeds_at(own), path.probes.speeds[parts.piece]]
    speeds = np.concatenate(probes, axis=1)
    unseen = unseen_of(low, high, nodes, times, speeds)
    inside = strictly_between(low, high, times)
    sizes = np.abs(np.concatenate([nodes, np.where(inside, speeds, nodes[:, :1])], axis=1))
    return (unseen <= SETTINGS.even) & (
        sizes.max(axis=1) <= SETTINGS.steady * sizes.min(axis=1)
    )


def sampled(slides: CellSlides, parts: Parts):
    """Wells whose passage is measured in each inner part, and times before and after."""
    path = slides.path
    wells, owner = [], []
    nodes = [
        nodes_of(float(low), float(high), int(count))
        for count, low, high in zip(parts.nodes, parts.low, parts.high, strict=True)
    ]
    states = slides.path.states_at(np.concatenate([*nodes, np.zeros(0)]))
    cuts = np.cumsum([times.size for times in nodes])
    for i, here in enumerate(np.split(states, cuts)[:-1] if nodes else []):
        cell, piece = parts.cell[i], parts.piece[i]
        if parts.fast[i] >= 0:
            at = slides.fast_slides[cell][parts.fast[i]].curve.number_at(nodes[i])
        else:
            way = np.abs(here - path.states[piece])
            at = way / slides.eps[cell] - slides.needs.lattice_offset[cell, piece]
        at = np.clip(np.round(at), parts.first[i], parts.last[i] - 1)
        wells.append(np.unique(at))
        owner.append(np.full(wells[-1].size, i))
    if not wells:
        empty = np.zeros(0)
        return empty.astype(int), empty, empty
    at, who = np.concatenate(wells), np.concatenate(owner)
    start, end = np.empty(at.size), np.empty(at.size)
    plain = np.flatnonzero(parts.fast[who] < 0)
    cells, pieces = np.tile(parts.cell[who[plain]], 2), np.tile(parts.piece[who[plain]], 2)
    both = np.append(at[plain], at[plain] + 1)
    start[plain], end[plain] = np.split(slides.times_at_wells(cells, pieces, both), 2)
    for i in np.flatnonzero(parts.fast >= 0).tolist():
        mine = np.flatnonzero(who == i)
        curve = slides.fast_slides[parts.cell[i]][parts.fast[i]].curve
        start[mine], end[mine] = curve.time_of(at[mine]), curve.time_of(at[mine] + 1)
    return who, start, end
