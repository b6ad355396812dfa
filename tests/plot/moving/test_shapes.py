"""Coils that can be told from blots."""

import numpy as np
import pytest

from frictionjax.plot.moving.shapes import coil, turns_within

START = np.array([1.5, 1.0])
WIDTH = 0.12


@pytest.mark.parametrize("length", [0.002, 0.05, 0.13, 0.5, 3.0])
def test_turns_of_a_coil_are_no_closer_than_it_is_wide_or_so(length):
    turns = turns_within(length, WIDTH)
    end = START + np.array([length, 0.0])
    points = coil(START, end, WIDTH, turns)
    np.testing.assert_allclose(points[:, [0, -1]].T, [START, end])
    wide = float(np.ptp(points[1]))
    assert wide <= min(WIDTH, 1.3 * length / turns) + 1e-12
    assert (turns == 7) == (length >= 0.7)


def test_a_coil_of_no_length_is_a_point():
    points = coil(START, START, WIDTH)
    np.testing.assert_array_equal(points, np.broadcast_to(START[:, None], points.shape))
