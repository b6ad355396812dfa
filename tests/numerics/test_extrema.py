"""Extrema of periodic functions: the scan finds the bump, Newton's method its top."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from frictionjax.numerics.extrema import periodic_extrema

DENSE = np.arange(2**17) / 2**17


@partial(jax.jit, static_argnames="points")  # one program for all seeds
def of_harmonics(angles, points):
    """Extrema of a sum of harmonics, what is there, and values everywhere."""
    orders = jnp.arange(angles.size) + 1

    def fn(y):
        return jnp.sum(jnp.cos(2 * jnp.pi * orders * y + angles))

    found = periodic_extrema(fn, points)
    there = [jax.value_and_grad(fn)(place) for place in (found.argmax, found.argmin)]
    return found, there, jax.vmap(fn)(DENSE)


# Of 1024 points only the highest of four neighbours is looked at, of 1022 each.
@pytest.mark.parametrize("points", [1022, 1024])
@pytest.mark.parametrize("seed", range(4))
def test_highest_bump_of_many(seed, points):
    # Random: none of them stands out, so there are as many bumps of like height.
    angles = np.random.default_rng(seed).uniform(0, 2 * np.pi, 40)
    found, (top, bottom), values = of_harmonics(angles, points)
    # Of a top of curvature c a grid of 2^17 misses c/8/2^34 at most.
    most = (2 * np.pi * 40) ** 2 * 40 / 2**37
    for value, (there, slope), brute in (
        (found.max, top, values.max()),
        (found.min, bottom, values.min()),
    ):
        assert abs(value - brute) < most
        assert float(there) == pytest.approx(float(value), rel=1e-12)
        assert abs(float(slope)) < 1e-8


def test_two_bumps_a_few_points_apart_are_told_apart():
    """The lower top is the nearest scanned point to its bump's top, so it scans higher."""
    width, apart = 2e-3, 16 / 1024  # bumps 16 points apart, each two wide

    def fn(y):
        def bump(center):
            return jnp.exp(-((jnp.sin(jnp.pi * (y - center)) / (jnp.pi * width)) ** 2))

        low, high = 512 / 1024, 512 / 1024 + apart + 0.5 / 1024
        return bump(low) + 1.01 * bump(high)

    found = jax.jit(lambda: periodic_extrema(fn, 1024))()
    assert float(found.argmax) == pytest.approx(0.5 + apart + 0.5 / 1024, abs=1e-9)
    assert float(found.max) == pytest.approx(1.01, rel=1e-9)


def test_the_highest_of_a_hundred_bumps_between_samples():
    """By samples the highest was none of eight: 4e-4 of it were lost."""

    def fn(y):
        return jnp.cos(200 * jnp.pi * y) - 0.01 * jnp.sin(2 * jnp.pi * y)

    found, values = jax.jit(lambda: (periodic_extrema(fn, 4096), jax.vmap(fn)(DENSE)))()
    most = (200 * np.pi) ** 2 / 2**37
    assert abs(float(found.max) - float(values.max())) < most
    assert abs(float(found.min) - float(values.min())) < most
