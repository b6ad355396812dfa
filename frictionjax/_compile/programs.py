"""Functions of parts and arrays, compiled."""

from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from .._checks import is_debugged, with_nan
from .flags import brief_options
from .program_cache import kept

_MOST = 256  # programs kept of one function


class Program:
    """`fn(*args)` compiled; arguments and results are trees of arrays.

    As `eqx.filter_jit`: whatever is no array, such as a function in a part, belongs to
    the program. A call costs 20 us where that takes 120, which counts in a sweep of
    hundreds of calls; NumPy arrays are passed as they are (`jnp.asarray` before: 50 us
    each, and a program for each shape).
    """

    def __init__(self, fn: Callable, brief: bool = False):
        self._fn, self._brief = fn, brief
        self._known: dict[Any, Callable] = {}

    def __call__(self, *args: Any) -> Any:
        numbers, key = taken_apart(args)
        program = self._known.get(key)
        if program is None:
            program = self._compiled(*key)
            if len(self._known) >= _MOST:
                self._known.clear()
            self._known[key] = program
        if is_debugged():
            return with_nan(program)(numbers)
        return program(numbers)

    def _compiled(self, structure: Any, rest: tuple) -> Callable:
        fn = self._fn

        def run(numbers: list) -> Any:
            return fn(*put_together(numbers, structure, rest))

        run.__name__ = run.__qualname__ = fn.__name__
        options = brief_options() if self._brief else None
        return kept(fn, run, structure, rest, options)


def once_a_scene(fn: Callable) -> Program:
    """`Program(fn)` that compiles in less time and runs longer.

    LLVM's level 0: what runs once or twice a scene takes 0.3 to 0.7 s of a core to compile
    for 0.4 to 1.3, and up to a third of a millisecond longer to run.
    """
    return Program(fn, brief=True)


ARRAYS = (jax.Array, np.ndarray, np.generic)


def strong_arrays(tree: Any) -> Any:
    """Plain floats that hide in the tracers of `jax.grad(f)(0.1)` as arrays.

    Rules of derivatives get them as they are, and take what is no array for a constant.
    """

    def strong(leaf: Any) -> Any:
        return jnp.asarray(leaf, dtype=float) if eqx.is_inexact_array(leaf) else leaf

    return jax.tree_util.tree_map(strong, tree)


def taken_apart(args: tuple) -> tuple[list, tuple]:
    """Arrays of some arguments, and what else there is: structures, other leaves."""
    leaves, structure = jax.tree_util.tree_flatten(args)
    numbers = [leaf for leaf in leaves if isinstance(leaf, ARRAYS)]
    rest: tuple = ()
    if len(numbers) < len(leaves):
        rest = tuple((i, x) for i, x in enumerate(leaves) if not isinstance(x, ARRAYS))
    return numbers, (structure, rest)


def put_together(numbers: list, structure: Any, rest: tuple) -> Any:
    """The arguments again, of the tree `structure`."""
    leaves = list(numbers)
    for index, leaf in rest:
        leaves.insert(index, leaf)
    return jax.tree_util.tree_unflatten(structure, leaves)


def in_chunks(
    program: Callable, size: int, fixed: tuple, columns: tuple[np.ndarray, ...]
) -> Any:
    """`program(*fixed, *columns)` of columns of any length, NumPy arrays in a tree.

    The columns go in pieces of `size`, the last lengthened by its last entry: one shape,
    so one program, where four sizes took 0.5 s of a study to trace and fetch.
    """
    count = columns[0].shape[0]
    padded = -(-count // size) * size
    whole = [_lengthened(column, padded) for column in columns]
    parts = [
        program(*fixed, *(c[at : at + size] for c in whole))
        for at in range(0, padded, size)
    ]

    outs = [jax.tree_util.tree_flatten(part) for part in parts]
    if len(outs) == 1:
        joined = [np.asarray(leaf)[:count] for leaf in outs[0][0]]
    else:
        rows = zip(*(leaves for leaves, _ in outs), strict=True)
        joined = [np.concatenate(pieces)[:count] for pieces in rows]
    return jax.tree_util.tree_unflatten(outs[0][1], joined)


def _lengthened(column: np.ndarray, to: int) -> np.ndarray:
    count = column.shape[0]
    if count == to:
        return column
    # `np.pad` takes 20 us.
    whole = np.empty((to, *column.shape[1:]), column.dtype)
    whole[:count], whole[count:] = column, column[-1:]
    return whole


def padded_size(count: int, least: int, factor: int = 4) -> int:
    """The smallest of least, factor least, factor^2 least ... that holds `count`."""
    size = least
    while size < count:
        size *= factor
    return size
