"""Power series, their integrals, and derivatives of both."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.polynomial import Polynomial

from frictionjax.numerics import power_integral, power_sum

TERMS = np.array([0.7, -1.1, 0.4, 2.0])
PLACES = np.array([-0.8, 0.0, 0.3])
SCALE = 0.6


def derived(fn, order):
    for _ in range(order):
        fn = jax.grad(fn)
    return jax.jit(jax.vmap(fn))(PLACES)


@pytest.mark.parametrize("order", range(6))
def test_sums_and_their_derivatives(order):
    found = derived(lambda x: power_sum(TERMS, x), order)
    expected = (
        Polynomial(TERMS).deriv(order)(PLACES) if order else Polynomial(TERMS)(PLACES)
    )
    np.testing.assert_allclose(found, expected, rtol=1e-14, atol=1e-15)


@pytest.mark.parametrize("order", range(6))
def test_integrals_and_their_derivatives(order):
    found = derived(lambda x: power_integral(TERMS, SCALE, x), order)
    whole = Polynomial(TERMS * SCALE ** np.arange(4)).integ()
    expected = whole.deriv(order)(PLACES) if order else whole(PLACES)
    np.testing.assert_allclose(found, expected, rtol=1e-14, atol=1e-15)


@pytest.mark.parametrize("count", [1, 4])
def test_derivatives_by_terms_and_scale(count):
    @jax.jit
    def fn(terms, scale, x):
        slope = jax.grad(lambda s: power_integral(terms, scale, s))(x)
        return power_integral(terms, scale, x) + 2.0 * slope + power_sum(terms, x)

    numbers = [TERMS[:count], jnp.asarray(SCALE), jnp.asarray(0.3)]
    found = jax.jit(jax.grad(fn, argnums=(0, 1, 2)))(*numbers)
    step = 1e-6
    for at, slopes in enumerate(found):
        for place in np.ndindex(np.shape(slopes)):
            moved = np.zeros(np.shape(slopes))
            moved[place] = step
            ends = [
                fn(*(n + sign * moved if i == at else n for i, n in enumerate(numbers)))
                for sign in (1, -1)
            ]
            difference = float(ends[0] - ends[1]) / (2 * step)
            assert float(slopes[place]) == pytest.approx(difference, rel=1e-8, abs=1e-9)
