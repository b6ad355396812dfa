"""Rosenbrock methods for a scalar stiff equation."""

from collections.abc import Callable
from typing import ClassVar, NamedTuple

import diffrax
import jax
import jax.numpy as jnp
from equinox import AbstractClassVar

from ..arguments import Real


class Tableau(NamedTuple):
    """Coefficients in the transformed variables of Hairer and Wanner, Section IV.7.

    `a`, `c`: rows of the strict lower triangles. `times`, `time_derivative`: of each stage.
    `dense`: weights of the stages in the interpolant. The last stage is the error estimate
    (stiffly accurate methods), of order `order - 1`.
    """

    order: int
    gamma: float
    a: tuple[tuple[float, ...], ...]
    c: tuple[tuple[float, ...], ...]
    times: tuple[float, ...]
    time_derivative: tuple[float, ...]
    dense: tuple[tuple[float, ...], ...]


class Linearised(NamedTuple):
    """Right-hand side at the start of a step, and its derivatives by state and time."""

    velocity: Real
    by_state: Real
    by_time: Real


def combine(weights: tuple[float, ...], values: list) -> Real | float:
    """Weighted sum that leaves zero weights out of the program."""
    terms = [w * v for w, v in zip(weights, values, strict=True) if w != 0]
    return sum(terms[1:], terms[0]) if terms else 0.0


def rosenbrock_step(
    tableau: Tableau,
    velocity: Callable[[Real, Real], Real],
    start: Linearised,
    t: Real,
    step: Real,
    y: Real,
) -> tuple[Real, list]:
    """State after one step, and the stages; the last one is the error estimate.

    Elementwise: arrays of lanes are as good as scalars. One division a stage, no linear
    algebra and no Newton iteration.
    """
    inverse = 1 / (1 / (step * tableau.gamma) - start.by_state)
    per_step = 1 / step
    stages: list = []
    rows = zip(tableau.a, tableau.c, tableau.times, tableau.time_derivative, strict=True)
    for a, c, time, by_time in rows:
        inside = y + combine(a, stages)
        fresh = any(a) or time != 0
        slope = velocity(t + time * step, inside) if fresh else start.velocity
        forcing = step * by_time * start.by_time if by_time else 0.0
        stages.append((slope + combine(c, stages) * per_step + forcing) * inverse)
    return inside + stages[-1], stages


def dense_output(tableau: Tableau, y0: Real, y1: Real, stages: list, share: Real) -> Real:
    """The interpolant at a share of the step, of order `order - 1`."""
    bends = [combine(row, stages) for row in tableau.dense]
    bend = bends[-1]
    for lower in bends[-2::-1]:
        bend = lower + share * bend
    return (1 - share) * y0 + share * (y1 + (1 - share) * bend)


class StageInterpolation(diffrax.AbstractLocalInterpolation):
    """Dense output of a Rosenbrock step, from the ends and the tableau's bends."""

    t0: Real
    t1: Real
    y0: Real
    y1: Real
    bends: Real

    def evaluate(self, t0, t1=None, left=True):
        if t1 is not None:
            return self.evaluate(t1) - self.evaluate(t0)
        share = (t0 - self.t0) / jnp.where(self.t1 == self.t0, 1.0, self.t1 - self.t0)
        bend = jnp.polyval(self.bends[::-1], share)
        return (1 - share) * self.y0 + share * (self.y1 + (1 - share) * bend)


class AbstractRosenbrock(diffrax.AbstractAdaptiveSolver):
    """A scheme for a scalar state, with exact Jacobian and time derivative by autodiff."""

    tableau: AbstractClassVar[Tableau]
    term_structure: ClassVar = diffrax.ODETerm
    interpolation_cls: ClassVar = StageInterpolation

    def order(self, terms):
        return self.tableau.order

    def init(self, terms, t0, t1, y0, args):
        return None

    def func(self, terms, t0, y0, args):
        return terms.vf(t0, y0, args)

    def step(self, terms, t0, t1, y0, args, solver_state, made_jump):
        def field(t, y):
            return terms.vf(t, y, args)

        velocity, by_state = jax.jvp(lambda y: field(t0, y), (y0,), (jnp.ones_like(y0),))
        _, by_time = jax.jvp(lambda t: field(t, y0), (t0,), (jnp.ones_like(t0),))
        start = Linearised(velocity, by_state, by_time)
        y1, stages = rosenbrock_step(self.tableau, field, start, t0, t1 - t0, y0)
        bends = jnp.stack([combine(row, stages) for row in self.tableau.dense])
        info = {"y0": y0, "y1": y1, "bends": bends}
        return y1, stages[-1], info, None, diffrax.RESULTS.successful
