"""What pulls at a trajectory, read from the scene that it is of."""

from typing import Any, NamedTuple

import jax
import numpy as np
from jaxtyping import Array, Float

from .._checks import require, scene_of
from .._compile import Interpreted, in_chunks
from ..effects import CompliantArray, NapFlip
from ..loads import AbstractPull
from ..model import SETTINGS, Scene
from ..supports import AbstractSupport
from ..tables import load_table


class Pulls(NamedTuple):
    """What acts, (n,): `load` and the support's `force` in N, its `stiffness` in N/m."""

    load: Any
    force: Any
    stiffness: Any


@Interpreted
def _pulls(load: AbstractPull, support: AbstractSupport, ts: Array, z: Array) -> Pulls:
    force, stiffness = jax.vmap(support.force), jax.vmap(support.stiffness_at)
    return Pulls(jax.vmap(load)(ts), force(z), stiffness(z))


def pulls_at(
    scene: Scene, ts: Float[np.ndarray, " n"], z: Float[np.ndarray, " n"]
) -> Pulls:
    """The load of a known scene at times in s, and the support at states in m."""
    fixed = load_table(scene.load), scene.support
    return in_chunks(_pulls, SETTINGS.times, fixed, (ts, z))


def loads_and_forces(
    solution: Any,
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    """The load l, and l - Phi'(z), at the times of a trajectory, in N.

    Raises `ValueError` of a batch, and where no scene is known.
    """
    scene = scene_of(solution)
    require(np.ndim(solution.z) == 1, "solution", "a batch", "one trajectory")
    found = pulls_at(scene, np.asarray(solution.ts), np.asarray(solution.z))
    return found.load, found.load - found.force


def require_one_force(solution: Any) -> None:
    """Raise where one force at a time does not tell what friction holds against."""
    effects = scene_of(solution).effects
    many = any(isinstance(effect, CompliantArray | NapFlip) for effect in effects)
    needs = "one bristle that keeps its side: fx.mechanics reads the others"
    require(not many, "solution", "of a compliant array or a rod that turns over", needs)
