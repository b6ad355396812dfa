"""General stiff solvers of SciPy on the wiggly system: what one has without the library."""

import itertools
import time
from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array
from scipy import integrate as scipy_integrate

from .._checks import Real
from .._compile import Program
from ..model import Scene, coefficients_jit, scene_of_tables
from ..wiggly import Status, TipField, field_of
from .settings import SETTINGS
from .step_record import StepRecord

SCIPY = ("LSODA", "BDF", "Radau")


class Run(NamedTuple):
    """What a solver gave: `z` (m) and `dissipation` (J) at the times, shapes (n,).

    NaN from where it gave up, and where a solver does not tell; `residual` is that of the
    energy-dissipation balance at the last time, J. `calls`: share of its seconds in calls
    of the field from Python. `record`: from which the rest follows, where it does not come
    with the run.
    """

    z: np.ndarray
    dissipation: np.ndarray
    status: Status
    steps: float
    rejected: float
    residual: float = float("nan")
    calls: float = 0.0
    record: StepRecord | None = None


def _rate_pair(field: TipField, t: Real, state: Array) -> Array:
    """`y'` and `eps^gamma z'^2`."""
    force, stretch = field.driving_force(t, state[0])
    pace = force / (field.viscosity * field.eps * stretch)
    return jnp.stack([pace, force**2 / field.viscosity])


@Program
def _rates(field: TipField, t: Real, state: Array) -> Array:
    return _rate_pair(field, t, state)


@Program
def _jacobian(field: TipField, t: Real, state: Array) -> Array:
    return jax.jacfwd(lambda s: _rate_pair(field, t, s))(state)


@Program
def _states(field: TipField, tips: Array) -> Array:
    return field.state(tips)


def run_scipy(
    scene: Scene,
    eps: float,
    gamma: float,
    ts: np.ndarray,
    tolerance: float,
    method: str,
    seconds: float,
) -> Run:
    """Solve with SciPy's `method`, stretch by stretch between turning points of the load.

    The tip coordinate y is the unknown, with atol = `tolerance` (periods), and the
    dissipation beside it, relative to what a slip dissipates. rtol as small as SciPy takes
    it: of a tip a thousand wells from 0, a share of 0.1 is a hundred wells. Exact Jacobian;
    compiled rates, called from Python, which takes most of the time: `calls`. No guard
    against steps over wells: they are what happens. Ends after `seconds`, compilation
    apart, as TOO_SLOW. Steps are the accepted ones; see `told`.
    """
    tables = scene_of_tables(scene, eps)
    field = field_of(tables, jnp.asarray(eps), jnp.asarray(gamma))
    solver_type = getattr(scipy_integrate, method)
    start = np.array([float(field.start(scene.z0)), 0.0])
    found = np.full((ts.size, 2), np.nan)
    found[ts <= 0.0] = start
    law = coefficients_jit(scene.potential)
    slip = eps * float(law.rho_plus - law.rho_minus)
    edges = np.union1d(np.asarray(tables.turning_points()), [0.0, float(ts[-1])])
    edges = edges[(edges >= 0) & (edges <= ts[-1])]

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        record.looks.append(t)
        return called(_rates, t, y)

    def jacobian(t: float, y: np.ndarray) -> np.ndarray:
        return called(_jacobian, t, y)

    def called(fn: Callable, t: float, y: np.ndarray) -> np.ndarray:
        called_at = time.perf_counter()
        found = np.asarray(fn(field, np.float64(t), y))
        record.calls += time.perf_counter() - called_at
        return found

    jax.block_until_ready([fn(field, np.float64(0.0), start) for fn in (_rates, _jacobian)])
    record, status, begun = StepRecord(), Status.OK, time.perf_counter()
    deadline = begun + seconds
    for begin, end in itertools.pairwise(edges):
        solver = solver_type(
            rates,
            begin,
            start,
            end,
            rtol=SETTINGS.rtol,
            atol=np.array([tolerance, tolerance * slip]),
            jac=jacobian,
        )
        status = _stretch(solver, ts, found, record, deadline)
        if status != Status.OK:
            break
        start = solver.y
    spent = time.perf_counter() - begun
    z = np.asarray(_states(field, found[:, 0]))
    if status == Status.OK and not np.all(np.isfinite(z)):
        status = Status.NOT_FINITE
    return Run(
        z,
        found[:, 1],
        status,
        steps=float(record.accepted),
        rejected=float("nan"),
        calls=record.calls / spent,
        record=record,
    )


def told(run: Run, scene: Scene, eps: float, gamma: float, method: str) -> Run:
    """The run with the steps that were tried, those rejected, and its residual.

    Not to be timed. Where the run has not come to its end there is no residual.
    """
    assert run.record is not None
    tried, residual = run.record.tried(method), float("nan")
    if run.status == Status.OK:
        tables = scene_of_tables(scene, eps)
        field = field_of(tables, jnp.asarray(eps), jnp.asarray(gamma))
        residual = run.record.residual(field)
    rejected = float(tried - run.record.accepted)
    return run._replace(
        steps=float(tried), rejected=rejected, residual=residual, record=None
    )


def _stretch(solver, ts, found, record, deadline) -> Status:
    """Step to the end of a stretch; values at the times on the way go into `found`."""
    while solver.status == "running":
        before, looks = solver.y, len(record.looks)
        message = solver.step()
        if solver.status == "failed":
            tiny = message == solver.TOO_SMALL_STEP
            return Status.STEP_TOO_SMALL if tiny else Status.SOLVER_FAILED
        record.add(solver, before, looks)
        passed = (ts > solver.t_old) & (ts <= solver.t)
        if passed.any():
            found[passed] = solver.dense_output()(ts[passed]).T
        if time.perf_counter() > deadline:
            return Status.TOO_SLOW
    return Status.OK
