"""Bristle given by its two functions."""

from collections.abc import Callable
from typing import Any, ClassVar

import jax
import jax.numpy as jnp
import numpy as np

from .._checks import Real, is_concrete, require, require_function
from .bristle import AbstractBristle


class Custom(AbstractBristle):
    """The bristle with tip offset `A = offset_fn` and energy `F = energy_fn`.

    `offset`: A, C^2, `A(0) = 0`, in m. `energy`: F, C^3, in J. Both scalar to scalar,
    written with `jax.numpy`; an `equinox.Module` with leaves is traced like other parts.

    Raises `ValueError` where `A(0) != 0`, `F'(0) = 0` or a value at 0 is not finite.

    >>> import jax.numpy as jnp
    >>> mine = fx.bristles.Custom(offset=lambda eta: -1.5 * eta, energy=jnp.exp)
    >>> law = fx.friction(scene.profile, mine)
    >>> print(f"rho = {law.rho_plus:.4f} N, {law.rho_minus:.4f} N")
    rho = 0.1176 N, -0.0870 N
    """

    _stored: ClassVar = {"offset": "offset_fn", "energy": "energy_fn"}

    offset_fn: Callable[[Real], Real]
    energy_fn: Callable[[Real], Real]

    def __init__(self, offset: Callable[[Real], Real], energy: Callable[[Real], Real]):
        self.offset_fn = offset
        self.energy_fn = energy

    def __check_init__(self):
        require_function("bristle.offset", self.offset_fn, "a function A of eta")
        require_function("bristle.energy", self.energy_fn, "a function F of eta")
        if not is_concrete(self):
            return
        zero: Any = np.float64(0.0)
        start = float(self.offset(zero))
        require(start == 0, "bristle.offset", start, "A(0) = 0")
        alpha = float(jax.grad(self.energy)(zero))
        require(np.isfinite(alpha), "bristle.energy", alpha, "a finite F'(0)")
        require(alpha != 0, "bristle.energy", alpha, "alpha = F'(0) != 0")

    def offset(self, eta: Real) -> Real:
        return jnp.asarray(self.offset_fn(eta))

    def energy(self, eta: Real) -> Real:
        return jnp.asarray(self.energy_fn(eta))
