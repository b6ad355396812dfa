"""Compression along rods, on slides and in sweeps."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.contact import axial_reading

ROD = fx.bristles.AngularSpring(1.0, 2**0.5, 1.0, 0.3)
# s = k L/B = 10: u^2 = 17.076295, so the critical load is u^2 B/L^2
STIFFNESS = 2**0.5 / 10
CRITICAL = 17.076295 * STIFFNESS / 2


def scene(stiffness=STIFFNESS, load=None):
    profile = fx.profiles.Fourier([0.004, 0.0], [0.015, 0.003])
    load = fx.loads.Triangle(1.0, 2.0) if load is None else load
    effects = (fx.effects.AxialLoad(stiffness),)
    return fx.Scene(profile, ROD, fx.supports.Spring(1.3), load, 2.0, effects=effects)


def test_slides_are_pressed_as_the_coefficients_say():
    one = scene()
    ts = np.linspace(0, 2, 401)
    data = fx.mechanics(one, fx.solve_limit(one, ts))
    assert data.critical_load == pytest.approx(CRITICAL, rel=1e-7)
    law, sine, cosine = fx.friction(one), 0.5**0.5, 0.5**0.5  # theta_lim is pi/4
    for way, normal, omega in (
        (1, law.normal_plus, law.omega_plus),
        (-1, law.normal_minus, law.omega_minus),
    ):
        moves = way * np.diff(data.z) > 1e-6
        slide = 1 + np.flatnonzero(moves[:-1] & moves[1:])
        assert slide.size > 50
        pressed = float(normal * (cosine - omega * sine))
        np.testing.assert_allclose(data.compression[slide], pressed, rtol=1e-9)
        np.testing.assert_allclose(
            data.buckling_share[slide], pressed / CRITICAL, rtol=1e-7
        )
    assert np.all(data.compression > 0)
    assert "not shown to buckle" in data.buckling


def test_friction_over_contact_force_is_the_slope_at_small_eps():
    one = scene(load=fx.loads.Ramp(1.0))
    solution = fx.solve(one, 1e-4, 2.0, ts=np.linspace(1.0, 1.01, 41))
    data = fx.mechanics(one, solution, eps=1e-4)
    share = float((-data.tangential_force / data.normal_force).median())
    assert share == pytest.approx(float(fx.friction(one).omega_plus), rel=1e-2)
    assert np.all(data.compression > 0)


def test_a_softer_rod_buckles():
    soft = scene(1e-3)
    data = fx.mechanics(soft, fx.solve_limit(soft, [0.0, 1.0, 2.0]))
    assert "buckles" in data.buckling
    assert "not" not in data.buckling


def test_it_changes_no_motion_and_sweeps_tell_the_largest():
    one, ts, eps = scene(), np.linspace(0, 2, 41), [0.02, 0.01]
    data = fx.sweep(one, eps, [0.5, 1.0], ts=ts)
    plain = fx.sweep(one.replace(effects=()), eps, [0.5, 1.0], ts=ts)
    assert "compression" not in plain
    for name in plain:
        np.testing.assert_array_equal(data[name], plain[name])
    alone = fx.solve(one, 0.01, 0.5, ts=ts)
    read = fx.mechanics(one, alone, eps=0.01).compression.max()
    cell = data.sel(eps=0.01, gamma=0.5)
    assert float(cell.compression) == pytest.approx(float(read), rel=1e-3)
    np.testing.assert_allclose(data.buckling_share, data.compression / CRITICAL, rtol=1e-7)


def test_a_scene_without_it_has_no_reading():
    assert axial_reading(scene().replace(effects=()), 1.0) is None


def test_another_bristle_is_refused():
    with pytest.raises(ValueError, match=r"scene\.bristle = VerticalSpring: needs an Ang"):
        scene().replace(bristle=fx.bristles.VerticalSpring(1.0, 2.0, 1.0))
