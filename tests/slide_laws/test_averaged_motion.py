"""The averaged motion seeks the state of what moves, and of nothing else."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.slide_laws import SlideData, averaged_motion, predict_errors


@pytest.mark.parametrize(
    "load", [fx.loads.Sine(1.0488, 3.0), fx.loads.Triangle(1.0488, 3.0)]
)
def test_a_direction_in_which_no_tip_moves_costs_nothing(load, monkeypatch):
    bristle = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    scene = fx.Scene(fx.profiles.Sine(0.1), bristle, fx.supports.Spring(1.0), load, 3.0)
    data = SlideData.of(fx.sweep(scene, eps=[0.05, 0.02], gamma=0.25).attrs)
    sought = []
    relaxed = averaged_motion._relaxed

    def counted(*given):
        sought.append(given)
        return relaxed(*given)

    monkeypatch.setattr(averaged_motion, "_relaxed", counted)
    found = predict_errors(data, np.array([0.05, 0.02]), np.array([0.25]))
    assert np.isfinite(found["sup_error"].errors).all()
    moments = data.length.size
    assert len(sought) < 2.2 * moments, "of two motions, in one direction at a time"
