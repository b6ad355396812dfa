"""Profiles as tables: exact to rounding, a few classes of a few sizes."""

import gc
import weakref

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from at_places import at_places, each_at_places, relative_errors

import frictionjax as fx
from frictionjax.tables import PiecewiseProfile, Waves, profile_tables

P = fx.profiles
RNG = np.random.default_rng(5)
Y = np.concatenate([RNG.uniform(-3, 3, 500), [0.0, 0.25, 0.5, 1.0, -1.0, 0.75]])


def series(harmonics):
    sizes = 0.02 / np.arange(1, harmonics + 1) ** 2
    return P.Fourier(RNG.normal(size=harmonics) * sizes, RNG.normal(size=harmonics) * sizes)


def smooth(y):
    return 0.02 * jnp.exp(jnp.sin(2 * jnp.pi * y)) + 0.01 * jnp.cos(6 * jnp.pi * y)


PROFILES = {
    "sine": P.Sine(0.3),
    "one harmonic": series(1),
    "three": series(3),
    "eight": series(8),
    "nine": series(9),
    "sixty": series(60),
    "spline": P.Spline(0.02 * np.sin(2 * np.pi * np.arange(7) / 7 + 0.3)),
    "long spline": P.Spline(0.02 * np.sin(2 * np.pi * np.arange(150) / 150)),
    "polyline": P.Polyline([0.1, 0.3, 0.75], [0.0, 0.05, 0.01], 0.01),
    "from zero": P.Polyline([0.0, 0.3, 0.75], [0.0, 0.05, 0.01], 0.02),
    "function": P.Custom(smooth),
}


@pytest.mark.parametrize("name", PROFILES)
def test_tables_are_the_profile_to_rounding(name):
    tables = profile_tables(PROFILES[name])
    assert tables.is_table
    for table in (tables.lanes, tables.planning):
        # Slopes carry the rounding of samples times the highest harmonic in use, and of
        # long splines that of differences, as in the profile itself.
        rough = name in ("function", "long spline")
        worst = [2e-14, 1e-13, 2e-12] if rough else [2e-14, 3e-14, 1e-13]
        assert np.all(relative_errors(PROFILES[name], table, Y) <= worst)


def shapes(table):
    return type(table), *(np.shape(leaf) for leaf in jax.tree_util.tree_leaves(table))


def test_few_classes_and_sizes_stand_for_all():
    lanes = {shapes(profile_tables(p).lanes) for p in PROFILES.values()}
    planning = {shapes(profile_tables(p).planning) for p in PROFILES.values()}
    assert len(lanes) == 4  # 4 and 8 harmonics; pieces of degree 4 and 8
    assert len(planning) == 4  # 4 and 8 as an axis; pieces as in lanes
    assert isinstance(profile_tables(series(3)).planning, Waves)
    assert shapes(profile_tables(series(3)).lanes) == shapes(
        profile_tables(PROFILES["sine"]).lanes
    )
    assert isinstance(profile_tables(PROFILES["nine"]).planning, PiecewiseProfile)
    assert profile_tables(PROFILES["nine"]).planning.points == 1024
    assert isinstance(profile_tables(PROFILES["spline"]).lanes, PiecewiseProfile)


def test_the_height_is_that_of_the_samples():
    for name in ("sine", "spline", "polyline", "function"):
        profile = PROFILES[name]
        places = np.arange(profile.points) / profile.points
        expected = float(np.abs(jax.jit(jax.vmap(profile))(places)).max())
        assert profile_tables(profile).height == pytest.approx(expected, rel=1e-14)


def test_a_mean_height_is_kept():
    raised = P.Custom(lambda y: 0.3 + 0.02 * jnp.sin(2 * jnp.pi * y))
    table = profile_tables(raised).lanes
    assert at_places(table, np.array([0.25]))[0] == pytest.approx(0.32, rel=1e-14)


@pytest.mark.parametrize(
    "fn",
    [
        lambda y: 0.02 * jnp.abs(jnp.sin(2 * jnp.pi * (y - 0.1))) ** 2.5,
        lambda y: 0.02 * jnp.sin(2 * jnp.pi * y) + 1e-6 * jnp.sin(2 * jnp.pi * 255 * y),
    ],
    ids=["no third derivative", "a wave between the samples"],
)
def test_what_no_table_meets_stays_itself(fn):
    profile = P.Custom(fn, points=4096)
    tables = profile_tables(profile)
    assert not tables.is_table
    assert tables.lanes is profile


@pytest.mark.parametrize("wide", [3e-3, 1e-3, 3e-4])
@pytest.mark.parametrize("at", [0.37123, 0.70031])
def test_a_bump_beside_a_sine_is_not_stepped_over(wide, at):
    """Down to the narrowest that 4096 samples resolve: a narrower one is refused.

    Tables have the widest; the others stay what they are, which is told.
    """

    def fn(y):
        bump = jnp.exp(-(((y - at) / wide) ** 2))
        return 0.02 * jnp.sin(2 * jnp.pi * y) + 0.1 * wide * bump

    profile = P.Custom(fn)
    assert profile_tables(profile).is_table == (wide == 3e-3)
    y = at + wide * np.linspace(-3, 3, 201)
    found, expected = each_at_places((profile_tables(profile).lanes, profile), y)
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-15)


@pytest.mark.parametrize("power", [3.0, 2.5])
def test_what_is_known_of_a_profile_does_not_keep_it_alive(power):
    gc.freeze()  # what was there before need not be looked through: 2 s
    profile = P.Custom(lambda y: 0.02 * jnp.abs(jnp.sin(2 * jnp.pi * (y - 0.1))) ** power)
    assert profile_tables(profile).is_table == (power == 3.0)
    assert profile_tables(profile).height == pytest.approx(0.02, rel=1e-5)
    gone = weakref.ref(profile)
    del profile
    gc.collect()
    gc.unfreeze()
    assert gone() is None


def test_more_harmonics_than_any_size_have_one_of_their_own():
    table = profile_tables(series(100)).lanes
    assert table.cos.shape == (100,)
