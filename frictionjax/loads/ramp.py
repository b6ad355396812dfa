"""Load that grows at a constant rate."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from .._checks import Asked, Real, as_real, require_real
from .load import AbstractLoad


class Ramp(AbstractLoad):
    """`l(t) = start + rate t`; `rate` in N/s, `start` in N.

    Raises `ValueError` for values that are not finite.

    >>> print(f"{fx.loads.Ramp(rate=0.5, start=0.1)(2.0):.2f} N")
    1.10 N
    """

    asked: ClassVar = {"rate": Asked("N/s", "any"), "start": Asked("N", "any")}

    rate: Real = eqx.field(converter=as_real)
    start: Real = eqx.field(converter=as_real, default=0.0)

    def __check_init__(self):
        require_real("load.rate", self.rate, "any rate")
        require_real("load.start", self.start, "any start")

    def __call__(self, t: Real) -> Real:
        return self.start + self.rate * t

    def turning_count(self, duration: float) -> int:
        return 0

    def turning_points(self, duration: Real, count: int) -> Float[Array, " count"]:
        return jnp.full((count,), duration)
