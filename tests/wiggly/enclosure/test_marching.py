"""How lanes of brackets are dealt to threads."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.wiggly.enclosure import marching


@pytest.mark.parametrize(("eps", "asked"), [(0.02, False), (5e-4, True)])
def test_lanes_of_few_wells_stay_in_one_thread(monkeypatch, eps, asked):
    found = []

    def crew(*args):
        found.append(args)
        return known(*args)

    known = marching.crew
    monkeypatch.setattr(marching, "crew", crew)
    profile, support = fx.profiles.Sine(0.10635), fx.supports.Spring(1.7858)
    bristle = fx.bristles.SlantedSpring(1.34635, 2.4, 1.0, angle=0.50613)
    scene = fx.Scene(profile, bristle, support, fx.loads.Sine(1.02157, 3.0), 3.0)
    fx.solve(scene, eps, ts=np.linspace(0, 3, 101), method="resolved")
    assert bool(found) == asked


@pytest.mark.parametrize("z0", [1e8, -1e8])
def test_no_lane_comes_from_billions_of_wells_away(z0):
    """It never ended; where the start is forgotten values are as of any other."""
    parts = fx.profiles.Sine(0.1), fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
    load = fx.loads.Sine(1.05, 3.0)
    scene = fx.Scene(*parts, fx.supports.Spring(1.0), load, 3.0)
    far, near = (
        fx.solve(s, 0.05, 2.0, [0.0, 0.1, 1.0, 3.0])
        for s in (scene.replace(z0=z0), scene.replace(z0=1e3))
    )
    assert far.status.name == "MAX_STEPS"
    assert far.z[0] == z0
    assert np.isnan(far.z[1])
    assert near.ok
    np.testing.assert_allclose(far.z[2:], near.z[2:], atol=1e-3 * 0.05)
