"""Which scene a trajectory is of: kept as a note beside it, for as long as it lives.

As a field it would be a leaf of every trajectory, and functions of a scene can be none.
"""

from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar, cast

import jax
import numpy as np
from jaxtyping import Array, Float

from .._checks import ByIdentity, is_concrete, require
from .._compile import Program, in_chunks
from ..effects import CompliantArray, NapFlip
from ..loads import AbstractPull
from ..model import SETTINGS, Scene
from ..supports import AbstractSupport
from ..tables import load_table

_Solver = TypeVar("_Solver", bound=Callable)
_SCENES = ByIdentity()


def noting_the_scene(solve: _Solver) -> _Solver:
    """A solver whose solutions know their scene, where nothing of it is traced."""

    @wraps(solve)
    def noted(scene: Scene, *args: Any, **kwargs: Any) -> Any:
        solution = solve(scene, *args, **kwargs)
        if is_concrete(scene, solution):
            _SCENES.put(solution, scene)
        return solution

    return cast(_Solver, noted)


def scene_of(solution: Any) -> Scene:
    """The scene of a trajectory. Raises `ValueError` where nothing is known of it."""
    scene = _SCENES.get(solution)
    needs = "one that solve has returned, not made of its leaves: fx.mechanics reads it"
    require(scene is not None, "solution", "of no scene that is known", needs)
    return scene


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
