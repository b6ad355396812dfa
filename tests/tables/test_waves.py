"""Fourier series with harmonics one after the other, and as an axis."""

import equinox as eqx
import jax
import numpy as np
import pytest

from frictionjax.tables import SeriesProfile, Waves

RNG = np.random.default_rng(2)


@eqx.filter_jit
def summed(series, y):
    return series(y)


@pytest.mark.parametrize("count", [1, 4, 8, 33])
def test_both_kinds_are_the_sum(count):
    cos, sin = RNG.normal(size=(2, count))
    y, n = RNG.uniform(-2, 2, 300), np.arange(1, count + 1)[:, None]
    turns = 2 * np.pi * n * y
    expected = 0.5 + cos @ np.cos(turns) + sin @ np.sin(turns)
    for kind in (SeriesProfile, Waves):
        found = summed(kind(0.5, cos, sin), y)
        np.testing.assert_allclose(found, expected, atol=2e-13 * count)


def test_no_digits_are_lost_far_away():
    waves = Waves(0.0, RNG.normal(size=4), RNG.normal(size=4))
    slope = jax.jit(jax.vmap(jax.grad(waves)))
    y = np.arange(16) / 16
    np.testing.assert_array_equal(slope(y + 2.0**40), slope(y))
