"""What parts of a sweep take on a machine: measured once, and kept."""

import json

import pytest
from foretold import MACHINE, TIMES

from frictionjax._checks.grids import cells_of
from frictionjax.cost import machine_cost
from frictionjax.cost.machine_cost import (
    MachineCost,
    keep_machine,
    known_machine,
)
from frictionjax.wiggly.predicted_work import workload


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
