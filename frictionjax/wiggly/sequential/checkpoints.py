"""Fronts of an integration: stretches between stops, each a loop of its own."""

from functools import partial

import diffrax
import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int, PyTree

from ..._checks import Real
from ..equation import Status, StepPlan, TipField
from .augmented_solver import augmented_field
from .stepper import Stepper, code_of
from .way_adjoint import Checkpoint, Past, goes_on, way_through
from .well_guard import WellGuard


def checkpoint_at_start(y: tuple, plan: StepPlan) -> Checkpoint:
    """The front at t = 0 with the tip and what follows it, `y`.

    Traced numbers are not looked at before: with an eps of -1 steps of NaN were made, and
    no error of one ends a solve before its last step.
    """
    none, zero = jnp.asarray(0), jnp.zeros_like(y[0])
    numbers = jnp.stack([y[0], plan.first_step, plan.tolerance, plan.reach])
    known = jnp.all(jnp.isfinite(numbers))
    code = jnp.where(known, int(Status.OK), int(Status.NOT_FINITE))
    return Checkpoint(zero, y, plan.first_step, code, none, none)


def times_of_stops(
    ts: Float[Array, " n"], turns: Float[Array, " turns"], until: Real, rounding: Real
) -> tuple[Float[Array, " m"], Int[Array, " n"]]:
    """Times at which steps end, sorted, and where in them the wanted ones are.

    Turning points after `until` and padding become empty intervals at the end. A time
    within `rounding` of a turning point, written differently or not, comes after it and
    takes its place: of two such stops the first is stepped to, and derivatives of the work
    need it to be the turning point.
    """
    turns = jnp.sort(jnp.where(jnp.isnan(turns), until, jnp.minimum(turns, until)))
    ends = jnp.append(turns, until)
    times = jnp.concatenate([ends, _beside(ts, ends, rounding)])
    order = jnp.argsort(times)
    return times[order], jnp.argsort(order)[ends.shape[0] :]


def _beside(ts: Array, ends: Array, rounding: Array) -> Array:
    """The times, or the end that is a rounding away."""
    after = jnp.clip(jnp.searchsorted(ends, ts), 1, ends.shape[0] - 1)
    for near in (ends[after - 1], ends[after]) if ends.shape[0] > 1 else (ends[0],):
        ts = jnp.where(jnp.abs(ts - near) <= rounding, near, ts)
    return ts


def controller_of(plan: StepPlan) -> WellGuard:
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
    return WellGuard(controller, plan.reach)


def checkpoints_at(
    stops: Float[Array, " m"],
    start: Checkpoint,
    field: TipField,
    plan: StepPlan,
    solver: diffrax.AbstractSolver,
    controller: WellGuard,
    max_steps: int,
    adjoint: diffrax.AbstractAdjoint | None = None,
    past: Past | None = None,
) -> tuple[Checkpoint, Past | None]:
    """Fronts at the stops, stacked, and the way to them; `solver` is of (y, ..., step).

    A loop for each piece, not one for all that writes states down: XLA compiles the loop
    as a single function only while its state is small, 11 us a step against 2.6. With an
    `adjoint` of the caller's, all between two stops is one piece, made by `diffeqsolve`.
    """
    if adjoint:
        whole = partial(_solved, field, plan, solver, controller, max_steps, adjoint)
        return jax.lax.scan(lambda f, stop: (whole(f, stop),) * 2, start, stops)[1], None
    still = jax.tree_util.tree_map(
        lambda leaf: jax.lax.stop_gradient(leaf) if eqx.is_inexact_array(leaf) else leaf,
        (controller, (plan.shortest_step, max_steps)),
    )
    found = way_through((Stepper(field, solver), start, stops), *still, past)
    return found.fronts, found


def _solved(
    field: TipField,
    plan: StepPlan,
    solver: diffrax.AbstractSolver,
    controller: WellGuard,
    max_steps: int,
    adjoint: diffrax.AbstractAdjoint,
    front: Checkpoint,
    stop: Real,
) -> Checkpoint:
    """All the way to the stop by diffrax, and differentiated as it does."""
    stop = jnp.where(goes_on(front, stop, plan.shortest_step), stop, front.t)
    found = diffrax.diffeqsolve(
        diffrax.ODETerm(augmented_field(field)),
        solver,
        front.t,
        stop,
        front.step,
        (*front.y, front.step),
        stepsize_controller=controller,
        saveat=diffrax.SaveAt(t1=True),
        max_steps=max_steps,
        adjoint=adjoint,
        throw=False,
    )
    reached, *y = jax.tree_util.tree_map(lambda leaf: leaf[0], (found.ts, *found.ys))
    unfinished = found.result == diffrax.RESULTS.max_steps_reached
    *y, step = y
    return Checkpoint(
        t=jnp.where(unfinished, reached, stop),
        y=tuple(y),
        step=jax.lax.stop_gradient(step),
        code=jnp.where(front.code == Status.OK, code_of(found.result), front.code),
        steps=front.steps + found.stats["num_steps"],
        rejected=front.rejected + found.stats["num_rejected_steps"],
    )


def _tip_norm(scaled: PyTree) -> Real:
    """Step control looks at the tip alone; the running integrals follow it."""
    return jnp.abs(jax.tree_util.tree_leaves(scaled)[0])
