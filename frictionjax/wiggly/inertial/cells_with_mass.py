"""Cells of a scene with inertia: each integrated thrice, at tolerances that must agree."""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from ..._checks import quiet_where_extreme, viscosity_of
from ..._compile import Program, in_chunks, once_a_scene
from ...called_for import inertia_numbers
from ...effects import Inertia
from ...model import Scene, SummedPotential, TabulatedScene, padded_edges, tabulated_scene
from ...numerics import concatenated, rows_of, slope_of
from ..equation import (
    PullRange,
    Status,
    SteppedParts,
    plan_steps,
    pull_between,
)
from ..stepping import Control
from .lanes_with_mass import (
    MassAtStops,
    MassiveLane,
    MassiveScene,
    Stretches,
    SupremaSoFar,
    at_start,
    march_with_mass,
)
from .settings import SETTINGS


class CellsWithMass(NamedTuple):
    """Values of all cells; (cells, n) at the requested times, else (cells,).

    `z` (m), `velocity` (m/s), `dissipation` (J), `running_residual`: what is left of the
    energy balance until then (J). `spread`: how far in m runs at other tolerances are
    from it. `sup_error`, `strip_excess` (m), `dissipation_error` (J): over [0, T], NaN
    where no suprema were wanted. `beta`: see `inertia_numbers`. `steps`, `rejected`: of
    all runs; `tolerance`: of the last, in periods.
    """

    z: np.ndarray
    velocity: np.ndarray
    dissipation: np.ndarray
    running_residual: np.ndarray
    spread: np.ndarray
    sup_error: np.ndarray
    strip_excess: np.ndarray
    dissipation_error: np.ndarray
    beta: np.ndarray
    status: np.ndarray
    steps: np.ndarray
    rejected: np.ndarray
    tolerance: np.ndarray


class MarchedRow(NamedTuple):
    """What a row of lanes has found, and how each has ended."""

    stops: MassAtStops
    suprema: SupremaSoFar
    steps: Any
    rejected: Any
    code: Any


class _Course(NamedTuple):
    """What all runs of some cells share: parts, segments, and which stops are asked for."""

    scene: MassiveScene
    segments: Stretches
    asked: np.ndarray
    with_suprema: bool
    accuracy: float


@quiet_where_extreme
def integrate_with_mass(
    scene: Scene,
    eps: Float[np.ndarray, " cells"],
    gamma: Float[np.ndarray, " cells"],
    *,
    inertia: Inertia,
    ts: Float[np.ndarray, " n"],
    accuracy: float,
    suprema: bool,
    budget: int,
    report: Callable[[float], None] = lambda share: None,
) -> CellsWithMass:
    """Every cell (eps, gamma), from z0 at rest through every slip.

    Each is integrated at three tolerances, of which the finest counts. Where they end in
    different wells all are made finer; where they still do, the status is SENSITIVE.
    `budget`: steps of a run. `report` is told the share of the first runs that is done.
    """
    # A sum of tips is a surface of its own at every eps.
    summed = isinstance(scene.potential, SummedPotential)
    groups = [np.flatnonzero(eps == e) for e in np.unique(eps)] if summed else []
    groups = groups or [np.arange(eps.size)]
    beta = inertia_numbers(scene.potential, inertia, eps, gamma)
    parts = []
    for group in groups:
        cells = eps[group], gamma[group]
        tables = tabulated_scene(scene, cells[0])
        if np.any(np.isnan(tables.turning_points)):
            parts.append(_without_turns(cells[0].size, ts.size))
            continue
        lanes = _lanes(tables, inertia, *cells, accuracy, budget)
        course = _course(tables, ts, suprema, accuracy)
        share = group.size / eps.size
        parts.append(_trusted(course, lanes, lambda done, s=share: report(s * done)))
    whole = rows_of(concatenated(parts), np.argsort(np.concatenate(groups)))
    return whole._replace(beta=beta)


def _course(
    scene: TabulatedScene, ts: np.ndarray, suprema: bool, accuracy: float
) -> _Course:
    last = scene.duration if suprema else float(ts[-1])
    turns = scene.turning_points
    checks = np.linspace(0.0, last, SETTINGS.checks if suprema else 2)
    stops = np.unique(np.concatenate([checks, ts, turns[turns < last]]))
    starts = stops[:-1]
    room = SETTINGS.stops * -(-max(starts.size, 1) // SETTINGS.stops)
    start, length = np.full(room, stops[-1]), np.zeros(room)
    start[: starts.size], length[: starts.size] = starts, np.diff(stops)
    parts = MassiveScene(
        potential=scene.lane_potential,
        support=scene.support,
        load=scene.load,
        z0=np.asarray(scene.z0),
        rho_plus=np.asarray(scene.rho_plus),
        rho_minus=np.asarray(scene.rho_minus),
    )
    asked = np.searchsorted(stops, ts) - 1  # -1: at 0
    return _Course(parts, Stretches(start, length), asked, suprema, accuracy)


class _Lengths(NamedTuple):
    """Of a cell: tolerance and reach in periods, `pace` in periods a second, the
    `steepest` slope of its force in N a period, and well and tip of z0."""

    tolerance: Any
    reach: Any
    pace: Any
    steepest: Any
    well: Any
    tip: Any


@Program
def _measured(parts: SteppedParts, pull: PullRange, accuracy, eps, gamma) -> _Lengths:
    def one(eps: Any, gamma: Any) -> _Lengths:
        plan = plan_steps(parts, eps, gamma, accuracy, pull)
        held = eps * parts.support.stiffness_at(parts.z0)
        grid = jnp.arange(parts.potential.points) / parts.potential.points
        slopes = slope_of(jax.vmap(lambda y: parts.potential.tip_force(y, eps)[0]))(grid)
        steepest = jnp.maximum(jnp.max(jnp.abs(slopes)), held)
        tip = parts.potential.tip(parts.z0, eps)
        return _Lengths(plan.tolerance, plan.reach, plan.pace, steepest, *tip)

    return jax.vmap(one)(eps, gamma)


_pull = once_a_scene(pull_between)


def _lanes(
    scene: TabulatedScene,
    inertia: Inertia,
    eps: np.ndarray,
    gamma: np.ndarray,
    accuracy: float,
    budget: int,
) -> MassiveLane:
    """A lane a cell, at the first tolerance."""
    edges = padded_edges(scene.turning_points, scene.duration)
    rho = np.asarray(scene.rho_plus), np.asarray(scene.rho_minus)
    pull = _pull(scene.load, scene.support, edges, *rho)
    parts = SteppedParts(
        potential=scene.potential,
        support=scene.support,
        duration=np.asarray(scene.duration),
        z0=np.asarray(scene.z0),
    )
    fixed = parts, pull, np.asarray(accuracy)
    known = in_chunks(_measured, SETTINGS.lanes, fixed, (eps, gamma))
    viscosity, mass = viscosity_of(eps, gamma), np.asarray(inertia.mass_at(eps))
    settling = known.steepest / (viscosity * eps)
    swinging = np.sqrt(known.steepest / (mass * eps))
    slower = np.minimum(settling, swinging)
    shortest = 1 / np.maximum(swinging, viscosity / mass)
    tolerance = SETTINGS.share * known.tolerance
    return MassiveLane(
        eps=eps,
        viscosity=viscosity,
        mass=np.broadcast_to(mass, eps.shape),
        well=known.well,
        tip=known.tip,
        control=Control(
            first_step=SETTINGS.first_step * shortest,
            tolerance=tolerance,
            loosest=tolerance,
            pace=known.pace,
            reach=known.reach,
        ),
        pause=1 / slower,
        budget=np.full(eps.shape, float(budget)),
    )


def _finer(lanes: MassiveLane, by: float) -> MassiveLane:
    steps = lanes.control
    finer = steps._replace(tolerance=by * steps.tolerance, loosest=by * steps.loosest)
    return lanes._replace(control=finer)


def _trusted(
    course: _Course, lanes: MassiveLane, report: Callable[[float], None]
) -> CellsWithMass:
    """Three runs of each cell, and more where they end in different wells."""
    cells = lanes.eps.size
    others = [lanes, _finer(lanes, SETTINGS.beside)]
    finest = _finer(lanes, SETTINGS.finer)
    every = _marched(course, concatenated([*others, finest]), report)
    rough, beside, fine = (
        rows_of(every, slice(i * cells, (i + 1) * cells)) for i in range(3)
    )
    found = _compared(course, finest, (rough, beside), fine)
    for _ in range(SETTINGS.rounds):
        doubtful = np.flatnonzero(found.status == int(Status.SENSITIVE))
        if doubtful.size == 0:
            break
        rough, lanes = rows_of(fine, doubtful), finest
        finest = _finer(lanes, SETTINGS.finer)
        some = rows_of(_finer(lanes, SETTINGS.beside), doubtful)
        last = rows_of(finest, doubtful)
        both = _marched(course, concatenated([some, last]), lambda share: None)
        beside, finer = (
            rows_of(both, i * doubtful.size + np.arange(doubtful.size)) for i in range(2)
        )
        again = _compared(course, last, (rough, beside), finer)
        before = rows_of(found, doubtful)
        again = again._replace(
            steps=again.steps + before.steps - rough.steps.astype(int),
            rejected=again.rejected + before.rejected - rough.rejected.astype(int),
        )
        found = _with_rows_of(found, again, doubtful)
        fine = _with_rows_of(fine, finer, doubtful)
    return found


def _with_rows_of(whole: Any, part: Any, rows: np.ndarray) -> Any:
    """A record with other values in some rows."""

    def put(old: np.ndarray, new: np.ndarray) -> np.ndarray:
        changed = np.array(old)
        changed[rows] = new
        return changed

    return jax.tree_util.tree_map(put, whole, part)


def _marched(
    course: _Course, lanes: MassiveLane, report: Callable[[float], None]
) -> MarchedRow:
    """Rows of lanes, those that take longest together; all the same length, so that a lane
    has the same bits in any company."""
    order = np.argsort(-lanes.eps, kind="stable")
    sorted_lanes, size = rows_of(lanes, order), SETTINGS.lanes
    rows = []
    for at in range(0, order.size, size):
        row = rows_of(sorted_lanes, slice(at, at + size))
        rows.append(_march_row(course, row))
        report(min(at + size, order.size) / order.size)
    return rows_of(concatenated(rows), np.argsort(order, kind="stable"))


def _march_row(course: _Course, row: MassiveLane) -> MarchedRow:
    """Some stops at a call: another number of them compiles nothing."""
    count, size = row.eps.size, SETTINGS.stops
    lanes = rows_of(row, np.minimum(np.arange(SETTINGS.lanes), count - 1))
    state, found = at_start(lanes, float(course.scene.z0)), []
    for at in range(0, course.segments.start.size, size):
        segments = rows_of(course.segments, slice(at, at + size))
        parts = course.scene, segments, course.with_suprema
        state, stops = march_with_mass(*parts, lanes, state)
        found.append(stops)
    stops = MassAtStops(*(np.concatenate(c, axis=1) for c in zip(*found, strict=True)))
    going = state.going
    whole = MarchedRow(stops, going.suprema, going.steps, going.rejected, going.code)
    return rows_of(whole, slice(count))


def _compared(
    course: _Course, lanes: MassiveLane, others: tuple[MarchedRow, ...], fine: MarchedRow
) -> CellsWithMass:
    """Values of the finest run, that of `lanes`, trusted where the others are in the same
    wells at all stops."""
    asked, z0 = course.asked, float(course.scene.z0)

    def at_times(column: np.ndarray, start: float) -> np.ndarray:
        return np.where(asked >= 0, column[:, asked], start)

    apart = np.max([np.abs(fine.stops.z - o.stops.z) for o in others], axis=0)
    wells = np.max(apart, axis=1, initial=0.0) / lanes.eps
    every = (fine, *others)
    code = np.max([run.code for run in every], axis=0).astype(int)
    sensitive = (code == 0) & ~(wells <= SETTINGS.well)
    unbalanced = (code == 0) & ~_is_balanced(course, lanes, fine)
    code = np.where(unbalanced, int(Status.UNBALANCED), code)
    seen = (code == 0) & course.with_suprema
    far, outside, lost = (np.where(seen, column, np.nan) for column in fine.suprema)
    return CellsWithMass(
        z=at_times(fine.stops.z, z0),
        velocity=at_times(fine.stops.velocity, 0.0),
        dissipation=at_times(fine.stops.lost, 0.0),
        running_residual=np.abs(at_times(fine.stops.left, 0.0)),
        spread=at_times(apart, 0.0),
        sup_error=far,
        strip_excess=outside,
        dissipation_error=lost,
        beta=np.full(code.size, np.nan),
        status=np.where(sensitive, int(Status.SENSITIVE), code),
        steps=np.sum([run.steps for run in every], axis=0).astype(int),
        rejected=np.sum([run.rejected for run in every], axis=0).astype(int),
        tolerance=np.asarray(lanes.control.tolerance),
    )


def _is_balanced(course: _Course, lanes: MassiveLane, found: MarchedRow) -> np.ndarray:
    """Whether energies add up to the accuracy of the dissipation, or of one slip."""
    slip = lanes.eps * float(course.scene.rho_plus - course.scene.rho_minus)
    left = np.max(np.abs(found.stops.left), axis=1, initial=0.0)
    return left <= course.accuracy * (slip + found.stops.lost[:, -1])


def _without_turns(cells: int, times: int) -> CellsWithMass:
    """Of a load that turns more often than the scene has room for."""
    nothing, rows = np.full(cells, np.nan), np.full((cells, times), np.nan)
    none = np.zeros(cells, dtype=int)
    return CellsWithMass(
        z=rows,
        velocity=rows,
        dissipation=rows,
        running_residual=rows,
        spread=rows,
        sup_error=nothing,
        strip_excess=nothing,
        dissipation_error=nothing,
        beta=nothing,
        status=np.full(cells, int(Status.TOO_MANY_TURNS)),
        steps=none,
        rejected=none,
        tolerance=nothing,
    )
