"""Pieces that are found by bins."""

import equinox as eqx
import numpy as np
import pytest

from frictionjax.tables import SETTINGS
from frictionjax.tables.pieces import Pieces, piecewise


def steps(left):
    """Each piece the constant of its number."""
    left = np.asarray(left)
    return Pieces(left, np.arange(left.size, dtype=float)[:, None])


@eqx.filter_jit
def found(table, y):
    return table(y)


@pytest.mark.parametrize("count", [1, 2, 3, 50, 500])
def test_every_place_is_in_its_piece(count):
    rng = np.random.default_rng(count)
    pitch = 4096 // count
    places = pitch * np.arange(count) + rng.integers(0, pitch // 2, count)
    left = np.append(0, places[1:]) / 4096  # exact, a period on too
    table = piecewise(steps(left), 256)
    assert table is not None
    # Of one length, whatever the count: one program.
    y = np.concatenate([left, left + 3, rng.uniform(0, 1, 2000 - 2 * count)])
    expected = np.searchsorted(left, y, side="right") - 1
    expected[count : 2 * count] = np.arange(count)
    np.testing.assert_array_equal(found(table, y), expected)


def test_too_many_pieces_and_too_short_ones_have_no_table():
    assert piecewise(steps(np.arange(5000) / 5000), 256) is None
    close = 0.3 + 1e-6 * np.arange(SETTINGS.few + 2)
    assert piecewise(steps(np.append(0.0, close)), 256) is None


def test_samples_a_period_come_in_few_sizes():
    assert piecewise(steps([0.0]), 300).points == 1024
    assert piecewise(steps([0.0]), 256).points == 256
