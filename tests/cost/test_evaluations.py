"""Counts of work are what is executed: attempts, evaluations, Jacobians, lanes' steps."""

import inspect
import sys
from types import SimpleNamespace

import diffrax
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy import integrate as scipy_integrate

import frictionjax as fx
from frictionjax.cost import timed_runs
from frictionjax.cost.evaluations import Counts, Work, can_count, count_work
from frictionjax.cost.scipy_solvers import Run, run_scipy, told
from frictionjax.cost.step_record import StepRecord
from frictionjax.wiggly.enclosure import close as rounds
from frictionjax.wiggly.equation.field import TipField
from frictionjax.wiggly.equation.step_plan import plan_steps
from frictionjax.wiggly.lanes import lane
from frictionjax.wiggly.lanes.lane import Sums
from frictionjax.wiggly.plan import TABLEAU
from frictionjax.wiggly.sequential.integration import integrate
from frictionjax.wiggly.sequential.solvers_by_name import solver_of

EPS, TIMES = 0.2, np.linspace(0.0, 3.0, 5)
SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
    fx.supports.Spring(1.0),
    fx.loads.Sine(1.0488, 3.0),
    duration=3.0,
)
SHARE = 1 - 0.5**0.5


class _Twice(diffrax.AbstractSDIRK):
    """Two implicit stages of order 2 (Alexander 1977), neither first same as last."""

    tableau = diffrax.ButcherTableau(
        a_lower=(np.array([1 - SHARE]),),
        a_diagonal=np.array([SHARE, SHARE]),
        a_predictor=(np.array([1.0]),),
        b_sol=np.array([1 - SHARE, SHARE]),
        b_error=np.array([0.5 - SHARE, SHARE - 0.5]),
        c=np.array([1.0]),
        c1=SHARE,
    )
    interpolation_cls = diffrax.LocalLinearInterpolation
    root_finder: object = diffrax.VeryChord(rtol=0.0, atol=1e-6)
    root_find_max_steps: int = 10

    def order(self, terms):
        return 2


class _EveryStage(_Twice):
    """The same with a Jacobian for each stage."""

    calculate_jacobian = diffrax.CalculateJacobian.every_stage


def executed(monkeypatch, solver, accuracy):
    """Evaluations and Jacobians that a plain run calls for, told by callbacks."""
    seen = {"evaluations": 0, "jacobians": 0}

    def tell(name):
        seen[name] += 1

    @jax.custom_jvp
    def probe(y):
        jax.debug.callback(lambda: tell("evaluations"))
        return y

    @probe.defjvp
    def _(points, tangents):
        jax.debug.callback(lambda: tell("jacobians"))
        return points[0], tangents[0]

    plain, ts, one = TipField.velocity, jnp.asarray(TIMES), jnp.asarray(1.0)
    plan = plan_steps(SCENE, EPS * one, one, accuracy * one)
    with monkeypatch.context() as change:
        change.setattr(TipField, "velocity", lambda self, t, y: plain(self, t, probe(y)))

        def run():
            parts = SCENE, EPS * one, one, ts, plan, solver
            found = integrate(*parts, until=ts[-1], balanced=False)
            return found.steps, found.rejected

        steps, rejected = jax.jit(run)()
        jax.effects_barrier()
    # One for all times asked for comes after the steps: derivatives by the times.
    in_steps = Work(seen["evaluations"] - 1, seen["jacobians"])
    return Counts(int(steps), int(rejected), in_steps)


@pytest.mark.parametrize(
    "solver",
    [
        pytest.param(diffrax.Kvaerno3(), marks=pytest.mark.slow),
        pytest.param(diffrax.ImplicitEuler(), marks=pytest.mark.slow),
        pytest.param(diffrax.Tsit5(), marks=pytest.mark.slow),
        pytest.param(_Twice(), marks=pytest.mark.slow),
        pytest.param(_EveryStage(), marks=pytest.mark.slow),
        pytest.param(diffrax.Kvaerno5(), marks=pytest.mark.slow),
        pytest.param(diffrax.Heun(), marks=pytest.mark.slow),
    ],
    ids=lambda solver: type(solver).__name__,
)
def test_what_is_counted_is_executed(monkeypatch, solver):
    one, accuracy = jnp.asarray(1.0), 0.3
    cell = SCENE, EPS * one, one, jnp.asarray(TIMES), accuracy * one
    found = count_work(*cell, solver, 2**20)
    assert jax.tree_util.tree_map(int, found) == executed(monkeypatch, solver, accuracy)
    assert int(found.rejected) > 0


def test_others_are_not_counted():
    assert not can_count(diffrax.ReversibleHeun())
    assert can_count(solver_of("Kvaerno4"))


def test_lanes_look_at_the_field_once_a_stage(monkeypatch):
    looks, plain = [], TipField.driving_force

    def look(*where):
        looks.append(0)
        return plain(*where)

    monkeypatch.setattr(TipField, "driving_force", look)
    one = jnp.asarray(1.0)
    point = lane.Point(*[one] * 6)
    cell = lane.LaneCells(*[one] * len(lane.LaneCells._fields))
    guide = lane.Guide(*[one] * 7)
    none = jnp.asarray(0)
    task = lane.LaneTask(none, none, cell, one, guide, one, one, one)
    sums, extent = lane.Balance(*[one] * 3), lane.Extent(*[one] * 5)
    motion = lane.LaneState(one, one, one, point, one, one, sums, extent, one, one, one)
    parts = lane.LaneScene(SCENE.potential, SCENE.support, SCENE.load, one, -one), TABLEAU
    jax.make_jaxpr(lambda m: lane.step_of_lane(*parts, Sums(False, False), task, m))(motion)
    assert len(looks) == len(TABLEAU.a)
    evaluations, jacobians = timed_runs._by_stages("auto", 10.0)
    assert (evaluations, jacobians) == (10.0 * len(looks), 10.0)


@pytest.mark.parametrize(
    ("eps", "gamma", "accuracy"),
    [(1e-3, 1.0, 1e-5), pytest.param(2.5e-4, 0.25, 1e-3, marks=pytest.mark.slow)],
)
def test_steps_of_lanes_are_all_steps(monkeypatch, eps, gamma, accuracy):
    """Also those of surveys that were made again, and of lanes that look for slip maps."""
    every, marches = np.zeros(2), rounds.march

    def march(*parts):
        found = marches(*parts)
        every[:] += np.nansum(found.steps), np.nansum(found.rejected)
        return found

    monkeypatch.setattr(rounds, "march", march)
    found = fx.solve(SCENE, eps, gamma, np.linspace(0, 3, 61), accuracy)
    assert found.ok
    assert (found.stats["steps"], found.stats["rejected"]) == tuple(every)


def attempts(monkeypatch, method, tolerance):
    """A run of SciPy's, and how often its step set off: lines of its code, counted."""
    code = getattr(scipy_integrate, method)._step_impl
    source, first = inspect.getsourcelines(code)
    lines = [first + i for i, x in enumerate(source) if x.strip() == "t_new = t + h"]
    assert len(lines) == 1
    count = 0

    def inside(frame, event, arg):
        nonlocal count
        count += event == "line" and frame.f_lineno == lines[0]
        return inside

    before = sys.gettrace()
    sys.settrace(lambda frame, *_: inside if frame.f_code is code.__code__ else None)
    try:
        run = run_scipy(SCENE, EPS, 1.0, TIMES, tolerance, method, 60.0)
    finally:
        sys.settrace(before)
    return run, count


@pytest.mark.parametrize("method", ["BDF", "Radau"])
def test_attempts_of_scipy_are_counted(monkeypatch, method):
    run, count = attempts(monkeypatch, method, 1e-3)
    known = told(run, SCENE, EPS, 1.0, method)
    assert known.steps == count
    assert known.rejected == count - run.steps > 0


def test_looks_at_the_start_are_no_attempts():
    """LSODA's first one, and those after three failures."""
    record, solver = StepRecord(), SimpleNamespace(t_old=1.0, t=1.25, y=np.zeros(2))
    record.looks += [1.0, 2.0, 2.0, 1.5, 1.0, 1.25, 1.25]
    record.add(solver, np.zeros(2), 0)
    assert (record.tried("LSODA"), record.accepted) == (3, 1)


def test_evaluations_of_scipy_are_its_own():
    """Looks that are recorded are what SciPy's solvers say they have made."""
    told_by, plain = [], scipy_integrate.LSODA.__init__

    def keep(self, *args, **options):
        told_by.append(self)
        plain(self, *args, **options)

    with pytest.MonkeyPatch.context() as change:
        change.setattr(scipy_integrate.LSODA, "__init__", keep)
        run = run_scipy(SCENE, 0.045, 1.0, TIMES, 1e-3, "LSODA", 60.0)
    assert run.jacobians > 0  # at eps = 0.2 it stays with Adams methods
    assert run.evaluations == sum(solver.nfev for solver in told_by)
    assert run.jacobians == sum(solver.njev for solver in told_by)
    own = [solver._lsoda_solver._integrator.iwork[10] for solver in told_by]
    assert run.steps == sum(own)


@pytest.mark.parametrize("method", ["LSODA", "Radau"])
def test_residual_of_scipy_is_that_of_its_steps(method):
    """As the certificate finds it, which joins the samples its own way."""
    run = run_scipy(SCENE, EPS, 1.0, TIMES, 1e-3, method, 60.0)
    ends = np.array([step[1] for step in run.record._steps])
    states = np.array([EPS * after[0] for _, after in run.record._tips])
    seen = fx.certify(SCENE, EPS, 1.0, ends, states)
    found = told(run, SCENE, EPS, 1.0, method).residual
    assert 0.3 < found / seen.residual < 3  # 0.86, 1.4


def test_work_of_another_run_is_not_taken(monkeypatch):
    run = Run(np.zeros(1), np.zeros(1), fx.Status.OK, 10.0, 2.0, np.nan, np.nan)
    cell = SCENE, EPS, 1.0, TIMES, 1e-3, "Kvaerno3", 1.0
    asked = []

    def count(*parts):
        asked.append(parts)
        return Counts(10, 2, Work(60.0, 20.0))

    monkeypatch.setattr(timed_runs, "count_work", count)
    known = timed_runs.accounted(run, *cell)
    assert (known.evaluations, known.jacobians) == (60.0, 20.0)
    other = timed_runs.accounted(run._replace(rejected=3.0), *cell)
    assert np.isnan(other.evaluations)
    late = timed_runs.accounted(run._replace(status=fx.Status.TOO_SLOW), *cell)
    assert np.isnan(late.jacobians)
    assert len(asked) == 2
