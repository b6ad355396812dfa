"""What a result is of: kept as a note beside it, for as long as it lives.

As a field it would be a leaf of every result, and functions of a scene can be none.
"""

import inspect
from collections.abc import Callable
from functools import wraps
from typing import Any, NamedTuple, TypeVar, cast

import numpy as np

from .arguments import is_concrete, known_numbers, require
from .parts import ByIdentity, Part, asked_names

_Solver = TypeVar("_Solver", bound=Callable)
_ORIGINS = ByIdentity()
_ROUNDING = 1e-12  # of the largest number: another way to round them is no other part
_NOTES = "slope_error", "slope_taken"  # of how well a surface is known


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

    Numbers that parts were built from are compared, to rounding: a spline that was saved
    has others. Functions are not, nor effects.
    """
    cell = origin_of(solution)
    if cell is None:
        return
    for name in ("profile", "bristle", "potential", "support", "load"):
        given, own = getattr(scene, name), getattr(cell.scene, name)
        alike = _same(given, own)
        require(alike, f"scene.{name}", given, "the one that the solution is of")
    if eps is not None and cell.eps is not None and is_concrete(cell.eps):
        given, own = float(eps), float(cell.eps)
        told = f"{own!r}, as the solution is of that one"
        require(_close(given, own), "eps", given, told)


def _same(given: Any, own: Any) -> bool:
    """Whether two parts are of one class and were built from the same numbers."""
    if type(given) is not type(own):
        return False
    if not isinstance(given, Part):
        numbers = known_numbers(given), known_numbers(own)
        return any(n.dtype == object for n in numbers) or _close(*numbers)
    names = (name for name in asked_names(type(given), {}) if name not in _NOTES)
    return all(_same(getattr(given, n, None), getattr(own, n, None)) for n in names)


def _close(given: Any, own: Any) -> bool:
    """Whether numbers are the same, of one shape, however they were rounded."""
    if np.shape(given) != np.shape(own):
        return False
    size = np.max(np.abs(own), initial=0.0)
    return bool(np.all(np.abs(np.subtract(given, own)) <= _ROUNDING * size))


def _cell_of(solution: Any) -> _Cell:
    cell = origin_of(solution)
    needs = "one that solve has returned, not made of its leaves: fx.mechanics reads it"
    require(cell is not None, "solution", "of no scene that is known", needs)
    return cell
