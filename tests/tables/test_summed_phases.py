"""Sums of one function's copies as pieces."""

import numpy as np

import frictionjax as fx
from frictionjax.tables import (
    PiecewiseProfile,
    TipStates,
    profile_kinks,
    profile_tables,
    summed_in_pieces,
)

CORNERS = fx.profiles.Polyline([0.0, 0.7], [0.0, 0.05], radius=0.01)


def waves(y):
    """A function that leans: `f = sin(2 pi y)` at the state `Y = y + 0.1 sin(2 pi y)`."""
    sine, cosine, turn = np.sin(2 * np.pi * y), np.cos(2 * np.pi * y), 2 * np.pi
    stretch = 1 + 0.1 * turn * cosine
    slope = turn * cosine / stretch
    rise = -(turn**2) * sine / stretch + slope * 0.1 * turn**2 * sine / stretch
    return TipStates(y + 0.1 * sine, stretch, sine, slope, rise / stretch)


def test_pieces_of_a_sum_are_the_sum():
    offsets, weights = np.array([0.0, 0.4, 1.4]), np.array([1.0, 2.0, 0.5])
    found = summed_in_pieces(waves, np.zeros(0), offsets, weights, 256)
    y = np.linspace(0, 1, 501)
    for offset, weight in ((0.0, 1.0), (0.4, 2.5)):
        alone = summed_in_pieces(waves, np.zeros(0), offsets[:1], weights[:1], 256)
        place = y + 0.1 * np.sin(2 * np.pi * y)
        np.testing.assert_allclose(alone(place), np.sin(2 * np.pi * y), atol=1e-11)
        found_without = np.asarray(found(place - offset))
        other = 2.5 if offset == 0.0 else 1.0
        apart = 0.4 if offset == 0.0 else 0.0
        rest = other * np.asarray(alone(place - offset + apart))
        exact = weight * np.sin(2 * np.pi * y) + rest
        np.testing.assert_allclose(found_without, exact, atol=1e-10)


def test_no_room_is_no_table():
    kinks = np.arange(100) / 100
    assert summed_in_pieces(waves, kinks, np.arange(400) / 400, np.ones(400), 256) is None


def test_kinks_are_the_ends_of_corners_and_those_of_heights():
    table = profile_tables(CORNERS).planning
    width = np.asarray(CORNERS.corners().width)
    ends = np.array([0.0, 0.7])[:, None] + 0.5 * width[:, None] * [-1, 1]
    np.testing.assert_allclose(
        profile_kinks(table), np.sort(ends.ravel() % 1.0), atol=1e-15
    )
    heights = 0.02 * np.sin(2 * np.pi * np.arange(12) / 12) ** 3
    spline = profile_tables(fx.profiles.Spline(heights)).planning
    assert set(profile_kinks(spline)) <= set(np.arange(12) / 12)


def test_a_series_in_pieces_has_no_kinks():
    n = np.arange(1, 41)
    table = profile_tables(fx.profiles.Fourier(0.01 / n**2, 0.0 / n)).planning
    assert isinstance(table, PiecewiseProfile)
    assert profile_kinks(table).size == 0
