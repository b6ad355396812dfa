"""What a result is of: kept as a note beside it, for as long as it lives.

As a field it would be a leaf of every result, and functions of a scene can be none.
"""

import inspect
from collections.abc import Callable
from functools import wraps
from typing import Any, NamedTuple, TypeVar, cast

from .arguments import is_concrete, require
from .parts import ByIdentity

_Solver = TypeVar("_Solver", bound=Callable)
_ORIGINS = ByIdentity()


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


def _cell_of(solution: Any) -> _Cell:
    cell = origin_of(solution)
    needs = "one that solve has returned, not made of its leaves: fx.mechanics reads it"
    require(cell is not None, "solution", "of no scene that is known", needs)
    return cell
