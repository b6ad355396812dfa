"""Errors that laws predict against those of sweeps, and coverage of the orders."""

import numpy as np
import pytest
import xarray as xr
from slides import known, scene

import frictionjax as fx
from frictionjax.slide_laws import NO_LAW, predict_errors


def test_predictions_of_a_cell_do_not_depend_on_the_others():
    data = known(scene(), np.array([0.01]))
    eps, gamma = np.array([1e-2, 1e-3, 1e-5]), np.array([0.3, 0.6, 1.5])
    together = predict_errors(data, eps, gamma)
    alone = predict_errors(data, eps[1:2], gamma[2:])
    for name, found in alone.items():
        assert found.errors[0, 0] == pytest.approx(together[name].errors[2, 1], rel=1e-9)
        assert found.laws[0] == together[name].laws[2]


def test_what_does_not_slide_has_no_law():
    found = predict_errors(
        known(scene(amplitude=1e-3), np.array([0.01])), np.ones(1), np.ones(1)
    )
    assert found["sup_error"].laws == [NO_LAW]
    assert np.isnan(found["sup_error"].errors).all()


GRID, GAMMAS = np.geomspace(3e-2, 5e-4, 8), np.array([0.4, 0.6, 1.0])


def random_scene(seed):
    rng = np.random.default_rng(seed)
    cos, sin = 0.1 * rng.normal(size=(2, 4)) / (2 * np.pi * np.arange(1, 5) ** 2)
    angle = rng.uniform(-0.5, 0.5)
    rest = 1 / np.cos(angle) + rng.uniform(0.5, 1.5)
    profile = fx.profiles.Fourier(cos, sin)
    return scene(profile, angle, rng.uniform(0.8, 1.4), rng.uniform(2.5, 4.0), rest)


@pytest.fixture(scope="module")
def studies():
    scenes = [random_scene(seed) for seed in range(3)]
    return [fx.study(fx.sweep(one, GRID, GAMMAS, ts=[0.0, 3.0])) for one in scenes]


@pytest.mark.slow
@pytest.mark.parametrize("grid", [(3e-2, 1e-5, 10), (1e-1, 1e-4, 8), (0.097, 1e-6, 16)])
def test_intervals_of_many_sweeps_hold_the_predicted_order(grid):
    gammas = np.array([0.25, 0.35, 0.4, 0.5, 0.6, 0.75, 1.0, 1.5, 2.0])
    scenes = [random_scene(seed) for seed in range(10, 18)]
    found = [fx.study(fx.sweep(s, np.geomspace(*grid), gammas, ts=[0.0])) for s in scenes]
    # Of dissipations 0.161 at eps >= 1e-4: what is unsettled of a ratio is in them.
    for prefix, width in (("", 0.06), ("strip_", 0.06), ("dissipation_", 0.2)):
        require_coverage(found, prefix, width, least=0.95)


@pytest.mark.parametrize(
    ("prefix", "width"), [("", 0.06), ("dissipation_", 0.2), ("strip_", 0.06)]
)
def test_intervals_of_sweeps_hold_the_predicted_order(studies, prefix, width):
    require_coverage(studies, prefix, width, least=8 / 9)


def require_coverage(studies, prefix, width, least):
    held, widths = [], []
    for one in studies:
        orders = one.orders
        order = orders[f"{prefix}order_predicted"]
        if not prefix:
            assert order.values == pytest.approx(np.minimum(1, 2 * orders.gamma.values))
        low, high = orders[f"{prefix}order_low"], orders[f"{prefix}order_high"]
        seen = np.isfinite(order.values + low.values)
        held += list(((low <= order) & (order <= high)).values[seen])
        widths += list((high - low).values[seen])
    assert len(held) >= 2 * len(studies)
    assert np.mean(held) >= least
    assert np.median(widths) < width


def test_errors_of_sweeps_are_those_of_the_law(studies):
    for one in studies:
        smallest = one.dataset.isel(eps=-1)
        found = smallest.sup_error / one.curves.sup_error_predicted.isel(eps=-1)
        assert found.values == pytest.approx(1.0, abs=0.1)
        lag = smallest.strip_excess / one.curves.strip_excess_predicted.isel(eps=-1)
        slow = smallest.gamma <= 1.0  # beyond, the excess is below the solver's error
        assert lag.values[slow] == pytest.approx(1.0, abs=0.02)
        predicted = one.curves.dissipation_error_predicted.isel(eps=-1)
        assert (smallest.dissipation_error / predicted).values[0] == pytest.approx(
            1, abs=0.1
        )


def test_laws_survive_a_file(studies, tmp_path):
    studies[0].dataset.to_netcdf(tmp_path / "sweep.nc", engine="h5netcdf")
    again = fx.study(xr.load_dataset(tmp_path / "sweep.nc", engine="h5netcdf"))
    assert list(again.orders.law.values) == list(studies[0].orders.law.values)
    assert again.orders.order.values == pytest.approx(studies[0].orders.order.values)
