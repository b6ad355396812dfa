"""All bristles, supports and loads against independent trajectories."""

import math

import jax.numpy as jnp
import numpy as np
import pytest
import reference as ref
from by_hand import Case, angular, piecewise, sine_load, slanted, vertical
from scipy.interpolate import CubicSpline

import frictionjax as fx

EPS = 0.02
TIMES = np.linspace(0.0, 3.0, 61)


def case(profile, bristle_, support, load_, gamma, z0, **system) -> Case:
    scene = fx.Scene(profile, bristle_, support, load_, 3.0, z0)
    return Case(scene, ref.System(duration=3.0, **system), gamma, z0)


def vertical_sine() -> Case:
    return case(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0488, 3.0),
        1.0,
        0.05,
        w=ref.sine(0.1),
        bristle=vertical(1.0, 2.0, 1.0),
        force=lambda z: z,
        load=sine_load(1.0488, 3.0),
    )


def stretched_vertical_triangle() -> Case:
    triangle = piecewise([0, 0.5, 1.5, 2.5, 3.0], [0, 0.9, -0.9, 0.9, 0])
    return case(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(2.0, 0.5, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.Triangle(0.9, 2.0),
        0.5,
        0.0,
        w=ref.sine(0.1),
        bristle=vertical(2.0, 0.5, 1.0),
        force=lambda z: z,
        load=triangle,
        kinks=(0.5, 1.5, 2.5),
    )


def slanted_fourier_far_above() -> Case:
    cos, sin = [0.004, 0.002], [0.012, -0.003]
    return case(
        fx.profiles.Fourier(cos, sin),
        fx.bristles.SlantedSpring(1.0, 2.2, 1.0, 0.4),
        fx.supports.Spring(2.0),
        fx.loads.Sine(1.3, 3.0),
        1.0,
        2.0,
        w=ref.series(cos, sin),
        bristle=slanted(1.0, 2.2, 1.0, 0.4),
        force=lambda z: 2.0 * z,
        load=sine_load(1.3, 3.0),
    )


def slanted_back_alpha_negative_plateau() -> Case:
    times = [0.0, 0.6, 1.0, 1.6, 1.9, 2.1, 3.0]
    values = [0.0, 0.7, 0.7, 0.3, 0.45, 0.2, -0.6]
    return case(
        fx.profiles.Sine(0.15),
        fx.bristles.SlantedSpring(1.0, 0.6, 1.0, -0.5),
        fx.supports.Spring(1.0),
        fx.loads.PiecewiseLinear(times, values),
        2.0,
        0.0,
        w=ref.sine(0.15),
        bristle=slanted(1.0, 0.6, 1.0, -0.5),
        force=lambda z: z,
        load=piecewise(times, values),
        kinks=tuple(times[1:-1]),
        rate=1.2,
    )


def angular_convex_triangle() -> Case:
    triangle = piecewise([0, 0.75, 2.25, 3.0], [0, 1.2, -1.2, 0])
    return case(
        fx.profiles.Sine(0.2),
        fx.bristles.AngularSpring(1.0, 1.3, 1.0, 0.1),
        fx.supports.Convex(lambda z: 0.5 * z**2 + 0.25 * z**4),
        fx.loads.Triangle(1.2, 3.0),
        1.0,
        0.0,
        w=ref.sine(0.2),
        bristle=angular(1.0, 1.3, 1.0, 0.1),
        force=lambda z: z + z**3,
        load=triangle,
        kinks=(0.75, 2.25),
        rate=1.6,
    )


def homothetic_ramp_far_below() -> Case:
    return case(
        fx.profiles.Sine(0.1),
        fx.bristles.Homothetic(-1.0),
        fx.supports.Spring(0.5),
        fx.loads.Ramp(0.4, -0.2),
        1.5,
        -1.5,
        w=ref.sine(0.1),
        bristle=lambda eta: (0.0, 0.0, -1.0),
        force=lambda z: 0.5 * z,
        load=lambda t: -0.2 + 0.4 * t,
        stiffness=0.5,
        rate=0.4,
    )


def custom_everything() -> Case:
    def load(t):
        return 0.8 * (1 - math.cos(2.1 * t))

    return case(
        fx.profiles.Custom(lambda y: 0.02 * jnp.exp(jnp.sin(2 * jnp.pi * y)), points=256),
        fx.bristles.Custom(
            lambda eta: 0.3 * eta + eta**2, lambda eta: jnp.exp(eta) - 0.4 * eta**2
        ),
        fx.supports.Convex(lambda z: 0.5 * z**2 + jnp.log(jnp.cosh(z))),
        fx.loads.Custom(
            lambda t: 0.8 * (1 - jnp.cos(2.1 * t)), [math.pi / 2.1, 2 * math.pi / 2.1]
        ),
        0.75,
        0.0,
        w=lambda y: (
            0.02 * math.exp(math.sin(ref.TWO_PI * y)),
            0.02
            * ref.TWO_PI
            * math.cos(ref.TWO_PI * y)
            * math.exp(math.sin(ref.TWO_PI * y)),
        ),
        bristle=lambda e: (0.3 * e + e**2, 0.3 + 2 * e, math.exp(e) - 0.8 * e),
        force=lambda z: z + math.tanh(z),
        load=load,
        rate=1.7,
        stiffness=1.5,
    )


def spline_vertical() -> Case:
    heights = 0.02 * np.array([0.0, 0.7, 1.0, 0.4, -0.1, -0.8, -0.9, -0.5])
    curve = CubicSpline(
        np.arange(9) / 8, np.append(heights, heights[0]), bc_type="periodic"
    )
    slope = curve.derivative()
    return case(
        fx.profiles.Spline(heights),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.Sine(0.8, 3.0),
        1.0,
        0.0,
        w=lambda y: (float(curve(y % 1.0)), float(slope(y % 1.0))),
        bristle=vertical(1.0, 2.0, 1.0),
        force=lambda z: z,
        load=sine_load(0.8, 3.0),
        rate=1.7,
    )


def given_potential() -> Case:
    two_pi = 2 * jnp.pi
    wiggle = fx.GivenPotential(
        lambda Y: 0.1 / two_pi * jnp.sin(two_pi * Y),
        lambda eps, Y: 0.3 * jnp.cos(two_pi * Y) / two_pi,
    )
    scene = fx.Scene(
        potential=wiggle,
        support=fx.supports.Spring(1.0),
        load=fx.loads.Ramp(0.5),
        duration=3.0,
    )

    def w(y):  # V' = W' + eps Q' as the slope, F' = 1
        a = ref.TWO_PI * y
        return 0.0, 0.1 * math.cos(a) - EPS * 0.3 * math.sin(a)

    system = ref.System(
        w=w,
        bristle=lambda eta: (0.0, 0.0, 1.0),
        force=lambda z: z,
        load=lambda t: 0.5 * t,
        duration=3.0,
        rate=0.5,
    )
    return Case(scene, system, 1.0, 0.0)


CASES = [
    vertical_sine,
    pytest.param(homothetic_ramp_far_below, marks=pytest.mark.slow),
    given_potential,
]
_MORE = [
    angular_convex_triangle,
    stretched_vertical_triangle,
    slanted_fourier_far_above,
    slanted_back_alpha_negative_plateau,
    custom_everything,
    spline_vertical,
]
# Each compiles its own program, for 10 to 30 s.
CASES += [pytest.param(make, marks=pytest.mark.slow) for make in _MORE]


@pytest.mark.parametrize("make", CASES, ids=lambda make: make.__name__)
def test_accuracy_is_met(make):
    one = make()
    expected = ref.solve(one.system, EPS, one.gamma, one.z0, TIMES)
    outside = ~expected.in_slip
    assert outside.sum() >= 40  # or the comparison shows nothing
    for accuracy in (1e-2, 1e-3, 1e-4):
        found = fx.solve(one.scene, EPS, one.gamma, TIMES, accuracy=accuracy)
        assert found.ok, found.status.message
        error = np.abs(np.asarray(found.z) - expected.z)[outside] / EPS
        assert error.max() < accuracy
        lost = np.abs(np.asarray(found.dissipation) - expected.dissipation)
        assert lost[outside].max() < accuracy * expected.dissipation[-1]
        assert found.stats["dissipation_gap"] < accuracy * expected.dissipation[-1]


@pytest.mark.parametrize("eps", [1e-2, pytest.param(1e-3, marks=pytest.mark.slow)])
def test_benchmark_scene(eps):
    one = vertical_sine()
    scene = fx.Scene(
        one.scene.profile, one.scene.bristle, one.scene.support, one.scene.load, 3.0
    )
    expected = ref.solve(one.system, eps, 1.0, 0.0, TIMES)
    outside = ~expected.in_slip
    assert outside.sum() >= 50
    for accuracy in (1e-2, 1e-3, 1e-4):
        found = fx.solve(scene, eps, 1.0, TIMES, accuracy=accuracy)
        error = np.abs(np.asarray(found.z) - expected.z)[outside] / eps
        assert error.max() < accuracy
        assert found.ok


def test_sparse_times_give_the_same_values():
    """Values do not depend on which other times are asked for."""
    one = vertical_sine()
    full = fx.solve(one.scene, EPS, 1.0, TIMES, accuracy=1e-6)
    few = fx.solve(one.scene, EPS, 1.0, TIMES[[13, 40]], accuracy=1e-6)
    assert np.abs(few.z - full.z[jnp.array([13, 40])]).max() < 2e-6 * EPS
