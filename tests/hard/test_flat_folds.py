"""Straight flanks and flat extremes, which tips leave slowly: slides remember long."""

import numpy as np
import pytest
from flat_folds import SCENES

import frictionjax as fx
from frictionjax.wiggly.equation import Status

CELLS = [
    pytest.param("sawtooth", 0.75, 1e-5, 1e6, marks=pytest.mark.slow),
    pytest.param("sawtooth", 0.5, 1e-8, 5e6, marks=pytest.mark.slow),
    # A slide that is slow at first: its slips are slower than those of the path.
    pytest.param(
        "sawtooth", 0.5, 1e-7, 8.2e5, marks=pytest.mark.slow
    ),  # 7.6e5; 8.3e5 where a second look begins again
    # Slides to the left remember 1 well, those to the right 127.
    ("sawtooth", 0.75, 1e-8, 1.3e6),  # 1.0e6; 2.6e6 and 7 s with the memory of both
    ("sawtooth", 0.5, 1e-5, 3e5),  # 2.4e5
    ("sawtooth", 1.0, 1e-5, 4.5e5),  # 3.4e5; 1.3e6
    ("quartic", 0.75, 1e-6, 6e5),  # 4.6e5; 4.4e6 without slip maps
    ("quartic", 0.4, 1e-8, 3e6),
    ("quartic", 0.25, 1e-5, 4e6),
]


@pytest.mark.parametrize(("name", "gamma", "eps", "most"), CELLS)
def test_flat_folds_are_no_end(name, gamma, eps, most):
    found = fx.sweep(SCENES[name], [eps], [gamma])
    assert found.status.item() == int(Status.OK)
    assert found.steps.item() < most


# gamma p/(p - 1): p = 4, and straight flanks.
@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "gamma", "order"), [("sawtooth", 0.5, 0.5), ("quartic", 0.5, 0.667)]
)
def test_orders_are_those_of_the_folds(name, gamma, order):
    eps = np.array([2e-8, 1e-8])
    found = fx.sweep(SCENES[name], eps, [gamma])
    errors = found.sel(eps=eps).sup_error.values.ravel()
    assert abs(np.log2(errors[0] / errors[1]) - order) < 0.01


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_slip_maps_agree_with_every_slip(name):
    eps, gamma, accuracy = 1e-3, 0.5, 1e-3
    ts = np.linspace(0.0, 3.0, 31)
    by_map, every = (
        fx.solve(SCENES[name], eps, gamma, ts, accuracy, method)
        for method in ("windowed", "resolved")
    )
    assert np.max(np.abs(by_map.z - every.z)) < accuracy * eps
