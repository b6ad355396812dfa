"""One trajectory of the wiggly system."""

import dataclasses
from typing import TYPE_CHECKING, Any

import jax.numpy as jnp

from .._checks import (
    as_real,
    is_concrete,
    is_known,
    kind_of,
    known_numbers,
    noting_the_scene,
    require,
    require_flags,
    require_numbers,
    require_whole,
    with_nan,
)
from .._compile import waiting
from ..called_for import Simulated, simulated
from ..effects import (
    AbstractEffect,
    engine_of,
    inertia_among,
    nap_flip_among,
    noise_among,
)
from ..model import (
    Scene,
    require_reach,
    require_times,
    require_told_apart,
    scene_for,
    scene_of_tables,
)
from .engine_solutions import along_one_path, through_lanes, with_mass, with_turning
from .equation import require_accuracy
from .problem import Problem
from .sequential import MAX_STEPS, is_ours
from .solution import Solution

if TYPE_CHECKING:
    import diffrax

_ACCURACY = 1e-3


def _require_adjoint(adjoint: Any) -> None:
    if adjoint is not None:
        from diffrax import AbstractAdjoint  # 0.5 s

        known, told = isinstance(adjoint, AbstractAdjoint), "None or an adjoint of diffrax"
        require(known, "adjoint", kind_of(adjoint), told)


def _require_method(method: Any) -> None:
    if not is_ours(method):
        from .sequential import solver_of  # and diffrax, 0.5 s

        solver_of(method)


def _require_unasked(accuracy: Any, max_steps: int, adjoint: Any) -> None:
    """What steps of a path with noise do not read has to be as it is by default."""
    told = "its default: steps of a path with noise are fixed"
    unasked = is_known(accuracy) and known_numbers(accuracy) == _ACCURACY
    require(unasked, "accuracy", accuracy, told)
    require(max_steps == MAX_STEPS, "max_steps", max_steps, told)
    require(adjoint is None, "adjoint", adjoint, told)


def _require_known(known: bool, effect: AbstractEffect) -> None:
    """What has no derivatives needs known numbers."""
    who = f"effects.{type(effect).__name__}"
    needs = f"known numbers and no adjoint: {who} has no derivatives"
    require(known, "scene", "traced, or with an adjoint", needs)


def _called_for(found: Simulated, *numbers: Any, **options: Any) -> Solution:
    """The solution of what is left of a scene, which says what was left out."""
    if "Noise" in found.left_out:
        options |= {"key": None}  # of noise alone
    if noise_among(found.scene.effects) is not None:
        options |= {"accuracy": _ACCURACY}  # what a path with noise does not read
    solution = _solve(found.scene, *numbers, **options)
    counts = solution.counts | {"left_out": found.left_out}
    return dataclasses.replace(solution, counts=counts)


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
    adjoint: "diffrax.AbstractAdjoint | None" = None,
    key: Any = None,
    effects: str = "all",
    progress: bool = False,
) -> Solution:
    """Solve `eps^gamma z' = l(t) - Phi'(z) - V_eps'(z)` (eq. 2.8) of a `scene` from z0.

    `eps` in m, `gamma` > 0. `ts`: times in s, not decreasing, in [0, duration] (those that
    are a rounding outside are taken for its end); 201 evenly spaced ones where None.
    `accuracy`: wanted error of `z` in units of eps at every time not inside a slip, and of
    `dissipation` in units of its value at `duration`; `dissipation_gap` in `stats` is an
    estimate of its error. Where the load turns, or stays, at the very force that a slip
    takes, errors decide on that slip: of steps, some 1e-6 of eps (rho_plus - rho_minus) at
    a kink, less at a finer accuracy, and of rounding, 1e-14 of the load. `method`:
    "resolved" integrates every slip with a Rosenbrock method, in tiles side by side;
    "windowed" only what values at `ts` and sums over [0, T] need, and falls back to every
    slip where starts are not forgotten; "auto" takes what is cheaper; or any adaptive
    diffrax solver of an ODE, by name, class or instance. `dissipation=False` integrates no
    energies.

    Differentiable with respect to the leaves of the scene, eps and gamma: traced values go
    through `diffeqsolve`, every slip one after the other. `adjoint`: how diffrax
    differentiates (`diffrax.ForwardMode()` for `jax.jvp`, and for second derivatives by
    `jax.jacfwd(jax.jacfwd(...))`; by default first derivatives in reverse mode are those of
    the steps taken, and NaN through more than 15 million of them). Derivatives are less
    accurate than values: of a dissipation by the time of a kink by 0.3 to 1.4% where 1e-3
    was asked for, by 1e-5 of it at 1e-6 (by hand), in forward mode too.
    `max_steps`: of such a solve; any but the default asks for one.
    `key`: of a scene with `effects.Noise`, a seed or a key of `jax.random`, whose path it
    is: in windows that meet to the last bit, by each of our methods. Steps are fixed, and
    accuracy, max_steps and adjoint are refused; dissipation and residual are None, as
    `int eps^gamma z'^2` of a path with noise is infinite.
    With `effects.Inertia` the equation has `m_eps z''`, z0 is at rest, every slip is
    integrated at three tolerances, and there are no derivatives.
    With `effects.NapFlip` every slip is integrated, from mode to mode, and there are no
    derivatives.
    `effects`: "all" of the scene's, or "auto": without those that this accuracy does not
    call for, as `explain` tells; `left_out` in `stats` says which, and the most that each
    changes z by in eps.

    `progress`: a line on standard error where it takes more than two seconds, which
    a first call of its kind does: it compiles.

    Returns a `Solution`: `.ts` (s), `.z` (m), `.dissipation` and `.residual` (J), shapes
    (n,), `.ok`, `.status`, `.stats`. Failure is a `status`, not an exception.

    Raises `ValueError` for arguments out of range, 32 bits, or an eps at which the
    bristle loses its contact (`G > 0` fails), with the largest eps allowed; and for
    derivatives in forward mode, or second ones, without an adjoint for them. Of traced
    numbers, which cannot be looked at, values are NaN then, and the status is `NOT_FINITE`.

    >>> solution = fx.solve(scene, eps=0.01)
    >>> solution.status
    <Status.OK: 0>
    >>> print(f"at 3 s: {solution.z[-1]:.3f} m, {solution.dissipation[-1]:.3f} J lost")
    at 3 s: -0.120 m, 0.384 J lost
    """
    require_flags(progress=progress)
    with waiting("solve", progress):
        require_numbers("eps", eps, "one number eps > 0", lambda e: (e > 0) & (e.ndim == 0))
        allowed = "one number gamma > 0"
        require_numbers("gamma", gamma, allowed, lambda g: (g > 0) & (g.ndim == 0))
        require_accuracy(accuracy)
        options: dict[str, Any] = {
            "accuracy": accuracy,
            "method": method,
            "dissipation": dissipation,
            "max_steps": max_steps,
            "adjoint": adjoint,
            "key": key,
        }
        if effects == "all":
            return _solve(scene, eps, gamma, ts, **options)
        found = simulated(scene, effects, eps, gamma, accuracy)
        return _called_for(found, eps, gamma, ts, **options)


def _solve(
    scene: Scene,
    eps: Any,
    gamma: Any,
    ts: Any,
    *,
    accuracy: Any,
    method: Any,
    dissipation: bool,
    max_steps: int,
    adjoint: Any,
    key: Any,
) -> Solution:
    scene = scene_for(engine_of(method), scene)
    require_flags(dissipation=dissipation)
    require_whole("max_steps", max_steps)
    _require_adjoint(adjoint)
    _require_method(method)
    ts = require_times(scene, ts)
    noise = noise_among(scene.effects)
    if noise is not None:
        _require_unasked(accuracy, max_steps, adjoint)
        return along_one_path(Problem(scene, eps, gamma, ts, accuracy), noise, key)
    require(key is None, "key", key, "None, or a scene with effects.Noise")
    eps, gamma = jnp.asarray(as_real(eps)), jnp.asarray(as_real(gamma))
    require_reach(scene.potential, eps)
    require_told_apart(scene, eps)
    known = is_concrete(scene, eps, gamma, ts, accuracy)
    problem = Problem(scene, eps, gamma, ts, as_real(accuracy))
    for effect, by in (
        (inertia_among(scene.effects), with_mass),
        (nap_flip_among(scene.effects), with_turning),
    ):
        if effect is not None:
            _require_known(known and adjoint is None, effect)
            return by(problem, effect, bool(dissipation), int(max_steps))
    plain = adjoint is None and max_steps == MAX_STEPS
    if plain and is_ours(method) and known:
        found = through_lanes(problem, str(method), bool(dissipation))
        if found is not None:
            return found
    from .differentiable import Options, solve_one_after_the_other
    from .sequential import solver_of  # and diffrax, 0.5 s

    if known and adjoint is None:
        problem = problem._replace(scene=scene_of_tables(scene, eps))
    options = Options(solver_of(method), bool(dissipation), int(max_steps), adjoint)
    return solve_one_after_the_other(problem, options)
