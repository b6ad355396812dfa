"""First model of the paper: vertical spring (Section 3.1)."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp

from .._checks import Asked, Real, as_real
from .bristle import AbstractBristle, Stance


class VerticalSpring(AbstractBristle):
    """`A = 0`, `F = k/2 (L_rest - h + eta)^2`, so `alpha = k (L_rest - h)`.

    First model of the paper (Section 3.1).

    `stiffness` k in N/m, `rest_length` L_rest in m, `height` h of its root in m.

    Raises `ValueError` for a stiffness, length or height that is not positive.

    >>> upright = fx.bristles.VerticalSpring(stiffness=1.0, rest_length=2.0, height=1.0)
    >>> law = fx.friction(scene.profile, upright)
    >>> print(f"rho = {law.rho_plus:.4f} N, {law.rho_minus:.4f} N")
    rho = 0.1000 N, -0.1000 N
    """

    asked: ClassVar = {
        "stiffness": Asked("N/m", "> 0"),
        "rest_length": Asked("m", "> 0"),
        "height": Asked("m", "> 0"),
    }

    positive: ClassVar = ("stiffness", "rest_length", "height")

    stiffness: Real = eqx.field(converter=as_real)
    rest_length: Real = eqx.field(converter=as_real)
    height: Real = eqx.field(converter=as_real)

    def __check_init__(self):
        self._require_positive()

    def offset(self, eta: Real) -> Real:
        return jnp.zeros_like(eta)

    def energy(self, eta: Real) -> Real:
        return 0.5 * self.stiffness * (self.rest_length - self.height + eta) ** 2

    def geometry(self, eta: Real) -> Stance:
        """Upright, its tip under its root."""
        return Stance(jnp.zeros_like(eta), self.height - eta)
