"""Studies: what a data set says about orders, constants and failures."""

import numpy as np
import pytest
import xarray as xr

import frictionjax as fx
from frictionjax.wiggly.equation.status import FailedCells


def synthetic(order=1.0, noise=0.0) -> xr.Dataset:
    """A data set with known orders, in the layout of a sweep."""
    eps, gamma = np.geomspace(0.1, 1e-3, 10), np.array([0.5, 1.0])
    time = np.linspace(0, 1, 11)
    scatter = np.exp(noise * np.random.default_rng(3).standard_normal((2, 10)))
    errors = np.stack([2 * eps**0.5, 0.7 * eps**order]) * scatter
    cells, ones = ("gamma", "eps"), np.ones((2, 10))
    return xr.Dataset(
        {
            "sup_error": (cells, errors),
            "dissipation_error": (cells, 0.1 * errors**2),
            "dissipation_gap": (cells, 1e-9 * ones),
            "strip_excess": (cells, np.stack([0.3 * eps**0.5, 0.2 * eps])),
            "status": (cells, np.zeros((2, 10), dtype=np.int8)),
            "z": ((*cells, "time"), ones[..., None] * 2.0 * time),
        },
        coords={"gamma": gamma, "eps": eps, "time": time},
        attrs={"accuracy": 1e-3},
    )


def test_orders_constants_and_exponents():
    orders = fx.study(synthetic()).orders
    assert orders.order.values == pytest.approx([0.5, 1.0], abs=1e-9)
    assert orders.dissipation_order.values == pytest.approx([1.0, 2.0], abs=1e-9)
    assert orders.beta.values == pytest.approx([0.5, 1.0])
    assert orders.C0.values == pytest.approx([0.3, 0.2])
    assert orders.C0.attrs["units"] == "m^(1-beta)"
    assert orders.C.attrs["units"] == "m/s, m^(1-beta)"
    # |z(t) - z(s)| = 2 |t - s|: largest over |t - s| + eps^beta at the ends, smallest eps.
    assert orders.C.values == pytest.approx([2 / (1 + 1e-3**0.5), 2 / (1 + 1e-3)])
    assert np.all(orders.order_low <= orders.order)
    assert np.all(orders.order <= orders.order_high)


@pytest.mark.parametrize("prefix", ["", "dissipation_", "strip_"])
def test_every_error_has_what_is_seen_and_the_interval_of_its_constant(prefix):
    orders = fx.study(synthetic(noise=0.02)).orders
    constant, low, high = (
        orders[f"{prefix}constant{end}"].values for end in ("", "_low", "_high")
    )
    assert np.all((low <= constant) & (constant <= high))
    seen = orders[f"{prefix}order_seen"].values
    assert seen == pytest.approx(orders[f"{prefix}order"].values, abs=0.1)
    assert ".curves" in orders[f"{prefix}constant"].attrs["comment"]
    assert ".curves" in orders[f"{prefix}misfit"].attrs["comment"]
    assert "not_yet_seen" in orders[f"{prefix}verdict"].attrs["flag_meanings"].split()


def test_local_orders_keep_their_sign():
    local = fx.study(synthetic(order=-0.5)).local_orders
    assert local.order.sel(gamma=1.0).values == pytest.approx(-0.5)
    assert local.sizes["eps"] == 9


def test_divergence_shows():
    orders = fx.study(synthetic(order=-0.5, noise=0.01)).orders
    meanings = orders.verdict.attrs["flag_meanings"].split()
    assert [meanings[int(v)] for v in orders.verdict] == ["converges", "diverges"]


def test_failed_cells_are_listed_not_dropped():
    data = synthetic()
    data.status[1, 3] = int(fx.Status.MAX_STEPS)
    data.sup_error[1, 3] = np.nan
    with pytest.warns(FailedCells, match=r"1 of \d+ cells failed \(gamma = 1, .*MAX_STEPS"):
        found = fx.study(data)
    assert [(c["gamma"], c["status"]) for c in found.failed] == [(1.0, "max_steps")]
    assert "max_steps" in found.failed[0]["message"]
    assert int(found.orders.failed.sel(gamma=1.0)) == 1
    assert found.orders.order.sel(gamma=1.0) == pytest.approx(1.0, abs=1e-9)


def test_orders_survive_a_file(tmp_path):
    orders = fx.study(synthetic()).orders
    orders.to_netcdf(tmp_path / "orders.nc", engine="h5netcdf")
    again = xr.load_dataset(tmp_path / "orders.nc", engine="h5netcdf")
    assert again.identical(orders)


def test_missing_variables_are_named():
    with pytest.raises(ValueError, match="dataset = 'one without strip_excess'"):
        fx.study(synthetic().drop_vars("strip_excess"))


@pytest.mark.parametrize(
    ("name", "value", "needs"),
    [
        ("status", 99, r"one of 0 \(OK\), "),
        ("sup_error", -1e-3, "a distance >= 0 in m where status is OK"),
        ("sup_error", np.nan, "a distance >= 0 in m where status is OK"),
        ("sup_error", np.inf, "a distance >= 0 in m where status is OK"),
        ("eps", 0, "eps > 0"),
        ("gamma", -1, "gamma > 0"),
    ],
)
def test_cells_that_somebody_edited_are_named(name, value, needs):
    """None vanishes from a fit, and no law meets it: warnings are errors here."""
    data = synthetic()
    if name in data.coords:
        data = data.assign_coords({name: np.append(value, data[name].values[1:])})
    else:
        data[name][1, 3] = value
    with pytest.raises(ValueError, match=rf"dataset\.{name} = {value}: needs {needs}"):
        fx.study(data)


def joined(dim: str) -> xr.Dataset:
    return xr.concat([synthetic(), synthetic()], dim, data_vars="all")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda data: joined("eps"),
            r"dataset\.eps = '\[0\.001\] more than once'",
        ),
        (
            lambda data: joined("gamma"),
            r"dataset\.gamma = '\[0\.5\] more than once'",
        ),
        (lambda data: joined("run"), r"dataset\.sup_error = 'dims run, gamma, eps': needs"),
        (
            lambda data: data.assign(strip_excess=data.strip_excess.isel(gamma=0)),
            r"dataset\.strip_excess = 'dims eps': needs the dims eps, gamma, as `sweep`",
        ),
        (lambda data: data.drop_attrs(), r"dataset = 'one without the attribute accuracy'"),
        (lambda data: data.assign_attrs(accuracy="1"), r"dataset\.accuracy = '1': needs a"),
        (
            lambda data: data.assign_coords(scene=0, parts=("eps", ["spring"] * 10)),
            r"dataset\.parts = 'dims eps': needs no dims, of one scene: `xr\.concat\(",
        ),
    ],
)
def test_what_a_sweep_does_not_have_is_named(change, message):
    with pytest.raises(ValueError, match=message):
        fx.study(change(synthetic()))


def test_end_to_end_on_a_scene():
    """gamma = 2 on the vertical spring: the limit lags by just under one eps."""
    scene = fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0488, 3.0),
        3.0,
    )
    data = fx.sweep(scene, np.geomspace(0.03, 3e-3, 8), [2.0])
    orders = fx.study(data).orders
    assert orders.order_low[0] <= 1.0 <= orders.order_high[0]
    assert abs(float(orders.order[0]) - 1.0) < 0.05
    assert float((data.sup_error / data.eps).max()) < 1.0
