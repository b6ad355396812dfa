"""The wiggly force over a period of z as cubics between even places."""

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..model import AbstractPotential
from .potential_samples import sampled_potential
from .settings import SETTINGS

_HALFWAY = np.array((1.0, 0.5, 0.25, 0.125))  # powers of u


class ForceTable(NamedTuple):
    """`V_eps'` in N at one eps: on cell i of `cells`, with u in [0, 1] inside it,
    `c0 + u (c1 + u (c2 + u c3))`, the rows of `cubics` (4, cells).

    A path takes millions of steps, each with one force. From the table it costs the same
    for any bristle and any surface, in a program that knows neither; steps are in z, where
    noise is additive, so that no drift has to be added for the tip's own coordinate, and
    the tip need not be found. (A Newton step for the tip, from the last one, takes three
    evaluations of profile and bristle, and more where noise throws it over half a period.)
    """

    cubics: Float[Array, "4 cells"]

    def force(self, z: Float[Array, "*z"], eps: Array) -> Float[Array, "*z"]:
        """`V_eps'(z)` in N; z and eps in m."""
        cells = self.cubics.shape[1]
        place = z / eps
        place = cells * (place - jnp.floor(place))
        cell = jnp.minimum(place.astype(int), cells - 1)
        u = place - cell
        c0, c1, c2, c3 = (row[cell] for row in self.cubics)
        return c0 + u * (c1 + u * (c2 + u * c3))


class TabulatedForce(NamedTuple):
    """A table, its largest error at other places (N), and the extremes of the force (N)
    and of `V_eps''` (N/m) over a period."""

    table: ForceTable
    error: float
    lowest: float
    highest: float
    curvature: float


def tabulated_force(potential: AbstractPotential, eps: float) -> TabulatedForce:
    """With as many cells as the error asks for; it is measured in their middles.

    Where a surface is only C^2 the error falls slowly, and the table ends with the most
    cells that there may be: 1e-5 of the force, in one cell of 65,536, for an edge of 90
    degrees in `V_eps''`.
    """
    cells = SETTINGS.table_nodes
    places = np.arange(cells) / cells
    _, nodes = sampled_potential(potential, eps, places)
    while True:
        _, middles = sampled_potential(potential, eps, places + 0.5 / cells)
        cubics = _cubics(nodes)
        error = np.max(np.abs(_HALFWAY @ cubics - middles))
        nodes = np.stack([nodes, middles], axis=1).ravel()  # twice as many
        largest = np.max(np.abs(nodes))
        if error <= SETTINGS.table_error * largest or cells >= SETTINGS.most_nodes:
            break
        cells *= 2
        places = np.arange(cells) / cells
    steepest = 2 * cells / eps * float(np.max(np.diff(nodes, append=nodes[:1])))
    lowest, highest = float(nodes.min()), float(nodes.max())
    return TabulatedForce(
        ForceTable(jnp.asarray(cubics)), float(error), lowest, highest, steepest
    )


def _cubics(nodes: Float[np.ndarray, " cells"]) -> Float[np.ndarray, "4 cells"]:
    """Hermite's, slopes by differences of order 4."""
    near = np.roll(nodes, -1) - np.roll(nodes, 1)
    far = np.roll(nodes, -2) - np.roll(nodes, 2)
    slope = (8 * near - far) / 12
    rise, after = np.roll(nodes, -1) - nodes, np.roll(slope, -1)
    return np.stack([nodes, slope, 3 * rise - 2 * slope - after, slope + after - 2 * rise])
