"""Integration of the wiggly system from stop to stop; traceable, one lane."""

from typing import Any, NamedTuple

import diffrax
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int, PyTree

from ..arguments import Real
from ..coefficients import coefficients
from ..scene import Scene
from .balance import Balance, dissipated
from .field import TipField
from .guard import WellGuard
from .methods import with_tolerance
from .observed import AbstractWatch, Observed, Recorder, observed_field
from .rounded import RoundedSteps
from .status import Status
from .tolerance import Plan

MAX_STEPS = 2**30  # a bound, not a buffer: nothing is allocated for it
_RESIDUAL_SHARE = 0.05  # of the energy dissipated; solutions leave about 1e-6 of it


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


class Front(NamedTuple):
    """How far an integration has come: the last step's length opens the next interval."""

    t: Real
    y: tuple
    step: Real
    code: Int[Array, ""]
    steps: Int[Array, ""]
    rejected: Int[Array, ""]


def field_of(scene: Scene, eps: Real, gamma: Real) -> TipField:
    """The vector field of a scene at one eps and gamma."""
    return TipField(scene.potential, scene.support, scene.load, eps, eps**gamma)


def integrate(
    scene: Scene,
    eps: Real,
    gamma: Real,
    ts: Float[Array, " n"],
    plan: Plan,
    solver: diffrax.AbstractSolver,
    *,
    until: Real,
    balanced: bool = True,
    watch: AbstractWatch | None = None,
    max_steps: int = MAX_STEPS,
    adjoint: diffrax.AbstractAdjoint | None = None,
) -> Trajectory:
    """Integrate from 0 to `until` >= ts[-1]; traceable, one lane.

    Steps end at all `ts` (dense output of a rest phase is worse than its steps: off by
    half a period at gamma = 2) and at the turning points and kinks of the load.
    """
    field = field_of(scene, eps, gamma)
    tip = field.start(scene.z0)
    start_energy = field.energy(jnp.zeros_like(until), tip)
    recorder = Recorder(field, start_energy, balanced, watch)
    turns = scene.turning_points()
    stops, wanted = _stops(ts, turns, until)
    advance = _advance(field, plan, solver, recorder, max_steps, adjoint)
    state = Front(
        t=jnp.zeros_like(until),
        y=(tip, *recorder.start(scene.z0)),
        step=plan.first_step,
        code=jnp.asarray(int(Status.OK)),
        steps=jnp.asarray(0),
        rejected=jnp.asarray(0),
    )
    last, fronts = jax.lax.scan(lambda f, stop: (advance(f, stop),) * 2, state, stops)
    fronts = jax.tree_util.tree_map(lambda leaf: leaf[wanted], fronts)
    tips, *memories = fronts.y
    blank = jnp.where(fronts.code == Status.OK, 0.0, jnp.nan)
    z = jax.vmap(field.state)(tips) + blank
    dissipation, residual, final, gap = None, None, None, None
    if balanced:
        final = last.y[1]
        spent = dissipated(field, final, last.t, last.y[0], start_energy)
        gap = jnp.abs(final.viscous - spent)
        dissipation = blank + jax.vmap(
            lambda t, y, balance: dissipated(field, balance, t, y, start_energy)
        )(ts, tips, memories[0])
        residual = memories[0].residual + blank
    status = _status(last.code, z, turns)
    if final is not None:
        status = _with_balance(status, scene, eps, final)
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
    )


def _stops(ts, turns, until) -> tuple[Float[Array, " m"], Int[Array, " n"]]:
    """Times at which steps end, sorted, and where in them the wanted ones are.

    Turning points after `until` and padding become empty intervals at the end.
    """
    turns = jnp.where(jnp.isnan(turns), until, jnp.minimum(turns, until))
    times = jnp.concatenate([ts, turns, until[None]])
    order = jnp.argsort(times)
    return times[order], jnp.argsort(order)[: ts.shape[0]]


def _advance(field, plan, solver, recorder, max_steps, adjoint):
    """The map from a front to the front at the next stop.

    One `diffeqsolve` for each interval, not one for all with `SaveAt(ts)`: XLA compiles
    the loop as a single function only while its state is small, 11 us a step against 2.6.
    """
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
    observed = Observed(with_tolerance(solver, plan.tolerance), recorder)
    terms = diffrax.ODETerm(observed_field(field))

    def advance(front: Front, stop: Real) -> Front:
        # A front that failed, or is a rounding away from the stop (a time asked for and a
        # kink, written differently), stays where it is: no length, no step.
        ahead = stop - front.t > plan.shortest_step
        spent = ahead & (front.steps >= max_steps) & (front.code == Status.OK)
        go_on = (front.code == Status.OK) & ahead & ~spent
        stop = jnp.where(go_on, stop, front.t)
        found = diffrax.diffeqsolve(
            terms,
            observed,
            front.t,
            stop,
            front.step,
            (*front.y, front.step),
            stepsize_controller=RoundedSteps(WellGuard(controller, plan.reach)),
            saveat=diffrax.SaveAt(t1=True),
            max_steps=max_steps,
            adjoint=adjoint or diffrax.RecursiveCheckpointAdjoint(),
            throw=False,
        )
        ended = jax.tree_util.tree_map(lambda leaf: leaf[0], found.ys)
        *y, step = ended
        code = jnp.where(front.code == Status.OK, _code(found.result), front.code)
        return Front(
            t=stop,
            y=tuple(y),
            step=jax.lax.stop_gradient(step),
            code=jnp.where(spent, int(Status.MAX_STEPS), code),
            steps=front.steps + found.stats["num_steps"],
            rejected=front.rejected + found.stats["num_rejected_steps"],
        )

    return advance


def _tip_norm(scaled: PyTree) -> Real:
    """Step control looks at the tip alone; the running integrals follow it."""
    return jnp.abs(jax.tree_util.tree_leaves(scaled)[0])


def _first_of(codes: list[tuple[Any, Status]], otherwise: Any) -> Array:
    """The first status whose condition holds."""
    status = otherwise
    for bad, code in reversed(codes):
        status = jnp.where(bad, int(code), status)
    return status


def _code(result: diffrax.RESULTS) -> Array:
    known = [
        (result == diffrax.RESULTS.successful, Status.OK),
        (result == diffrax.RESULTS.max_steps_reached, Status.MAX_STEPS),
        (result == diffrax.RESULTS.dt_min_reached, Status.STEP_TOO_SMALL),
    ]
    return _first_of(known, jnp.asarray(int(Status.SOLVER_FAILED)))


def _status(code: Array, z: Float[Array, " n"], turns: Array) -> Array:
    known = [
        (jnp.any(jnp.isnan(turns)), Status.TOO_MANY_TURNS),
        (~jnp.all(jnp.isfinite(z)), Status.NOT_FINITE),
    ]
    found = _first_of(known, jnp.asarray(int(Status.OK)))
    return jnp.where((code != Status.OK) & (found != Status.TOO_MANY_TURNS), code, found)


def _with_balance(status: Array, scene: Scene, eps: Real, final: Balance) -> Array:
    """A residual of more than a share of the energy of every slip made is a failure."""
    law = coefficients(scene.potential)
    slip = eps * (law.rho_plus - law.rho_minus)
    allowed = _RESIDUAL_SHARE * (slip + final.viscous)
    closes = final.residual <= allowed
    return jnp.where((status == Status.OK) & ~closes, int(Status.UNBALANCED), status)
