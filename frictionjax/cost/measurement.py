"""What accuracy costs in time: methods, accuracies and cells, measured side by side."""

import itertools
import time
from collections.abc import Callable, Iterable, Mapping, Set
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from .._checks import grid_of, require, require_flags, require_real, require_whole, with_nan
from .._compile import progress_bar, waiting
from ..effects import Engine
from ..model import (
    Scene,
    coefficients_jit,
    require_reach,
    require_times,
    require_told_apart,
    scene_for,
)
from ..sweeps import origin, set_meanings
from ..wiggly import ENDED, Status, accuracies_of, is_ours, solver_of
from .advice import advice
from .error_measures import MEASURES, errors_of
from .instants import Instants, instants
from .meanings import COORDINATES, REFERENCE, RUN
from .references import LEAST_JUDGED, Reference, reference
from .scipy_solvers import SCIPY, Run, told
from .settings import SETTINGS
from .timed_runs import clocked, runner, timed

METHODS = ("auto", "windowed", "resolved", "Kvaerno5", "Kvaerno3", "LSODA", "BDF", "Radau")
MEASURED_ACCURACIES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)

_NOTHING = dict.fromkeys(RUN, float("nan")) | {
    "status": int(Status.NOT_TRIED),
    "wrong": 0.0,
    "runs": 0,
}


class _Column(NamedTuple):
    """One method in one cell, at all accuracies."""

    scene: Scene
    eps: float
    gamma: float
    when: Instants
    truth: Reference
    method: Any

    @property
    def slip_energy(self) -> float:
        law = coefficients_jit(self.scene.potential)
        return self.eps * float(law.rho_plus - law.rho_minus)


class _Effort(NamedTuple):
    """How long and how often methods may run."""

    accuracies: np.ndarray
    repeats: int
    seconds: float
    until: float  # on the clock of `perf_counter`: nothing begins later
    anyway: Any  # the method that is measured in any case
    loosest: tuple  # SciPy's that are so at the loosest accuracy

    def goes_first(self, method: Any) -> bool:
        """Whether it comes before all others: ours, one of them where time is short."""
        return is_ours(method) and (method is self.anyway or self.until == float("inf"))

    def allows(self, method: Any, first: bool) -> bool:
        """Whether there is time to begin, and to compile what is not SciPy's.

        The first of ours always may: what others take is to be held against something.
        """
        if method is self.anyway or (first and method in self.loosest):
            return True
        compiled = method in SCIPY or not first
        needs = 0.0 if compiled else SETTINGS.compiles
        return time.perf_counter() + needs < self.until


def _is_wrong(errors: dict, of_truth: dict, accuracy: float) -> bool:
    """Whether errors are surely half an eps, and more than was asked for.

    Known at times outside slips; where there are none, at the end, which may be in a slip.
    """
    name, least = (
        ("end_error", SETTINGS.lost)
        if np.isnan(errors["error"])
        else ("error", SETTINGS.wrong)
    )
    return bool(errors[name] - of_truth[name] >= max(least, accuracy))


def _values(
    run: Run, times: dict[str, float], column: _Column, accuracy: float
) -> dict[str, float]:
    """Everything the data set holds of one run."""
    truth = column.truth
    errors = dict.fromkeys(MEASURES, float("nan"))
    if run.status in ENDED:  # part of a trajectory is no trajectory
        errors = errors_of(
            run.z,
            run.dissipation,
            truth.z,
            truth.dissipation,
            truth.in_slip,
            column.when,
            column.eps,
        )
    wrong = run.status == Status.OK and _is_wrong(errors, truth.errors, accuracy)
    return (
        times
        | errors
        | {"steps": run.steps, "rejected": run.rejected, "calls_share": run.calls}
        | {"residual": run.residual / column.slip_energy}
        | {"status": int(run.status), "wrong": float(wrong)}
    )


def _first_calls(
    scene: Scene, eps: float, gamma: float, ts: np.ndarray, names: list, effort: _Effort
) -> list[float | None]:
    """Seconds of the first calls of our own methods; the others' are clocked later.

    Before the reference, which would compile the same programs for them. Where time is
    short only of what is measured in any case. (The windowed method compiles for 8 s.)
    """
    loosest = float(effort.accuracies[0])
    return [
        clocked(runner(scene, eps, gamma, ts, loosest, name, effort.seconds))[1]
        if effort.goes_first(name)
        else None
        for name in names
    ]


def _measured(
    column: _Column, effort: _Effort, first: float | None, done: Callable[[], None]
) -> list[dict[str, float]]:
    """From the loosest accuracy to the tightest, until runs take too long.

    `first`: seconds of a call at the loosest, where there was one. `done`: called after
    each.
    """
    scene, eps, gamma, when, _, method = column
    cells: list[dict[str, float]] = []
    given_up = False
    for accuracy in map(float, effort.accuracies):
        given_up = given_up or not effort.allows(method, first=not cells)
        if given_up:
            cells.append(_NOTHING)
        else:
            run = runner(scene, eps, gamma, when.ts, accuracy, method, effort.seconds)
            if cells and method in SCIPY:
                first = 0.0  # rates and Jacobian are compiled: the next run is a warm one
            found, times = timed(run, effort.repeats, effort.seconds, first)
            first = None
            if method in SCIPY:
                found = told(found, scene, eps, gamma, method)
            cells.append(_values(found, times, column, accuracy))
            slow = times["seconds"] > effort.seconds
            given_up = found.status == Status.TOO_SLOW or slow
        done()
    return cells


def _required(methods: Any, accuracies: Any, repeats: Any, seconds: Any):
    ordered = not isinstance(methods, Mapping | Set)
    require(ordered, "methods", methods, "a name, a solver, or a list of them")
    names = [methods] if _is_one(methods) else list(methods)
    names = [str(n) if isinstance(n, str) else n for n in names]  # NumPy's print otherwise
    require(bool(names), "methods", methods, "at least one method")
    for name in names:
        if not isinstance(name, str) or name not in SCIPY:
            solver_of(name, "methods", SCIPY)
    labels = [m if isinstance(m, str) else _label(m) for m in names]
    unique = len(set(labels)) == len(labels)
    require(unique, "methods", ", ".join(labels), "each method once")
    asked = accuracies_of(accuracies, LEAST_JUDGED)[::-1]
    require_whole("repeats", repeats)
    require_real("seconds", seconds, "seconds > 0", lambda s: s > 0)
    return names, labels, asked


def _required_anyway(anyway: Any, names: list) -> tuple[str, ...]:
    given = [anyway] if isinstance(anyway, str) else anyway
    known = [name for name in names if isinstance(name, str) and name in SCIPY]
    allowed = f"some of SciPy's among methods: {', '.join(known) or 'none'}"
    listed = isinstance(given, Iterable) and not isinstance(given, Mapping)
    require(listed, "anyway", anyway, allowed)
    asked = list(given)
    require(all(name in known for name in asked), "anyway", anyway, allowed)
    return tuple(str(name) for name in asked)


def _is_one(methods: Any) -> bool:
    return isinstance(methods, str) or not isinstance(methods, Iterable)


def _label(method: Any) -> str:
    return method.__name__ if isinstance(method, type) else type(method).__name__


@with_nan
def work_precision(
    scene: Scene,
    eps: Any = 1e-2,
    gamma: Any = 1.0,
    methods: Any = METHODS,
    accuracies: Any = MEASURED_ACCURACIES,
    ts: Any = None,
    *,
    repeats: int = 5,
    seconds: float = 10.0,
    total: float | None = None,
    progress: bool = False,
    anyway: Any = (),
) -> xr.Dataset:
    """Measure what accuracy costs: time and error of methods on a `scene`, cell by cell.

    `eps` in m and `gamma`: numbers or lists. `methods`: one or several, as `method` of
    `solve`, and SciPy's "LSODA", "BDF" and "Radau" without any guard. `accuracies`: asked
    of each, atol (in periods) of SciPy's. `ts`: times in s at which errors are measured, 61
    even ones where None; 32 more over one slip period are added where one of them has a
    whole one ahead. `repeats`: at most so many warm runs are timed: three, or as many as
    fit into half a second, and no more than fit into `seconds`. `seconds`: of a method that
    takes longer tighter accuracies are not tried; SciPy's runs are ended then, diffrax's
    after a million steps for each second, ours, which cannot be, go on. `total`: seconds
    of all together after which no run is begun, but those of the first of ours, which come
    before all others, in all cells; these follow in their order, each in all cells; what is
    left out is NOT_TRIED. None: no bound, and all of ours come first. `anyway`: of
    `methods`, those of SciPy's that are run at the loosest accuracy after `total` too, so
    that ours are held against one.
    `progress`: a line on standard error until there are references, then a bar.

    Returns a data set with dims (gamma, eps, solver, accuracy): times `seconds` (median),
    `seconds_low`, `seconds_high`, `runs`, `compile_seconds` (what the first call took
    longer: methods share programs, and what this process has compiled before, or loads from
    a cache, is not compiled again); errors `error` (largest outside slips, in eps),
    `slip_error` (NaN without a whole slip period), `end_error` and `mescd` at the last of
    `ts` (as the Test Set for IVP Solvers, with atol/rtol = eps), `dissipation_error`;
    `residual` of the energy-dissipation balance, for all along cubics through the ends of
    steps; `steps` and `rejected`: of all attempts, for SciPy's, which do not tell them,
    found after the timed runs from the times of their calls. `calls_share`: of the seconds
    of SciPy's solvers, which call the compiled field from Python. `status`, and `wrong`:
    success reported half an eps or more off (1.5 eps at the end where all times lie in
    slips), and further than asked for. Over (gamma, eps) what is known of the reference:
    `reference_error` and so on is its distance from a second one, made otherwise as
    `reference_ways` says; no error below it means anything. The attribute `advice` says in
    a sentence which method and accuracy to take, by what was measured.

    Failures stay in the table with their status and errors of NaN.

    Raises `ValueError` for arguments out of range, as `solve` does. Source of mescd: F.
    Mazzia and C. Magherini, Test Set for Initial Value Problem Solvers, release 2.4
    (2008).

    >>> costs = fx.work_precision(scene, methods="auto", accuracies=1e-3, repeats=1)
    >>> print(costs.attrs["advice"])
    For 1e-03 eps take method='auto', accuracy=1e-03: z within ... eps in the cell in ... s.
    """
    scene = scene_for(Engine.COST, scene)
    require_flags(progress=progress)
    eps, gamma = grid_of("eps", eps), grid_of("gamma", gamma)
    names, labels, asked = _required(methods, accuracies, repeats, seconds)
    if total is not None:
        require_real("total", total, "seconds > 0, or None", lambda s: s > 0)
    require_reach(scene.potential, eps)
    require_told_apart(scene, eps)
    ts = np.asarray(require_times(scene, ts, SETTINGS.times))
    until = float("inf") if total is None else time.perf_counter() + float(total)
    ours = next((name for name in names if is_ours(name)), None)
    loosest = _required_anyway(anyway, names)
    effort = _Effort(asked, int(repeats), float(seconds), until, ours, loosest)
    cells, truths = _all_cells(scene, eps, gamma, ts, names, effort, progress)
    shape = gamma.size, eps.size, len(names), asked.size
    data = _dataset(cells, truths, shape)
    data = data.assign_coords(gamma=gamma, eps=eps, solver=labels, accuracy=asked)
    return _described(data, scene)


def _all_cells(
    scene: Scene,
    eps: np.ndarray,
    gamma: np.ndarray,
    ts: np.ndarray,
    names: list,
    effort: _Effort,
    progress: bool,
) -> tuple[list[dict], list[Reference]]:
    """Runs in the order of the data set, and a reference for each (gamma, eps).

    Made in another order: our methods in all cells before the others, which may take all
    the time there is; where that is bounded, only the one that is measured in any case, and
    then method by method, so that no slow one of a cell takes the time of all in the next.
    """
    grid = list(itertools.product(gamma.tolist(), eps.tolist()))
    columns: dict[tuple[int, int], _Column] = {}
    first: dict[tuple[int, int], float | None] = {}
    with waiting("work_precision", progress) as tell:
        for row, (g, e) in enumerate(grid):
            tell(f"first calls and a reference, gamma = {g:.4g}, eps = {e:.4g} m")
            when = instants(scene, e, ts)
            longer = _first_calls(scene, e, g, when.ts, names, effort)
            truth = reference(scene, e, g, when, float(effort.accuracies[-1]))
            for index, name in enumerate(names):
                columns[row, index] = _Column(scene, e, g, when, truth, name)
                first[row, index] = longer[index]
    found: dict[tuple[int, int], list[dict]] = {}
    with progress_bar("runs", progress) as bar:
        share = 1.0 / (len(columns) * effort.accuracies.size)

        def told() -> None:
            bar.update(share)

        def turn(place: tuple[int, int]) -> tuple[bool, int, int]:
            row, index = place
            return not effort.goes_first(names[index]), index, row

        for place in sorted(columns, key=turn):
            found[place] = _measured(columns[place], effort, first[place], told)
    cells = [run for place in columns for run in found[place]]
    return cells, [columns[row, 0].truth for row in range(len(grid))]


def _dataset(cells: list[dict], truths: list[Reference], shape: tuple) -> xr.Dataset:
    dims = ("gamma", "eps", "solver", "accuracy")
    data = xr.Dataset()
    for name in RUN:
        data[name] = dims, np.array([cell[name] for cell in cells]).reshape(shape)
    for name in REFERENCE:
        known = [_of_reference(truth, name) for truth in truths]
        data[name] = dims[:2], np.array(known).reshape(shape[:2])
    return data


def _of_reference(truth: Reference, name: str) -> float | str:
    measure = name.removeprefix("reference_")
    return truth.ways if measure == "ways" else truth.errors[measure]


def _described(data: xr.Dataset, scene: Scene) -> xr.Dataset:
    data["status"] = data["status"].astype(np.int8)
    set_meanings(data, RUN | REFERENCE | COORDINATES)
    data.attrs = origin("What accuracy costs in time", scene) | {"advice": advice(data)}
    return data
