"""Several scenes in one sweep: each as it is alone, under its label."""

import numpy as np
import pytest
import xarray as xr

import frictionjax as fx
from frictionjax.sweeps.selected_cells import one_scene
from frictionjax.wiggly.equation.status import FailedCells
from frictionjax.wiggly.sequential.rosenbrock_solvers import Rodas5P

EPS, GAMMA = [0.05, 0.02, 0.01], [0.5, 1.0]
TIMES = np.linspace(0.0, 3.0, 61)


def scene_of(profile=None, duration=3.0, z0=0.0):
    return fx.Scene(
        fx.profiles.Sine(0.1) if profile is None else profile,
        fx.bristles.SlantedSpring(1.0, 2.2, 1.0, 0.4),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0488, 3.0),
        duration,
        z0,
    )


SCENES = {
    "sine": scene_of(),
    "series": scene_of(fx.profiles.Fourier([0.01, 0.003], [0.012, 0.0])),
    "spline": scene_of(fx.profiles.Spline(0.02 * np.sin(2 * np.pi * np.arange(12) / 12))),
}


@pytest.fixture(scope="module")
def data():
    return fx.sweep(SCENES, EPS, GAMMA, TIMES)


def test_scenes_are_a_dimension_with_their_labels(data):
    assert data.z.dims == ("scene", "gamma", "eps", "time")
    assert data.z_limit.dims == ("scene", "time")
    assert data.scene.values.tolist() == list(SCENES)
    assert "angle=0.4" in data.parts.sel(scene="spline").item()
    for name in data.variables:
        assert data[name].attrs["long_name"], name


@pytest.mark.parametrize("label", SCENES)
def test_each_is_what_it_is_alone(data, label):
    alone, one = fx.sweep(SCENES[label], EPS, GAMMA, TIMES), data.sel(scene=label)
    for name in alone.data_vars:
        np.testing.assert_array_equal(one[name], alone[name], err_msg=name)
    own = one_scene(one)
    laws = {name for name in alone.attrs if name.startswith("law_")}
    assert laws == {name for name in own.attrs if name.startswith("law_")}
    for name in laws:
        np.testing.assert_array_equal(own.attrs[name], alone.attrs[name], err_msg=name)


def test_lanes_of_two_queues_have_the_same_bits():
    few = {label: SCENES[label] for label in ("sine", "series")}
    eps = [0.05, 0.01, 0.002, 0.0005]
    both = fx.sweep(few, eps, GAMMA, TIMES)
    for label, scene in few.items():
        alone = fx.sweep(scene, eps, GAMMA, TIMES)
        for name in ("z", "dissipation", "sup_error", "steps"):
            np.testing.assert_array_equal(both[name].sel(scene=label), alone[name])


def test_lists_are_numbered_and_files_keep_all(data, tmp_path):
    listed = fx.sweep(list(SCENES.values()), EPS, GAMMA, TIMES)
    assert listed.scene.values.tolist() == [0, 1, 2]
    np.testing.assert_array_equal(listed.sup_error, data.sup_error)
    data.to_netcdf(tmp_path / "scenes.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "scenes.nc", engine="h5netcdf") as again:
        xr.testing.assert_identical(again.load(), data)


def test_other_solvers_know_scenes_too():
    sine = SCENES["sine"]
    pair = {"sine": sine, "steeper": sine.replace(profile=fx.profiles.Sine(0.15))}
    # The program of a test of single scenes, which take as many times: without energies,
    # three fifths of it.
    cell = [0.09], [1.0], TIMES
    found = fx.sweep(pair, *cell, 1e-2, method=Rodas5P(), dissipation=False)
    ours = fx.sweep(pair, *cell, accuracy=1e-3)
    assert np.abs(found.z - ours.z).max() < 2e-2 * 0.09


def test_what_is_wrong_with_a_scene_names_it():
    with pytest.raises(ValueError, match=r"scene 'far': scene\.z0 = 9: needs z_minus"):
        fx.sweep({"near": scene_of(), "far": scene_of(z0=9.0)}, EPS, GAMMA)
    with pytest.raises(ValueError, match="scene 1: scene = 'int': needs a Scene"):
        fx.sweep([scene_of(), 3], EPS, GAMMA)
    with pytest.raises(ValueError, match="a Scene, or several"):
        fx.sweep([], EPS, GAMMA)
    for labels in (["a", 1], [10**30, 1]):  # no file has room for the latter
        with pytest.raises(ValueError, match=r"scene = .*: needs .* all str, or all"):
            fx.sweep({label: scene_of() for label in labels}, EPS, GAMMA)
    with pytest.raises(ValueError, match="scene = 'generator': needs a Scene, or several"):
        fx.sweep((scene_of() for _ in range(2)), EPS, GAMMA)
    longer = [scene_of(), scene_of(duration=4.0)]
    with pytest.raises(ValueError, match="ts = None: needs times ts, as scenes last"):
        fx.sweep(longer, EPS, GAMMA)
    numbered = dict(zip(np.arange(2), longer, strict=True))
    assert fx.sweep(numbered, EPS[:1], GAMMA, TIMES).scene.values.tolist() == [0, 1]


def test_failed_cells_are_named_with_their_scene(data):
    broken = data.copy(deep=True)
    broken["status"][1, 0, 2] = int(fx.Status.OPEN_BRACKET)
    with pytest.warns(FailedCells, match=r"scene series, gamma = 0.5, eps = 0.01"):
        found = fx.study(broken)
    (cell,) = found.failed
    assert (cell["scene"], cell["eps"]) == ("series", 0.01)


@pytest.mark.parametrize("none", [[], {}, ()])
def test_no_scenes_are_named(none):
    with pytest.raises(ValueError, match=r"scenes? = .*: needs a Scene, or several"):
        fx.sweep(none, 0.1, 1.0)
