"""The path that the strip's edges prescribe: where, when and how fast the tip must slide.

Lanes measure from it and start by it; what they find does not depend on it, since brackets
and known starts decide which values are accepted.
"""

from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int, Shaped

from ..._checks import Real
from ..._compile import Interpreted, Program, in_chunks, padded_size
from ...loads import AbstractPull
from ...model import SETTINGS as MODEL_SETTINGS
from ...model import TabulatedScene
from ...numerics import find_root
from ...supports import AbstractSupport
from ...tables import straight_part
from ..equation import PullRange
from .settings import SETTINGS


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
    on the slide. `rho_plus`, `rho_minus`: in N. `speed`: largest of slides in m/s.
    `stiffness`, `stiffest`: smallest and largest Phi'' there. `pulled`: what the load goes
    up and down in all, N. `pull`: how hard the load pulls. `probes`: speeds on the way.
    `rows` (room, 7): the pieces for compiled programs.
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
    stiffest: float = 1.0
    pulled: float = 0.0
    pull: PullRange | None = None
    probes: Probes = NO_PROBES
    rows: Float[np.ndarray, "room 7"] = np.zeros((0, 7))

    @property
    def width(self) -> float:
        """`rho_plus - rho_minus` in N: times eps, the energy of one slip."""
        return self.rho_plus - self.rho_minus

    def piece_of(self, times: Float[np.ndarray, "*shape"]) -> Int[np.ndarray, "*shape"]:
        """Index of the piece that holds each time; a turning point opens its piece."""
        found = np.searchsorted(self.edges, times, side="right") - 1
        return np.clip(found, 0, self.direction.size - 1)


class Piece(NamedTuple):
    """A row of a path's table: times in s, states and way in m, force of friction in N."""

    begin: Any
    touch: Any
    direction: Any
    state: Any
    end_state: Any
    travel: Any
    rho: Any


def rows_of_path(path: Path) -> Float[np.ndarray, "room 7"]:
    """The pieces as rows of `Piece`; those that fill the room never begin."""
    pieces = Piece(
        begin=path.edges[:-1],
        touch=path.touch,
        direction=path.direction,
        state=path.states[:-1],
        end_state=path.states[1:],
        travel=path.travel[:-1],
        rho=path.rho,
    )
    count = path.direction.size
    rows = np.full((padded_size(count, MODEL_SETTINGS.edges), len(pieces)), np.inf)
    rows[:count] = np.stack(pieces, axis=1)
    return rows


class Motion(NamedTuple):
    """The path at times (n,): states and way so far in m, speeds in m/s, Phi'' in N/m.

    `levels`, `rates`: of the straight part of the load, in N and N/s.
    """

    states: Any
    ways: Any
    speeds: Any
    stiffness: Any
    levels: Any
    rates: Any


def state_on_path(
    load: AbstractPull, support: AbstractSupport, rows: Float[Array, "room 7"], time: Real
) -> tuple[Real, Piece]:
    """State in m at a time, and the piece that holds it; traceable."""
    piece = _piece_at(rows, time)
    edge = support.state_of(load(time) - piece.rho)
    low = jnp.minimum(piece.state, piece.end_state)
    edge = jnp.clip(edge, low, jnp.maximum(piece.state, piece.end_state))
    return jnp.where(_slides(piece, time), edge, piece.state), piece


def _piece_at(rows: Float[Array, "room 7"], time: Real) -> Piece:
    few = rows.shape[0] <= SETTINGS.few_pieces
    method = "compare_all" if few else "scan_unrolled"
    index = jnp.searchsorted(rows[:, 0], time, side="right", method=method)
    return Piece(*rows[jnp.maximum(index - 1, 0)])


def _slides(piece: Piece, time: Real) -> Bool[Array, ""]:
    return (piece.direction != 0) & (time > piece.touch)


def _speed(load: AbstractPull, rows: Array, time: Real, stiffness: Real) -> Real:
    piece = _piece_at(rows, time)
    return jnp.where(_slides(piece, time), load.slope(time) / stiffness, 0.0)


@Program
def _motion(
    load: AbstractPull,
    support: AbstractSupport,
    rows: Float[Array, "room 7"],
    times: Float[Array, " n"],
    beside: Float[Array, " n"],
) -> Motion:
    def at(time: Real, other: Real) -> Motion:
        state, piece = state_on_path(load, support, rows, time)
        stiffness = support.stiffness_at(state)
        way = piece.travel + jnp.abs(state - piece.state)
        line = straight_part(load)
        return Motion(
            states=state,
            ways=way,
            speeds=_speed(load, rows, other, stiffness),
            stiffness=stiffness,
            levels=line(time),
            rates=line.slope(other),
        )

    return jax.vmap(at)(times, beside)


@Program
def _speeds(load: AbstractPull, support: AbstractSupport, rows, times, states):
    stiffness = jax.vmap(support.stiffness_at)(states)
    return (jax.vmap(partial(_speed, load, rows))(times, stiffness),)


@Program
def _times_at(load: AbstractPull, support: AbstractSupport, states, rho, early, late):
    """Time in [early, late] at which the edge that belongs to `rho` is at each state."""
    load = jax.vmap(load)
    wanted = jax.vmap(support.force)(states) + rho
    rising = jnp.where(load(late) >= load(early), 1.0, -1.0)
    return (find_root(lambda t: rising * (load(t) - wanted), early, late),)


@Interpreted
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
    early, late = path.touch[piece], path.edges[piece + 1]
    return np.clip(arrivals_at(scene, states, path.rho[piece], early, late), early, late)


def arrivals_at(
    scene: TabulatedScene,
    states: Float[np.ndarray, " n"],
    pull: Float[np.ndarray, " n"],
    early: Float[np.ndarray, " n"],
    late: Float[np.ndarray, " n"],
) -> Float[np.ndarray, " n"]:
    """Time in [early, late] at which `l - Phi'` is `pull` (N) at each state."""
    columns = states, pull, early, late
    return in_chunks(_times_at, SETTINGS.roots, (scene.load, scene.support), columns)[0]


def state_under(
    scene: TabulatedScene, times: Float[np.ndarray, " n"], pull: Float[np.ndarray, " n"]
) -> Float[np.ndarray, " n"]:
    """State in m at which `l - Phi'` is `pull` (N) at each time."""
    return in_chunks(
        _state_under, MODEL_SETTINGS.times, (scene.load, scene.support), (times, pull)
    )[0]


def motion_at(
    scene: TabulatedScene,
    path: Path,
    times: Float[np.ndarray, " n"],
    beside: Float[np.ndarray, " n"] | None = None,
) -> Motion:
    """The path at each time; its speed, from the right at kinks, at times `beside` them."""
    if times.size == 0:
        return Motion(*[times] * len(Motion._fields))
    columns = times, times if beside is None else beside
    fixed = scene.load, scene.support, path.rows
    return in_chunks(_motion, MODEL_SETTINGS.times, fixed, columns)


def states_at(
    scene: TabulatedScene, path: Path, times: Float[np.ndarray, "*shape"]
) -> Float[np.ndarray, "*shape"]:
    """The path's state in m at times of any shape."""
    return motion_at(scene, path, times.ravel()).states.reshape(times.shape)


def speeds_at(
    scene: TabulatedScene, path: Path, times: Float[np.ndarray, "*shape"]
) -> Float[np.ndarray, "*shape"]:
    """The path's speed in m/s at times of any shape, from the right at kinks."""
    return motion_at(scene, path, times.ravel()).speeds.reshape(times.shape)


def slopes_at(
    scene: TabulatedScene,
    path: Path,
    times: Float[np.ndarray, " n"],
    states: Float[np.ndarray, " n"],
) -> Float[np.ndarray, " n"]:
    """The path's speed in m/s at times at which its states are known."""
    if times.size == 0:
        return times
    fixed = scene.load, scene.support, path.rows
    return in_chunks(_speeds, MODEL_SETTINGS.times, fixed, (times, states))[0]
