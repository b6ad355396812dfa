"""Derivatives of `solve` outside of compiled functions, as notebooks take them."""

import jax
import jax.numpy as jnp
import pytest

import frictionjax as fx


def curve(slope, **options):
    bristle = fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)
    parts = fx.profiles.Sine(slope), bristle, fx.supports.Spring(1.0)
    scene = fx.Scene(*parts, fx.loads.Sine(1.2, 3.0), 3.0)
    return fx.solve(scene, 0.05, 1.0, [0.0, 1.2, 3.0], **options)


def end(slope):
    return curve(slope, dissipation=False).z[-1]


def test_plain_numbers_have_the_derivatives_of_arrays():
    """What `jax.grad(f)(0.1)` hands on is no array inside: it was taken for a constant."""
    width = 1e-5
    ends = [float(end(0.1 + share * width)) for share in (1, -1)]
    slope = float(jax.grad(end)(0.1))
    assert slope == pytest.approx((ends[0] - ends[1]) / (2 * width), rel=1e-2)
    assert slope == float(jax.grad(end)(jnp.asarray(0.1)))


@pytest.mark.slow  # two programs of their own: 14 s
def test_places_alone_have_the_derivatives_that_they_have_beside_energies():
    """Of z alone, what goes with the steps is not gone through again."""

    def places(slope):
        return curve(slope).z

    def all_of_it(slope):
        found = curve(slope)
        return found.z, found.dissipation, found.residual

    by = jnp.array([0.3, -1.0, 0.7])
    alone = jax.vjp(places, 0.1)[1](by)[0]
    beside = jax.vjp(all_of_it, 0.1)[1]((by, 0 * by, 0 * by))[0]
    assert alone != 0
    assert float(alone) == pytest.approx(float(beside), rel=1e-9)
