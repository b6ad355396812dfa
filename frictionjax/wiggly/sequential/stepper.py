"""Steps of a solver under a controller, in a loop of our own.

diffrax's has dense output, events and checkpoints to see to, and asks the host to report
errors: to trace and to compile a derivative through it took 26 s of a core, in every
process again, as JAX keeps no program that calls the host.
"""

from typing import Any, NamedTuple

import diffrax
import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int, PyTree

from ..._checks import Real
from ..equation import Status, TipField
from .augmented_solver import augmented_field

_NEARLY = 100 * float(jnp.finfo(float).eps)  # of a stop: diffrax goes on to it from there


class Stepper(eqx.Module):
    """What makes steps: all that their derivatives are by."""

    field: TipField
    solver: diffrax.AbstractSolver

    @property
    def term(self) -> diffrax.ODETerm:
        """The equation as solvers want it."""
        return diffrax.ODETerm(augmented_field(self.field))

    def memory(self, t: Real, end: Real, y: tuple) -> PyTree:
        """What the solver is to remember at a first step."""
        found = self.solver.init(self.term, t, end, y, None)
        return jax.tree_util.tree_map(jnp.asarray, found)

    def step(self, t: Real, end: Real, y: tuple, memory: PyTree) -> tuple:
        """The state after a step, its error, the solver's memory and result."""
        y, error, _, *rest = self.solver.step(self.term, t, end, y, None, memory, False)
        return y, error, *rest


class Stepping(NamedTuple):
    """Where the next step begins and ends, and what has come of those before."""

    t: Real
    end: Real
    y: tuple
    memory: PyTree
    control: PyTree
    code: Int[Array, ""]
    steps: Int[Array, ""]
    accepted: Int[Array, ""]


class StepLog(NamedTuple):
    """Times, tips and memories at which accepted steps began, and how many; padded."""

    t: Float[Array, " room"]
    tip: Float[Array, " room"]
    memory: PyTree
    filled: Int[Array, ""]


def blank_log(stepper: Stepper, y: tuple, room: int) -> StepLog:
    """Room for so many steps."""
    zero = jnp.zeros_like(y[0])
    rows = jax.tree_util.tree_map(
        lambda leaf: jnp.zeros((room, *leaf.shape), leaf.dtype),
        (zero, zero, stepper.memory(zero, zero, y)),
    )
    return StepLog._make((*rows, jnp.asarray(0)))


def step_to(
    stop: Real,
    stepper: Stepper,
    controller: diffrax.AbstractAdaptiveStepSizeController,
    t: Real,
    y: tuple,
    first_step: Real,
    *,
    most: Any,
    log: Any = None,
) -> tuple[Stepping, Any]:
    """At most `most` steps from `t` to `stop`, as diffrax makes them.

    `log`: a `StepLog`, where accepted ones are noted; None: nowhere.
    """
    order: Any = stepper.solver.error_order(stepper.term)
    known = stepper.term, t, stop, y, first_step, None, stepper.solver.func, order
    end, control = controller.init(*known)
    end, none = jnp.minimum(end, stop), jnp.asarray(0)
    start = Stepping(t, end, y, stepper.memory(t, end, y), control, none, none, none)
    nearly = stop - _NEARLY * jnp.abs(stop)

    def advance(carry: tuple) -> tuple:
        now, log = carry
        after, error, memory, result = stepper.step(now.t, now.end, now.y, now.memory)
        error = jax.tree_util.tree_map(lambda e: jnp.where(jnp.isnan(e), jnp.inf, e), error)
        keep, t, end, _, control, verdict = controller.adapt_step_size(
            now.t, now.end, now.y, after, None, error, order, now.control
        )
        t = jnp.minimum(t, stop)
        half = jnp.where(keep, stop, t + 0.5 * (stop - t))
        y, memory = jax.tree_util.tree_map(
            lambda new, old: jnp.where(keep, new, old), (after, memory), now[2:4]
        )
        code = jnp.where(keep, code_of(result), int(Status.OK))
        code = jnp.where(code == Status.OK, code_of(verdict), code)
        end = jnp.where(end > nearly, half, end)
        counts = now.steps + 1, now.accepted + keep
        if log is not None:  # a step that is rejected is written over
            at = log.filled
            rows = jax.tree_util.tree_map(
                lambda a, v: a.at[at].set(v), log[:3], (now.t, now.y[0], now.memory)
            )
            log = StepLog._make((*rows, at + keep))
        return Stepping(t, end, y, memory, control, code, *counts), log

    def goes_on(carry: tuple) -> Array:
        now, _ = carry
        return (now.t < stop) & (now.code == Status.OK) & (now.steps < most)

    return jax.lax.while_loop(goes_on, advance, (start, log))


def code_of(result: diffrax.RESULTS) -> Array:
    """The `Status` of what diffrax says of a step, or of all."""
    code: Any = int(Status.SOLVER_FAILED)
    for known, status in (
        (diffrax.RESULTS.max_steps_reached, Status.MAX_STEPS),
        (diffrax.RESULTS.dt_min_reached, Status.STEP_TOO_SMALL),
        (diffrax.RESULTS.successful, Status.OK),
    ):
        code = jnp.where(result == known, int(status), code)
    return code
