"""A program without calls: what does not depend on t is known, sums forget what rests."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from jax.extend.core import Literal, jaxprs_in_params

from . import jet as jets
from .functions import ELEMENTARY
from .jet import Jet
from .logic import LOGIC
from .settings import SETTINGS
from .shapes import SHAPES

_TERMWISE = {*ELEMENTARY, *LOGIC, "integer_pow", "convert_element_type", "copy"}

Results = Callable[[Any, list[Jet]], list[Jet]]
"""What an equation gives for operands."""


class TooMuchWorkError(Exception):
    """More numbers were needed than are affordable."""


class Step(NamedTuple):
    """An equation; `reads` known numbers, or places of results.

    `numbers`, `steps`: computed inside it for one time, as in loops.
    """

    eqn: Any
    reads: tuple[Jet | int, ...]
    write: tuple[int, ...]
    numbers: int
    steps: int


class Plan(NamedTuple):
    """What is computed of each result: places along its axis, None for all.

    `sums`: by step, places of the terms that move, and the sum of the others.
    """

    wanted: dict[int, np.ndarray | None]
    sums: dict[int, tuple[np.ndarray, Jet]]
    largest: int


class Program:
    """A function of one number, step by step. `spent`: numbers computed so far.

    `most`: numbers after which `TooMuchWorkError` is raised.
    """

    def __init__(self, closed: Any, results: Results, inner: Callable[[Any], Any]):
        self._results, self._inner = results, inner
        self._steps: list[Step] = []
        self._count, self.spent, self.most = 1, 0, np.inf
        constants = [jets.number(np.asarray(c)) for c in closed.consts]
        (self._out,) = self._flattened(closed.jaxpr, constants, [0])
        self._all = self._whole()
        self._narrows = bool(self._all.sums)

    def _flattened(self, jaxpr: Any, constants: list, arguments: list) -> list:
        known: dict[Any, Any] = dict(zip(jaxpr.constvars, constants, strict=True))
        known |= dict(zip(jaxpr.invars, arguments, strict=True))

        def read(atom: Any) -> Any:
            if isinstance(atom, Literal):
                return jets.number(np.asarray(atom.val))
            return known[atom]

        for eqn in jaxpr.eqns:
            found = self._step(eqn, tuple(read(atom) for atom in eqn.invars))
            known |= dict(zip(eqn.outvars, found, strict=True))
        return [read(atom) for atom in jaxpr.outvars]

    def _step(self, eqn: Any, reads: tuple) -> list:
        if all(isinstance(known, Jet) for known in reads):
            return self._results(eqn, list(reads))
        called = self._inner(eqn)
        if called is not None:
            constants = [jets.number(np.asarray(c)) for c in getattr(called, "consts", ())]
            return self._flattened(getattr(called, "jaxpr", called), constants, list(reads))
        places = tuple(range(self._count, self._count + len(eqn.outvars)))
        self._count += len(places)
        inside = _inside(eqn) if eqn.primitive.name in ("scan", "cond") else (0, 0)
        self._steps.append(Step(eqn, reads, places, *inside))
        return list(places)

    def _whole(self) -> Plan:
        sums = {
            k: (np.arange(_terms(step.eqn)), jets.number(np.zeros(())))
            for k, step in enumerate(self._steps)
            if _terms(step.eqn) >= SETTINGS.many
        }
        sizes = [v.aval.size for step in self._steps for v in step.eqn.outvars]
        return Plan({}, sums, max([1, *sizes]))

    def __call__(self, lo: np.ndarray, hi: np.ndarray) -> list[Jet]:
        """Bounds over each [lo, hi], shapes (N,), N > 0, in consecutive parts."""
        return self._in_parts(lo, hi, self._all)

    def _in_parts(self, lo: np.ndarray, hi: np.ndarray, plan: Plan) -> list[Jet]:
        small = lo.size * plan.largest <= SETTINGS.leaf
        if not self._narrows or lo.size <= SETTINGS.few or small:
            room = max(SETTINGS.largest // plan.largest, 1)
            places = range(0, max(lo.size, 1), room)
            return [self._run(lo[k : k + room], hi[k : k + room], plan)[0] for k in places]
        around = np.min(lo, keepdims=True), np.max(hi, keepdims=True)
        less = self._narrowed(self._run(*around, plan)[1], plan)
        edges = np.linspace(0, lo.size, SETTINGS.parts + 1).astype(int)
        if lo.size * less.largest <= SETTINGS.leaf:
            edges = edges[[0, -1]]
        found = []
        for a, b in pairwise(edges):
            found += self._in_parts(lo[a:b], hi[a:b], less)
        return found

    def _run(self, lo: np.ndarray, hi: np.ndarray, plan: Plan) -> tuple[Jet, dict]:
        """The result over each [lo, hi], and what each step gave."""
        known: dict[int, Jet] = {0: jets.variable(lo, hi)}
        for k, step in enumerate(self._steps):
            if plan.wanted and not any(place in plan.wanted for place in step.write):
                continue
            self.spent += lo.size * step.numbers + SETTINGS.step * step.steps
            if self.spent > self.most:
                raise TooMuchWorkError
            found = self._found(k, step, known, plan)
            known |= dict(zip(step.write, found, strict=True))
            self.spent += SETTINGS.step + sum(jet.seam.size for jet in found)
            if self.spent > self.most:
                raise TooMuchWorkError
        out = self._out if isinstance(self._out, Jet) else known[self._out]
        return out.mapped(lambda a: np.broadcast_to(a, lo.shape)), known

    def _found(self, k: int, step: Step, known: dict[int, Jet], plan: Plan) -> list[Jet]:
        if k in plan.sums:
            moving, rest = plan.sums[k]
            return [jets.add(jets.summed(_terms_at(step, known, plan, moving), (0,)), rest)]
        places = plan.wanted.get(step.write[0])
        operands = _picked(step, known, plan, places)
        if places is not None and step.eqn.primitive.name == "broadcast_in_dim":
            params = step.eqn.params | {"shape": (places.size,)}
            return [SHAPES["broadcast_in_dim"](params, *operands)]
        return self._results(step.eqn, operands)

    def _narrowed(self, known: dict[int, Jet], plan: Plan) -> Plan:
        """A plan for stretches inside the one on which these results were found."""
        wanted: dict[int, np.ndarray | None] = {}
        sums = {}
        if not isinstance(self._out, Jet):
            wanted[self._out] = None
        for k in range(len(self._steps) - 1, -1, -1):
            step = self._steps[k]
            if not any(place in wanted for place in step.write):
                continue
            places = wanted.get(step.write[0])
            if k in plan.sums:
                old, rest = plan.sums[k]
                terms = _terms_at(step, known, plan, old)
                moves = _moves(terms)
                still = jets.summed(terms.mapped(lambda a, m=moves: a[:, ~m]), (0,))
                places = old[moves]
                sums[k] = places, jets.add(rest, still)
            elif not _is_termwise(step.eqn):
                places = None
                wanted |= dict.fromkeys(step.write)
            for read, atom in zip(step.reads, step.eqn.invars, strict=True):
                if not isinstance(read, Jet):
                    _ask(wanted, read, places if atom.aval.ndim == 1 else None)
        sizes = [places.size for places, _ in sums.values()]
        return Plan(wanted, sums, self._largest(wanted, sizes))

    def _largest(self, wanted: dict[int, np.ndarray | None], sizes: list[int]) -> int:
        for step in self._steps:
            for place, var in zip(step.write, step.eqn.outvars, strict=True):
                if place in wanted:
                    some = wanted[place]
                    sizes.append(int(var.aval.size if some is None else some.size))
        return max([1, *sizes])


def work_of(jaxpr: Any) -> tuple[int, int]:
    """Numbers and steps of a program, those of loops as often as they run."""
    numbers = steps = 0
    for eqn in jaxpr.eqns:
        numbers += sum(getattr(var.aval, "size", 1) for var in eqn.outvars)
        numbers += SETTINGS.callback * ("callback" in eqn.primitive.name)
        more = _inside(eqn)
        numbers, steps = numbers + more[0], steps + 1 + more[1]
    return numbers, steps


def _inside(eqn: Any) -> tuple[int, int]:
    parts = [work_of(called) for called in jaxprs_in_params(eqn.params)]
    unknown = SETTINGS.unknown_loop if eqn.primitive.name == "while" else 1
    often = eqn.params.get("length", unknown)
    return often * sum(n for n, _ in parts), often * sum(k for _, k in parts)


def _terms(eqn: Any) -> int:
    """Number of terms of a sum over one axis of one array, or of a product; else 0."""
    if eqn.primitive.name not in ("reduce_sum", "dot_general"):
        return 0
    first = eqn.invars[0].aval
    if eqn.primitive.name == "reduce_sum" and first.ndim == 1:
        return first.size if first.dtype.kind == "f" else 0
    if not eqn.outvars[0].aval.ndim:
        axes, _ = eqn.params["dimension_numbers"]
        one = first.ndim == 1 and all(len(side) == 1 for side in axes)
        return first.size if one and eqn.outvars[0].aval.dtype == np.float64 else 0
    return 0


def _is_termwise(eqn: Any) -> bool:
    name = eqn.primitive.name
    spread = name == "broadcast_in_dim" and eqn.invars[0].aval.ndim == 0
    return name in _TERMWISE or spread


def _picked(step: Step, known: dict[int, Jet], plan: Plan, places) -> list[Jet]:
    """Operands of a step, of arrays the entries at these places."""
    found = []
    for read, atom in zip(step.reads, step.eqn.invars, strict=True):
        whole = read if isinstance(read, Jet) else known[read]
        if places is not None and atom.aval.ndim == 1:
            held = None if isinstance(read, Jet) else plan.wanted.get(read)
            at = places if held is None else np.searchsorted(held, places)
            whole = whole.mapped(lambda a, at=at: a[:, at])
        found.append(whole)
    return found


def _terms_at(step: Step, known: dict[int, Jet], plan: Plan, places: np.ndarray) -> Jet:
    operands = _picked(step, known, plan, places)
    return operands[0] if len(operands) == 1 else jets.mul(*operands)


def _moves(terms: Jet) -> np.ndarray:
    """Which terms of a sum are more than known numbers on a stretch, at least one."""

    def rests(sizes: np.ndarray, most: np.ndarray, share: float) -> np.ndarray:
        return sizes <= share * np.max(most[np.isfinite(most)], initial=0.0)

    value, slope, bend = (part.mapped(lambda a: a[0]) for part in terms[:3])
    still = rests(value.width, value.size, SETTINGS.known)
    for part in (slope, bend):
        still &= rests(part.size, part.size, SETTINGS.rests)
    moves = ~still | terms.seam[0]
    moves[0] |= not moves.any()
    return moves


def _ask(wanted: dict[int, np.ndarray | None], place: int, some: np.ndarray | None) -> None:
    if place not in wanted:
        wanted[place] = some
        return
    old = wanted[place]
    wanted[place] = None if old is None or some is None else np.union1d(old, some)
