"""Steps that are known: a controller that takes them again, each as it was."""

from typing import Any

import diffrax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ..._checks import Real
from .wrapped import AbstractWrappedController


class ReplaySteps(AbstractWrappedController):
    """Ends steps at `times` (s, increasing, padded by anything beyond the last).

    Derivatives in reverse mode take every step once more, compiled otherwise. Judged
    again, one of 200000 steps that had been accepted by less than a rounding was rejected,
    and its share of the dissipation's derivative was lost: -11.6 came for 0.4772. Here no
    step is judged. Each ends when it did, the last one where the integration ends.
    `controller`: whose tolerances root finders take.
    """

    controller: diffrax.AbstractAdaptiveStepSizeController
    times: Float[Array, " n"]

    def __init__(
        self,
        controller: diffrax.AbstractAdaptiveStepSizeController,
        times: Float[Array, " n"],
    ):
        self.controller = controller
        self.times = times

    def wrap(self, direction: Any) -> "ReplaySteps":
        return self

    def init(
        self,
        terms: Any,
        t0: Any,
        t1: Any,
        y0: Any,
        dt0: Any,
        args: Any,
        func: Any,
        error_order: Any,
    ) -> tuple:
        return self._end(0, t1), (jnp.asarray(1), t1)

    def adapt_step_size(
        self,
        t0: Any,
        t1: Any,
        y0: Any,
        y1_candidate: Any,
        args: Any,
        y_error: Any,
        error_order: Any,
        controller_state: tuple,
    ) -> tuple:
        index, last = controller_state
        after = self._end(index, last), False, (index + 1, last)
        return jnp.asarray(True), t1, *after, diffrax.RESULTS.successful

    def _end(self, index: Any, last: Real) -> Array:
        time = self.times[index]
        return jnp.where(time < last, time, last)
