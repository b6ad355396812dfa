"""Steps of Rosenbrock methods for a scalar stiff equation."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from ..._checks import Real


class Tableau(NamedTuple):
    """Coefficients in the transformed variables of Hairer and Wanner, Section IV.7.

    `a`, `c`: rows of the strict lower triangles. `times`, `time_derivative`: of each stage.
    `dense`: weights of the stages in the interpolant, of a scheme that has one. The last
    stage is the error estimate (stiffly accurate methods), of order `order - 1`.
    """

    order: int
    gamma: float
    a: tuple[tuple[float, ...], ...]
    c: tuple[tuple[float, ...], ...]
    times: tuple[float, ...]
    time_derivative: tuple[float, ...]
    dense: tuple[tuple[float, ...], ...] = ()


class Linearised(NamedTuple):
    """Right-hand side at the start of a step, and its derivatives by state and time."""

    velocity: Real
    by_state: Real
    by_time: Real


class _Row(NamedTuple):
    """What belongs to one stage; `a`, `c`: weights of as many stages before it as there
    are in all, 0 for those that it has not."""

    a: Any
    c: Any
    time: Any
    time_derivative: Any


def _later_rows(tableau: Tableau) -> _Row:
    """Of all stages but the first, which has nothing to go by but the start."""
    a, c = (
        np.array([(0.0,) * (len(rows) - len(row)) + row for row in rows[1:]])
        for rows in (tableau.a, tableau.c)
    )
    times, by_time = (np.array(x[1:]) for x in (tableau.times, tableau.time_derivative))
    return _Row(a, c, times, by_time)


def _weighted(weights: Any, stages: tuple[Real, ...]) -> Real:
    terms = [weights[j] * stage for j, stage in enumerate(stages)]
    return sum(terms[1:], terms[0])


def combine(weights: tuple[float, ...], values: Sequence[Any]) -> Real | float:
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
) -> tuple[Real, tuple[Real, ...]]:
    """State after one step, and the stages; the last one is the error estimate.

    Elementwise: arrays of lanes are as good as scalars. One division a stage, no linear
    algebra and no Newton iteration. In a loop over the stages: one copy of the field for
    eight, half the program to trace and to compile, and no more time to run.
    """
    inverse = 1 / (1 / (step * tableau.gamma) - start.by_state)
    per_step = 1 / step

    def stage(carry: tuple, row: _Row) -> tuple[tuple, None]:
        before, _ = carry
        inside = y + _weighted(row.a, before)
        push = velocity(t + row.time * step, inside) + _weighted(row.c, before) * per_step
        push = (push + step * row.time_derivative * start.by_time) * inverse
        return ((*before[1:], push), inside), None

    first = (start.velocity + step * tableau.time_derivative[0] * start.by_time) * inverse
    none = (jnp.zeros_like(first),) * (len(tableau.times) - 1)
    (stages, inside), _ = jax.lax.scan(stage, ((*none, first), y), _later_rows(tableau))
    return inside + stages[-1], stages


def dense_output(
    tableau: Tableau, y0: Real, y1: Real, stages: Sequence[Real], share: Real
) -> Real:
    """The interpolant at a share of the step, of order `order - 1`."""
    bends = [combine(row, stages) for row in tableau.dense]
    bend = bends[-1]
    for lower in bends[-2::-1]:
        bend = lower + share * bend
    return (1 - share) * y0 + share * (y1 + (1 - share) * bend)
