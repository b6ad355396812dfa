"""Numbers that functions of parts hold beside their arguments, as leaves of the parts.

Rules of derivatives see leaves: a traced number in a closure is one that JAX knows nothing
of there, and refuses.
"""

import inspect
from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from .._checks import Real, is_known


class TracedFunction(eqx.Module):
    """A function of scalars as JAX has traced it, and the numbers that it holds."""

    program: Any = eqx.field(static=True)
    numbers: list

    def __call__(self, *args: Real) -> Any:
        given = [jnp.asarray(arg, dtype=float) for arg in args]
        return jax.core.eval_jaxpr(self.program, self.numbers, *given)[0]


def hoisted(tree: Any) -> Any:
    """The tree, whose functions hold no traced numbers but as leaves."""

    def of_leaf(leaf: Any) -> Any:
        return leaf if not callable(leaf) or is_known(leaf) else _traced(leaf)

    return jax.tree_util.tree_map(of_leaf, tree)


def _traced(fn: Callable) -> TracedFunction:
    scalars = [np.zeros(())] * _arguments(fn)
    made = jax.make_jaxpr(lambda *args: jnp.asarray(fn(*args), dtype=float))(*scalars)
    return TracedFunction(made.jaxpr, made.consts)


def _arguments(fn: Callable) -> int:
    """One, or two where one is too few: functions of eps and Y."""
    try:
        inspect.signature(fn).bind(None)
    except TypeError:
        return 2
    except ValueError:
        pass  # no signature to be had
    return 1
