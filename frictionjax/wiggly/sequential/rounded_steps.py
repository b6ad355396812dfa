"""Step sizes on a coarse grid, so that rounding errors cannot steer them."""

from typing import Any, cast

import diffrax

from ..stepping import rounded_down
from .wrapped import AbstractWrappedController


class RoundedSteps(AbstractWrappedController):
    """Rounds the step that `controller` proposes down to 2^(k/8) s.

    Step size control is chaotic: an error estimate that passes through zero turns a
    rounding difference (another vector width, another batch) into another sequence of
    steps within 20 slips, and results then differ by the solver's error, 3e-6 to 6e-5
    eps at accuracy 1e-3. On a grid the sequences stay the same, and so do the results.
    """

    controller: diffrax.AbstractAdaptiveStepSizeController

    def __init__(self, controller: diffrax.AbstractAdaptiveStepSizeController):
        self.controller = controller

    def wrap(self, direction: Any) -> "RoundedSteps":
        return RoundedSteps(cast(Any, self.controller.wrap(direction)))

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
        first, state = self.controller.init(terms, t0, t1, y0, dt0, args, func, error_order)
        return t0 + rounded_down(first - t0), state

    def adapt_step_size(
        self,
        t0: Any,
        t1: Any,
        y0: Any,
        y1_candidate: Any,
        args: Any,
        y_error: Any,
        error_order: Any,
        controller_state: Any,
    ) -> tuple:
        keep, next_t0, next_t1, jump, state, result = self.controller.adapt_step_size(
            t0, t1, y0, y1_candidate, args, y_error, error_order, controller_state
        )
        next_t1 = next_t0 + rounded_down(next_t1 - next_t0)
        return keep, next_t0, next_t1, jump, state, result
