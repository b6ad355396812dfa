"""Derivatives of the limit where the load turns at a time that is asked for."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx

SURFACE, BRISTLE = fx.profiles.Sine(0.1), fx.bristles.SlantedSpring(1.0, 2.4, 1.0, 0.5)


def solved(load, ts, duration=3.0):
    scene = fx.Scene(SURFACE, BRISTLE, fx.supports.Spring(1.0), load, duration)
    found = fx.solve_limit(scene, ts)
    return jnp.stack([found.z, found.dissipation])


def bent(corner):
    """Turns at `corner` and at 2 s, and rises faster from 3.2 times `corner` on."""
    times = jnp.stack([jnp.asarray(t, float) for t in (0, corner, 2, 3.2 * corner, 3)])
    return fx.loads.PiecewiseLinear(times, [0.0, 1.05, -0.4, 0.2, 1.2])


LOADS = {
    "points": (lambda p: solved(bent(p), [0.6, 0.75, 2.0, 2.4, 2.7]), 0.75),
    "at the end": (lambda p: solved(fx.loads.Triangle(1.05, p), [0.7, 0.75], 0.75), 3.0),
}
SLOW = pytest.mark.slow  # 2 to 5 s each
BY_DEFAULT = (lambda p: solved(fx.loads.Triangle(1.05, p), None), 3.0)


@pytest.mark.parametrize(
    ("values", "at"),
    [
        *(pytest.param(*case, id=name) for name, case in LOADS.items()),
        pytest.param(*BY_DEFAULT, id="at times by default", marks=SLOW),
    ],
)
def test_first_derivatives_lie_between_differences_from_both_sides(values, at):
    @jax.jit
    def found(p):
        return values(p), jax.jacfwd(values)(p), jax.jacrev(values)(p)

    width = 1e-6
    here, forward, reverse = (np.asarray(x) for x in found(at))
    behind, ahead = (np.asarray(found(at + by)[0]) for by in (-width, width))
    sides = np.stack([here - behind, ahead - here]) / width
    for slopes in (forward, reverse):
        assert np.all(slopes >= sides.min(axis=0) - 2e-5)
        assert np.all(slopes <= sides.max(axis=0) + 2e-5)


@pytest.mark.parametrize(
    "kind", [pytest.param(fx.loads.Triangle, marks=SLOW), fx.loads.Sine]
)
def test_what_is_lost_has_derivatives_that_do_not_depend_on_the_times_asked_for(kind):
    def lost(period, ts):
        return solved(kind(1.05, period), ts)[1, -1]

    @jax.jit
    def found(period):
        twice = jax.value_and_grad(jax.grad(lost))
        return *twice(period, [0.0, 0.75, 2.25, 3.0]), *twice(period, [0.0, 3.0])

    slope, bend, alone, bend_alone = found(3.0)
    assert slope == pytest.approx(float(alone), rel=1e-12)
    assert bend == pytest.approx(float(bend_alone), rel=1e-12)
    difference = float(found(3.0 + 1e-5)[2] - found(3.0 - 1e-5)[2]) / 2e-5
    assert bend == pytest.approx(difference, rel=1e-6)
