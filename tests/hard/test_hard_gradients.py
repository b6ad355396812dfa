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
# Energies of 1e7 J, of which 2e-7 J are dissipated: rounding hides its differences.
_STATES_ALONE = HARD["far from the origin"]
_EVERY = [
    name for name in HARD if name in FEW_WELLS or HARD[name].truth.__name__ == "plain"
] + ["rod lying flat", "rod upright"]


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
    """Numbers of the scene, times outside slips, and weights of order 1.

    Not where the load turns: states there have a derivative by that time on either side.
    """
    parts = one.build(), jnp.asarray(one.eps), jnp.asarray(one.gamma)
    numbers, static = eqx.partition(parts, eqx.is_inexact_array_like)
    numbers = jax.tree_util.tree_map(jnp.asarray, numbers)
    turns = np.asarray(one.build().turning_points())
    away = np.abs(one.ts[:, None] - turns[np.isfinite(turns)]).min(axis=1)
    rest = np.flatnonzero(~expected.in_slip & (away > 1e-6 * one.ts[-1]))[1:]
    picked = rest[np.linspace(0, rest.size - 1, 8).astype(int)]
    energy = 0.0 if one is _STATES_ALONE else 1 / expected.dissipation[-1]
    weights = np.append(np.cos(np.arange(8)) / one.eps, energy)
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
    # Energies of 2 kJ, of which 0.2 J are dissipated: differences need a wider way.
    check(HARD[name], 1e-4 if name == "no folds" else 1e-5)


@pytest.mark.slow
def test_derivatives_through_three_thousand_slips():
    check(HARD["3000 slips"], 3e-7)
