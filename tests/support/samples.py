"""Random admissible surfaces and bristles, and a derivative that knows no autodiff."""

from collections.abc import Callable

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx

BRISTLES = ("homothetic", "vertical", "slanted", "angular", "custom")
# Where each compiles a program, the one that has everything.
FEW_BRISTLES = (
    "angular",
    *(pytest.param(kind, marks=pytest.mark.slow) for kind in BRISTLES if kind != "angular"),
)
PROFILES = ("sine", "fourier", "spline", "custom")


def profile(kind, rng, size=0.2):
    """A profile with slopes of about `size`, not symmetric except the sine."""
    if kind == "sine":
        return fx.profiles.Sine(size * rng.uniform(0.5, 1.5))
    if kind == "fourier":
        orders = np.arange(1, 6)
        cos, sin = size * rng.normal(size=(2, 5)) / (2 * np.pi * orders**2)
        return fx.profiles.Fourier(cos, sin)
    if kind == "spline":
        return fx.profiles.Spline(size / 20 * rng.normal(size=6))
    tilt, shift = rng.uniform(0.2, 0.8), rng.uniform()
    numbers = jnp.asarray([shift, size / 6, tilt])
    return fx.profiles.Custom(Formula(_shifted, numbers), points=512)


class Formula(eqx.Module):
    """A function with its numbers as leaves: other numbers compile nothing new."""

    fn: Callable = eqx.field(static=True)
    numbers: jax.Array

    def __call__(self, x):
        return self.fn(x, *self.numbers)


def _shifted(y, shift, size, tilt):
    return exponential(y + shift, size, tilt)


def _leaning(eta, lean, bend):
    return lean * jnp.sin(eta) + bend * eta**2


def _pressing(eta, alpha):
    return 3.0 + alpha * jnp.sinh(eta) + 0.3 * eta**2


def exponential(y, size, tilt):
    """All harmonics at once: not a trigonometric polynomial."""
    phase = 2 * jnp.pi * y
    return size * jnp.exp(tilt * jnp.sin(phase)) * jnp.cos(phase)


def bristle(kind, rng, sign):
    """A bristle with `alpha` of the given sign, where its model allows both."""
    stiffness = rng.uniform(0.5, 2.0)
    if kind == "homothetic":
        return fx.bristles.Homothetic(sign * stiffness)
    if kind == "vertical":
        return fx.bristles.VerticalSpring(stiffness, 1 + sign * rng.uniform(0.1, 0.6), 1.0)
    if kind == "slanted":
        angle = rng.uniform(-0.8, 0.8)
        rest = (1 + sign * rng.uniform(0.1, 0.5)) / np.cos(angle)
        return fx.bristles.SlantedSpring(stiffness, rest, 1.0, angle)
    if kind == "angular":  # theta_rest < theta_lim makes alpha positive
        limit = rng.uniform(0.8, 1.0)
        rest = limit - rng.uniform(0.2, 1.2)
        return fx.bristles.AngularSpring(stiffness, 1 / np.cos(limit), 1.0, rest)
    lean, bend, alpha = rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5), sign * stiffness
    return fx.bristles.Custom(
        Formula(_leaning, jnp.asarray([lean, bend])),
        Formula(_pressing, jnp.asarray([alpha])),
    )


def pair(profile_kind, bristle_kind, sign, seed):
    """Surface and bristle; the seed is the name of the draw."""
    rng = np.random.default_rng(seed)
    return profile(profile_kind, rng), bristle(bristle_kind, rng, sign)


def central(fn, x, step):
    """`fn'(x)` by central differences of order 10, by NumPy."""
    weights = (5 / 6, -5 / 21, 5 / 84, -5 / 504, 1 / 1260)

    def at(place):
        return np.asarray(fn(place))

    terms = [
        c * (at(x + k * step) - at(x - k * step)) for k, c in enumerate(weights, start=1)
    ]
    return sum(terms) / step


def swinging_scene(slope):
    """A vertical spring on a sine, drawn to and fro once in 3 s."""
    return fx.Scene(
        fx.profiles.Sine(slope),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        fx.loads.Sine(1.0488, 3.0),
        duration=3.0,
    )
