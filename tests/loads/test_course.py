"""Loads given as functions: turns, kinks and steep places are found, or refused."""

import warnings

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.loads.course import course_of

T = 60.0


def knock(at, lasts=5e-3, size=4.0):
    """A sin^2 pulse, nothing before and after."""

    def fn(t):
        u = (t - at) / lasts
        return jnp.where((u > 0) & (u < 1), size * jnp.sin(jnp.pi * u) ** 2, 0.0)

    return fn


def gaussian(at, wide, size=4.0):
    return lambda t: size * jnp.exp(-(((t - at) / wide) ** 2))


def pull(*events):
    """A slow pull, and what comes on top."""
    return lambda t: 0.4 / T * t + sum(event(t) for event in events)


def prepared(fn, listed=(), duration=T):
    return fx.loads.Custom(fn, listed).prepared(jnp.asarray(duration))


def ends_at(fn):
    """The play operator over what was found, for friction of 0.1 N and 1 N/m."""
    load, z = prepared(fn), 0.0
    for value in jax.vmap(load)(jnp.append(load.found, T)):
        z = float(np.clip(z, value - 0.1, value + 0.1))
    return z


@pytest.mark.parametrize(
    "event",
    [
        knock(41.7, 5e-3),
        gaussian(41.7, 6e-5),
        lambda t: 4 / jnp.cosh(jnp.clip((t - 41.7) / 1e-3, -300, 300)),
        lambda t: jnp.maximum(4 - 4e5 * jnp.abs(t - 41.7), 0.0),
    ],
    ids=["window", "gaussian of 1e-6 T", "sech", "hat of 20 us"],
)
def test_a_knock_in_a_long_pull_drags_the_limit(event):
    """4096 samples step over it: 0.3 where it is 0.378."""
    assert ends_at(pull(event)) == pytest.approx(0.4 / T * 41.7 + 0.1, abs=1e-4)
    assert ends_at(pull()) == pytest.approx(0.3, abs=1e-12)


def test_a_scene_holds_what_was_found():
    """0.3 with an OK, where it is 0.378."""
    surface, part = fx.profiles.Sine(0.1), fx.bristles.Homothetic(1.0)
    load = fx.loads.Custom(pull(knock(41.7)))
    scene = fx.Scene(surface, part, fx.supports.Spring(1.0), load, T)
    known = ends_at(pull(knock(41.7)))
    found = float(fx.solve_limit(scene, jnp.asarray([T])).z[0])
    assert found == pytest.approx(known, abs=1e-12)
    assert known == pytest.approx(0.4 / T * 41.7 + 0.1, abs=1e-4)


@pytest.mark.parametrize("seed", range(3))
def test_gaussians_of_any_width_anywhere_are_found(seed):
    rng = np.random.default_rng(seed)
    for wide in T * 10 ** rng.uniform(-9, -2, 3):
        at = rng.uniform(0.1 * T, 0.9 * T)
        found = course_of(pull(gaussian(at, wide)), T)
        assert not found.unproved
        top, bottom = found.turns
        # l' = 0: the slope of the pull moves the top by wide^2 rate/(8 N).
        assert abs(top - at - wide**2 * 0.4 / T / 8) < 1e-12 * T
        assert at < bottom < at + 7 * wide
        assert found.steepest == pytest.approx(at, abs=wide)


def sine(t):
    return jnp.sin(2 * jnp.pi * 500 * t / T)


def chirp(t):
    return jnp.sin(t**2)


@pytest.mark.parametrize(
    ("fn", "turns"),
    [
        (lambda t: (t - 7.0) ** 2, [7.0]),
        (lambda t: (t - 7.0) ** 4, [7.0]),
        (lambda t: (t - 7.0) ** 3, []),
        (lambda t: 0.1 * t, []),
        (lambda t: 0.0 * t, []),
        (sine, (np.arange(1000) + 0.5) / 1000 * T),
        (chirp, np.sqrt(np.pi * (np.arange(1146) + 0.5))),
        (lambda t: t + 20 * jnp.exp(-t / 10), [10 * np.log(2)]),
        (lambda t: jnp.abs(jnp.mod(t, 2.0) - 1.0), np.arange(1.0, T)),
    ],
    ids=["square", "flat", "cube", "line", "none", "1000", "chirp", "dip", "teeth"],
)
def test_turning_points_are_those_of_the_closed_form(fn, turns):
    found = course_of(fn, T)
    assert not found.unproved
    assert found.kinks.size == 0
    assert found.turns.shape == np.shape(turns)
    np.testing.assert_allclose(found.turns, turns, atol=1e-12 * T)


def test_bursts_at_every_second_and_a_knock_on_a_sine():
    hit = knock(0.3)
    bursts = course_of(lambda t: 0.01 * t + hit(jnp.mod(t, 1.0)), T)
    assert bursts.turns.size == 120
    np.testing.assert_allclose(bursts.turns[::2], np.arange(60) + 0.3025, atol=1e-6)
    wave = course_of(lambda t: jnp.sin(2 * jnp.pi * t / 7) + knock(31.7123)(t), T)
    own = 7 * (2 * np.arange(17) + 1) / 4
    assert wave.turns.size == own.size + 2
    assert np.max(np.min(np.abs(wave.turns[:, None] - own), axis=0)) < 1e-9


def test_kinks_open_the_piece_to_their_right():
    found = course_of(lambda t: jnp.clip(jnp.minimum(t, 6 - t), 0.5, 2.0), 6.0)
    assert found.turns.tolist() == pytest.approx([2.0], abs=1e-13)
    assert found.kinks.tolist() == pytest.approx([0.5, 4.0, 5.5], abs=1e-13)
    table = course_of(lambda t: jnp.interp(t, jnp.array([0.0, 1.0, 5.0]), jnp.ones(3)), 6.0)
    assert table.turns.size == table.kinks.size == 0
    load = prepared(lambda t: jnp.abs(t - 31.7))
    assert float(load.slope(load.found[0])) == 1.0


def test_the_steepest_of_many_ramps_is_known_where_it_is_the_smallest():
    at, wide, tall = jnp.linspace(1, 59, 40), np.full(40, 2e-2), np.full(40, 0.12)
    wide[17], tall[17] = 1e-5, 0.002
    wide, tall = jnp.asarray(wide), jnp.asarray(tall)
    found = course_of(
        lambda t: 0.3 * t + jnp.sum(0.5 * tall * jnp.tanh((t - at) / wide)), T
    )
    assert found.turns.size == 0
    assert found.steepest == pytest.approx(float(at[17]), abs=1e-5)


def opaque(t):
    """0, by a loop of which nobody knows how long it is."""
    return 0 * jax.lax.while_loop(lambda x: x < 5, lambda x: x + 1.3, t)


def test_what_cannot_be_bounded_is_sampled_and_said():
    def fn(t):
        return pull(knock(31.7123))(t) + opaque(t)

    with pytest.warns(fx.loads.UnprovedLoad, match=r"while .* less than 0\.000916 s"):
        load = prepared(fn)
    known = course_of(pull(knock(31.7123)), T).turns
    gaps = np.min(np.abs(np.asarray(load.found)[:, None] - known), axis=0)
    assert np.max(gaps) < 1e-9
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fx.loads.UnprovedLoad)
        kink = fx.loads.Custom(lambda t: jnp.abs(t - 1.0) + opaque(t))
        assert kink.turning_count(3.0) == 1
        with pytest.raises(ValueError, match="jumps by 1 at t = 2"):
            fx.loads.Custom(lambda t: (t > 2.0) + opaque(t)).turning_count(3.0)


@pytest.mark.parametrize(
    ("fn", "message"),
    [
        (lambda t: jnp.where((t > 1) & (t < 1 + 1e-9), jnp.nan, t), "no finite number"),
        (lambda t: jnp.log(t - 1e-6), "no finite number"),
        (lambda t: jnp.where(t < 31.7, 0.3, 0.3 + 1e-5), "jumps by 1e-05 at t = 31.7"),
        (lambda t: 1.0 * (t > 31.7) * (t < 31.7 + 1e-8), "jumps by 1 at t = 31.7"),
        (lambda t: jnp.floor(t / 7), "jumps by 1 at t = 7"),
    ],
)
def test_what_is_no_load_is_refused_however_briefly(fn, message):
    with pytest.raises(ValueError, match=message):
        course_of(fn, T)


def test_listed_times_are_checked_against_what_is_found():
    fn = pull(knock(31.7), knock(45.3))
    turns = course_of(fn, T).turns
    with pytest.raises(
        ValueError, match=r"turning_points = 'without 45\.3025, 45\.305': n"
    ):
        prepared(fn, turns[:2])
    whole = prepared(fn, [5.0, *turns])
    assert set(np.asarray(whole.listed)) <= set(np.asarray(whole.found))
    near = fx.loads.Custom(lambda t: (t - 7.0) ** 2, [7.0 + 1e-6])
    assert near.turning_count(T) == 1
    with pytest.raises(ValueError, match="without 7'"):
        fx.loads.Custom(lambda t: (t - 7.0) ** 2, [7.1]).turning_count(T)


def test_what_is_found_follows_the_duration():
    load = prepared(jnp.sin, duration=2.0)
    assert load.found.shape == (1,)
    assert load.prepared(jnp.asarray(9.0)).found.shape == (3,)
    assert np.asarray(load.turning_points(jnp.asarray(1.9), 1)) == pytest.approx(np.pi / 2)
    assert np.isnan(load.turning_points(jnp.asarray(2.1), 1)).all()


class Wave(eqx.Module):
    """A sine with a number that can be changed."""

    rate: jax.Array

    def __call__(self, t):
        return jnp.sin(self.rate * t)


def test_a_number_that_was_changed_since_does_not_pass_for_the_old_one():
    load = prepared(Wave(jnp.asarray(1.0)), duration=2.0)
    faster = eqx.tree_at(lambda load: load.fn.rate, load, jnp.asarray(1.3))
    assert load.turning_points(jnp.asarray(2.0), 2).tolist() == [np.pi / 2, 2.0]
    assert np.isnan(faster.turning_points(jnp.asarray(2.0), 2)).all()
    again = faster.prepared(jnp.asarray(2.0))
    found = float(again.turning_points(jnp.asarray(2.0), 1)[0])
    assert found == pytest.approx(np.pi / 2.6, rel=1e-14)


def test_traced_numbers_cannot_be_looked_at():
    """Samples say where a traced load turns that no listed time is for."""

    def turns(rate, listed):
        load = fx.loads.Custom(lambda t: jnp.sin(rate * t), listed)
        assert load.prepared(jnp.asarray(2.0)) is load
        return load.turning_points(jnp.asarray(2.0), 2)

    many = eqx.filter_jit(lambda rate: (turns(rate, ()), turns(rate, (np.pi / 2,))))
    with pytest.warns(fx.loads.UnprovedLoad, match="numbers are traced"):
        none, one = many(jnp.asarray(1.0))
    assert np.all(np.isnan(none))
    assert np.asarray(one).tolist() == [np.pi / 2, 2.0]
    assert np.all(np.isnan(many(jnp.asarray(3.0))[1]))
