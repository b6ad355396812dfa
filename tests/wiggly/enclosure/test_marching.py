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
