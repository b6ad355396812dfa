"""Steps of Rosenbrock methods for a scalar stiff equation."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

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


def combine(weights: tuple[float, ...], values: Sequence[Any] | Array) -> Real | float:
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


def rolled_step(
    tableau: Tableau,
    velocity: Callable[[Real, Real], Real],
    start: Linearised,
    t: Real,
    step: Real,
    y: Real,
) -> tuple[Real, Array]:
    """`rosenbrock_step` of one lane as a loop over the stages, stages in an array.

    One copy of the field for eight: derivatives of a step take a quarter of the time to
    trace and to compile, and as long to run.
    """
    count = len(tableau.times)
    a, c = (
        np.array([row + (0.0,) * (count - len(row)) for row in rows])
        for rows in (tableau.a, tableau.c)
    )
    rows = (
        np.arange(count),
        np.array(tableau.times),
        np.array(tableau.time_derivative),
        a,
        c,
    )
    inverse = 1 / (1 / (step * tableau.gamma) - start.by_state)

    def stage(stages: Array, row: tuple) -> tuple[Array, Real]:
        index, time, by_time, a, c = row
        inside = y + jnp.sum(a * stages)
        push = velocity(t + time * step, inside) + jnp.sum(c * stages) / step
        push = (push + step * by_time * start.by_time) * inverse
        return stages.at[index].set(push), inside

    stages, inside = jax.lax.scan(stage, jnp.zeros(count), rows)
    return inside[-1] + stages[-1], stages


def dense_output(
    tableau: Tableau, y0: Real, y1: Real, stages: list | Array, share: Real
) -> Real:
    """The interpolant at a share of the step, of order `order - 1`."""
    bends = [combine(row, stages) for row in tableau.dense]
    bend = bends[-1]
    for lower in bends[-2::-1]:
        bend = lower + share * bend
    return (1 - share) * y0 + share * (y1 + (1 - share) * bend)
