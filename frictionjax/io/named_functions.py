"""Parts made of Python functions, which scene files name: "module:function".

To read such a file runs the code of the module, so it is imported only where the reader
allows it.
"""

import importlib
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple

from .. import bristles, loads, profiles, supports
from .._checks import ByIdentity
from ..model import GivenPotential

_NAMES = ByIdentity()  # of functions that a file has named
_ALLOW = "load_scene(..., functions=True), or --functions: their modules are imported"


class PathWithFunctions(str):
    """A path of a scene file whose functions may be imported."""

    __slots__ = ()


class FunctionKind(NamedTuple):
    """A class of part: arguments that are functions, others that are numbers, and what of
    all may be left out."""

    build: type
    functions: tuple[str, ...]
    numbers: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()


FUNCTION_KINDS: dict[str, dict[str, FunctionKind]] = {
    "profile": {"Custom": FunctionKind(profiles.Custom, ("fn",), ("points",), ("points",))},
    "bristle": {"Custom": FunctionKind(bristles.Custom, ("offset", "energy"))},
    "support": {"Convex": FunctionKind(supports.Convex, ("energy",))},
    "load": {
        "Custom": FunctionKind(
            loads.Custom, ("fn",), ("turning_points",), ("turning_points",)
        )
    },
    "potential": {
        "GivenPotential": FunctionKind(
            GivenPotential, ("W", "Q"), ("points",), ("Q", "points")
        )
    },
}
"""Of every table of a scene the kinds that are made of functions."""


def function_of(where: str, text: Any, folder: Path, allowed: bool) -> Callable:
    """The function that a file in `folder` names.

    Modules are looked for beside the file first. Raises `ValueError` where it is not
    allowed, and for what cannot be imported or is no function.
    """
    said = f"{where} = {text!r}"
    module, _, name = str(text).partition(":")
    known = isinstance(text, str) and module and name
    need(bool(known), said, 'a function by name, "module:function"')
    need(allowed, said, f"the reader's word for it, {_ALLOW}")
    with _beside(folder):
        try:
            found: Any = importlib.import_module(module)
        except (Exception, SystemExit) as problem:  # whatever the module does
            raise ValueError(f"{said}: {_one_line(problem)}") from problem
    for part in name.split("."):
        need(hasattr(found, part), said, f"a name that {module} has")
        found = getattr(found, part)
    need(callable(found), said, "a function")
    with suppress(TypeError):  # of some kinds there are no weak references
        _NAMES.put(found, text)
    return found


def name_of(fn: Any) -> str | None:
    """What a file calls a function by, None of one that no module holds by a name."""
    known = _NAMES.get(fn)
    if known is not None:
        return known
    module, name = getattr(fn, "__module__", None), getattr(fn, "__qualname__", None)
    if not module or not name or module == "__main__":
        return None
    found: Any = sys.modules.get(module)
    for part in name.split("."):
        found = getattr(found, part, None)
    return f"{module}:{name}" if found is fn else None


@contextmanager
def _beside(folder: Path) -> Iterator[None]:
    place = str(folder.resolve())
    sys.path.insert(0, place)
    try:
        yield
    finally:
        sys.path.remove(place)


def _one_line(problem: BaseException) -> str:
    said = " ".join(str(problem).split())
    return f"{type(problem).__name__}: {said}" if said else type(problem).__name__


def need(condition: Any, said: str, allowed: str) -> None:
    """Like `require`, in the words of the file rather than of a constructor."""
    if not condition:
        raise ValueError(f"{said}: needs {allowed}")
