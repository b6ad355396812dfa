"""When a slide has passed its first wells."""

import numpy as np

from ..potentials import AbstractPotential
from .forgetting import FORCES, from_fold_to_fold

_GRID = np.concatenate([np.logspace(-9, 0, 400), np.linspace(1.05, 25.0, 480)])


def first_wells(
    potential: AbstractPotential,
    eps: np.ndarray,
    fold: np.ndarray,
    side: np.ndarray,
    viscosity: np.ndarray,
    rate: np.ndarray,
    stiffness: np.ndarray,
    wells: float,
) -> np.ndarray:
    """Seconds from the touch of the strip's edge until about `wells` are behind the tip.

    The slow equation averaged over a well, `X' = l' - Phi'' v(X)` for the force X beyond
    the fold, on a grid that nears the steady X like 1 - exp(-u). Of slides, shape (n,):
    `eps`, `fold`, tip coordinates of the extreme fold, `side`, 1 or -1, `viscosity`,
    eps^gamma, `rate`, l' in N/s, not 0, and `stiffness`, Phi'' in N/m.
    """
    sides = np.stack([eps, side])
    _, first, which = np.unique(sides, axis=1, return_index=True, return_inverse=True)
    one = from_fold_to_fold(potential, eps[first], fold[first], side[first]).thinned()
    passages = one.passages(np.tile(FORCES, (first.size, 1)))[which]
    speeds = -np.log(viscosity[:, None] * passages)
    columns = zip(eps, speeds, rate, stiffness, strict=True)
    return np.array([_wait(*slide, wells) for slide in columns])


def _wait(eps: float, speeds: np.ndarray, rate: float, stiffness: float, wells: float):
    """The same of one cell, whose logarithms of speeds belong to `FORCES`."""
    logs = np.log(FORCES)
    steady = np.interp(np.log(rate / stiffness), speeds, logs)
    share = -np.expm1(-_GRID)
    pace = np.exp(np.interp(steady + np.log(share), logs, speeds))
    gain = np.maximum(rate - stiffness * pace, 1e-12 * rate)
    step = np.diff(_GRID, prepend=0.0) * np.exp(steady - _GRID) / gain
    passed = np.cumsum(step * pace / eps)
    return np.interp(wells, passed, np.cumsum(step))
