"""How lanes of brackets are dealt to threads."""

from functools import partial

import pytest

import frictionjax as fx
from frictionjax.wiggly import batch
from frictionjax.wiggly.enclosure import marching


@pytest.mark.parametrize(("eps", "asked"), [(0.02, False), (5e-4, True)])
def test_lanes_of_few_wells_stay_in_one_thread(monkeypatch, eps, asked):
    found = []

    def crew(*args):
        found.append(args)
        return known(*args)

    known, two = marching.crew, partial(batch.AttemptContext, workers=2)
    monkeypatch.setattr(marching, "crew", crew)
    monkeypatch.setattr(batch, "AttemptContext", two)
    bristle = fx.bristles.SlantedSpring(1.1, rest_length=2.4, height=1.0, angle=0.43)
    parts = fx.profiles.Sine(0.11), bristle, fx.supports.Spring(2.0), fx.loads.Sine(1.05, 3.0)
    fx.solve(fx.Scene(*parts, 3.0), eps, method="resolved")
    assert bool(found) == asked
