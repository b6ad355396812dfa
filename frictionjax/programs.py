"""Functions of parts and arrays, compiled."""

from collections.abc import Callable
from typing import Any

import jax
import numpy as np

from .kept_programs import kept

_MOST = 256  # programs kept of one function


class Program:
    """`fn(*args)` compiled; arguments and results are trees of arrays.

    As `eqx.filter_jit`: whatever is no array, such as a function in a part, belongs to
    the program. A call costs 20 us where that takes 120, which counts in a sweep of
    hundreds of calls; NumPy arrays are passed as they are (`jnp.asarray` before: 50 us
    each, and a program for each shape).
    """

    def __init__(self, fn: Callable):
        self._fn = fn
        self._known: dict[Any, Callable] = {}

    def __call__(self, *args: Any) -> Any:
        leaves, structure = jax.tree_util.tree_flatten(args)
        numbers = [leaf for leaf in leaves if isinstance(leaf, _ARRAYS)]
        rest: tuple = ()
        if len(numbers) < len(leaves):
            rest = tuple((i, x) for i, x in enumerate(leaves) if not isinstance(x, _ARRAYS))
        key = structure, rest
        program = self._known.get(key)
        if program is None:
            program = self._compiled(structure, rest)
            if len(self._known) >= _MOST:
                self._known.clear()
            self._known[key] = program
        return program(numbers)

    def _compiled(self, structure: Any, rest: tuple) -> Callable:
        fn = self._fn

        def run(numbers):
            leaves = list(numbers)
            for index, leaf in rest:
                leaves.insert(index, leaf)
            return fn(*jax.tree_util.tree_unflatten(structure, leaves))

        run.__name__ = run.__qualname__ = fn.__name__
        return kept(fn, run, structure, rest)


_ARRAYS = (jax.Array, np.ndarray, np.generic)


def in_chunks(
    program: Callable, size: int, fixed: tuple, columns: tuple[np.ndarray, ...]
) -> Any:
    """`program(*fixed, *columns)` of columns of any length, NumPy arrays in a tree.

    The columns go in pieces of `size`, the last lengthened by its last entry: one shape,
    so one program, where four sizes took 0.5 s of a study to trace and fetch.
    """
    count = columns[0].shape[0]
    short = -count % size
    whole = [_lengthened(column, short) for column in columns]
    parts = [
        program(*fixed, *(c[at : at + size] for c in whole)) for at in range(0, count, size)
    ]

    def joined(*values: Any) -> np.ndarray:
        found = [np.asarray(v) for v in values]
        return (found[0] if len(found) == 1 else np.concatenate(found))[:count]

    return jax.tree_util.tree_map(joined, *parts)


def _lengthened(column: np.ndarray, by: int) -> np.ndarray:
    if by == 0:
        return column
    # `np.pad` takes 20 us.
    return np.concatenate([column, np.repeat(column[-1:], by, axis=0)])


def room(count: int, least: int, factor: int = 4) -> int:
    """The smallest of least, factor least, factor^2 least ... that holds `count`."""
    size = least
    while size < count:
        size *= factor
    return size
