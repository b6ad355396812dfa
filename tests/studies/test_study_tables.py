"""Tables of studies: every number in its column, nothing dropped."""

import pytest
from sweep_like import EPS, sweep_like

import frictionjax as fx
from frictionjax.studies import failed_table, lemma_table, order_table, sweep_table


def test_sweep_table_has_every_cell():
    lines = [line.split() for line in str(sweep_table(sweep_like())).splitlines()[1:]]
    assert len(lines) == 12
    first, failed = lines[0], lines[-1]
    assert [float(v) for v in first[:3]] == pytest.approx(
        [0.5, EPS[0], EPS[0] ** 0.5], 1e-2
    )
    assert float(first[3]) == pytest.approx(EPS[0] ** -0.5, rel=1e-2)
    assert first[-2:] == ["1234", "ok"]
    assert failed[2] == "-"
    assert failed[-1] == "max_steps"


def test_without_dissipation_its_columns_are_empty():
    text = str(sweep_table(sweep_like(dissipation=False)))
    assert text.splitlines()[1].split()[4:6] == ["-", "-"]


@pytest.mark.filterwarnings("ignore::frictionjax.wiggly.equation.status.FailedCells")
def test_order_table():
    orders = fx.study(sweep_like()).orders
    lines = str(order_table(orders)).splitlines()
    assert [line.split()[0] for line in lines[1:]] == [
        *("state", "state", "dissipation", "dissipation", "from", "from")
    ]
    assert lines[1].split()[1:3] == ["0.5", "0.500"]
    assert lines[1].split()[5:7] == ["-", "free"]  # nothing is known of its wells
    assert lines[1].split()[7:11] == ["0.500", "1", "[1,", "1]"]  # seen, constant
    assert lines[1].endswith("converges")
    assert "0.01 to 0.1" in lines[1]


def test_lemma_table():
    lines = str(lemma_table(fx.study(sweep_like(failed=False)).orders)).splitlines()
    assert [line.split()[:2] for line in lines[1:3]] == [["0.5", "0.5"], ["1", "1"]]
    assert [line.split()[3:-1] for line in lines[1:3]] == [["m^0.5"], []]
    assert lines[3].startswith("(C: in m/s before")


def test_an_order_from_too_few_points_is_a_dash():
    orders = fx.study(sweep_like().isel(eps=[0, 1])).orders
    line = str(order_table(orders)).splitlines()[1]
    assert line.split()[2] == "-"
    assert line.endswith("too few points")


@pytest.mark.filterwarnings("ignore::frictionjax.wiggly.equation.status.FailedCells")
def test_failed_cells_are_listed():
    text = failed_table(fx.study(sweep_like()).failed)
    assert text.splitlines()[1].split()[:3] == ["1", "0.01", "max_steps"]
    assert "raise max_steps" in text
    assert failed_table([]) == "no cell failed"


@pytest.mark.filterwarnings("ignore::frictionjax.wiggly.equation.status.FailedCells")
def test_a_study_shows_its_orders_and_what_failed():
    found = fx.study(sweep_like())
    orders = str(order_table(found.orders))
    assert str(found.table()) == orders
    assert repr(found) == f"{orders}\n{failed_table(found.failed)}"
    page = found._repr_html_()
    assert page.count("<tr>") == 1 + len(found.table().rows)
    assert "max_steps" in page
