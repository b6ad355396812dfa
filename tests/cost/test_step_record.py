"""Steps that are told are those made: by lanes, and by SciPy's solvers, which tell none."""

import inspect
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import integrate as scipy_integrate

import frictionjax as fx
from frictionjax.cost.scipy_solvers import run_scipy, told
from frictionjax.cost.step_record import StepRecord
from frictionjax.wiggly.enclosure import marching

EPS, TIMES = 0.2, np.linspace(0.0, 3.0, 5)
SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
    fx.supports.Spring(1.0),
    fx.loads.Sine(1.0488, 3.0),
    duration=3.0,
)


@pytest.mark.parametrize(
    ("eps", "gamma", "accuracy"),
    [(1e-3, 1.0, 1e-5), pytest.param(2.5e-4, 0.25, 1e-3, marks=pytest.mark.slow)],
)
def test_steps_of_lanes_are_all_steps(monkeypatch, eps, gamma, accuracy):
    """Also those of surveys that were made again, and of lanes that look for slip maps."""
    every, marches = np.zeros(2), marching.march

    def march(*parts):
        found = marches(*parts)
        every[:] += np.nansum(found.steps), np.nansum(found.rejected)
        return found

    monkeypatch.setattr(marching, "march", march)
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


def test_looks_of_scipy_are_its_own():
    """Those recorded, of which attempts are told, are what SciPy's solvers have made."""
    told_by, plain = [], scipy_integrate.LSODA.__init__

    def keep(self, *args, **options):
        told_by.append(self)
        plain(self, *args, **options)

    with pytest.MonkeyPatch.context() as change:
        change.setattr(scipy_integrate.LSODA, "__init__", keep)
        run = run_scipy(SCENE, 0.045, 1.0, TIMES, 1e-3, "LSODA", 60.0)
    assert sum(solver.njev for solver in told_by) > 0  # at eps = 0.2: Adams methods alone
    assert len(run.record.looks) == sum(solver.nfev for solver in told_by)
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
