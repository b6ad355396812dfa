"""One trajectory of the wiggly system."""

from typing import Any, NamedTuple

import diffrax
import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int, PyTree

from ..admissibility import require_reach
from ..arguments import (
    Real,
    as_real,
    is_concrete,
    require_numbers,
    require_real,
    require_x64,
)
from ..coefficients import coefficients
from ..scene import Scene, require_times
from .balance import Balance, dissipated
from .field import TipField
from .guard import WellGuard
from .methods import solver_of, with_tolerance
from .rounded import RoundedSteps
from .observed import AbstractWatch, Observed, Recorder, observed_field
from .status import Status, status_of
from .tolerance import Plan, plan_steps

MAX_STEPS = 2**30  # a bound, not a buffer: nothing is allocated for it
_RESIDUAL_SHARE = 0.05  # of the energy of a slip, a slip: 10 times what is measured


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


class Solution(eqx.Module):
    """Trajectory of the wiggly system.

    `ts` in s, `z` in m, shapes (n,). `dissipation`: `int_0^ts eps^gamma z'^2` in J.
    `residual`: `int_0^ts (eps^gamma z' + D E)^2/(2 eps^gamma)` in J, of the
    energy-dissipation balance; both are None where dissipation was not asked for. `ok`:
    every number can be trusted. `stats`: steps, rejected steps, tolerance in periods, how
    values were obtained, and `dissipation_gap`, the distance in J at the end between the
    dissipation and an independent second value of it.
    """

    ts: Float[Array, " n"]
    z: Float[Array, " n"]
    dissipation: Float[Array, " n"] | None
    residual: Float[Array, " n"] | None
    status_code: Int[Array, ""]
    stats: dict[str, Any]

    @property
    def ok(self) -> Any:
        """One bool (an array where traced)."""
        good = self.status_code == Status.OK
        return bool(good) if is_concrete(good) else good

    @property
    def status(self) -> Any:
        """A `Status` with `.message` (an integer array where traced)."""
        code = self.status_code
        return status_of(int(code)) if is_concrete(code) else code


def field_of(scene: Scene, eps: Real, gamma: Real) -> TipField:
    """The vector field of a scene at one eps and gamma."""
    return TipField(scene.potential, scene.support, scene.load, eps, gamma)


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
    the loop as a single function only while its state is small, 10 us a step against 1.7.
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
        go_on = (front.code == Status.OK) & (stop - front.t > plan.shortest_step)
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
        return Front(
            t=stop,
            y=tuple(y),
            step=jax.lax.stop_gradient(step),
            code=jnp.where(front.code == Status.OK, _code(found.result), front.code),
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


@eqx.filter_jit
def _solve(scene, eps, gamma, ts, accuracy, solver, balanced, max_steps, adjoint):
    plan = plan_steps(scene, eps, gamma, accuracy)
    found = integrate(
        scene,
        eps,
        gamma,
        ts,
        plan,
        solver,
        until=ts[-1],
        balanced=balanced,
        max_steps=max_steps,
        adjoint=adjoint,
    )
    stats = {
        "steps": found.steps,
        "rejected": found.rejected,
        "tolerance": plan.tolerance,
        "dissipation_gap": found.dissipation_gap,
    }
    return Solution(ts, found.z, found.dissipation, found.residual, found.status, stats)


def require_accuracy(accuracy: Any) -> None:
    """Check the accuracy asked for."""
    allowed = "1e-10 <= accuracy <= 1 (error of z in units of eps)"
    require_real("accuracy", accuracy, allowed, lambda a: 1e-10 <= a <= 1)


def solve(
    scene: Scene,
    eps: Any,
    gamma: Any = 1.0,
    ts: Any = None,
    accuracy: Any = 1e-3,
    method: Any = "auto",
    *,
    dissipation: bool = True,
    max_steps: int = MAX_STEPS,
    adjoint: diffrax.AbstractAdjoint | None = None,
) -> Solution:
    """Solve `eps^gamma z' = l(t) - Phi'(z) - V_eps'(z)` (eq. 2.7) from z0.

    `eps` in m, `gamma` > 0. `ts`: times in s, not decreasing, in [0, duration]; 201 evenly
    spaced ones where None. `accuracy`: wanted error of `z` in units of eps at every time
    not inside a slip, and of `dissipation` in units of its final value. `method`: "auto"
    and "resolved" integrate every slip with a Rosenbrock method, "windowed" falls back to
    that; or any adaptive diffrax solver of an ODE, by name, class or instance.
    `dissipation=False` integrates no energies. `adjoint`: how diffrax differentiates
    (`diffrax.ForwardMode()` for `jax.jvp`).

    Differentiable with respect to the leaves of the scene, eps and gamma. Failure is a
    `status`, not an exception.

    Raises `ValueError` for arguments out of range, 32 bits, or an eps at which the
    bristle loses its contact (`G > 0` fails), with the largest eps allowed.
    """
    require_x64(scene)
    require_numbers("eps", eps, "one number eps > 0", lambda e: (e > 0) & (e.ndim == 0))
    allowed = "one number gamma > 0"
    require_numbers("gamma", gamma, allowed, lambda g: (g > 0) & (g.ndim == 0))
    require_accuracy(accuracy)
    ts = require_times(scene, ts)
    solver = solver_of(method)
    eps, gamma = jnp.asarray(as_real(eps)), jnp.asarray(as_real(gamma))
    require_reach(scene.potential, eps)
    found = _solve(
        scene,
        eps,
        gamma,
        ts,
        jnp.asarray(as_real(accuracy)),
        solver,
        bool(dissipation),
        int(max_steps),
        adjoint,
    )
    found.stats["values"] = f"resolved, every slip, by {type(solver).__name__}"
    return found
