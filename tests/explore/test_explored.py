"""What the page draws is what the library says."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.explore.explored import explored_at, scene_at
from frictionjax.explore.setting import SLIDERS, PageSetting

SETTINGS = [PageSetting(), PageSetting(-0.8, 0.2, -0.4, 0.1, 0.5)]


@pytest.fixture(scope="module", params=SETTINGS, ids=["right", "left"])
def found(request):
    return explored_at(request.param)


@pytest.fixture
def scene(found):
    angle, slope, asymmetry, _, _ = found.setting
    return scene_at(angle, slope, asymmetry)


def test_coefficients_are_those_of_friction(found, scene):
    law = fx.friction(scene)
    named = found.coefficients
    assert named["rho_plus"] == pytest.approx(float(law.rho_plus), rel=1e-12)
    assert named["rho_minus"] == pytest.approx(float(law.rho_minus), rel=1e-12)
    assert named["ratio"] == -named["rho_plus"] / named["rho_minus"]


def test_loops_are_those_of_both_solvers(found, scene):
    """Within what a hundredth of eps allows; slips of this size are not told apart."""
    eps, gamma = found.setting.eps, found.setting.gamma
    wiggly = fx.solve(scene, eps, gamma, found.ts)
    limit = fx.solve_limit(scene, found.ts)
    assert wiggly.ok
    np.testing.assert_allclose(found.z, wiggly.z, rtol=0, atol=0.01 * eps)
    np.testing.assert_allclose(found.force, wiggly.force, rtol=0, atol=0.02 * eps)
    np.testing.assert_allclose(found.z_limit, limit.z, rtol=0, atol=1e-12)
    held = wiggly.load - 2.0 * np.asarray(limit.z)
    np.testing.assert_allclose(found.force_limit, held, rtol=0, atol=1e-12)


def test_energy_is_the_wiggly_potential(found, scene):
    eps = found.setting.eps
    energy = fx.potential(scene.profile, scene.bristle).energy(eps * found.wells, eps)
    np.testing.assert_allclose(found.energy, energy, rtol=1e-9, atol=1e-15)


def test_what_is_sent_are_all_arrays_in_32_bits(found):
    names = "wells", "energy", "ts", "z", "force", "z_limit", "force_limit"
    whole = np.concatenate([getattr(found, name) for name in names])
    sent = np.frombuffer(found.packed(), "<f4")
    np.testing.assert_array_equal(sent, whole.astype(np.float32))


def test_asymmetry_is_the_slope_of_the_second_harmonic_over_the_first():
    profile = scene_at(0.5, 0.1, 0.3).profile
    x = 0.07
    slopes = np.cos(2 * np.pi * x) + 0.3 * np.cos(4 * np.pi * x)
    rise = (float(profile(x + 1e-6)) - float(profile(x - 1e-6))) / 2e-6
    assert rise == pytest.approx(0.1 * slopes, rel=1e-6)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"angle": 1.3, "slope": 0.5}, r"bristle\.angle = 1\.3: needs omega_plus < cot"),
        ({"angle": -1.6}, r"bristle\.angle = -1\.6: needs -pi/2 < angle < pi/2"),
        ({"angle": 7.0}, r"bristle\.angle = 7: needs -pi/2 < angle < pi/2"),
        ({"eps": 1e-18}, r"eps = 1e-18: needs eps >="),
        ({"slope": 0.0}, "slope = 0: needs slope > 0"),
        ({"eps": -0.1}, r"eps = -0\.1: needs eps > 0"),
        ({"gamma": 0.0}, "gamma = 0: needs gamma > 0"),
        ({"eps": np.nan}, "eps = nan: needs a finite number"),
    ],
)
def test_what_the_paper_does_not_allow_is_refused_by_name(changed, message):
    with pytest.raises(ValueError, match=message):
        explored_at(PageSetting()._replace(**changed))


def test_sliders_are_those_of_a_setting_and_reach_its_defaults():
    assert tuple(slider.name for slider in SLIDERS) == PageSetting._fields
    for slider, value in zip(SLIDERS, PageSetting(), strict=True):
        assert slider.low < value < slider.high
