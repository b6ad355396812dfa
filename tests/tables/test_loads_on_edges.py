"""Loads of all classes as one."""

import equinox as eqx
import jax
import numpy as np
import pytest
from at_places import at_places
from loads_known import LOADS, L, T, shapes, with_slopes

from frictionjax.model import known_turning_points, padded_edges
from frictionjax.tables import (
    load_on_edges,
    load_table,
)


def on_edges(load, duration=3.0):
    load = load.prepared(duration)
    turns = known_turning_points(load, duration, 64)
    return load_on_edges(load_table(load), padded_edges(turns, duration))


@pytest.mark.parametrize("name", LOADS)
def test_lines_between_edges_are_the_load_with_its_slopes_from_the_right(name):
    load, found = LOADS[name], on_edges(LOADS[name])
    times = np.concatenate([T, found.edges, np.nextafter(found.edges, 9.0)])
    (values, slopes), expected = with_slopes(found, times), with_slopes(load, times)
    size = np.abs(expected[0]).max()
    np.testing.assert_allclose(values, expected[0], atol=4e-15 * max(size, 1.0))
    np.testing.assert_allclose(slopes, expected[1], rtol=1e-14, atol=1e-14)
    count = found.edges.size - 1
    assert found.turning_count(3.0) == count
    expected = eqx.filter_jit(load.turning_points)(np.asarray(3.0), count)
    np.testing.assert_array_equal(found.turning_points(3.0, count), expected)


def test_lines_between_edges_are_of_one_kind_whatever_the_load():
    kinds = {shapes(on_edges(LOADS[name])) for name in LOADS if name != "many points"}
    assert len(kinds) == 1


def test_functions_stay_functions_between_edges_and_their_steepest_times_known():
    load = L.Custom(lambda t: jax.numpy.sin(2 * t)).prepared(3.0)
    found = on_edges(load)
    np.testing.assert_allclose(at_places(found, T), np.sin(2 * T), atol=1e-15)
    assert found.steepest == load.steepest
    assert on_edges(LOADS["sine"]).steepest is None


def test_many_edges_are_searched_not_compared_with_the_same_values():
    load = L.Triangle(1.3, 0.01)
    turns = known_turning_points(load, 3.0, 1024)
    found = load_on_edges(load_table(load), padded_edges(turns, 3.0))
    assert found.edges.size > 512
    np.testing.assert_allclose(at_places(found, T), at_places(load, T), atol=1e-12)
