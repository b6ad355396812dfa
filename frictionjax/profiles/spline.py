"""Periodic cubic spline."""

from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..arguments import Real, as_real, is_known, known_numbers, require
from .profile import AbstractProfile


class Spline(AbstractProfile):
    """Periodic cubic spline through `heights` at y = 0, 1/n, ..., (n-1)/n.

    `heights`: in periods, shape (n,), n >= 4; the point y = 1 is the first one again and
    is not repeated. C^2 everywhere, the seam included, by construction.

    The leaf is the B-spline coefficients, so evaluation solves nothing; gradients with
    respect to heights go through the constructor.

    Raises `ValueError` for fewer than 4 heights, a wrong shape, or heights that are not
    finite or all equal.
    """

    coefficients: Float[Array, " n"]

    def __init__(self, heights: Any):
        heights = as_real(heights)
        if is_known(heights):
            _require_heights(heights)
        # c_{k-1} + 4 c_k + c_{k+1} = 6 h_k is circulant: diagonal after an FFT.
        count = heights.shape[0]
        symbol = (4 + 2 * np.cos(2 * np.pi * np.arange(count // 2 + 1) / count)) / 6
        self.coefficients = jnp.fft.irfft(jnp.fft.rfft(heights) / symbol, count)

    def __check_init__(self):
        if is_known(self.coefficients):
            _require_heights(self.coefficients)

    @property
    def heights(self) -> Float[Array, " n"]:
        """The interpolated heights, shape (n,)."""
        c = self.coefficients
        return (jnp.roll(c, 1) + 4 * c + jnp.roll(c, -1)) / 6

    def __call__(self, y: Real) -> Real:
        y = jnp.asarray(y)
        count = self.coefficients.shape[0]
        place = (y - jnp.floor(y)) * count
        knot = jnp.floor(place)
        s = place - knot
        index = knot.astype(jnp.int32)
        weights = (
            (1 - s) ** 3 / 6,
            (3 * s**3 - 6 * s**2 + 4) / 6,
            (-3 * s**3 + 3 * s**2 + 3 * s + 1) / 6,
            s**3 / 6,
        )
        terms = [
            weight * self.coefficients[(index + shift - 1) % count]
            for shift, weight in enumerate(weights)
        ]
        return sum(terms[1:], terms[0])

    @property
    def points(self) -> int:
        return 16 * max(16, self.coefficients.shape[0])


def _require_heights(given: Any) -> None:
    heights = known_numbers(given)
    enough = heights.ndim == 1 and heights.size >= 4
    require(enough, "profile.heights", given, "4 or more heights, shape (n,)")
    require(np.all(np.isfinite(heights)), "profile.heights", heights, "finite heights")
    require(np.ptp(heights) > 0, "profile.heights", heights, "heights that vary")
