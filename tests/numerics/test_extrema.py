"""Extrema of periodic functions: the scan finds the bump, Newton's method its top."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from frictionjax.numerics.extrema import periodic_extrema

DENSE = np.arange(2**17) / 2**17


def of_harmonics(seed, count):
    """A random sum of harmonics, none of which stands out: as many bumps of like height."""
    angles = jnp.asarray(np.random.default_rng(seed).uniform(0, 2 * np.pi, count))
    orders = jnp.arange(count) + 1
    return lambda y: jnp.sum(jnp.cos(2 * jnp.pi * orders * y + angles))


# Of 1024 points only the highest of four neighbours is looked at, of 1022 each.
@pytest.mark.parametrize("points", [1022, 1024])
@pytest.mark.parametrize("seed", range(4))
def test_highest_bump_of_many(seed, points):
    fn = of_harmonics(seed, 40)
    values = np.asarray(jax.vmap(fn)(DENSE))
    # Of a top of curvature c a grid of 2^17 misses c/8/2^34 at most.
    most = (2 * np.pi * 40) ** 2 * 40 / 2**37
    found = periodic_extrema(fn, points)
    for value, place, brute in (
        (found.max, found.argmax, values.max()),
        (found.min, found.argmin, values.min()),
    ):
        assert abs(value - brute) < most
        assert float(fn(place)) == pytest.approx(float(value), rel=1e-12)
        assert abs(float(jax.grad(fn)(place))) < 1e-8


def test_two_bumps_a_few_points_apart_are_told_apart():
    """The lower top is the nearest scanned point to its bump's top, so it scans higher."""
    width, apart = 2e-3, 16 / 1024  # bumps 16 points apart, each two wide

    def fn(y):
        def bump(center):
            return jnp.exp(-((jnp.sin(jnp.pi * (y - center)) / (jnp.pi * width)) ** 2))

        low, high = 512 / 1024, 512 / 1024 + apart + 0.5 / 1024
        return bump(low) + 1.01 * bump(high)

    found = periodic_extrema(fn, 1024)
    assert float(found.argmax) == pytest.approx(0.5 + apart + 0.5 / 1024, abs=1e-9)
    assert float(found.max) == pytest.approx(1.01, rel=1e-9)
