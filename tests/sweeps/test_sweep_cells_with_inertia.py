"""Sweeps of scenes with inertia."""

import numpy as np
import pytest
from tips_with_mass import RHO, mass_for, massive_scene

import frictionjax as fx
from frictionjax.wiggly.inertial import lanes_with_mass

EPS = np.geomspace(5e-2, 1.2e-2, 6)


@pytest.fixture(scope="module")
def data():
    scene = massive_scene(mass_for(0.05, 1.0, 0.0), 3.0)
    return fx.sweep(scene, EPS, [0.75, 1.0], np.linspace(0, 3, 61))


def test_columns_are_those_of_other_scenes(data):
    plain = fx.sweep(massive_scene(1.0).replace(effects=()), EPS[:1], [1.0])
    assert set(plain.data_vars) - set(data.data_vars) == set()
    assert set(data.data_vars) - set(plain.data_vars) == {"beta", "velocity", "spread"}
    assert np.all(np.isnan(data.bracket))
    assert np.all(data.status == 0)
    assert data.beta.attrs["long_name"].startswith("m_eps max|W''|")
    for name in ("beta", "velocity", "spread"):
        assert "units" in data[name].attrs


def test_beta_is_that_of_each_cell(data):
    mass = mass_for(0.05, 1.0, 0.0) * EPS**3
    for gamma in (0.75, 1.0):
        expected = mass * 2 * np.pi * RHO * EPS ** (-1 - 2 * gamma)
        np.testing.assert_allclose(data.beta.sel(gamma=gamma), expected, rtol=1e-5)


@pytest.mark.slow  # 20,001 times: a loop of its own
def test_suprema_are_those_of_a_fine_curve(data):
    eps = float(EPS[2])
    scene = massive_scene(mass_for(0.05, 1.0, 0.0), 3.0)
    ts = np.linspace(0, 3, 20001)
    fine, limit = fx.solve(scene, eps, 1.0, ts=ts), fx.solve_limit(scene, ts)
    cell = data.sel(gamma=1.0, eps=eps)
    far = np.max(np.abs(fine.z - limit.z))
    assert float(cell.sup_error) == pytest.approx(float(far), abs=5e-3 * eps)
    lost = np.max(np.abs(fine.dissipation - limit.dissipation))
    assert float(cell.dissipation_error) == pytest.approx(float(lost), rel=1e-2)
    load = 1.0488 * np.sin(2 * np.pi * ts / 3)
    outside = np.maximum(load - RHO - fine.z, fine.z - load - RHO)
    assert float(cell.strip_excess) == pytest.approx(np.max(outside), abs=5e-3 * eps)


@pytest.mark.slow  # a support of one's own
def test_supports_of_functions_are_swept_too():
    """A program of some ten gigabytes, which ended the process."""
    soft = fx.supports.Convex(lambda z: 0.025 * z**2 + z**4 / 4)
    scene = massive_scene(1e-5).replace(support=soft)
    cell = fx.sweep(scene, 0.05, 1.0, np.linspace(0, 3, 6001)).isel(eps=0, gamma=0)
    assert int(cell.status) == fx.Status.OK
    seen = np.abs(cell.z - cell.z_limit).max()
    outside = np.maximum(cell.z_minus - cell.z, cell.z - cell.z_plus).max()
    lost = np.abs(cell.dissipation - cell.dissipation_limit).max()
    assert float(cell.sup_error) == pytest.approx(float(seen), abs=1e-3 * 0.05)
    assert float(cell.strip_excess) == pytest.approx(float(outside), abs=1e-3 * 0.05)
    assert float(cell.dissipation_error) == pytest.approx(float(lost), rel=1e-3)


def test_what_is_not_asked_for_is_not_there():
    scene = massive_scene(mass_for(0.05, 1.0, 0.0), 3.0)
    few = fx.sweep(scene, EPS[:1], [1.0], [0.0, 3.0], dissipation=False, suprema=False)
    assert not {"dissipation", "residual", "sup_error", "strip_excess"} & set(few)
    assert {"z", "velocity", "beta"} <= set(few)


def test_one_program_for_all_cells(data, monkeypatch):
    known = lanes_with_mass.march_with_mass._known
    before = len(known)
    other = massive_scene(0.3, 2.5, load=fx.loads.Ramp(1.0, 0.0), duration=2.0)
    fx.sweep(other, EPS[:3], [1.0, 1.2], np.linspace(0, 2, 61), accuracy=1e-4)
    assert len(known) == before
