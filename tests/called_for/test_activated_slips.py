"""Barriers against temperature."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.called_for import setting_of
from frictionjax.called_for.activated_slips import activated_slips

RHO, EPS = 0.1, 1e-2
SCENE = fx.Scene(
    fx.profiles.Sine(RHO),
    fx.bristles.Homothetic(1.0),
    fx.supports.Spring(1.0),
    fx.loads.Sine(1.0488, 3.0),
    3.0,
)


def barrier(deficit):
    """Of a sine's well under the force rho - deficit, in J."""
    place = np.arccos(1 - deficit / RHO) / (2 * np.pi)
    area = RHO * np.sin(2 * np.pi * place) / np.pi - 2 * place * (RHO - deficit)
    return EPS * area


@pytest.mark.parametrize("heat", [1e-8, 1e-6, 1e-5])
def test_the_barrier_left_is_so_many_temperatures_high(heat):
    found = activated_slips(setting_of(SCENE, EPS, 1.0), heat)
    assert barrier(found.force) == pytest.approx(found.logarithm * heat, rel=0.02)
    half = np.arccos(1 - found.force / RHO) / (2 * np.pi)
    assert found.width == pytest.approx(half, rel=0.02)
    assert not found.free
    tries = RHO / EPS**2 * 3.0 / 0.01  # max|W''|/(2 pi) = rho
    assert found.logarithm == pytest.approx(np.log(tries), rel=1e-3)


def test_near_the_fold_it_goes_with_the_power_two_thirds():
    curvature = RHO * (2 * np.pi) ** 2
    found = activated_slips(setting_of(SCENE, EPS, 1.0), 1e-9)
    law = (0.75 * 1e-9 / EPS * np.sqrt(curvature / 2) * found.logarithm) ** (2 / 3)
    assert found.force == pytest.approx(law, rel=0.02)


def test_heat_above_every_barrier_leaves_tips_free():
    found = activated_slips(setting_of(SCENE, EPS, 1.0), 1e-3)
    assert found.free
    assert found.force == pytest.approx(RHO, rel=1e-3)


def test_the_weaker_direction_is_told():
    """A surface whose flanks differ, and its mirror image: the same in the other order."""
    profile = fx.profiles.Fourier(cos=[0.0, 0.0], sin=[0.1 / (2 * np.pi), 0.02 / np.pi])
    leaning = setting_of(SCENE.replace(profile=profile), EPS, 1.0)
    data = leaning.data
    mirrored = data._replace(phase=1 - data.phase[::-1], force=-data.force[::-1])
    pair = [
        activated_slips(leaning, 1e-6),
        activated_slips(leaning._replace(data=mirrored), 1e-6),
    ]
    assert pair[0].force == pytest.approx(pair[1].force, rel=1e-6)
    upright = activated_slips(setting_of(SCENE, EPS, 1.0), 1e-6)
    assert pair[0].force != pytest.approx(upright.force, rel=0.1)
