"""The sine and cosine pair, and Fourier sums made of it."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from frictionjax.numerics.trigonometry import fourier_sum, sin_cos

TURN = 8 * np.arctan(np.longdouble(1))


def in_ulps(found, exact):
    return np.abs(found.astype(np.longdouble) - exact) / np.spacing(
        np.abs(exact).astype(float)
    )


@pytest.mark.skipif(np.finfo(np.longdouble).nmant < 63, reason="no longer floats here")
def test_two_ulp_on_the_whole_circle():
    rng = np.random.default_rng(0)
    near = np.arange(-8, 9) / 8 + 1e-7 * rng.normal(size=(200, 17))
    y = np.concatenate(
        [rng.uniform(-1, 1, 100_000), near.ravel(), rng.uniform(-1e-9, 1e-9, 99)]
    )
    sine, cosine = (np.asarray(v) for v in jax.jit(sin_cos)(y))
    reduced = y - np.round(y)  # exact
    exact = np.sin(TURN * reduced), np.cos(TURN * reduced)
    # Where the exact value is so small that the long double argument itself is rounded,
    # only the other of the two is looked at.
    for found, value in zip((sine, cosine), exact, strict=True):
        sharp = np.abs(value) > 1e-3
        assert in_ulps(found[sharp], value[sharp]).max() <= 2
    small = np.abs(y) < 1e-3
    assert (
        in_ulps(
            sine[small],
            (TURN * y[small])
            * (1 - (TURN * y[small]) ** 2 / 6 + (TURN * y[small]) ** 4 / 120),
        ).max()
        <= 2
    )


def test_digits_are_kept_far_from_zero():
    wells = 1e8 + np.arange(50)
    inside = np.linspace(-0.5, 0.5, 50)
    y = wells + inside
    exact = np.sin(2 * np.pi * (y - wells))
    assert np.abs(np.asarray(sin_cos(y)[0]) - exact).max() < 1e-15


@pytest.mark.parametrize("harmonics", [1, 4, 16, 64])
@pytest.mark.parametrize("order", [0, 1, 2])
def test_fourier_sums_and_derivatives(harmonics, order):
    rng = np.random.default_rng(harmonics)
    n = np.arange(1, harmonics + 1)
    cos, sin = rng.normal(size=(2, harmonics)) / n**3
    y = rng.uniform(-2, 2, 2000)
    fn = partial(fourier_sum, jnp.asarray(cos), jnp.asarray(sin))
    for _ in range(order):
        fn = jax.grad(fn)
    phase = 2 * np.pi * np.outer(y - np.round(y), n) + order * np.pi / 2
    turns = (2 * np.pi * n) ** order
    exact = np.cos(phase) @ (turns * cos) + np.sin(phase) @ (turns * sin)
    found = np.asarray(jax.jit(jax.vmap(fn))(jnp.asarray(y)))
    assert np.abs(found - exact).max() <= 1e-14 * np.abs(exact).max() * np.sqrt(harmonics)


@pytest.mark.parametrize("harmonics", [2, 37])  # written out, and in blocks
def test_gradient_by_coefficients(harmonics):
    n = np.arange(1, harmonics + 1)
    cos, sin = np.array([[0.1, -0.2], [0.3, 0.05]])[:, n % 2] / n**2
    slope = jax.jit(jax.grad(lambda c, s: fourier_sum(c, s, 0.3), (0, 1)))(cos, sin)
    phase = 2 * np.pi * 0.3 * n
    np.testing.assert_allclose(slope[0], np.cos(phase), atol=1e-14)
    np.testing.assert_allclose(slope[1], np.sin(phase), atol=1e-14)
    mixed = jax.jit(jax.grad(jax.grad(lambda c, y: fourier_sum(c, sin, y), 1), 0))
    np.testing.assert_allclose(mixed(cos, 0.3), -2 * np.pi * n * np.sin(phase), atol=1e-11)


def test_no_call_of_a_library_sine():
    program = jax.jit(sin_cos).lower(jnp.zeros(64)).compile().as_text()
    assert "sine(" not in program
    assert "cosine(" not in program


@pytest.mark.parametrize("inner", [jax.jacrev, jax.jacfwd])
@pytest.mark.parametrize("outer", [jax.jacrev, jax.jacfwd])
@pytest.mark.parametrize("by", [(0, 2), (2, 0), (1, 2), (2, 2), (0, 1)])
def test_second_derivatives_in_every_order_and_mode(inner, outer, by):
    """By places of those by coefficients were 0 where the first were in reverse mode."""
    known = jnp.array([0.02, 0.01]), jnp.array([0.03, -0.01]), 0.3

    def written_out(cos, sin, y):
        turns = 2 * jnp.pi * jnp.arange(1, 3) * y
        return jnp.sum(cos * jnp.cos(turns) + sin * jnp.sin(turns))

    @jax.jit
    def both(*numbers):
        fns = fourier_sum, written_out
        return [outer(inner(fn, by[0]), by[1])(*numbers) for fn in fns]

    found, wanted = both(*known)
    np.testing.assert_allclose(found, wanted, rtol=1e-13, atol=1e-14)
