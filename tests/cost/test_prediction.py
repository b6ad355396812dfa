"""Predicted cost: seconds and memory from a machine that is known, budgets."""

import numpy as np
import pytest
from foretold import MACHINE, TIMES, scene_of

import frictionjax as fx
from frictionjax.cost import machine_cost
from frictionjax.cost import prediction as cost_prediction
from frictionjax.cost.machine_cost import ELSEWHERE
from frictionjax.cost.settings import SETTINGS
from frictionjax.report.job import read_job
from frictionjax.report.study import expectation, expected_cost, within_budget


@pytest.fixture(autouse=True)
def known(monkeypatch):
    """A machine that is known: tests measure none."""
    for name in ("machine_cost", "known_machine"):
        monkeypatch.setattr(cost_prediction, name, lambda: MACHINE)


def test_turns_take_time_where_nothing_slides():
    """2000 of them: 1.8 to 3.4 s, foretold as 0.04 s."""
    long = scene_of(fx.loads.Sine(0.05, 3.0)).replace(duration=3000.0)
    found = [fx.predict_cost(one, [1e-2, 1e-5], 1.0) for one in (scene_of(), long)]
    turns = 2000 * SETTINGS.piece_calls * MACHINE.call
    assert found[1].seconds - found[0].seconds > 0.9 * turns
    assert 0.3 < found[1].seconds < 3.0


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
