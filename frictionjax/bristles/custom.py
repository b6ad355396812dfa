"""Bristle given by its two functions."""

from collections.abc import Callable
from typing import ClassVar

import jax.numpy as jnp

from .._checks import Real
from .bristle import AbstractBristle, require_two


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
        require_two("bristle.", self.offset_fn, self.energy_fn)

    def offset(self, eta: Real) -> Real:
        return jnp.asarray(self.offset_fn(eta))

    def energy(self, eta: Real) -> Real:
        return jnp.asarray(self.energy_fn(eta))
