"""Load given by points."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .._checks import Asked, Real, as_real, is_known, known_numbers, require
from .load import AbstractLoad, listed_turning_points


class PiecewiseLinear(AbstractLoad):
    """Linear between `(times, values)`, constant before the first and after the last.

    `times` in s, increasing, shape (n,); `values` in N, shape (n,).

    Raises `ValueError` for shapes that differ, times that do not increase, or values
    that are not finite.

    >>> load = fx.loads.PiecewiseLinear(times=[0.0, 1.0, 3.0], values=[0.0, 1.0, -0.5])
    >>> print(f"{load(2.0):.2f} N, {load(5.0):.2f} N")
    0.25 N, -0.50 N
    """

    asked: ClassVar = {
        "times": Asked("s", "a list, increasing", row=True),
        "values": Asked("N", "a list as long as times", row=True),
    }

    times: Float[Array, " n"] = eqx.field(converter=as_real)
    values: Float[Array, " n"] = eqx.field(converter=as_real)

    def __check_init__(self):
        if not is_known(self.times, self.values):
            return
        times, values = known_numbers(self.times), known_numbers(self.values)
        flat = times.ndim == 1 and times.size >= 1
        require(flat, "load.times", self.times, "one or more times, shape (n,)")
        shape = f"the shape {times.shape} of times"
        require(values.shape == times.shape, "load.values", self.values, shape)
        require(np.all(np.isfinite(times)), "load.times", times, "finite times")
        require(np.all(np.isfinite(values)), "load.values", values, "finite values")
        require(np.all(np.diff(times) > 0), "load.times", times, "increasing times")

    def __call__(self, t: Real) -> Real:
        count = self.times.shape[0]
        if count == 1:
            return self.values[0] + 0.0 * t
        piece = jnp.clip(jnp.searchsorted(self.times, t, side="right") - 1, 0, count - 2)
        width = self.times[piece + 1] - self.times[piece]
        slope = (self.values[piece + 1] - self.values[piece]) / width
        inside = self.values[piece] + slope * (t - self.times[piece])
        before = jnp.where(t < self.times[0], self.values[0], inside)
        return jnp.where(t >= self.times[-1], self.values[-1], before)

    def turning_count(self, duration: float) -> int:
        return int(self.times.shape[0])

    def turning_points(self, duration: Real, count: int) -> Float[Array, " count"]:
        return listed_turning_points(self.times, duration, count)
