"""Orders by regression: intervals that hold, windows, floors, divergence."""

import numpy as np
import pytest

from frictionjax.orders import Verdict, fit_order, local_orders

GENERATOR = np.random.default_rng(20)


def grid(n):
    return 10 ** np.sort(GENERATOR.uniform(-3, -1, n))[::-1]


def fit(eps, errors, floor=0.0):
    return fit_order(eps, errors, np.full_like(eps, floor))


@pytest.mark.parametrize("order", [-0.4, 0.5, 1.0, 2.0])
def test_exact_powers_on_any_grid(order):
    eps = grid(9)
    found = fit(eps, 3.0 * eps**order)
    assert found.order == pytest.approx(order, abs=1e-12)
    assert found.low <= order <= found.high
    assert found.constant == pytest.approx(3.0)
    assert found.points + found.preasymptotic == 9


@pytest.mark.parametrize("points", [6, 12, 20])
def test_the_interval_holds_the_order_about_as_often_as_it_says(points):
    hits = 0
    for _ in range(400):
        eps = grid(points)
        errors = eps**0.7 * np.exp(0.05 * GENERATOR.standard_normal(points))
        found = fit(eps, errors)
        hits += found.low <= 0.7 <= found.high
    assert 0.90 <= hits / 400 <= 0.99


def test_the_preasymptotic_part_is_left_out():
    eps = np.geomspace(1e-1, 1e-3, 12)
    found = fit(eps, eps * (1 + 30 * eps))
    assert found.preasymptotic >= 4
    assert found.eps_max < 0.05
    assert found.low <= 1.0 <= found.high
    assert abs(found.order - 1.0) < 0.05
    everything = np.polyfit(np.log(eps), np.log(eps * (1 + 30 * eps)), 1)[0]
    assert everything > 1.2  # what a plain regression says


def test_order_of_the_input_does_not_matter():
    eps = np.geomspace(1e-1, 1e-3, 12)
    errors = eps * (1 + 30 * eps)
    mixed = GENERATOR.permutation(12)
    assert fit(eps[mixed], errors[mixed]) == pytest.approx(fit(eps, errors), rel=1e-12)


def test_the_floor_is_left_out_and_counted():
    eps = np.geomspace(1e-1, 1e-4, 13)
    errors = np.hypot(eps, 1e-3)
    found = fit(eps, errors, floor=1e-3)
    assert found.floor == np.sum(errors <= 3e-3)
    assert found.eps_min > 2.5e-3
    assert abs(found.order - 1) < 0.05


def test_divergence_shows_as_divergence():
    eps = grid(10)
    errors = eps**-0.5 * np.exp(0.02 * GENERATOR.standard_normal(10))
    found = fit(eps, errors)
    assert found.verdict is Verdict.DIVERGES
    assert found.high < 0
    assert local_orders(np.array([0.1, 0.05]), np.array([1.0, 2.0])) == pytest.approx(-1)


def test_constant_errors_are_undecided():
    assert fit(grid(9), np.full(9, 3.0)).verdict is Verdict.UNDECIDED


def test_failures_and_too_few_points():
    eps = np.geomspace(1e-1, 1e-2, 6)
    errors = eps.copy()
    errors[1] = np.nan
    assert fit(eps, errors).failed == 1
    errors[2:4] = np.nan
    found = fit(eps, errors)
    assert found.verdict is Verdict.TOO_FEW_POINTS
    assert np.isnan(found.order)
    assert found.failed == 3


def test_bad_arguments_are_named():
    with pytest.raises(ValueError, match="errors = "):
        fit_order(np.array([0.1, 0.2]), np.array([1.0]), np.zeros(2))
    with pytest.raises(ValueError, match=r"eps = .*distinct"):
        fit(np.array([0.1, 0.1]), np.ones(2))


def test_a_window_must_foretell_its_smallest_eps():
    """Errors that fall fast and then stop falling: no narrow interval around the fall."""
    eps = np.geomspace(1e-1, 3e-3, 12)
    errors = 30 * eps**1.9
    errors[-2:] = errors[-3], 1.5 * errors[-3]
    found = fit(eps, errors)
    assert found.verdict is Verdict.UNDECIDED
    assert not found.low > 1.0
