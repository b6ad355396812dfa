"""Annotated shapes, checked at every call."""

from collections.abc import Callable
from typing import Any, get_args, get_origin

from beartype import beartype
from jaxtyping import AbstractArray


def holds_shape(hint: Any) -> bool:
    """Whether a hint has an array with its shape in it, other than one of a callable."""
    if isinstance(hint, type) and issubclass(hint, AbstractArray):
        return True
    if get_origin(hint) is Callable:
        return False
    return any(holds_shape(part) for part in get_args(hint))


def shapes_checked(fn: Any) -> Any:
    """A function that checks its hints with shapes, and no others, which mypy does."""
    hints = getattr(fn, "__annotations__", {})
    fn.__annotations__ = {name: hint for name, hint in hints.items() if holds_shape(hint)}
    return beartype(fn)
