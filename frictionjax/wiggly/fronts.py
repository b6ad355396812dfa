"""Fronts of an integration: stretches between stops, each a `diffeqsolve` of its own."""

from collections.abc import Callable
from typing import Any, NamedTuple

import diffrax
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int, PyTree

from ..arguments import Real
from .field import TipField
from .guard import WellGuard
from .observed import observed_field
from .rounded import RoundedSteps
from .status import Status
from .tolerance import Plan

# Steps of a stretch whose states are kept for derivatives in reverse mode. Those of longer
# stretches are made again from some of them, in a loop that rounds differently: step
# control is chaotic, so these are other steps, and derivatives of the dissipation were up
# to 4e-3 off, with no sign of it (230000 steps of a support of 1e4 N/m, 1449 kept).
# Stops beside those asked for keep stretches short: 26000 slips of 40 steps. (Golden
# section: none is a rounding away from a kink. 64 of 2^14 steps took 1.3 to 2.3 times as
# long, as much memory is cleared for each.)
_KEPT, _BETWEEN, _GOLDEN = 2**12, 256, 0.6180339887498949


class Front(NamedTuple):
    """How far an integration has come: the last step's length opens the next interval.

    `tally`: what the controller has added up over all attempts, where it does.
    """

    t: Real
    y: tuple
    step: Real
    code: Int[Array, ""]
    steps: Int[Array, ""]
    rejected: Int[Array, ""]
    tally: PyTree = ()


def front_at_start(y: tuple, plan: Plan, tally: PyTree = ()) -> Front:
    """The front at t = 0 with the tip and what follows it, `y`."""
    none = jnp.asarray(0)
    code, zero = jnp.asarray(int(Status.OK)), jnp.zeros_like(y[0])
    return Front(zero, y, plan.first_step, code, none, none, tally)


def stops_of(
    ts, turns, until, rounding: Real
) -> tuple[Float[Array, " m"], Int[Array, " n"]]:
    """Times at which steps end, sorted, and where in them the wanted ones are.

    Turning points after `until` and padding become empty intervals at the end. A time
    within `rounding` of a turning point, written differently or not, comes after it and
    takes its place: of two such stops the first is stepped to, and derivatives of the work
    need it to be the turning point.
    """
    turns = jnp.sort(jnp.where(jnp.isnan(turns), until, jnp.minimum(turns, until)))
    ends = jnp.append(turns, until)
    between = until * (np.arange(_BETWEEN) + _GOLDEN) / _BETWEEN
    times = jnp.concatenate([ends, _beside(ts, ends, rounding), between])
    order = jnp.argsort(times)
    first, count = ends.shape[0], ts.shape[0]
    return times[order], jnp.argsort(order)[first : first + count]


def _beside(ts, ends, rounding):
    """The times, or the end that is a rounding away."""
    after = jnp.clip(jnp.searchsorted(ends, ts), 1, ends.shape[0] - 1)
    for near in (ends[after - 1], ends[after]) if ends.shape[0] > 1 else (ends[0],):
        ts = jnp.where(jnp.abs(ts - near) <= rounding, near, ts)
    return ts


def controller_of(plan: Plan) -> RoundedSteps:
    """What chooses steps."""
    controller = diffrax.PIDController(
        rtol=0.0,
        atol=plan.tolerance,
        pcoeff=0.4,
        icoeff=0.3,  # pure I control loses 35% of the steps at folds, this 20%
        dtmin=plan.shortest_step,
        force_dtmin=False,
        factormin=0.1,
        factormax=5.0,
        norm=_tip_norm,
    )
    return RoundedSteps(WellGuard(controller, plan.reach))


def advancing(
    field: TipField,
    plan: Plan,
    solver: diffrax.AbstractSolver,
    controller: diffrax.AbstractAdaptiveStepSizeController,
    max_steps: int,
    adjoint: diffrax.AbstractAdjoint | None = None,
    tally: Callable[[PyTree], PyTree] | None = None,
) -> Callable[[Front, Real], Front]:
    """The map from a front to the front at the next stop; `solver` is of (y, ..., step).

    `tally`: what the controller's state has added up. One `diffeqsolve` for each interval,
    not one for all with `SaveAt(ts)`: XLA compiles the loop as a single function only while
    its state is small, 11 us a step against 2.6.
    """
    terms, kept = diffrax.ODETerm(observed_field(field)), min(max_steps, _KEPT)

    # In reverse mode one stretch at a time keeps its steps.
    @jax.checkpoint
    def advance(front: Front, stop: Real) -> Front:
        # A front that failed, or is a rounding away from the stop (a time asked for and a
        # kink, written differently), stays where it is: no length, no step.
        ahead = stop - front.t > plan.shortest_step
        spent = ahead & (front.steps >= max_steps) & (front.code == Status.OK)
        go_on = (front.code == Status.OK) & ahead & ~spent
        stop = jnp.where(go_on, stop, front.t)
        found = diffrax.diffeqsolve(
            terms,
            solver,
            front.t,
            stop,
            front.step,
            (*front.y, front.step),
            stepsize_controller=controller,
            saveat=diffrax.SaveAt(t1=True, controller_state=tally is not None),
            max_steps=max_steps,
            adjoint=adjoint or diffrax.RecursiveCheckpointAdjoint(checkpoints=kept),
            throw=False,
        )
        ended = jax.tree_util.tree_map(lambda leaf: leaf[0], found.ys)
        *y, step = ended
        code = jnp.where(front.code == Status.OK, _code(found.result), front.code)
        more = () if tally is None else tally(found.controller_state)
        return Front(
            t=stop,
            y=tuple(y),
            step=jax.lax.stop_gradient(step),
            code=jnp.where(spent, int(Status.MAX_STEPS), code),
            steps=front.steps + found.stats["num_steps"],
            rejected=front.rejected + found.stats["num_rejected_steps"],
            tally=jax.tree_util.tree_map(jnp.add, front.tally, more),
        )

    return advance


def _tip_norm(scaled: PyTree) -> Real:
    """Step control looks at the tip alone; the running integrals follow it."""
    return jnp.abs(jax.tree_util.tree_leaves(scaled)[0])


def _code(result: diffrax.RESULTS) -> Array:
    known = [
        (result == diffrax.RESULTS.successful, Status.OK),
        (result == diffrax.RESULTS.max_steps_reached, Status.MAX_STEPS),
        (result == diffrax.RESULTS.dt_min_reached, Status.STEP_TOO_SMALL),
    ]
    return first_of(known, jnp.asarray(int(Status.SOLVER_FAILED)))


def first_of(codes: list[tuple[Any, Status]], otherwise: Any) -> Array:
    """The first status whose condition holds."""
    status = otherwise
    for bad, code in reversed(codes):
        status = jnp.where(bad, int(code), status)
    return status
