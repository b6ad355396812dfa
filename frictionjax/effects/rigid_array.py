"""Many tips on one rigid root."""

from typing import ClassVar

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from .._checks import Asked, as_real, is_known, known_numbers, require
from .abstract import AbstractEffect
from .phases import require_row


class RigidArray(AbstractEffect):
    """N bristles whose root moves as one: their wiggly potentials add.

    `V(z) = sum_i weight_i V_eps(z + eps offset_i)`. `offsets`: where their tips stand, in
    periods of the surface, shape (N,). `weights`: how often each stands there, say, shape
    (N,), >= 0; 1 each where None. Friction is that of the sum: N rho where all stand
    alike, none where they are spread evenly over a sine, about `sqrt(pi N)/2 rho` where
    they stand anywhere on one.

    Raises `ValueError` for offsets that are no row of finite numbers, and weights that are
    negative, all 0, or of another shape.

    >>> pair = scene.replace(effects=(fx.effects.RigidArray(offsets=[0.0, 0.5]),))
    >>> print(f"{fx.friction(pair).rho_plus:.4f} N")
    0.0324 N
    """

    asked: ClassVar = {
        "offsets": Asked("periods", "a list", row=True),
        "weights": Asked("no unit", "a list as long as offsets, >= 0, not all 0", row=True),
    }

    offsets: Float[Array, " n"] = eqx.field(converter=as_real)
    weights: Float[Array, " n"] | None = eqx.field(
        default=None,
        converter=lambda given: None if given is None else as_real(given),
    )

    def __check_init__(self):
        require_row("effects.RigidArray.offsets", self.offsets, "places in periods")
        if self.weights is None or not is_known(self.offsets, self.weights):
            return
        name = "effects.RigidArray.weights"
        require_row(name, self.weights, "weights")
        count, weights = np.size(self.offsets), known_numbers(self.weights)
        require(weights.size == count, name, weights, f"{count} weights, one each")
        good = np.all(weights >= 0) and np.any(weights > 0)
        require(good, name, weights, "weights >= 0, one of them > 0")
