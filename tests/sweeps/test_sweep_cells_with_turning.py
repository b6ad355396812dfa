"""Sweeps of scenes whose rods turn over."""

import re

import numpy as np
import pytest
from rods_that_turn import jumping_scene, turning_scene
from scipy.spatial import cKDTree

import frictionjax as fx
from frictionjax.wiggly.turning import phases

EPS = [0.08, 0.04, 0.02]
TS = np.linspace(0, 4, 41)


@pytest.fixture(scope="module")
def jumping():
    return fx.sweep(jumping_scene(), EPS, [1.0], TS)


@pytest.fixture(scope="module")
def followed():
    return fx.sweep(turning_scene(), EPS, [1.0], TS)


def test_columns_are_those_of_other_scenes_and_its_own(jumping):
    # An eps at which a rod is as short a series as in other tests: their programs.
    plain = fx.sweep(jumping_scene().replace(effects=()), [0.01], [1.0], TS)
    assert set(plain.data_vars) - set(jumping.data_vars) == set()
    own = {"root", "mode", "root_limit", "mode_limit", "jumps", "jump_loss"}
    own |= {"graph_error", "dissipation_graph_error"}
    assert set(jumping.data_vars) - set(plain.data_vars) == own
    assert np.all(jumping.status == 0)
    for name, column in jumping.data_vars.items():
        if np.isnan(column.astype(float)).any():
            assert column.attrs["missing"], name
        assert column.attrs["long_name"]
    assert np.all(np.isnan(jumping.z_minus) == (jumping.mode_limit == 0))


def test_a_cell_is_what_it_is_alone(jumping):
    alone = fx.sweep(jumping_scene(), EPS[1], 1.0, TS)
    for name in alone.data_vars:
        if "eps" in alone[name].dims:
            same = jumping[name].sel(eps=[EPS[1]])
            np.testing.assert_array_equal(alone[name], same, err_msg=name)


def test_it_is_what_solve_says(jumping):
    found = fx.solve(jumping_scene(), EPS[0], 1.0, TS)
    cell = jumping.sel(gamma=1.0, eps=EPS[0])
    for name in ("z", "root", "mode", "dissipation"):
        np.testing.assert_array_equal(cell[name], getattr(found, name), err_msg=name)
    limit = fx.solve_limit(jumping_scene(), TS)
    np.testing.assert_array_equal(cell.mode_limit, limit.mode)
    np.testing.assert_array_equal(cell.root_limit, limit.root)


def test_the_largest_compression_is_that_of_straight_rods(followed):
    one = turning_scene()
    one = one.replace(effects=(*one.effects, fx.effects.AxialLoad(0.1)))
    data = fx.sweep(one, EPS[:2], [1.0], TS)
    for name in followed:
        known = followed[name]
        same = known.sel(eps=EPS[:2]) if "eps" in known.dims else known
        np.testing.assert_array_equal(data[name], same, err_msg=name)
    read = fx.mechanics(one, fx.solve(one, EPS[1], 1.0, TS), EPS[1])
    mode, cell = read["mode"].values, data.sel(gamma=1.0, eps=EPS[1])
    both = [float(read.compression[mode == side].max()) for side in (1, -1)]
    assert float(cell.compression) == pytest.approx(max(both), rel=1e-12)
    share = max(both) / read.attrs["sprung_load"]
    assert float(cell.sprung_share) == pytest.approx(share, rel=1e-12)
    assert data.sprung_share.attrs["units"] == "1"
    assert max(both) > 1.1 * min(both)


def test_suprema_are_those_of_a_fine_curve(followed):
    ts = np.linspace(0, 4, 4001)
    one, eps = turning_scene(), EPS[1]
    fine, limit = fx.solve(one, eps, 1.0, ts), fx.solve_limit(one, ts)
    cell = followed.sel(gamma=1.0, eps=eps)
    far = float(np.max(np.abs(fine.z - limit.z)))
    assert float(cell.sup_error) == pytest.approx(far, abs=0.03 * eps)
    lost = float(np.max(np.abs(fine.dissipation - limit.dissipation)))
    assert float(cell.dissipation_error) == pytest.approx(lost, rel=0.05)


def dense_points(x, z, gap):
    """Points of a polyline in a plane, (n, 2), no further apart than `gap`."""
    counts = np.ceil(np.maximum(np.diff(x), np.abs(np.diff(z))) / gap).astype(int)
    leg = np.repeat(np.arange(counts.size), counts)
    share = (np.arange(leg.size) - (np.cumsum(counts) - counts)[leg]) / counts[leg]
    return np.stack([v[leg] + np.diff(v)[leg] * share for v in (x, z)], axis=1)


def test_graphs_are_as_far_as_their_nearest_points(jumping):
    """Of a fine curve and of a limit sampled with its jumps filled, by trees."""
    one, eps = jumping_scene(), EPS[2]
    ts = np.linspace(0, 4, 2001)
    fine, speed = fx.solve(one, eps, 1.0, ts), jumping.attrs["graph_speed"]
    limit = np.asarray(fx.solve_limit(one, ts).z)
    readings = fx.mechanics(one, fx.solve_limit(one, ts))
    gap = speed * ts[1] / 4
    points = [dense_points(speed * ts, z, gap) for z in (np.asarray(fine.z), limit)]
    for time, start, end in zip(
        *(readings[name].values for name in ("jump_time", "jump_from", "jump_to")),
        strict=True,
    ):
        filled = np.linspace(start, end, 4001)
        points[1] = np.concatenate(
            [points[1], np.stack([np.full(4001, speed * time), filled], axis=1)]
        )
    far = max(
        float(np.max(cKDTree(points[j]).query(points[i], p=np.inf)[0]))
        for i, j in ((0, 1), (1, 0))
    )
    cell = jumping.sel(gamma=1.0, eps=eps)
    assert float(cell.graph_error) == pytest.approx(far, abs=2 * speed * 4 / 2000)


def test_where_it_jumps_suprema_stay_and_graphs_come_together(jumping):
    assert int(jumping.jumps) == jumping.attrs["jump_times"].size > 0
    assert float(jumping.jump_loss) == pytest.approx(np.sum(jumping.attrs["jump_losses"]))
    sup, graph = jumping.sup_error.values[0], jumping.graph_error.values[0]
    assert np.all(sup > 0.5)
    # It sets off slowly, as eps^(2/3) of a fold: to 1/4 at 1/16 of this eps.
    assert graph[0] > 1.1 * graph[1] > 1.4 * graph[2]
    lost = jumping.dissipation_graph_error.values[0]
    assert lost[0] > 1.4 * lost[1] > 2.2 * lost[2]


def test_where_it_does_not_both_do(followed):
    assert int(followed.jumps) == 0
    assert float(followed.jump_loss) == 0
    assert "jump_times" not in followed.attrs
    sup, graph = followed.sup_error.values[0], followed.graph_error.values[0]
    assert np.all(graph <= sup)
    assert sup[0] > 2.5 * sup[2]


def test_all_eps_are_one_program(jumping, monkeypatch):
    counts = [len(program._known) for program in (phases.slide, phases.turn)]
    fx.sweep(jumping_scene(), [0.07, 0.03], [0.8, 1.2], [0.0, 1.0])
    assert counts == [len(program._known) for program in (phases.slide, phases.turn)]


def test_what_is_not_asked_for_is_not_there():
    few = fx.sweep(jumping_scene(), EPS[:1], [1.0], TS, dissipation=False, suprema=False)
    left = {"dissipation", "residual", "sup_error", "graph_error", "strip_excess"}
    assert not left & set(few)
    assert {"z", "root", "mode", "jumps"} <= set(few)


def test_selected_cells_are_a_grid_again(jumping):
    from frictionjax.sweeps import whole_grid

    again = whole_grid(jumping.isel(gamma=0, eps=1))
    assert again.root.dims == ("eps", "gamma", "time")
    assert again.jumps.dims == ()
    assert again.root_limit.dims == ("time",)


def test_several_scenes_have_it_in_front():
    two = {"jumps": jumping_scene(), "follows": turning_scene()}
    both = fx.sweep(two, EPS[:1], [1.0], TS)
    assert both.jumps.sel(scene="follows") == 0
    assert both.jumps.sel(scene="jumps") > 0
    assert both.graph_error.dims == ("scene", "gamma", "eps")


def test_it_comes_back_from_a_file(jumping, tmp_path):
    import xarray as xr

    jumping.to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    again = xr.load_dataset(tmp_path / "a.nc", engine="h5netcdf")
    xr.testing.assert_identical(again, jumping)


def test_windows_are_refused():
    with pytest.raises(ValueError, match="does not do NapFlip: needs method="):
        fx.sweep(jumping_scene(), EPS, [1.0], method="windowed")


def test_starts_outside_are_refused_as_the_limit_does():
    """Outside the strip of the rod that keeps its nap, and outside of less only."""
    for z0 in (5.0, 0.3, -0.3):
        scene = turning_scene().replace(z0=z0)
        with pytest.raises(ValueError, match="what the rod withstands") as limit:
            fx.solve_limit(scene)
        with pytest.raises(ValueError, match=re.escape(str(limit.value))):
            fx.sweep(scene, EPS[:1], [1.0])
