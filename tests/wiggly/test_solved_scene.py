"""Trajectories know the scene that they are of: its load, and the force on the root."""

import jax
import numpy as np
import pytest

import frictionjax as fx

SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0),
    fx.supports.Spring(2.0),
    fx.loads.Sine(1.0488, 3.0),
    3.0,
)
TS = np.linspace(0.0, 3.0, 7)


def test_loads_and_forces_are_those_of_the_scene():
    found = fx.solve(SCENE, 1e-2, 1.0, TS)
    load = 1.0488 * np.sin(2 * np.pi * TS / 3.0)
    np.testing.assert_allclose(found.load, load, atol=1e-14)
    np.testing.assert_allclose(found.force, load - 2.0 * np.asarray(found.z), atol=1e-14)


def test_a_data_set_holds_all_that_there_is():
    found = fx.solve(SCENE, 1e-2, 1.0, TS)
    data = found.to_dataset()
    assert set(data.data_vars) == {"z", "dissipation", "residual"}
    np.testing.assert_array_equal(data.z, found.z)
    np.testing.assert_array_equal(data.time, TS)
    assert data.z.attrs["units"] == "m"
    assert data.attrs["status"] == "OK"
    assert data.attrs["values"] == found.how


def test_what_nothing_is_known_of_is_said_to_be():
    found = fx.solve(SCENE, 1e-2, 1.0, TS)
    with pytest.raises(ValueError, match="of no scene that is known"):
        _ = jax.tree_util.tree_map(lambda leaf: leaf, found).load
    array = SCENE.replace(effects=(fx.effects.CompliantArray([0.0, 0.3]),))
    found = fx.solve(array, 1e-2, 1.0, TS, dissipation=False)
    assert found.load.shape == TS.shape
    with pytest.raises(ValueError, match=r"of a compliant array.*fx\.mechanics"):
        _ = found.force
