"""The least bent surface within bounds on its curvature and height, by exchange.

With the place of the lowest slope fixed this is a shortest vector within linear bounds: a
height `max w - min w` is one for each pair of places. Rows and pairs are added where the
surface leaves its bounds. Unlike rows of a barrier these leave no margin: what the steepest
surface reaches is met.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from ..barrier import basis_at
from .settings import SETTINGS
from .shortest import least_distance
from .steepest import BoundRows, SurfaceBounds, extrema, first_rows, scanned_places


class BentSurface(NamedTuple):
    """`waves`, the `place` of the lowest slope; `bound`: of `int v'^2` with it there."""

    waves: Float[np.ndarray, " waves"]
    place: float
    bound: float


class _Held(NamedTuple):
    """Rows of slopes and curvatures, and pairs of places (n, 2), the second one lower."""

    rows: BoundRows
    pairs: np.ndarray


def least_bent_within(
    bounds: SurfaceBounds, place: float | None = None
) -> BentSurface | None:
    """The least bent over places that a scan looks at, or with the one given.

    None where none is found: next to the steepest surface there is hardly another one.
    """
    places = scanned_places(bounds.harmonics) if place is None else np.array([place])
    best: BentSurface | None = None
    for at in places[::-1]:
        found = _at_place(bounds, float(at), np.inf if best is None else _energy(best))
        best = best if found is None else found
    return best


def _energy(found: BentSurface) -> float:
    return float(found.waves @ found.waves)


def _at_place(bounds: SurfaceBounds, place: float, less: float) -> BentSurface | None:
    """Rows added until the bounds hold, as long as the energy may be less than that."""
    inside = bounds._replace(
        curvature=bounds.curvature * (1 - SETTINGS.inside),
        height=bounds.height * (1 - SETTINGS.inside),
    )
    held = _Held(first_rows(bounds), np.zeros((0, 2)))
    for _ in range(SETTINGS.additions):
        waves = _shortest(inside, place, held)
        if waves is None or waves @ waves >= less:
            return None
        more = _with_left(inside, waves, held)
        if more is None:
            return BentSurface(waves, place, _bound(bounds, place, held))
        held = more
    return None


def _bound(bounds: SurfaceBounds, place: float, held: _Held) -> float:
    """Without the margin, with a part of the rows: no more than any surface has."""
    waves = _shortest(bounds, place, held)
    return 0.0 if waves is None else float(waves @ waves)


def _shortest(bounds: SurfaceBounds, place: float, held: _Held) -> np.ndarray | None:
    """The shortest waves with both slopes at their places, the bounds held on rows."""
    count = bounds.harmonics
    slopes = basis_at(held.rows.slopes, count)
    top, bottom = basis_at(np.array([0.0, place]), count)
    bends = basis_at(held.rows.curvatures, count, 1)
    ways = basis_at(held.pairs[:, 1], count, -1) - basis_at(held.pairs[:, 0], count, -1)
    blocks = (
        (top[None], bounds.plus),
        (-bottom[None], bounds.minus),
        (-slopes, -bounds.plus),
        (slopes, -bounds.minus),
        (-bends, -bounds.curvature),
        (bends, -bounds.curvature),
        (ways, -bounds.height),
    )
    rows = np.concatenate([rows for rows, _ in blocks])
    ends = np.concatenate([np.full(len(rows), end) for rows, end in blocks])
    sizes = np.linalg.norm(rows, axis=1)
    return least_distance(rows / sizes[:, None], ends / sizes)


def _with_left(bounds: SurfaceBounds, waves: np.ndarray, held: _Held) -> _Held | None:
    """Rows and pairs added where a bound is left; None where all hold."""
    slopes, bends, heights = extrema(waves)
    over = SETTINGS.over
    steep = _beyond(slopes, bounds.plus, bounds.minus)
    sharp = _beyond(bends, bounds.curvature, bounds.curvature)
    pairs = _pairs(heights, bounds.height * (1 + over))
    if not (steep.size or sharp.size or pairs.size):
        return None
    rows = held.rows._replace(
        slopes=np.concatenate([held.rows.slopes, steep]),
        curvatures=np.concatenate([held.rows.curvatures, sharp]),
    )
    return _Held(rows, np.concatenate([held.pairs, pairs]))


def _beyond(seen: tuple[np.ndarray, np.ndarray], up: float, down: float) -> np.ndarray:
    places, values = seen
    return places[np.maximum(values / up, -values / down) > 1 + SETTINGS.over]


def _pairs(seen: tuple[np.ndarray, np.ndarray], height: float) -> np.ndarray:
    """Of the highest place and all that are too far below it, and the lowest one."""
    places, values = seen
    above, below = np.argmax(values), np.argmin(values)
    low = places[values < values[above] - height]
    high = places[values > values[below] + height]
    high = high[high != places[above]]  # which is in the first
    first = np.stack([np.full(low.size, places[above]), low], axis=1)
    return np.concatenate([first, np.stack([high, np.full(high.size, places[below])], 1)])
