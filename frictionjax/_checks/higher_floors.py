"""What stands on floors above, for what is asked there of something below."""

from importlib import import_module
from typing import Any


def floor_above(package: str) -> Any:
    """A package of the library that knows what asks for it, imported when it is asked."""
    return import_module(f"{__name__.partition('.')[0]}.{package}")
