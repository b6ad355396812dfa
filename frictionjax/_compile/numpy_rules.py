"""Steps of a traced program, by their names, in NumPy."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

Rule = Callable[..., Any]


def _termwise(fn: Callable) -> Rule:
    return lambda params, *operands: fn(*operands)


def _select(params: dict, which: Any, *cases: Any) -> Any:
    found = cases[0]
    for number, case in enumerate(cases[1:], start=1):
        found = np.where(which == number, case, found)
    return found


def _converted(params: dict, x: Any) -> Any:
    stays = np.issubdtype(params["new_dtype"], np.complexfloating)
    return x.real if x.dtype.kind == "c" and not stays else x


def _rounded(params: dict, x: Any) -> Any:
    to_even = int(params["rounding_method"]) == 1
    return np.rint(x) if to_even else np.trunc(x + np.copysign(0.5, x))


def _broadcast(params: dict, x: Any, *sizes: Any) -> Any:
    shape = [1] * len(params["shape"])
    for axis, size in zip(params["broadcast_dimensions"], x.shape, strict=True):
        shape[axis] = size
    return np.broadcast_to(x.reshape(shape), params["shape"])


def _reduced(fn: Callable) -> Rule:
    return lambda params, x: fn(x, axis=tuple(params["axes"]))


def _slice(params: dict, x: Any) -> Any:
    starts, limits, strides = (
        params[k] for k in ("start_indices", "limit_indices", "strides")
    )
    steps = strides or (1,) * len(starts)
    return x[tuple(map(slice, starts, limits, steps))]


# Steps that NumPy calls as JAX does.
_ALIKE = (
    *("sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "exp2", "expm1", "log", "log1p"),
    *("sqrt", "cbrt", "square", "abs", "sign", "floor", "ceil"),
)

_TERMWISE: dict[str, Callable] = {name: getattr(np, name) for name in _ALIKE} | {
    "add": np.add,
    "add_any": np.add,
    "sub": np.subtract,
    "mul": np.multiply,
    "neg": np.negative,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "atan2": np.arctan2,
    "asinh": np.arcsinh,
    "acosh": np.arccosh,
    "atanh": np.arctanh,
    "rsqrt": lambda x: 1 / np.sqrt(x),
    "logistic": lambda x: 1 / (1 + np.exp(-x)),
    "erf": np.vectorize(math.erf, otypes=[float]),
    "erfc": np.vectorize(math.erfc, otypes=[float]),
    "pow": np.power,
    "max": np.maximum,
    "min": np.minimum,
    "eq": np.equal,
    "ne": np.not_equal,
    "lt": np.less,
    "le": np.less_equal,
    "gt": np.greater,
    "ge": np.greater_equal,
    "is_finite": np.isfinite,
    "copy": lambda x: x,
    "stop_gradient": lambda x: x,
    "rem": np.fmod,
    "clamp": lambda low, x, high: np.minimum(np.maximum(x, low), high),
}

RULES: dict[str, Rule] = {name: _termwise(fn) for name, fn in _TERMWISE.items()} | {
    "div": lambda params, a, b: np.trunc(a / b) if a.dtype.kind in "iu" else a / b,
    "integer_pow": lambda params, x: np.power(x, params["y"]),
    "convert_element_type": _converted,
    "select_n": _select,
    "round": _rounded,
    "broadcast_in_dim": _broadcast,
    "reshape": lambda params, x, *sizes: x.reshape(params["new_sizes"]),
    "squeeze": lambda params, x: np.squeeze(x, axis=tuple(params["dimensions"])),
    "transpose": lambda params, x: np.transpose(x, params["permutation"]),
    "concatenate": lambda params, *x: np.concatenate(x, axis=params["dimension"]),
    "stack": lambda params, *x: np.stack(x, axis=params["axis"]),
    "slice": _slice,
    "reduce_sum": _reduced(np.sum),
    "reduce_max": _reduced(np.max),
    "reduce_min": _reduced(np.min),
    "reduce_or": _reduced(np.any),
    "reduce_and": _reduced(np.all),
    "argmin": lambda params, x: np.argmin(x, axis=params["axes"][0]),
    "argmax": lambda params, x: np.argmax(x, axis=params["axes"][0]),
    "and": lambda params, a, b: a & b,
    "or": lambda params, a, b: a | b,
    "not": lambda params, a: ~a,
}
"""A step's operands, after its parameters, to its one result."""
