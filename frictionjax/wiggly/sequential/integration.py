"""Integration of the wiggly system from stop to stop; traceable, one lane."""

from typing import NamedTuple

import diffrax
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int, PyTree

from ..._checks import Real
from ...model import Scene
from ..equation import Balance, Status, StepPlan, TipField, dissipated, errors_of_sums
from .augmented_solver import AbstractObserver, AugmentedSolver, Recorder
from .checkpoints import (
    checkpoint_at_start,
    checkpoints_at,
    controller_of,
    times_of_stops,
)
from .own_methods import MAX_STEPS
from .settings import SETTINGS
from .solvers_by_name import with_tolerance
from .way_adjoint import Past


class Trajectory(NamedTuple):
    """Raw result of one integration; energies are None where none were asked for."""

    z: Float[Array, " n"]
    dissipation: Float[Array, " n"] | None
    residual: Float[Array, " n"] | None
    final: Balance | None
    dissipation_gap: Real | None
    watched: PyTree
    status: Int[Array, ""]
    steps: Int[Array, ""]
    rejected: Int[Array, ""]
    past: Past | None


def field_of(scene: Scene, eps: Real, gamma: Real) -> TipField:
    """The vector field of a scene at one eps and gamma."""
    return TipField(scene.potential, scene.support, scene.load, eps, eps**gamma)


def integrate(
    scene: Scene,
    eps: Real,
    gamma: Real,
    ts: Float[Array, " n"],
    plan: StepPlan,
    solver: diffrax.AbstractSolver,
    *,
    until: Real,
    balanced: bool = True,
    watch: AbstractObserver | None = None,
    max_steps: int = MAX_STEPS,
    adjoint: diffrax.AbstractAdjoint | None = None,
    past: Past | None = None,
) -> Trajectory:
    """Integrate from 0 to `until` >= ts[-1]; traceable, one lane.

    `past`: of the same integration, made before; then only derivatives are to be made.

    Steps end at all `ts` (dense output of a rest phase is worse than its steps: off by
    half a period at gamma = 2) and at the turning points and kinks of the load.
    """
    field = field_of(scene, eps, gamma)
    tip = field.start(scene.z0)
    start_energy = field.energy(jnp.zeros_like(until), tip)
    recorder = Recorder(field, start_energy, balanced, watch)
    turns = scene.turning_points()
    stops, wanted = times_of_stops(ts, turns, until, plan.shortest_step)
    observed = AugmentedSolver(with_tolerance(solver, plan.tolerance), recorder)
    start = checkpoint_at_start((tip, *recorder.start(scene.z0)), plan)
    parts = stops, start, field, plan, observed, controller_of(plan)
    fronts, past = checkpoints_at(*parts, max_steps, adjoint, past)
    last = jax.tree_util.tree_map(lambda leaf: leaf[-1], fronts)
    fronts = jax.tree_util.tree_map(lambda leaf: leaf[wanted], fronts)
    tips, *memories = fronts.y
    # Where a turning point is the time asked for, it has been stepped to: derivatives by
    # the turning point are those at a time that moves with it. (Energies left where they
    # were: the dissipation at a corner by its time was 1.14 J/s for -0.12.)
    speeds = jax.lax.stop_gradient(jax.vmap(field.velocity)(fronts.t, tips))
    powers = jax.lax.stop_gradient(jax.vmap(field.dissipated_power)(fronts.t, tips))
    later, reached = ts - fronts.t, tips
    tips = tips + later * speeds
    # As a factor: a term would leave derivatives of what failed finite.
    valid = jnp.where(fronts.code == Status.OK, 1.0, jnp.nan)
    z = jax.vmap(field.state)(tips) * valid
    dissipation, residual, final, gap = None, None, None, None
    if balanced:
        final = last.y[1]
        spent = dissipated(field, final, last.t, last.y[0], start_energy)
        gap = jnp.abs(final.viscous - spent)
        lost = jax.vmap(
            lambda t, y, balance: dissipated(field, balance, t, y, start_energy)
        )(fronts.t, reached, memories[0])
        pulled = _pulled(scene, turns, until)
        size = jnp.abs(start_energy) + jnp.abs(field.energy(last.t, last.y[0]))
        errors = errors_of_sums(final.viscous, final.residual, size, plan.unit, pulled)
        lost = jnp.where(errors.sum_is_closer, memories[0].viscous, lost)
        dissipation = (lost + later * powers) * valid
        residual = memories[0].residual * valid
    status = _status(last.code, z, turns)
    if final is not None:
        slip = eps * (plan.folds.force_plus - plan.folds.force_minus)
        status = _with_balance(status, slip, final)
    return Trajectory(
        z=z,
        dissipation=dissipation,
        residual=residual,
        final=final,
        dissipation_gap=gap,
        watched=None if watch is None else last.y[-1],
        status=status,
        steps=last.steps,
        rejected=last.rejected,
        past=past,
    )


def _status(code: Array, z: Float[Array, " n"], turns: Array) -> Array:
    lost = (code == Status.OK) & ~jnp.all(jnp.isfinite(z))
    code = jnp.where(lost, int(Status.NOT_FINITE), code)
    return jnp.where(jnp.any(jnp.isnan(turns)), int(Status.TOO_MANY_TURNS), code)


def _pulled(scene: Scene, turns: Float[Array, " m"], until: Real) -> Real:
    """What the load goes up and down in all, N."""
    ends = jnp.stack([jnp.zeros_like(until), until])
    edges = jnp.sort(jnp.concatenate([ends, jnp.minimum(turns, until)]))
    return jnp.sum(jnp.abs(jnp.diff(jax.vmap(scene.load)(edges))))


def _with_balance(status: Array, slip: Real, final: Balance) -> Array:
    """A residual of more than a share of the energy (J) of every slip made is a failure."""
    allowed = SETTINGS.residual * (slip + final.viscous)
    closes = final.residual <= allowed
    return jnp.where((status == Status.OK) & ~closes, int(Status.UNBALANCED), status)
