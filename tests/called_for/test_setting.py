"""How fast tips move outside of slips: what estimates are made with."""

import numpy as np
import pytest
from scipy.special import ai_zeros, airy

import frictionjax as fx
from frictionjax.called_for import setting_of

RHO = 0.1
SCENE = fx.Scene(
    fx.profiles.Sine(RHO),
    fx.bristles.Homothetic(1.0),
    fx.supports.Spring(1.0),
    fx.loads.Triangle(1.0, 2.0),  # 2 N/s, and slides at 2 m/s
    2.0,
)


@pytest.mark.parametrize("eps", [1e-3, 1e-5])
def test_near_a_fold_a_resting_tip_moves_as_its_parabola_says(eps):
    """At half a percent of a well's force below it: `W'' = sqrt(0.01 c eps k)`, and the
    tip moves by `1/(k + W''/eps)` with the load, k times that of the support."""
    curved = RHO * (2 * np.pi) ** 2
    steep = np.sqrt(0.01 * curved * eps)
    found = setting_of(SCENE, eps, 5.0).fastest
    assert found == pytest.approx(eps / steep, rel=1e-3)
    assert found < 0.2


@pytest.mark.parametrize("eps", [3e-3, 1e-3, 3e-4, 1e-4])
def test_where_drag_holds_tips_up_a_little_airy_functions_tell_how_fast_they_go(eps):
    """Of `eps^3 Y' = k v t + c Y^2/2` half a percent of a well's time before the slip.

    With t in `(2 eps^6/(k v c))^(1/3)` it is `x' = t + x^2`, and `x = Ai'(-t)/Ai(-t)`.
    """
    curved, speed = RHO * (2 * np.pi) ** 2, 2.0
    unit = (2 * eps**6 / (speed * curved)) ** (1 / 3)
    t = -ai_zeros(1)[0][0] - 0.005 * eps / speed / unit
    value, slope, _, _ = airy(-t)
    times_as_fast = unit / eps**2 * (t + (slope / value) ** 2)
    found = setting_of(SCENE, eps, 2.0).fastest
    assert times_as_fast <= found <= 1.25 * times_as_fast


def test_no_tip_is_faster_than_the_largest_force_drives_it():
    """`eps^gamma z' <= rho_plus + eps^gamma v - rho_minus`."""
    found = setting_of(SCENE, 0.1, 0.5).fastest
    assert found == pytest.approx(1 + 2 * RHO / (2.0 * 0.1**0.5), rel=1e-3)
    found = setting_of(SCENE, 0.02, 1.0).fastest
    assert found == pytest.approx(1 + 2 * RHO / (2.0 * 0.02), rel=1e-3)
    data = fx.solve(SCENE, 0.02, 1.0, np.linspace(0.3, 0.45, 3000), dissipation=False)
    speed = np.max(np.diff(data.z) / np.diff(data.ts)) / 2.0
    assert 0.7 * found < speed <= found


def test_a_fold_that_holds_tips_up_lets_them_run_off_fast():
    """Half a percent of a well's time before: 10 times, and no more is outside a slip."""
    assert setting_of(SCENE, 5e-3, 1.0).fastest == 10.0
