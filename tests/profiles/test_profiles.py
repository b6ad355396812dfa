"""Profiles: values, period, smoothness, and the check that a function is one."""

from collections.abc import Callable

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from at_places import with_derivatives
from samples import PROFILES, exponential, profile
from scipy.interpolate import CubicSpline

import frictionjax as fx

Y = np.linspace(-1, 1, 257)[:-1] + 1e-3
TAU = 2 * np.pi


@eqx.filter_jit
def heights(surface, y):
    return surface(y)


@pytest.mark.parametrize("kind", PROFILES)
def test_period_one_and_no_digits_lost_far_away(kind):
    surface = profile(kind, np.random.default_rng(3))
    y = np.round(np.asarray(Y) * 2**20) / 2**20  # so that y + 1e8 is exact
    here = heights(surface, y)
    for away in (1.0, -3.0, 1e8):
        np.testing.assert_allclose(heights(surface, y + away), here, atol=1e-15)
    for shape in ((3, 2), ()):
        assert jax.eval_shape(surface, jnp.zeros(shape)).shape == shape


@pytest.mark.parametrize("kind", PROFILES)
def test_twice_differentiable_across_the_seam(kind):
    surface = profile(kind, np.random.default_rng(3))
    for below, at, above in with_derivatives(surface, np.array([-1e-9, 0.0, 1e-9])):
        assert abs(above - at) < 1e-6
        assert abs(below - at) < 1e-6


def test_closed_forms():
    np.testing.assert_allclose(
        heights(fx.profiles.Sine(0.3), Y), 0.3 / TAU * np.sin(TAU * Y), atol=1e-16
    )
    series = fx.profiles.Fourier([0.1, 0.0, 0.02], [0.0, -0.03, 0.01])
    expected = (
        0.1 * np.cos(TAU * Y)
        - 0.03 * np.sin(2 * TAU * Y)
        + 0.02 * np.cos(3 * TAU * Y)
        + 0.01 * np.sin(3 * TAU * Y)
    )
    np.testing.assert_allclose(heights(series, Y), expected, atol=1e-15)


@pytest.mark.parametrize("count", [4, 5, 12])
def test_spline_is_the_periodic_interpolant(count):
    heights = np.random.default_rng(count).normal(size=count)
    surface = fx.profiles.Spline(heights)
    knots = np.arange(count + 1) / count
    peer = CubicSpline(knots, np.append(heights, heights[0]), bc_type="periodic")
    np.testing.assert_allclose(surface.heights, heights, atol=1e-14)
    for order, found in enumerate(with_derivatives(surface, Y)):
        size = np.max(np.abs(found))
        np.testing.assert_allclose(found, peer(Y % 1, order), atol=1e-12 * size)


def bent(y, order):
    """Zero for y < 0.3137, then a power: derivative `order` jumps there by 1."""
    s = y - 0.3137
    power = jnp.where(s > 0, s**order, 0.0) / max(order, 1)
    return 0.2 * jnp.sin(TAU * y) + power * (1 - y) ** 3


JUMPS = {
    "w jumps at the seam": (lambda y: y, "w jumps by 1 at the seam"),
    "w' jumps at the seam": (lambda y: y * (1 - y), "w' jumps by 2 at the seam"),
    "w'' jumps at the seam": (lambda y: y**2 * (1 - y) ** 3, "w'' jumps by 2 at the seam"),
    "w jumps inside": (lambda y: jnp.floor(y + 0.5) * (1 - y) ** 3 + y**3, "w jumps"),
    "w' jumps inside": (lambda y: bent(y, 1), "w' jumps by .* near y = 0.313"),
    "w'' jumps inside": (lambda y: bent(y, 2), "w'' jumps by .* near y = 0.313"),
    "w'' jumps a little": (
        lambda y: jnp.sin(TAU * y) * (1 + 1e-4 * jnp.abs(jnp.sin(TAU * (y - 0.11)))),
        "w.* jumps",
    ),
    "constant": (lambda y: 0 * y + 1.0, "constant"),
    "not finite": (lambda y: jnp.log(y), "not finite"),
}


@pytest.mark.parametrize("case", JUMPS)
def test_what_is_not_periodic_and_smooth_is_named(case):
    fn, message = JUMPS[case]
    with pytest.raises(ValueError, match=f"profile.fn = .*{message}"):
        fx.profiles.Custom(fn)


class Mine(fx.profiles.AbstractProfile):
    """A surface of a class of one's own."""

    fn: Callable
    points: int = eqx.field(static=True, default=512)

    def __call__(self, y):
        return self.fn(y)


MINE = {
    "another period": (lambda y: jnp.sin(4 * y), "w jumps by .* at the seam"),
    "no period": (lambda y: y**3 * (1 - y) ** 3, r"w\(y\) and w\(y \+ 1\) are 7.94 apart"),
    "numpy": (np.sin, "written with jax.numpy"),
    "two numbers": (lambda y: (y, y), r"values of shape \(2,\)"),
}


@pytest.mark.parametrize("case", MINE)
def test_a_class_of_ones_own_is_checked(case):
    fn, message = MINE[case]
    with pytest.raises(ValueError, match=rf"profile: Mine\.__call__ = .*{message}"):
        Mine(fn)


def test_a_class_of_ones_own_that_keeps_the_rules_is_taken():
    assert Mine(lambda y: jnp.sin(TAU * y))(0.25) == 1.0
    with pytest.raises(ValueError, match=r"profile: Mine\.points = 4: needs .* >= 16"):
        Mine(lambda y: jnp.sin(TAU * y), 4)
    slopes = jax.vmap(lambda s: Mine(lambda y: s * jnp.sin(TAU * y))(0.25))
    assert slopes(jnp.array([1.0, 2.0])).tolist() == [1.0, 2.0]  # traced ones too


@pytest.mark.filterwarnings("ignore::frictionjax.profiles.SlopesUndetermined")
def test_no_false_alarm_on_smooth_functions():
    rng = np.random.default_rng(0)
    orders = np.arange(1, 65)
    for decay in (0, 1, 2):
        cos, sin = rng.normal(size=(2, 64)) / orders**decay
        fx.profiles.Custom(fx.profiles.Fourier(cos, sin))
    for count in (4, 7, 64):  # C^2 and no more
        fx.profiles.Custom(fx.profiles.Spline(rng.normal(size=count)))
    for tilt in (0.1, 10.0, 30.0):
        fx.profiles.Custom(lambda y, t=tilt: exponential(y, 1e-3, t))
    fx.profiles.Custom(lambda y: jnp.abs(jnp.sin(TAU * (y - 0.3137))) ** 3)
    fx.profiles.Custom(lambda y: 1e-12 * jnp.sin(TAU * y) + 1.0)
    fx.profiles.Custom(lambda y: 1e6 * jnp.cos(TAU * y))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: fx.profiles.Sine(0.0), "profile.slope = 0: needs slope != 0"),
        (lambda: fx.profiles.Sine(np.inf), "profile.slope = inf"),
        (lambda: fx.profiles.Sine("0.1"), "profile.slope = '0.1': needs a number"),
        (lambda: fx.profiles.Sine([0.1]), "profile.slope = .*one number"),
        (lambda: fx.profiles.Fourier([0.1], [0.1, 0.2]), r"profile.sin = .*shape \(1,\)"),
        (lambda: fx.profiles.Fourier([], []), "profile.cos = .*coefficients"),
        (lambda: fx.profiles.Fourier(0.1, 0.2), "profile.cos = 0.1"),
        (lambda: fx.profiles.Fourier([0.0], [0.0]), "profile.cos = .*!= 0"),
        (lambda: fx.profiles.Fourier([np.nan], [0.0]), "profile.cos = .*finite"),
        (lambda: fx.profiles.Fourier("ab", [0.0]), "profile.cos = 'ab'"),
        (lambda: fx.profiles.Fourier([[1.0], [1.0, 2.0]], [0.0]), "profile.cos = "),
        (lambda: fx.profiles.Spline([1, 2, 3]), "profile.heights = .*4 or more"),
        (lambda: fx.profiles.Spline(None), "profile.heights = None"),
        (lambda: fx.profiles.Spline([1, 1, 1, 1]), "profile.heights = .*vary"),
        (lambda: fx.profiles.Spline([1, 2, 1, np.nan]), "profile.heights = .*finite"),
        (lambda: fx.profiles.Custom(0.1), "profile.fn = 0.1: needs a function"),
        (lambda: fx.profiles.Custom(lambda y: jnp.stack([y, y])), r"shape \(2,\)"),
        (lambda: fx.profiles.Custom(jnp.sin, points=4), "profile.points = 4"),
        (lambda: fx.profiles.Custom(jnp.sin, points="all"), "profile.points = 'all'"),
        (lambda: fx.GivenPotential(jnp.sin), "potential.W = .*seam"),
        (lambda: fx.GivenPotential(jnp.sin, 3.0), "potential.Q = 3"),
    ],
)
def test_wrong_parameters_are_named(make, message):
    with pytest.raises(ValueError, match=message):
        make()
