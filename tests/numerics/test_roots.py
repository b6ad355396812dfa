"""Roots of increasing functions whose slope rises and falls within a short way."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.numerics.roots import find_root, increasing_root

KINDS = {
    # Newton goes back and forth between the flanks, inside any bracket.
    "a step": lambda z, at, wide, tall: z + tall * jnp.tanh((z - at) / wide),
    "a flat stretch": lambda z, at, wide, tall: (
        z - at - tall * wide * jnp.tanh((z - at) / wide) / (1 + tall)
    ),
    "a corner": lambda z, at, wide, tall: (
        z + (1 + 1e3 * tall) * wide * jnp.logaddexp(0.0, (z - at) / wide)
    ),
}


def _far(count):
    return np.full(count, -50.0), np.full(count, 50.0)


@pytest.mark.parametrize("kind", KINDS)
def test_roots_are_where_the_sign_changes(kind):
    fn = KINDS[kind]
    rng = np.random.default_rng(0)
    at, wanted = rng.uniform(-2, 2, (2, 4000))
    wide, tall = 10 ** rng.uniform([[-4], [-3]], [[0], [1]], (2, 4000))

    @jax.jit
    @jax.vmap
    def found(at, wide, tall, wanted):
        root = increasing_root(lambda z: fn(z, at, wide, tall) - wanted, jnp.zeros(()))
        near = 4e-15 * jnp.array([-1.0, 1.0]) * (10 + jnp.abs(root))
        return root, fn(root + near, at, wide, tall) - wanted

    numbers = map(jnp.asarray, (at, wide, tall, wanted))
    root, around = map(np.asarray, found(*numbers))
    below, above = around.T
    assert np.all(np.isfinite(root))
    assert np.all(below <= 0)
    assert np.all(above >= 0)


@jax.jit
def around_the_root(at, tall, wide, wanted):
    """Values right below and above the root of a step."""

    def fn(z):
        return z + tall * jnp.tanh((z - at) / wide) - wanted

    root = find_root(fn, *_far(4000))
    near = 4e-15 * (10 + jnp.abs(root))
    return fn(root - near), fn(root + near)


@pytest.mark.parametrize("wide", [1e-4, 1e-7, 1e-9])
@pytest.mark.parametrize("inside", [False, True])
def test_steps_far_narrower_than_the_bracket(wide, inside):
    """Newton's steps are small there and do not shrink, as from rounding of `f`."""
    rng = np.random.default_rng(1)
    at, wanted = rng.uniform(-2, 2, (2, 4000))
    tall = 10 ** rng.uniform(-3, 1, 4000)
    if inside:
        wanted = at + 0.9 * tall * np.tanh(rng.uniform(-2, 2, 4000))

    below, above = map(np.asarray, around_the_root(at, tall, wide, wanted))
    assert np.all(below <= 0)
    assert np.all(above >= 0)


@pytest.mark.parametrize("power", [3, 9])
def test_multiple_roots(power):
    at = np.linspace(-2, 2, 1000)
    root = find_root(lambda z: jnp.sign(z - at) * jnp.abs(z - at) ** power, *_far(1000))
    np.testing.assert_allclose(root, at, atol=1e-12)


@pytest.mark.slow  # programs for this support
def test_a_support_with_a_bump_in_its_stiffness():
    """Rest positions, and so the limit, were 0.1 m off where Phi'' rises from 1 to 6."""

    def energy(z):
        return 0.5 * z**2 + 0.002 * jnp.logaddexp((z - 1.23) / 0.02, (1.23 - z) / 0.02)

    support = fx.supports.Convex(energy)
    forces = jnp.linspace(1.05, 1.4, 36)
    states = jax.jit(jax.vmap(support.state_of))(forces)
    there = jax.jit(jax.vmap(support.force))(states)
    np.testing.assert_allclose(there, forces, rtol=1e-14)
    scene = fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        support,
        fx.loads.Ramp(1.0, 0.0),
        duration=3.0,
    )
    limit = fx.solve_limit(scene, jnp.array([1.35]))
    low, high = 1.2, 1.3
    for _ in range(60):
        middle = 0.5 * (low + high)
        held = middle + 0.1 * np.tanh((middle - 1.23) / 0.02) < 1.35 - 0.1
        low, high = (middle, high) if held else (low, middle)
    np.testing.assert_allclose(limit.z, [low], rtol=1e-14)
