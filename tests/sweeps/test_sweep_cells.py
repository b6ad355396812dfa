"""Sweeps: suprema, batches, compilation, failures, files."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
import xarray as xr
from dense_times import finer

import frictionjax as fx
from frictionjax.model import tabulated_scene
from frictionjax.wiggly.equation.status import FailedCells
from frictionjax.wiggly.lanes import loops
from frictionjax.wiggly.plan import lane_scene
from frictionjax.wiggly.sequential.rosenbrock_solvers import Rodas5P
from frictionjax.wiggly.settings import SETTINGS as SWEEP_SETTINGS

EPS = [0.09, 0.05, 0.03]
GAMMA = [0.5, 1.0, 2.0]


def scene_of(slope=0.1, amplitude=1.0488, angle=0.4):
    return fx.Scene(
        fx.profiles.Sine(slope),
        fx.bristles.SlantedSpring(1.0, 2.2, 1.0, angle),
        fx.supports.Spring(1.0),
        fx.loads.Sine(amplitude, 3.0),
        3.0,
    )


@pytest.fixture(scope="module")
def data():
    return fx.sweep(scene_of(), EPS, GAMMA, ts=np.linspace(0, 3, 61), accuracy=1e-3)


def test_layout(data):
    assert data.z.dims == ("gamma", "eps", "time")
    assert data.sizes == {"gamma": 3, "eps": 3, "time": 61}
    assert list(data.eps.values) == EPS
    assert data.viscosity.attrs["units"] == "N s m-1"
    assert data.viscosity.sel(gamma=2.0, eps=0.05) == pytest.approx(0.0025)
    for name in data.data_vars:
        assert data[name].attrs["long_name"]
    assert int(data.status.max()) == fx.Status.OK
    assert data.status.attrs["flag_meanings"].split()[fx.Status.OK] == "ok"
    assert "angle=0.4" in data.attrs["scene"]
    assert "jax" in data.attrs["versions"]


@pytest.mark.slow
def test_sup_error_is_over_all_times_not_over_ts(data):
    """Against the densest sampling: all of a finely sampled trajectory."""
    dense = np.linspace(0, 3, 20001)
    limit = fx.solve_limit(scene_of(), dense)
    for gamma in (0.5, 2.0):
        found = fx.solve(scene_of(), 0.03, gamma, dense, accuracy=1e-5)
        cell = data.sel(gamma=gamma, eps=0.03)
        sampled = np.abs(np.asarray(found.z - limit.z)).max()
        assert float(cell.sup_error) == pytest.approx(sampled, abs=2e-3 * 0.03)
        lost = np.abs(np.asarray(found.dissipation - limit.dissipation)).max()
        final = float(found.dissipation[-1])
        assert float(cell.dissipation_error) == pytest.approx(lost, abs=1e-3 * final)
        coarse = np.abs(cell.z - cell.z_limit).max()
        assert float(cell.sup_error) >= float(coarse) * (1 - 1e-9)


def test_strip_excess_is_the_distance_from_the_strip(data):
    law = fx.friction(scene_of())

    def outside(ts):
        z = fx.sweep(scene_of(), 0.03, 0.5, ts, accuracy=1e-5).z.values.ravel()
        load = 1.0488 * np.sin(2 * np.pi * ts / 3)
        return np.maximum(load - float(law.rho_plus) - z, z - load + float(law.rho_minus))

    # As many times at once as the program of `data` takes, then finer ones.
    ts = np.linspace(0, 3, 1501)
    dense = finer(ts, outside(ts))
    cell = data.sel(gamma=0.5, eps=0.03)
    assert float(cell.strip_excess) == pytest.approx(outside(dense).max(), abs=2e-3 * 0.03)


def test_a_batch_equals_its_lanes_alone(data):
    """Within a thousandth of the accuracy asked for, in units of eps."""
    ts = data.time.values
    for gamma in GAMMA:
        for eps in EPS:
            alone = fx.solve(scene_of(), eps, gamma, ts, accuracy=1e-3)
            cell = data.sel(gamma=gamma, eps=eps)
            assert np.abs(cell.z - np.asarray(alone.z)).max() < 1e-6 * eps
            final = float(alone.dissipation[-1])
            lost = np.abs(cell.dissipation - np.asarray(alone.dissipation)).max()
            assert lost < 1e-6 * final


def test_order_of_cells_does_not_matter(data):
    shuffled = fx.sweep(scene_of(), EPS[::-1], [2.0, 0.5, 1.0], ts=data.time.values)
    # Which lanes share a loop moves the last digit.
    xr.testing.assert_allclose(shuffled, data, rtol=1e-12, atol=1e-14)


def test_a_value_that_is_there_twice_is_one_cell(data):
    eps, gamma = [0.03, 0.09, 0.03, 0.05], [2.0, 0.5, 1.0, 0.5]
    twice = fx.sweep(scene_of(), eps, gamma, ts=data.time.values)
    assert list(twice.eps.values) == EPS
    assert list(twice.gamma.values) == GAMMA
    xr.testing.assert_allclose(twice, data, rtol=1e-12, atol=1e-14)


def test_one_compilation_for_any_values(data):
    """Other eps, gamma, accuracy and parameters, and other numbers of cells."""
    # Both loops are there: when one is compiled in the background hangs on what ran before.
    lanes = lane_scene(tabulated_scene(scene_of(), EPS))
    for width in (loops.SETTINGS.narrow, loops.SETTINGS.width):
        program = lanes, SWEEP_SETTINGS.tableau, True, width
        loops._LOOPS.run(program, loops.Room(9, 9, 9), loops._nothing)
    compiled = []
    jax.monitoring.register_event_duration_secs_listener(
        lambda event, seconds, **_: (
            compiled.append(event)
            if event == "/jax/core/compile/backend_compile_duration"
            else None
        )
    )
    ts = data.time.values
    fx.sweep(scene_of(0.08, 0.97, 0.3), [0.08, 0.06, 0.04], [0.6, 1.1, 1.7], ts, 1e-2)
    assert compiled == []
    fx.sweep(scene_of(0.07), np.geomspace(0.09, 0.03, 5), [0.6, 0.9, 1.1, 1.7], ts)
    assert compiled == []


def test_netcdf_without_loss(data, tmp_path):
    path = tmp_path / "sweep.nc"
    data.to_netcdf(path, engine="h5netcdf")
    assert xr.load_dataset(path, engine="h5netcdf").identical(data)


def test_failed_cells_keep_their_place(data, monkeypatch):
    """One cell below the spacing of floats: a status and NaN, the others untouched."""
    ts = data.time.values
    said = r"1 of 4 cells failed \(gamma = 5, eps = 0.001: STEP_TOO_SMALL\)"
    with pytest.warns(FailedCells, match=said):
        mixed = fx.sweep(
            scene_of(), [0.05, 1e-3], [1.0, 5.0], ts, method=Rodas5P(), dissipation=False
        )
    bad = mixed.sel(gamma=5.0, eps=1e-3)
    assert int(bad.status) == fx.Status.STEP_TOO_SMALL
    assert np.isnan(bad.sup_error)
    good = mixed.sel(gamma=1.0, eps=0.05)
    same = data.sel(gamma=1.0, eps=0.05)
    assert int(good.status) == fx.Status.OK
    assert np.abs(good.z - same.z).max() < 1e-4 * 0.05  # another scheme
    with pytest.warns(FailedCells, match=said):
        failed = fx.study(mixed).failed
    assert [cell["status"] for cell in failed] == ["step_too_small"]
    assert failed[0]["gamma"] == 5.0
    assert failed[0]["eps"] == 1e-3


def test_without_dissipation_its_variables_are_absent(data):
    bare = fx.sweep(scene_of(), EPS, GAMMA, ts=data.time.values, dissipation=False)
    assert {"dissipation", "residual", "dissipation_error"}.isdisjoint(bare.variables)
    assert np.allclose(bare.sup_error, data.sup_error, atol=1e-9)
    assert "dissipation_order" not in fx.study(bare).orders


def test_without_suprema_theirs_are_absent(data):
    options = {"dissipation": False, "suprema": False}
    bare = fx.sweep(scene_of(), EPS, GAMMA, ts=data.time.values, **options)
    left_out = {"sup_error", "strip_excess", "survey_error", "dissipation"}
    assert left_out.isdisjoint(bare.variables)
    assert np.abs(bare.z - data.z).max() < 1e-3 * max(EPS)
    kept = fx.sweep(scene_of(), EPS, GAMMA, ts=data.time.values, suprema=False)
    assert np.allclose(kept.dissipation, data.dissipation, rtol=0, atol=1e-12)
    assert "sup_error" not in kept
    with pytest.raises(ValueError, match="sup_error"):
        fx.study(bare)


def test_values_alone_of_cells_that_remember_without_end_give_no_warning():
    """Of these none are sampled: 0 wells of a run-up that is infinite."""
    scene = fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0, 3.0),
        3.0,
    )
    bare = fx.sweep(scene, [0.0013503140378698735], [0.5], dissipation=False, suprema=False)
    assert int(bare.status.max()) == fx.Status.OK


def test_progress_goes_to_standard_error(capsys):
    fx.sweep(scene_of(), EPS, GAMMA, ts=np.linspace(0, 3, 61), progress=True)
    captured = capsys.readouterr()
    assert "100%" in captured.err
    assert captured.out == ""


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"eps": []}, "eps = "),
        ({"eps": [0.1, -0.1]}, "eps = "),
        ({"gamma": [np.inf]}, r"gamma = \[inf\]"),
        ({"accuracy": 2.0}, "accuracy = 2"),
        ({"method": "magic"}, "method = 'magic'"),
        ({"dissipation": 0}, "dissipation = 0: needs True or False"),
        ({"suprema": None}, "suprema = None: needs True or False"),
        ({"progress": "no"}, "progress = 'no': needs True or False"),
    ],
)
def test_bad_arguments_are_named(arguments, message):
    with pytest.raises(ValueError, match=message):
        fx.sweep(scene_of(), **({"eps": EPS, "gamma": GAMMA} | arguments))


def test_start_outside_the_strip_is_refused():
    scene = eqx.tree_at(lambda s: s.z0, scene_of(), jnp.asarray(0.9))
    with pytest.raises(ValueError, match=r"scene\.z0 = 0\.9: needs z_minus\(0\) <= z0"):
        fx.sweep(scene, EPS, GAMMA)


def test_eps_too_large_for_the_bristle_is_refused():
    bristle = fx.bristles.AngularSpring(1.0, 1.0001, 1.0, 0.0)
    parts = fx.profiles.Sine(0.005), bristle, fx.supports.Spring(1.0)
    scene = fx.Scene(*parts, fx.loads.Ramp(1.0), 1.0)
    with pytest.raises(ValueError, match=r"eps = 1: needs eps < 0\.\d+, where G"):
        fx.sweep(scene, [1.0, 1e-3], [1.0])
