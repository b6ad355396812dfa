"""When a slide has passed its first wells."""

import numpy as np

from ..potentials import AbstractPotential
from .forgetting import FORCES, from_fold_to_fold

_GRID = np.concatenate([np.logspace(-9, 0, 400), np.linspace(1.05, 25.0, 480)])


def first_wells(
    potential: AbstractPotential,
    eps: np.ndarray,
    fold: np.ndarray,
    side: float,
    viscosity: np.ndarray,
    rate: float,
    stiffness: float,
    wells: float,
) -> np.ndarray:
    """Seconds from the touch of the strip's edge until about `wells` are behind the tip.

    The slow equation averaged over a well, `X' = l' - Phi'' v(X)` for the force X beyond
    the fold, on a grid that nears the steady X like 1 - exp(-u). Of cells, shape (C,):
    `eps`, `fold`, tip coordinates of the extreme fold, and `viscosity`, eps^gamma. Of all:
    `rate`, l' in N/s; `stiffness`, Phi'' in N/m.
    """
    well = from_fold_to_fold(potential, eps, fold, np.full(eps.size, side)).thinned()
    passages = well.passages(np.tile(FORCES, (eps.size, 1)))
    speeds = -np.log(viscosity[:, None] * passages)
    columns = zip(eps, speeds, strict=True)
    return np.array([_wait(e, own, rate, stiffness, wells) for e, own in columns])


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
