"""When a slide has passed its first wells."""

import numpy as np

from ...model import AbstractPotential
from .contraction import LAG_FORCES, from_fold_to_fold
from .settings import SETTINGS

_GRID = np.concatenate([np.logspace(*SETTINGS.sets_off), np.linspace(*SETTINGS.goes_on)])


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
    passages = one.passages(np.tile(LAG_FORCES, (first.size, 1)))[which]
    speeds = -np.log(viscosity[:, None] * passages)
    return _waits(eps, speeds, rate, stiffness, wells)


def _waits(eps, speeds, rate, stiffness, wells: float) -> np.ndarray:
    """The same of slides whose logarithms of speeds, (n, forces), are at `LAG_FORCES`."""
    logs, wanted = np.log(LAG_FORCES), np.log(rate / stiffness)
    rows = zip(wanted, speeds, strict=True)
    steady = np.array([np.interp(speed, row, logs) for speed, row in rows])
    pace = np.exp(_between(speeds, steady[:, None] + np.log(-np.expm1(-_GRID))))
    gain = rate[:, None] - stiffness[:, None] * pace
    gain = np.maximum(gain, 1e-12 * rate[:, None])
    step = np.diff(_GRID, prepend=0.0) * np.exp(steady[:, None] - _GRID) / gain
    passed, time = np.cumsum(step * pace / eps[:, None], axis=1), np.cumsum(step, axis=1)
    pairs = zip(passed, time, strict=True)
    return np.array([np.interp(wells, way, since) for way, since in pairs])


def _between(rows: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Linear between a row's values at the logarithms of `LAG_FORCES`: even steps."""
    first, pitch = np.log(LAG_FORCES[0]), np.log(LAG_FORCES[1] / LAG_FORCES[0])
    place = np.clip((at - first) / pitch, 0.0, LAG_FORCES.size - 1.0)
    left = np.minimum(place.astype(int), LAG_FORCES.size - 2)
    low = np.take_along_axis(rows, left, axis=1)
    rise = np.take_along_axis(rows, left + 1, axis=1) - low
    return low + (place - left) * rise
