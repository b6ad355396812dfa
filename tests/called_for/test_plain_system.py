"""What is told of the plain system, on scenes that ship, against an effect switched off."""

import numpy as np
import pytest
from outside_slips import states_outside_slips, times_about

import frictionjax as fx
from frictionjax.io.example_scenes import example_text
from frictionjax.io.scene_files import parse_scene

EPS = 5e-3
LEADING = (fx.effects.LeadingOrder(),)
SCENES = (
    *("vertical-spring", "slanted-spring", "angular-spring", "leading-order"),
    *("nap", "measured-groove"),
)
SLOW = pytest.mark.slow
CASES = [
    pytest.param(name, gamma, EPS, marks=() if (name, gamma) == (SCENES[0], 1.0) else SLOW)
    for name in SCENES
    for gamma in (0.5, 1.0, 2.0)
]
# Where slips are late by how far a fold moves, 20 times what its force says.
CASES.append(pytest.param("nap", 2.0, 2e-2, marks=SLOW))


@pytest.mark.parametrize(("name", "gamma", "eps"), CASES)
def test_the_higher_order_changes_less_than_told_and_no_tenth_of_it(name, gamma, eps):
    scene = parse_scene(example_text(name), name).scene.replace(effects=())
    times = times_about(scene, eps)
    whole, calm = states_outside_slips(scene, gamma, eps, times)
    without, still = states_outside_slips(scene.replace(effects=LEADING), gamma, eps, times)
    seen = np.max(np.abs(whole - without)[calm & still])
    told = float(fx.explain(scene, eps, gamma).effects.in_z.sel(effect="higher order"))
    assert np.mean(calm & still) > 0.9
    assert seen <= told <= 10 * seen
