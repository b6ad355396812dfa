"""A diffrax solver that carries running integrals beside the state."""

import abc
from typing import Any, ClassVar

import diffrax
import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, PyTree

from ..._checks import Real
from ..equation import (
    Point,
    TipField,
    advance,
    arrival,
    at_rest,
    dissipated,
)


class AbstractObserver(eqx.Module):
    """Something that looks at every accepted step, such as a running maximum.

    Its memory is a pytree of floats; `look` gives the memory after a step that ended at
    time `t` (s) in the state `z` (m), with the energy `dissipation` (J) lost since 0 (0
    where no balance is integrated).
    """

    @abc.abstractmethod
    def start(self, z: Real) -> PyTree:
        """Memory at t = 0."""

    @abc.abstractmethod
    def look(self, memory: PyTree, t: Real, z: Real, dissipation: Real) -> PyTree:
        """Memory after a step."""


class Recorder(eqx.Module):
    """What is integrated beside the tip: nothing, the balance, and a watch on top."""

    field: TipField
    start_energy: Real
    balanced: bool = eqx.field(static=True)
    watch: AbstractObserver | None

    def start(self, z: Real) -> tuple:
        balance = (at_rest(),) if self.balanced else ()
        watched = () if self.watch is None else (self.watch.start(z),)
        return (*balance, *watched)

    def record(self, memory: tuple, t0: Any, t1: Any, y0: Real, y1: Real) -> tuple:
        after: list = []
        spent = jnp.zeros_like(y1)
        if self.balanced:
            step = t1 - t0
            start, end = self._points(jnp.stack([t0, t1]), jnp.stack([y0, y1]))
            balance = advance(
                self.field,
                memory[0],
                t0,
                step,
                y0,
                y1,
                start,
                arrival(self.field, t0, step, end),
            )
            after.append(balance)
        if self.watch is not None:
            if self.balanced:
                spent = dissipated(self.field, balance, t1, y1, self.start_energy)
            z = self.field.state(y1)
            after.append(self.watch.look(memory[-1], t1, z, spent))
        return tuple(after)

    def _points(self, ts: Array, ys: Array) -> tuple[Point, Point]:
        """The field at both ends, by one copy of it."""
        both = jax.lax.map(lambda at: self.field.point(*at), (ts, ys))
        return Point(*(leaf[0] for leaf in both)), Point(*(leaf[1] for leaf in both))


class AugmentedSolver(diffrax.AbstractAdaptiveSolver):
    """Wraps a solver of y' to one of (y, *memory, step): the rest only follows.

    `memory` is the recorder's; `step` the length in s of the longest recent step, at which
    an integration that goes on can start.

    Integrating the memory as further states: 3 x 3 systems in every stage of an implicit
    method, and step sizes that follow a sum instead of the trajectory.
    """

    solver: diffrax.AbstractSolver
    recorder: Recorder
    term_structure: ClassVar = diffrax.ODETerm
    interpolation_cls: ClassVar = diffrax.LocalLinearInterpolation

    def order(self, terms: Any) -> Any:
        return self.solver.order(terms)

    def error_order(self, terms: Any) -> Any:
        return self.solver.error_order(terms)

    def func(self, terms: Any, t0: Any, y0: Any, args: Any) -> Any:
        return terms.vf(t0, y0, args)

    def init(self, terms: Any, t0: Any, t1: Any, y0: tuple, args: Any) -> Any:
        return self.solver.init(self._tip_terms(), t0, t1, y0[0], args)

    def step(
        self,
        terms: Any,
        t0: Any,
        t1: Any,
        y0: tuple,
        args: Any,
        solver_state: Any,
        made_jump: Any,
    ) -> tuple:
        tip0, *memory0, step0 = y0
        tip1, error, _, solver_state, result = self.solver.step(
            self._tip_terms(), t0, t1, tip0, args, solver_state, made_jump
        )
        memory1 = self.recorder.record(tuple(memory0), t0, t1, tip0, tip1)
        # Halving forgets: the last step before a stop may be cut short by it.
        y1 = (tip1, *memory1, jnp.maximum(t1 - t0, 0.5 * step0))
        still: Any = (error, *_zeros_like(y1[1:]))
        return y1, still, {"y0": y0, "y1": y1}, solver_state, result

    def _velocity(self, t: Any, y: Real, args: Any) -> Real:
        return self.recorder.field.velocity(t, y)

    def _tip_terms(self) -> diffrax.ODETerm:
        return diffrax.ODETerm(self._velocity)


def _zeros_like(memory: PyTree) -> PyTree:
    return jax.tree_util.tree_map(jnp.zeros_like, memory)


def augmented_field(field: TipField):
    """Vector field of (y, *memory, step), as diffrax wants it: only y moves."""

    def vector_field(t: Real, state: tuple, args: Any) -> tuple:
        tip, *rest = state
        return (field.velocity(t, tip), *_zeros_like(tuple(rest)))

    return vector_field
