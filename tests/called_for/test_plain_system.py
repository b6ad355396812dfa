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
# Wells so stiff that tips hardly move in them.
CASES += [pytest.param("crawler-foot", g, 5e-6, marks=SLOW) for g in (0.5, 1.0, 2.0)]
SHIPPED = [
    pytest.param(name, eps, marks=SLOW)
    for name in (*SCENES, "crawler-foot", "rigid-array")
    for eps in parse_scene(example_text(name), name).study["eps"]
]


def seen_and_told(scene, gamma, eps):
    """Largest change of the state outside of slips, and the row of `explain`."""
    times = times_about(scene, eps)
    leading = scene.replace(effects=(*scene.effects, *LEADING))
    whole, calm = states_outside_slips(scene, gamma, eps, times)
    without, still = states_outside_slips(leading, gamma, eps, times)
    assert np.mean(calm & still) > 0.9
    row = fx.explain(scene, eps, gamma).effects.sel(effect="higher order")
    return np.max(np.abs(whole - without)[calm & still]), row


@pytest.mark.parametrize(("name", "gamma", "eps"), CASES)
def test_the_higher_order_changes_less_than_told_and_no_tenth_of_it(name, gamma, eps):
    scene = parse_scene(example_text(name), name).scene.replace(effects=())
    seen, row = seen_and_told(scene, gamma, eps)
    assert seen <= float(row.in_z) <= 10 * seen


@pytest.mark.parametrize(("name", "eps"), SHIPPED)
def test_so_it_is_at_every_eps_that_ships_or_explain_says_that_it_is_no_bound(name, eps):
    scene = parse_scene(example_text(name), name).scene
    kept = tuple(e for e in scene.effects if isinstance(e, fx.effects.RigidArray))
    seen, row = seen_and_told(scene.replace(effects=kept), 1.0, eps)
    if "no bound" not in str(row.source.values):
        assert seen <= float(row.in_z) <= 10 * seen
