"""What a result is of: kept as a note beside it, for as long as it lives.

As a field it would be a leaf of every result, and functions of a scene can be none.
"""

import inspect
from collections.abc import Callable
from functools import wraps
from typing import Any, NamedTuple, TypeVar, cast

import numpy as np
from jax.tree_util import tree_leaves

from .arguments import is_concrete, require
from .parts import ByIdentity

_Solver = TypeVar("_Solver", bound=Callable)
_ORIGINS = ByIdentity()
_SAME_EPS = 1e-12  # relative: another way to round it is no other eps


class _Cell(NamedTuple):
    """What a trajectory is of: a scene, and eps in m; None of the limit."""

    scene: Any
    eps: Any


def note_origin(result: Any, origin: Any) -> None:
    """Keep what a result is of, which must not hold the result; nothing where traced."""
    if is_concrete(origin, result):
        _ORIGINS.put(result, origin)


def origin_of(result: Any) -> Any:
    """What a result is of; None where nothing is known of it."""
    return _ORIGINS.get(result)


def noting_the_scene(solve: _Solver) -> _Solver:
    """A solver of a `scene`, and at an `eps`, whose solutions know these if not traced."""

    arguments = inspect.signature(solve)

    @wraps(solve)
    def noted(*args: Any, **kwargs: Any) -> Any:
        solution = solve(*args, **kwargs)
        asked = arguments.bind(*args, **kwargs).arguments
        note_origin(solution, _Cell(asked["scene"], asked.get("eps")))
        return solution

    return cast(_Solver, noted)


def scene_of(solution: Any) -> Any:
    """The scene of a trajectory. Raises `ValueError` where nothing is known of it."""
    return _cell_of(solution).scene


def eps_of(solution: Any) -> Any:
    """The eps of a trajectory; None of the limit's. Raises as `scene_of` does."""
    return _cell_of(solution).eps


def require_own(solution: Any, scene: Any, eps: Any) -> None:
    """Raise where a trajectory is known to be of other parts, or of another eps in m.

    Functions in parts are not compared, nor effects.
    """
    cell = origin_of(solution)
    if cell is None:
        return
    for name in ("profile", "bristle", "potential", "support", "load"):
        given, own = getattr(scene, name), getattr(cell.scene, name)
        same = type(given) is type(own) and _numbers(given) == _numbers(own)
        require(same, f"scene.{name}", given, "the one that the solution is of")
    if eps is not None and cell.eps is not None and is_concrete(cell.eps):
        own = float(cell.eps)
        alike = abs(float(eps) - own) <= _SAME_EPS * own
        require(alike, "eps", eps, f"{own:.6g}, as the solution is of that one")


def _numbers(part: Any) -> list:
    """What two parts alike have in common: shapes, and digits."""
    arrays = [np.asarray(leaf) for leaf in tree_leaves(part) if not callable(leaf)]
    return [(array.shape, array.tobytes()) for array in arrays]


def _cell_of(solution: Any) -> _Cell:
    cell = origin_of(solution)
    needs = "one that solve has returned, not made of its leaves: fx.mechanics reads it"
    require(cell is not None, "solution", "of no scene that is known", needs)
    return cell
