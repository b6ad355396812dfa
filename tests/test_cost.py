"""What accuracy costs: errors are those of the run, failures keep their place."""

import diffrax
import numpy as np
import pytest
from reference import System, sine
from reference import solve as plain_solve

import frictionjax as fx
from frictionjax import cost_of_accuracy
from frictionjax.cost_of_accuracy import _Column, _values
from frictionjax.error_measures import errors_of
from frictionjax.instants import instants, slips_of
from frictionjax.plot.work_precision import _front
from frictionjax.references import reference
from frictionjax.report.cost import chosen_eps, cost_sections
from frictionjax.wiggly.general import run_scipy, told

EPS, SLOPE = 0.045, 0.1
TIMES = np.linspace(0, 3, 31)


@pytest.fixture(scope="module")
def scene():
    return fx.Scene(
        fx.profiles.Sine(SLOPE),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0488, 3.0),
        duration=3.0,
    )


@pytest.fixture(scope="module")
def when(scene):
    return instants(scene, EPS, TIMES)


@pytest.fixture(scope="module")
def truth(scene, when):
    return reference(scene, EPS, 1.0, when, 1e-4)


@pytest.fixture(scope="module")
def data(scene):
    methods = ["auto", "Kvaerno3", "LSODA"]
    return fx.work_precision(scene, EPS, 1.0, methods, [1e-1, 1e-4], TIMES, repeats=2)


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


@pytest.mark.parametrize("method", ["LSODA", "BDF", "Radau"])
def test_scipy_solves_the_same_system(scene, when, truth, method):
    run = run_scipy(scene, EPS, 1.0, when.ts, 1e-6, method, 60.0)
    assert run.status is fx.Status.OK
    found = errors_of(run.z, run.dissipation, *true_of(truth), when, EPS)
    assert found["error"] < 5e-3  # 5e-4, 1.5e-3, 7e-6
    assert found["dissipation_error"] < 1e-3
    assert run.steps > 100
    assert run.evaluations > run.steps
    assert run.jacobians > 0
    known = told(run, scene, EPS, 1.0, method)
    assert run.steps + known.rejected == known.steps


def test_measurements(data):
    assert data.error.dims == ("gamma", "eps", "solver", "accuracy")
    assert list(data.accuracy) == [1e-1, 1e-4]
    cell = data.isel(gamma=0, eps=0)
    ours = cell.sel(solver="auto")
    assert np.all(ours.status == 0)
    assert np.all(ours.error < ours.accuracy)
    assert np.all(ours.dissipation_error < ours.accuracy)
    assert float(cell.reference_error) < 1e-6
    assert np.all(ours.seconds_low <= ours.seconds)
    assert np.all(ours.seconds <= ours.seconds_high)
    assert np.all(ours.evaluations > ours.steps)
    assert np.all(cell.sel(solver="Kvaerno3").error < ours.accuracy)
    for name in ("steps", "rejected", "evaluations", "jacobians", "residual"):
        assert np.all(np.isfinite(cell[name])), name
    assert np.all(cell.rejected < 0.5 * cell.steps)
    implicit = cell.sel(solver="Kvaerno3")
    assert np.all(implicit.evaluations > 5 * implicit.steps)
    assert np.all(implicit.jacobians == 2 * implicit.steps)


def test_success_in_another_well_is_called_wrong(data):
    loose = data.isel(gamma=0, eps=0).sel(solver="LSODA", accuracy=1e-1)
    assert int(loose.status) == fx.Status.OK
    assert float(loose.error) > 0.5
    assert int(loose.wrong) == 1
    assert float(loose.residual) > 1.0  # 45; 0.0062 and less of the others
    assert np.all(data.residual.sel(solver=["auto", "Kvaerno3"]) < 1e-3)
    assert int(data.sel(solver="auto").wrong.sum()) == 0
    table = dict(cost_sections(data))[f"gamma = 1, eps = {EPS:.4g} m"]
    assert "wrong" in next(x for x in table.splitlines() if x.startswith("LSODA"))


@pytest.mark.parametrize(
    "method", ["Radau", pytest.param("Kvaerno3", marks=pytest.mark.slow)]
)
def test_slow_runs_end_and_keep_their_place(scene, method):
    cost = fx.work_precision(scene, EPS, 1.0, method, [1e-2, 1e-4], TIMES, seconds=0.01)
    states = cost.status.values.ravel()
    assert list(states) == [fx.Status.TOO_SLOW, fx.Status.NOT_TRIED]
    for name in ("error", "end_error", "mescd", "dissipation_error"):
        assert np.all(np.isnan(cost[name]))


def test_bad_arguments_are_named(scene):
    for change, message in [
        ({"methods": "Euler5"}, "methods = 'Euler5'"),
        ({"methods": None}, "methods = 'None'"),
        ({"methods": 5}, "methods = '5'"),
        ({"methods": []}, "methods = .*at least one"),
        ({"methods": np.array(["auto", "Euler5"])}, "methods = 'Euler5'"),
        ({"methods": ["auto", "auto"]}, "methods = .*once"),
        ({"accuracies": [0.0]}, "accuracies = 0"),
        ({"accuracies": [1e-2, 1e-9]}, "accuracies = 1e-09: .* 1e-08"),
        ({"accuracies": []}, "accuracies = "),
        ({"accuracies": None}, "accuracies = None"),
        ({"accuracies": "abc"}, "accuracies = 'abc'"),
        ({"accuracies": [[1e-2], [1e-3, 1e-4]]}, "accuracies = "),
        ({"eps": -1.0}, "eps = -1"),
        ({"gamma": 0.0}, "gamma = 0"),
        ({"seconds": 0.0}, "seconds = 0"),
        ({"repeats": 0}, "repeats = 0"),
        ({"repeats": 2.5}, "repeats = 2.5"),
        ({"progress": "no"}, "progress = 'no'"),
        ({"ts": [5.0]}, "ts = "),
    ]:
        with pytest.raises(ValueError, match=message):
            fx.work_precision(scene, **{"eps": EPS, **change})


def test_a_solver_of_the_user_is_one_method(scene):
    data = fx.work_precision(scene, EPS, 1.0, diffrax.Kvaerno3(), 1e-1, TIMES, repeats=1)
    assert data.solver.values.tolist() == ["Kvaerno3"]
    assert int(data.runs[0, 0, 0, 0]) == 1
    line = cost_sections(data)[0][1].splitlines()[-1].split()
    assert line[9] == "-"  # one run has no spread


def test_our_methods_are_clocked_before_the_reference(scene, monkeypatch):
    """The reference runs the same programs: clocked after it they seem to be free."""
    order = []

    def noted(name, call):
        def noting(*args):
            order.append(name)
            return call(*args)

        return noting

    for name in ("clocked", "reference"):
        call = noted(name, getattr(cost_of_accuracy, name))
        monkeypatch.setattr(cost_of_accuracy, name, call)
    methods = ["auto", "LSODA"]
    data = fx.work_precision(scene, EPS, 1.0, methods, 1e-2, TIMES, repeats=1)
    assert order == ["clocked", "reference"]
    assert float(data.compile_seconds.sel(solver="auto").item()) >= 0


def test_nothing_is_known_without_a_reference(scene, when, truth):
    blank = np.full(when.ts.size, np.nan)
    none = blank, blank, np.zeros(when.ts.size, dtype=bool)
    found = errors_of(truth.z, truth.dissipation, *none, when, EPS)
    assert all(np.isnan(value) for value in found.values()), found
    still = np.zeros(when.ts.size)
    found = errors_of(truth.z, still, truth.z, still, truth.in_slip, when, EPS)
    assert found["dissipation_error"] == 0.0


def test_nothing_is_concluded_below_the_error_of_the_reference(scene, when, truth):
    run = run_scipy(scene, EPS, 1.0, when.ts, 1e-1, "LSODA", 60.0)
    for unsure, wrong in ((0.0, 1.0), (100.0, 0.0), (np.inf, 0.0)):
        judge = truth._replace(errors=truth.errors | {"error": unsure})
        column = _Column(scene, EPS, 1.0, when, judge, "LSODA")
        values = _values(run, {}, column)
        assert values["error"] > 0.5
        assert values["wrong"] == wrong


@pytest.mark.parametrize("unsure", [1e-2, 1e2, np.inf])
def test_a_picture_shades_what_the_reference_cannot_judge(data, unsure):
    unsure_data = data.assign(reference_error=data.reference_error * 0 + unsure)
    for axes in fx.plot.draw_work_precision(unsure_data).axes:
        shades = [p for p in axes.patches if p.get_facecolor()[:3] == (238 / 255,) * 3]
        low, high = axes.get_ylim()
        top = max(patch.get_window_extent().y1 for patch in shades)
        shown = axes.transData.inverted().transform((0.0, top))[1]
        edge = min(max(min(unsure, 1e3), low), high)
        assert shown == pytest.approx(edge, rel=1e-6)
        said = any("no reference" in text.get_text() for text in axes.texts)
        assert said == np.isinf(unsure)


def test_a_picture_of_nothing_but_failures(data):
    nothing = data.assign(error=data.error * np.nan)
    fx.plot.draw_work_precision(nothing).canvas.draw()


def test_the_front_is_what_no_run_beats():
    points = np.random.default_rng(0).uniform(size=(2, 40))
    expected = {
        (t, e)
        for t, e in points.T
        if not any(a <= t and b <= e and (a, b) != (t, e) for a, b in points.T)
    }
    assert {(t, e) for t, e in _front(points).T} == expected


def test_picture(data):
    picture = fx.plot.draw_work_precision(data)
    assert len(picture.axes) == 2
    assert "LSODA" in " ".join(t.get_text() for t in picture.axes[0].get_legend().texts)
    with pytest.raises(ValueError, match=r"eps = 0\.3: .*one of 0\.045"):
        fx.plot.draw_work_precision(data, eps=0.3)
    assert len(fx.plot.draw_work_precision(data, eps=EPS).axes) == 2


def test_cells_of_a_study_that_are_measured(scene):
    eps = np.geomspace(0.1, 1e-7, 13)
    chosen = chosen_eps(scene, eps)
    slips = slips_of(scene, 1.0) / np.array(chosen)
    assert len(chosen) == 3
    assert np.all(slips < 4e4)
    assert np.all(slips > 30)


def test_a_scene_at_rest_has_cells_to_measure_too():
    rest = fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.Sine(0.01, 3.0),
        3.0,
    )
    assert slips_of(rest, 1.0) == 0
    assert chosen_eps(rest, [1e-3, 1e-1, 1e-2, 1e-4]) == [1e-1, 1e-3, 1e-4]
    assert chosen_eps(rest, 1e-3) == [1e-3]
