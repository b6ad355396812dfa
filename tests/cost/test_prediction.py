"""Predicted cost: work from the plan, seconds from a measured machine, budgets."""

import json
import tracemalloc

import numpy as np
import pytest
from flat_folds import SCENES

import frictionjax as fx
from frictionjax._checks.grids import cells_of
from frictionjax.cost import machine_cost
from frictionjax.cost import prediction as cost_prediction
from frictionjax.cost.machine_cost import (
    ELSEWHERE,
    MachineCost,
    keep_machine,
    known_machine,
)
from frictionjax.cost.settings import SETTINGS
from frictionjax.model import tabulated_scene
from frictionjax.report.job import read_job
from frictionjax.report.study import expectation, expected_cost, within_budget
from frictionjax.wiggly.enclosure import BracketContext, lay_out, marching
from frictionjax.wiggly.limit_path import path_of
from frictionjax.wiggly.plan import planned
from frictionjax.wiggly.predicted_work import _longest_chains, _weight_of, workload
from frictionjax.wiggly.ways import Way

TIMES = np.linspace(0.0, 3.0, 61)
MACHINE = MachineCost(0.01, 0.002, 1e-5, 1e-7, 1e-6, 5.0, 1e9)


def scene_of(load=None):
    return fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        load or fx.loads.Sine(1.0488, 3.0),
        duration=3.0,
    )


@pytest.fixture(autouse=True)
def known(monkeypatch):
    """A machine that is known: tests measure none."""
    for name in ("machine_cost", "known_machine"):
        monkeypatch.setattr(cost_prediction, name, lambda: MACHINE)


@pytest.mark.parametrize(
    ("eps", "gamma", "accuracy", "method"),
    [
        (5e-2, 1.0, 1e-3, "auto"),
        (1e-5, 1.0, 1e-3, "auto"),
        pytest.param(2e-3, 2.0, 1e-3, "auto", marks=pytest.mark.slow),
        pytest.param(1e-2, 1.0, 1e-5, "auto", marks=pytest.mark.slow),
        (5e-3, 1.0, 1e-3, "resolved"),
        (2e-3, 0.5, 1e-3, "auto"),
    ],
)
def test_the_work_is_foreseen(eps, gamma, accuracy, method):
    cell = np.array([eps]), np.array([gamma])
    work = workload(scene_of(), *cell, TIMES.size, accuracy, method)
    data = fx.sweep(scene_of(), *cell, TIMES, accuracy, method)
    ratio = float(data.steps.squeeze()) / float(work.steps[0])
    assert 0.5 < ratio < 2, ratio  # 0.57 to 1.4


@pytest.mark.parametrize(
    ("gamma", "eps"),
    [
        pytest.param(0.5, 1e-4, marks=pytest.mark.slow),
        pytest.param(1.0, 1e-6, marks=pytest.mark.slow),
        (2.0, 1e-7),
    ],
)
def test_the_work_on_straight_flanks_is_foreseen(gamma, eps):
    """Eleven times too much and ten times too little was said."""
    cell = np.array([eps]), np.array([gamma])
    work = workload(SCENES["sawtooth"], *cell, TIMES.size, 1e-3, "auto")
    data = fx.sweep(SCENES["sawtooth"], *cell, TIMES)
    assert 0.5 < data.steps.item() / float(work.steps[0]) < 2


_STEPPED = fx.loads.PiecewiseLinear(
    [0.0, 1.0, 1.001, 2.0, 2.001, 3.0], [0.0, 0.0, 1.0, 1.0, -1.0, -1.0]
)


@pytest.mark.parametrize(
    ("load", "duration", "eps", "gamma"),
    [
        (fx.loads.Sine(1.0488, 3.0), 30.0, 1e-3, 0.5),  # 21 slip maps, side by side
        (fx.loads.Sine(1.0488, 3.0), 30.0, 1e-2, 0.5),  # one lane through all
        (fx.loads.Sine(0.05, 3.0), 300.0, 1e-2, 1.0),  # never out of the strip
        # Slip maps one after the other: slides end at speed.
        pytest.param(
            fx.loads.Triangle(1.0488, 0.3), 3.0, 1e-3, 1.0, marks=pytest.mark.slow
        ),
        # Tips that follow only after a jump.
        pytest.param(_STEPPED, 3.0, 1e-3, 1.0, marks=pytest.mark.slow),
        pytest.param(_STEPPED, 3.0, 1e-3, 0.5, marks=pytest.mark.slow),
    ],
)
def test_the_work_of_other_loads_is_foreseen(load, duration, eps, gamma):
    """Up to 37 and 212 times too little was said."""
    one = scene_of(load)
    scene = fx.Scene(one.profile, one.bristle, one.support, load, duration)
    times = np.linspace(0, duration, 61)
    work = workload(scene, np.array([eps]), np.array([gamma]), 61, 1e-3, "auto")
    data = fx.sweep(scene, eps, gamma, times)
    ratio = data.steps.item() / float(work.steps[0])
    assert 0.4 < ratio < 2.5, ratio  # 0.49 to 0.81


@pytest.mark.parametrize(("gamma", "steps"), [(0.5, 2.31e5), (1.0, 1.04e5)])
def test_the_work_of_jumps_is_foreseen(gamma, steps):
    """Steps as the sweep reports them, see above."""
    cell = np.array([1e-3]), np.array([gamma])
    work = workload(scene_of(_STEPPED), *cell, 61, 1e-3, "auto")
    assert 0.4 < steps / float(work.steps[0]) < 2.5


def test_turns_take_time_where_nothing_slides():
    """2000 of them: 1.8 to 3.4 s, foretold as 0.04 s."""
    long = scene_of(fx.loads.Sine(0.05, 3.0)).replace(duration=3000.0)
    found = [fx.predict_cost(one, [1e-2, 1e-5], 1.0) for one in (scene_of(), long)]
    turns = 2000 * SETTINGS.piece_calls * MACHINE.call
    assert found[1].seconds - found[0].seconds > 0.9 * turns
    assert 0.3 < found[1].seconds < 3.0


def test_slip_maps_that_wait_for_each_other():
    slides = np.array([[1, 0, 1, 0, 1, 1], [1, 1, 1, 1, 0, 0], [0, 0, 0, 0, 0, 0]], bool)
    cut = np.array([[0, 1, 0, 0, 0, 0], [1, 1, 1, 1, 1, 1], [0, 0, 0, 0, 0, 0]], bool)
    assert _longest_chains(slides, cut).tolist() == [3, 1, 0]


@pytest.mark.parametrize(("periods", "alone"), [(1, False), (3, True), (100, True)])
def test_many_short_slides_are_no_matter_for_slip_maps(periods, alone):
    """100 periods of 380 wells took 14 s by maps, one lane goes through them in 3."""
    one = scene_of()
    end = 3.0 * periods
    scene = fx.Scene(one.profile, one.bristle, one.support, one.load, end)
    eps = np.array([1.5e-3 if periods == 1 else 1e-2])
    tables = tabulated_scene(scene, eps)
    plan = planned(
        tables, path_of(tables), eps, np.array([0.5]), 61, accuracy=1e-3, method="auto"
    )
    assert plan.way == (Way.ONE_LANE if alone else Way.SLIP_MAP)


@pytest.mark.parametrize(
    ("eps", "gamma", "times", "method"),
    [
        pytest.param(
            *([5e-2, 1e-2, 1e-3], [1.0, 2.0], 401, "auto"), marks=pytest.mark.slow
        ),
        ([1e-5], [1.0], 401, "auto"),
        ([1e-3], [1.0], 2001, "resolved"),
    ],
)
def test_the_rows_of_tables_are_foreseen(monkeypatch, eps, gamma, times, method):
    rows, plans = np.zeros(2), marching.plan_brackets

    def plan(*parts):
        found = plans(*parts)
        rows[:] += found.jobs.cell.size, found.segments.start.size
        return found

    monkeypatch.setattr(marching, "plan_brackets", plan)
    cells = cells_of(np.array(eps), np.array(gamma))
    work = workload(scene_of(), *cells, times, 1e-3, method)
    fx.sweep(scene_of(), eps, gamma, np.linspace(0.0, 3.0, times), 1e-3, method)
    ratios = rows / (work.jobs.sum(), work.segments.sum())
    assert np.all((ratios > 0.7) & (ratios < 1.3)), ratios


@pytest.mark.parametrize(("eps", "gamma"), [(1e-7, 0.25), (1e-5, 0.5)])
def test_rows_of_lanes_beside_slip_maps_are_foreseen(monkeypatch, eps, gamma):
    """As many as through all wells between, 3 GB of them, were foretold for 5 MB."""
    rows, plans = [], marching.plan_brackets

    def plan(*parts):
        found = plans(*parts)
        rows.append(found.segments.start.size)
        return found

    monkeypatch.setattr(marching, "plan_brackets", plan)
    work = workload(scene_of(), np.array([eps]), np.array([gamma]), 2, 1e-3, "auto")
    assert work.maps.sum() > 0
    fx.sweep(scene_of(), eps, gamma, [0.0, 3.0])
    assert 0.2 < max(rows) / work.segments.sum() < 2


def test_tables_grow_with_the_times_and_not_their_square():
    """The layout of 20 001 times took 0.4 GB, of 200 001 it failed."""
    cell = np.array([1e-3]), np.array([1.0])
    scene = tabulated_scene(scene_of(), 1e-3)
    path = path_of(scene)
    ts = np.sort(np.concatenate([np.linspace(0.0, 3.0, 20_000), [1.5, 1.5]]))
    plan = planned(scene, path, *cell, ts.size, accuracy=1e-3, method="resolved")
    tracemalloc.start()
    blank = BracketContext(*[None] * 11)
    rounds = blank._replace(path=path, ground=plan.ground, accuracy=1e-3)
    found = lay_out(rounds, ts, plan.needs)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 1000 * ts.size, most / ts.size
    at = found.output[0]
    assert np.all(found.brackets.stop[at[1:]] == ts[1:])
    assert at[0] == -1  # the start is known


def test_work_follows_from_the_numbers():
    grid = np.array([1e-3, 1e-4]), np.array([1.0, 1.0])
    every = workload(scene_of(), *grid, TIMES.size, 1e-3, "resolved")
    assert every.steps[1] == pytest.approx(10 * every.steps[0], rel=0.5)
    small = np.array([1e-5, 1e-7]), np.array([1.0, 1.0])
    some = workload(scene_of(), *small, TIMES.size, 1e-3, "windowed")
    assert some.steps[1] < 2 * some.steps[0]
    waves = fx.profiles.Fourier(np.zeros(16), 0.005 * 0.5 ** np.arange(16))
    parts = scene_of()
    bumpy = fx.Scene(waves, parts.bristle, parts.support, parts.load, 3.0)
    weights = [_weight_of(tabulated_scene(scene, 1e-3)) for scene in (bumpy, parts)]
    assert weights[0] > 1.2 * weights[1]  # 0.21 us a step in pieces, 0.16 of a sine


def test_a_machine_is_found_from_its_times(monkeypatch):
    true = MachineCost(0.02, 0.005, 0.0, 2e-7, 3e-6, 0.0, 0.0)

    def clocked(scene, eps, gamma, method):
        cells = cells_of(eps, gamma)
        return true.seconds(workload(scene, *cells, TIMES.size, 1e-3, method)), 0.5

    monkeypatch.setattr(machine_cost, "_clocked", clocked)
    found = machine_cost.measure_machine()
    assert found[:5] == pytest.approx(true[:5], rel=1e-6, abs=1e-9)
    assert found.compilation == pytest.approx(0.5 * len(machine_cost._RUNS))
    assert 1e8 < found.memory < 1e11


@pytest.mark.parametrize("before", [0.3e9, 9e9])
def test_what_a_process_did_before_is_no_memory_of_a_sweep(monkeypatch, before):
    sizes, longer = iter([before, before + 0.6e9] * 2), iter([0.5] * 7 + [0.001] * 7)
    monkeypatch.setattr(machine_cost, "_clocked", lambda *_: (0.1, next(longer)))
    monkeypatch.setattr(machine_cost, "_resident_bytes", lambda: next(sizes))
    cold, warm = machine_cost.measure_machine(), machine_cost.measure_machine()
    assert cold.memory == pytest.approx(0.8e9)
    assert cold.compilation == pytest.approx(3.5)
    known = machine_cost.ELSEWHERE
    assert (warm.compilation, warm.memory) == (known.compilation, known.memory)


def test_a_measurement_is_kept(tmp_path, monkeypatch):
    assert known_machine(tmp_path) is None
    keep_machine(MACHINE, tmp_path)
    assert known_machine(tmp_path) == MACHINE
    # Other flags are another machine, and both are kept.
    with monkeypatch.context() as change:
        change.setenv("XLA_FLAGS", "--other")
        assert known_machine(tmp_path) is None
        keep_machine(MACHINE._replace(call=1.0), tmp_path)
    assert known_machine(tmp_path) == MACHINE
    path = tmp_path / "cost.json"
    assert len(json.loads(path.read_text())) == 2


@pytest.mark.parametrize("text", ["", "[]", "{", '{"a": 1}'])
def test_a_spoiled_file_is_no_measurement(tmp_path, text):
    (tmp_path / "cost.json").write_text(text)
    assert known_machine(tmp_path) is None
    keep_machine(MACHINE, tmp_path)
    assert known_machine(tmp_path) == MACHINE


def test_a_spoiled_number_is_no_measurement(tmp_path):
    keep_machine(MACHINE, tmp_path)
    path = tmp_path / "cost.json"
    for bad in ("NaN", "-1.0", '"1"', "true", f"1{400 * '0'}"):
        path.write_text(path.read_text().replace(json.dumps(MACHINE.call), bad))
        assert known_machine(tmp_path) is None
        keep_machine(MACHINE, tmp_path)


def test_a_measurement_of_nothing_is_none(tmp_path):
    keep_machine(MachineCost(0.0, 0.0, 0.0, 0.0, 0.0, 5.0, 1e9), tmp_path)
    assert known_machine(tmp_path) is None


def test_a_folder_that_cannot_be_written_is_said_once(tmp_path, monkeypatch):
    """It raised after the 15 s of the measurement, each time."""
    monkeypatch.setattr(machine_cost, "_UNWRITTEN", {})
    monkeypatch.setattr(machine_cost, "measure_machine", lambda: MACHINE)
    (tmp_path / "file").write_text("")
    with pytest.warns(UserWarning, match="measured again next time: .*file"):
        assert machine_cost.machine_cost(tmp_path / "file") == MACHINE
    monkeypatch.setattr(machine_cost, "measure_machine", None)
    assert machine_cost.machine_cost(tmp_path / "file") == MACHINE


def test_measured_once(tmp_path, monkeypatch):
    times = []
    monkeypatch.setattr(machine_cost, "measure_machine", lambda: times.append(1) or MACHINE)
    for _ in range(2):
        assert machine_cost.machine_cost(tmp_path) == MACHINE
    assert len(times) == 1
    machine_cost.machine_cost(tmp_path, again=True)
    assert len(times) == 2


def test_prediction_of_a_sweep():
    eps, gamma = [1e-2, 1e-3], [1.0, 2.0]
    cost = fx.predict_cost(scene_of(), eps, gamma, 1e-3, TIMES)
    assert cost.cells.shape == (2, 2)
    # One sweep shares its calls and cores.
    assert cost.cells.max() < cost.seconds < cost.cells.sum()
    assert cost.low < cost.seconds < cost.high
    assert cost.compilation == MACHINE.compilation
    assert cost.memory > MACHINE.memory
    alone = fx.predict_cost(scene_of(), 1e-3, 1.0, 1e-3, TIMES)
    assert alone.seconds == pytest.approx(cost.cells[0, 1])
    assert "another machine" not in str(cost)
    assert "GB" in str(cost)


def test_without_a_measurement_the_prediction_says_so(monkeypatch):
    monkeypatch.setattr(cost_prediction, "known_machine", lambda: None)
    cost = fx.predict_cost(scene_of(), 1e-2, 1.0, measure=False)
    assert not cost.measured
    assert "another machine" in str(cost)
    assert cost.compilation == ELSEWHERE.compilation


def test_too_many_turns_are_unknown(monkeypatch):
    monkeypatch.setattr(cost_prediction, "workload", lambda *parts: None)
    cost = fx.predict_cost(scene_of(), [1e-2, 1e-3], 1.0)
    assert np.isnan(cost.seconds)
    assert "unknown" in str(cost)


def test_budgets(monkeypatch):
    eps = np.geomspace(1e-1, 1e-6, 12)
    plenty = fx.fit_budget(scene_of(), eps, 1.0, 1e3, TIMES)
    assert plenty.accuracy == 1e-6
    assert plenty.eps.size == 12
    loose, tight = (
        fx.predict_cost(scene_of(), eps, 1.0, a, TIMES).seconds for a in (1e-3, 1e-6)
    )
    middle = fx.fit_budget(scene_of(), eps, 1.0, np.sqrt(loose * tight), TIMES)
    assert 1e-6 < middle.accuracy <= 1e-3
    assert middle.eps.size == 12
    assert middle.cost.seconds <= np.sqrt(loose * tight)
    fewer = fx.fit_budget(scene_of(), eps, 1.0, 0.6 * loose, TIMES)
    assert fewer.accuracy == 1e-3
    assert 4 <= fewer.eps.size < 12
    assert set(fewer.eps) < set(eps)
    with pytest.raises(ValueError, match=r"budget = 1e-06: needs at least .* for 4 eps"):
        fx.fit_budget(scene_of(), eps, 1.0, 1e-6, TIMES)


def test_bad_arguments_are_named():
    for change, message in [
        ({"eps": -1.0}, "eps = -1"),
        ({"gamma": "one"}, "gamma = "),
        ({"accuracy": 0.0}, "accuracy = 0"),
        ({"method": "Kvaerno5"}, "method = 'Kvaerno5': needs one of auto"),
        ({"ts": [4.0]}, "ts = "),
        ({"measure": "no"}, "measure = 'no'"),
    ]:
        with pytest.raises(ValueError, match=message):
            fx.predict_cost(scene_of(), **{"eps": 1e-2, **change})
    for accuracies in ([], 2.0, "abc", [[1e-2], [1e-3, 1e-4]], None):
        with pytest.raises(ValueError, match="accuracies = "):
            fx.fit_budget(scene_of(), 1e-2, 1.0, 1.0, accuracies=accuracies)
    for budget in (0.0, np.nan, [1.0, 2.0]):
        with pytest.raises(ValueError, match="budget = "):
            fx.fit_budget(scene_of(), 1e-2, 1.0, budget)


def test_other_methods_cost_nobody_knows_what():
    """Said before anything runs; a name that is none is refused first."""
    job = read_job(None)
    assert "unknown time" in expectation(job, "Kvaerno5")
    with pytest.raises(ValueError, match="method = 'Euler5'"):
        expectation(job, "Euler5")


def test_memory_is_that_of_now_not_the_most_so_far():
    large = np.ones(3 * 10**7)
    with_it = machine_cost._resident_bytes()
    del large
    assert machine_cost._resident_bytes() < with_it - 1e8


def test_a_study_within_a_budget():
    job = read_job(None)
    job = job._replace(study=job.study | {"gamma": [1.0]})
    some, said = within_budget(job, 1e3, "auto", None)
    assert said.startswith("Budget of 1000 s: accuracy 1e-06, 16 of 16 eps")
    assert said in some.notes
    assert some.study["accuracy"] == 1e-6
    assert some.study["eps"] == sorted(job.study["eps"], reverse=True)
    tighter = job._replace(study=job.study | {"accuracy": 1e-8})
    assert within_budget(tighter, 1e3, "auto", None)[0].study["accuracy"] == 1e-8
    cost = expected_cost(job, "auto")
    fewer, said = within_budget(job, 0.6 * cost.seconds, "auto", 1e-3)
    assert fewer.study["accuracy"] == 1e-3
    assert 4 <= len(fewer.study["eps"]) < len(job.study["eps"])
    assert said in fewer.notes
    assert expected_cost(job, "Kvaerno5") is None
