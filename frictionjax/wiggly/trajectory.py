"""One trajectory of the wiggly system."""

import dataclasses
from typing import Any, NamedTuple

import diffrax
import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from .._checks import (
    Real,
    as_real,
    is_concrete,
    noting_the_scene,
    require,
    require_flags,
    require_numbers,
    require_whole,
    with_nan,
)
from .._compile import Program
from ..called_for import Simulated, simulated
from ..effects import (
    Inertia,
    NapFlip,
    Noise,
    engine_of,
    inertia_among,
    nap_flip_among,
    noise_among,
)
from ..model import (
    Scene,
    TabulatedScene,
    require_reach,
    require_times,
    require_told_apart,
    scene_for,
    tabulated_scene,
)
from .arrays import integrate_scene
from .equation import Status, StepPlan, plan_steps, require_accuracy
from .sequential import MAX_STEPS, integrate, is_ours, solver_of
from .solution import Solution

_ACCURACY = 1e-3


class _Problem(NamedTuple):
    """What trajectories have derivatives by."""

    scene: Scene
    eps: Real
    gamma: Real
    ts: Array
    accuracy: Real


class _Options(NamedTuple):
    solver: Any
    balanced: bool
    max_steps: int
    adjoint: Any


class _Curve(NamedTuple):
    """What of a `Solution` has derivatives."""

    z: Array
    dissipation: Array | None
    residual: Array | None


@Program
def _planned(problem: _Problem) -> StepPlan:
    scene, eps, gamma, _, accuracy = problem
    return plan_steps(scene, eps, gamma, accuracy)


def _answered(
    problem: _Problem, plan: StepPlan, options: _Options, past: Any = None
) -> tuple:
    scene, eps, gamma, ts, _ = problem
    found = integrate(
        scene,
        eps,
        gamma,
        ts,
        plan,
        options.solver,
        until=ts[-1],
        balanced=options.balanced,
        max_steps=options.max_steps,
        adjoint=options.adjoint,
        past=past,
    )
    counts = {
        "steps": found.steps,
        "rejected": found.rejected,
        "tolerance": plan.tolerance,
        "dissipation_gap": found.dissipation_gap,
    }
    curve = _Curve(found.z, found.dissipation, found.residual)
    return curve, (found.status, counts), found.past


@Program
def _forth(problem: _Problem, plan: StepPlan, options: _Options) -> tuple:
    return _answered(problem, plan, options)


@Program
def _back(
    problem: _Problem, plan: StepPlan, options: _Options, past: Any, by: _Curve
) -> _Problem:
    """Derivatives by the problem of what has those `by` the curve."""
    moving, still = eqx.partition(problem, eqx.is_inexact_array)

    def curve(moving: _Problem) -> _Curve:
        return _answered(eqx.combine(moving, still), plan, options, past)[0]

    return jax.vjp(curve, moving)[1](by)[0]


@eqx.filter_custom_vjp
def _differentiable(problem: _Problem, options: _Options) -> tuple:
    """Forth and back in a program each, kept for later processes as others are.

    Derivatives of one program were traced anew in every process, for 10 s.
    """
    return _forth(problem, _planned(problem), options)[:2]


@_differentiable.def_fwd
def _with_past(perturbed: Any, problem: _Problem, options: _Options) -> tuple:
    plan = _planned(problem)
    curve, told, past = _forth(problem, plan, options)
    return (curve, told), (plan, past, curve)


@_differentiable.def_bwd
def _pulled_back(
    known: tuple, by: tuple, perturbed: Any, problem: _Problem, options: _Options
) -> _Problem:
    plan, past, curve = known
    whole = jax.tree_util.tree_map(
        lambda value, by_value: jnp.zeros_like(value) if by_value is None else by_value,
        curve,
        by[0],
    )
    return _back(problem, plan, options, past, whole)


def _solve(problem: _Problem, options: _Options) -> Solution:
    if options.adjoint is None:
        curve, (status, counts) = _differentiable(problem, options)
    else:
        curve, (status, counts), _ = _forth(problem, _planned(problem), options)
    how = f"resolved, every slip, by {type(options.solver).__name__}"
    z, dissipation, residual = curve
    return Solution(problem.ts, z, dissipation, residual, status, counts, how)


def _through_lanes(scene, eps, gamma, ts, accuracy, method, balanced) -> Solution | None:
    """The solution by lanes; None where the scene has no room for the load's turns."""
    found, apart = integrate_scene(
        scene=scene,
        eps=np.atleast_1d(float(eps)),
        gamma=np.atleast_1d(float(gamma)),
        ts=np.asarray(ts),
        accuracy=accuracy,
        method=method,
        balanced=balanced,
        suprema=False,
    )
    if found is None:
        return None
    dissipation = jnp.asarray(found.dissipation[0]) if balanced else None
    residual = jnp.asarray(found.running_residual[0]) if balanced else None
    counts = {
        "steps": int(found.steps[0]),
        "rejected": int(found.rejected[0]),
        "tolerance": float(found.tolerance[0]),
        "dissipation_gap": float(found.dissipation_gap[0]) if balanced else None,
        "how": found.how[0],
        "bracket": found.gap[0],
        "sampled": float(found.sampled[0]),
    }
    if apart is not None:
        counts["spread"] = apart[0]
    return Solution(
        ts,
        jnp.asarray(found.z[0]),
        dissipation,
        residual,
        jnp.asarray(found.status[0]),
        counts,
        _in_words(found.how[0], float(found.sampled[0]), tabulated_scene(scene, eps)),
    )


def _in_words(how: np.ndarray, sampled: float, scene: TabulatedScene) -> str:
    own = scene.untabulated
    return _found_in_words(how, sampled) + (f"; compiled for {own}" if own else "")


def _found_in_words(how: np.ndarray, sampled: float) -> str:
    if not how.any():
        return "resolved, every slip since z0, by one lane"
    share = f"{np.mean(how > 0):.0%} of them from brackets that closed"
    if np.any(how == 2):
        share += f", {np.mean(how == 2):.0%} set off from a slip map"
    if np.isnan(sampled):
        return f"windowed, values at the times alone; {share}"
    if sampled:
        return f"windowed, {share}; {sampled:.0%} of the way known from some of its slips"
    return f"resolved, every slip, in tiles; {share}"


def _require_unasked(accuracy: Any, max_steps: int, adjoint: Any) -> None:
    """What steps of a path with noise do not read has to be as it is by default."""
    told = "its default: steps of a path with noise are fixed"
    require(as_real(accuracy) == _ACCURACY, "accuracy", accuracy, told)
    require(max_steps == MAX_STEPS, "max_steps", max_steps, told)
    require(adjoint is None, "adjoint", adjoint, told)


def _one_path(
    scene: Scene, noise: Noise, eps: Any, gamma: Any, ts: Array, key: Any
) -> Solution:
    from ..stochastic import key_words, noisy_path  # nothing else needs it

    words = key_words(key)
    found = noisy_path(scene, noise, eps=eps, gamma=gamma, key=words, ts=ts)
    status = Status.OK if found.ok else Status.NOT_FINITE
    counts = {
        "steps": found.steps,
        "rejected": 0,
        "tolerance": None,
        "dissipation_gap": None,
        "step": found.step,
    }
    how = "a path with noise, by fixed steps (Leimkuhler and Matthews)"
    z = jnp.asarray(found.z)
    return Solution(ts, z, None, None, jnp.asarray(int(status)), counts, how)


def _require_known(numbers: tuple, adjoint: Any, who: str) -> None:
    """What has no derivatives needs known numbers."""
    needs = f"known numbers and no adjoint: {who} no derivatives"
    known = is_concrete(*numbers) and adjoint is None
    require(known, "scene", "traced, or with an adjoint", needs)


def _with_mass(
    scene: Scene,
    inertia: Inertia,
    eps: Any,
    gamma: Any,
    ts: Array,
    accuracy: float,
    balanced: bool,
    max_steps: int,
) -> Solution:
    from .inertial import integrate_with_mass  # nothing else needs it

    found = integrate_with_mass(
        scene,
        np.atleast_1d(float(eps)),
        np.atleast_1d(float(gamma)),
        inertia=inertia,
        ts=np.asarray(ts),
        accuracy=accuracy,
        suprema=False,
        budget=max_steps,
    )
    counts = {
        "steps": int(found.steps[0]),
        "rejected": int(found.rejected[0]),
        "tolerance": float(found.tolerance[0]),
        "dissipation_gap": float(found.running_residual[0, -1]) if balanced else None,
        "spread": found.spread[0],
        "beta": float(found.beta[0]),
    }
    return Solution(
        ts,
        jnp.asarray(found.z[0]),
        jnp.asarray(found.dissipation[0]) if balanced else None,
        jnp.asarray(found.running_residual[0]) if balanced else None,
        jnp.asarray(found.status[0]),
        counts,
        "resolved, every slip since z0, with mass, at three tolerances",
        jnp.asarray(found.velocity[0]),
    )


def _with_turning(
    scene: Scene,
    effect: NapFlip,
    *,
    eps: Any,
    gamma: Any,
    ts: Array,
    accuracy: float,
    balanced: bool,
    max_steps: int,
) -> Solution:
    from .turning import integrate_turning  # nothing else needs it

    found = integrate_turning(
        scene,
        float(eps),
        float(gamma),
        effect=effect,
        ts=np.asarray(ts),
        accuracy=accuracy,
        budget=max_steps,
    )
    counts = {
        "steps": found.steps,
        "rejected": found.rejected,
        "tolerance": found.tolerance,
        "dissipation_gap": found.gap if balanced else None,
    }
    return Solution(
        ts=ts,
        z=jnp.asarray(found.z),
        dissipation=jnp.asarray(found.dissipation) if balanced else None,
        residual=jnp.asarray(found.residual) if balanced else None,
        status_code=jnp.asarray(found.status),
        counts=counts,
        how="resolved, every slip, with a rod that turns over",
        root=jnp.asarray(found.root),
        mode=jnp.asarray(found.mode),
        tip=jnp.asarray(found.tip),
    )


def _called_for(found: Simulated, *numbers: Any, key: Any, **options: Any) -> Solution:
    """The solution of what is left of a scene, which says what was left out."""
    used = None if "Noise" in found.left_out else key  # of noise alone
    if noise_among(found.scene.effects) is not None:
        options |= {"accuracy": _ACCURACY}  # what a path with noise does not read
    solution = solve(found.scene, *numbers, key=used, **options)
    counts = solution.counts | {"left_out": found.left_out}
    how = solution.how + (f"; without {found.in_words}" if found.left_out else "")
    return dataclasses.replace(solution, counts=counts, how=how)


@noting_the_scene
@with_nan
def solve(
    scene: Scene,
    eps: Any,
    gamma: Any = 1.0,
    ts: Any = None,
    accuracy: Any = _ACCURACY,
    method: Any = "auto",
    *,
    dissipation: bool = True,
    max_steps: int = MAX_STEPS,
    adjoint: diffrax.AbstractAdjoint | None = None,
    key: Any = None,
    effects: str = "all",
) -> Solution:
    """Solve `eps^gamma z' = l(t) - Phi'(z) - V_eps'(z)` (eq. 2.7) of a `scene` from z0.

    `eps` in m, `gamma` > 0. `ts`: times in s, not decreasing, in [0, duration]; 201 evenly
    spaced ones where None. `accuracy`: wanted error of `z` in units of eps at every time
    not inside a slip, and of `dissipation` in units of its value at `duration`;
    `dissipation_gap` in `stats` is an estimate of its error. `method`: "resolved"
    integrates every slip with a Rosenbrock method, in tiles side by side; "windowed" only
    what values at `ts` and sums over [0, T] need, and falls back to every slip where starts
    are not forgotten; "auto" takes what is cheaper; or any adaptive diffrax solver of an
    ODE, by name, class or instance. `dissipation=False` integrates no energies.

    Differentiable with respect to the leaves of the scene, eps and gamma: traced values go
    through `diffeqsolve`, every slip one after the other. `adjoint`: how diffrax
    differentiates (`diffrax.ForwardMode()` for `jax.jvp`; by default derivatives in reverse
    mode are those of the steps taken, and NaN through more than 15 million of them).
    `max_steps`: of such a solve.
    `key`: of a scene with `effects.Noise`, a seed or a key of `jax.random`, whose path it
    is. Steps are fixed then, and accuracy, max_steps and adjoint are refused; dissipation
    and residual are None, as `int eps^gamma z'^2` of a path with noise is infinite.
    With `effects.Inertia` the equation has `m_eps z''`, z0 is at rest, every slip is
    integrated at three tolerances, and there are no derivatives.
    With `effects.NapFlip` every slip is integrated, from mode to mode, and there are no
    derivatives.
    `effects`: "all" of the scene's, or "auto": without those that this accuracy does not
    call for, as `explain` tells; `left_out` in `stats` says which, and the most that each
    changes z by in eps.

    Returns a `Solution`: `.ts` (s), `.z` (m), `.dissipation` and `.residual` (J), shapes
    (n,), `.ok`, `.status`, `.stats`. Failure is a `status`, not an exception.

    Raises `ValueError` for arguments out of range, 32 bits, or an eps at which the
    bristle loses its contact (`G > 0` fails), with the largest eps allowed.

    >>> solution = fx.solve(scene, eps=0.01)
    >>> solution.status
    <Status.OK: 0>
    >>> print(f"at 3 s: {solution.z[-1]:.3f} m, {solution.dissipation[-1]:.3f} J lost")
    at 3 s: -0.120 m, 0.384 J lost
    """
    require_numbers("eps", eps, "one number eps > 0", lambda e: (e > 0) & (e.ndim == 0))
    allowed = "one number gamma > 0"
    require_numbers("gamma", gamma, allowed, lambda g: (g > 0) & (g.ndim == 0))
    require_accuracy(accuracy)
    if effects != "all":
        return _called_for(
            simulated(scene, effects, eps, gamma, accuracy),
            *(eps, gamma, ts),
            accuracy=accuracy,
            method=method,
            dissipation=dissipation,
            max_steps=max_steps,
            adjoint=adjoint,
            key=key,
        )
    scene = scene_for(engine_of(method), scene)
    require_flags(dissipation=dissipation)
    require_whole("max_steps", max_steps)
    known = adjoint is None or isinstance(adjoint, diffrax.AbstractAdjoint)
    require(known, "adjoint", type(adjoint).__name__, "None or an adjoint of diffrax")
    ts = require_times(scene, ts)
    solver = solver_of(method)
    noise = noise_among(scene.effects)
    if noise is not None:
        _require_unasked(accuracy, max_steps, adjoint)
        return _one_path(scene, noise, eps, gamma, ts, key)
    require(key is None, "key", key, "None, or a scene with effects.Noise")
    eps, gamma = jnp.asarray(as_real(eps)), jnp.asarray(as_real(gamma))
    require_reach(scene.potential, eps)
    require_told_apart(scene, eps)
    inertia = inertia_among(scene.effects)
    if inertia is not None:
        _require_known((scene, eps, gamma, ts, accuracy), adjoint, "effects.Inertia has")
        return _with_mass(
            scene=scene,
            inertia=inertia,
            eps=eps,
            gamma=gamma,
            ts=ts,
            accuracy=float(as_real(accuracy)),
            balanced=bool(dissipation),
            max_steps=int(max_steps),
        )
    turning = nap_flip_among(scene.effects)
    if turning is not None:
        _require_known((scene, eps, gamma, ts, accuracy), adjoint, "effects.NapFlip has")
        return _with_turning(
            scene,
            turning,
            eps=eps,
            gamma=gamma,
            ts=ts,
            accuracy=float(as_real(accuracy)),
            balanced=bool(dissipation),
            max_steps=int(max_steps),
        )
    plain = adjoint is None and max_steps == MAX_STEPS
    if plain and is_ours(method) and is_concrete(scene, eps, gamma, ts, accuracy):
        found = _through_lanes(
            scene=scene,
            eps=eps,
            gamma=gamma,
            ts=ts,
            accuracy=float(as_real(accuracy)),
            method=str(method),
            balanced=bool(dissipation),
        )
        if found is not None:
            return found
    problem = _Problem(scene, eps, gamma, ts, jnp.asarray(as_real(accuracy)))
    options = _Options(solver, bool(dissipation), int(max_steps), adjoint)
    return _solve(problem, options)
