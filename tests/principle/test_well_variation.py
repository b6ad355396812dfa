"""The integral behind K, against quadrature and closed forms."""

from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from samples import FEW_BRISTLES, central, pair

import frictionjax as fx
from frictionjax.principle.well_variation import well_variation

K = eqx.filter_jit(
    lambda potential, xi: jax.vmap(lambda x: well_variation(potential, x))(xi)
)
K_and_slope = eqx.filter_jit(
    lambda potential, xi: jax.vmap(jax.value_and_grad(partial(well_variation, potential)))(
        xi
    )
)
MID = (np.arange(1 << 15) + 0.5) / (1 << 15)


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
@pytest.mark.parametrize(
    "surface", ["fourier", pytest.param("sine", marks=pytest.mark.slow)]
)
def test_K_is_above_its_argument_inside_only(surface, kind):
    parts = pair(surface, kind, 1, 8)
    found = fx.friction(*parts)
    plus, minus = float(found.rho_plus), float(found.rho_minus)
    width = plus - minus
    share = np.array([1e-3, 0.1, 0.5, 0.9, 0.999])
    inside = minus + width * share
    outside = np.array([minus, plus, 3 * minus, plus + 0.2 * width, 2 * plus])
    values = K(fx.potential(*parts), np.concatenate([inside, outside]))
    assert np.all(values[:5] > np.abs(inside) * (1 + 1e-9))
    np.testing.assert_allclose(values[5:], np.abs(outside), rtol=4e-14)


def test_K_of_a_sine_in_closed_form():
    rho = 0.37
    potential = fx.potential(fx.profiles.Sine(0.2), fx.bristles.Homothetic(rho / 0.2))
    # The last ones leave a piece above xi that is narrower than a cell of the grid.
    xi = rho * jnp.asarray([0.0, 0.3, -0.7, 0.99, 1 - 1e-5, -1 + 1e-6, 1.0])
    share = np.clip(xi / rho, -1, 1)
    closed = 2 / np.pi * (xi * np.arcsin(share) + rho * np.sqrt(1 - share**2))
    found, _ = K_and_slope(potential, xi)
    np.testing.assert_allclose(found, closed, rtol=1e-12)
    assert found[0] == pytest.approx(2 * rho / np.pi, rel=1e-14)


def test_slope_of_K_is_the_share_below_minus_the_share_above():
    potential = fx.potential(fx.profiles.Sine(0.2), fx.bristles.Homothetic(1.0))
    share = jnp.linspace(-0.75, 0.75, 7)
    _, slope = K_and_slope(potential, 0.2 * share)
    np.testing.assert_allclose(slope, 2 / np.pi * np.arcsin(share), atol=1e-6)


@pytest.mark.slow  # a program for each
def test_a_batch_equals_its_lanes():
    alphas = jnp.asarray([0.5, 1.0, -2.0])

    def lane(alpha):
        wiggle = fx.potential(fx.profiles.Sine(0.2), fx.bristles.Homothetic(alpha))
        return well_variation(wiggle, jnp.asarray(0.05))

    batch = jax.jit(jax.vmap(lane))(alphas)
    np.testing.assert_allclose(batch, [lane(alpha) for alpha in alphas], rtol=1e-13)
