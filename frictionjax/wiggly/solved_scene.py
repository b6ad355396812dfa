"""What pulls at a trajectory, read from the scene that it is of."""

from typing import Any

import jax
import numpy as np
from jaxtyping import Array, Float

from .._checks import require, scene_of
from .._compile import Program, in_chunks
from ..effects import CompliantArray, NapFlip
from ..loads import AbstractPull
from ..model import SETTINGS
from ..supports import AbstractSupport
from ..tables import load_table


@Program
def _loads_and_holds(load: AbstractPull, support: AbstractSupport, ts: Array, z: Array):
    return jax.vmap(load)(ts), jax.vmap(support.force)(z)


def loads_and_forces(
    solution: Any,
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    """The load l, and l - Phi'(z), at the times of a trajectory, in N.

    Raises `ValueError` of a batch, and where no scene is known.
    """
    scene = scene_of(solution)
    require(np.ndim(solution.z) == 1, "solution", "a batch", "one trajectory")
    fixed = load_table(scene.load), scene.support
    columns = np.asarray(solution.ts), np.asarray(solution.z)
    load, held = in_chunks(_loads_and_holds, SETTINGS.times, fixed, columns)
    return load, load - held


def require_one_force(solution: Any) -> None:
    """Raise where one force at a time does not tell what friction holds against."""
    effects = scene_of(solution).effects
    many = any(isinstance(effect, CompliantArray | NapFlip) for effect in effects)
    needs = "one bristle that keeps its side: fx.mechanics reads the others"
    require(not many, "solution", "of a compliant array or a rod that turns over", needs)
