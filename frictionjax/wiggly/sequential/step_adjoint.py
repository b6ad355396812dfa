"""Back along the steps of a piece in reverse mode: those that were made, at their times.

Step control is chaotic: steps made again, compiled otherwise, round otherwise and become
other steps. So pieces made again must end at the times they ended at, not after as many
steps, with all steps kept and none judged twice. (With pieces of 100 steps made again by a
checkpointed loop, derivatives of a dissipation were 1e-3 off; judged again, one of 200000
steps was rejected that had been accepted by less than a rounding: -11.6 came for 0.4772.
All steps of the way kept: 16 bytes for each that there may be, in each lane of a batch, and
to clear room for 4 million takes as long as a short way.)
"""

from functools import partial
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import PyTree

from ..._checks import Real
from .stepper import StepLog, Stepping


class ReversedSteps(NamedTuple):
    """Steps of a stepper by the leaves of it that are `wanted`.

    `beside`: what goes with the tip, and the length of a step, as numbers.
    """

    wanted: PyTree
    fixed: PyTree
    beside: tuple

    def _begun(self, wanted: PyTree, t: Real, tip: Real, stop: Real) -> PyTree:
        """What the solver remembers at a first step."""
        stepper: Any = eqx.combine(wanted, self.fixed)
        memory = stepper.memory(t, stop, (tip, *self.beside))
        return eqx.filter(memory, eqx.is_inexact_array)

    def _made(
        self, wanted: PyTree, t: Real, tip: Real, moving: PyTree, end: Real, still: PyTree
    ) -> tuple:
        """The state after a step, and what the solver remembers then."""
        stepper: Any = eqx.combine(wanted, self.fixed)
        y, memory = (tip, *self.beside), eqx.combine(moving, still)
        y, _, memory, _ = stepper.step(t, end, y, memory)
        return y[:-1], eqx.filter(memory, eqx.is_inexact_array)

    def back(
        self, by: tuple, by_rest: list, log: StepLog, now: Stepping, stop: Real
    ) -> tuple[tuple, Real]:
        """Derivatives by the stepper, and by the time and the tip of a piece's start.

        Beside them that by its end, the `stop`. `by`: the stepper, as far as is known, and
        the tip at the end; `by_rest`: what goes with it. `log`, `now`: of the steps.
        """

        def over_step(carry: tuple) -> tuple:
            (by_stepper, _, by_tip, by_memory), by_end, left = carry
            t, tip, memory = jax.tree_util.tree_map(lambda leaf: leaf[left - 1], log[:3])
            moving, still = eqx.partition(memory, eqx.is_inexact_array)
            last = left == now.accepted
            end = jnp.where(last, stop, log.t[left])
            made = partial(self._made, still=still)
            back = jax.vjp(made, self.wanted, t, tip, moving, end)[1]
            more, *by_start, by_this = back(((by_tip, *by_rest), by_memory))
            by_end = jnp.where(last, by_this, by_end)
            return (added(by_stepper, more), *by_start), by_end, left - 1

        by_stepper, by_tip = by
        moving = eqx.filter(now.memory, eqx.is_inexact_array)
        none, zero = jax.tree_util.tree_map(jnp.zeros_like, moving), jnp.zeros_like(stop)
        start = (by_stepper, zero, by_tip, none), zero, now.accepted
        (*found, by_memory), by_end, _ = jax.lax.while_loop(
            lambda carry: carry[2] > 0, over_step, start
        )
        begun = partial(self._begun, stop=stop)
        beginning = jax.vjp(begun, self.wanted, log.t[0], log.tip[0])[1]
        return added(tuple(found), beginning(by_memory)), by_end


def added(one: PyTree, other: PyTree) -> PyTree:
    """Sums of derivatives, leaf by leaf."""
    return jax.tree_util.tree_map(jnp.add, one, other)
