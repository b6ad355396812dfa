"""Bounds of a function written with `jax.numpy` over intervals: its program, read."""

from collections.abc import Callable
from typing import Any

import jax
import numpy as np
from jax.extend.core import Literal

from .._compile import CALLS, scan_counts
from . import jet as jets
from .functions import ELEMENTARY, cos, integer_power, sin
from .interval import Interval
from .jet import Jet
from .logic import LOGIC, select
from .program import Program
from .program import TooMuchWorkError as TooMuchWorkError
from .settings import SETTINGS
from .shapes import SHAPES, NoRuleError, stack


class Enclosure:
    """`f`, `f'` and `f''` over intervals of t, by the rules of interval arithmetic.

    Values are those of the real function that the program stands for, with 64-bit
    constants, up to underflow; roundings are inside the bounds.
    """

    def __init__(self, closed: Any):
        with np.errstate(all="ignore"):
            self._program = Program(closed, _results, _inlined)

    def __call__(self, lo: np.ndarray, hi: np.ndarray) -> Jet:
        """Bounds over each [lo, hi], shapes (N,), increasing for speed.

        Raises `TooMuchWorkError` where more was computed than `allow` allows.
        """
        with np.errstate(all="ignore"):
            parts = self._program(lo, hi)
        return parts[0] if len(parts) == 1 else _joined(parts)

    def allow(self, numbers: float) -> None:
        """Let so many numbers be computed from now on, in all steps of the program."""
        self._program.most = self._program.spent + numbers


def _joined(parts: list[Jet]) -> Jet:
    rows = [jax.tree_util.tree_leaves(part) for part in parts]
    columns = [np.concatenate(column) for column in zip(*rows, strict=True)]
    structure = jax.tree_util.tree_structure(parts[0])
    return jax.tree_util.tree_unflatten(structure, columns)


def enclosure_of(fn: Callable) -> Enclosure:
    """That of a function of one number; raises `NoRuleError`."""
    with jax.ensure_compile_time_eval():
        closed = jax.make_jaxpr(lambda t: jax.numpy.asarray(fn(t), float))(0.5)
    try:
        found = Enclosure(closed)
        found(np.zeros(2), np.ones(2))  # what has no rule says so now
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        # Programs of another version of JAX may be written otherwise.
        raise NoRuleError("this program") from error
    return found


def run(jaxpr: Any, constants: list[Jet], arguments: list[Jet]) -> list[Jet]:
    """Results of a program for these arguments."""
    known = dict(zip(jaxpr.constvars, constants, strict=True))
    known |= dict(zip(jaxpr.invars, arguments, strict=True))

    def read(atom: Any) -> Jet:
        if isinstance(atom, Literal):
            return jets.number(np.asarray(atom.val))
        return known[atom]

    for eqn in jaxpr.eqns:
        found = _results(eqn, [read(atom) for atom in eqn.invars])
        known |= dict(zip(eqn.outvars, found, strict=True))
    return [read(atom) for atom in jaxpr.outvars]


def _results(eqn: Any, operands: list[Jet]) -> list[Jet]:
    name, params = eqn.primitive.name, eqn.params
    if name in CALLS:
        known = _known_call(params[CALLS[name]], operands)
        return known or _call(params[CALLS[name]], operands)
    if name == "scan":
        return _scan(eqn, operands)
    if name == "cond":
        return _branches(params["branches"], *operands)
    if any(_is_short(atom.aval) for atom in eqn.outvars):
        raise NoRuleError(f"{name} in 32 bits")
    if name in ("eq", "ne") and eqn.invars[0] is eqn.invars[1]:
        return [_told(name, operands[0])]
    if name in SHAPES:
        return [SHAPES[name](params, *operands)]
    if name in LOGIC:
        return [LOGIC[name](*_of_one_rank(operands))]
    return [_elementary(eqn, operands)]


def _elementary(eqn: Any, operands: list[Jet]) -> Jet:
    name, whole = eqn.primitive.name, eqn.outvars[0].aval.dtype.kind in "iu"
    if name == "integer_pow":
        return integer_power(operands[0], eqn.params["y"])
    rule = ELEMENTARY.get(name)
    if rule is None or (whole and name in ("div", "rem")):
        raise NoRuleError(name)
    found = rule(*_of_one_rank(operands))
    if not whole:
        return found
    ends = Interval(np.ceil(found.value.lo), np.floor(found.value.hi))
    return found._replace(value=ends)  # whole numbers are exact


def _of_one_rank(operands: list[Jet]) -> list[Jet]:
    """Scalars beside arrays, with axes of length 1."""
    rank = max(jet.seam.ndim for jet in operands)

    def lengthened(a: np.ndarray) -> np.ndarray:
        return a.reshape(a.shape + (1,) * (rank - a.ndim))

    return [jet.mapped(lengthened) for jet in operands]


def _is_short(aval: Any) -> bool:
    kind = getattr(aval.dtype, "kind", "O")
    return kind not in "biuf" or (kind == "f" and aval.dtype.itemsize < 8)


def _inlined(eqn: Any) -> Any:
    """The program that an equation calls; None where it is none, or bounded as a whole."""
    called = eqn.params.get(CALLS.get(eqn.primitive.name))
    return None if called is None or _is_known(called) else called


def _is_known(called: Any) -> bool:
    source = _source(called)
    return source.startswith(("sin_cos at", "searchsorted at"))


def _source(called: Any) -> str:
    return str(getattr(called, "jaxpr", called).debug_info.func_src_info)


def _known_call(called: Any, operands: list[Jet]) -> list[Jet] | None:
    """Results of functions that their programs do not bound well, by their sources."""
    source = _source(called)
    if source.startswith("sin_cos at") and "trigonometry.py" in source:
        turns = jets.mul(operands[-1], jets.number(np.asarray(2 * np.pi)))
        return [sin(turns), cos(turns)]
    if source.startswith("searchsorted at") and "jax" in source:
        return [_place(*operands[:2])]
    return None


def _told(name: str, a: Jet) -> Jet:
    """Whether a number is itself: what is not a number is not."""
    none = np.isnan(a.value.lo) | np.isnan(a.value.hi)
    truth = none if name == "ne" else ~none
    return jets.constant(Interval(*(truth.astype(float),) * 2))


def _call(closed: Any, operands: list[Jet]) -> list[Jet]:
    constants = [jets.number(np.asarray(c)) for c in getattr(closed, "consts", ())]
    return run(getattr(closed, "jaxpr", closed), constants, operands)


def _scan(eqn: Any, operands: list[Jet]) -> list[Jet]:
    """A loop of known length, step by step."""
    params, (fixed, carried) = eqn.params, scan_counts(eqn)
    length = params["length"]
    if length > SETTINGS.longest:
        raise NoRuleError(f"scan of {length} steps")
    held, carry = operands[:fixed], operands[fixed : fixed + carried]
    rows, found = operands[fixed + carried :], []
    order = range(length - 1, -1, -1) if params["reverse"] else range(length)
    for step in order:
        row = [jet.mapped(lambda a, step=step: a[:, step]) for jet in rows]
        results = _call(params["jaxpr"], [*held, *carry, *row])
        carry = results[:carried]
        found.append(results[carried:])
    if params["reverse"]:
        found.reverse()
    stacked = [stack(list(column)) for column in zip(*found, strict=True)]
    return [*carry, *stacked]


def _branches(branches: Any, which: Jet, *operands: Jet) -> list[Jet]:
    found = [_call(branch, list(operands)) for branch in branches]
    columns = zip(*found, strict=True)
    return [select(*_of_one_rank([which, *column])) for column in columns]


def _place(table: Jet, wanted: Jet) -> Jet:
    """Where numbers belong in a sorted table, the ends of each stretch on either side."""
    if not table.is_point or table.seam.ndim != 2:
        raise NoRuleError("searchsorted in a table that changes")
    known = table.value.lo[0]
    lo = np.searchsorted(known, wanted.value.lo, side="left")
    hi = np.searchsorted(known, wanted.value.hi, side="right")
    return jets.constant(Interval(lo.astype(float), hi.astype(float)))
