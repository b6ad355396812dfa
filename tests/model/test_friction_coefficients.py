"""Friction coefficients: brute force, closed forms, gradients, batches."""

import functools

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from samples import FEW_BRISTLES, PROFILES, central, pair

import frictionjax as fx

SINE = fx.profiles.Sine(0.3)
WAVES = fx.profiles.Fourier(cos=[0.01, 0.004, 0.0], sin=[0.02, 0.0, -0.003])


def brute_slope_extrema(W):
    """Largest and smallest `W'` by differences alone: a scan, then two finer ones."""
    grid = np.arange(2048) / 2048
    slopes = np.asarray(central(W, grid, 1e-3))
    found = []
    for pick in (np.argmax, np.argmin):
        centre, width, values = grid[pick(slopes)], 1 / 2048, slopes
        for _ in range(2):
            near = centre + width * np.linspace(-1, 1, 2048)
            values = np.asarray(central(W, near, 1e-3))
            centre, width = near[pick(values)], width / 64
        found.append(values[pick(values)])
    return found


@pytest.mark.parametrize("bristle_kind", FEW_BRISTLES)
@pytest.mark.parametrize("profile_kind", PROFILES)
def test_rho_is_the_extreme_slope_of_W(profile_kind, bristle_kind):
    for sign, seed in ((1, 1), (-1, 2)):
        surface, bristle = pair(profile_kind, bristle_kind, sign, seed)
        found = fx.friction(surface, bristle)
        highest, lowest = brute_slope_extrema(fx.potential(surface, bristle).W)
        assert abs(found.rho_plus / highest - 1) < 1e-9
        assert abs(found.rho_minus / lowest - 1) < 1e-9


def _stack(pairs):
    return jax.tree_util.tree_map(lambda *leaves: jnp.stack(leaves), *pairs)


@eqx.filter_jit
def slopes_of(surface, places):
    return jax.vmap(jax.grad(surface))(places)


def _gentle(surface):
    """The same shape with slopes of at most 0.5, which every bristle here can follow."""
    steepest = np.max(np.abs(slopes_of(surface, np.linspace(0, 1, 2048))))
    return fx.profiles.Fourier(surface.cos / steepest / 2, surface.sin / steepest / 2)


def test_a_batch_equals_its_lanes_and_brute_force():
    pairs = [pair("fourier", "angular", 1, seed) for seed in range(100, 132)]
    pairs = [(_gentle(surface), bristle) for surface, bristle in pairs]
    lanes = [fx.friction(*one) for one in pairs]
    batch = eqx.filter_vmap(lambda one: fx.friction(*one))(_stack(pairs))
    for name in ("rho_plus", "rho_minus", "mu_plus", "omega_minus", "alpha", "a"):
        alone = np.array([getattr(lane, name) for lane in lanes])
        np.testing.assert_allclose(getattr(batch, name), alone, rtol=1e-13)
    for one, lane in zip(pairs[:8], lanes, strict=False):
        highest, lowest = brute_slope_extrema(fx.potential(*one).W)
        np.testing.assert_allclose(
            (lane.rho_plus, lane.rho_minus), (highest, lowest), rtol=1e-9
        )


def test_two_bumps_that_tie_within_the_scan():
    # The higher bump falls between two samples, the lower one, 1e-4 less, on a sample.
    n, shift, share = np.arange(1, 17), 0.5 / (64 * 16), 1 - 1e-4
    sin = (np.cos(2 * np.pi * n * shift) + share * (-1.0) ** n) / (2 * np.pi * n)
    cos = -np.sin(2 * np.pi * n * shift) / (2 * np.pi * n)
    near = 2 * np.pi * np.outer(shift + np.linspace(-1e-4, 1e-4, 20001), n)
    highest = np.max(
        np.cos(near) @ (2 * np.pi * n * sin) - np.sin(near) @ (2 * np.pi * n * cos)
    )
    found = fx.friction(fx.profiles.Fourier(cos, sin), fx.bristles.Homothetic(1.0))
    assert abs(found.omega_plus / highest - 1) < 1e-12


@pytest.mark.parametrize("sign", [1, -1])
def test_closed_forms_of_the_three_models(sign):
    k, h, theta = 1.7, 0.8, 0.4
    rest = h * (1 + 0.2 * sign)
    vertical = fx.friction(SINE, fx.bristles.VerticalSpring(k, rest, h))
    check_closed_form(vertical, k * (rest - h), 0.0)
    long = h / np.cos(theta) * (1 + 0.2 * sign)
    slanted = fx.friction(SINE, fx.bristles.SlantedSpring(k, long, h, theta))
    alpha = k / np.cos(theta) * (long - h / np.cos(theta))
    check_closed_form(slanted, alpha, -np.tan(theta))
    length, rest_angle = 1.1, 0.1
    limit = np.arccos(h / length)
    angular = fx.friction(SINE, fx.bristles.AngularSpring(k, length, h, rest_angle))
    alpha = k / np.sqrt(length**2 - h**2) * (limit - rest_angle)
    check_closed_form(angular, alpha, 1 / np.tan(limit))
    assert angular.rho_plus < -angular.rho_minus  # Section 3.4 prints the other sign
    assert slanted.mu_plus > -slanted.mu_minus


def check_closed_form(found, alpha, a):
    """Lemma 3 and the two cases of Lemma 2 for slopes of 0.3."""
    mu_plus, mu_minus = 0.3 / (1 + 0.3 * a), -0.3 / (1 - 0.3 * a)
    pair = (alpha * mu_plus, alpha * mu_minus)
    expected = (0.3, -0.3, a, alpha, mu_plus, mu_minus, max(pair), min(pair))
    names = ("omega_plus", "omega_minus", "a", "alpha", "mu_plus", "mu_minus")
    names = (*names, "rho_plus", "rho_minus")
    values = [getattr(found, name) for name in names]
    np.testing.assert_allclose(values, expected, rtol=2e-14, atol=1e-15)


def test_a_slanted_spring_upright_is_a_vertical_one():
    upright = fx.friction(WAVES, fx.bristles.SlantedSpring(2.0, 1.3, 1.0, 0.0))
    vertical = fx.friction(WAVES, fx.bristles.VerticalSpring(2.0, 1.3, 1.0))
    for name, value in vars(vertical).items():
        if value is not None:
            np.testing.assert_allclose(
                getattr(upright, name), value, rtol=1e-14, err_msg=name
            )


def build_spline(p):
    return fx.profiles.Spline(p[:5]), fx.bristles.Homothetic(p[5])


def build_slanted(p):
    surface = fx.profiles.Fourier(cos=p[:2], sin=p[2:4])
    return surface, fx.bristles.SlantedSpring(p[4], p[5], p[6], p[7])


def build_angular(p):
    return fx.profiles.Fourier(p[:2], p[2:4]), fx.bristles.AngularSpring(*p[4:])


def build_vertical(p):
    return fx.profiles.Sine(p[0]), fx.bristles.VerticalSpring(p[1], p[2], p[3])


SLANTED = (build_slanted, [0.02, 0.01, 0.03, -0.01, 1.5, 1.4, 1.0, 0.3])
ANGULAR = (build_angular, [0.02, 0.01, 0.03, -0.01, 1.5, 1.6, 1.0, 0.2])
SPLINE = (build_spline, [0.0, 0.03, -0.02, 0.01, 0.04, -1.5])
VERTICAL = (build_vertical, [0.2, 1.5, 0.8, 1.0])


@pytest.mark.parametrize(
    ("build", "numbers"),
    [
        *(pytest.param(*p, marks=pytest.mark.slow) for p in (SLANTED, ANGULAR, SPLINE)),
        VERTICAL,
    ],
)
def test_gradients_in_every_parameter_of_every_part(build, numbers):
    def rho(p):
        found = fx.friction(*build(p))
        return jnp.stack([found.rho_plus, found.rho_minus])

    def known(p):
        """Values and derivatives in one program; second ones of the spline take 5 s to
        compile and show nothing new."""
        first = jax.jacrev(rho)
        bent = None if build is build_spline else jax.jacfwd(first)(p)
        return rho(p), first(p), bent

    p, found = np.asarray(numbers), jax.jit(known)
    _, first, second = found(p)

    def differences(order):
        along = np.eye(p.size)
        return np.stack(
            [central(lambda s, e=e: found(p + s * e)[order], 0.0, 1e-4) for e in along], -1
        )

    np.testing.assert_allclose(first, differences(0), rtol=1e-6, atol=1e-9)
    if second is not None:
        np.testing.assert_allclose(second, differences(1), rtol=1e-6, atol=1e-8)


def test_gradient_of_a_sine_in_closed_form():
    slope, k, rest, h = VERTICAL[1]
    numbers = jnp.asarray(VERTICAL[1])
    found = jax.grad(lambda p: fx.friction(*build_vertical(p)).rho_plus)(numbers)
    # alpha < 0: rho_plus = alpha mu_minus = k (h - rest) slope
    expected = [k * (h - rest), (h - rest) * slope, -k * slope, k * slope]
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_gradient_of_a_whole_scene():
    scene = fx.Scene(
        WAVES,
        fx.bristles.Homothetic(2.0),
        fx.supports.Spring(1.0),
        fx.loads.Ramp(1.0),
        duration=1.0,
    )
    slopes = eqx.filter_grad(lambda s: fx.friction(s).rho_plus)(scene)
    place = np.linspace(0, 1, 100_001)
    w = slopes_of(WAVES, place)
    top = place[np.argmax(w)]
    orders = 2 * np.pi * np.arange(1, 4)
    np.testing.assert_allclose(
        slopes.profile.sin, 2 * orders * np.cos(orders * top), atol=1e-2
    )
    np.testing.assert_allclose(slopes.bristle.alpha, np.max(w), rtol=1e-8)


def sine(y, size):
    return size * jnp.sin(2 * jnp.pi * y)


class Shape:
    def __init__(self, size):
        self.size = size

    def height(self, y):
        return sine(y, self.size)


@pytest.mark.parametrize(
    "with_size",
    [
        lambda size: lambda y: sine(y, size),
        lambda size: lambda y, size=size: sine(y, size),
        lambda size: lambda y, *, size=size: sine(y, size),
        lambda size: functools.partial(sine, size=size),
        lambda size: Shape(size).height,
    ],
    ids=["closed over", "a default", "a default by name", "partial", "of a method's own"],
)
def test_gradients_by_numbers_that_a_function_holds(with_size):
    def rho(size):
        surface = fx.profiles.Custom(with_size(size), points=64)
        return fx.friction(surface, fx.bristles.Homothetic(1.0)).rho_plus

    assert jax.grad(rho)(0.1) == pytest.approx(2 * np.pi, rel=1e-12)


def test_wrong_arguments_are_named():
    with pytest.raises(ValueError, match=r"friction\(...\) = 'Sine'"):
        fx.friction(SINE)
    with pytest.raises(ValueError, match="profile = 'Spring'"):
        fx.friction(fx.supports.Spring(1.0), fx.bristles.Homothetic(1.0))
    with pytest.raises(ValueError, match="bristle = 'Sine'"):
        fx.friction(SINE, SINE)
