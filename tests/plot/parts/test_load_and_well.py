"""What pulls at a scene and what holds it, as they are drawn."""

import numpy as np
import pytest

import frictionjax as fx


def test_the_force_of_a_well_ends_at_the_friction_coefficients():
    bristle = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)
    rest = fx.supports.Spring(1.0), fx.loads.Sine(1.5, 2.0), 3.0
    scene = fx.Scene(fx.profiles.Sine(0.1), bristle, *rest)
    left, right = fx.plot.draw_forces(scene).axes
    t, load = left.lines[0].get_data()
    assert load == pytest.approx(1.5 * np.sin(np.pi * t), abs=1e-12)
    assert t[-1] == 3.0
    law, force = fx.friction(scene), right.lines[0].get_ydata()
    assert force.max() == pytest.approx(float(law.rho_plus), rel=1e-4)
    assert force[0] == pytest.approx(force[-1])  # one whole period, with one lowest place
    assert np.count_nonzero(np.diff(np.sign(np.diff(force)))) == 1
    assert force.min() == pytest.approx(float(law.rho_minus), rel=1e-4)
    levels = [line.get_ydata()[0] for line in right.lines[1:]]
    assert levels == pytest.approx([float(law.rho_plus), float(law.rho_minus)])
