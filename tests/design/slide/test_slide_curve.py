"""Slides of arrays whose bristles have supports of their own, against SciPy and lanes."""

import jax
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import frictionjax as fx
from frictionjax.design.slide.slide_curve import SlideCurve

SINE = fx.profiles.Sine(0.1)
VERTICAL = fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
PHASES = np.array([0.13, 1.48, -0.21])


def compliant(phases):
    return (fx.effects.CompliantArray(phases),)


def mean_forces_by_scipy(eps, gamma, rate, sign, periods=8):
    """Over one period after some, all bristles of `PHASES` by LSODA in time, by hand."""

    def field(t, z):
        y = z / eps + PHASES
        press = 1.0 + eps * 0.1 * np.sin(2 * np.pi * y) / (2 * np.pi)
        pull = press * 0.1 * np.cos(2 * np.pi * y)
        return (sign * rate * t - z - pull) / eps**gamma

    start = (0.2 + periods * eps) / rate
    ts = start + np.linspace(0, eps / rate, 4001)
    found = solve_ivp(field, (0, ts[-1]), np.zeros(3), "LSODA", ts, rtol=1e-9, atol=1e-12)
    return np.mean(sign * rate * ts - found.y, axis=0)


@pytest.mark.slow  # a program of its own
def test_the_force_of_an_array_is_that_of_bristles_integrated_in_time():
    eps, gamma, rate = 0.05, 1.0, 0.5
    one = fx.steady_slide(SINE, VERTICAL, eps, gamma, rate)
    many = fx.steady_slide(SINE, VERTICAL, eps, gamma, rate, effects=compliant(PHASES))
    assert many.ok
    assert (many.mean_plus, many.mean_minus) == (one.mean_plus, one.mean_minus)
    for sign, mean, peak, own in (
        (1, many.mean_plus, many.peak_plus, one.peak_plus),
        (-1, many.mean_minus, many.peak_minus, one.peak_minus),
    ):
        force = sign * mean_forces_by_scipy(eps, gamma, rate, sign)
        assert np.trapezoid(force) / 4000 == pytest.approx(sign * float(mean), rel=2e-6)
        assert np.max(force) == pytest.approx(sign * float(peak), rel=2e-5)
        assert sign * float(peak) < sign * float(own) - 1e-3


@pytest.mark.slow  # slides of arrays: a program of their own
def test_phases_decide_ripples_alone():
    """Of equal ones those of one; of even ones a share of it; of random ones less and
    less."""
    eps = np.array([0.05, 1e-3])
    one = fx.steady_slide(SINE, VERTICAL, eps)

    def ripple(phases):
        many = fx.steady_slide(SINE, VERTICAL, eps, effects=compliant(phases))
        assert np.all(many.ok)
        np.testing.assert_array_equal(many.mean_plus, one.mean_plus)
        return np.asarray(many.peak_plus - many.mean_plus)

    alone = np.asarray(one.peak_plus - one.mean_plus)
    np.testing.assert_array_equal(ripple([0.3, 0.3]), alone)
    np.testing.assert_allclose(ripple([0.3, 1.3]), alone, rtol=1e-5)
    # A saw-tooth's mean over n even phases is one of n times the rate, 1/n as high.
    assert ripple(np.arange(4) / 4)[1] == pytest.approx(alone[1] / 4, rel=0.15)
    random = np.random.default_rng(0).uniform(size=400)
    assert np.all(ripple(random) < 0.1 * alone)


@pytest.mark.slow
def test_it_is_what_lanes_find_on_a_long_ramp():
    eps, rng = 0.01, np.random.default_rng(1)
    array = compliant(rng.uniform(size=7))
    ts = np.concatenate([[0.0], 0.6 + eps * np.linspace(0, 1, 801)])
    ramp = fx.loads.Ramp(1.0)
    scene = fx.Scene(SINE, VERTICAL, fx.supports.Spring(1.0), ramp, 0.7, effects=array)
    found = fx.solve(scene, eps, 1.0, ts, accuracy=1e-6)
    force = (ts - np.asarray(found.z))[1:]
    slide = fx.steady_slide(SINE, VERTICAL, eps, effects=array)
    assert np.trapezoid(force) / 800 == pytest.approx(float(slide.mean_plus), rel=2e-5)
    assert np.max(force) == pytest.approx(float(slide.peak_plus), rel=2e-5)


def test_a_sum_of_curves_is_that_of_their_values():
    rng = np.random.default_rng(2)
    share = np.concatenate([[0.0], np.sort(rng.uniform(size=9)), [1.0]])
    force = rng.normal(size=11)
    force[-1] = force[0]
    curve = SlideCurve(share, force, 0.0)
    phases = np.array([0.0, 0.25, -3.1, share[4], 1 - 1e-17])
    many, places = curve.of_many(phases), rng.uniform(size=200)
    exact = [np.mean(np.interp((s + phases) % 1, share, force)) for s in places]
    np.testing.assert_allclose(np.interp(places, many.share, many.force), exact, atol=1e-13)
    assert many.share[-1] == 1.0
    assert many.force[-1] == pytest.approx(many.force[0], abs=1e-13)


def test_derivatives_are_those_of_one_bristle():
    def mean(slope):
        profile = fx.profiles.Sine(slope)
        return fx.steady_slide(profile, VERTICAL, 0.05, effects=compliant(PHASES)).mean_plus

    with pytest.raises(ValueError, match="CompliantArray = 'traced numbers': needs known"):
        jax.grad(mean)(0.1)
