"""Sums over slides from a few of their slip periods."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frictionjax.wiggly.survey import RESIDUAL, VISCOUS, WORK, nodes_of, surveys_of

LOW, HIGH, COUNT, PERIOD = 1.0, 3.0, 17, 1e-3


def survey(density):
    """A slide whose sums of one period have this density at its middle, (3, n)."""
    starts = nodes_of(LOW, HIGH - PERIOD, COUNT)
    sums = PERIOD * density(starts + 0.5 * PERIOD)
    ends, extremes = starts + PERIOD, np.zeros((1, 4, COUNT))
    parts = (a[None] for a in (starts, ends, sums))
    return surveys_of(np.array([LOW]), np.array([HIGH]), *parts, extremes)[0]


def test_smooth_sums_are_integrals_of_their_density():
    found = survey(lambda t: np.stack([np.exp(t), np.cos(t), 0 * t + 2.0]))
    times = np.linspace(LOW, HIGH, 41)
    done = found.integrals(times)
    assert_allclose(done[WORK], np.exp(times) - np.exp(LOW), rtol=1e-9, atol=1e-9)
    assert_allclose(done[VISCOUS], np.sin(times) - np.sin(LOW), rtol=1e-9, atol=1e-9)
    assert_allclose(done[RESIDUAL], 2.0 * (times - LOW), rtol=1e-12)
    assert_allclose(done[:, -1], found.whole, rtol=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_what_is_left_of_the_balance_is_never_negative(seed):
    """What steps leave of a period depends on where they fall: it is rough."""
    rough = np.random.default_rng(seed).exponential(size=COUNT) ** 3
    found = survey(lambda t: np.stack([t, t, rough]))
    done = found.integrals(np.linspace(LOW, HIGH, 301))[RESIDUAL]
    assert done[0] == 0
    assert np.all(np.diff(done) >= 0)
    assert done[-1] == found.whole[RESIDUAL]
    assert rough.min() < done[-1] / (HIGH - LOW) < rough.max()
