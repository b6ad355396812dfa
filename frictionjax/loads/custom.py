"""Load given as a function."""

import itertools
from collections.abc import Callable

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..arguments import (
    Real,
    as_real,
    is_concrete,
    known_numbers,
    require,
    require_function,
)
from .load import AbstractLoad, listed_turning_points

_SAMPLES = 4096  # per piece between two turning points: finds a sign change that lasts


class Custom(AbstractLoad):
    """`l(t) = fn(t)`, monotone and C^1 between the times listed in `turning_points`.

    `fn`: s to N, scalar to scalar, written with `jax.numpy`. `turning_points`: all times
    at which `l'` changes sign or jumps, shape (n,), n = 0 allowed.

    Raises `ValueError` for times that are not finite and increasing. A scene checks on
    its duration that no turning point is missing.
    """

    fn: Callable[[Real], Real]
    listed: Float[Array, " n"]

    def __init__(self, fn: Callable[[Real], Real], turning_points=()):
        self.fn = fn
        self.listed = as_real(turning_points)

    def __check_init__(self):
        require_function("load.fn", self.fn, "a function of t")
        if not is_concrete(self.listed):
            return
        times = known_numbers(self.listed)
        require(times.ndim == 1, "load.turning_points", self.listed, "times, shape (n,)")
        increasing = np.all(np.isfinite(times)) and np.all(np.diff(times) > 0)
        require(increasing, "load.turning_points", times, "finite, increasing times")

    def __call__(self, t: Real) -> Real:
        return jnp.asarray(self.fn(t))

    def turning_count(self, duration: float) -> int:
        self._require_monotone(duration)
        return int(self.listed.shape[0])

    def turning_points(self, duration: Real, count: int) -> Float[Array, " count"]:
        return listed_turning_points(self.listed, duration, count)

    def _require_monotone(self, duration: float) -> None:
        times = np.asarray(self.listed)
        inside = times[(times > 0) & (times < duration)]
        edges = np.concatenate([[0.0], inside, [duration]])
        for start, end in itertools.pairwise(edges):
            t = np.linspace(start, end, _SAMPLES)
            values = np.asarray(jax.vmap(self)(jnp.asarray(t)))
            require(np.all(np.isfinite(values)), "load.fn", "not finite", "finite values")
            steps = np.diff(values)
            noise = 1e-12 * (1e-300 + np.max(np.abs(values)))
            up, down = np.any(steps > noise), np.any(steps < -noise)
            missing = f"turns between {start:.6g} and {end:.6g}"
            allowed = "every time at which l' changes sign in turning_points"
            require(not (up and down), "load.turning_points", missing, allowed)
