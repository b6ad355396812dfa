"""The way from stop to stop in pieces, and back along them in reverse mode."""

from functools import partial
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int, PyTree

from ..._checks import Real
from ..equation import Status
from .settings import SETTINGS
from .step_adjoint import ReversedSteps, added
from .stepper import blank_log, step_to


class Checkpoint(NamedTuple):
    """How far an integration has come: the last step's length opens the next interval."""

    t: Real
    y: tuple
    step: Real
    code: Int[Array, ""]
    steps: Int[Array, ""]
    rejected: Int[Array, ""]


class PieceLog(NamedTuple):
    """Where each piece began, and the time it ended at; padded. `made`: how many."""

    t: Float[Array, " room"]
    tip: Float[Array, " room"]
    step: Float[Array, " room"]
    end: Float[Array, " room"]
    made: Int[Array, ""]


class Past(NamedTuple):
    """Fronts at the stops, how many pieces there were by then, and the pieces."""

    fronts: Checkpoint
    made: Int[Array, " stops"]
    pieces: PieceLog


def goes_on(front: Checkpoint, stop: Real, rounding: Real) -> Array:
    """Not where it failed, or is a rounding away from the stop (written differently)."""
    return (front.code == Status.OK) & (stop - front.t > rounding)


@eqx.filter_custom_vjp
def way_through(
    parts: tuple, controller: Any, limits: tuple, past: Past | None = None
) -> Past:
    """The way from a front through all stops. `parts`: (stepper, front, stops).

    `limits`: a rounding of time, and how many steps there may be. `past`: the way, where it
    has been gone before. Derivatives of times and states are by the stepper, the front and
    the stops; NaN through more than `SETTINGS.most_pieces` pieces.
    """
    if past is not None:
        return past
    stepper, front, stops = parts
    rounding, most = limits

    def piece(front: Checkpoint, stop: Real) -> Checkpoint:
        left = jnp.minimum(most - front.steps, SETTINGS.piece)
        start = front.t, (*front.y, front.step), front.step
        now, _ = step_to(stop, stepper, controller, *start, most=left)
        *y, step = now.y
        steps = front.steps + now.steps
        unfinished = (now.code == Status.OK) & (now.t < stop)
        spent = unfinished & (steps >= most)
        return Checkpoint(
            t=jnp.where(unfinished, now.t, stop),
            y=tuple(y),
            step=step,
            code=jnp.where(spent, int(Status.MAX_STEPS), now.code),
            steps=steps,
            rejected=front.rejected + now.steps - now.accepted,
        )

    def stretch(carry: tuple, stop: Real) -> tuple[tuple, tuple]:
        def advance(carry: tuple) -> tuple:
            front, pieces = carry
            after, at = piece(front, stop), pieces.made
            row = front.t, front.y[0], front.step, after.t
            # Beyond the room nothing is written.
            rows = (to.at[at].set(v) for to, v in zip(pieces[:4], row, strict=True))
            return after, PieceLog._make((*rows, at + 1))

        carry = jax.lax.while_loop(
            lambda carry: goes_on(carry[0], stop, rounding), advance, carry
        )
        return carry, (carry[0], carry[1].made)

    room = jnp.zeros(SETTINGS.most_pieces)
    start = front, PieceLog(room, room, room, room, jnp.asarray(0))
    (_, pieces), (fronts, made) = jax.lax.scan(stretch, start, stops)
    return Past(fronts, made, pieces)


@way_through.def_fwd
def _forth(perturbed: PyTree, *given: Any) -> tuple[Past, Past]:
    found = way_through.fn(*given)
    return found, found


@way_through.def_bwd
def _back(
    known: Past, by: Past, perturbed: PyTree, parts: tuple, controller: Any, *_: Any
) -> tuple:
    (_, made, pieces), (stepper, front, stops) = known, parts
    # A step adds to what goes with the tip, and does not read it.
    beside = jax.tree_util.tree_map(jnp.zeros_like, front.y[1:])
    wanted, fixed = eqx.partition(stepper, eqx.is_inexact_array)
    steps = ReversedSteps(wanted, fixed, (*beside, front.step))

    def over_piece(by_rest: list, past: Real, carry: tuple) -> tuple:
        by_stepper, _, by_tip, by_stop, whole, left = carry
        t, tip, first_step, stop = (leaf[left - 1] for leaf in pieces[:4])
        y, room = (tip, *beside, first_step), SETTINGS.piece + SETTINGS.more
        start, log = (controller, t, y, first_step), blank_log(stepper, y, room)
        now, log = step_to(stop, stepper, *start, most=room, log=log)
        begun, by_end = steps.back((by_stepper, by_tip), by_rest, log, now, stop)
        # Only the last piece of a stretch ends where its stop is.
        by_stop = by_stop + jnp.where(left == past, by_end, 0.0)
        whole &= (now.code == Status.OK) & (now.t >= stop)
        return *begun, by_stop, whole, left - 1

    def over_stop(carry: tuple, given: tuple) -> tuple[tuple, Real]:
        by_stepper, by_t, by_y, whole = carry
        first, past, (more_t, more_y) = given
        by_t, (by_tip, *by_rest) = added((by_t, by_y), (more_t, more_y))
        by_stepper, by_t, by_tip, by_stop, whole, _ = jax.lax.while_loop(
            lambda carry: carry[-1] > first,
            partial(over_piece, by_rest, past),
            (by_stepper, by_t, by_tip, by_t, whole, past),
        )
        by_stop = jnp.where(past > first, by_stop, 0.0)
        return (by_stepper, by_t, (by_tip, *by_rest), whole), by_stop

    whole = pieces.made <= SETTINGS.most_pieces
    past = jnp.where(whole, made, 0)
    first = jnp.concatenate([jnp.zeros_like(past[:1]), past[:-1]])
    moved = (by.fronts.t, by.fronts.y), (front.t, front.y)
    given = first, past, _filled(*moved, stops.shape[0])
    none = jax.tree_util.tree_map(jnp.zeros_like, (wanted, front.t, front.y))
    (*found, whole), by_stops = jax.lax.scan(over_stop, (*none, whole), given, reverse=True)
    # Where room ran out, for pieces or for the steps of one, there is no derivative.
    by_stepper, by_t, by_y, by_stops = jax.tree_util.tree_map(
        lambda leaf: jnp.where(whole, leaf, jnp.nan), (*found, by_stops)
    )
    nothing = jax.tree_util.tree_map(lambda leaf: None, front)
    return by_stepper, nothing._replace(t=by_t, y=by_y), by_stops


def _filled(by: PyTree, like: PyTree, count: int) -> PyTree:
    """Zeros for what nothing depends on."""
    return jax.tree_util.tree_map(
        lambda b, leaf: jnp.zeros((count, *leaf.shape)) if b is None else b,
        by,
        like,
        is_leaf=lambda leaf: leaf is None,
    )
