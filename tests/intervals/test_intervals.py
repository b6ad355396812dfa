"""Bounds of functions over intervals: true, and close where stretches are short."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from at_places import at_places
from jax.scipy.special import erf, erfc

import frictionjax as fx
from frictionjax.intervals import NoRuleError, enclosure_of
from frictionjax.intervals.functions import ELEMENTARY
from frictionjax.intervals.jet import number, variable

TABLE = jnp.array([0.0, 1.0, 2.0, 5.0]), jnp.array([0.0, 1.0, 0.0, 3.0])
WEIGHTS = jnp.asarray(np.random.default_rng(0).normal(size=(4, 3)))
COUNT = jnp.arange(5)


def pieces(t):
    return jnp.piecewise(t, [t < 1, t < 2], [lambda t: t, lambda t: 2 - t, lambda t: 0 * t])


def loop(t):
    return jax.lax.fori_loop(0, 5, lambda i, x: jnp.sin(x + t), t)


FUNCTIONS = {
    "polynomial": lambda t: t**4 - 4 * t**3 + 6 * t**2 - 4 * t + 1,
    "horner": lambda t: jnp.polyval(jnp.array([1.0, -2.0, 0.5]), t),
    "powers": lambda t: t**1.5 + t**-2 + jnp.sqrt(1 + t) * jnp.cbrt(t) + jax.lax.rsqrt(t),
    "logarithms": lambda t: jnp.log(t) * jnp.log1p(t) + jnp.exp(-t) + jnp.expm1(t),
    "hyperbolic": lambda t: jnp.sinh(t / 3) + jnp.cosh(t) * jnp.tanh(t) + jnp.arcsinh(t),
    "circular": lambda t: jnp.tan(t / 3) + jnp.arctan(t) - jnp.arctan2(t, 1 + t),
    "errors": lambda t: erf(t - 2) + erfc(2 * t) + jax.nn.sigmoid(3 * t),
    "activations": lambda t: jax.nn.softplus(t - 2) + jax.nn.gelu(t) + jax.nn.relu(t - 1),
    "gaussians": lambda t: jnp.sum(jnp.exp(-(((t - TABLE[0]) / 0.1) ** 2))),
    "window": lambda t: jnp.where((t > 1) & (t < 2), jnp.sin(jnp.pi * (t - 1)) ** 2, 0.0),
    "mask": lambda t: (t > 1.0) * (t - 1.0) ** 2 + jnp.heaviside(t - 2, 0.5) * (t - 2),
    "sawtooth": lambda t: jnp.sin(jnp.mod(t, 0.7)) + t - jnp.floor(t) + jnp.round(t),
    "clipped": lambda t: jnp.clip(t, 1.0, 2.0) + jnp.abs(t - 1.5) + jnp.sign(t - 2) * t,
    "branches": lambda t: jax.lax.cond(t < 2, lambda t: t * t, lambda t: 4 + 0 * t, t),
    "cases": pieces,
    "loop": loop,
    "stacked": lambda t: jnp.max(jnp.stack([t, 2 - t])) + jnp.array([t, 2 * t])[1],
    "matrix": lambda t: jnp.sum(jnp.tanh(WEIGHTS @ (t * jnp.ones(3)))),
    "harmonics": lambda t: jnp.cos(2 * jnp.pi * COUNT * t) @ jnp.ones(5),
    "table": lambda t: jnp.interp(t, *TABLE),
    "own sine": fx.loads.Sine(1.0, 0.7),
    "own triangle": fx.loads.Triangle(1.0, 0.7),
    "own line": fx.loads.PiecewiseLinear([0.5, 1.0, 2.0], [1.0, 3.0, -1.0]),
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_bounds_hold_values_and_two_derivatives(name):
    fn = FUNCTIONS[name]
    rng = np.random.default_rng(1)
    lo = rng.uniform(0.01, 3.5, 60)
    hi = np.minimum(lo + 10 ** rng.uniform(-6, 0, 60), 4.0)
    bounds = enclosure_of(fn)
    whole = bounds(lo, hi)
    for share in rng.uniform(0.05, 0.95, 8):
        at = lo + share * (hi - lo)
        inside = bounds(at, at)
        for wide, narrow in zip(whole[:3], inside[:3], strict=True):
            slack = 1e-13 * (1 + np.abs(narrow.middle))
            decided = ~inside.seam
            assert np.all((wide.lo <= narrow.hi + slack)[decided])
            assert np.all((wide.hi >= narrow.lo - slack)[decided])
    values = at_places(fn, lo[:8])
    found = bounds(lo[:8], lo[:8])
    np.testing.assert_allclose(found.value.middle, values, rtol=1e-12, atol=1e-12)
    assert np.all(found.value.width <= 1e-11 * (1 + np.abs(values)))


def test_a_polynomial_that_is_one_step_is_bounded_as_its_products_are():
    """JAX writes `jnp.polyval` so from 0.12 on."""
    lo, hi = np.array([0.2, 1.0]), np.array([0.3, 2.5])
    terms = [number(np.asarray(term)) for term in (0.5, -2.0, 1.0)]
    found = ELEMENTARY["polynomial"](variable(lo, hi), *terms)
    for one, other in zip(
        found[:3], enclosure_of(FUNCTIONS["horner"])(lo, hi), strict=False
    ):
        np.testing.assert_allclose(one, other, rtol=1e-14, atol=1e-14)


@pytest.mark.parametrize("name", ["polynomial", "powers", "errors", "gaussians", "loop"])
def test_derivatives_are_those_of_differences(name):
    bounds, at, step = enclosure_of(FUNCTIONS[name]), np.linspace(0.3, 3.5, 40), 1e-4
    below, here, above = (bounds(t, t) for t in (at - step, at, at + step))
    slope = (above.value.middle - below.value.middle) / (2 * step)
    bend = (above.slope.middle - below.slope.middle) / (2 * step)
    np.testing.assert_allclose(here.slope.middle, slope, rtol=1e-4, atol=1e-4)
    np.testing.assert_allclose(here.bend.middle, bend, rtol=1e-4, atol=1e-4)


def test_bounds_close_with_the_square_of_the_length():
    bounds = enclosure_of(lambda t: t * jnp.sin(t) - jnp.exp(-t))
    lo = np.full(3, 1.3)
    wide = bounds(lo, lo + np.array([1e-2, 1e-3, 1e-4]))
    per_length = wide.slope.width / np.array([1e-2, 1e-3, 1e-4])
    assert np.all(per_length < 10)


def test_a_pulse_shows_in_bounds_of_all_that_holds_it():
    bounds = enclosure_of(lambda t: 0.02 * t + 4 * jnp.exp(-(((t - 31.7) / 1e-9) ** 2)))
    found = bounds(np.array([0.0, 31.0, 32.0]), np.array([60.0, 32.0, 33.0]))
    assert np.all(found.value.hi[:2] > 4)
    assert found.value.hi[2] < 0.67


@pytest.mark.parametrize(
    ("fn", "name"),
    [
        (lambda t: jax.lax.while_loop(lambda x: x < 5, lambda x: x + 1.3, t), "while"),
        (lambda t: t.astype(jnp.float32).astype(float), "32 bits"),
        (lambda t: jnp.sort(jnp.stack([t, 1 - t]))[0], "sort"),
    ],
)
def test_what_has_no_rule_is_named(fn, name):
    with pytest.raises(NoRuleError, match=name):
        enclosure_of(fn)
