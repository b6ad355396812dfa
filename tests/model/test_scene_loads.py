"""Where loads turn, in rooms of a few sizes."""

import equinox as eqx
import numpy as np
import pytest

import frictionjax as fx
from frictionjax.model import known_turning_points, padded_edges


@pytest.mark.parametrize(
    "load",
    [
        fx.loads.Sine(1.0, 0.3),
        fx.loads.PiecewiseLinear([0.2, 0.9, 2.1], [0.0, 1.0, -1.0]),
        fx.loads.Custom(lambda t: (t - 1) ** 2).prepared(2.0),
        fx.loads.Ramp(1.0),
    ],
    ids=["sine", "points", "function", "ramp"],
)
def test_they_are_those_of_the_load(load):
    expected = np.asarray(eqx.filter_jit(load.turning_points)(np.asarray(2.0), 16))
    found = known_turning_points(load, 2.0, 16)
    np.testing.assert_allclose(found, expected[expected < 2.0], rtol=1e-15)


def test_too_small_a_room_is_told():
    assert np.all(np.isnan(known_turning_points(fx.loads.Sine(1.0, 0.01), 2.0, 4)))


@pytest.mark.parametrize(
    ("turns", "room"), [(0, 8), (6, 8), (7, 32), (100, 128), (2100, 4096)]
)
def test_edges_fill_their_room_with_the_end(turns, room):
    times = np.linspace(0.1, 1.9, turns)
    edges = padded_edges(times, 2.0)
    assert edges.size == room
    np.testing.assert_array_equal(edges[: turns + 2], [0.0, *times, 2.0])
    assert np.all(edges[turns + 2 :] == 2.0)
