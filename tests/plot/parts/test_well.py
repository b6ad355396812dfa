"""The force of a potential is drawn with the extremes that friction takes."""

import numpy as np
import pytest

import frictionjax as fx

BRISTLE = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 1.0)


@pytest.mark.parametrize("effects", [(), (fx.effects.RigidArray([0.0, 0.2]),)], ids=len)
def test_levels_are_the_extremes_of_the_force(effects):
    parts = fx.supports.Spring(1.0), fx.loads.Sine(1.0488, 3.0)
    scene = fx.Scene(fx.profiles.Sine(0.1), BRISTLE, *parts, 3.0, effects=effects)
    law = fx.friction(scene)
    (axes,) = law.plot().axes
    force, *levels = (np.asarray(line.get_ydata()) for line in axes.lines)
    assert [force.max(), force.min()] == pytest.approx([level[0] for level in levels], 1e-4)
    assert levels[0][0] == pytest.approx(float(law.rho_plus))
