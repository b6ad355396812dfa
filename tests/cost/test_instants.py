"""Which instants lie inside a slip, and the times around them."""

import numpy as np

from frictionjax.cost.instants import Instants

TS = np.array([0.0, 1.0, 2.0, 3.0])
NOTHING = np.zeros(0)


def instants_of(shift: float = 0.1) -> Instants:
    return Instants(TS, np.arange(4), NOTHING, np.full(4, shift))


def test_times_around_stay_within_the_scene_and_find_their_way_back():
    ts, back = instants_of().around(3.0)
    assert np.all(np.diff(ts) >= 0)
    assert (ts[0], ts[-1]) == (0.0, 3.0)
    np.testing.assert_allclose(ts[back][0], [0.0, 0.9, 1.9, 2.9])
    np.testing.assert_array_equal(ts[back][1], TS)
    np.testing.assert_allclose(ts[back][2], [0.1, 1.1, 2.1, 3.0])


def test_one_side_stands_for_both_where_the_scene_begins_or_ends():
    """The same speed is a slip, or none, at all instants alike."""
    eps = 1e-3
    for speed, expected in ((0.2 * eps, False), (0.3 * eps, True)):
        ts, back = instants_of().around(3.0)
        around = speed * ts[back]
        found = instants_of().in_slip(around, eps, 3.0)
        assert np.all(found == expected), speed


def test_batches_of_states_are_taken():
    ts, back = instants_of().around(3.0)
    speeds = np.array([0.1, 1.0])[:, None, None]
    found = instants_of().in_slip(speeds * ts[back], 1.0, 3.0)
    np.testing.assert_array_equal(found, [[False] * 4, [True] * 4])
