"""Derivatives of a piece of steps: each is made once more, with the state it began at.

Steps are chosen again and kept; none is judged twice, compiled otherwise. (Judged twice,
one of 200000 steps that had been accepted by less than a rounding was rejected, and its
share of the dissipation's derivative was lost: -11.6 came for 0.4772.)
"""

from typing import Any, NamedTuple

import diffrax
import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, PyTree

from ..._checks import Real
from ..equation import Status
from .stepper import StepLog, Stepper, Stepping, step_to


class Ends(NamedTuple):
    """What the state at the end of a piece depends on."""

    stepper: Stepper
    t: Real
    y: tuple
    stop: Real


class _Pull(NamedTuple):
    """Derivatives while they are traced back from the last step."""

    left: Array
    by_stepper: PyTree
    by_start: Real
    by_stop: Real
    by_y: tuple
    by_memory: PyTree


@eqx.filter_custom_vjp
def made_again(
    ends: Ends,
    controller: diffrax.AbstractAdaptiveStepSizeController,
    first_step: Real,
    room: int,
) -> tuple[tuple, Bool[Array, ""]]:
    """The state at the stop, and whether that was reached in `room` steps.

    Derivatives are by the `ends`: times of the steps between them are numbers.
    """
    return _made(ends, controller, first_step, room)[0]


def _made(ends: Ends, controller: Any, first_step: Real, room: int) -> tuple:
    parts = ends.stepper, controller, ends.t, ends.y, first_step
    now, log = step_to(ends.stop, *parts, most=room, room=room)
    fits = (now.code == Status.OK) & (now.t >= ends.stop)
    return (now.y, fits), (now, log)


@made_again.def_fwd
def _forth(perturbed: PyTree, *given: Any) -> tuple:
    return _made(*given)


@made_again.def_bwd
def _back(
    known: tuple[Stepping, StepLog], by: tuple, perturbed: PyTree, ends: Ends, *_: Any
) -> Ends:
    now, log = known
    wanted, fixed = eqx.partition(ends.stepper, eqx.is_inexact_array)
    moving, still = eqx.partition(now.memory, eqx.is_inexact_array)

    def step(wanted: PyTree, t: Real, end: Real, y: tuple, memory: PyTree) -> tuple:
        stepper = eqx.combine(wanted, fixed)
        y, _, memory, _ = stepper.step(t, end, y, eqx.combine(memory, still))
        return y, eqx.filter(memory, eqx.is_inexact_array)

    def over_step(pull: _Pull) -> _Pull:
        index, last = pull.left - 1, pull.left == now.accepted
        begin = jax.tree_util.tree_map(lambda leaf: leaf[index], log)
        memory = eqx.filter(begin.memory, eqx.is_inexact_array)
        end = jnp.where(last, ends.stop, log.t[jnp.where(last, index, pull.left)])
        _, back = jax.vjp(step, wanted, begin.t, end, begin.y, memory)
        more, by_start, by_end, *by = back((pull.by_y, pull.by_memory))
        by_stop = jnp.where(last, by_end, pull.by_stop)
        return _Pull(index, added(pull.by_stepper, more), by_start, by_stop, *by)

    zero, none = jnp.zeros_like(ends.stop), jax.tree_util.tree_map(jnp.zeros_like, wanted)
    by_y = jax.tree_util.tree_map(
        lambda leaf, b: jnp.zeros_like(leaf) if b is None else b, ends.y, by[0]
    )
    by_memory = jax.tree_util.tree_map(jnp.zeros_like, moving)
    start = _Pull(now.accepted, none, zero, zero, by_y, by_memory)
    end = jax.lax.while_loop(lambda pull: pull.left > 0, over_step, start)

    def begun(wanted: PyTree, t: Real, y: tuple) -> PyTree:
        memory = eqx.combine(wanted, fixed).memory(t, ends.stop, y)
        return eqx.filter(memory, eqx.is_inexact_array)

    _, back = jax.vjp(begun, wanted, ends.t, ends.y)
    more = back(end.by_memory)
    by_stepper, by_t, by_y = added((end.by_stepper, end.by_start, end.by_y), more)
    return Ends(by_stepper, by_t, by_y, end.by_stop)


def added(one: PyTree, other: PyTree) -> PyTree:
    """Sums of derivatives, leaf by leaf."""
    return jax.tree_util.tree_map(jnp.add, one, other)
