"""Distances of graphs that jump."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from frictionjax.numerics import graph_distance


def densely(times, values, speed, count=400):
    """Points on a polyline in (speed t, z), close to each other."""
    shares = np.arange(count) / count
    ends = np.stack([speed * times, values])
    legs = ends[:, :-1, None] + np.diff(ends)[:, :, None] * shares
    return np.concatenate([legs.reshape(2, -1), ends[:, -1:]], axis=1).T


def by_trees(times, first, second, speed):
    """The same from nearest points of both, in the largest of both differences."""
    points = [densely(times, values, speed) for values in (first, second)]
    pairs = ((0, 1), (1, 0))
    return max(
        float(np.max(cKDTree(points[j]).query(points[i], p=np.inf)[0])) for i, j in pairs
    )


@pytest.mark.parametrize("seed", range(8))
def test_it_is_the_distance_of_nearest_points(seed):
    draw = np.random.default_rng(seed)
    times = np.sort(draw.uniform(0, 2, 60))
    times[30:33] = times[30]  # a jump of one or both
    first = np.cumsum(draw.normal(size=60))
    second = first + draw.normal(size=60) * (draw.random(60) < 0.3)
    speed = float(draw.choice([0.1, 1.0, 20.0]))
    found = graph_distance(times, first, second, speed)
    step = 0.01 * np.max(np.abs(np.diff(first)))
    step = max(step, 0.01 * np.max(np.abs(np.diff(second))))
    # Points between vertices may be a little farther than all vertices are.
    expected = by_trees(times, first, second, speed)
    assert found <= expected + step
    assert expected <= found + 0.5 * float(np.max(np.abs(np.diff(first - second))))


def test_a_jump_that_comes_late_is_as_far_as_it_is_late():
    times = np.array([0.0, 1.0, 1.0, 1.25, 1.25, 2.0])
    early = np.array([0.0, 0.0, 1.0, 1.0, 1.0, 1.0])
    late = np.array([0.0, 0.0, 0.0, 0.0, 1.0, 1.0])
    assert graph_distance(times, early, late, 2.0) == pytest.approx(0.5, rel=1e-6)
    assert graph_distance(times, late, early, 2.0) == pytest.approx(0.5, rel=1e-6)
    # Where a second is worth much, the jump itself is what is left.
    assert graph_distance(times, early, late, 100.0) == pytest.approx(1.0, rel=1e-6)


def test_where_nothing_is_fast_it_is_the_largest_difference_within_two():
    times = np.linspace(0, 3, 3001)
    first = np.sin(times)
    second = first + 0.05 * np.cos(40 * times) * np.exp(-times)
    far = float(np.max(np.abs(first - second)))
    found = graph_distance(times, first, second, 1.0)
    assert 0.5 * far <= found <= far


def test_it_is_zero_and_not_a_number_where_curves_are():
    times = np.linspace(0, 1, 11)
    assert graph_distance(times, times, times, 1.0) == 0.0
    assert np.isnan(graph_distance(times, times, times * np.nan, 1.0))


def test_without_a_speed_it_is_the_distance_of_their_ranges():
    times = np.linspace(0, 1, 11)
    found = graph_distance(times, times, 1.3 * times[::-1], 0.0)
    assert found == pytest.approx(0.3, rel=1e-6)
