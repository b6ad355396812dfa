"""Profiles given as functions, in pieces that meet w''."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from at_places import relative_errors

import frictionjax as fx
from frictionjax.tables import PiecewiseProfile, profile_pieces, profile_tables
from frictionjax.tables.profile_pieces import profile_in_pieces

RNG = np.random.default_rng(8)


def step(x):
    """From 0 to 1, C^2."""
    x = jnp.clip(x, 0.0, 1.0)
    return x**3 * (10 - 15 * x + 6 * x**2)


def teeth(y):
    """Up to 0.3137 and down again, C^2 there and at the seam."""
    return 0.02 * jnp.where(y < 0.3137, step(y / 0.3137), step((1 - y) / (1 - 0.3137)))


def waves(y):
    """Written for one place at a time."""
    orders, heights = jnp.array([1.0, 2.0]), jnp.array([0.02, 0.01])
    return jnp.sum(heights * jnp.abs(jnp.sin(jnp.pi * orders * y)) ** 3)


# Each with the places where w'' has kinks.
FUNCTIONS = {
    "kinks at halves": (lambda y: 0.02 * jnp.abs(jnp.sin(2 * jnp.pi * y)) ** 3, [0, 0.5]),
    "kinks elsewhere": (
        lambda y: 0.02 * jnp.abs(jnp.sin(2 * jnp.pi * (y - 0.1234))) ** 3,
        [0.1234, 0.6234],
    ),
    "kinks close by": (
        lambda y: (
            0.02 * jnp.sin(2 * jnp.pi * y)
            + 1e-5 * (step((y - 0.4) / 0.002) - step((y - 0.7) / 0.2))
        ),
        [0.4, 0.402, 0.7, 0.9],
    ),
    "teeth": (teeth, [0, 0.3137]),
    "one place at a time": (waves, [0, 0.5]),
    "a bump": (lambda y: 0.02 * jnp.exp(-(((y - 0.5) / 0.01) ** 2)), []),
    "steep flanks": (lambda y: 0.02 * jnp.tanh(jnp.sin(2 * jnp.pi * y) / 0.05), []),
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_pieces_are_the_function_and_its_derivatives(name):
    fn, kinks = FUNCTIONS[name]
    profile = fx.profiles.Custom(fn)
    tables = profile_tables(profile)
    assert tables.is_table
    near = [np.mod(k + s * d, 1.0) for k in kinks for s in (-1, 1) for d in (1e-9, 1e-6)]
    places = np.concatenate([RNG.uniform(-2, 3, 2000), near])
    for table in (tables.lanes, tables.planning):
        assert np.all(relative_errors(profile, table, places) <= [4e-14, 1e-13, 1e-11])


@pytest.mark.parametrize("name", [name for name, (_, kinks) in FUNCTIONS.items() if kinks])
def test_pieces_end_at_kinks(name):
    fn, kinks = FUNCTIONS[name]
    left = np.asarray(profile_in_pieces(fx.profiles.Custom(fn)).rows[:, 0])
    for kink in kinks:
        assert np.min(np.abs(left - kink)) < 1e-10  # of a weak one, in w'' 2e-14


class KinksAt(eqx.Module):
    """Beside a sine and a level, one kink at each place; leaves, so that one trace does."""

    places: jax.Array
    level: float | jax.Array = 0.0

    def __call__(self, y):
        each = jnp.abs(jnp.sin(jnp.pi * (y[..., None] - self.places))) ** 3
        waves = 0.01 * jnp.sin(2 * jnp.pi * y) + 0.002 * jnp.sum(each, axis=-1)
        return self.level + waves


class BeginsAt(eqx.Module):
    """0 up to a place, a polynomial from there on."""

    place: jax.Array

    def __call__(self, y):
        rise = 0.5 * (y - self.place) ** 3 * (1 - y) ** 3
        return jnp.where(y < self.place, 0.0, rise)


@pytest.mark.parametrize("count", [1, 6])
def test_kinks_are_found_wherever_they_are(count):
    """The middle of the shortest piece is none: a third of six kinks had no table."""
    for places in np.random.default_rng(count).uniform(0, 1, (12, count)):
        table = profile_in_pieces(fx.profiles.Custom(KinksAt(jnp.asarray(places))))
        assert table is not None, places
        left = np.asarray(table.rows[:, 0])
        assert np.max(np.min(np.abs(left[:, None] - places), axis=0)) < 1e-10


def test_what_begins_anywhere_is_met():
    """w'' to two roundings, from one piece of half a period on, is w to 5e-14 only."""
    for begins in np.random.default_rng(0).uniform(0.1, 0.9, 12):
        profile = fx.profiles.Custom(BeginsAt(jnp.asarray(begins)))
        assert profile_in_pieces(profile) is not None, begins


@pytest.mark.parametrize("level", [0.0, -10.0, 1e4, 1e7])
def test_a_height_that_all_share_changes_nothing(level):
    """Rounding of it was taken for waves, and met as closely as all of it."""
    place = jnp.array([0.2])
    fn, profile = KinksAt(place), fx.profiles.Custom(KinksAt(place, jnp.asarray(level)))
    tables = profile_tables(profile)
    assert tables.is_table
    places = RNG.uniform(0, 1, 500)
    slopes = [jax.jit(jax.vmap(jax.grad(f)))(places) for f in (fn, tables.lanes)]
    np.testing.assert_allclose(slopes[1], slopes[0], atol=1e-13)


def test_friction_is_that_of_the_function():
    profile = fx.profiles.Custom(FUNCTIONS["kinks elsewhere"][0])
    slope = 3 * 0.02 * 2 * np.pi * (2 / 3) / np.sqrt(3)  # of 0.02 |sin|^3, largest
    found = fx.friction(profile, fx.bristles.VerticalSpring(1.0, 2.0, 1.0))
    assert found.omega_plus == pytest.approx(slope, rel=2e-14)


@pytest.mark.parametrize(
    "fn",
    [
        lambda y: 0.02 * jnp.abs(jnp.sin(2 * jnp.pi * (y - 0.1))) ** 2.5,
        lambda y: 0.02 * jnp.sin(2 * jnp.pi * y) + 1e-6 * jnp.sin(2 * jnp.pi * 255 * y),
    ],
    ids=["no third derivative", "a wave between the samples"],
)
def test_what_no_pieces_meet_has_none(fn):
    assert profile_in_pieces(fx.profiles.Custom(fn)) is None


def test_pieces_that_say_something_else_are_not_taken(monkeypatch):
    profile = fx.profiles.Custom(teeth)
    assert isinstance(profile_in_pieces(profile), PiecewiseProfile)
    made = profile_pieces.fitted_pieces

    def bent(*args):
        pieces = made(*args)
        return pieces._replace(terms=pieces.terms * (1 + 1e-9))

    monkeypatch.setattr(profile_pieces, "fitted_pieces", bent)
    assert profile_in_pieces(profile) is None
