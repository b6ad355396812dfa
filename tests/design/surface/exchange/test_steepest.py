"""The steepest and the least bent surface within bounds, by exchange."""

import numpy as np
import pytest

from frictionjax.design.surface.exchange import (
    SurfaceBounds,
    extrema,
    least_bent_within,
    steepest_surface,
)


@pytest.mark.parametrize("harmonics", [1, 2])
def test_the_steepest_of_one_wave_is_in_closed_form(harmonics):
    """`w = h/2 sin`: slopes pi h, and 1/(2 pi R) where |w''| is 1/R at most."""
    high = SurfaceBounds(1, 1.0, 1.0, np.inf, 0.1)
    assert np.isclose(steepest_surface(high).share, 0.1 * np.pi, rtol=1e-4)
    sharp = SurfaceBounds(harmonics, 1.0, 1.0, 2.0, np.inf)
    found = steepest_surface(sharp)
    assert found.share >= (1 - 1e-4) / np.pi
    assert found.place > 0.45


def test_the_steepest_has_its_lowest_slope_where_that_is_best():
    """Half a period away 4 waves that rise by 0.005 reach 0.867 of these slopes."""
    slope = 0.0482
    bounds = SurfaceBounds(4, 0.0408 / slope, 0.0556 / slope, np.inf, 0.005 / slope)
    found = steepest_surface(bounds)
    assert 1.003 < found.share < 1.02
    assert abs(found.place - 0.5) > 0.1


def test_next_to_the_largest_ratio_of_slopes_the_share_is_known():
    """There the lowest slope is at the places of Fejer's kernel: "0 of the slopes"."""
    found = steepest_surface(SurfaceBounds(4, 1.0, 0.25 * (1 + 1e-7), np.inf, 0.05))
    assert 0.2 < found.share < 1


def test_the_least_bent_of_one_wave_is_that_wave_or_none():
    """Slopes of 1 rise by 1/pi in a period, whose |w''| is 2 pi at most."""
    found = least_bent_within(SurfaceBounds(1, 1.0, 1.0, 6.3, 0.32))
    slopes, bends, heights = (values for _, values in extrema(found.waves))
    assert np.allclose([slopes.max(), slopes.min()], [1.0, -1.0], rtol=1e-6)
    assert np.isclose(bends.max(), 2 * np.pi, rtol=1e-6)
    assert np.isclose(np.ptp(heights), 1 / np.pi, rtol=1e-6)
    assert found.bound <= found.waves @ found.waves * (1 + 1e-9)
    assert least_bent_within(SurfaceBounds(1, 1.0, 1.0, 6.3, 0.31)) is None
    assert least_bent_within(SurfaceBounds(1, 1.0, 1.0, 6.2, 0.32)) is None
