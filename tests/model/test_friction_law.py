"""The friction law and its dual: R, K, M."""

from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from samples import FEW_BRISTLES, central, pair

import frictionjax as fx
from frictionjax.model.friction_law import (
    dissipation_potential,
    dual_dissipation,
    limit_dissipation,
)

K = eqx.filter_jit(
    lambda potential, xi: jax.vmap(lambda x: dual_dissipation(potential, x))(xi)
)
M_OF_SLIDES = eqx.filter_jit(jax.vmap(limit_dissipation, in_axes=(None, None, 0, 0)))
MID = (np.arange(1 << 15) + 0.5) / (1 << 15)


def test_R_is_positively_homogeneous():
    v = jnp.asarray([-2.0, -1.0, 0.0, 1.0, 3.0])
    found = dissipation_potential(0.3, -0.2, v)
    np.testing.assert_allclose(found, [0.4, 0.2, 0.0, 0.3, 0.9], rtol=1e-15)


@pytest.mark.parametrize(
    "kind",
    [
        "slanted",
        "given",
        *(pytest.param(k, marks=pytest.mark.slow) for k in ("angular", "vertical")),
    ],
)
def test_K_against_brute_quadrature(kind):
    if kind == "given":
        potential = fx.GivenPotential(
            lambda Y: jnp.sin(2 * jnp.pi * Y) + 0.3 * jnp.cos(6 * jnp.pi * Y), points=512
        )
        plus, minus = 8.0, -8.0
    else:
        parts = pair("fourier", kind, 1, 3)
        potential, found = fx.potential(*parts), fx.friction(*parts)
        plus, minus = found.rho_plus, found.rho_minus
    slopes = np.asarray(central(potential.W, MID, 1e-3))
    share = np.linspace(-0.3, 1.3, 33)
    xi = jnp.asarray(minus + (plus - minus) * share)
    brute = [np.mean(np.abs(x - slopes)) for x in xi]
    found = K(potential, xi)
    size = np.max(np.abs(slopes))
    np.testing.assert_allclose(found, brute, atol=3e-8 * size)  # of the midpoint rule


@pytest.mark.parametrize("kind", FEW_BRISTLES)
def test_K_is_above_its_argument_inside_only(kind):
    for surface in ("sine", "fourier"):
        parts = pair(surface, kind, 1, 8)
        found = fx.friction(*parts)
        plus, minus = float(found.rho_plus), float(found.rho_minus)
        width = plus - minus
        share = jnp.asarray([1e-3, 0.1, 0.5, 0.9, 0.999])
        inside = minus + width * share
        outside = jnp.asarray([minus, plus, 3 * minus, plus + 0.2 * width, 2 * plus])
        values = K(fx.potential(*parts), jnp.concatenate([inside, outside]))
        assert np.all(values[:5] > jnp.abs(inside) * (1 + 1e-9))
        np.testing.assert_allclose(values[5:], jnp.abs(outside), rtol=4e-14)


def test_K_of_a_sine_in_closed_form():
    rho = 0.37
    potential = fx.potential(fx.profiles.Sine(0.2), fx.bristles.Homothetic(rho / 0.2))
    # The last ones leave a piece above xi that is narrower than a cell of the grid.
    xi = rho * jnp.asarray([0.0, 0.3, -0.7, 0.99, 1 - 1e-5, -1 + 1e-6, 1.0])
    share = np.clip(xi / rho, -1, 1)
    closed = 2 / np.pi * (xi * np.arcsin(share) + rho * np.sqrt(1 - share**2))
    found = K(potential, xi)
    np.testing.assert_allclose(found, closed, rtol=1e-12)
    assert found[0] == pytest.approx(2 * rho / np.pi, rel=1e-14)


def test_slope_of_K_is_the_share_below_minus_the_share_above():
    potential = fx.potential(fx.profiles.Sine(0.2), fx.bristles.Homothetic(1.0))
    slope = jax.jit(jax.grad(lambda xi: dual_dissipation(potential, xi)))
    for xi in (-0.15, 0.0, 0.1):
        expected = 2 / np.pi * np.arcsin(xi / 0.2)
        assert float(slope(xi)) == pytest.approx(expected, abs=1e-6)


def test_M_bounds_the_power_and_meets_it_while_sliding():
    parts = pair("fourier", "angular", 1, 3)
    potential, found = fx.potential(*parts), fx.friction(*parts)

    law = eqx.filter_jit(lambda v, xi: limit_dissipation(potential, found, v, xi))

    def M(v, xi):
        return float(law(jnp.asarray(v), jnp.asarray(xi)))

    plus, minus = float(found.rho_plus), float(found.rho_minus)
    assert M(2.0, plus) == pytest.approx(2 * plus, rel=1e-13)
    assert M(-2.0, minus) == pytest.approx(-2 * minus, rel=1e-13)
    assert M(2.0, 0.5 * plus) > plus
    assert M(0.0, 0.5 * plus) == 0
    assert M(0.0, 1.001 * plus) == np.inf
    assert M(1.0, 1.001 * minus) == np.inf
    wide = float(plus - minus)
    assert np.isfinite(M(1.0, plus + 1e-12 * wide))
    assert np.isfinite(M(1.0, minus - 1e-12 * wide))
    assert M(1.0, plus + 1e-9 * wide) == M(1.0, minus - 1e-9 * wide) == np.inf
    near = limit_dissipation(potential, found, 1.0, plus + 1e-9 * wide, slack=2e-9 * wide)
    assert near == pytest.approx(float(M(1.0, plus)), rel=1e-12)


@pytest.mark.parametrize(("stiffness", "amplitude"), [(1.0, 1.0488), (1e4, 1e4)])
def test_what_the_limit_dissipates_on_its_slides_is_finite(stiffness, amplitude):
    """xi = l - Phi'(z) is rho but for rounding there: M = rho v, and K(rho) = rho."""
    scene = fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(stiffness),
        fx.loads.Sine(amplitude, 3.0),
        3.0,
    )
    ts = np.linspace(0.0, 3.0, 1501)
    z = np.asarray(fx.solve_limit(scene, ts).z)
    speed = np.diff(z, prepend=z[0])
    slides = np.flatnonzero(speed)
    xi = np.asarray(jax.vmap(scene.load)(ts))[slides] - stiffness * z[slides]
    found = fx.friction(scene)
    assert slides.size > 500
    rate = M_OF_SLIDES(scene.potential, found, speed[slides][:500], xi[:500])
    assert rate == pytest.approx(0.1 * np.abs(speed[slides][:500]), rel=1e-7)


@pytest.mark.parametrize("stiffness", [2.0, 2e-3])
@pytest.mark.parametrize("rate", [1e4, 1e6, 1e9])
def test_loads_far_above_rho_are_told_by_the_load(rate, stiffness):
    """At l = 1e6 N one spacing of floats is 1e-10 N: 1,159 of 1,201 were infinite."""
    parts = fx.profiles.Sine(0.1), fx.bristles.VerticalSpring(1.0, 2.0, 1.0)
    found, wiggle = fx.friction(*parts), fx.potential(*parts)
    load = 0.7 + rate * np.linspace(1.0, 2.0, 101)
    z = (load - 0.1) / stiffness
    xi = load - stiffness * z
    speed = np.full(101, rate / stiffness)
    law = jax.jit(jax.vmap(partial(limit_dissipation, wiggle, found)))
    told = law(speed, xi, load=load)
    assert np.all(np.isfinite(told))
    wrong = law(speed, xi + 20 * np.spacing(2 * rate) + 1e-9, load=load)
    assert np.all(np.isinf(wrong))


def test_a_batch_equals_its_lanes():
    alphas = jnp.asarray([0.5, 1.0, -2.0])

    def lane(alpha):
        wiggle = fx.potential(fx.profiles.Sine(0.2), fx.bristles.Homothetic(alpha))
        return dual_dissipation(wiggle, jnp.asarray(0.05))

    batch = jax.jit(jax.vmap(lane))(alphas)
    np.testing.assert_allclose(batch, [lane(alpha) for alpha in alphas], rtol=1e-13)
