"""The parts of slides of which only some periods are measured, and which periods."""

from typing import NamedTuple

import numpy as np

from ...model import Scene
from ..limit_path import SETTINGS as PATH_SETTINGS
from ..limit_path import (
    Path,
    nodes_inside,
    nodes_of,
    probes_of,
    speeds_at,
    states_at,
    strictly_between,
    times_at,
    unseen_of,
)
from .requirements import Requirements, inner_wells
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


def level_at(
    path: Path, eps: np.ndarray, needs: Requirements, cell, piece, well
) -> np.ndarray:
    """The path's state in m at a lattice point of a slide."""
    way = (well + needs.lattice_offset[cell, piece]) * eps[cell]
    return path.states[piece] + path.direction[piece] * way


def _path_parts(scene: Scene, path: Path, eps, needs: Requirements, fast_slides) -> Parts:
    """Inner parts of slides that are known from brackets: all but the fast ones."""
    ways = np.abs(np.diff(path.states))[None, :] / eps[:, None]
    inner = inner_wells(ways, needs)
    for c in range(eps.size):
        inner[c, [slide.piece for slide in fast_slides[c]]] = 0.0
    cell, piece = np.nonzero(inner)
    first = np.ceil(needs.transient)[cell]
    last = first + inner[cell, piece]
    nodes = needs.samples[cell]
    return _between(scene, path, eps, needs, cell, piece, first, last, nodes)


def _between(
    scene, path, eps, needs: Requirements, cell, piece, first, last, nodes
) -> Parts:
    """Parts between wells of the path."""
    levels = [level_at(path, eps, needs, cell, piece, well) for well in (first, last)]
    both = times_at(scene, path, np.tile(piece, 2), np.concatenate(levels))
    low, high = np.split(both, 2)
    none = np.full(cell.size, -1)
    return Parts(cell, piece, first, last, low, high, none, nodes)


def _fast_parts(needs: Requirements, fast_slides: np.ndarray) -> list[tuple]:
    """Each panel of a fast slide that is long enough to be known from some of its wells."""
    rows = []
    for c in range(needs.samples.size):
        # Panels hold times that are polynomials already: half the nodes do.
        count = needs.samples[c] // 2 + 1
        for index, slide in enumerate(fast_slides[c] if needs.samples[c] > 0 else ()):
            edges, starts = slide.curve.edges, slide.curve.starts
            for k in np.flatnonzero(np.diff(edges) > SETTINGS.sparse * count):
                span = edges[k], edges[k + 1], starts[k], starts[k + 1]
                rows.append((c, slide.piece, *span, index, count))
    return rows


def _rests_of_slides(
    scene: Scene, path: Path, eps, needs: Requirements, fast_slides
) -> list[tuple]:
    """Where fast slides turn slow: the path's wells from there on."""
    cells = [c for c in range(eps.size) if needs.samples[c] > 0]
    last = [(c, slide) for c in cells for slide in _last_of_pieces(path, fast_slides[c])]
    ends = np.array([slide.end for _, slide in last])
    rows = []
    for (c, slide), at in zip(last, states_at(scene, path, ends), strict=True):
        piece = slide.piece
        way = abs(path.states[piece + 1] - path.states[piece]) / eps[c]
        first = np.ceil(abs(at - path.states[piece]) / eps[c]) + SETTINGS.tail
        past = np.floor(way - needs.lattice_offset[c, piece]) - SETTINGS.tail
        if (
            slide.end > path.touch[piece]
            and past - first > SETTINGS.sparse_behind * needs.samples[c]
        ):
            # Slides turn from fast to slow there: 17 nodes leave 6e-4 eps. Chebyshev's
            # points less than a well apart mean nothing: 129 in 3800 wells left 6e3 m.
            most = max(SETTINGS.dense * np.sqrt(past - first), 2 * SETTINGS.least_nodes)
            rows.append((c, piece, first, past, int(min(2 * needs.samples[c], most))))
    return rows


def _last_of_pieces(path: Path, fast_slides: tuple) -> list:
    """The last fast slide of each piece, where it goes the piece's way."""
    last = {slide.piece: slide for slide in fast_slides}
    return [r for r in last.values() if path.direction[r.piece] == r.sign]


def inner_parts(
    scene: Scene, path: Path, eps, needs: Requirements, fast_slides: np.ndarray
) -> Parts:
    """All inner parts; on other slides none hides a fast stretch between nodes.

    (Fast slides are known from panels that follow the slide wherever they are fast.)
    """
    parts = [_path_parts(scene, path, eps, needs, fast_slides)]
    fast = _fast_parts(needs, fast_slides)
    if fast:
        parts.append(Parts(*(np.array(column) for column in zip(*fast, strict=True))))
    rest = _rests_of_slides(scene, path, eps, needs, fast_slides)
    if rest:
        columns = (np.array(column) for column in zip(*rest, strict=True))
        parts.append(_between(scene, path, eps, needs, *columns))
    every = _joined(parts)
    uneven = uneven_pieces(path)[every.piece] & (every.fast < 0)
    if not uneven.any():
        return every
    even = [_chosen(every, ~uneven)]
    return _joined(even + _graded(scene, path, eps, needs, _chosen(every, uneven)))


def uneven_pieces(path: Path) -> np.ndarray:
    """Pieces on which the path speeds up and slows down between a few nodes, (P,)."""
    return path.probes.unseen > SETTINGS.even


def _joined(parts: list[Parts]) -> Parts:
    return Parts(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def _chosen(parts: Parts, which: np.ndarray) -> Parts:
    return Parts(*(column[which] for column in parts))


def _graded(scene: Scene, path: Path, eps, needs: Requirements, some: Parts) -> list[Parts]:
    """Parts halved until their nodes see the path's speed; short ones are left out.

    A load that rises by 0.04 N within 6 ms of 3 s was stepped over by all 17 nodes, and
    the largest deviation was a twelfth of what it is there. Where the speed of a part is a
    multiple elsewhere, its nodes in time are less than a well apart: beside a burst within
    0.2 ms, suprema were 6% off, and twice as large in other scenes.
    """
    done = []
    for _ in range(SETTINGS.part_halvings):
        some = _chosen(some, some.last - some.first > SETTINGS.sparse * some.nodes)
        if some.cell.size == 0:
            break
        known = _is_known(scene, path, some)
        done.append(_chosen(some, known))
        left = _chosen(some, ~known)
        middle = np.floor(0.5 * (left.first + left.last))
        first = np.concatenate([left.first, middle])
        last = np.concatenate([middle, left.last])
        cell, piece, nodes = (np.tile(c, 2) for c in (left.cell, left.piece, left.nodes))
        some = _between(scene, path, eps, needs, cell, piece, first, last, nodes)
    return done


def _is_known(scene: Scene, path: Path, some: Parts) -> np.ndarray:
    """Whether nodes of each part see the path's speed, which is much the same there."""
    ends = some.low, some.high
    nodes = speeds_at(scene, path, nodes_inside(*ends))
    own = probes_of(scene, path, *ends, PATH_SETTINGS.fewer_samples)
    times = np.concatenate([own, path.probes.times[some.piece]], axis=1)
    probes = [speeds_at(scene, path, own), path.probes.speeds[some.piece]]
    speeds = np.concatenate(probes, axis=1)
    unseen = unseen_of(*ends, nodes, times, speeds)
    inside = strictly_between(*ends, times)
    sizes = np.abs(np.concatenate([nodes, np.where(inside, speeds, nodes[:, :1])], axis=1))
    return (unseen <= SETTINGS.even) & (
        sizes.max(axis=1) <= SETTINGS.steady * sizes.min(axis=1)
    )


def sampled(
    scene: Scene,
    path: Path,
    eps,
    needs: Requirements,
    parts: Parts,
    fast_slides: np.ndarray,
):
    """Wells whose passage is measured in each inner part, and times before and after."""
    wells, owner = [], []
    nodes = [
        nodes_of(float(low), float(high), int(count))
        for count, low, high in zip(parts.nodes, parts.low, parts.high, strict=True)
    ]
    states = states_at(scene, path, np.concatenate([*nodes, np.zeros(0)]))
    cuts = np.cumsum([times.size for times in nodes])
    for i, here in enumerate(np.split(states, cuts)[:-1] if nodes else []):
        if parts.fast[i] >= 0:
            at = fast_slides[parts.cell[i]][parts.fast[i]].curve.number_at(nodes[i])
        else:
            own, slide = parts.cell[i], parts.piece[i]
            way = np.abs(here - path.states[slide])
            at = way / eps[own] - needs.lattice_offset[own, slide]
        at = np.clip(np.round(at), parts.first[i], parts.last[i] - 1)
        wells.append(np.unique(at))
        owner.append(np.full(wells[-1].size, i))
    if not wells:
        empty = np.zeros(0)
        return empty.astype(int), empty, empty
    at, who = np.concatenate(wells), np.concatenate(owner)
    start, end = np.empty(at.size), np.empty(at.size)
    plain = np.flatnonzero(parts.fast[who] < 0)
    cell, piece = parts.cell[who[plain]], parts.piece[who[plain]]
    levels = [level_at(path, eps, needs, cell, piece, at[plain] + k) for k in (0, 1)]
    both = times_at(scene, path, np.tile(piece, 2), np.concatenate(levels))
    start[plain], end[plain] = np.split(both, 2)
    for i in np.flatnonzero(parts.fast >= 0).tolist():
        mine = np.flatnonzero(who == i)
        curve = fast_slides[parts.cell[i]][parts.fast[i]].curve
        start[mine], end[mine] = curve.time_of(at[mine]), curve.time_of(at[mine] + 1)
    return who, start, end
