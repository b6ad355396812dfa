"""What effects change is less than told, and more than a tenth: on scenes that ship."""

import numpy as np
import pytest
from outside_slips import states_outside_slips, times_about

import frictionjax as fx
from frictionjax.called_for import inertia_numbers
from frictionjax.io.example_scenes import example_lines, example_text
from frictionjax.io.scene_files import parse_scene

ACCURACY = 1e-6  # of suprema, in eps

pytestmark = pytest.mark.slow  # each cell compiles, and takes minutes with mass


def scene_of(name):
    return parse_scene(example_text(name), name).scene


def shipped_eps(name):
    return parse_scene(example_text(name), name).study["eps"]


def told_of(scene, effect, eps, gamma=1.0):
    return float(fx.explain(scene, eps, gamma).effects.in_z.sel(effect=effect))


def seen_of_a_mass(heavy, eps, gamma=1.0):
    times = times_about(heavy, eps)
    (with_mass, calm), (without, still) = (
        states_outside_slips(s, gamma, eps, times, 1e-5, method="resolved")
        for s in (heavy, heavy.replace(effects=()))
    )
    assert np.mean(calm & still) > 0.9
    return np.max(np.abs(with_mass - without)[calm & still])


@pytest.mark.parametrize("eps", [*shipped_eps("inertia"), 0.004])  # a slip behind there
def test_a_mass(eps):
    heavy = scene_of("inertia")
    seen = seen_of_a_mass(heavy, eps)
    assert seen <= told_of(heavy, "Inertia", eps) <= 10 * seen


@pytest.mark.parametrize(
    ("eps", "gamma", "behind"),
    [(0.006, 1.0, False), (0.012, 1.0, True), (0.02, 1.5, False), (0.05, 1.5, True)],
)
def test_a_mass_where_slips_are_late_by_as_long_as_they_last(eps, gamma, behind):
    """A little less, and there are no times outside of both slips; beta = 0.3."""
    bristle = fx.bristles.SlantedSpring(1.0, 2.2, 1.0, 0.4)
    light = scene_of("inertia").replace(bristle=bristle, effects=())
    number = float(inertia_numbers(light.potential, fx.effects.Inertia(1.0), eps, gamma))
    heavy = light.replace(effects=(fx.effects.Inertia(0.3 / number),))
    seen = seen_of_a_mass(heavy, eps, gamma)
    assert (seen > 0.15 * eps) == behind
    assert seen <= told_of(heavy, "Inertia", eps, gamma) <= 10 * seen


@pytest.mark.parametrize("eps", shipped_eps("noise"))
def test_noise(eps):
    """The worst of eight paths, where tips of neither scene slip."""
    warm = scene_of("noise")
    times = times_about(warm, eps)
    still_z, still = states_outside_slips(warm.replace(effects=()), 1.0, eps, times, 1e-4)
    seen = 0.0
    for key in range(8):
        z, calm = states_outside_slips(warm, 1.0, eps, times, 1e-3, key=key)
        seen = max(seen, np.max(np.abs(z - still_z)[calm & still]))
    assert seen <= told_of(warm, "Noise", eps) <= 10 * seen


@pytest.mark.parametrize("gamma", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("name", example_lines())
def test_finite_speed(name, gamma):
    """By how far one bristle is beyond the strip; its potential is the leading one."""
    shared = [e for e in scene_of(name).effects if isinstance(e, fx.effects.RigidArray)]
    scene = scene_of(name).replace(effects=(*shared, fx.effects.LeadingOrder()))
    eps = shipped_eps(name)
    seen = fx.sweep(scene, eps, [gamma], ts=[0.0], accuracy=ACCURACY).strip_excess
    told = [told_of(scene, "finite speed", e, gamma) for e in eps]
    seen, off = seen.sel(gamma=gamma).values, ACCURACY * np.array(eps)
    assert np.all(seen - off <= told)
    assert np.all(told <= 1.05 * seen + off)
