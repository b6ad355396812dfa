"""Limits for eps -> 0: flatness, forces in closed form, orders."""

import numpy as np
import pytest
from scipy.special import ai_zeros
from slides import RHO, flat, sine, straight, wells

from frictionjax.slide_laws.averaged_motion import steady_force
from frictionjax.slide_laws.exponents import averaged_force, fold_force, limit_orbit
from frictionjax.slide_laws.orbit import periodic_orbit


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(
    ("force", "flatness"), [(sine, 2.0), (flat, 4.0), (straight, np.inf)]
)
def test_flatness_is_found_from_the_force(force, flatness, sign):
    assert wells(force, sign).flatness == flatness


def test_a_steady_slide_over_a_sine_without_rests():
    drag = np.geomspace(1e-6, 1.0, 13)
    exact = np.hypot(RHO, drag) - RHO
    assert steady_force(wells(sine), drag) == pytest.approx(exact, rel=5e-3)
    assert averaged_force(wells(sine), drag[:3]) == pytest.approx(exact[:3], rel=5e-3)


def test_the_averaged_force_of_flat_extremes():
    """`(drag I c^(-1/p))^(p/(p - 1))` with I = 2 pi/(p sin(pi/p)), gap = c y^4."""
    curvature = RHO / 8 * (9 * (2 * np.pi) ** 4 - (6 * np.pi) ** 4) / 24
    integral = 2 * np.pi / (4 * np.sin(np.pi / 4))
    exact = (1e-8 * integral * abs(curvature) ** -0.25) ** (4 / 3)
    assert averaged_force(wells(flat), np.array(1e-8)) == pytest.approx(exact, rel=0.01)


def test_a_tip_at_rest_falls_late_by_the_zero_of_airy():
    speed = np.array([0.5, 2.0])
    force, order = fold_force(wells(sine), speed, np.array([3.0, 3.0]), 1.0)
    curvature = 0.5 * RHO * (2 * np.pi) ** 2
    zero = -ai_zeros(1)[0][0]
    assert order == pytest.approx(4 / 3)
    exact = zero * (3 * speed) ** (2 / 3) * curvature ** (-1 / 3)
    assert force == pytest.approx(exact, rel=0.02)


@pytest.mark.parametrize(("force", "gamma"), [(sine, 2.5), (flat, 1.8), (straight, 1.2)])
def test_a_tip_that_creeps_over_the_steepest_place_is_held_by_drag_alone(force, gamma):
    eps, speed = 1e-6, 2.0
    found = periodic_orbit(wells(force), np.array(eps), np.array(speed * eps**gamma))
    law, order = fold_force(wells(force), np.array([speed]), np.ones(1), gamma)
    assert order == gamma
    assert float(found.largest) == pytest.approx(float(law[0]) * eps**gamma, rel=0.1)


@pytest.mark.parametrize(
    ("force", "gamma", "order", "law"),
    [
        (sine, 0.25, 0.5, "averaged"),
        (sine, 0.5, 1.0, "between"),
        (sine, 0.6, 1.0, "slips"),
        (flat, 0.6, 0.8, "averaged"),
        (flat, 0.75, 1.0, "between"),
        (straight, 0.75, 0.75, "averaged"),
        (straight, 2.0, 1.0, "slips"),
    ],
)
def test_orders_follow_from_flatness_and_gamma(force, gamma, order, law):
    found = limit_orbit(wells(force), np.ones(1), np.ones(1), gamma)
    assert found.order == pytest.approx(order)
    assert found.law == law
    if law == "slips":  # a well less what is flat of it: a slip ends on the next flank
        ahead = 1 - 2 * np.arccos(1 / 1.7) / (2 * np.pi) if force is straight else 1.0
        assert -found.force.smallest[0] == pytest.approx(ahead, abs=2e-3)
