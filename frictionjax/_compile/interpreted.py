"""Functions of parts and arrays, evaluated once: step by step in NumPy, uncompiled."""

from collections.abc import Callable
from typing import Any

import jax
import numpy as np
from jax.extend.core import Literal

from .._checks import is_debugged, with_nan
from .numpy_rules import RULES
from .programs import put_together, taken_apart

_MOST = 32  # programs kept of one function, and what a user's function holds
_SHORT = 64  # turns of a loop from which on JAX makes all of them at once
# Steps that only call, by name: `reduce` has a `jaxpr` too, which is no call.
CALLS = {
    "jit": "jaxpr",
    "closed_call": "call_jaxpr",
    "remat2": "jaxpr",
    "checkpoint": "jaxpr",
    "custom_jvp_call": "call_jaxpr",
    "custom_vjp_call": "call_jaxpr",
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
            found = _traced(self._fn, what[0], what[1], arrays)
            if len(self._known) >= _MOST:
                self._known.clear()
            self._known[key] = found
        run, out = found
        run = with_nan(run) if is_debugged() else run
        with np.errstate(all="ignore"):
            return jax.tree_util.tree_unflatten(out, run(*arrays))


@Interpreted
def values_at(fn: Callable, places: Any) -> Any:
    """A part, or a function, at places (n,): of each the value alone."""
    return jax.vmap(fn)(places)


def _traced(fn: Callable, structure: Any, rest: tuple, arrays: list) -> tuple[Any, Any]:
    def flat(numbers: list) -> Any:
        return fn(*put_together(numbers, structure, rest))

    with jax.ensure_compile_time_eval():
        closed, shapes = jax.make_jaxpr(flat, return_shape=True)(arrays)
    return _in_steps(closed), jax.tree_util.tree_structure(shapes)


def _in_steps(closed: Any) -> Callable[..., list]:
    """A traced program as calls on one list of values, in which each has its place.

    (Looked up by name at each call: half as long again.)
    """
    jaxpr = getattr(closed, "jaxpr", closed)
    # Copies: a user's array may change later.
    start = [np.array(c) for c in getattr(closed, "consts", ())]
    places = {var: place for place, var in enumerate(jaxpr.constvars)}

    def placed(atoms: Any) -> list[int]:
        return [place_of(atom) for atom in atoms]

    def place_of(atom: Any) -> int:
        if isinstance(atom, Literal):
            start.append(np.asarray(atom.val))
            return len(start) - 1
        if atom not in places:
            places[atom] = len(start)
            start.append(np.asarray(0))
        return places[atom]

    given = placed(jaxpr.invars)
    steps = [(_step(e), placed(e.invars), placed(e.outvars)) for e in jaxpr.eqns]
    wanted = placed(jaxpr.outvars)

    def run(*operands: Any) -> list:
        values = start.copy()
        for place, operand in zip(given, operands, strict=True):
            values[place] = operand
        for step, takes, gives in steps:
            found = step(*[values[place] for place in takes])
            for place, value in zip(gives, found, strict=True):
                values[place] = value
        return [values[place] for place in wanted]

    return run


def _step(eqn: Any) -> Callable[..., list]:
    name, params = eqn.primitive.name, eqn.params
    if name in CALLS:
        return _in_steps(params[CALLS[name]])
    if name == "cond":
        ways = [_in_steps(way) for way in params["branches"]]
        return lambda which, *rest: ways[int(np.clip(which, 0, len(ways) - 1))](*rest)
    if name == "while":
        return _while(params)
    if name == "scan" and 0 < params["length"] <= _SHORT:
        return _scan(eqn)
    rule = RULES.get(name)
    if rule is not None:
        dtype = eqn.outvars[0].aval.dtype
        return lambda *operands: [np.asarray(rule(params, *operands), dtype)]
    return lambda *operands: _made_by_jax(eqn.primitive, params, operands)


def _made_by_jax(primitive: Any, params: dict, operands: tuple) -> list:
    with jax.ensure_compile_time_eval():
        found = primitive.bind(*operands, **params)
    return [np.asarray(v) for v in (found if primitive.multiple_results else [found])]


def _while(params: dict) -> Callable[..., list]:
    goes_on, moved = _in_steps(params["cond_jaxpr"]), _in_steps(params["body_jaxpr"])
    asked, count = params["cond_nconsts"], params["cond_nconsts"] + params["body_nconsts"]

    def run(*operands: Any) -> list:
        carry = list(operands[count:])
        while np.any(going := goes_on(*operands[:asked], *carry)[0]):
            after = moved(*operands[asked:count], *carry)
            # Under `vmap` each has an end of its own, and stays where it came to.
            carry = [_where(going, *pair) for pair in zip(after, carry, strict=True)]
        return carry

    return run


def scan_counts(eqn: Any) -> tuple[int, int]:
    """How many operands of a scan stay what they are, and how many are carried on.

    By their ranks, as rows are given and gathered with an axis more: the parameters that
    tell have other names from one version of JAX to the next.
    """
    body = getattr(eqn.params["jaxpr"], "jaxpr", eqn.params["jaxpr"])
    rows = _deeper(eqn.invars, body.invars)
    carried = len(eqn.outvars) - _deeper(eqn.outvars, body.outvars)
    return len(eqn.invars) - carried - rows, carried


def _deeper(outside: list, inside: list) -> int:
    pairs = zip(outside, inside, strict=True)
    return sum(one.aval.ndim > other.aval.ndim for one, other in pairs)


def _scan(eqn: Any) -> Callable[..., list]:
    params, (fixed, count) = eqn.params, scan_counts(eqn)
    body, order = _in_steps(params["jaxpr"]), range(params["length"])
    carried = fixed + count

    def run(*operands: Any) -> list:
        carry, rows = list(operands[fixed:carried]), []
        for i in reversed(order) if params["reverse"] else order:
            each = [np.asarray(column[i]) for column in operands[carried:]]
            found = body(*operands[:fixed], *carry, *each)
            carry, row = found[:count], found[count:]
            rows.append(row)
        rows = rows[::-1] if params["reverse"] else rows
        return [*carry, *map(np.stack, zip(*rows, strict=True))]

    return run


def _where(chosen: np.ndarray, one: np.ndarray, other: np.ndarray) -> np.ndarray:
    if np.ndim(chosen) == 0:
        return one
    of_each = np.reshape(chosen, chosen.shape + (1,) * (one.ndim - chosen.ndim))
    return np.where(of_each, one, other)
