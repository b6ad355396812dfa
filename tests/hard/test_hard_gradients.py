"""Derivatives of hard scenes, and through thousands of slips: finite, and right."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from asked import named
from catalogue import HARD
from few_wells import FEW_WELLS

import frictionjax as fx

_QUICK = ("two folds", "alpha < 0", "far above", "slow part", "on a summit")
_EVERY = [
    name for name in HARD if name in FEW_WELLS or HARD[name].truth.__name__ == "plain"
]


@eqx.filter_jit
def weighed(numbers, static, ts, weights):
    """One number of a trajectory: states at times and the energy dissipated, weighed."""
    scene, eps, gamma = eqx.combine(numbers, static)
    found = fx.solve(scene, eps, gamma, ts, accuracy=1e-9, max_steps=2**22)
    return jnp.sum(weights[:-1] * found.z) + weights[-1] * found.dissipation[-1]


@eqx.filter_jit
def value_and_gradient(numbers, static, *asked):
    return jax.value_and_grad(lambda n: weighed(n, static, *asked))(numbers)


def question(one, expected):
    """Numbers of the scene, times outside slips, and weights of order 1."""
    parts = one.build(), jnp.asarray(one.eps), jnp.asarray(one.gamma)
    numbers, static = eqx.partition(parts, eqx.is_inexact_array_like)
    numbers = jax.tree_util.tree_map(jnp.asarray, numbers)
    rest = np.flatnonzero(~expected.in_slip)[1:]
    picked = rest[np.linspace(0, rest.size - 1, 8).astype(int)]
    weights = np.append(np.cos(np.arange(8)) / one.eps, 1 / expected.dissipation[-1])
    return numbers, static, jnp.asarray(one.ts[picked]), jnp.asarray(weights)


def rates_of(numbers, width, seed):
    """A random direction: every number by up to itself.

    Lengths of a spring by up to what it is pressed by: alpha is the difference of two, and
    a share of either may be many times it. `width` of them is a multiple of their rounding.
    """
    leaves, tree = jax.tree_util.tree_flatten(numbers)
    factors = np.random.default_rng(seed).uniform(-1, 1, len(leaves))
    rates = tree.unflatten([v * f for v, f in zip(leaves, factors, strict=True)])
    spring = numbers[0].potential.bristle
    if not isinstance(spring, fx.bristles.VerticalSpring):
        return rates
    pressed = float(spring.rest_length - spring.height)
    grain = 2 * np.spacing(float(spring.rest_length))
    steps = np.random.default_rng(seed + 1).uniform(-1, 1, 2) * pressed * width / grain
    exact = [jnp.asarray(v) for v in np.round(steps) * grain / width]

    def lengths(tree):
        bristle = tree[0].potential.bristle
        return bristle.rest_length, bristle.height

    return eqx.tree_at(lengths, rates, tuple(exact))


def check(one, width, seed=0):
    """Along a random direction in all numbers, against differences of order 4."""
    expected = one.truth(one, one.ts)
    numbers, *rest = question(one, expected)
    value, gradient = value_and_gradient(numbers, *rest)
    slopes = jax.tree_util.tree_leaves(gradient)
    assert np.isfinite(value)
    assert all(bool(jnp.all(jnp.isfinite(slope))) for slope in slopes)
    rates = rates_of(numbers, width, seed)
    pairs = zip(slopes, jax.tree_util.tree_leaves(rates), strict=True)
    terms = [float(jnp.vdot(slope, rate)) for slope, rate in pairs]

    def moved(share):
        return jax.tree_util.tree_map(lambda v, r: v + share * r, numbers, rates)

    ends = [float(weighed(moved(s * width), *rest)) for s in (-2, -1, 1, 2)]
    central = (8 * (ends[2] - ends[1]) - (ends[3] - ends[0])) / (12 * width)
    assert abs(sum(terms) - central) < 1e-5 * max(abs(central), *map(abs, terms))


@pytest.mark.slow
@pytest.mark.parametrize("name", named(_EVERY, slow=[n for n in HARD if n not in _QUICK]))
def test_derivatives_by_every_number_are_central_differences(name):
    check(HARD[name], 1e-5)


@pytest.mark.slow
def test_derivatives_through_three_thousand_slips():
    check(HARD["3000 slips"], 3e-7)
