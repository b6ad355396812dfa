"""Step sizes: as large as the error allows, foreseeing how it changes.

A predictive controller after K. Gustafsson (ACM Trans. Math. Softw. 20, 1994): it goes on
as the last steps did, which shrink or grow steadily before and after a fold. Million steps
of the vertical benchmark scene, every slip, gamma 1 (16 eps) and 2 (14 eps), at the same
tolerances: PI control 9.0 and 4.7 (tips that come to rest after a slip allow steps that
grow faster than it lets them), I control 8.3 and 4.5 (a third of them rejected), this one
6.5 and 3.2.
"""

from typing import Any, NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Bool

from ..._checks import Real
from .computed_once import materialise
from .settings import SETTINGS
from .step_sizes import log2


class Control(NamedTuple):
    """What steers steps; of lanes and traces, in s and in periods of the tip.

    `tolerance`: error of a step where the tip is slower than `pace` (periods a second, the
    fastest slide's). Faster tips are in a slip, where an error is a shift in time that
    matters less in proportion: up to `loosest` there. `reach`: how far one step may move
    the tip, whatever its error: see `WellGuard`. Levels are counted from `first_step`, so
    that steps do not depend on the units.
    """

    first_step: Any
    tolerance: Any
    loosest: Any
    pace: Any
    reach: Any


class ControlState(NamedTuple):
    """The next step's level, and the trend that the last accepted step has left."""

    level: Any = 0.0
    trend: Any = 0.0


class StepVerdict(NamedTuple):
    """Whether a step is accepted, and how steps go on."""

    accepted: Bool[Array, ""]
    after: ControlState


def _power(x: Real, order: int) -> Real:
    found = x
    for _ in range(order - 1):
        found = found * x
    return found


def judge(
    order: int,
    control: Control,
    before: ControlState,
    *,
    step: Real,
    moved: Real,
    error: Real,
    cut: Bool[Array, ""] | bool = False,
    overgrown: Real | float = 0.0,
    shifts: Bool[Array, ""] | bool = True,
) -> StepVerdict:
    """Judge a step that has moved the tip by `moved`.

    `order`: of the error in the step. `cut`: whether a stop has made it shorter, so that it
    says nothing about the next one. `overgrown`: how many times it is too long for unstable
    branches. `shifts`: whether an error in a slip is one in time.
    """
    excess = jnp.maximum(moved / control.reach, overgrown)
    finite = (excess < SETTINGS.far) & (error < 1e300)
    excess = jnp.where(finite, excess, SETTINGS.far)
    pace = jnp.where(finite, moved, 0.0) / (step * control.pace)
    tolerance = control.tolerance * jnp.where(shifts, jnp.maximum(pace, 1.0), 1.0)
    tolerance = jnp.minimum(tolerance, control.loosest)
    share = jnp.where(finite, jnp.maximum(error / tolerance, SETTINGS.tiny), 1.0)
    # One logarithm of both: each costs as much as a stage's sine.
    share = log2(jnp.maximum(share, _power(excess, order))) / order
    share = materialise(share, control.first_step)
    size = log2(step / control.first_step)
    accepted = share <= 0
    allowed = SETTINGS.safe - SETTINGS.gain * share
    foreseen = allowed - share + before.trend + size
    change = jnp.where(accepted, jnp.minimum(allowed + SETTINGS.ahead, foreseen), allowed)
    change = jnp.clip(
        change,
        SETTINGS.least_change,
        jnp.where(accepted, SETTINGS.most_change, SETTINGS.rejected),
    )
    level = jnp.floor(SETTINGS.per_octave * (size + change) + 1e-4)
    level = jnp.where(accepted & cut, jnp.maximum(level, before.level), level)
    trend = jnp.where(accepted & ~jnp.asarray(cut), share - size, before.trend)
    return StepVerdict(accepted, ControlState(level, trend))
