"""What SciPy's solvers do not tell, from a record of their run: looked at after it."""

from typing import Any

import jax
import numpy as np
from jaxtyping import Array

from .._compile import Program, in_chunks
from ..wiggly import TipField, advance, arrival, at_rest
from .settings import SETTINGS

_NODES = {"Radau": 3}  # times at which an attempt looks at the field; of others one


class StepRecord:
    """Accepted steps of a run between times (s) and tips (periods), the times of all looks
    at the field, and the seconds of its calls (`calls`).
    """

    def __init__(self) -> None:
        self.looks: list[float] = []
        self.calls = 0.0
        self._steps: list[tuple] = []
        self._tips: list[tuple] = []

    def add(self, solver: Any, before: Any, looks: int) -> None:
        """The step that a solver has just made, from the state `before`, after `looks`."""
        self._steps.append((solver.t_old, solver.t, looks, len(self.looks)))
        self._tips.append((before, solver.y))

    @property
    def accepted(self) -> int:
        """Steps."""
        return len(self._steps)

    def tried(self, method: str) -> int:
        """Steps with those rejected: each attempt has a length, hence a time, of its own.

        Newton iterations look at the times of their attempt; looks back at the start of
        the step (Radau's error estimate) belong to none.
        """
        attempts = 0
        for start, _, first, past in self._steps:
            later = {t for t in self.looks[first:past] if t > start}
            attempts += len(later) // _NODES.get(method, 1)
        return attempts

    def residual(self, field: TipField) -> float:
        """Residual of the energy-dissipation balance in J, taken as for all solvers.

        Along cubics between the ends of steps: dense output differs from one solver to the
        next.
        """
        if not self._steps:
            return 0.0
        times = np.array([step[:2] for step in self._steps], dtype=float)
        tips = np.array([[y[0] for y in ends] for ends in self._tips], dtype=float)
        return float(np.sum(in_chunks(_residuals, SETTINGS.steps, (field,), (times, tips))))


@Program
def _residuals(field: TipField, times, tips):
    def one(time: Array, tip: Array) -> Array:
        start, end = (field.point(t, y) for t, y in zip(time, tip, strict=True))
        step = time[1] - time[0]
        end = arrival(field, time[0], step, end)
        balance = advance(field, at_rest(), time[0], step, tip[0], tip[1], start, end)
        return balance.residual

    return jax.vmap(one)(times, tips)
