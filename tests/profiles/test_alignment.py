"""Rows moved into phase by all of their harmonics."""

import numpy as np
import pytest

import frictionjax as fx
from frictionjax.profiles.alignment import moved, shifts_into_phase, variance_of_shift

SHAPE = np.array([-0.1j, 1.0 * np.exp(0.3j), 0.4 * np.exp(1.0j), 0.0])
TURNS = 0.37 + 0.0123 * np.arange(60)


def rows_of(noise, seed=0):
    rng = np.random.default_rng(seed)
    both = rng.standard_normal((2, TURNS.size, SHAPE.size))
    return moved(np.tile(SHAPE, (TURNS.size, 1)), -TURNS) + noise * (both[0] + 1j * both[1])


def test_clean_rows_come_back_to_rounding():
    mean = moved(rows_of(0.0), shifts_into_phase(list(rows_of(0.0)))).mean(axis=0)
    assert mean[0].imag == pytest.approx(0, abs=1e-13)
    np.testing.assert_allclose(mean, moved(SHAPE[None], np.array([-0.25]))[0], atol=1e-12)


@pytest.mark.parametrize("seed", range(3))
def test_a_fundamental_in_noise_smears_no_other_wave(seed):
    """By its phase alone the other two lost a fifth and a half."""
    rows = rows_of(0.03, seed)
    shifts = shifts_into_phase(list(rows))
    mean = moved(rows, shifts).mean(axis=0)
    np.testing.assert_allclose(np.abs(mean[1:3]), np.abs(SHAPE[1:3]), rtol=0.02)
    off = (shifts - TURNS + 0.5) % 1 - 0.5
    error = np.sqrt(variance_of_shift(SHAPE, np.full(4, 0.03)))
    assert 0.7 * error < np.std(off) < 1.4 * error


def test_one_series_has_a_positive_fundamental():
    (shift,) = shifts_into_phase([SHAPE])
    assert moved(SHAPE[None], np.array([shift]))[0, 0] == pytest.approx(0.1)


def test_stated_slopes_hold_of_a_map_with_a_weak_fundamental():
    """They were 25% low, and said 11%."""
    period, n = 1e-5, np.arange(1, 4)
    x = np.arange(120) * 4 * period / 120
    waves = np.exp(2j * np.pi * np.outer(n, x / period))
    clean = 1e-7 * np.real(moved(rows_of(0.0), np.zeros(60))[:, :3] @ waves)
    turns = 2j * np.pi * n
    y = np.arange(4096) / 4096
    steepest = 1e-2 * np.max(np.real((SHAPE[:3] * turns) @ np.exp(np.outer(turns, y))))
    for seed in range(4):
        noise = 0.3 * clean.std() * np.random.default_rng(seed).standard_normal(clean.shape)
        surface = fx.measured.Measured(x, clean + noise)
        slopes = fx.measured.fit_profile(surface, period, 4).slopes
        assert abs(slopes.omega_plus - steepest) < slopes.error_plus
        assert slopes.error_plus < 0.08 * steepest


def test_what_noise_takes_off_the_mean_is_in_its_error():
    """Of the second of two waves, more than what 200 rows leave of the noise."""
    x = np.arange(64) / 16
    heights = np.sin(2 * np.pi * x) + 0.5 * np.sin(4 * np.pi * x)
    rng = np.random.default_rng(0)
    noisy = heights + 1.5 * rng.standard_normal((200, 64))
    fits = fx.profiles.fit_rows_in_phase(x, noisy, 1.0, 2)
    noise = np.mean([fit.waves.noise for fit in fits], axis=0)
    mean = fx.profiles.fourier.fit_map(x, noisy, 1.0, 2).waves
    variance = variance_of_shift(mean.c[:2], noise[:2])
    lost = -np.expm1(-0.5 * (4 * np.pi) ** 2 * variance) * np.abs(mean.c[1])
    assert lost > 1.5 * noise[1] / np.sqrt(200)
    assert lost < mean.noise[1] < 1.5 * lost
