"""Finite Fourier series."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..arguments import Real, as_real, is_known, known_numbers, require
from ..trigonometry import fourier_sum
from .heights import HeightsFit, fit_heights
from .profile import AbstractProfile


class Fourier(AbstractProfile):
    """`w(y) = sum_n cos_n cos(2 pi n y) + sin_n sin(2 pi n y)`, n = 1, 2, ...

    `cos`, `sin`: coefficients in periods, shape (harmonics,) each.

    Raises `ValueError` where the shapes differ, a coefficient is not finite or all are 0.
    """

    cos: Float[Array, " harmonics"] = eqx.field(converter=as_real)
    sin: Float[Array, " harmonics"] = eqx.field(converter=as_real)

    def __check_init__(self):
        if not is_known(self.cos, self.sin):
            return
        cos, sin = known_numbers(self.cos), known_numbers(self.sin)
        flat = cos.ndim == 1 and cos.size > 0
        require(flat, "profile.cos", self.cos, "coefficients, shape (harmonics,)")
        same = sin.shape == cos.shape
        require(same, "profile.sin", self.sin, f"shape {cos.shape} of cos")
        require(np.all(np.isfinite(cos)), "profile.cos", cos, "finite coefficients")
        require(np.all(np.isfinite(sin)), "profile.sin", sin, "finite coefficients")
        require(np.any(cos) or np.any(sin), "profile.cos", cos, "a coefficient != 0")

    def __call__(self, y: Real) -> Real:
        return fourier_sum(self.cos, self.sin, jnp.asarray(y))

    @property
    def points(self) -> int:
        return 64 * max(4, self.cos.shape[0])

    @classmethod
    def from_heights(
        cls, x: Any, heights: Any, period: float | None = None, harmonics: int = 8
    ) -> "HeightsFit[Fourier]":
        """Periodic profile of a measured trace.

        `x`: positions in m, increasing, shape (n,). `heights`: in m, shape (n,).
        `period`: in m; found in the data where it is None. `harmonics`: how many.

        A straight trend and all harmonics are fitted together by least squares, which
        averages over the periods in the trace. Returns `.profile`, `.period` in m and
        `.explained`, the share of the detrended variance that the periodic profile
        explains. `w` = height/period, so slopes are those measured.

        Samples that are masked (`numpy.ma`) in either are left out.

        Raises `ValueError` for wrong shapes, values that are not finite, less than
        1.5 periods, or more harmonics than the samples can tell apart, or parts of a
        period that are masked in every one.
        """
        fit = fit_heights(x, heights, period, harmonics)
        profile = cls(as_real(fit.cos / fit.period), as_real(fit.sin / fit.period))
        return HeightsFit(profile, fit.period, fit.explained)
