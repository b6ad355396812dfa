"""Loads: values, turning points, slopes, room."""

from itertools import pairwise

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from at_places import part_at
from paths import path_of
from samples import Formula

import frictionjax as fx
from frictionjax.loads.steep import steep_times

T = jnp.linspace(0, 3, 301)
TABLE = fx.loads.PiecewiseLinear([0.5, 1.0, 2.0], [1.0, 3.0, -1.0])


def values(load, t=T):
    return np.asarray(part_at(load, t))


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
        here, near, later = values(load, kink + np.array([0.0, 1e-13, 1e-3]))
        assert float(load.slope(kink)) == pytest.approx((later - here) / 1e-3, abs=1e-9)
        assert here == pytest.approx(near, abs=1e-11)


def test_turning_points_are_listed_all_or_not_at_all():
    def build(turns):
        load = fx.loads.Custom(lambda t: jnp.sin(3 * t), turns)
        surface, part = fx.profiles.Sine(0.1), fx.bristles.Homothetic(1.0)
        return fx.Scene(surface, part, fx.supports.Spring(1.0), load, duration=2.0)

    build([np.pi / 6, np.pi / 2])
    build([np.pi / 6, np.pi / 2, 30.0])
    found = np.asarray(build(()).turning_points())
    np.testing.assert_allclose(found, [np.pi / 6, np.pi / 2, 2.0, 2.0], rtol=1e-15)
    with pytest.raises(ValueError, match=r"load.turning_points = 'without 1\.57079633'"):
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


@eqx.filter_jit
def steep_slopes(load, start, end):
    times = steep_times(load, start, end)
    return times, jax.vmap(load.slope)(times)


def fastest(load, start, end):
    times, slopes = steep_slopes(load, jnp.asarray(start), jnp.asarray(end))
    assert np.all((times > start) & (times < end))
    return np.max(np.abs(slopes))


def _ramped(t, center, width, rise):
    return 0.2 * t + rise * jnp.tanh((t - center) / width)


def with_ramp(center, width, rise=0.4):
    """A slow rise with a steep one of `2 rise` N inside it, C^1 and monotone."""
    return fx.loads.Custom(Formula(_ramped, jnp.asarray([center, width, rise])))


@pytest.mark.parametrize("center", [0.7, 1.5, 1.523])
@pytest.mark.parametrize(("width", "rise"), [(1e-2, 0.4), (1e-3, 0.4), (1e-6, 1e-3)])
def test_ramps_between_samples_are_found(center, width, rise):
    load = with_ramp(center, width, rise)
    assert fastest(load, 0.0, 3.0) == pytest.approx(0.2 + rise / width, rel=1e-2)


def test_steepest_places_of_plain_loads():
    assert fastest(fx.loads.Sine(1.5, 0.7), 0.175, 0.525) == pytest.approx(
        1.5 * 2 * np.pi / 0.7, rel=1e-6
    )
    assert fastest(fx.loads.Ramp(-2.0), 0.0, 3.0) == pytest.approx(2.0, rel=1e-12)
    assert fastest(TABLE, 1.0, 2.0) == pytest.approx(4.0, rel=1e-9)


@pytest.mark.slow
def test_slides_over_a_ramp_between_samples():
    """Tolerances come from the fastest slide: values were 0.0076 eps off, status OK."""
    scene = fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
        fx.supports.Spring(1.0),
        with_ramp(1.5, 1e-3, 0.2),
        3.0,
    )
    assert path_of(scene).speed == pytest.approx(200.2, rel=1e-3)
    eps, ts = 3e-4, 1.5 + np.array([0.004, 0.01, 0.03, 0.1])
    found = fx.solve(scene, eps, 0.5, ts, dissipation=False)
    truth = fx.solve(scene, eps, 0.5, ts, 1e-4, dissipation=False)
    assert found.ok
    assert truth.ok
    assert np.max(np.abs(np.asarray(found.z - truth.z))) < 1e-3 * eps


@pytest.mark.parametrize("listed", [(), (1.0,)])
@pytest.mark.parametrize("size", [1.0, -1e-3])
def test_a_load_that_jumps_is_refused(listed, size):
    load = fx.loads.Custom(lambda t: jnp.where(t < 1, 0.3, 0.3 + size), listed)
    with pytest.raises(ValueError, match=r"load\.fn = .jumps by .* at t = 1"):
        load.turning_count(3.0)
    assert with_ramp(1.0, 1e-9).turning_count(3.0) == 0  # steep, but no jump


def test_more_turns_than_there_is_room_for_are_refused():
    with pytest.raises(ValueError, match=r"load: turning points = 6e\+09: needs at most"):
        fx.Scene(
            fx.profiles.Sine(0.1),
            fx.bristles.Homothetic(1.0),
            fx.supports.Spring(1.0),
            fx.loads.Sine(1.0, 1e-9),
            3.0,
        )


def test_functions_in_pieces_by_name_have_their_course_looked_at():
    """A branch without a number of its own was one that no stretch could be joined to."""

    def up_and_down(t):
        return jnp.piecewise(t, [t < 1, t >= 1], [lambda t: 1.5 * t, lambda t: 2.5 - t])

    load = fx.loads.Custom(up_and_down, [1.0])
    assert load.turning_points(jnp.asarray(3.0), 2).tolist() == [1.0, 3.0]
    scene = fx.Scene(
        fx.profiles.Sine(0.1),
        fx.bristles.Homothetic(1.0),
        fx.supports.Spring(1.0),
        load,
        3.0,
    )
    rho = 0.1
    found = fx.solve_limit(scene, [0.0, 1.0, 3.0]).z
    np.testing.assert_allclose(found, [0.0, 1.5 - rho, -0.5 + rho], atol=1e-14)


@pytest.mark.parametrize(
    ("load", "turns"),
    [
        (fx.loads.Sine(1.0, 4.0), [1.0, 3.0, 5.0, 7.0]),
        (fx.loads.Triangle(1.0, 4.0), [1.0, 3.0, 5.0, 7.0]),
        (fx.loads.PiecewiseLinear([1.0, 7.9, 9.0], [0, 2, 1]), [1.0, 7.9]),
    ],
)
def test_turning_points_are_there_up_to_the_end(load, turns):
    found = load.turning_points(jnp.asarray(8.0), 5)
    np.testing.assert_allclose(found[: len(turns)], turns, rtol=1e-15)
    np.testing.assert_array_equal(found[len(turns) :], 8.0)
