"""Arguments by name that a design hands on to another one."""

import inspect
from collections.abc import Callable, Mapping
from typing import Any


def require_passed_on(caller: str, to: Callable, given: Mapping[str, Any]) -> None:
    """Raise `TypeError`, as Python does, of what neither of the two has."""
    known = inspect.signature(to).parameters
    for name in given:
        if name not in known:
            told = f"{caller}() got an unexpected keyword argument {name!r}"
            raise TypeError(told)
