"""The report of a study: everything in it, nothing taken for a tag."""

import time
from pathlib import Path

import numpy as np
import pytest
from html_pages import cells_of_table, checked_page
from matplotlib.figure import Figure
from sweep_like import sweep_like

import frictionjax as fx
from frictionjax.io import part_rows
from frictionjax.report import page
from frictionjax.report.job import ReportRequest, read_job
from frictionjax.report.study_results import write_results
from frictionjax.report.study_words import verdict_sentence
from frictionjax.studies import failures, lemma_table, order_table, sweep_table

HOSTILE = '<script>alert(1)</script><img src=http://a.example/x.png onerror="x()">'
pytestmark = pytest.mark.filterwarnings(
    "ignore::frictionjax.wiggly.equation.status.FailedCells"
)


def report_of(folder, data, notes=(), command="frictionjax study --report", **attrs):
    data = data.assign_attrs(method="auto", source="frictionjax 0", **attrs)
    request = ReportRequest(command, time.perf_counter(), "2 to 8 s of computation")
    job = read_job(None)
    job = job._replace(report=request, notes=[*notes])
    write_results(job, data, folder, 12.5)
    return (folder / "report.html").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    command = f"frictionjax study '{HOSTILE}.toml' --report"
    return folder, report_of(folder, sweep_like(), [f"Note: {HOSTILE}"], command)


@pytest.fixture
def unpainted(monkeypatch):
    """Words and files are looked at alone: no picture is painted."""
    monkeypatch.setattr(page.pictures, "vector_graphic", lambda figure: "<svg></svg>")
    monkeypatch.setattr(Figure, "savefig", lambda self, path: Path(path).touch())


def test_it_needs_nothing_beside_it(written):
    page = checked_page(written[1])
    assert len(page.of("img")) == 8


def test_names_are_text_whatever_they_are(written):
    page = checked_page(written[1])
    assert page.text.count(HOSTILE) == 2  # command and note
    assert "http:" not in written[1].replace(HOSTILE, "").replace("src=http:", "")


def test_every_number_of_the_tables_is_in_it(written):
    text = checked_page(written[1]).text
    found = fx.study(sweep_like())
    tables = [
        sweep_table(found.dataset),
        order_table(found.orders),
        lemma_table(found.orders),
        part_rows(read_job(None).scene),
        failures(found.failed),
    ]
    words = set(text.split())
    for table in tables:
        for cell in cells_of_table(table):
            assert set(cell.split()) <= words, cell
    law = fx.friction(read_job(None).scene)
    for number in (law.rho_plus, law.rho_minus, law.alpha, law.a):
        assert f"{float(number):.6g}" in words


def test_failures_are_told_first_and_by_name(written):
    text = checked_page(written[1]).text
    assert text.index("1 of 12 computations failed") < text.index("Contents")
    assert "1 of 12 cells failed, and are left out of the orders" in text
    assert fx.Status.MAX_STEPS.message in text


@pytest.mark.usefixtures("unpainted")
def test_where_none_failed_it_says_so(tmp_path):
    resolved = sweep_like(failed=False).interp(time=np.linspace(0.0, 3.0, 601))
    resolved["status"] = resolved.status.astype(np.int8)
    text = checked_page(report_of(tmp_path, resolved)).text
    assert "Right: a few slips from hollow to hollow" in text
    assert "on the left. Dots stand for an eps whose slips the stored times" in text
    assert "None of the 12 computations failed" in text
    assert "No cell failed, of 12." in text
    assert "Failed cells" not in text


def test_it_can_be_made_again(written):
    folder, html = written
    text = checked_page(html).text
    toml = (folder / "scene.toml").read_text()
    assert " ".join(toml.split()) in text
    assert "frictionjax study scene.toml --out again --report" in text
    for fact in ("12.5 s", "2 to 8 s of computation", "seed", "64-bit", "jax 0."):
        assert fact in text
    files = {link["href"] for link in checked_page(html).of("a")}
    left = {path.name for path in folder.iterdir()} - {"report.html"}
    assert left <= files


def test_pictures_are_told_with_their_numbers(written):
    told = [image["alt"] for image in checked_page(written[1]).of("img")]
    data = sweep_like()
    (errors,) = (one for one in told if "distance of the state from the limit" in one)
    assert f"{float(data.sup_error[0, 0]):.3g} m at eps = 0.1 m" in errors
    assert "gamma = 0.5" in errors
    assert "eps^0.500" in errors
    (loop,) = (one for one in told if one.startswith("Loop"))
    assert "0.1204 N" in loop


def test_letters_of_the_equation_are_explained(written):
    text = checked_page(written[1]).text
    assert "F(ε w(y))" in text.replace("( ", "(").replace(" )", ")")
    for letter in ("z is the state", "w is the height", "F is the", "A by how many m"):
        assert letter in text


def test_captions_tell_of_no_panel_that_is_not_there(written):
    """These times resolve no slip; where none failed they do."""
    text = checked_page(written[1]).text
    assert "at which friction can hold the bristle." in text
    assert "Right: a few slips" not in text


def test_the_verdict_is_that_of_the_gamma_nearest_to_one():
    law = fx.friction(read_job(None).scene)
    said = verdict_sentence(fx.study(sweep_like(failed=False)), law)
    assert said.startswith("The motion comes to that of dry friction like eps^1.000")
    assert "Bumps at half the distance leave 0.5 of the difference" in said
    few = fx.study(sweep_like(failed=False).isel(eps=[0, 1]))
    assert "too few cells are left to measure an order" in verdict_sentence(few, law)


def test_a_prediction_outside_of_the_interval_is_said():
    found = fx.study(sweep_like(failed=False))
    law = fx.friction(read_job(None).scene)
    for value, where in ((1.0, "inside"), (1.5, "outside")):
        orders = found.orders.assign(order_predicted=("gamma", np.array([0.5, value])))
        said = verdict_sentence(found._replace(orders=orders), law)
        assert f"theory predicts {value:.4g}, which lies {where} that interval" in said


@pytest.mark.usefixtures("unpainted")
def test_nothing_is_written_unasked(tmp_path):
    write_results(read_job(None), sweep_like(), tmp_path, 1.0)
    assert not (tmp_path / "report.html").exists()
