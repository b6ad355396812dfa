"""Bristles as power series."""

import equinox as eqx
import jax
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.tables import (
    SeriesBristle,
    bristle_at_rest,
    bristle_series,
    in_one_size,
)

BRISTLES = {
    "vertical": fx.bristles.VerticalSpring(1.0, 1.3, 1.0),
    "slanted": fx.bristles.SlantedSpring(1.0, 1.3, 1.0, 0.5),
    "angular": fx.bristles.AngularSpring(1.0, 1.3, 1.0, 0.1),
    "homothetic": fx.bristles.Homothetic(2.0),
    "own": fx.bristles.Custom(lambda e: 0.2 * e + e**2, lambda e: 3 * e + e**3),
}


def slopes(bristle, etas):
    return np.stack(_slopes(bristle, etas))


@eqx.filter_jit
def _slopes(bristle, etas):
    return [jax.vmap(jax.grad(fn))(etas) for fn in (bristle.offset, bristle.energy)]


@eqx.filter_jit
def with_slopes(bristle, eta):
    return bristle.with_slopes(eta)


@pytest.mark.parametrize("name", BRISTLES)
@pytest.mark.parametrize("highest", [3e-2, 1e-2, 1e-7])
def test_the_series_is_the_bristle_to_rounding(name, highest):
    found = bristle_series(BRISTLES[name], highest)
    assert isinstance(found, SeriesBristle)
    etas = np.linspace(-highest, highest, 41)
    expected = slopes(BRISTLES[name], etas)
    size = np.abs(expected).max(axis=1, keepdims=True) + 1e-300
    assert np.max(np.abs(slopes(found, etas) - expected) / size) < 4e-14


@pytest.mark.parametrize("name", ["vertical", "slanted"])
def test_of_a_line_a_line_is_left(name):
    """In a table of degree 4, at whatever height it was found."""
    for highest in (1e-2, 3e-4):
        found = bristle_series(BRISTLES[name], highest)
        assert found.ahead.shape == found.climb.shape == (5,)
        assert not np.any([found.ahead[2:], found.climb[2:]])


@pytest.mark.parametrize("name", ["slanted", "angular", "own"])
def test_slopes_are_those_of_offset_and_energy(name):
    eta = 3e-3
    for bristle in (BRISTLES[name], bristle_series(BRISTLES[name], 1e-2)):
        offset, *rest = with_slopes(bristle, np.asarray(eta))
        assert float(offset) == pytest.approx(float(bristle.offset(eta)), rel=1e-15)
        np.testing.assert_allclose(rest, slopes(bristle, np.array([eta]))[:, 0], 4e-15)


def test_near_its_reach_a_bristle_stays_itself():
    angular = BRISTLES["angular"]
    assert bristle_series(angular, 0.29) is angular
    assert bristle_series(angular, 5.0) is angular


@pytest.mark.parametrize("name", BRISTLES)
def test_at_rest_two_numbers_are_left(name):
    found, zero = bristle_at_rest(BRISTLES[name]), np.zeros(1)
    np.testing.assert_allclose(
        slopes(found, zero), slopes(BRISTLES[name], zero), rtol=4e-16, atol=0
    )
    assert found.ahead.shape == (1,)


def test_a_rod_is_one_where_it_is_asked_for():
    rod = BRISTLES["angular"]
    found = bristle_series(rod, 1e-2, with_rods=True)
    for eta in (-8e-3, 0.0, 5e-3):
        np.testing.assert_allclose(found.rod(eta), rod.rod(eta), rtol=1e-13)
    assert bristle_series(rod, 1e-2).rod(0.0) is None
    assert bristle_series(BRISTLES["slanted"], 1e-2, with_rods=True).rods is None


def test_series_of_one_size_have_the_same_bits():
    etas = np.linspace(-1e-2, 1e-2, 41)
    sizes = set()
    for bristle in BRISTLES.values():
        series = bristle_series(bristle, 1e-2)
        found = in_one_size(series)
        sizes.add(found.ahead.shape + found.climb.shape)
        np.testing.assert_array_equal(slopes(found, etas), slopes(series, etas))
    assert sizes == {(13, 13)}
    assert in_one_size(BRISTLES["angular"]) is BRISTLES["angular"]
