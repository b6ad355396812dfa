"""From stop to stop in pieces of limited length, and back along them in reverse mode.

Step control is chaotic: steps made again, compiled otherwise, round otherwise and become
other steps. So a derivative needs all steps of a piece kept, and pieces made again must end
at the times they ended at, not after as many steps: with pieces of 100 steps kept by a
checkpointed loop, derivatives of a dissipation were 1e-3 off, with one of 230000 steps and
1449 of them kept 4e-3, with no sign of it.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int, PyTree

from ..._checks import Real
from .settings import SETTINGS
from .step_adjoint import added


class Log(NamedTuple):
    """Where each piece began, the time it ended at, and the stop it made for."""

    begins: PyTree
    ends: Float[Array, " p"]
    stops: Int[Array, " p"]
    pieces: Int[Array, ""]


class Past(NamedTuple):
    """Fronts at the stops, stacked, and the pieces on the way."""

    fronts: PyTree
    log: Log


@eqx.filter_custom_vjp
def segment_adjoint(
    parts: tuple, goes_on: Callable[[PyTree, Real], Array], past: Past | None = None
) -> Past:
    """The way from stop to stop. `parts`: (piece, piece again, front, stops).

    `piece(front, stop)` goes towards the stop as far as it may, `again(front, end)` all the
    way to where a piece has ended; `goes_on(front, stop)`: whether there is more to go.
    `past`: the way, where it has been gone before, and needs no `piece`. Derivatives of
    fronts are by what the pieces depend on, by the front and by the stops.
    """
    if past is not None:
        return past
    piece, _, front, stops = parts
    begins = jax.tree_util.tree_map(_room, front)
    where = jnp.zeros(SETTINGS.most_pieces, int)
    log = Log(begins, _room(stops[0]), where, jnp.asarray(0))

    def stretch(carry: tuple, given: tuple) -> tuple[tuple, PyTree]:
        index, stop = given

        def advance(carry: tuple) -> tuple:
            front, log = carry
            after = piece(front, stop)
            return after, _noted(log, front, after.t, index)

        carry = jax.lax.while_loop(lambda c: goes_on(c[0], stop), advance, carry)
        return carry, carry[0]

    given = jnp.arange(stops.shape[0]), stops
    (_, log), fronts = jax.lax.scan(stretch, (front, log), given)
    return Past(fronts, log)


@segment_adjoint.def_fwd
def _with_log(perturbed: PyTree, *given: Any) -> tuple[Past, Log]:
    found = segment_adjoint.fn(*given)
    return found, found.log


def _room(leaf: Array) -> Array:
    return jnp.zeros((SETTINGS.most_pieces, *leaf.shape), leaf.dtype)


def _noted(log: Log, front: PyTree, end: Real, stop: Int[Array, ""]) -> Log:
    at = log.pieces  # beyond the room nothing is written
    return Log(
        jax.tree_util.tree_map(lambda to, v: to.at[at].set(v), log.begins, front),
        log.ends.at[at].set(end),
        log.stops.at[at].set(stop),
        at + 1,
    )


@segment_adjoint.def_bwd
def _back(log: Log, by: Past, perturbed: PyTree, parts: tuple, *_: Any) -> tuple:
    _, again, front, stops = parts
    wanted, fixed = eqx.partition(again, perturbed[1])

    def over_piece(carry: tuple) -> tuple:
        by_front, by_wanted, by_stop, left = carry
        index = left - 1
        begin = jax.tree_util.tree_map(lambda leaf: leaf[index], log.begins)
        moving, still = eqx.partition(begin, eqx.is_inexact_array)

        def passage(wanted: PyTree, moving: PyTree, end: Array) -> PyTree:
            after = eqx.combine(wanted, fixed)(eqx.combine(moving, still), end)
            return eqx.filter(after, eqx.is_inexact_array)

        end = log.ends[index]
        after, pull = jax.vjp(passage, wanted, moving, end)
        more, by_front, by_end = pull(by_front)
        # Only the last piece of a stretch ends where its stop is.
        last = (left == log.pieces) | (log.stops[left] != log.stops[index])
        by_end = jnp.where(after.t == end, jnp.where(last, by_end, 0.0), jnp.nan)
        return by_front, added(by_wanted, more), by_stop + by_end, index

    def over_stop(carry: tuple, given: tuple) -> tuple[tuple, PyTree]:
        by_front, by_wanted, left = carry
        index, by_here = given
        start = added(by_front, by_here), by_wanted, jnp.zeros_like(stops[0]), left
        *back, by_stop, left = jax.lax.while_loop(
            lambda c: (c[3] > 0) & (log.stops[c[3] - 1] == index), over_piece, start
        )
        return (*back, left), by_stop

    moving = eqx.filter(front, eqx.is_inexact_array)
    none = jax.tree_util.tree_map(jnp.zeros_like, (moving, wanted))
    start = *none, jnp.where(log.pieces > SETTINGS.most_pieces, 0, log.pieces)
    given = jnp.arange(stops.shape[0]), _whole(by.fronts, moving, stops.shape[0])
    (*found, _), by_stops = jax.lax.scan(over_stop, start, given, reverse=True)
    # Where room ran out, for pieces or for the steps of one, there is no derivative.
    bad = (log.pieces > SETTINGS.most_pieces) | jnp.any(jnp.isnan(by_stops))
    by_front, by_wanted, by_stops = jax.tree_util.tree_map(
        lambda leaf: jnp.where(bad, jnp.nan, leaf), (*found, by_stops)
    )
    by_piece = eqx.filter(parts[0], lambda leaf: False)
    return by_piece, by_wanted, by_front, by_stops


def _whole(by_fronts: PyTree, moving: PyTree, count: int) -> PyTree:
    """Zeros for what nothing depends on."""

    def filled(by: Any, leaf: Any) -> Any:
        blank = by is None and leaf is not None
        return jnp.zeros((count, *leaf.shape), leaf.dtype) if blank else by

    none = {"is_leaf": lambda leaf: leaf is None}
    return jax.tree_util.tree_map(filled, by_fronts, moving, **none)
