"""References, and errors measured against them: those that were put in."""

import jax.numpy as jnp
import numpy as np
import pytest
from reference import System, sine
from reference import solve as plain_solve
from samples import swinging_scene

import frictionjax as fx
from frictionjax.cost.error_measures import errors_of
from frictionjax.cost.instants import instants, slips_of
from frictionjax.cost.measurement import _Column, _values
from frictionjax.cost.references import _compared, reference
from frictionjax.cost.scipy_solvers import run_scipy, told

EPS, SLOPE = 0.045, 0.1
TIMES = np.linspace(0, 3, 31)


@pytest.fixture(scope="module")
def scene():
    return swinging_scene(SLOPE)


@pytest.fixture(scope="module")
def when(scene):
    return instants(scene, EPS, TIMES)


@pytest.fixture(scope="module")
def truth(scene, when):
    return reference(scene, EPS, 1.0, when, 1e-4)


def true_of(truth):
    return truth.z, truth.dissipation, truth.in_slip


def test_the_reference_is_the_solution(scene, when, truth):
    system = System(
        w=sine(SLOPE),
        bristle=lambda eta: (0.0, 0.0, 1.0 + eta),
        force=lambda z: z,
        load=lambda t: 1.0488 * np.sin(2 * np.pi * t / 3),
        duration=3.0,
        rate=2.2,
    )
    plain = plain_solve(system, EPS, 1.0, 0.0, when.ts)
    outside = ~(plain.in_slip | truth.in_slip)
    assert outside.sum() > 50
    assert np.abs(plain.z - truth.z)[outside].max() < 1e-5 * EPS
    assert np.abs(plain.dissipation - truth.dissipation).max() < 1e-5
    assert truth.errors["error"] < 1e-5
    assert truth.errors["dissipation_error"] < 1e-5
    # The two agree on what a slip is, but for their lengths of its period.
    assert np.mean(plain.in_slip == truth.in_slip) > 0.95


def test_instants_hold_a_whole_slip(when, truth):
    assert np.allclose(when.ts[when.asked], TIMES)
    z = truth.z[when.slip]
    # 32 midpoints of a period: one well, but for a 32nd.
    assert abs(abs(z[-1] - z[0]) / EPS - 1) < 0.15
    assert np.all(np.diff(when.ts) > 0)


def test_a_scene_that_rests_has_no_slip():
    load = fx.loads.Ramp(0.01)
    still = fx.Scene(
        fx.profiles.Sine(SLOPE),
        fx.bristles.Homothetic(1.0),
        fx.supports.Spring(1.0),
        load,
        duration=1.0,
    )
    assert slips_of(still, EPS) == 0
    assert instants(still, EPS, np.linspace(0, 1, 5)).slip.size == 0


@pytest.mark.parametrize("ts", [[2.99], [0.745], [2.98, 2.99]])
def test_a_slip_period_that_is_cut_off_is_none(scene, ts):
    """By the end of the scene, or of the slide: the load turns at 0.75."""
    assert instants(scene, EPS, np.array(ts)).slip.size == 0


def test_a_slip_period_begins_where_a_whole_one_is_left(scene):
    when = instants(scene, EPS, np.array([1.2, 2.99]))
    assert when.slip.size == 32
    begin, end = when.ts[when.slip[[0, -1]]]
    assert 1.2 < begin < end < 1.25
    assert when.ts[when.asked[-1]] == 2.99


def test_errors_at_the_end_are_those_of_the_last_time_asked_for(scene):
    """The slip period after it is no part of what was asked."""
    when = instants(scene, EPS, np.array([0.0, 0.5]))
    assert when.ts[-1] > 0.5
    true_z, spent = 0.1 + when.ts, 2.0 * when.ts
    z, other = true_z.copy(), spent.copy()
    z[when.asked[-1]] += 0.25 * EPS
    other[when.asked[0]] += 0.1  # of the 1 J at 0.5 s
    after = when.ts > 0.5
    z[after] += 7 * EPS
    other[after] += 3.0
    calm = np.zeros(when.ts.size, dtype=bool)
    found = errors_of(z, other, true_z, spent, calm, when, EPS)
    assert found["end_error"] == pytest.approx(0.25)
    assert found["mescd"] == pytest.approx(-np.log10(0.25 * EPS / (EPS + 0.6)))
    assert found["dissipation_error"] == pytest.approx(0.1)
    assert found["slip_error"] == pytest.approx(7.0)


def test_errors_are_what_was_put_in(when, truth):
    shifted = truth.z + 0.25 * EPS
    found = errors_of(shifted, 1.5 * truth.dissipation, *true_of(truth), when, EPS)
    for name in ("error", "slip_error", "end_error"):
        assert found[name] == pytest.approx(0.25)
    assert found["dissipation_error"] == pytest.approx(0.5)
    relative = 0.25 * EPS / (EPS + abs(truth.z[-1]))
    assert found["mescd"] == pytest.approx(-np.log10(relative))
    moved, hidden = truth.z.copy(), truth.in_slip.copy()
    moved[when.asked[5]] += EPS
    hidden[when.asked[5]] = True
    in_slip = truth._replace(in_slip=hidden)
    seen = errors_of(moved, truth.dissipation, *true_of(truth), when, EPS)
    still = errors_of(moved, truth.dissipation, *true_of(in_slip), when, EPS)
    assert seen["error"] == pytest.approx(1.0)
    assert still["error"] == 0.0


@pytest.mark.parametrize(
    "method",
    [pytest.param(m, marks=pytest.mark.slow) for m in ("LSODA", "BDF", "Radau")],
)
def test_scipy_solves_the_same_system(scene, when, truth, method):
    run = run_scipy(scene, EPS, 1.0, when.ts, 1e-6, method, 60.0)
    assert run.status is fx.Status.OK
    found = errors_of(run.z, run.dissipation, *true_of(truth), when, EPS)
    assert found["error"] < 5e-3  # 5e-4, 1.5e-3, 7e-6
    assert found["dissipation_error"] < 1e-3
    assert run.steps > 100
    known = told(run, scene, EPS, 1.0, method)
    assert run.steps + known.rejected == known.steps


def test_tolerances_of_scipy_are_of_periods_wherever_the_tip_is():
    """Relative ones: a tenth of the way from 0, wells after a few."""

    def end(wells):
        rise = wells * EPS
        load = fx.loads.Custom(lambda t: rise + 1.0488 * jnp.sin(2 * jnp.pi * t / 3))
        parts = fx.profiles.Sine(SLOPE), fx.bristles.Homothetic(1.0)
        spring = fx.supports.Spring(1.0)
        scene = fx.Scene(*parts, spring, load, duration=0.7, z0=rise)
        run = run_scipy(scene, EPS, 1.0, np.array([0.7]), 1e-2, "Radau", 60.0)
        return (run.z[0] - rise) / EPS

    assert abs(end(1000) - end(0)) < 1e-2  # 0.88 by relative ones


def test_one_time_is_enough_at_the_start(scene):
    run = run_scipy(scene, EPS, 1.0, np.array([0.0]), 1e-1, "LSODA", 60.0)
    assert run.z.tolist() == [0.0]
    assert told(run, scene, EPS, 1.0, "LSODA").residual == 0.0


def test_nothing_is_known_without_a_reference(scene, when, truth):
    blank = np.full(when.ts.size, np.nan)
    none = blank, blank, np.zeros(when.ts.size, dtype=bool)
    found = errors_of(truth.z, truth.dissipation, *none, when, EPS)
    assert all(np.isnan(value) for value in found.values()), found
    still = np.zeros(when.ts.size)
    found = errors_of(truth.z, still, truth.z, still, truth.in_slip, when, EPS)
    assert found["dissipation_error"] == 0.0


def test_without_a_second_method_the_reference_is_as_bad_as_can_be(when):
    """Of mescd more is better: inf would be the best."""
    errors = _compared(when, EPS, 3.0, []).errors
    assert errors.pop("mescd") == -np.inf
    assert set(errors.values()) == {np.inf}


def test_nothing_is_concluded_below_the_error_of_the_reference(scene, when, truth):
    run = run_scipy(scene, EPS, 1.0, when.ts, 0.5, "LSODA", 60.0)
    for unsure, wrong in ((0.0, 1.0), (100.0, 0.0), (np.inf, 0.0)):
        judge = truth._replace(errors=truth.errors | {"error": unsure})
        column = _Column(scene, EPS, 1.0, when, judge, "LSODA")
        values = _values(run, {}, column, 0.5)
        assert values["error"] > 0.5
        assert values["wrong"] == wrong
