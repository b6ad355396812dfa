"""Costs that are told, held against the steps that are taken, on scenes that ship."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.io.example_scenes import example_text
from frictionjax.io.scene_files import parse_scene


def scene_of(name, *effects):
    scene = parse_scene(example_text(name), name).scene
    return scene.replace(effects=effects) if effects else scene


def told(scene, effect, eps, accuracy=1e-3):
    return float(fx.explain(scene, eps, 1.0, accuracy).effects.cost.sel(effect=effect))


def seen(scene, eps, accuracy=1e-3, key=None):
    plain = fx.solve(scene.replace(effects=()), eps, 1.0, accuracy=accuracy)
    if key is not None:
        accuracy = 1e-3  # a path reads none
    return (
        fx.solve(scene, eps, accuracy=accuracy, key=key).stats["steps"]
        / (plain.stats["steps"])
    )


@pytest.mark.slow
@pytest.mark.parametrize("eps", [0.1, 0.02, 0.005])
def test_a_mass_costs_what_is_told_within_a_factor_of_three(eps):
    heavy = scene_of("inertia")
    for accuracy in (1e-3, 1e-4):
        ratio = told(heavy, "Inertia", eps, accuracy) / seen(heavy, eps, accuracy)
        assert 1 / 3 < ratio < 3


@pytest.mark.slow
@pytest.mark.parametrize("mass", [1e-2, 100.0])
def test_so_do_lighter_and_heavier_ones(mass):
    other = scene_of("inertia", fx.effects.Inertia(mass, 3.0))
    assert 1 / 3 < told(other, "Inertia", 0.02) / seen(other, 0.02) < 3


@pytest.mark.slow
@pytest.mark.parametrize("eps", [0.1, 0.02, 0.005])
def test_noise_costs_what_is_told_within_a_factor_of_three(eps):
    warm = scene_of("noise")
    assert 1 / 3 < told(warm, "Noise", eps) / seen(warm, eps, key=0) < 3


@pytest.mark.slow  # measured: 4 s
def test_smaller_eps_cost_more_with_noise_and_as_much_with_mass():
    """Steps of a path go like eps^-2, those of slips like their number."""
    noise = [told(scene_of("noise"), "Noise", eps) for eps in (0.02, 0.005, 1e-7)]
    assert 2.5 < noise[1] / noise[0] < 6
    assert noise[2] == np.inf
    mass = [told(scene_of("inertia"), "Inertia", eps) for eps in (0.02, 0.005)]
    assert 0.5 < mass[1] / mass[0] < 2
    assert min(mass) > 1


def test_what_nothing_is_known_of_stays_so():
    """Loads that never turn: nothing is solved to be told."""
    flips, array = (
        scene_of(name).replace(load=fx.loads.Ramp(1.0))
        for name in ("nap-flip", "compliant-array")
    )
    assert np.isnan(told(flips, "NapFlip", 0.02))
    assert told(array, "CompliantArray", 0.02) > 1
