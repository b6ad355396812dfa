"""Studies of several scenes: each as it is alone, and how they differ."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.studies import spread_table
from frictionjax.studies.scene_spread import QUANTILES, spread_over_scenes

EPS, GAMMA = np.geomspace(0.05, 1e-3, 7), [0.5, 2.0]


def scene_of(slope):
    return fx.Scene(
        fx.profiles.Sine(slope),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0488, 3.0),
        3.0,
    )


@pytest.fixture(scope="module")
def data():
    scenes = {f"slope {slope}": scene_of(slope) for slope in (0.08, 0.1, 0.13)}
    return fx.sweep(scenes, EPS, GAMMA, np.linspace(0.0, 3.0, 31))


@pytest.fixture(scope="module")
def found(data):
    return fx.study(data)


def test_each_scene_has_the_orders_that_it_has_alone(data, found):
    assert found.orders.order.dims == ("scene", "gamma")
    for label in data.scene.values:
        alone = fx.study(data.sel(scene=label))
        assert alone.spread is None
        for name in alone.orders.data_vars:
            one = found.orders[name].sel(scene=label)
            np.testing.assert_array_equal(one, alone.orders[name], err_msg=name)
        np.testing.assert_array_equal(
            found.curves.sel(scene=label).sup_error_fitted, alone.curves.sup_error_fitted
        )
        np.testing.assert_array_equal(
            found.local_orders.sel(scene=label).order, alone.local_orders.order
        )


def test_spreads_are_quantiles_over_the_scenes(found):
    spread = found.spread
    assert spread["quantile"].values.tolist() == list(QUANTILES)
    assert spread.scenes.values.tolist() == [3, 3]
    for name in ("order", "dissipation_constant", "strip_order_seen", "C0"):
        values = np.sort(found.orders[name].values, axis=0)
        np.testing.assert_array_equal(spread[name].isel(quantile=[0, 3, 6]), values)


def test_scenes_behind_a_prediction_are_counted(found):
    """Rows of which a law says nothing stood for it too."""
    columns = ("error", "gamma", "order [5%, 95%]", "predicted", "in", "constant", "rows")
    orders = found.orders.copy(deep=True)
    orders.strip_order_predicted[0, :] = np.nan
    orders.dissipation_order_predicted[:] = np.nan
    spread = spread_over_scenes(orders)
    assert spread.strip_predicted_scenes.values.tolist() == [2, 2]
    table = spread_table(spread)
    assert table.header == columns
    cells = {(row[0], row[1]): row[3:5] for row in table.rows}
    assert cells["from the strip", "2"][1] == "2"
    assert cells["state", "2"][1] == "3"
    assert cells["dissipation", "2"] == ("-", "0")


def test_spreads_that_no_scene_has_an_order_of_are_dashes(found):
    orders = found.orders.copy(deep=True)
    for name in ("order", "constant"):
        orders[name][:, 0] = np.nan
    cells = {row[:2]: row for row in spread_table(spread_over_scenes(orders)).rows}
    lost, kept = cells["state", "0.5"], cells["state", "2"]
    assert (lost[2], lost[5], lost[6]) == ("-", "-", "0")
    assert kept[2].endswith("]")
    assert "nan" not in str(spread_table(spread_over_scenes(orders)))


def test_scenes_without_an_order_are_left_out_of_its_spread(data):
    gone = data.copy(deep=True)
    gone["status"][0, 1] = int(fx.Status.OPEN_BRACKET)
    with pytest.warns(UserWarning, match="scene slope 0.08"):
        found = fx.study(gone)
    assert found.spread.scenes.values.tolist() == [3, 2]
    least = found.orders.order.isel(gamma=1, scene=[1, 2]).min()
    assert found.spread.order.isel(gamma=1, quantile=0) == least


def test_pictures_show_every_scene(found):
    figure = found.plot()
    errors, orders = figure.axes
    assert "3 scenes" in errors.get_title(loc="left")
    drawn = [line for line in orders.lines if line.get_marker() == "o"]
    shown = np.sort(np.concatenate([line.get_ydata() for line in drawn]))
    np.testing.assert_array_equal(shown, np.sort(found.orders.order.values.ravel()))
    thin = [line for line in errors.lines if line.get_linewidth() < 1]
    assert len(thin) == 6
