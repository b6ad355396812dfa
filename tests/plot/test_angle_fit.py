"""Pictures of designs of a bristle say where its range ends."""

import numpy as np
import pytest

import frictionjax as fx

BRISTLE = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)


def ends(axes):
    """Places and texts of the lines that end a range."""
    return {text.xy[0]: text.get_text() for text in axes.texts}


def test_angles_end_where_alpha_does():
    fit = fx.fit_angle(fx.profiles.Sine(0.1), BRISTLE, ratio=1.5)
    (axes,) = fx.plot.draw_angle_fit(fit).axes
    vertical = np.arccos(1 / 2.4)  # as long as it is unloaded
    assert sorted(ends(axes)) == pytest.approx([-vertical, vertical], abs=1e-6)
    assert set(ends(axes).values()) == {"$\\alpha$ = 0"}
    low, high = axes.get_xlim()
    assert low < -vertical < vertical < high


def test_bounds_are_no_such_ends():
    fit = fx.fit_angle(fx.profiles.Sine(0.1), BRISTLE, ratio=1.3, bounds=(0.1, 1.0))
    (axes,) = fx.plot.draw_angle_fit(fit).axes
    assert not axes.texts
    assert np.nanmin(fit.normal_forces(5)) > 0.1
