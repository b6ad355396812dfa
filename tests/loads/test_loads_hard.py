"""Loads that turn too often, take long, jump, or are no function of a real number."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.intervals import TooMuchWorkError, enclosure_of
from frictionjax.loads.course import course_of

T = 60.0


def fast(t):
    return jnp.sin(2e6 * jnp.pi * t)


def opaque(t):
    """0, by a loop of which nobody knows how long it is."""
    return 0 * jax.lax.while_loop(lambda x: x < 5, lambda x: x + 1.3, t)


@pytest.mark.parametrize(
    "fn",
    [
        fast,
        pytest.param(lambda t: 0.3 * t + 0.1 * fast(t), marks=pytest.mark.slow),
        pytest.param(lambda t: jnp.sin(1e6 * t**2), marks=pytest.mark.slow),
        lambda t: jnp.mod(jnp.sin(12.9898 * t) * 43758.5453, 1.0),
        lambda t: fast(t) + opaque(t),
    ],
    ids=["sine", "on a pull", "chirp", "noise", "sampled"],
)
def test_what_turns_too_often_to_be_seen_is_refused(fn):
    """A limit of 0 with an OK, where it is -0.1278."""
    with pytest.raises(ValueError, match=r"load\.fn = 'turns more often than once in"):
        course_of(fn, 10.0)


def test_what_moves_nothing_between_samples_is_none_of_these():
    found = course_of(lambda t: 0.3 * t + 1e-9 * fast(t) + opaque(t), 10.0)
    assert found.unproved
    assert found.turns.size == 0


def pulses(count, wide=1e-3):
    at = jnp.linspace(0.1, 59.9, count)
    return lambda t: jnp.sum(jnp.exp(-(((t - at) / wide) ** 2)))


@pytest.mark.parametrize(
    "fn",
    [
        pulses(300),
        jax.jit(pulses(300)),
        lambda t: (
            jnp.ones(300) @ jnp.exp(-(((t - jnp.linspace(0.1, 59.9, 300)) * 1e3) ** 2))
        ),
        lambda t: jnp.sum(jnp.tanh((t - jnp.linspace(0.1, 59.9, 300)) * 1e3)),
    ],
    ids=["sum", "compiled", "product", "steps"],
)
def test_sums_of_pulses_are_bounded_by_the_terms_that_move(fn):
    """2000 pulses ran without end; now as many numbers as 300 took."""
    bounds, whole = enclosure_of(fn), jax.vmap(fn)
    lo = np.sort(np.random.default_rng(0).uniform(0.0, T, 3000))
    hi = lo + 1e-4
    bounds.allow(3000 * 300)  # an eighth of all terms in all steps
    found = bounds(lo, hi)
    for times in (lo, 0.5 * (lo + hi), hi):
        values = np.asarray(whole(times))
        # XLA multiplies by 1/299 in `linspace`: 7e-15 s, of slopes of 1e3 N/s.
        assert np.all(found.value.lo <= values + 1e-10)
        assert np.all(values - 1e-10 <= found.value.hi)
    rise = (np.asarray(whole(hi)) - np.asarray(whole(lo))) / (hi - lo)
    assert np.all((found.slope.lo - 1e-5 <= rise) & (rise <= found.slope.hi + 1e-5))
    assert np.max(found.value.width[np.abs(rise) < 1e-25]) < 1e-10


@pytest.mark.slow
def test_thousands_of_pulses_are_all_found():
    found = course_of(pulses(2000), T)
    assert not found.unproved
    assert found.turns.size == 3999
    at = np.linspace(0.1, 59.9, 2000)
    np.testing.assert_allclose(found.turns[::2], at, atol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("fn", "message"),
    [
        (lambda t: jnp.sum(jnp.sin(jnp.arange(100_000) * t)), "a program of 40000"),
        (
            lambda t: jnp.sum(1 / (1 + (1e3 * (t - jnp.linspace(0, 60, 2000))) ** 2)),
            "turns more often",
        ),
        (
            lambda t: jnp.sum(0.5 ** jnp.arange(30) * jnp.cos(3.0 ** jnp.arange(30) * t)),
            "turns more often",
        ),
    ],
    ids=["long", "pulses that never rest", "weierstrass"],
)
def test_what_takes_too_much_work_is_refused(fn, message):
    with pytest.raises(ValueError, match=message):
        course_of(fn, T)


def test_work_is_counted_inside_loops():
    def fn(t):
        return jax.lax.scan(lambda c, a: (c + a * t, None), 0.0, jnp.ones(900))[0]

    bounds = enclosure_of(fn)
    bounds.allow(900 * 256)
    with pytest.raises(TooMuchWorkError):
        bounds(np.zeros(8), np.ones(8))


@pytest.mark.parametrize(
    ("fn", "turns"),
    [
        (lambda t: 4 * jnp.maximum(0, 1 - jnp.abs(t - 1e-7) / 1e-7), [1e-7]),
        (lambda t: 4 * jnp.maximum(0, 1 - jnp.abs(t - 60 + 1e-7) / 1e-7), [60 - 1e-7]),
        (lambda t: 4 * jnp.maximum(0, 1 - jnp.abs(t - 31.234) / 1e-12), [31.234]),
        (lambda t: 2 * jnp.exp(-jnp.sqrt(jnp.abs(t - 20.123) / 1e-4)), [20.123]),
        (lambda t: -(jnp.abs(t - 20.123) ** 0.2), [20.123]),
    ],
    ids=["at the start", "at the end", "of 1 ps", "cusp", "steep cusp"],
)
def test_what_is_steep_does_not_jump(fn, turns):
    np.testing.assert_allclose(course_of(fn, T).turns, turns, atol=1e-12)


@pytest.mark.parametrize(
    ("fn", "message"),
    [
        (lambda t: 0.01 * jnp.log(jnp.abs(t - 1.23456)), "number at t = 1.23456"),
        (lambda t: 0.01 * jnp.log(jnp.abs(t**2 - 2)), "grows without bound at t = 1.4142"),
        (lambda t: 1e-9 / (t**2 - 2), "grows without bound at t = 1.4142"),
        (lambda t: jnp.where(t == 31.25, jnp.nan, 0.01 * t), "number at t = 31.25"),
        (lambda t: jnp.where(t == 0.1, jnp.inf, 0.01 * t), "number at t = 0.1"),
        (lambda t: jnp.where(t > 20, 1.0, 0.01 * t), "jumps by 0.8 at t = 20, or changes"),
    ],
)
def test_places_that_are_no_number_are_named(fn, message):
    with pytest.raises(ValueError, match=message):
        course_of(fn, T)


def test_a_derivative_that_overflows_is_named():
    message = r"slope at t = 0, where jax\.jvp overflows"
    with pytest.raises(ValueError, match=message):
        course_of(lambda t: 4 / jnp.cosh((t - 31.2) / 1e-6) + opaque(t), T)


def callback(t):
    number = jax.ShapeDtypeStruct(jnp.shape(t), float)
    return jax.pure_callback(np.sin, number, t, vmap_method="expand_dims")


@pytest.mark.parametrize(
    ("fn", "message"),
    [
        (
            lambda t: jnp.exp(1j * t),
            "'values of dtype complex128': needs .* one real number",
        ),
        (lambda t: "a", r"values that are \['a'\]"),
        (lambda t: None, r"values that are \[None\]"),
        (lambda t: {"l": t}, "values that are "),
        (lambda t: (t, t), r"values of shape \(2,\)"),
        (callback, "'without jax.jvp, as Pure callbacks .* needs .*custom_jvp"),
    ],
)
def test_what_is_no_function_of_a_number_is_named(fn, message):
    with pytest.raises(ValueError, match=r"load\.fn = .*" + message):
        fx.loads.Custom(fn)


def test_callbacks_with_a_derivative_are_sampled():
    fn = jax.custom_jvp(callback)
    fn.defjvp(lambda t, by: (fn(*t), jnp.cos(t[0]) * by[0]))
    with pytest.warns(fx.loads.UnprovedLoad, match="pure_callback has no bounds"):
        load = fx.loads.Custom(fn).prepared(jnp.asarray(6.0))
    np.testing.assert_allclose(load.found, [np.pi / 2, 3 * np.pi / 2], atol=1e-9)


def test_dataclasses_replace_builds_a_load_anew():
    load = fx.loads.Custom(jnp.sin, [np.pi / 2]).prepared(jnp.asarray(3.0))
    other = dataclasses.replace(load, fn=jnp.cos)
    assert other.fn is jnp.cos
    assert other.found is None
    assert other.listed.tolist() == load.replace(fn=jnp.cos).listed.tolist()
    moved = dataclasses.replace(load, turning_points=[1.0])
    assert moved.listed.tolist() == [1.0]
    with pytest.raises(ValueError, match=r"load\.fn = 3"):
        dataclasses.replace(load, fn=3.0)
