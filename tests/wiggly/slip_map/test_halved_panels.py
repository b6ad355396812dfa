"""Panels halved until the time of a passage is known, however narrow a corner is."""

import numpy as np
import pytest

from frictionjax.wiggly.slip_map.gauss import GAUSS_NODES, GAUSS_WEIGHTS
from frictionjax.wiggly.slip_map.halved_panels import halved_panels
from frictionjax.wiggly.slip_map.settings import SETTINGS

ALLOWED = np.array([1e-5, 4e-5])
EXCESS = np.array([[1e-3, 0.03], [1e-4, 3e-3]])


def steps(starts, width, height=0.1):
    """A force that falls by `height` evenly over a corner, and is back at the end."""

    def gaps(cell, shares):
        rise = np.clip((shares - np.asarray(starts)[cell][:, None]) / width, 0.0, 1.0)
        back = np.clip((shares - 0.8) / width, 0.0, 1.0)
        return height * (rise - back)

    return gaps


def exact(start, width, excess, height=0.1):
    corner = width / height * np.log(1 + height / excess)
    lower, higher = start + 0.2 - width, 0.8 - start - width
    return lower / excess + higher / (excess + height) + 2 * corner


@pytest.mark.parametrize("width", [0.05, 1e-3, 1e-5, 1e-12])
@pytest.mark.parametrize("starts", [(0.3, 0.61), (0.0, 0.5), (0.25, 1e-4)])
def test_passages_are_known_to_what_is_allowed(starts, width):
    """A corner where the way starts, or a panel does, lies before the first node."""
    gaps = steps(starts, width)
    left, size = halved_panels(gaps, EXCESS, ALLOWED)
    assert left.shape[1] in SETTINGS.halved_sizes
    np.testing.assert_allclose(left[:, 1:], (left + size)[:, :-1], atol=1e-15)
    for cell, start in enumerate(starts):
        shares = left[cell][:, None] + 0.5 * size[cell][:, None] * (GAUSS_NODES + 1)
        held = gaps(np.full(len(shares), cell), shares)
        for excess, allowed in zip(EXCESS[cell], ALLOWED, strict=True):
            time = np.sum(0.5 * size[cell][:, None] * GAUSS_WEIGHTS / (excess + held))
            assert time == pytest.approx(exact(start, width, excess), rel=3 * allowed)


def test_more_panels_than_there_may_be_are_none():
    """Two hundred corners."""

    def comb(cell, shares):
        return 0.1 * (np.floor(200 * shares) % 2)

    assert halved_panels(comb, EXCESS, ALLOWED) is None
