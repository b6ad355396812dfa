"""How far the tip can lag behind the strip's edge on a slide."""

import jax
import numpy as np
from jaxtyping import Array, Float

from ..arguments import Real
from ..potentials import AbstractPotential
from ..programs import Program
from .tolerance import Folds

# Half of the grid over a well, graded towards the fold by e-folds that resolve folds down
# to 1e-13 of a period.
_GRADED = np.expm1(30.0 * np.linspace(0.0, 1.0, 1024)) / np.expm1(30.0)
_GRID = 0.5 * np.concatenate([-_GRADED[:0:-1], _GRADED])
FORCES = np.logspace(-24, 4, 85)


@Program
def _forces(potential: AbstractPotential, eps: Real, places: Float[Array, " n"]):
    return jax.vmap(lambda y: potential.tip_force(y, eps))(places)


def passage_integrals(
    potential: AbstractPotential, eps: float, place: float, side: float
) -> np.ndarray:
    """`int_0^1 dY/(f + rho - V')` for each force f beyond the fold, an upper bound.

    The grid is graded towards the extreme fold; others that are nearly as high may each
    hide as much again, so the integral is multiplied by their number.
    """
    scan = np.arange(potential.points) / potential.points
    force, stretch = _forces(
        potential, np.asarray(eps), np.concatenate([place + _GRID, scan])
    )
    force, stretch = side * np.asarray(force), np.asarray(stretch)[: _GRID.size]
    heights, top = force[_GRID.size :], force[_GRID.size // 2]
    bump = (heights >= np.roll(heights, 1)) & (heights > np.roll(heights, -1))
    near = bump & (heights > heights.max() - 0.05 * np.ptp(heights))
    gaps = np.maximum(top - force[: _GRID.size], 0.0)
    integrals = np.trapezoid(stretch / (FORCES[:, None] + gaps), _GRID, axis=1)
    return max(int(near.sum()), 1) * integrals


def lag_forces(
    potential: AbstractPotential, eps: float, folds: Folds, drag: np.ndarray
) -> list[np.ndarray]:
    """Force in N beyond the fold that a steady slide needs, at most: right and left.

    `drag`: eps^gamma times the speed of the slide, in N, any shape. From the slow equation
    averaged over a well, `v = eps^-gamma / int_0^1 dY/(f + rho - W')`.
    """
    wanted = np.log(np.maximum(drag, 1e-300))
    found = []
    for place, side in ((folds.place_plus, 1.0), (folds.place_minus, -1.0)):
        speeds = -np.log(passage_integrals(potential, eps, float(place), side))
        found.append(np.exp(np.interp(wanted, speeds, np.log(FORCES))))
    return found
