"""What the accuracy of an order costs: how its interval shrinks with number and range."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from .._checks import grid_of, require, require_flags, require_real, with_nan
from .._text import SelfDrawn
from ..convergence import STATE, Fit, fit_with_law
from ..effects import Engine
from ..model import Scene, scene_for
from ..slide_laws import NO_LAW, Law, SlideData, predict_errors
from ..sweeps import sweep
from ..wiggly import Status
from .prediction import predict_cost
from .settings import SETTINGS


class EpsGrid(NamedTuple):
    """A grid of eps with equal ratios, what it gives and what it costs.

    `half_width`: half of the 95% interval of the order of sup_error, the widest of those of
    `laid` different grids of this kind in the pilot; `low`, `high`: ends of all of them;
    `order`: their median; `seconds`: predicted, of `sweep` at its own times. `confirmed`:
    whether grids of the pilot that reach to smaller eps agree with it, or, where the range
    ends, there are none.
    """

    eps_max: float
    eps_min: float
    points: int
    half_width: float
    order: float
    seconds: float
    low: float
    high: float
    laid: int
    confirmed: bool = False

    @property
    def eps(self) -> np.ndarray:
        """Its eps in m, falling."""
        return np.geomspace(self.eps_max, self.eps_min, self.points)


class _Grids(NamedTuple):
    grids: list[EpsGrid]
    choice: EpsGrid | None
    success: bool
    message: str


class OrderCost(SelfDrawn, _Grids):
    """Result of `order_cost`.

    `grids`: all that were looked at, by time; `front`: the confirmed ones that no cheaper
    one beats; `choice`: the cheapest of the confirmed ones within what was wanted, or
    one of a narrower interval that takes at most a quarter longer, which predictions do not
    tell apart; None where `success` is false.
    """

    __slots__ = ()
    _picture = "draw_order_cost"

    @property
    def front(self) -> list[EpsGrid]:
        best, kept = np.inf, []
        for grid in self.grids:
            if grid.confirmed and grid.half_width < best:
                best = grid.half_width
                kept.append(grid)
        return kept


@with_nan
def order_cost(
    scene: Scene,
    eps: Any,
    gamma: float = 1.0,
    within: float = 0.02,
    accuracy: float = 1e-3,
    *,
    measure: bool = True,
    progress: bool = False,
) -> OrderCost:
    """Which grid of eps gives the order to +- `within`, and how long that takes.

    `eps` (m): the largest and smallest that come into question, or a list with them;
    `scene`, one `gamma` and `accuracy` as in `sweep`. A pilot sweep of 48 eps in that range
    is run, and grids of fewer eps and narrower ranges are laid into it, each with up to
    seven phases (fewer where they fall on the same eps); the interval is the one that
    `study` would give, drift and scatter included. (A formula, scatter over the spread of
    log eps: three times too narrow where the order still drifts.) Seconds are those of
    `predict_cost`; `measure` as there. `progress`: a bar on standard error for the pilot.

    A grid counts only where its order is confirmed: its intervals are compared with those
    of all grids of the pilot whose range lies at smaller eps (neither end larger, one
    smaller); one that does not overlap is a contradiction, and one that reaches the pilot's
    smallest eps must have an interval of at most five times `within`. The last range of the
    pilot has nothing to be compared with. `message` says what was compared, and which
    ranges disagree. (Without: 1.30 +- 0.02 at eps 1e-2 to 1e-3 where the order falls to 0.9
    decade by decade.)

    Returns an `OrderCost`: `.choice`, a grid with `.eps` (m), `.order`, `.seconds`, or
    None; `.grids`, `.front`, `.success` and `.message`.

    Raises `ValueError` for arguments out of range, or less than two eps.

    >>> fx.order_cost(scene, eps=[1e-2, 1e-4], within=0.1, measure=False).message
    'the order to +-0.1 from 6 eps, 0.00155 to 0.0001 m: ... s; 6 grids of smaller ...
    """
    scene = scene_for(Engine.COST, scene)
    known = grid_of("eps", eps)
    require(known.size >= 2, "eps", known, "a largest and a smallest")
    require_real("within", within, "within > 0", lambda w: w > 0)
    require_flags(measure=measure, progress=progress)
    require_real("gamma", gamma, "gamma > 0, one number", lambda g: g > 0)
    pilot = np.geomspace(known[0], known[-1], SETTINGS.pilot)
    ts = float(scene.duration) * np.linspace(0, 1, SETTINGS.pilot_times)
    asked = pilot, gamma, ts, accuracy
    data = sweep(scene, *asked, dissipation=False, progress=progress).isel(gamma=0)
    errors = data.sup_error.where(data.status == int(Status.OK)).values
    predicted, law = _predicted(data, pilot, gamma)
    measured = _Pilot(pilot, errors, accuracy * pilot, predicted, law)
    grids = []
    for start, stop, points in _candidates():
        found = _intervals(measured, start, stop, points)
        if found is not None:
            largest, least = float(pilot[start]), float(pilot[stop])
            some = np.geomspace(largest, least, points)
            cost = predict_cost(scene, some, gamma, accuracy, measure=measure)
            grids.append(EpsGrid(largest, least, points, **found, seconds=cost.seconds))
    return cheapest_grid(grids, float(within))


def _candidates() -> Iterator[tuple[int, int, int]]:
    """First and last place in the pilot, and how many eps."""
    ends = (
        np.linspace(0, SETTINGS.pilot - 1, SETTINGS.parts + 1).round().astype(int).tolist()
    )
    for i, start in enumerate(ends):
        for stop in ends[i + 1 :]:
            for points in SETTINGS.points:
                if points <= stop - start + 1:
                    yield start, stop, points


class _Pilot(NamedTuple):
    """Errors of the pilot's eps, how well they are known, and what the law has for them."""

    eps: np.ndarray
    errors: np.ndarray
    uncertainty: np.ndarray
    predicted: np.ndarray | None
    law: Law

    def order(self, row: list[int]) -> Fit:
        """The order from these of its eps, as `study` gives it."""
        predicted = None if self.predicted is None else self.predicted[row]
        return fit_with_law(
            eps=self.eps[row],
            errors=self.errors[row],
            uncertainty=self.uncertainty[row],
            predicted=predicted,
            law=self.law,
            trust=STATE,
        ).fit


def _predicted(data: Any, pilot: np.ndarray, gamma: float) -> tuple[np.ndarray | None, Law]:
    known = SlideData.of(data.attrs)
    if known is None:
        return None, NO_LAW
    found = predict_errors(known, pilot, np.array([gamma]))["sup_error"]
    return found.errors[0], found.laws[0]


def _intervals(pilot: _Pilot, start: int, stop: int, points: int) -> dict[str, Any] | None:
    """Widest half interval of the order over the phases, median order, ends, how many.

    None where a grid gives no interval.
    """
    spacing = (stop - start) / (points - 1)
    # Shifted grids stay in the range: their ends move inwards by half a distance.
    shifts = (np.array(SETTINGS.offsets) - np.mean(SETTINGS.offsets)) * spacing
    places = np.linspace(start, stop, points) + shifts[:, None]
    rows = np.unique(np.clip(places.round().astype(int), start, stop), axis=0)
    fits = []
    for row in {tuple(np.unique(row).tolist()) for row in rows}:
        fits.append(pilot.order(list(row)))
    lows, highs, orders = (
        np.array([getattr(fit, name) for fit in fits]) for name in ("low", "high", "order")
    )
    if not np.all(np.isfinite(orders)):
        return None
    return {
        "half_width": float(0.5 * (highs - lows).max()),
        "order": float(np.median(orders)),
        "low": float(lows.min()),
        "high": float(highs.max()),
        "laid": len(fits),
    }


def _lies_below(other: EpsGrid, grid: EpsGrid) -> bool:
    """Whether the range of the other grid is the same one moved to smaller eps."""
    ends = (other.eps_max, other.eps_min), (grid.eps_max, grid.eps_min)
    return (
        ends[0] != ends[1]
        and other.eps_max <= grid.eps_max
        and other.eps_min <= grid.eps_min
    )


def _judges(grid: EpsGrid, grids: list[EpsGrid], within: float) -> list[EpsGrid]:
    return [
        other
        for other in grids
        if _lies_below(other, grid) and other.half_width <= SETTINGS.judges * within
    ]


def _judged(
    grid: EpsGrid, grids: list[EpsGrid], within: float
) -> tuple[EpsGrid, list[EpsGrid]]:
    """A grid with whether it is confirmed, and those that contradict it."""
    last = min(other.eps_min for other in grids)
    below = [other for other in grids if _lies_below(other, grid)]
    reach = any(judge.eps_min == last for judge in _judges(grid, grids, within))
    against = [other for other in below if other.low > grid.high or other.high < grid.low]
    return grid._replace(confirmed=not against and (reach or not below)), against


def cheapest_grid(grids: list[EpsGrid], within: float) -> OrderCost:
    """The result of `order_cost` from the grids of a pilot."""
    grids = sorted(grids, key=lambda grid: (grid.seconds, grid.half_width))
    if not grids:
        return OrderCost(grids, None, False, "no grid in this range gives an order")
    judged = [_judged(grid, grids, within) for grid in grids]
    narrow = [(g, against) for g, against in judged if g.half_width <= within]
    good = [grid for grid, _ in narrow if grid.confirmed]
    grids = [grid for grid, _ in judged]
    if good:
        tied = [grid for grid in good if grid.seconds <= SETTINGS.tie * good[0].seconds]
        found = min(tied, key=lambda grid: grid.half_width)
        message = (
            f"the order to +-{within:g} from {found.points} eps, {_range(found)}: "
            f"{found.seconds:.2g} s; {_compared(found, grids, within)}"
        )
        return OrderCost(grids, found, True, message)
    best = min(grids, key=lambda grid: grid.half_width)
    first = narrow[0] if narrow else next(pair for pair in judged if pair[0] is best)
    return OrderCost(grids, None, False, _refusal(*first, within))


def _range(grid: EpsGrid) -> str:
    return f"{grid.eps_max:.3g} to {grid.eps_min:.3g} m"


def _compared(found: EpsGrid, grids: list[EpsGrid], within: float) -> str:
    judges = _judges(found, grids, within)
    if not judges:
        return "the range ends here, nothing of smaller eps to compare it with"
    end = min(judge.eps_min for judge in judges)
    return f"{len(judges)} grids of smaller eps, down to {end:.3g} m, agree"


def _refusal(grid: EpsGrid, against: list[EpsGrid], within: float) -> str:
    """Of the best grid, or of the cheapest that is narrow enough."""
    start = f"no grid in this range gives the order to +-{within:g}, confirmed"
    if grid.half_width > within:
        start = f"no grid in this range gives the order to +-{within:g}"
    size = (
        f"{grid.points} eps from {_range(grid)}: {grid.order:.3f} +-{grid.half_width:.2g}"
    )
    if against:
        other = min(against, key=lambda g: (g.eps_min, g.half_width))
        but = f"{other.order:.3f} +-{other.half_width:.2g} from {_range(other)}"
        return f"{start}: ranges disagree, {size}, but {but}"
    if grid.confirmed:
        return f"{start}; the best, {size}"
    return (
        f"{start}; the best, {size}, and no smaller eps to +-{SETTINGS.judges * within:.2g}"
    )
