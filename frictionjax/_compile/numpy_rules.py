"""Steps of a traced program, by their names, in NumPy."""

import functools
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


def _padded(params: dict, x: Any, value: Any) -> Any:
    low, high, inside = zip(*params["padding_config"], strict=True)
    sizes = [max(0, n + (n - 1) * gap) for n, gap in zip(x.shape, inside, strict=True)]
    added = [(max(0, a), max(0, b)) for a, b in zip(low, high, strict=True)]
    whole = np.full([n + a + b for n, (a, b) in zip(sizes, added, strict=True)], value)
    places = [
        slice(a, a + n, 1 + gap)
        for n, (a, _), gap in zip(sizes, added, inside, strict=True)
    ]
    whole[tuple(places)] = x
    cuts = [  # what is less than nothing is cut off
        slice(max(0, -a), n - max(0, -b))
        for n, a, b in zip(whole.shape, low, high, strict=True)
    ]
    return whole[tuple(cuts)]


def _sliced_at(params: dict, x: Any, *starts: Any) -> Any:
    """A slice of a known size, moved to where all of it is inside."""
    sizes = params["slice_sizes"]
    firsts = [
        int(np.clip(start, 0, n - size))
        for start, n, size in zip(starts, x.shape, sizes, strict=True)
    ]
    return x[tuple(slice(at, at + size) for at, size in zip(firsts, sizes, strict=True))]


def _ordered(x: Any) -> Any:
    """Whole numbers in the order of floats that has -0 < 0 and NaN at its ends."""
    if x.dtype.kind != "f":
        return x
    bits = x.view(f"i{x.dtype.itemsize}")
    return np.where(bits < 0, bits ^ np.iinfo(bits.dtype).max, bits)


def _gathered(params: dict, x: Any, indices: Any) -> Any:
    """Slices of x at many places: `indices` (..., which axes), of which `...` stays."""
    how, sizes = params["dimension_numbers"], params["slice_sizes"]
    rooms = np.array(x.shape) - sizes
    wanted = {d: indices[..., k] for k, d in enumerate(how.start_index_map)}
    batch = indices.shape[:-1]
    for d, axis in zip(
        how.operand_batching_dims, how.start_indices_batching_dims, strict=True
    ):
        wanted[d] = np.arange(x.shape[d]).reshape(
            [-1 if i == axis else 1 for i in range(len(batch))]
        )
    gone = (*how.collapsed_slice_dims, *how.operand_batching_dims)
    window = [d for d in range(x.ndim) if d not in gone]
    places: list[Any] = []
    for d in range(x.ndim):
        start = np.clip(wanted.get(d, np.zeros(batch, int)), 0, rooms[d])
        start = np.reshape(start, start.shape + (1,) * len(window))
        along = [sizes[d] if d == other else 1 for other in window]
        places.append(start + np.arange(sizes[d] if d in window else 1).reshape(along))
    found = x[tuple(places)] if x.ndim else np.broadcast_to(x, batch)
    if "FILL" in str(params["mode"]).upper():
        found = _filled(params, found, [(wanted[d], rooms[d]) for d in wanted], window)
    shape = batch + tuple(sizes[d] for d in window)
    stays = [i for i in range(len(shape)) if i not in how.offset_dims]
    found = np.broadcast_to(found, shape)
    return np.moveaxis(found, range(len(shape)), [*stays, *how.offset_dims])


def _filled(params: dict, found: Any, asked: list, window: list) -> Any:
    """What was asked for outside of an array is no number, or the least or largest."""
    fill = params["fill_value"]
    if fill is None:
        kind = found.dtype.kind
        whole = {"i": lambda t: np.iinfo(t).min, "u": lambda t: np.iinfo(t).max}
        fill = True if kind == "b" else whole.get(kind, lambda t: np.nan)(found.dtype)
    inside = np.array(True)
    for start, room in asked:
        inside = inside & (start >= 0) & (start <= room)
    inside = np.reshape(inside, inside.shape + (1,) * len(window))
    return np.where(inside, found, np.asarray(fill, found.dtype))


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
    "polynomial": lambda x, *terms: functools.reduce(lambda t, c: t * x + c, terms[::-1]),
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
    "pad": _padded,
    "rev": lambda params, x: np.flip(x, tuple(params["dimensions"])),
    "dynamic_slice": _sliced_at,
    "gather": _gathered,
    "lt_to": lambda params, a, b: _ordered(a) < _ordered(b),
    "le_to": lambda params, a, b: _ordered(a) <= _ordered(b),
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
