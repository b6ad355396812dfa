"""Load given as a function."""

import itertools
from collections.abc import Callable
from typing import ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..arguments import (
    Real,
    as_real,
    is_known,
    known_numbers,
    require,
    require_function,
)
from .load import AbstractLoad, listed_turning_points

_SAMPLES = 4096  # per piece between two turning points: finds a sign change that lasts
# What a load may change by within a few spacings of floats, of its largest value; and into
# how many parts, how often, the stretch of the largest change is cut to look there.
_JUMP, _PARTS, _ZOOMS = 1e-6, 64, 8


class Custom(AbstractLoad):
    """`l(t) = fn(t)`, monotone and C^1 between the times listed in `turning_points`.

    `fn`: s to N, scalar to scalar, written with `jax.numpy`. `turning_points`: all times
    at which `l'` changes sign or jumps, shape (n,), n = 0 allowed.

    Raises `ValueError` for times that are not finite and increasing. A scene checks on
    its duration that no turning point is missing and that nothing jumps.
    """

    _stored: ClassVar = {"turning_points": "listed"}

    fn: Callable[[Real], Real]
    listed: Float[Array, " n"] = eqx.field(converter=as_real)

    def __init__(self, fn: Callable[[Real], Real], turning_points=()):
        self.fn = fn
        self.listed = turning_points

    def __check_init__(self):
        require_function("load.fn", self.fn, "a function of t")
        if not is_known(self.listed):
            return
        times = known_numbers(self.listed)
        require(times.ndim == 1, "load.turning_points", self.listed, "times, shape (n,)")
        increasing = np.all(np.isfinite(times)) and np.all(np.diff(times) > 0)
        require(increasing, "load.turning_points", times, "finite, increasing times")

    def __call__(self, t: Real) -> Real:
        return jnp.asarray(self.fn(t))

    def turning_count(self, duration: float) -> int:
        for start, end in self._pieces(duration):
            times, values = self._values(start, end, _SAMPLES)
            _require_monotone(times, values)
            self._require_no_jump(times, values)
        return int(self.listed.shape[0])

    def turning_points(self, duration: Real, count: int) -> Float[Array, " count"]:
        return listed_turning_points(self.listed, duration, count)

    def _pieces(self, duration: float):
        times = np.asarray(self.listed)
        inside = times[(times > 0) & (times < duration)]
        return itertools.pairwise(np.concatenate([[0.0], inside, [duration]]))

    def _values(self, start: float, end: float, count: int):
        t = np.linspace(start, end, count)
        return t, np.asarray(jax.vmap(self)(jnp.asarray(t)))

    def _require_no_jump(self, times: np.ndarray, values: np.ndarray) -> None:
        """Looked into where the load changes most, down to the spacing of floats."""
        allowed, end = _JUMP * (1e-300 + np.max(np.abs(values))), times[-1]
        for _ in range(_ZOOMS):
            steps = np.abs(np.diff(values))
            at = int(np.argmax(steps))
            low, high, change = times[at], times[at + 1], steps[at]
            if change <= allowed or high - low <= 8 * np.spacing(end):
                break
            times, values = self._values(low, high, _PARTS + 1)
        jump = f"jumps by {change:.6g} at t = {high:.6g}"
        require(change <= allowed, "load.fn", jump, "a continuous function")


def _require_monotone(times: np.ndarray, values: np.ndarray) -> None:
    require(np.all(np.isfinite(values)), "load.fn", "not finite", "finite values")
    steps = np.diff(values)
    noise = 1e-12 * (1e-300 + np.max(np.abs(values)))
    up, down = np.any(steps > noise), np.any(steps < -noise)
    missing = f"turns between {times[0]:.6g} and {times[-1]:.6g}"
    allowed = "every time at which l' changes sign in turning_points"
    require(not (up and down), "load.turning_points", missing, allowed)
