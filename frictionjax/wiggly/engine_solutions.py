"""What engines find of one trajectory, as a `Solution`."""

from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from .._checks import as_jax
from ..effects import Noise
from ..model import tabulated_scene
from ..numerics import rows_of
from .arrays import integrate_scene
from .equation import Status
from .problem import Problem
from .solution import Solution


def _one_cell(problem: Problem) -> dict[str, Any]:
    """Arguments of what integrates cells."""
    return {
        "scene": problem.scene,
        "eps": np.atleast_1d(float(problem.eps)),
        "gamma": np.atleast_1d(float(problem.gamma)),
        "ts": np.asarray(problem.ts),
        "accuracy": float(problem.accuracy),
    }


def _energies(
    balanced: bool, dissipation: Any, residual: Any
) -> tuple[Array | None, Array | None]:
    """Both as arrays, or None where none were asked for."""
    return (as_jax(dissipation), as_jax(residual)) if balanced else (None, None)


def through_lanes(problem: Problem, method: str, balanced: bool) -> Solution | None:
    """The solution by lanes; None where the scene has no room for the load's turns."""
    asked = _one_cell(problem) | {"method": method, "balanced": balanced}
    found, apart = integrate_scene(suprema=False, **asked)
    if found is None:
        return None
    one = rows_of(found, 0)
    own = tabulated_scene(problem.scene, problem.eps).untabulated
    counts = {
        "steps": int(one.steps),
        "rejected": int(one.rejected),
        "tolerance": float(one.tolerance),
        "dissipation_gap": float(one.dissipation_gap) if balanced else None,
        "how": one.how,
        "bracket": one.gap,
        "sampled": float(found.sampled[0]),
    }
    if apart is not None:
        counts["spread"] = apart[0]
    return Solution(
        problem.ts,
        as_jax(one.z),
        *_energies(balanced, one.dissipation, one.running_residual),
        as_jax(one.status),
        counts,
        f"; compiled for {own}" if own else "",
    )


def along_one_path(problem: Problem, noise: Noise, key: Any) -> Solution:
    from ..stochastic import key_words, noisy_path  # nothing else needs it

    scene, eps, gamma, ts, _ = problem
    found = noisy_path(scene, noise, eps=eps, gamma=gamma, key=key_words(key), ts=ts)
    status = Status.OK if found.ok else Status.NOT_FINITE
    counts = {
        "steps": found.steps,
        "rejected": 0,
        "tolerance": None,
        "dissipation_gap": None,
        "step": found.step,
        "rounds": found.rounds,
    }
    how = "a path with noise, by fixed steps (Leimkuhler and Matthews), in windows"
    z = as_jax(found.z)
    return Solution(ts, z, None, None, jnp.asarray(int(status)), counts, how)


def with_mass(problem: Problem, effect: Any, balanced: bool, max_steps: int) -> Solution:
    from .inertial import integrate_with_mass  # nothing else needs it

    asked = _one_cell(problem) | {"inertia": effect, "budget": max_steps}
    found = rows_of(integrate_with_mass(suprema=False, **asked), 0)
    counts = {
        "steps": int(found.steps),
        "rejected": int(found.rejected),
        "tolerance": float(found.tolerance),
        "dissipation_gap": float(found.running_residual[-1]) if balanced else None,
        "spread": found.spread,
        "beta": float(found.beta),
    }
    return Solution(
        problem.ts,
        as_jax(found.z),
        *_energies(balanced, found.dissipation, found.running_residual),
        as_jax(found.status),
        counts,
        "resolved, every slip since z0, with mass, at three tolerances",
        as_jax(found.velocity),
    )


def with_turning(problem: Problem, effect: Any, balanced: bool, max_steps: int) -> Solution:
    from .turning import integrate_turning  # nothing else needs it

    found = integrate_turning(
        problem.scene,
        float(problem.eps),
        float(problem.gamma),
        effect=effect,
        ts=np.asarray(problem.ts),
        accuracy=float(problem.accuracy),
        budget=max_steps,
    )
    counts = {
        "steps": found.steps,
        "rejected": found.rejected,
        "tolerance": found.tolerance,
        "dissipation_gap": found.gap if balanced else None,
    }
    return Solution(
        problem.ts,
        as_jax(found.z),
        *_energies(balanced, found.dissipation, found.residual),
        as_jax(found.status),
        counts,
        "resolved, every slip, with a rod that turns over",
        root=as_jax(found.root),
        mode=as_jax(found.mode),
        tip=as_jax(found.tip),
    )
