"""Which grid of eps gives an order, and how surely."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.cost import (
    order_accuracy as eps_grids,
)
from frictionjax.cost import (
    prediction as cost_prediction,
)
from frictionjax.cost.machine_cost import MachineCost
from frictionjax.cost.order_accuracy import (
    EpsGrid,
    _candidates,
    _intervals,
    _Pilot,
    cheapest_grid,
)
from frictionjax.slide_laws import NO_LAW

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
    # No cheaper grid would do, and the front has only what no cheaper one beats. Times
    # within a quarter are the same time.
    good = [grid for grid in found.grids if grid.half_width <= 0.02 and grid.confirmed]
    assert choice.seconds <= 1.25 * min(grid.seconds for grid in good)
    widths = [grid.half_width for grid in found.front]
    assert all(np.diff(widths) < 0)
    assert all(np.diff([grid.seconds for grid in found.front]) >= 0)


@pytest.mark.slow
def test_out_of_reach_is_said(scene):
    found = fx.order_cost(scene, RANGE, 1.0, within=1e-9)
    assert not found.success
    assert found.choice is None
    best = min(grid.half_width for grid in found.grids)
    assert f"+-{best:.2g}" in found.message


PILOT = np.geomspace(1e-1, 1e-6, eps_grids.SETTINGS.pilot)


def lawless(pilot, errors):
    return _Pilot(pilot, errors, 1e-9 * pilot, None, NO_LAW)


def grids_of(errors, pilot=PILOT, second=lambda eps: 0.01):
    """All grids of a pilot with these errors, a cell of each taking as long as said."""
    grids = []
    for start, stop, points in _candidates():
        found = _intervals(lawless(pilot, errors), start, stop, points)
        if found is not None:
            ends = float(pilot[start]), float(pilot[stop])
            seconds = sum(second(eps) for eps in np.geomspace(*ends, points))
            grids.append(EpsGrid(*ends, points, **found, seconds=seconds))
    return grids


def test_intervals_of_known_errors():
    rng = np.random.default_rng(0)
    power = 3 * PILOT**1.5
    exact = _intervals(lawless(PILOT, power), 0, 47, 12)
    assert exact["half_width"] < 1e-9
    assert exact["order"] == pytest.approx(1.5)
    noisy = power * np.exp(0.02 * rng.normal(size=PILOT.size))
    few = _intervals(lawless(PILOT, noisy), 0, 47, 6)
    many = _intervals(lawless(PILOT, noisy), 0, 47, 48)
    short = _intervals(lawless(PILOT, noisy), 38, 47, 8)
    assert many["half_width"] < few["half_width"]
    assert many["half_width"] < short["half_width"]
    assert abs(many["order"] - 1.5) < 2 * many["half_width"]
    # Rounding leaves fewer different grids: said, not seven.
    assert (many["laid"], few["laid"]) == (1, 7)
    # Failed cells, or too few, give no interval.
    assert _intervals(lawless(PILOT, np.full(48, np.nan)), 0, 47, 6) is None


def bent(scatter):
    """As the angular spring at gamma = 0.75: 1.3 in the first decades, 0.95 in the last."""
    x = np.log(PILOT)
    slope = 1.125 + 0.175 * np.tanh((x - np.log(2e-4)) / 0.8)
    y = np.concatenate([[0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * np.diff(x))])
    return np.exp(y + scatter(x) * np.random.default_rng(1).normal(size=x.size))


def test_a_grid_of_large_eps_is_held_against_smaller_ones():
    # The smallest eps scatter so much that no grid there is within 0.02.
    found = cheapest_grid(
        grids_of(bent(lambda x: np.where(x < np.log(2e-4), 0.08, 1e-4))), 0.02
    )
    assert not found.success
    assert found.choice is None
    trap = [g for g in found.grids if g.half_width <= 0.02 and g.order > 1.2]
    assert trap  # what would be chosen on their own word
    assert not any(grid.confirmed for grid in trap)
    assert "ranges disagree" in found.message
    # Where they do not scatter they are chosen, though larger eps are cheaper.
    found = cheapest_grid(
        grids_of(bent(lambda x: 1e-4), second=lambda eps: 1e-4 / eps**0.3), 0.02
    )
    assert found.success
    assert found.choice.order == pytest.approx(0.95, abs=0.02)
    assert found.choice.eps_max < 2e-4


def test_what_was_compared_is_said():
    errors = PILOT * np.exp(1e-3 * np.random.default_rng(2).normal(size=48))
    found = cheapest_grid(grids_of(errors, second=lambda eps: 1e-3 / eps), 0.02)
    assert found.success
    assert found.choice.eps_max == pytest.approx(1e-1)
    assert "grids of smaller eps, down to 1e-06 m, agree" in found.message
    # Of times that a prediction does not tell apart, the narrowest.
    cheapest = min(g.seconds for g in found.grids if g.confirmed and g.half_width <= 0.02)
    tied = [g for g in found.grids if g.seconds <= 1.25 * cheapest and g.confirmed]
    assert found.choice.half_width == min(grid.half_width for grid in tied)


@pytest.mark.slow
def test_the_order_of_the_angular_spring_is_not_what_decades_show():
    """Decade by decade 1.31, 1.22, 1.12, 0.90, 0.96: without a law 1.30 +- 0.02."""
    scene = fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3),
        fx.supports.Spring(1.0),
        fx.loads.Triangle(0.9, 2.3),
        duration=2.9,
    )
    found = fx.order_cost(scene, [0.097, 1.03e-6], 0.75, within=0.02)
    assert found.success
    assert found.choice.order == pytest.approx(1.0, abs=0.02)


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
