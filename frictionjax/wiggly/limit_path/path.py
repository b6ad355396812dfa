"""The path that the strip's edges prescribe: where, when and how fast the tip must slide.

Lanes measure from it and start by it; what they find does not depend on it, since brackets
and known starts decide which values are accepted.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int, Shaped

from ..._compile import Program, in_chunks
from ...loads import AbstractPull
from ...model import SETTINGS as MODEL_SETTINGS
from ...model import TabulatedScene, strips_at
from ...numerics import find_root
from ...supports import AbstractSupport


class Probes(NamedTuple):
    """Where the speed of the path has been looked at on each piece, P pieces.

    `times` (P, n): s, those of the steepest places of the path among them; `speeds` (P, n):
    m/s. `unseen` (P,): by how much a polynomial through a few nodes misses them, relative.
    """

    times: Float[np.ndarray, "pieces n"]
    speeds: Float[np.ndarray, "pieces n"]
    unseen: Float[np.ndarray, " pieces"]


NO_PROBES = Probes(np.zeros((0, 0)), np.zeros((0, 0)), np.zeros(0))


class Path(NamedTuple):
    """Pieces between turning points of the load, P of them, as NumPy arrays.

    `edges` (P+1,): times in s. `states` (P+1,): of the path, in m. `direction` (P,): 1, -1
    or 0 where the path rests. `touch` (P,): time at which a slide begins, the piece's end
    where none does. `travel` (P+1,): way so far, in m. `rho` (P,): force of friction in N
    on the slide. `rho_plus`, `rho_minus`: in N. `speed`, `stiffness`: largest speed of
    slides in m/s, smallest Phi''. `pulled`: what the load goes up and down in all, N.
    `probes`: speeds on the way.
    """

    edges: Float[np.ndarray, " edges"]
    states: Float[np.ndarray, " edges"]
    direction: Shaped[np.ndarray, " pieces"]
    touch: Float[np.ndarray, " pieces"]
    travel: Float[np.ndarray, " edges"]
    rho: Float[np.ndarray, " pieces"]
    rho_plus: float
    rho_minus: float
    speed: float = 0.0
    stiffness: float = 1.0
    pulled: float = 0.0
    probes: Probes = NO_PROBES

    @property
    def width(self) -> float:
        """`rho_plus - rho_minus` in N: times eps, the energy of one slip."""
        return self.rho_plus - self.rho_minus

    def piece_of(self, times: Float[np.ndarray, "*shape"]) -> Int[np.ndarray, "*shape"]:
        """Index of the piece that holds each time; a turning point opens its piece."""
        found = np.searchsorted(self.edges, times, side="right") - 1
        return np.clip(found, 0, self.direction.size - 1)


@Program
def _rates(
    load: AbstractPull,
    support: AbstractSupport,
    times: Float[Array, " n"],
    states: Float[Array, " n"],
):
    """l' in N/s at the times and Phi'' in N/m at the states."""
    return jax.vmap(load.slope)(times), jax.vmap(support.stiffness_at)(states)


@Program
def _times_at(load: AbstractPull, support: AbstractSupport, states, rho, early, late):
    """Time in [early, late] at which the edge that belongs to `rho` is at each state."""
    load = jax.vmap(load)
    wanted = jax.vmap(support.force)(states) + rho
    rising = jnp.where(load(late) >= load(early), 1.0, -1.0)
    return (find_root(lambda t: rising * (load(t) - wanted), early, late),)


@Program
def _state_under(
    load: AbstractPull,
    support: AbstractSupport,
    times: Float[Array, " n"],
    pull: Float[Array, " n"],
):
    return (jax.vmap(support.state_of)(jax.vmap(load)(times) - pull),)


def times_at(
    scene: TabulatedScene,
    path: Path,
    piece: Int[np.ndarray, " n"],
    states: Float[np.ndarray, " n"],
) -> Float[np.ndarray, " n"]:
    """When the path is at each state, on the slide of each piece."""
    if states.size == 0:
        return states
    columns = states, path.rho[piece], path.touch[piece], path.edges[piece + 1]
    (found,) = in_chunks(
        _times_at, MODEL_SETTINGS.times, (scene.load, scene.support), columns
    )
    return np.clip(found, columns[2], columns[3])


def arrivals_at(
    scene: TabulatedScene,
    states: Float[np.ndarray, " n"],
    pull: Float[np.ndarray, " n"],
    early: Float[np.ndarray, " n"],
    late: Float[np.ndarray, " n"],
) -> Float[np.ndarray, " n"]:
    """Time in [early, late] at which `l - Phi'` is `pull` (N) at each state."""
    columns = states, pull, early, late
    return in_chunks(_times_at, MODEL_SETTINGS.times, (scene.load, scene.support), columns)[
        0
    ]


def state_under(
    scene: TabulatedScene, times: Float[np.ndarray, " n"], pull: Float[np.ndarray, " n"]
) -> Float[np.ndarray, " n"]:
    """State in m at which `l - Phi'` is `pull` (N) at each time."""
    return in_chunks(
        _state_under, MODEL_SETTINGS.times, (scene.load, scene.support), (times, pull)
    )[0]


def states_at(
    scene: TabulatedScene, path: Path, times: Float[np.ndarray, " n"]
) -> Float[np.ndarray, " n"]:
    """The path's state in m at each time."""
    piece = path.piece_of(times)
    _, lower, upper = strips_at(scene, path.rho_plus, path.rho_minus, times)
    edge = np.where(path.direction[piece] > 0, lower, upper)
    slides = (path.direction[piece] != 0) & (times > path.touch[piece])
    ends = np.sort(np.stack([path.states[piece], path.states[piece + 1]]), axis=0)
    return np.where(slides, np.clip(edge, *ends), path.states[piece])


def slopes_at(
    scene: TabulatedScene,
    path: Path,
    times: Float[np.ndarray, " n"],
    states: Float[np.ndarray, " n"],
) -> Float[np.ndarray, " n"]:
    """The path's speed in m/s at each time, from the right at kinks."""
    if times.size == 0:
        return times
    piece = path.piece_of(times)
    slides = (path.direction[piece] != 0) & (times > path.touch[piece])
    slope, stiffness = in_chunks(
        _rates, MODEL_SETTINGS.times, (scene.load, scene.support), (times, states)
    )
    return np.where(slides, slope / stiffness, 0.0)


def speeds_at(
    scene: TabulatedScene, path: Path, times: Float[np.ndarray, "*shape"]
) -> Float[np.ndarray, "*shape"]:
    """The path's speed in m/s at times of any shape."""
    flat = times.ravel()
    return slopes_at(scene, path, flat, states_at(scene, path, flat)).reshape(times.shape)


def stiffness_at(
    scene: TabulatedScene, states: Float[np.ndarray, " n"]
) -> Float[np.ndarray, " n"]:
    """Phi'' in N/m at states (n,) in m."""
    return in_chunks(
        _rates,
        MODEL_SETTINGS.times,
        (scene.load, scene.support),
        (np.zeros_like(states), states),
    )[1]
