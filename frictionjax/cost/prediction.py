"""What a sweep will cost, before anything runs, and which sweep fits a budget."""

from typing import Any, NamedTuple

import numpy as np

from .._checks import (
    as_real,
    cells_of,
    grid_of,
    no_less,
    require,
    require_flags,
    require_real,
    with_nan,
)
from .._compile import waiting
from .._text import Named, SelfDrawn, ShownNumbers
from ..effects import Engine
from ..limit import require_start_in_strip
from ..model import Scene, require_reach, require_times, require_told_apart, scene_for
from ..wiggly import OURS, Workload, accuracies_of, is_ours, require_accuracy, workload
from .machine_cost import ELSEWHERE, MachineCost, known_machine, machine_cost
from .settings import SETTINGS

PREDICTED_ACCURACIES = (
    1e-6,
    1e-5,
    1e-4,
    1e-3,
)  # that calibration has looked at, and their cost


class _Costs(NamedTuple):
    seconds: float
    cells: np.ndarray
    compilation: float
    memory: float
    measured: bool


class CostPrediction(ShownNumbers, SelfDrawn, _Costs):
    """Predicted cost of a sweep on this machine.

    `seconds`: of the warm sweep, NaN where the load turns more often than lanes have room
    for; `low`, `high`: half and twice that, which nine of ten cells keep to while nothing
    else runs. `cells`: each cell alone, s, shape (gamma, eps). `compilation`: s that the
    first sweep of its kind may take longer. `memory`: of the process at most, bytes,
    within a factor of 1.5 in 15 sweeps. `measured`: whether this machine was measured;
    else the numbers are those of another one.
    """

    __slots__ = ()
    _picture = "draw_cost_prediction"

    @property
    def low(self) -> float:
        return self.seconds / SETTINGS.within

    @property
    def high(self) -> float:
        return self.seconds * SETTINGS.within

    def __str__(self) -> str:
        if not np.isfinite(self.seconds):
            return "unknown: the load turns too often, or floats do not hold eps^gamma"
        where = (
            "" if self.measured else " (on another machine; this one has not been measured)"
        )
        return (
            f"{_seconds(self.low)} to {_seconds(self.high)} s of computation, up to "
            f"{_seconds(self.compilation)} s of compilation the first time, "
            f"{self.memory / 1e9:.1f} GB{where}"
        )

    def _numbers(self) -> list[Named]:
        where = "this machine, measured" if self.measured else "of another machine"
        return [
            Named("seconds", self.seconds, "s", where),
            Named("low", self.low, "s", "nine of ten cells keep between this"),
            Named("high", self.high, "s", "and this"),
            Named("compilation", self.compilation, "s", "at most, the first time"),
            Named("memory", self.memory / 1e9, "GB", "of the process at most"),
        ]


def _seconds(value: float) -> str:
    return f"{value:.2g}" if value < 100 else f"{value:.0f}"


def _predicted(
    scene: Scene, eps, gamma, times: int, accuracy, method, machine: MachineCost
) -> CostPrediction:
    lane_eps, lane_gamma = cells_of(eps, gamma)
    work = workload(scene, lane_eps, lane_gamma, times, accuracy, method)
    values = 2.0 * lane_eps.size * times
    if work is None:
        nothing = np.full((gamma.size, eps.size), np.nan)
        return CostPrediction(np.nan, nothing, np.nan, machine.memory, machine.measured)
    each = [machine.seconds(_one(work, i)) for i in range(lane_eps.size)]
    rows = SETTINGS.leg_bytes * work.segments.sum() + SETTINGS.job_bytes * work.jobs.sum()
    memory = machine.memory + rows + SETTINGS.value_bytes * values
    return CostPrediction(
        machine.seconds(work),
        np.reshape(each, (gamma.size, eps.size)),
        machine.compilation,
        float(memory),
        machine.measured,
    )


def _one(work: Workload, cell: int) -> Workload:
    some = slice(cell, cell + 1)
    return Workload._make([*(column[some] for column in work[:-2]), *work[-2:]])


@with_nan
def predict_cost(
    scene: Scene,
    eps: Any,
    gamma: Any = 1.0,
    accuracy: Any = 1e-3,
    ts: Any = None,
    method: str = "auto",
    *,
    measure: bool = True,
    progress: bool = False,
) -> CostPrediction:
    """Time and memory of `sweep` with these arguments, before anything runs.

    `eps` in m and `gamma`: numbers or lists; `scene`, `accuracy` and `ts` as in `sweep`,
    and `method` one of the library's own. The first call on a machine measures it, 5 to 20
    s, and keeps that in the user's cache folder; `measure=False` measures
    nothing: of a machine that was never measured it takes another's numbers. `progress`:
    a line on standard error where it takes more than two seconds.

    The work of lanes follows from the plan of the sweep: wells, windows, tolerances. Where
    surveys have to be made again, which nobody knows before, a cell takes longer.

    Returns a `CostPrediction`: `.seconds` with `.low` and `.high`, `.cells` (s, shape
    (gamma, eps)), `.compilation` (s) and `.memory` (bytes).

    Raises `ValueError` for arguments out of range, as `sweep` does.

    >>> print(fx.predict_cost(scene, eps=[1e-2, 1e-3], gamma=1.0, measure=False))
    0.024 to 0.097 s of computation, up to 9.3 s of compilation the first time, 0.8 GB ...
    """
    scene = scene_for(Engine.COST, scene)
    eps, gamma = grid_of("eps", eps), grid_of("gamma", gamma)
    require_accuracy(accuracy)
    require_flags(measure=measure, progress=progress)
    require(is_ours(method), "method", method, f"one of {', '.join(OURS)}")
    ts = require_times(scene, ts)
    require_start_in_strip(scene)
    require_reach(scene.potential, eps)
    require_told_apart(scene, eps)
    wanted = float(as_real(accuracy))
    with waiting("predict_cost", progress) as tell:
        tell("this machine")
        machine = machine_cost() if measure else known_machine() or ELSEWHERE
        tell("the plan of the sweep")
        return _predicted(scene, eps, gamma, len(ts), wanted, method, machine)


class Affordable(NamedTuple):
    """A sweep that fits a budget: its eps (m), accuracy and predicted cost."""

    eps: np.ndarray
    accuracy: float
    cost: CostPrediction


def fit_budget(
    scene: Scene,
    eps: Any,
    gamma: Any,
    budget: float,
    ts: Any = None,
    method: str = "auto",
    accuracies: Any = PREDICTED_ACCURACIES,
) -> Affordable:
    """The tightest of `accuracies` that fits `budget` (s); with fewer eps if none does.

    `scene`, `eps` (m), `gamma`, `ts` and `method`: as in `predict_cost`. Compilation is not
    counted. Where even the loosest does not fit, the dearest eps go first, until four are
    left, the fewest that give an order.

    Returns `.eps` (m, shape (n,)), `.accuracy` and `.cost`, a `CostPrediction`.

    Raises `ValueError` for a budget that is not positive, that nothing fits into, or where
    nothing is known of the cost.

    >>> fits = fx.fit_budget(scene, eps=[1e-2, 1e-3, 1e-4, 1e-5], gamma=1.0, budget=10.0)
    >>> fits.accuracy, fits.eps.size
    (1e-06, 4)
    """
    require_real("budget", budget, "seconds > 0", lambda s: s > 0)
    values = grid_of("eps", eps)
    for accuracy in accuracies_of(accuracies).tolist():
        cost = predict_cost(scene, values, gamma, accuracy, ts, method)
        if not np.isfinite(cost.seconds):
            raise ValueError(f"budget = {budget:g}: cost {cost}; run without a budget")
        if cost.seconds <= budget:
            return Affordable(values, accuracy, cost)
    while values.size > SETTINGS.least_eps:
        values = np.delete(values, _dearest(cost))
        cost = predict_cost(scene, values, gamma, accuracy, ts, method)
        if cost.seconds <= budget:
            return Affordable(values, accuracy, cost)
    needs = (
        f"at least {no_less(cost.seconds, 2)} s, for {values.size} eps at {accuracy:.0e}"
    )
    raise ValueError(f"budget = {budget:g}: needs {needs}")


def _dearest(cost: CostPrediction) -> int:
    """The eps whose cells cost most; the smallest of equals."""
    each = cost.cells.sum(axis=0)
    return int(each.size - 1 - np.argmax(each[::-1]))
