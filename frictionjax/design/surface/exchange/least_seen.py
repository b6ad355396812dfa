"""The least bent surface whose slopes seen have wanted extremes, over all surfaces.

What is seen of each wave may differ (`SeenSlopes`): the kernel is `k(y) = sum_n 2 |c_n|^2
cos(2 pi n y)/(2 pi n)^2`, whose lowest place need not be half a period. Let P = max v of
the slopes v seen be at 0, -M = min v at s.

With P >= M (else the surface is turned over):

- Where the shortest waves with v(0) = P and -M <= v <= P reach -M, they are the optimum, of
  a convex problem: a least-distance problem, with rows added where the range is left.
- Else v(s) = -M has to be asked for too. Without the range that costs `(k0 (P^2 + M^2) +
  2 k(s) P M)/(k0^2 - k(s)^2)`, a lower bound. Places s are tried from the lowest bound on,
  until that of the next is above what was found: no other place is better (branch and
  bound). Then the best one is searched between its neighbours.
"""

from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from .seen_slopes import SeenSlopes, bumps, with_ends_seen
from .settings import SETTINGS
from .shortest import least_distance


class LeastBent(NamedTuple):
    """Waves turned, and a lower bound of `int v'^2` of all with these slopes."""

    waves: Float[np.ndarray, " waves"]
    bound: float


def least_bent_seen(seen: SeenSlopes, ends: Any) -> LeastBent | None:
    """Of slopes between (P, M) = `ends`; None where no surface is seen to have these."""
    plus, minus = ends
    if plus < minus:
        found = least_bent_seen(seen, (minus, plus))
        return None if found is None else found._replace(waves=-found.waves)
    rows = seen.grid(SETTINGS.rows_seen)
    waves = _within(seen, ends, None, rows)
    if waves is None:
        return None
    if np.min(rows @ waves) <= -minus * (1 - SETTINGS.reached):
        return _exactly(seen, ends, None, rows)
    place = _best_place(seen, ends, rows)
    return None if place is None else _exactly(seen, ends, place, rows)


def _best_place(seen: SeenSlopes, ends: Any, rows: np.ndarray) -> float | None:
    """Where the lowest slope is best, in periods from the highest."""
    count = len(rows)
    places = np.arange(1, count // 2 + 1) / count  # k is even
    bounds = _free_energies(seen, ends, places)
    best, where = np.inf, None
    for index in np.argsort(bounds):
        if bounds[index] >= best:
            break
        waves = _within(seen, ends, places[index], rows)
        if waves is not None and waves @ waves < best:
            best, where = float(waves @ waves), places[index]
    return None if where is None else _searched(seen, ends, where, best, rows)


def _free_energies(seen: SeenSlopes, ends: Any, places: np.ndarray) -> np.ndarray:
    plus, minus = ends
    top = seen.at(0.0)
    own, cross = top @ top, seen.at(places) @ top
    determinant = own**2 - cross**2
    # v(s) = -v(0), whatever v is.
    alone = determinant <= SETTINGS.impossible * own**2
    energies = own * (plus**2 + minus**2) + 2 * cross * plus * minus
    return np.where(alone, plus**2 / own, energies / np.where(alone, 1.0, determinant))


def _within(
    seen: SeenSlopes, ends: Any, place: float | None, rows: np.ndarray
) -> np.ndarray | None:
    """The shortest waves with P at 0, -M at the place, if any, and the range on rows."""
    plus, minus = ends
    fixed, least = seen.at(np.zeros(1)), [plus]
    if place is not None:
        fixed, least = np.concatenate([fixed, -seen.at([place])]), [plus, minus]
    inside = np.full(len(rows), -plus), np.full(len(rows), -minus)
    stacked = np.concatenate([fixed, -rows, rows])
    return least_distance(stacked, np.concatenate([least, *inside]))


def _searched(
    seen: SeenSlopes, ends: Any, place: float, known: float, rows: np.ndarray
) -> float:
    """The best place next to one with a known energy."""
    from scipy.optimize import minimize_scalar

    def energy(at: float) -> float:
        waves = _within(seen, ends, at, rows)
        return 2 * known if waves is None else float(waves @ waves)

    width = 1 / len(rows)
    near = place - width, place + width
    options = {"xatol": SETTINGS.place * width}
    found = minimize_scalar(energy, bounds=near, method="bounded", options=options)
    return float(found.x) if found.fun < known else place


def _exactly(
    seen: SeenSlopes, ends: Any, place: float | None, rows: np.ndarray
) -> LeastBent | None:
    """Rows added where the range is left, then both ends to rounding."""
    waves, over = _within(seen, ends, place, rows), SETTINGS.over * np.sum(ends)
    if waves is None:
        return None
    for _ in range(SETTINGS.additions):
        places, slopes = bumps(seen, waves)
        out = np.maximum(slopes - ends[0], -ends[1] - slopes) > over
        if not np.any(out):
            break
        rows = np.concatenate([rows, seen.at(places[out])])
        more = _within(seen, ends, place, rows)
        if more is None:  # no series, or rows so near to each other that none is found
            break
        waves = more
    bound = float(waves @ waves)
    return LeastBent(with_ends_seen(seen, waves, ends), bound)
