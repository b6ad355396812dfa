"""Waves between the multiples of the strongest one's frequency."""

import numpy as np
import pytest

from frictionjax.profiles import find_period
from frictionjax.profiles.subharmonics import subharmonics_stand_out

PERIOD = 1e-5


def grooves(rows, samples, periods, seed, weak=0.2):
    """The strongest wave is the second; noise of 60% of the heights."""
    rng = np.random.default_rng(seed)
    x = np.arange(samples) * periods * PERIOD / samples
    turns = 2 * np.pi * x / PERIOD
    others = weak * (np.sin(turns) + 2 * np.sin(3 * turns + 1))
    clean = np.sin(2 * turns + 0.3) + others
    noise = 0.6 * clean.std() * rng.standard_normal((rows, samples))
    return x, 1e-7 * (clean + noise)


@pytest.mark.parametrize(("rows", "samples", "periods"), [(60, 120, 4), (1, 900, 30)])
def test_noise_does_not_hide_a_period_of_two_of_its_waves(rows, samples, periods):
    """They explain a third of what is left: many sigmas, but not the half of it."""
    found = find_period(*grooves(rows, samples, periods, 0), 4)
    assert found == pytest.approx(PERIOD, rel=1e-2)


def test_what_does_not_repeat_is_no_longer_period():
    """White noise, and waviness that is a random walk, strongest at the longest waves."""
    for seed in range(20):
        x, heights = grooves(1, 120, 4, seed, weak=0.0)
        assert not subharmonics_stand_out(x, heights, PERIOD / 2, 2, 4)
        walk = np.cumsum(np.random.default_rng(seed).standard_normal(120))
        assert not subharmonics_stand_out(x, heights + 2e-8 * walk, PERIOD / 2, 2, 4)


def test_too_few_waves_in_the_trace_say_nothing():
    x, heights = grooves(1, 120, 4, 0)
    assert not subharmonics_stand_out(x, heights, 4 * PERIOD, 2, 4)
