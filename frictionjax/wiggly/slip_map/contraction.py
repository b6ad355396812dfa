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
_STEPS = np.diff(GRID)
_THIN_STEPS = np.diff(GRID[:: SETTINGS.thin])
LAG_FORCES = np.logspace(*SETTINGS.lag_forces)


class Wells(NamedTuple):
    """The way through a well, from fold to fold, shape (wells, grid).

    `gaps`: force in N below the fold's. `stretch`: `G`. `folds` (wells,): how many are
    nearly as high. `second` (wells,): by how much in N the next one is lower, at
    least; infinite where there is none.
    """

    gaps: Any
    stretch: Any
    folds: Any
    second: Any

    def thinned(self) -> "Wells":
        """Every third point: integrals to about a percent."""
        every = slice(None, None, SETTINGS.thin)
        thin = {"gaps": self.gaps[:, every], "stretch": self.stretch[:, every]}
        return self._replace(**thin)

    def passages(self, forces: np.ndarray) -> np.ndarray:
        """`int_0^1 dY/(f + rho - V')` for forces f beyond the fold, an upper bound.

        `forces`: shape (wells, n), and so the result. The grid is graded towards the
        extreme fold; others that are nearly as high may each hide as much again, so the
        integral is multiplied by their number.
        """
        rate = self.stretch[:, None] / (forces[..., None] + self.gaps[:, None])
        steps = _STEPS if rate.shape[-1] == GRID.size else _THIN_STEPS
        whole = 0.5 * (rate[..., 1:] + rate[..., :-1]) @ steps
        return self.folds[:, None] * whole


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
    return in_chunks(_wells, SETTINGS.wells_together, (potential,), columns)


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
    both = np.repeat(np.maximum(drag, 1e-300)[..., None, :], 2, axis=-2)
    cells = rows_of(wells, np.tile(np.arange(wells.folds.size), drag[..., 0].size))
    found = _needed(cells, np.log(both.ravel()))
    return SteadyLags._make(each.reshape(both.shape) for each in found)


def _needed(wells: Wells, wanted: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The force at which each speed, a logarithm, is reached: between two of `LAG_FORCES`.

    And the power of the speed that it grows with there.

    By halving on a thinned grid, then by steps on the whole one: 2 to 4 integrals where
    halving alone took 9, and the whole table has 85.
    """
    low = _below(wells.thinned(), wanted)
    while True:
        slow, fast = _speeds(wells, low), _speeds(wells, low + 1)
        shift = ((fast <= wanted) & (low < LAG_FORCES.size - 2)).astype(int)
        shift -= (slow > wanted) & (low > 0)
        if not shift.any():
            break
        low = low + shift
    logs, rise = np.log(LAG_FORCES), np.maximum(fast - slow, 1e-300)
    share, step = np.clip((wanted - slow) / rise, 0.0, 1.0), logs[low + 1] - logs[low]
    return np.exp(logs[low] + share * step), step / rise


def _speeds(wells: Wells, index: np.ndarray) -> np.ndarray:
    """Logarithms of speeds under some of `LAG_FORCES`, one for each well."""
    return -np.log(wells.passages(LAG_FORCES[index][:, None])[:, 0])


def _below(wells: Wells, wanted: np.ndarray) -> np.ndarray:
    """Index of the last force under which slides are not faster, by halving."""
    low = np.zeros(wanted.size, dtype=int)
    high = np.full(wanted.size, LAG_FORCES.size - 1)
    while np.any(high - low > 1):
        middle = (low + high) // 2
        below = _speeds(wells, middle) <= wanted
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.minimum(low, LAG_FORCES.size - 2)
