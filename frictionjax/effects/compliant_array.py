"""Many bristles on one root, each with a support of its own."""

from typing import ClassVar

import equinox as eqx
from jaxtyping import Array, Float

from .._checks import Asked, as_real
from .abstract import AbstractEffect, Stage
from .phases import require_row


class CompliantArray(AbstractEffect):
    """N bristles on one root, each held by its own support and pulled by the same load.

    Bristle i moves in `V_eps(z_i + eps offset_i)`. `offsets`: where they stand, in periods
    of the surface, shape (N,). What is told of an array is the mean of its bristles: state,
    dissipation, force, and in sweeps the errors of each, no less than those of the mean
    state; `strip_excess` is that of the bristle that leaves the strip furthest. Its
    friction is N times that of one; how much it ripples falls with N, as `1/sqrt(N)` where
    bristles stand anywhere. Elastic coupling between bristles is not simulated.

    Raises `ValueError` for offsets that are no row of finite numbers.

    >>> array = scene.replace(effects=(fx.effects.CompliantArray(offsets=[0.0, 0.5]),))
    >>> solution = fx.solve(array, eps=0.01)
    >>> print(f"z(3 s) = {solution.z[-1]:.4f} +- {solution.stats['spread'][-1]:.4f} m")
    z(3 s) = -0.1223 +- 0.0021 m
    """

    asked: ClassVar = {"offsets": Asked("periods", "a list", row=True)}

    stage: ClassVar[Stage] = Stage.STATE

    offsets: Float[Array, " n"] = eqx.field(converter=as_real)

    def __check_init__(self):
        require_row("effects.CompliantArray.offsets", self.offsets, "places in periods")
