"""The steepest surface within bounds on its curvature and height, by linear programs.

Of surfaces with `max w' = share P` at 0 and `min w' = -share M` at a place the one with the
largest share. Half a period is not the best place: under a bound on the height slopes are
far apart only with one long wave, and few harmonics round off what curvature allows. By
reflection places up to half a period are all.
"""

from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from ..barrier import ORDERS, basis_at
from ..barrier import SETTINGS as BARRIER_SETTINGS
from .seen_slopes import bumps, plain_slopes, turned
from .settings import SETTINGS


class SurfaceBounds(NamedTuple):
    """What a surface is to have, in units of the slope of the task.

    `plus`, `minus`: slopes (omega_plus, -omega_minus) asked for; `curvature`, `height`: the
    largest allowed, infinite where nothing bounds them.
    """

    harmonics: int
    plus: float
    minus: float
    curvature: float
    height: float


class SteepSurface(NamedTuple):
    """`share` of the slopes asked for; `place`: of the lowest, periods from the highest."""

    share: float
    place: float
    waves: Float[np.ndarray, " waves"]


class BoundRows(NamedTuple):
    """Places in periods where slopes, curvatures and heights are held to their bounds."""

    slopes: np.ndarray
    curvatures: np.ndarray
    heights: np.ndarray


def first_rows(bounds: SurfaceBounds) -> BoundRows:
    """Few, evenly spaced: others are added where a bound is left between them."""
    count = SETTINGS.rows_seen * max(BARRIER_SETTINGS.fewest_waves, bounds.harmonics)
    even, none = np.arange(count) / count, np.zeros(0)
    sharp, high = np.isfinite(bounds.curvature), np.isfinite(bounds.height)
    return BoundRows(even, even if sharp else none, even if high else none)


def extrema(waves: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Places and values of all extrema of slopes, curvatures and heights."""
    harmonics = waves.size // 2
    turns = 2j * np.pi * np.arange(1, harmonics + 1)
    plain = plain_slopes(harmonics)
    return [bumps(plain, turned(waves, turns ** float(order))) for order in ORDERS]


def steepest_surface(bounds: SurfaceBounds) -> SteepSurface | None:
    """The steepest over all places looked at; None where none was found.

    A scan on few rows, then the best of its peaks with rows added until every bound holds.
    It ends early once a share is beyond 1: then the slopes asked for are there.
    """
    rows = first_rows(bounds)
    places = scanned_places(bounds.harmonics)
    shares = np.array([_share(_on_rows(bounds, place, rows)) for place in places])
    around = np.concatenate([[-np.inf], shares, shares[-2:-1]])  # even about the half
    peaks = np.flatnonzero((shares >= around[:-2]) & (shares >= around[2:]))
    best: SteepSurface | None = None
    for index in peaks[np.argsort(-shares[peaks])][: SETTINGS.peaks]:
        if _share(best) >= min(shares[index], SETTINGS.enough):
            break
        best = _around(bounds, places[index], 0.5 / _scanned(bounds.harmonics), best)
    return best


def scanned_places(harmonics: int) -> np.ndarray:
    """Places of the lowest slope, half a period the last.

    Those of Fejer's kernel among them: next to the largest ratio of slopes there are no
    others.
    """
    count = _scanned(harmonics)
    even = 0.5 * np.arange(1, count + 1) / count
    kernel = np.arange(1, harmonics // 2 + 1) / (harmonics + 1)
    return np.union1d(even, kernel)


def _scanned(harmonics: int) -> int:
    return int(np.clip(4 * harmonics, *SETTINGS.scanned))


def _share(found: SteepSurface | None) -> float:
    return -np.inf if found is None else found.share


def _around(
    bounds: SurfaceBounds, place: float, width: float, best: SteepSurface | None
) -> SteepSurface | None:
    """The best place next to one, if it is better than the best before."""
    from scipy.optimize import minimize_scalar

    before = best
    rows, _, best = _exact(bounds, place, first_rows(bounds), best)
    if best is before or _share(best) >= SETTINGS.enough:
        return best

    def less(at: float) -> float:
        nonlocal best, rows
        rows, most, best = _exact(bounds, at, rows, best)
        return -most

    near = place - width, min(place + width, 0.5)
    options = {"xatol": SETTINGS.steepest * width, "maxiter": SETTINGS.steeper_places}
    minimize_scalar(less, bounds=near, method="bounded", options=options)
    return best


def _exact(
    bounds: SurfaceBounds, place: float, rows: BoundRows, best: SteepSurface | None
) -> tuple[BoundRows, float, SteepSurface | None]:
    """Rows added where a bound is left, as long as the share may be more than the best.

    Returns rows, what the share is at most, and the best.
    """
    most = np.inf
    for _ in range(SETTINGS.additions):
        found = _on_rows(bounds, place, rows)
        most = max(_share(found), 0.0)
        if found is None or most <= max(_share(best) * SETTINGS.steeper, SETTINGS.flat):
            break
        over, rows = _with_left(bounds, found, rows)
        if over <= SETTINGS.left:
            less = 1 + max(over, 0.0)
            known = found._replace(share=most / less, waves=found.waves / less)
            best = max((best, known), key=_share)
            break
    return rows, most, best


def _with_left(
    bounds: SurfaceBounds, found: SteepSurface, rows: BoundRows
) -> tuple[float, BoundRows]:
    """How far the surface leaves its bounds, in shares of them, and rows where it does."""
    seen = extrema(found.waves)
    highest = np.max(seen[2][1]), -np.min(seen[2][1])
    span = sum(highest) if rows.heights.size else 1.0
    spare = (bounds.height - span) / 2 if rows.heights.size else 0.0
    ends = (
        (found.share * bounds.plus, found.share * bounds.minus),
        (bounds.curvature, bounds.curvature),
        (highest[0] + spare, highest[1] + spare),
    )
    most, more = -np.inf, []
    for (places, values), (up, down), held in zip(seen, ends, rows, strict=True):
        if not held.size:
            more.append(held)
            continue
        over = np.maximum(values / up, -values / down) - 1
        most = max(most, float(np.max(over)))
        more.append(np.concatenate([held, places[over > SETTINGS.left]]))
    return most, BoundRows(*more)


def _on_rows(bounds: SurfaceBounds, place: float, rows: BoundRows) -> SteepSurface | None:
    """The steepest with its lowest slope there, the bounds held on rows (HiGHS)."""
    from scipy.optimize import linprog  # 0.3 s, for targets that are not met only

    slopes, bends, heights = (
        basis_at(at, bounds.harmonics, order)
        for at, order in zip(rows, ORDERS, strict=True)
    )
    plus, minus = bounds.plus, bounds.minus
    top, bottom = basis_at(np.array([0.0, place]), bounds.harmonics)
    blocks: list[Any] = [  # unknowns: waves, share, above, below
        (slopes, (-plus, 0, 0), 0.0),
        (-slopes, (-minus, 0, 0), 0.0),
        (-top[None], (plus, 0, 0), 0.0),
        (bottom[None], (minus, 0, 0), 0.0),
        (bends, (0, 0, 0), bounds.curvature),
        (-bends, (0, 0, 0), bounds.curvature),
        (heights, (0, -1, 0), 0.0),
        (-heights, (0, 0, -1), 0.0),
    ]
    if rows.heights.size:
        blocks.append((0 * top[None], (0, 1, 1), bounds.height))
    left = [np.hstack([part, np.tile(rest, (len(part), 1))]) for part, rest, _ in blocks]
    right = [np.full(len(part), end) for part, _, end in blocks]
    aim = np.zeros(top.size + 3)
    aim[-3] = -1.0
    exact = dict.fromkeys(_TOLERANCES, SETTINGS.programs)
    parts = aim, np.concatenate(left), np.concatenate(right)
    none: Any = (None, None)
    found = linprog(*parts, bounds=none, method="highs", options=exact)
    if found.status != 0:
        return None
    return SteepSurface(float(-found.fun), float(place), found.x[:-3])


_TOLERANCES = "primal_feasibility_tolerance", "dual_feasibility_tolerance"
