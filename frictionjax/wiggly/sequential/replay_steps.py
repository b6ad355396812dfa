"""Steps that are known: a controller that takes them again, each as it was."""

import diffrax
import jax.numpy as jnp
from jaxtyping import Array, Float

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

    def wrap(self, direction):
        return self

    def init(self, terms, t0, t1, y0, dt0, args, func, error_order):
        return self._end(0, t1), (jnp.asarray(1), t1)

    def adapt_step_size(
        self, t0, t1, y0, y1_candidate, args, y_error, error_order, controller_state
    ):
        index, last = controller_state
        after = self._end(index, last), False, (index + 1, last)
        return jnp.asarray(True), t1, *after, diffrax.RESULTS.successful

    def _end(self, index, last):
        time = self.times[index]
        return jnp.where(time < last, time, last)
