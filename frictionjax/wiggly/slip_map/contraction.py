"""How far the tip can lag behind the strip's edge on a slide."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..._checks import Real
from ..._compile import Program, in_chunks
from ...model import AbstractPotential
from ...numerics import rows_of
from ..equation import WiggleFolds
from .settings import SETTINGS

# Half of the grid over a well, graded towards the fold.
_EVEN = np.linspace(0.0, 1.0, SETTINGS.half_grid)
_GRADED = np.expm1(SETTINGS.e_folds * _EVEN) / np.expm1(SETTINGS.e_folds)
GRID = 0.5 * np.concatenate([-_GRADED[:0:-1], _GRADED])
_WEIGHTS = 0.5 * np.convolve(np.diff(GRID), np.ones(2))  # of trapezia
LAG_FORCES = np.logspace(*SETTINGS.lag_forces)


class Wells(NamedTuple):
    """The way through a well, from fold to fold, shape (wells, grid).

    `gaps`: force in N below the fold's. `stretch`: `G`. `folds` (wells,): how many are
    nearly as high. `second` (wells,): by how much in N the next one is lower, at
    least; infinite where there is none. `speeds` (wells, forces): logarithms of wells a
    second, times the viscosity, under `LAG_FORCES` beyond the fold.
    """

    gaps: Any
    stretch: Any
    folds: Any
    second: Any
    speeds: Any = None


@Program
def _wells(
    potential: AbstractPotential,
    eps: Float[Array, " wells"],
    place: Float[Array, " wells"],
    side: Float[Array, " wells"],
) -> Wells:
    scan = np.arange(potential.points) / potential.points
    force_at = jax.vmap(potential.tip_force, in_axes=(0, None))

    def one(eps: Real, place: Real, side: Real) -> Wells:
        forces, stretch = force_at(jnp.concatenate([place + GRID, scan]), eps)
        way, heights = jnp.split(side * forces, [GRID.size])
        bump = (heights >= jnp.roll(heights, 1)) & (heights > jnp.roll(heights, -1))
        least = heights.max() - SETTINGS.as_high * jnp.ptp(heights)
        tops = jnp.sort(jnp.where(bump, heights, -jnp.inf))
        top = way[GRID.size // 2]
        second = top - tops[-2] - SETTINGS.missed * jnp.ptp(heights)
        return Wells(
            gaps=jnp.maximum(top - way, 0.0),
            stretch=stretch[: GRID.size],
            folds=jnp.maximum(jnp.sum(bump & (heights > least)), 1),
            second=jnp.maximum(second, 0.0),
        )

    return jax.vmap(one)(eps, place, side)


def from_fold_to_fold(
    potential: AbstractPotential, eps: np.ndarray, place: np.ndarray, side: np.ndarray
) -> Wells:
    """Wells at each eps from the extreme fold `place`, right (`side` 1) or left (-1)."""
    columns = eps, place, side
    wells = in_chunks(_wells, SETTINGS.wells_together, (potential,), columns)
    return wells._replace(speeds=_speeds(wells))


def _speeds(wells: Wells) -> np.ndarray:
    """Logarithms of 1/`int_0^1 dY/(f + rho - V')` for `LAG_FORCES` f: lower bounds.

    The grid is graded towards the extreme fold; others that are nearly as high may each
    hide as much again, so the integral is multiplied by their number.
    """
    passages = [(wells.stretch / (f + wells.gaps)) @ _WEIGHTS for f in LAG_FORCES]
    return -np.log(wells.folds[:, None] * np.stack(passages, axis=1))


class SteadyLags(NamedTuple):
    """Steady slides of cells, to the right (row 0) and the left (1), shape (..., 2, cells).

    `force`: in N beyond the fold, at most. `power`: of the speed that it grows with, at
    this speed: slides remember so many times the wells that they lag by.
    """

    force: np.ndarray
    power: np.ndarray


def wells_both_ways(
    potential: AbstractPotential, eps: np.ndarray, folds: WiggleFolds
) -> Wells:
    """Of cells, from fold to fold: to the right, then to the left, 2 rows a cell."""
    # Once for each eps; of the largest for all, cells would depend on their neighbours.
    own, first, which = np.unique(eps, return_index=True, return_inverse=True)
    places = [np.asarray(v)[first] for v in (folds.place_plus, folds.place_minus)]
    sides = np.repeat([1.0, -1.0], own.size)
    wells = from_fold_to_fold(potential, np.tile(own, 2), np.concatenate(places), sides)
    return rows_of(wells, np.concatenate([which, which + own.size]))


def steady_lags(wells: Wells, drag: np.ndarray) -> SteadyLags:
    """What steady slides need; `drag`: eps^gamma times their speed, in N, (..., cells).

    From the slow equation averaged over a well,
    `v = eps^-gamma / int_0^1 dY/(f + rho - W')`. `wells`: of the cells, both ways.
    """
    wanted = np.log(np.maximum(drag, 1e-300))[..., None, :]
    rows = wells.speeds.reshape(2, -1, LAG_FORCES.size)
    below = np.count_nonzero(rows <= wanted[..., None], axis=-1) - 1
    low = np.clip(below, 0, LAG_FORCES.size - 2)
    rows = np.broadcast_to(rows, (*low.shape, LAG_FORCES.size))
    slow, fast = (np.take_along_axis(rows, low[..., None] + k, -1)[..., 0] for k in (0, 1))
    logs, rise = np.log(LAG_FORCES), np.maximum(fast - slow, 1e-300)
    share, step = np.clip((wanted - slow) / rise, 0.0, 1.0), logs[low + 1] - logs[low]
    return SteadyLags(np.exp(logs[low] + share * step), step / rise)
