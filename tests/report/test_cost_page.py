"""The report of what accuracy costs: the best run, and those that were wrong."""

import time

import numpy as np
import pytest
import xarray as xr
from html_pages import cells_of_table, checked_page

import frictionjax as fx
from frictionjax.cost.advice import advice
from frictionjax.report.cost import ASKED, measured_cells, run_cost
from frictionjax.report.cost_page import verdict_of_cost
from frictionjax.report.job import ReportRequest, read_job

SOLVERS = "auto", "LSODA", "Radau"


def measured(eps=(0.01, 0.001)):
    """As of `work_precision`: LSODA is wrong at the loosest accuracy, Radau never done."""
    asked, gamma = np.array([1e-2, 1e-3]), [1.0]
    dims = "gamma", "eps", "solver", "accuracy"
    shape = 1, len(eps), 3, 2
    error = np.broadcast_to(0.1 * asked, shape).copy()
    seconds = np.broadcast_to(np.array([[0.3, 0.5], [0.2, 0.4], [9.0, 9.0]]), shape).copy()
    status, wrong = np.zeros(shape, dtype=np.int8), np.zeros(shape)
    status[:, :, 2] = int(fx.Status.TOO_SLOW)
    error[:, :, 2] = np.nan
    error[:, :, 1, 0], wrong[:, :, 1, 0] = 31.25, 1.0
    columns = {"seconds": seconds, "error": error, "status": status, "wrong": wrong}
    columns |= {"seconds_low": 0.9 * seconds, "seconds_high": 1.5 * seconds}
    others = ("slip_error", "end_error", "dissipation_error", "residual", "mescd")
    columns |= dict.fromkeys(others, 0.5 * error)
    columns |= dict.fromkeys(("runs", "steps", "rejected"), np.full(shape, 3))
    columns |= dict.fromkeys(("compile_seconds", "calls_share"), np.full(shape, 0.25))
    data = xr.Dataset({name: (dims, values) for name, values in columns.items()})
    for name in ("error", "slip_error", "end_error", "dissipation_error", "mescd"):
        data[f"reference_{name}"] = dims[:2], np.full(shape[:2], 1e-6)
    data["reference_ways"] = dims[:2], np.full(shape[:2], "one <way> against another")
    coords = {"gamma": gamma, "eps": list(eps), "solver": list(SOLVERS), "accuracy": asked}
    data = data.assign_coords(coords)
    data.status.attrs["flag_values"] = np.array([int(s) for s in fx.Status], dtype=np.int8)
    data.status.attrs["flag_meanings"] = " ".join(s.name.lower() for s in fx.Status)
    data.attrs["advice"] = "For 1e-3 eps take <this>."
    return data


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """Written once, 3 s, and only read."""
    folder = tmp_path_factory.mktemp("cost")
    request = ReportRequest("frictionjax cost --report", time.perf_counter())
    job = read_job(None)._replace(report=request)
    with pytest.MonkeyPatch.context() as patch:
        name = "frictionjax.report.cost.work_precision"
        patch.setattr(name, lambda *_, **__: measured())
        run_cost(job, folder, None, None, 1.0, False)
    return checked_page((folder / "report.html").read_text(encoding="utf-8"))


def test_every_number_of_every_run_is_in_it(page):
    words = set(page.text.split())
    for _, _, table in measured_cells(measured()):
        for cell in cells_of_table(table):
            assert set(cell.split()) <= words, cell


def test_what_was_wrong_and_what_was_not_done_is_listed(page):
    assert "Of 12 runs 2 reported success and were half an eps or more off" in page.text
    assert "LSODA 2" in page.text
    assert "For 1e-3 eps take <this>." in page.text
    assert "and 4 were too slow or failed" in page.text
    assert page.text.count("wrong success was reported half an eps or more off") == 2
    assert "one <way> against another" in page.text
    assert "frictionjax cost --report" in page.text
    again = (
        "--eps 0.01,0.001 --gamma 1.0 --accuracies 0.01,0.001 --methods auto,LSODA,Radau"
    )
    assert f"frictionjax cost scene.toml {again} --seconds 1 --out again" in page.text


def test_the_first_sentence_is_what_the_shell_prints_and_there_is_no_other(page):
    (said,) = page.text.split("For 1e-3 eps take <this>.")[1:]
    assert said.lstrip().startswith("Of 12 runs 2 reported success and were half an eps")
    assert "ask it for" not in page.text
    data = measured()
    data.attrs["advice"] = advice(data)
    told = "For 1e-03 eps take method='LSODA', accuracy=1e-03: z within 1.0e-04 eps in all"
    assert verdict_of_cost(data).startswith(f"{told} 2 cells in 0.8 s, the next method")


def test_the_reference_is_said_to_be_known_as_well_as_its_two_ways_agree(page):
    """Its own difference may be as large as the error of a run."""
    assert "computed in two ways, which is known as well as these agree" in page.text
    assert "more accurate than" not in page.text
    assert "much more accurately" not in page.text


def test_where_nothing_is_accurate_enough_it_says_so():
    data = measured()
    data["error"] = data.error + 1.0
    data.attrs["advice"] = advice(data)
    assert "No method was measured to keep 1e-03 eps" in verdict_of_cost(data)
    assert "none reported success" in verdict_of_cost(data.assign(wrong=0 * data.wrong))


def test_runs_that_nobody_has_begun_are_counted_apart():
    """They were told as too slow or failed."""
    data = measured()
    data.status[0, 0, 2, 1] = int(fx.Status.NOT_TRIED)
    said = verdict_of_cost(data)
    assert "(`LSODA` 2), 3 were too slow or failed, and 1 was not tried." in said


def test_methods_that_take_all_the_time_come_after_ours():
    ours = [ASKED.index(name) for name in ("auto", "resolved", "windowed")]
    assert max(ours) < min(ASKED.index(name) for name in ("BDF", "Radau", "Kvaerno5"))


def test_one_run_is_no_plural():
    data = measured()
    one = data.wrong.dims, np.arange(data.wrong.size).reshape(data.wrong.shape) == 0
    said = verdict_of_cost(data.assign(wrong=one))
    assert "Of 12 runs 1 reported success and was half an eps or more off" in said


def test_its_picture_is_told_method_by_method(page):
    (told,) = (
        one["alt"] for one in page.of("img") if "error against seconds" in one["alt"]
    )
    assert "auto: at best 1.0e-04 eps off in 0.5 s" in told
    assert "Radau: no run is known" in told
