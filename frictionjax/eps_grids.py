"""What the accuracy of an order costs: how its interval shrinks with number and range."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from .arguments import require, require_flags, require_real
from .cost_prediction import predict_cost
from .grids import grid_of
from .orders import fit_order
from .scene import Scene, require_scene
from .sweeps import sweep
from .wiggly.status import Status

_PILOT = 48  # eps of the pilot: two seconds a gamma
_TIMES = 2  # suprema are over all of [0, T] whatever times are kept
# Of 4 and 5 the interval is luck: up to three times wider on the next such grid.
_POINTS = (6, 8, 12, 16, 24, 32, 48)
_PARTS = 5  # ends of ranges: fifths of the pilot's
_OFFSETS = (0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75)  # of the distance of two eps


class EpsGrid(NamedTuple):
    """A grid of eps with equal ratios, what it gives and what it costs.

    `half_width`: of the 95% interval of the order of sup_error, the widest of seven such
    grids laid into the pilot; `order`: of the last of them; `seconds`: predicted.
    """

    eps_max: float
    eps_min: float
    points: int
    half_width: float
    order: float
    seconds: float

    @property
    def eps(self) -> np.ndarray:
        """Its eps in m, falling."""
        return np.geomspace(self.eps_max, self.eps_min, self.points)


class OrderCost(NamedTuple):
    """Result of `order_cost`.

    `grids`: all that were looked at, by time; `front`: those that no cheaper one beats;
    `choice`: the cheapest within what was wanted, None where `success` is false.
    """

    grids: list[EpsGrid]
    choice: EpsGrid | None
    success: bool
    message: str

    @property
    def front(self) -> list[EpsGrid]:
        best, kept = np.inf, []
        for grid in self.grids:
            if grid.half_width < best:
                best = grid.half_width
                kept.append(grid)
        return kept


def order_cost(
    scene: Scene,
    eps: Any,
    gamma: float = 1.0,
    within: float = 0.02,
    accuracy: float = 1e-3,
    *,
    measure: bool = True,
) -> OrderCost:
    """Which grid of eps gives the order to +- `within`, and how long that takes.

    `eps` (m): the largest and smallest that come into question, or a list with them. A
    pilot sweep of 48 eps in that range is run, and grids of fewer eps and narrower ranges
    are laid into it, each seven times with other phases; the interval is the one that
    `study` would give, drift and scatter included. (A formula, scatter over the spread of
    log eps: three times too narrow where the order still drifts.) Seconds are those of
    `predict_cost`; `measure` as there.

    Raises `ValueError` for arguments out of range, or less than two eps.
    """
    require_scene(scene)
    known = grid_of("eps", eps)
    require(known.size >= 2, "eps", known, "a largest and a smallest")
    require_real("within", within, "within > 0", lambda w: w > 0)
    require_flags(measure=measure)
    require_real("gamma", gamma, "gamma > 0, one number", lambda g: g > 0)
    pilot = np.geomspace(known[0], known[-1], _PILOT)
    ts = float(scene.duration) * np.linspace(0, 1, _TIMES)
    data = sweep(scene, pilot, gamma, ts, accuracy, dissipation=False).isel(gamma=0)
    errors = data.sup_error.where(data.status == int(Status.OK)).values
    grids = []
    for start, stop, points in _candidates():
        half, order = _interval(pilot, errors, accuracy, start, stop, points)
        grid = EpsGrid(float(pilot[start]), float(pilot[stop]), points, half, order, 0.0)
        if np.isfinite(half):
            cost = predict_cost(scene, grid.eps, gamma, accuracy, ts, measure=measure)
            grids.append(grid._replace(seconds=cost.seconds))
    grids.sort(key=lambda grid: (grid.seconds, grid.half_width))
    return _chosen(grids, float(within))


def _candidates() -> Iterator[tuple[int, int, int]]:
    """First and last place in the pilot, and how many eps."""
    ends = np.linspace(0, _PILOT - 1, _PARTS + 1).round().astype(int).tolist()
    for i, start in enumerate(ends):
        for stop in ends[i + 1 :]:
            for points in _POINTS:
                if points <= stop - start + 1:
                    yield start, stop, points


def _interval(pilot, errors, accuracy, start, stop, points) -> tuple[float, float]:
    """Widest half interval of the order over the phases, and an order."""
    spacing = (stop - start) / (points - 1)
    widest, order = 0.0, float("nan")
    for offset in _OFFSETS:
        # Shifted grids stay in the range: their ends move inwards by half a distance.
        shift = (offset - np.mean(_OFFSETS)) * spacing
        places = np.linspace(start, stop, points) + shift
        chosen = np.unique(np.clip(places.round().astype(int), start, stop))
        fit = fit_order(pilot[chosen], errors[chosen], accuracy * pilot[chosen])
        half = 0.5 * (fit.high - fit.low)
        widest = max(widest, half) if np.isfinite(half) else float("inf")
        order = fit.order if np.isfinite(fit.order) else order
    return widest, order


def _chosen(grids: list[EpsGrid], within: float) -> OrderCost:
    good = [grid for grid in grids if grid.half_width <= within]
    if good:
        found = good[0]
        message = (
            f"the order to +-{within:g} from {found.points} eps, {found.eps_max:.3g} to "
            f"{found.eps_min:.3g} m: {found.seconds:.2g} s"
        )
        return OrderCost(grids, found, True, message)
    if not grids:
        return OrderCost(grids, None, False, "no grid in this range gives an order")
    best = min(grids, key=lambda grid: grid.half_width)
    message = (
        f"no grid in this range gives the order to +-{within:g}; the best, {best.points} "
        f"eps from {best.eps_max:.3g} to {best.eps_min:.3g} m, to +-{best.half_width:.2g}"
    )
    return OrderCost(grids, None, False, message)
