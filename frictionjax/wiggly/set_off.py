"""When a slide has passed its first wells."""

import numpy as np

from ..potentials import AbstractPotential
from .forgetting import FORCES, from_fold_to_fold

_GRID = np.concatenate([np.logspace(-9, 0, 400), np.linspace(1.05, 25.0, 480)])


def first_wells(
    potential: AbstractPotential,
    eps: float,
    fold: float,
    side: float,
    viscosity: float,
    rate: float,
    stiffness: float,
    wells: float,
) -> float:
    """Seconds from the touch of the strip's edge until about `wells` are behind the tip.

    The slow equation averaged over a well, `X' = l' - Phi'' v(X)` for the force X beyond
    the fold, on a grid that nears the steady X like 1 - exp(-u). `fold`: tip coordinate of
    the extreme fold; `viscosity`: eps^gamma; `rate`: l' in N/s; `stiffness`: Phi'', N/m.
    """
    well = from_fold_to_fold(potential, *(np.array([v]) for v in (eps, fold, side)))
    speeds = -np.log(viscosity * well.passages(FORCES[None])[0])

    def speed(force: np.ndarray) -> np.ndarray:
        return np.exp(np.interp(np.log(force), np.log(FORCES), speeds))

    steady = float(np.exp(np.interp(np.log(rate / stiffness), speeds, np.log(FORCES))))
    share = -np.expm1(-_GRID)
    pace = speed(steady * share)
    gain = np.maximum(rate - stiffness * pace, 1e-12 * rate)
    seconds = steady * np.exp(-_GRID) / gain
    step = np.diff(_GRID, prepend=0.0)
    times = np.cumsum(step * seconds)
    passed = np.cumsum(step * seconds * pace / eps)
    return float(np.interp(wells, passed, times))
