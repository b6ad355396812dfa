"""Which requested times share a bracket."""

import numpy as np
import pytest
from paths import path_of

import frictionjax as fx
from frictionjax.wiggly.enclosure import requested_times

SCENE = fx.Scene(
    fx.profiles.Sine(0.1),
    fx.bristles.VerticalSpring(1.0, 2.0, 1.0),
    fx.supports.Spring(1.0),
    fx.loads.PiecewiseLinear([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 1.0, 0.0]),
    3.0,
)


@pytest.mark.parametrize(
    ("late", "sizes"),
    [
        ([], [1, 3, 3]),  # the slide's time alone; rests, of two cells
        ([1], [1, 1, 2, 3]),  # a fast slide goes on into the first cell's rest
        ([1, 2, 3], [1, 1, 1, 1, 3]),
    ],
)
def test_times_of_a_rest_share_a_bracket_unless_tips_still_slide(late, sizes):
    """One bracket of such a rest took 5e6 steps."""
    path = path_of(SCENE)
    times = np.array([0.9, 1.2, 1.4, 1.6, 1.2, 1.4, 1.6])
    cell = np.array([0, 0, 0, 0, 1, 1, 1])
    assert (path.piece_of(times[1:]) == path.piece_of(times[1:2])).all()
    begin = times.copy()
    begin[[0, *late]] -= 1e-3  # their periods
    order, found = requested_times._rests_together(path, cell, times, begin)
    assert found.tolist() == sizes
    assert sorted(order.tolist()) == list(range(7))
    assert (np.diff(cell[order]) >= 0).all()
