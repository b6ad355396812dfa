"""Waves between the multiples of a frequency: is the period a multiple of that wave's?"""

import numpy as np

from .settings import SETTINGS


def subharmonics_stand_out(
    x: np.ndarray, heights: np.ndarray, period: float, multiple: int, harmonics: int
) -> bool:
    """Whether `multiple` of these periods repeat, and one alone does not (F test).

    Waves of frequencies `(k + j/multiple)/period` have more energy than waves that are as
    long and whole waves of the trace (n,), or of the rows (rows, n), away from them: noise,
    or what does not repeat, has as much in both, waviness in those on either side more.
    Rows count as one, as neighbours share what is wrong with them: so noise of 60% of the
    heights does not hide waves of 0.2 and 0.4 beside 1 (in 60 rows of 120 samples), noise
    of 100% does.
    """
    count = np.ptp(x) / period
    lines = np.arange(1, multiple) / multiple
    beside = _beside(lines, count)
    if not beside.size:
        return False
    known = _waves(x, np.arange(1, harmonics + 1) / period)
    basis, _ = np.linalg.qr(
        np.concatenate([np.stack([np.ones_like(x), x - x.mean()]), known]).T
    )
    rows = np.atleast_2d(heights)
    left = rows - (rows @ basis) @ basis.T
    found, others = (
        np.mean([_energies(x, left, basis, s, period, harmonics) for s in shifts], axis=0)
        for shifts in (lines, beside)
    )
    # Waves that have most of the energy count: of white noise all, of waviness the longest.
    waves = 2 * np.sum(others) ** 2 / np.sum(others**2)
    ratio = np.sum(found) / np.sum(others)
    from scipy.special import fdtrc  # for measured surfaces only

    freedom = waves * lines.size, waves * beside.size
    return bool(fdtrc(*freedom, ratio) < SETTINGS.by_chance)


def _beside(lines: np.ndarray, count: float) -> np.ndarray:
    """Shifts a whole number of waves in the trace away from `lines` and from 0 and 1."""
    away = np.arange(1, int(count) + 1) / count
    every = np.concatenate([lines[0] - away, lines[-1] + away])
    gap = 0.9 / count
    every = every[(every > gap) & (every < 1 - gap)]
    return every[np.all(np.abs(every[:, None] - lines) > gap, axis=1)][: SETTINGS.controls]


def _waves(x: np.ndarray, frequencies: np.ndarray) -> np.ndarray:
    phases = 2 * np.pi * np.outer(frequencies, x)
    return np.concatenate([np.cos(phases), np.sin(phases)])


def _energies(x, left, basis, shift: float, period: float, harmonics: int) -> np.ndarray:
    """Of each wave at this shift, the mean over rows, without what `basis` explains."""
    phases = _waves(x, (np.arange(harmonics) + shift) / period).T
    own, _ = np.linalg.qr(phases - basis @ (basis.T @ phases))
    powers = np.mean((left @ own) ** 2, axis=0)
    return powers[:harmonics] + powers[harmonics:]
