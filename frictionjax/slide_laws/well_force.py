"""The force that holds the tip back on its way through a well, in one direction."""

from typing import NamedTuple

import numpy as np

from .second_tops import with_second_tops
from .settings import SETTINGS

_FORCES = np.log(np.geomspace(*SETTINGS.passage_forces))  # of passage times


class WellForce(NamedTuple):
    """Distance of W' from its extreme, over one period around it.

    `place`: Y - Y* in the direction of motion, from -1/2 to 1/2 about, shape (n,);
    `gap` = rho - W' in N, > 0 but at the top, where `place` is 0. `shift`: Q'(0; Y*) in
    N/m, by which rho changes with eps. `flatness`: p of `gap ~ |Y - Y*|^p`, infinite on a
    straight flank. `rho`, `range`: max W' and max W' - min W' in N. `log_times`: logarithm
    of `int dY/(f + gap)` at `log_forces`.
    """

    place: np.ndarray
    gap: np.ndarray
    shift: float
    flatness: float
    rho: float
    range: float
    log_forces: np.ndarray
    log_times: np.ndarray


def well_force(
    phase: np.ndarray, force: np.ndarray, change: np.ndarray, sign: int
) -> WellForce:
    """Of motion to the right (`sign` = 1) or to the left (-1), from a table of a period.

    Below what rounding leaves of `rho - W'` the power law of the top is continued.
    """
    held = sign * force
    top = _top(phase, held)
    place = sign * (phase - phase[top])
    place = place - np.floor(place + 0.5)
    order = np.argsort(place)
    place, others = with_second_tops(place[order], held[order])
    gap = held[top] - others
    width = float(gap.max())
    gap = np.maximum(gap, SETTINGS.no_gap * width)  # of a second top of the same height
    left, right = (_side(sign * place, gap, width) for sign in (-1, 1))
    flatness = _flatness(left.power, right.power)
    place = np.concatenate([-left.place[::-1], [0.0], right.place])
    gap = np.concatenate(
        [left.gap[::-1], [min(left.gap[0], right.gap[0]) * 1e-3], right.gap]
    )
    place, gap = np.append(place, place[0] + 1.0), np.append(gap, gap[0])
    log_forces = _FORCES + np.log(width)
    return WellForce(
        place=place,
        gap=gap,
        shift=float(sign * change[top]),
        flatness=flatness,
        rho=float(held[top]),
        range=width,
        log_forces=log_forces,
        log_times=np.log(passage_time(place, gap, np.exp(log_forces))),
    )


def _top(phase: np.ndarray, held: np.ndarray) -> int:
    """Index of the top; of a straight flank that is long, of its middle.

    From the end of a flank longer than half a period a side would see nothing else.
    """
    top = int(np.argmax(held))
    level = held >= held[top] - SETTINGS.reliable * np.ptp(held)
    ahead = np.argsort((phase - phase[top]) % 1.0)
    down = np.flatnonzero(~level[ahead])
    run = np.concatenate([ahead[down[-1] + 1 :], ahead[: down[0]]])
    way = (phase[run] - phase[run[0]]) % 1.0
    if way[-1] < SETTINGS.long_flank:
        return top
    return int(run[np.argmin(np.abs(way - 0.5 * way[-1]))])


class _Side(NamedTuple):
    """One side of the top: distances from it that grow, gaps, the power between them."""

    place: np.ndarray
    gap: np.ndarray
    power: float


def _side(place: np.ndarray, gap: np.ndarray, width: float) -> _Side:
    beyond = place > 0
    order = np.argsort(place[beyond])
    place, gap = place[beyond][order], gap[beyond][order]
    least = SETTINGS.reliable * width
    known = np.flatnonzero(gap > least)
    first = int(known[0])
    near = place[first:] <= SETTINGS.decade * place[first]
    near[:4] = True
    near = np.flatnonzero(near) + first
    flat = place[first] > 0.5 / SETTINGS.decade or np.any(gap[near] <= least)
    power = np.inf
    if not flat:
        power = float(np.polyfit(np.log(place[near]), np.log(gap[near]), 1)[0])
    straight = not np.isfinite(power) or power > SETTINGS.flattest
    # A flank ends at its last place, not at the first beyond it: nodes are far apart there.
    flank = straight and first > 0
    end = place[first - 1] if flank else place[first]
    place, gap = place[first:], gap[first:]
    inner = np.geomspace(SETTINGS.nearest_node, end, SETTINGS.gap_nodes, endpoint=flank)
    if straight:
        inner_gap = np.full(SETTINGS.gap_nodes, SETTINGS.no_gap * width)
    else:
        inner_gap = gap[0] * (inner / place[0]) ** power
    return _Side(np.append(inner, place), np.append(inner_gap, gap), power)


def _flatness(left: float, right: float) -> float:
    """p of a top whose sides have these powers: the flatter one decides."""
    power = max(left, right)
    if not np.isfinite(power) or power > SETTINGS.flattest:
        return np.inf
    whole = 2.0 * round(0.5 * power)
    return whole if abs(power - whole) < SETTINGS.whole else power


def passage_time(place: np.ndarray, gap: np.ndarray, force: np.ndarray) -> np.ndarray:
    """`int_0^1 dY/(f + gap)` at each f of `force`, any shape; gaps linear between nodes."""
    low = force[..., None] + gap
    rise = np.diff(low, axis=-1) / low[..., :-1]
    steady = np.abs(rise) < 1e-6
    share = np.where(steady, 1 - 0.5 * rise, np.log1p(rise) / np.where(steady, 1.0, rise))
    return np.sum(np.diff(place) / low[..., :-1] * share, axis=-1)


def gap_at(well: WellForce, place: np.ndarray) -> np.ndarray:
    """`rho - W'` at any places of the period: powers of the distance between nodes."""
    found = np.empty(place.shape)
    for sign in (1, -1):
        side = sign * well.place > 0
        order = np.argsort(sign * well.place[side])
        far = np.log((sign * well.place[side])[order])
        gaps = np.log(well.gap[side][order])
        asked = sign * place >= 0
        distance = np.log(np.maximum(np.abs(place[asked]), 1e-300))
        found[asked] = np.exp(np.interp(distance, far, gaps))
    return found
