"""Arrays of jets: moved, picked, converted, summed; axis 0 holds the intervals."""

from collections.abc import Callable
from functools import reduce
from typing import Any

import numpy as np

from . import jet as jets
from .functions import maximum, minimum
from .interval import Interval, hull, where
from .jet import Jet


class NoRuleError(Exception):
    """A function uses what nothing here can bound; the message names it."""


def _broadcast(params: Any, a: Jet, *sizes: Jet) -> Jet:
    shape, places = params["shape"], params["broadcast_dimensions"]

    def spread(x: np.ndarray) -> np.ndarray:
        slim = [1] * len(shape)
        for axis, place in enumerate(places):
            slim[place] = x.shape[axis + 1]
        whole = x.reshape(x.shape[0], *slim)
        return np.broadcast_to(whole, (x.shape[0], *shape))

    return a.mapped(spread)


def _reshape(params: Any, a: Jet, *sizes: Jet) -> Jet:
    return a.mapped(lambda x: x.reshape(x.shape[0], *params["new_sizes"]))


def _squeeze(params: Any, a: Jet) -> Jet:
    axes = tuple(axis + 1 for axis in params["dimensions"])
    return a.mapped(lambda x: np.squeeze(x, axis=axes))


def _transpose(params: Any, a: Jet) -> Jet:
    axes = (0, *(axis + 1 for axis in params["permutation"]))
    return a.mapped(lambda x: np.transpose(x, axes))


def _slice(params: Any, a: Jet) -> Jet:
    strides = params["strides"] or (1,) * len(params["start_indices"])
    ends = zip(params["start_indices"], params["limit_indices"], strides, strict=True)
    cut = (slice(None), *(slice(*end) for end in ends))
    return a.mapped(lambda x: x[cut])


def _reverse(params: Any, a: Jet) -> Jet:
    axes = tuple(axis + 1 for axis in params["dimensions"])
    return a.mapped(lambda x: np.flip(x, axes))


def _joined(rows: list[Jet], axis: int) -> Jet:
    # Constants have one row, whatever the count, which may be 0.
    (count,) = np.broadcast_shapes(*(jet.seam.shape[:1] for jet in rows))
    whole = [j.mapped(lambda x: np.broadcast_to(x, (count, *x.shape[1:]))) for j in rows]

    def join(part: Callable[[Jet], np.ndarray]) -> np.ndarray:
        return np.concatenate([part(jet) for jet in whole], axis=axis)

    value, slope, bend = (
        Interval(join(lambda j, i=i: j[i].lo), join(lambda j, i=i: j[i].hi))
        for i in range(3)
    )
    return Jet(value, slope, bend, join(lambda j: j.seam))


def _concatenate(params: Any, *rows: Jet) -> Jet:
    return _joined(list(rows), params["dimension"] + 1)


def _rows(a: Jet, axis: int) -> list[Jet]:
    """Its entries along an axis."""
    count, place = a.seam.shape[axis + 1], axis + 1
    return [a.mapped(lambda x, k=k: np.take(x, k, place)) for k in range(count)]


def stack(rows: list[Jet], axis: int = 0) -> Jet:
    """Along a new axis."""
    place = axis + 1
    return _joined([jet.mapped(lambda x: np.expand_dims(x, place)) for jet in rows], place)


def _stack(params: Any, *rows: Jet) -> Jet:
    return stack(list(rows), params["axis"])


def _cumulated(params: Any, a: Jet) -> Jet:
    """Sums so far, of whole numbers as of others."""
    axis = params["axis"]
    rows = _rows(a, axis)
    if params["reverse"]:
        rows.reverse()
    sums = [rows[0]]
    for row in rows[1:]:
        sums.append(jets.add(sums[-1], row))
    if params["reverse"]:
        sums.reverse()
    return stack(sums, axis)


def _largest_at(params: Any, a: Jet) -> Jet:
    """The first of the largest."""
    axis = params["axes"][0] + 1
    lo, hi = a.value
    may = hi >= np.max(lo, axis=axis, keepdims=True)
    sure = lo >= np.max(hi, axis=axis, keepdims=True)
    last = may.shape[axis] - 1 - np.argmax(np.flip(may, axis), axis=axis)
    first_sure = np.where(sure.any(axis=axis), np.argmax(sure, axis=axis), last)
    found = np.argmax(may, axis=axis), np.minimum(last, first_sure)
    return jets.constant(Interval(*(place.astype(float) for place in found)))


def _iota(params: Any) -> Jet:
    shape, axis = params["shape"], params["dimension"]
    slim = [-1 if k == axis else 1 for k in range(len(shape))]
    return jets.number(np.broadcast_to(np.arange(shape[axis]).reshape(slim), shape))


def _convert(params: Any, a: Jet) -> Jet:
    """Between kinds of numbers; what was true or whole jumps where it changes."""
    kind = np.dtype(params["new_dtype"]).kind
    if kind in "iu":
        return jets.constant(Interval(np.trunc(a.value.lo), np.trunc(a.value.hi)))
    if kind == "b":
        lo, hi = a.value
        false, true = (lo == 0) & (hi == 0), (lo > 0) | (hi < 0)
        return jets.constant(Interval(true.astype(float), (~false).astype(float)))
    still = (a.slope.lo == 0) & (a.slope.hi == 0) & (a.value.lo != a.value.hi)
    return a._replace(seam=a.seam | still)


def _dynamic_slice(params: Any, a: Jet, *starts: Jet) -> Jet:
    """Entries of a table at a place that may not be known to one."""
    if len(starts) != 1 or not a.is_point:
        raise NoRuleError("dynamic_slice of what changes")
    (size,), table = params["slice_sizes"], a.value.lo[0]
    last = table.shape[0] - size
    lo, hi = (np.clip(end, 0, last).astype(int) for end in starts[0].value)
    at = np.arange(size)
    first, second = table[lo[:, None] + at], table[hi[:, None] + at]
    near = hull(Interval(first, first), Interval(second, second))
    far = (hi - lo > 1)[:, None] & np.ones(size, dtype=bool)
    whole = hull(
        Interval(*(np.full(far.shape, table.min()),) * 2),
        Interval(*(np.full(far.shape, table.max()),) * 2),
    )
    unsure = (hi > lo)[:, None] & np.ones(size, dtype=bool)
    return jets.constant(where(far, whole, near), unsure)


def _summed(params: Any, a: Jet) -> Jet:
    return jets.summed(a, tuple(params["axes"]))


def _folded(rule: Callable[[Jet, Jet], Jet]) -> Callable:
    def fold(params: Any, a: Jet) -> Jet:
        for axis in sorted(params["axes"], reverse=True):
            a = reduce(rule, _rows(a, axis))
        return a

    return fold


def _dot(params: Any, a: Jet, b: Jet) -> Jet:
    """Sums of products over one axis of each."""
    (left, right), batch = params["dimension_numbers"]
    if any(batch) or len(left) != 1:
        raise NoRuleError("dot_general over several axes")
    rows = a.mapped(lambda x: np.moveaxis(x, left[0] + 1, -1))
    columns = b.mapped(lambda x: np.moveaxis(x, right[0] + 1, -1))
    more = columns.seam.ndim - 2
    rows = rows.mapped(lambda x: x.reshape(*x.shape[:-1], *(1,) * more, x.shape[-1]))
    less = rows.seam.ndim - columns.seam.ndim
    columns = columns.mapped(lambda x: x.reshape(x.shape[0], *(1,) * less, *x.shape[1:]))
    product = jets.mul(rows, columns)
    return jets.summed(product, (product.seam.ndim - 2,))


def _same(params: Any, a: Jet) -> Jet:
    return a


SHAPES: dict[str, Callable[..., Jet]] = {
    "argmax": _largest_at,
    "broadcast_in_dim": _broadcast,
    "concatenate": _concatenate,
    "convert_element_type": _convert,
    "copy": _same,
    "copy_p": _same,
    "cumsum": _cumulated,
    "dot_general": _dot,
    "dynamic_slice": _dynamic_slice,
    "iota": _iota,
    "optimization_barrier": _same,
    "reduce_max": _folded(maximum),
    "reduce_min": _folded(minimum),
    "reduce_sum": _summed,
    "reshape": _reshape,
    "rev": _reverse,
    "slice": _slice,
    "squeeze": _squeeze,
    "stack": _stack,
    "transpose": _transpose,
}
"""By the names that JAX has for them."""
