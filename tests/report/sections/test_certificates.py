"""What a sweep proves of its values, a line a cell."""

import numpy as np
from sweep_like import EPS, sweep_like

from frictionjax.report.sections.certificates import certificate_rows


def certified():
    data = sweep_like()
    cells = "gamma", "eps", "time"
    how = np.zeros((2, 6, 61), dtype=np.int8)
    how[1, :, 21:] = 1
    how[1, 0, 60] = 2
    bracket = np.full(how.shape, 9.0)  # where none was used
    bracket[1, :, 21:] = 1e-5
    bracket[1, 1, 30] = 2e-3
    return data.assign(how=(cells, how), bracket=(cells, bracket))


def test_values_are_counted_by_how_they_were_found():
    rows = certificate_rows(certified()).rows
    assert len(rows) == 12
    assert rows[0][:6] == ("0.5", f"{EPS[0]:.4g}", "61", "0", "0", "-")
    assert rows[6][2:6] == ("21", "39", "1", "1e-05")
    assert rows[7][5] == "0.002"  # the widest, of those used


def test_cells_of_one_way_have_it_at_all_times():
    """As those of tips with mass, of which every slip is followed."""
    cells = "gamma", "eps"
    data = certified().assign(how=(cells, np.zeros((2, 6), dtype=np.int8)))
    assert certificate_rows(data).rows[6][2:6] == ("61", "0", "0", "-")


def test_residuals_are_told_in_joule_and_as_a_share():
    data = certified()
    spent = float(data.dissipation[0, 0, -1])
    row = certificate_rows(data).rows[0]
    assert row[7] == "1e-08"
    assert float(row[8]) == float(f"{1e-8 / spent:.3g}")
    assert certificate_rows(data).rows[-1][-1] == "max_steps"


def test_another_solver_bounds_nothing():
    assert certificate_rows(sweep_like(dissipation=False)) is None
    assert certificate_rows(sweep_like()).rows[0][2:5] == ("-", "-", "-")
