"""What a load is."""

import abc
from typing import Any, ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .._checks import (
    Asked,
    Part,
    Real,
    as_jax,
    as_real,
    is_concrete,
    is_foreign,
    require_real,
)
from .completeness import require_methods, require_stated


class AbstractPull(Part):
    """`l(t)` in N and its slope: what a bristle feels of a load.

    >>> print(f"{scene.load.slope(0.0):.4f} N/s")
    2.1991 N/s
    """

    @abc.abstractmethod
    def __call__(self, t: Real) -> Real:
        """`l(t)` in N at time `t` in s."""

    def slope(self, t: Real) -> Real:
        """`l'(t)` in N/s, from the right at kinks."""
        t = jnp.asarray(t)
        return jax.jvp(self, (t,), (jnp.ones_like(t),))[1]


class AbstractLoad(AbstractPull):
    """The load `l(t)` in N, continuous and piecewise C^1.

    An implementer keeps three rules:

    1. `__call__(t)` takes a scalar and is differentiable by `jax.jvp`; at a kink it gives
       the slope to the right.
    2. `turning_points(duration, count)` holds every time in (0, duration) at which `l'`
       changes sign or jumps; between them `l` is monotone and C^1. It is traceable, sorted,
       of shape (count,), padded with `duration`, and all NaN where `count` is too small.
    3. `turning_count(duration)` is that number for known values, rounded up or not.

    Of a class of your own these are checked: that JAX traces it where it is made, that no
    turning point is missing where a scene takes it, as for `Custom` with listed ones.
    Where its numbers are traced 4096 samples are looked at, and one that turns elsewhere
    has the status of a load that turns too often.

    >>> print(scene.load.turning_points(duration=3.0, count=2))
    [0.75 2.25]
    """

    def __check_init__(self):
        if is_foreign(self):
            require_methods(self)

    @abc.abstractmethod
    def turning_count(self, duration: float) -> int:
        """Number of turning points in (0, duration); needs known values."""

    @abc.abstractmethod
    def turning_points(self, duration: Real, count: int) -> Float[Array, " count"]:
        """Turning points and kinks in (0, duration), padded with `duration`."""

    def prepared(self, duration: Real) -> "AbstractLoad":
        """The load with what a scene must find out about it first; others are ready.

        Raises `ValueError` where turning points of a foreign class are missing.
        """
        if is_foreign(self):
            require_stated(self, duration)
        return self


class PeriodicLoad(AbstractLoad):
    """A load that turns, or has kinks, at odd multiples of a quarter period and only there.

    `amplitude` in N, `period` in s.
    """

    asked: ClassVar = {"amplitude": Asked("N", "any"), "period": Asked("s", "> 0")}

    amplitude: Real = eqx.field(converter=as_real)
    period: Real = eqx.field(converter=as_real)

    def __check_init__(self):
        require_real("load.amplitude", self.amplitude, "any amplitude")
        require_real("load.period", self.period, "period > 0", lambda p: p > 0)

    def turning_count(self, duration: float) -> int:
        return max(0, int((duration / (float(self.period) / 4) + 1) // 2) + 1)

    def turning_points(self, duration: Real, count: int) -> Float[Array, " count"]:
        (period, duration), by, exact = _looked_at(self.period, duration)
        quarter = period / 4
        times = (2 * by.arange(count) + 1) * quarter
        enough = (2 * count + 1) * quarter >= duration
        # One at the end is the load's own: derivatives by the period go through it.
        times = by.where(times <= duration, times, duration)
        return exact(by.where(enough, times, by.nan))


def _looked_at(times: Real, duration: Real) -> tuple[tuple[Any, Any], Any, Any]:
    """Both for NumPy where they are known, what computes with them, and what ends it.

    JAX compiles each step at each new `count`, for 20 ms.
    """
    if is_concrete(times, duration):
        return (np.asarray(times), np.asarray(duration)), np, as_jax
    return (times, duration), jnp, jnp.asarray


def listed_turning_points(
    listed: Float[Array, " n"], duration: Real, count: int
) -> Float[Array, " count"]:
    """Listed times in (0, duration), as rule 2 wants them."""
    (known, duration), by, exact = _looked_at(listed, duration)
    inside = (known > 0) & (known < duration)
    # One at the end is as large as what fills the room, and moves as it does itself.
    kept = inside | (known == duration)
    times = by.sort(by.where(kept, known, duration))
    fill = by.full((max(0, count - times.shape[0]),), duration)
    all_of_them = by.concatenate([times, fill])[:count]
    return exact(by.where(by.sum(inside) <= count, all_of_them, by.nan))
