"""Parts as the call that makes them, with their numbers."""

import dataclasses
import html
import inspect
from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax
import numpy as np

from .arguments import is_known

_WIDTH = 88
_FEW = 6  # numbers that are written out


def notebook_text(thing: Any, table: Callable[[], Any]) -> str:
    """What a notebook shows, as HTML: a table of known numbers, else what prints show."""
    if is_known(thing):
        return table()._repr_html_()
    return f"<pre>{html.escape(repr(thing))}</pre>"


def part_text(part: Any, names: list[str]) -> str:
    """`Sine(slope=0.1)`: the class of a part, and arguments `names` with their values.

    What is as the constructor has it without being asked, and what is None, is left out.
    Long arrays are told by their number and range, traced ones by their shape. Arguments
    go on lines of their own where one would be too long.
    """
    stored = getattr(part, "_stored", {})
    known = inspect.signature(type(part).__init__).parameters
    given = {}
    for name in names:
        value = getattr(part, stored.get(name, name), None)
        default = known[name].default if name in known else inspect.Parameter.empty
        if value is not None and not _as_is(value, default):
            given[name] = _value_text(value)
    return _call(type(part).__name__, given)


def call_text(name: str, given: dict[str, Any]) -> str:
    """A call of another name than the class's, with what of its arguments is not None."""
    known = {key: _value_text(v) for key, v in given.items() if v is not None}
    return _call(name, known)


def exact_text(value: Any) -> str:
    """Any part with all of its fields, to the last digit of every number."""
    if isinstance(value, eqx.Module):
        names = [field.name for field in dataclasses.fields(value)]
        shown = {name: exact_text(getattr(value, name)) for name in names}
        return _call(type(value).__name__, shown)
    if isinstance(value, tuple | list):
        comma = "," if isinstance(value, tuple) and len(value) == 1 else ""
        inside = ", ".join(exact_text(v) for v in value) + comma
        return f"({inside})" if isinstance(value, tuple) else f"[{inside}]"
    if eqx.is_array_like(value):
        return repr(np.asarray(value).tolist())
    if callable(value):
        return getattr(value, "__qualname__", None) or repr(value)
    return repr(value)


def _value_text(value: Any) -> str:
    """One argument: numbers to six digits, parts as calls, functions by their names."""
    if isinstance(value, tuple | list) and any(isinstance(v, eqx.Module) for v in value):
        comma = "," if len(value) == 1 else ""
        return f"({', '.join(_value_text(v) for v in value)}{comma})"
    if isinstance(value, eqx.Module):
        return _module_text(value)
    if isinstance(value, jax.core.Tracer):
        return eqx.tree_pformat(value)
    if isinstance(value, jax.Array | np.ndarray | float | np.floating):
        return _numbers(np.asarray(value))
    if callable(value):
        return getattr(value, "__name__", type(value).__name__)
    return repr(value)


def _module_text(value: eqx.Module) -> str:
    """A part by its own `repr`; a function with leaves by its fields."""
    if type(value).__repr__ is not eqx.Module.__repr__:
        return repr(value)
    names = [field.name for field in dataclasses.fields(value)]
    shown = {name: _value_text(getattr(value, name)) for name in names}
    return _call(type(value).__name__, shown)


def _numbers(values: np.ndarray) -> str:
    if values.ndim == 0:
        return f"{float(values):.6g}" if values.dtype.kind == "f" else str(values)
    if values.ndim == 1 and values.size <= _FEW:
        return f"[{', '.join(_numbers(v) for v in values)}]"
    shape = " x ".join(str(n) for n in values.shape)
    if not values.size or values.dtype.kind not in "fiu":
        return f"<{shape} values>"
    return f"<{shape} values, {np.min(values):.3g} to {np.max(values):.3g}>"


def _as_is(value: Any, default: Any) -> bool:
    """Whether the constructor makes it so without being asked."""
    if value is default:
        return True
    if default is inspect.Parameter.empty or isinstance(value, jax.core.Tracer):
        return False
    if isinstance(value, tuple | list):
        return isinstance(default, tuple | list) and not value and not default
    return bool(np.ndim(value) == 0 and np.ndim(default) == 0 and value == default)


def _call(name: str, given: dict[str, str]) -> str:
    arguments = [f"{key}={text}" for key, text in given.items()]
    line = f"{name}({', '.join(arguments)})"
    if len(line) <= _WIDTH and "\n" not in line:
        return line
    indented = [argument.replace("\n", "\n  ") for argument in arguments]
    return f"{name}(\n  " + ",\n  ".join(indented) + "\n)"
