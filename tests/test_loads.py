"""Loads: values, turning points, slopes, room."""

from itertools import pairwise

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx

T = jnp.linspace(0, 3, 301)
TABLE = fx.loads.PiecewiseLinear([0.5, 1.0, 2.0], [1.0, 3.0, -1.0])


def values(load, t=T):
    return np.asarray(jax.vmap(load)(t))


def test_closed_forms():
    np.testing.assert_allclose(values(fx.loads.Ramp(2.0, 0.5)), 0.5 + 2 * T, rtol=1e-15)
    wave = 1.5 * np.sin(2 * np.pi * T / 0.7)
    np.testing.assert_allclose(values(fx.loads.Sine(1.5, 0.7)), wave, atol=1e-14)
    corners = np.interp(T % 0.8, [0, 0.2, 0.6, 0.8], [0, 1.5, -1.5, 0])
    np.testing.assert_allclose(values(fx.loads.Triangle(1.5, 0.8)), corners, atol=2e-14)
    line = np.interp(T, [0.5, 1.0, 2.0], [1.0, 3.0, -1.0])
    np.testing.assert_allclose(values(TABLE), line, atol=1e-15)
    np.testing.assert_allclose(values(fx.loads.PiecewiseLinear([1.0], [2.0])), 2.0)


LOADS = [
    fx.loads.Ramp(1.0),
    fx.loads.Sine(1.1, 0.7),
    fx.loads.Triangle(-0.6, 0.7),
    TABLE,
    fx.loads.Custom(lambda t: (t - 1) ** 2, [1.0]),
]


@pytest.mark.parametrize("load", LOADS, ids=lambda load: type(load).__name__)
def test_monotone_between_the_turning_points(load):
    count = max(1, load.turning_count(3.0))
    turns = np.asarray(load.turning_points(jnp.asarray(3.0), count))
    assert turns.shape == (count,)
    assert np.all(np.diff(turns) >= 0)
    edges = np.unique(np.concatenate([[0.0], turns, [3.0]]))
    for start, end in pairwise(edges):
        steps = np.diff(values(load, jnp.linspace(start, end, 101)))
        assert np.all(steps > -1e-14) or np.all(steps < 1e-14)


@pytest.mark.parametrize("load", LOADS[1:4], ids=lambda load: type(load).__name__)
def test_too_little_room_is_nan(load):
    assert np.all(np.isnan(load.turning_points(jnp.asarray(3.0), 1)))
    exact = {"Sine": 9, "Triangle": 9, "PiecewiseLinear": 3}[type(load).__name__]
    room = np.asarray(load.turning_points(jnp.asarray(3.0), exact + 2))
    assert np.sum(room < 3.0) == exact


@pytest.mark.parametrize("load", LOADS[2:4], ids=lambda load: type(load).__name__)
def test_slopes_at_kinks_are_those_to_the_right(load):
    kinks = [t for t in load.turning_points(jnp.asarray(3.0), 12) if t < 2.9]
    for kink in kinks:
        ahead = (float(load(kink + 1e-3)) - float(load(kink))) / 1e-3
        assert float(load.slope(kink)) == pytest.approx(ahead, abs=1e-9)
        assert float(load(kink)) == pytest.approx(float(load(kink + 1e-13)), abs=1e-11)


def test_a_custom_load_must_list_its_turning_points():
    def build(turns):
        load = fx.loads.Custom(lambda t: jnp.sin(3 * t), turns)
        surface, part = fx.profiles.Sine(0.1), fx.bristles.Homothetic(1.0)
        return fx.Scene(surface, part, fx.supports.Spring(1.0), load, duration=2.0)

    build([np.pi / 6, np.pi / 2])
    build([np.pi / 6, np.pi / 2, 30.0])
    with pytest.raises(ValueError, match=r"load.turning_points = .*turns between 0\.5235"):
        build([np.pi / 6])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: fx.loads.Ramp("fast"), "load.rate = 'fast'"),
        (lambda: fx.loads.Ramp(1.0, np.inf), "load.start = inf"),
        (lambda: fx.loads.Sine(1.0, 0.0), "load.period = 0: needs period > 0"),
        (lambda: fx.loads.Sine(np.nan, 1.0), "load.amplitude = nan"),
        (lambda: fx.loads.Triangle([1, 2], 1.0), "load.amplitude = .*one number"),
        (lambda: fx.loads.Triangle(1.0, -1.0), "load.period = -1"),
        (lambda: fx.loads.PiecewiseLinear([0, 1], [1]), "load.values = .*shape"),
        (lambda: fx.loads.PiecewiseLinear([], []), "load.times = .*one or more times"),
        (lambda: fx.loads.PiecewiseLinear("ab", [1]), "load.times = 'ab'"),
        (lambda: fx.loads.PiecewiseLinear([1, 0], [1, 1]), "load.times = .*increasing"),
        (lambda: fx.loads.PiecewiseLinear([0, 1], [1, np.nan]), "load.values = .*finite"),
        (lambda: fx.loads.Custom(3.0), "load.fn = 3"),
        (
            lambda: fx.loads.Custom(jnp.sin, [1.0, 1.0]),
            "load.turning_points = .*increasing",
        ),
        (lambda: fx.loads.Custom(jnp.sin, "never"), "load.turning_points = 'never'"),
    ],
)
def test_wrong_parameters_are_named(make, message):
    with pytest.raises(ValueError, match=message):
        make()
