"""What is told of the plain system, on scenes that ship, against an effect switched off."""

import jax
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.io.example_scenes import example_text
from frictionjax.io.scene_files import parse_scene

EPS = 5e-3
LEADING = (fx.effects.LeadingOrder(),)
SCENES = ("vertical-spring", "slanted-spring", "angular-spring", "leading-order")
SLOW = pytest.mark.slow
CASES = [
    pytest.param(name, gamma, marks=() if (name, gamma) == (SCENES[0], 1.0) else SLOW)
    for name in SCENES
    for gamma in (0.5, 1.0, 2.0)
]


def times_about(scene, eps):
    """Times, and those half a percent of a well's time before and after."""
    duration = float(scene.duration)
    middle = np.linspace(0.003, 0.995, 4000) * duration
    pull = np.abs(jax.vmap(jax.grad(scene.load))(middle))
    away = np.minimum(0.005 * eps / np.maximum(pull, 1e-3 * pull.max()), duration / 600)
    return np.maximum(middle - away, 0.0), middle, middle + away


def states_outside_slips(scene, gamma, eps, times):
    """States at the times in between, and where they are outside of slips."""
    ts = np.sort(np.concatenate(times))
    found = fx.solve(scene, eps, gamma, ts, 1e-6, dissipation=False)
    before, z, after = (np.asarray(found.z)[np.searchsorted(ts, t)] for t in times)
    return z, np.maximum(np.abs(z - before), np.abs(after - z)) < 0.05 * eps


@pytest.mark.parametrize(("name", "gamma"), CASES)
def test_the_higher_order_changes_less_than_told_and_no_tenth_of_it(name, gamma):
    scene = parse_scene(example_text(name), name).scene.replace(effects=())
    times = times_about(scene, EPS)
    whole, calm = states_outside_slips(scene, gamma, EPS, times)
    without, still = states_outside_slips(scene.replace(effects=LEADING), gamma, EPS, times)
    seen = np.max(np.abs(whole - without)[calm & still])
    told = float(fx.explain(scene, EPS, gamma).effects.in_z.sel(effect="higher order"))
    assert np.mean(calm & still) > 0.9
    assert seen <= told <= 10 * seen
