"""Step size control that cannot step over a well, and that rounding cannot steer."""

from typing import Any

import diffrax
import jax.numpy as jnp

from ..._checks import Real
from ..stepping import SETTINGS, rounded_down


class WellGuard(diffrax.AbstractAdaptiveStepSizeController):
    """Reject every step that moves the tip further than `reach`, then ask `controller`.

    A general solver on a rest phase takes steps longer than a slip. The implicit equation
    of such a step has a root in every well that holds an equilibrium; a root in the wrong
    one comes with a small error estimate (LSODA: 185 wells off, success reported). To
    change wells the tip must cross a whole falling branch of `W'`; with `reach` a quarter
    of the narrowest, no step can, and the slip itself is resolved.

    The estimate handed on is raised to what makes the controller shrink the step by the
    factor that is needed.

    The step that it proposes is rounded down to 2^(k/8) s. Step size control is chaotic: an
    error estimate that passes through zero turns a rounding difference (another vector
    width, another batch) into another sequence of steps within 20 slips, and results then
    differ by the solver's error, 3e-6 to 6e-5 eps at accuracy 1e-3. On a grid the sequences
    stay the same, and so do the results.
    """

    controller: diffrax.PIDController
    reach: Real

    def __init__(self, controller: diffrax.PIDController, reach: Real):
        self.controller, self.reach = controller, reach

    @property
    def rtol(self) -> Any:  # type: ignore[override]
        return self.controller.rtol

    @property
    def atol(self) -> Any:  # type: ignore[override]
        return self.controller.atol

    @property
    def norm(self) -> Any:  # type: ignore[override]
        return self.controller.norm

    def wrap(self, direction: Any) -> "WellGuard":
        return WellGuard(self.controller.wrap(direction), self.reach)

    def init(
        self,
        terms: Any,
        t0: Any,
        t1: Any,
        y0: tuple,
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
        y0: tuple,
        y1_candidate: tuple,
        args: Any,
        y_error: Any,
        error_order: Any,
        controller_state: Any,
    ) -> tuple:
        tip0, tip1, error = y0[0], y1_candidate[0], y_error[0]
        excess = jnp.abs(tip1 - tip0) / self.reach
        finite = jnp.isfinite(excess) & jnp.isfinite(error)
        excess = jnp.where(finite, jnp.minimum(excess, SETTINGS.far), SETTINGS.far)
        error = jnp.maximum(jnp.abs(error), SETTINGS.tiny * self.atol)
        too_far = self.atol * (excess * 1.1) ** error_order
        error = jnp.where(finite, error, too_far)
        error = jnp.where(excess > 1, jnp.maximum(error, too_far), error)
        tip1 = jnp.where(finite, tip1, tip0)
        keep, next_t0, next_t1, *rest = self.controller.adapt_step_size(
            t0,
            t1,
            (tip0,),
            (tip1,),
            args,
            (error,),
            error_order,
            controller_state,
        )
        return keep, next_t0, next_t0 + rounded_down(next_t1 - next_t0), *rest
