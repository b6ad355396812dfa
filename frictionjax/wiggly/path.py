"""The path that the strip's edges prescribe: where, when and how fast the tip must slide.

Lanes measure from it and start by it; what they find does not depend on it, since brackets
and known starts decide which values are accepted.
"""

from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..coefficients import coefficients_jit
from ..loads import AbstractLoad
from ..loads.steep import steep_times
from ..programs import Program, in_chunks
from ..roots import find_root
from ..scene import Scene
from ..strip import CHUNK, strips_at
from .probes import NO_PROBES, Probes, nodes_inside, unseen_of

_PIECES = 16  # of the load, in a compiled call


class Path(NamedTuple):
    """Pieces between turning points of the load, P of them, as NumPy arrays.

    `edges` (P+1,): times in s. `states` (P+1,): of the path, in m. `direction` (P,): 1, -1
    or 0 where the path rests. `touch` (P,): time at which a slide begins, the piece's end
    where none does. `travel` (P+1,): way so far, in m. `rho` (P,): force of friction in N
    on the slide. `rho_plus`, `rho_minus`: in N. `speed`, `stiffness`: largest speed of
    slides in m/s, smallest Phi''. `probes`: speeds on the way.
    """

    edges: np.ndarray
    states: np.ndarray
    direction: np.ndarray
    touch: np.ndarray
    travel: np.ndarray
    rho: np.ndarray
    rho_plus: float
    rho_minus: float
    speed: float = 0.0
    stiffness: float = 1.0
    probes: Probes = NO_PROBES

    @property
    def width(self) -> float:
        """`rho_plus - rho_minus` in N: times eps, the energy of one slip."""
        return self.rho_plus - self.rho_minus

    def piece_of(self, times: np.ndarray) -> np.ndarray:
        """Index of the piece that holds each time; a turning point opens its piece."""
        found = np.searchsorted(self.edges, times, side="right") - 1
        return np.clip(found, 0, self.direction.size - 1)


@Program
def _turns(scene: Scene) -> Array:
    return scene.turning_points()


@Program
def _rates(scene: Scene, times: Float[Array, " n"], states: Float[Array, " n"]):
    """l' in N/s at the times and Phi'' in N/m at the states."""
    slopes = jax.vmap(scene.load.slope)(times)
    return slopes, jax.vmap(scene.support.stiffness_at)(states)


@Program
def _times_at(scene: Scene, states, rho, early, late):
    """Time in [early, late] at which the edge that belongs to `rho` is at each state."""
    load = jax.vmap(scene.load)
    wanted = jax.vmap(scene.support.force)(states) + rho
    rising = jnp.where(load(late) >= load(early), 1.0, -1.0)
    return (find_root(lambda t: rising * (load(t) - wanted), early, late),)


@Program
def _state_under(scene: Scene, times: Float[Array, " n"], pull: Float[Array, " n"]):
    loads = jax.vmap(scene.load)(times)
    return (jax.vmap(scene.support.state_of)(loads - pull),)


def times_at(scene: Scene, path: Path, piece: np.ndarray, states: np.ndarray) -> np.ndarray:
    """When the path is at each state, on the slide of each piece."""
    if states.size == 0:
        return states
    columns = states, path.rho[piece], path.touch[piece], path.edges[piece + 1]
    (found,) = in_chunks(_times_at, CHUNK, (scene,), columns)
    return np.clip(found, columns[2], columns[3])


def arrivals_at(
    scene: Scene, states: np.ndarray, pull: np.ndarray, early: np.ndarray, late: np.ndarray
) -> np.ndarray:
    """Time in [early, late] at which `l - Phi'` is `pull` (N) at each state."""
    columns = states, pull, early, late
    return in_chunks(_times_at, CHUNK, (scene,), columns)[0]


def state_under(scene: Scene, times: np.ndarray, pull: np.ndarray) -> np.ndarray:
    """State in m at which `l - Phi'` is `pull` (N) at each time."""
    return in_chunks(_state_under, CHUNK, (scene,), (times, pull))[0]


def states_at(scene: Scene, path: Path, times: np.ndarray) -> np.ndarray:
    """The path's state in m at each time."""
    piece = path.piece_of(times)
    _, lower, upper = strips_at(scene, path.rho_plus, path.rho_minus, times)
    edge = np.where(path.direction[piece] > 0, lower, upper)
    slides = (path.direction[piece] != 0) & (times > path.touch[piece])
    ends = np.sort(np.stack([path.states[piece], path.states[piece + 1]]), axis=0)
    return np.where(slides, np.clip(edge, *ends), path.states[piece])


def slopes_at(
    scene: Scene, path: Path, times: np.ndarray, states: np.ndarray
) -> np.ndarray:
    """The path's speed in m/s at each time, from the right at kinks."""
    if times.size == 0:
        return times
    piece = path.piece_of(times)
    slides = (path.direction[piece] != 0) & (times > path.touch[piece])
    slope, stiffness = in_chunks(_rates, CHUNK, (scene,), (times, states))
    return np.where(slides, slope / stiffness, 0.0)


@Program
def _steep_times(load: AbstractLoad, start: Float[Array, " n"], end: Float[Array, " n"]):
    return jax.vmap(partial(steep_times, load))(start, end)


def speeds_at(scene: Scene, path: Path, times: np.ndarray) -> np.ndarray:
    """The path's speed in m/s at times of any shape."""
    flat = times.ravel()
    return slopes_at(scene, path, flat, states_at(scene, path, flat)).reshape(times.shape)


def _looked_at(scene: Scene, path: Path) -> Path:
    """With the largest speed on slides, sampled, and the smallest stiffness there."""
    ends = path.touch, path.edges[1:]
    steep = in_chunks(_steep_times, _PIECES, (scene.load,), ends)
    times = np.concatenate([steep, nodes_inside(*ends)], axis=1)
    flat = times.ravel()
    states = states_at(scene, path, flat)
    speeds = slopes_at(scene, path, flat, states).reshape(times.shape)
    _, stiffness = in_chunks(_rates, CHUNK, (scene,), (flat, states))
    seen, known = speeds[:, : steep.shape[1]], speeds[:, steep.shape[1] :]
    unseen = unseen_of(*ends, known, steep, seen)
    return path._replace(
        speed=float(np.max(np.abs(speeds))),
        stiffness=float(np.min(stiffness)),
        probes=Probes(steep, seen, np.where(path.direction == 0, 0.0, unseen)),
    )


def path_of(scene: Scene) -> Path | None:
    """The path of a scene; None where the load turns more often than there is room for."""
    turns = np.asarray(_turns(scene))
    duration = float(scene.duration)
    if np.any(np.isnan(turns)):
        return None
    edges = np.unique(np.concatenate([[0.0], turns[turns < duration], [duration]]))
    found = coefficients_jit(scene.potential)
    rho_plus, rho_minus = float(found.rho_plus), float(found.rho_minus)
    _, lower, upper = strips_at(scene, rho_plus, rho_minus, edges)
    states = np.empty(edges.size)
    states[0] = np.clip(float(scene.z0), lower[0], upper[0])
    for i in range(1, edges.size):
        states[i] = np.clip(states[i - 1], lower[i], upper[i])
    moves = np.diff(states)
    direction = np.sign(moves)
    rho = np.where(direction > 0, rho_plus, rho_minus)
    path = Path(
        edges=edges,
        states=states,
        direction=direction,
        touch=np.where(direction == 0, edges[1:], edges[:-1]),
        travel=np.concatenate([[0.0], np.cumsum(np.abs(moves))]),
        rho=rho,
        rho_plus=rho_plus,
        rho_minus=rho_minus,
    )
    sliding = np.flatnonzero(direction)
    touch = path.touch.copy()
    touch[sliding] = times_at(scene, path, sliding, states[sliding])
    return _looked_at(scene, path._replace(touch=touch))
