"""Functions of parts and arrays, evaluated once: step by step in NumPy, uncompiled."""

from collections.abc import Callable
from typing import Any

import jax
import numpy as np
from jax.extend.core import Literal

from .numpy_rules import RULES
from .programs import put_together, taken_apart

_MOST = 256  # programs kept of one function
# Steps that only call, by name: `reduce` has a `jaxpr` too, which is no call.
CALLS = {
    "jit": "jaxpr",
    "pjit": "jaxpr",
    "closed_call": "call_jaxpr",
    "core_call": "call_jaxpr",
    "remat": "jaxpr",
    "checkpoint": "jaxpr",
    "custom_jvp_call": "call_jaxpr",
    "custom_vjp_call": "call_jaxpr",
    "custom_vjp_call_jaxpr": "fun_jaxpr",
}


class Interpreted:
    """`fn(*args)` by NumPy; arguments and results are trees of arrays.

    As in a `Program`, what is no array belongs to the program. For what is asked of a part
    once: to compile it takes 0.03 to 0.3 s for every class of part; to trace it and go
    through its steps 3 ms, and 0.2 ms where the class has been seen. Steps without a rule
    here are made by JAX, one by one.
    """

    def __init__(self, fn: Callable):
        self._fn = fn
        self._known: dict[Any, tuple[Any, Any]] = {}

    def __call__(self, *args: Any) -> Any:
        numbers, what = taken_apart(args)
        arrays = [np.asarray(number) for number in numbers]
        key = what, tuple([(a.shape, a.dtype) for a in arrays])
        found = self._known.get(key)
        if found is None:
            whole = jax.tree_util.tree_structure(args)
            found = _traced(self._fn, whole, what[1], arrays)
            if len(self._known) >= _MOST:
                self._known.clear()
            self._known[key] = found
        closed, out = found
        with np.errstate(all="ignore"):
            results = _run(closed.jaxpr, closed.consts, arrays)
        return jax.tree_util.tree_unflatten(out, results)


def _traced(fn: Callable, structure: Any, rest: tuple, arrays: list) -> tuple[Any, Any]:
    def flat(numbers: list) -> Any:
        return fn(*put_together(numbers, structure, rest))

    with jax.ensure_compile_time_eval():
        closed, shapes = jax.make_jaxpr(flat, return_shape=True)(arrays)
    return closed, jax.tree_util.tree_structure(shapes)


def _run(jaxpr: Any, constants: Any, arguments: list) -> list:
    known = dict(zip(jaxpr.constvars, map(np.asarray, constants), strict=True))
    known |= dict(zip(jaxpr.invars, arguments, strict=True))

    def read(atom: Any) -> Any:
        return np.asarray(atom.val) if isinstance(atom, Literal) else known[atom]

    for eqn in jaxpr.eqns:
        results = _results(eqn, [read(atom) for atom in eqn.invars])
        known |= dict(zip(eqn.outvars, results, strict=True))
    return [read(atom) for atom in jaxpr.outvars]


def _results(eqn: Any, operands: list) -> list:
    name, params = eqn.primitive.name, eqn.params
    if name in CALLS:
        return _call(params[CALLS[name]], operands)
    if name == "cond":
        which = int(np.clip(operands[0], 0, len(params["branches"]) - 1))
        return _call(params["branches"][which], operands[1:])
    if name == "while":
        return _while(params, operands)
    rule = RULES.get(name)
    if rule is not None:
        (aval,) = [var.aval for var in eqn.outvars]
        return [np.asarray(rule(params, *operands), dtype=aval.dtype)]
    with jax.ensure_compile_time_eval():
        found = eqn.primitive.bind(*operands, **params)
    return [np.asarray(v) for v in (found if eqn.primitive.multiple_results else [found])]


def _call(closed: Any, operands: list) -> list:
    return _run(getattr(closed, "jaxpr", closed), getattr(closed, "consts", ()), operands)


def _while(params: dict, operands: list) -> list:
    condition, body = params["cond_nconsts"], params["body_nconsts"]
    fixed = operands[:condition], operands[condition : condition + body]
    carry = operands[condition + body :]
    while np.any(goes_on := _call(params["cond_jaxpr"], [*fixed[0], *carry])[0]):
        moved = _call(params["body_jaxpr"], [*fixed[1], *carry])
        # Under `vmap` each has an end of its own, and stays where it came to.
        carry = [_where(goes_on, *pair) for pair in zip(moved, carry, strict=True)]
    return carry


def _where(chosen: np.ndarray, one: np.ndarray, other: np.ndarray) -> np.ndarray:
    if np.ndim(chosen) == 0:
        return one
    of_each = np.reshape(chosen, chosen.shape + (1,) * (one.ndim - chosen.ndim))
    return np.where(of_each, one, other)
