"""Advice names the fastest of those that kept what was wanted, and who was wrong."""

import numpy as np
import pytest
import xarray as xr

from frictionjax.cost.advice import advice
from frictionjax.wiggly import Status

SOLVERS, ACCURACIES = ["auto", "resolved", "BDF"], [1e-1, 1e-3, 1e-5]
EPS = [1e-2, 1e-3]


@pytest.fixture
def data():
    """auto in 0.1 s, resolved in 0.3 s, BDF in 1 ms; errors a tenth of what is asked."""
    dims = ("gamma", "eps", "solver", "accuracy")
    shape = 1, len(EPS), len(SOLVERS), len(ACCURACIES)
    seconds = np.array([0.1, 0.3, 1e-3])[:, None] + np.zeros(shape)
    columns = {
        "error": 0.1 * np.array(ACCURACIES) + np.zeros(shape),
        "seconds": seconds,
        "status": np.full(shape, int(Status.OK)),
        "wrong": np.zeros(shape),
    }
    known = xr.Dataset({name: (dims, values) for name, values in columns.items()})
    known["reference_error"] = dims[:2], np.full(shape[:2], 1e-8)
    return known.assign_coords(gamma=[1.0], eps=EPS, solver=SOLVERS, accuracy=ACCURACIES)


def changed(data, name, value, **where):
    """A copy with a value at one place."""
    copy = data.copy(deep=True)
    copy[name].loc[where] = value
    return copy


def test_the_fastest_of_all_that_kept_it_and_the_next_one(data):
    told = advice(data)
    assert told.startswith(
        "For 1e-03 eps take method='BDF', accuracy=1e-03: z within 1.0e-04"
    )
    assert "in all 2 cells in 0.002 s" in told
    assert "the next method, 'auto', takes 1e+02 times as long" in told
    assert "off" not in told
    alike = data.assign(seconds=data.seconds * 0 + 0.1)
    faster = changed(alike, "seconds", 0.095, solver="resolved")
    for tied in (alike, faster):
        assert "take method='auto', accuracy=1e-03" in advice(tied)
        assert advice(tied).endswith(
            "in 0.2 s, the next method, 'resolved', takes as long."
        )


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("error", 0.7),
        ("error", 1.1e-3),
        ("error", np.nan),
        ("status", int(Status.TOO_SLOW)),
        ("status", int(Status.NOT_TRIED)),
    ],
)
def test_who_fails_in_one_cell_is_not_named(data, name, value):
    place = {"solver": "BDF", "eps": 1e-3}
    assert "'BDF'" not in advice(changed(data, name, value, **place))
    # Tighter ones may still do, and are slower.
    tighter = changed(data, "seconds", 0.2, accuracy=1e-5, solver="BDF")
    told = advice(changed(tighter, name, value, accuracy=1e-3, **place))
    assert "take method='auto', accuracy=1e-03" in told
    assert "'BDF', takes 2 times" in told


def test_who_was_wrong_anywhere_is_told(data):
    lost = changed(data, "wrong", 1.0, accuracy=1e-1, solver="BDF", eps=1e-3)
    assert advice(lost).endswith("; success reported half an eps or more off: BDF.")


def test_nothing_is_promised_beyond_the_reference_or_where_nothing_was_measured(data):
    unsure = data.assign(reference_error=data.reference_error * 0 + 2e-3)
    assert advice(unsure) == "No method was measured to keep 1e-03 eps in all 2 cells."
    one = data.isel(eps=[0]).sel(accuracy=[1e-1])
    assert "For 1e-01 eps" in advice(one)  # the tightest that was asked for
    assert "eps in the cell in" in advice(one)


def test_who_was_not_run_is_said(data):
    nowhere = changed(data, "status", int(Status.NOT_TRIED), solver="BDF")
    assert advice(nowhere).endswith("; not run, for want of time: BDF.")
    some = {"solver": "resolved", "eps": 1e-3}
    once = changed(nowhere, "status", int(Status.NOT_TRIED), **some)
    assert advice(once).endswith(": BDF, resolved (in some cells).")
    slow = {"solver": "resolved", "accuracy": 1e-5}  # the loosest took too long
    given_up = changed(data, "status", int(Status.NOT_TRIED), **slow)
    assert "want of time" not in advice(given_up)
