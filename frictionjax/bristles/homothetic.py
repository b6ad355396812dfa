"""Bristle that leaves the surface's shape as it is."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp

from .._checks import Asked, Real, as_real, require_real
from .bristle import AbstractBristle


class Homothetic(AbstractBristle):
    """`A = 0`, `F = alpha eta`: Mielke's homothetic scaling (Prandtl-Tomlinson).

    `alpha`: normal force in N, not 0; with this bristle the same on a slide as at rest.

    Raises `ValueError` for alpha that is 0 or not finite.

    >>> law = fx.friction(scene.profile, fx.bristles.Homothetic(alpha=2.0))
    >>> print(f"rho = {law.rho_plus:.4f} N, {law.rho_minus:.4f} N")
    rho = 0.2000 N, -0.2000 N
    """

    asked: ClassVar = {"alpha": Asked("N", "not 0")}

    alpha: Real = eqx.field(converter=as_real)

    def __check_init__(self):
        require_real("bristle.alpha", self.alpha, "alpha != 0", lambda v: v != 0)

    def offset(self, eta: Real) -> Real:
        return jnp.zeros_like(eta)

    def energy(self, eta: Real) -> Real:
        return self.alpha * eta
