"""Which grid of eps gives an order, and how surely."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax import cost_prediction, eps_grids
from frictionjax.eps_grids import _interval
from frictionjax.machine_cost import MachineCost

RANGE = [5e-2, 1e-5]


@pytest.fixture(autouse=True)
def known(monkeypatch):
    machine = MachineCost(0.01, 0.002, 1e-5, 1e-7, 1e-6, 5.0, 1e9)
    monkeypatch.setattr(cost_prediction, "machine_cost", lambda: machine)


@pytest.fixture(scope="module")
def scene():
    return fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0488, 3.0),
        duration=3.0,
    )


@pytest.mark.slow
def test_the_grid_does_what_it_says(scene):
    found = fx.order_cost(scene, RANGE, 1.0, within=0.02)
    assert found.success
    choice = found.choice
    assert choice.half_width <= 0.02
    # The next grid of the same kind, a third of a distance further on.
    eps = choice.eps * (choice.eps[1] / choice.eps[0]) ** 0.3
    orders = fx.study(fx.sweep(scene, eps, 1.0, [0.0, 3.0])).orders.isel(gamma=0)
    half = 0.5 * float(orders.order_high - orders.order_low)
    assert half < 1.5 * 0.02
    assert abs(float(orders.order) - 1.0) < half + 0.02
    # No cheaper grid would do, and the front has only what no cheaper one beats.
    cheaper = [grid for grid in found.grids if grid.seconds < choice.seconds]
    assert all(grid.half_width > 0.02 for grid in cheaper)
    widths = [grid.half_width for grid in found.front]
    assert all(np.diff(widths) < 0)
    assert all(np.diff([grid.seconds for grid in found.front]) >= 0)


def test_out_of_reach_is_said(scene):
    found = fx.order_cost(scene, RANGE, 1.0, within=1e-9)
    assert not found.success
    assert found.choice is None
    best = min(grid.half_width for grid in found.grids)
    assert f"+-{best:.2g}" in found.message


def test_intervals_of_known_errors():
    rng = np.random.default_rng(0)
    pilot = np.geomspace(1e-1, 1e-6, eps_grids._PILOT)
    power = 3 * pilot**1.5
    half, order = _interval(pilot, power, 1e-9, 0, 47, 12)
    assert half < 1e-9
    assert order == pytest.approx(1.5)
    noisy = power * np.exp(0.1 * rng.normal(size=pilot.size))
    few, _ = _interval(pilot, noisy, 1e-9, 0, 47, 6)
    many, order = _interval(pilot, noisy, 1e-9, 0, 47, 48)
    short, _ = _interval(pilot, noisy, 1e-9, 28, 47, 8)
    assert many < few
    assert many < short
    assert abs(order - 1.5) < 2 * many
    # Failed cells, or too few, give no interval.
    assert _interval(pilot, np.full(48, np.nan), 1e-9, 0, 47, 6)[0] == np.inf


def test_bad_arguments_are_named(scene):
    for change, message in [
        ({"eps": 1e-2}, "eps = .*a largest and a smallest"),
        ({"eps": [-1.0, 1.0]}, "eps = "),
        ({"within": 0.0}, "within = 0"),
        ({"gamma": [1.0, 2.0]}, "gamma = "),
        ({"accuracy": -1.0}, "accuracy = -1"),
        ({"measure": 1}, "measure = 1"),
    ]:
        with pytest.raises(ValueError, match=message):
            fx.order_cost(scene, **{"eps": RANGE, **change})
