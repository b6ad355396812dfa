"""Where the path is at a time, and when at a state: programs on the tables of a scene."""

from typing import Any, NamedTuple, Protocol

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from ..._checks import Real
from ..._compile import Interpreted, Program, in_chunks
from ...loads import AbstractPull
from ...model import SETTINGS as MODEL_SETTINGS
from ...numerics import find_root
from ...supports import AbstractSupport
from ...tables import straight_part
from .settings import SETTINGS


class Piece(NamedTuple):
    """A row of a path's table: times in s, states and way in m, force of friction in N."""

    begin: Any
    touch: Any
    direction: Any
    state: Any
    end_state: Any
    travel: Any
    rho: Any


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
def motion_program(
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


class LoadAndSupport(Protocol):
    """What has a load and a support, as tables: a scene, or its path."""

    @property
    def load(self) -> Any: ...

    @property
    def support(self) -> Any: ...


def arrivals_at(
    pulled: LoadAndSupport,
    states: Float[np.ndarray, " n"],
    pull: Float[np.ndarray, " n"],
    early: Float[np.ndarray, " n"],
    late: Float[np.ndarray, " n"],
) -> Float[np.ndarray, " n"]:
    """Time in [early, late] at which `l - Phi'` is `pull` (N) at each state."""
    columns = states, pull, early, late
    return in_chunks(_times_at, SETTINGS.roots, (pulled.load, pulled.support), columns)[0]


def state_under(
    pulled: LoadAndSupport, times: Float[np.ndarray, " n"], pull: Float[np.ndarray, " n"]
) -> Float[np.ndarray, " n"]:
    """State in m at which `l - Phi'` is `pull` (N) at each time."""
    return in_chunks(
        _state_under, MODEL_SETTINGS.times, (pulled.load, pulled.support), (times, pull)
    )[0]
