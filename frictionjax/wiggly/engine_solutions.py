"""What engines find of one trajectory, as a `Solution`."""

from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from ..effects import Inertia, NapFlip, Noise
from ..model import Scene, TabulatedScene, tabulated_scene
from .arrays import integrate_scene
from .equation import Status
from .solution import Solution


def through_lanes(scene, eps, gamma, ts, accuracy, method, balanced) -> Solution | None:
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


def along_one_path(
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
        "rounds": found.rounds,
    }
    how = "a path with noise, by fixed steps (Leimkuhler and Matthews), in windows"
    z = jnp.asarray(found.z)
    return Solution(ts, z, None, None, jnp.asarray(int(status)), counts, how)


def with_mass(
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


def with_turning(
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
