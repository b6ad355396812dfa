"""Second model of the paper: slanted spring (Section 3.2)."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp

from .._checks import Asked, Real, as_real, require_real
from .bristle import AbstractBristle, SlopeBounds, Stance
from .radians import in_radians


class SlantedSpring(AbstractBristle):
    """`A = -eta tan(theta)`, `F = k/2 (L_rest - (h - eta)/cos(theta))^2`.

    Second model of the paper (Section 3.2).

    `stiffness` k in N/m, `rest_length` L_rest in m, `height` h of its root in m,
    `angle` theta from the vertical in rad, in (-pi/2, pi/2); at 0 it is a vertical spring
    and a negative angle is the mirror image. `alpha = k/cos (L_rest - h/cos)`.

    Raises `ValueError` for parameters out of range.

    >>> mirrored = fx.bristles.SlantedSpring(1.0, rest_length=2.4, height=1.0, angle=-1.0)
    >>> law = fx.friction(scene.profile, mirrored)
    >>> print(f"rho = {law.rho_plus:.4f} N, {law.rho_minus:.4f} N")
    rho = 0.0879 N, -0.1204 N
    """

    asked: ClassVar = {
        "stiffness": Asked("N/m", "> 0"),
        "rest_length": Asked("m", "> 0"),
        "height": Asked("m", "> 0"),
        "angle": Asked("rad", "in (-pi/2, pi/2), with w' tan(angle) < 1 on the surface"),
    }

    positive: ClassVar = ("stiffness", "rest_length", "height")
    angles: ClassVar = ("angle",)

    stiffness: Real = eqx.field(converter=as_real)
    rest_length: Real = eqx.field(converter=as_real)
    height: Real = eqx.field(converter=as_real)
    angle: Real = eqx.field(converter=as_real)

    def __check_init__(self):
        self._require_positive()
        allowed = in_radians("-pi/2 < angle < pi/2", self.angle)
        require_real("bristle.angle", self.angle, allowed, lambda v: abs(v) < 0.5 * jnp.pi)

    def offset(self, eta: Real) -> Real:
        return -eta * jnp.tan(self.angle)

    def energy(self, eta: Real) -> Real:
        length = (self.height - eta) / jnp.cos(self.angle)
        return 0.5 * self.stiffness * (self.rest_length - length) ** 2

    def slope_bounds(self) -> SlopeBounds:
        """`omega_plus < cot(theta)`: the tip moves on without a jump."""
        tangent = jnp.tan(self.angle)
        cotangent = 1 / jnp.where(tangent == 0, 1.0, tangent)
        lower = jnp.where(tangent < 0, cotangent, -jnp.inf)
        upper = jnp.where(tangent > 0, cotangent, jnp.inf)
        return SlopeBounds(lower, upper, "cot(angle)", "cot(angle)")

    def geometry(self, eta: Real) -> Stance:
        """Always at its angle; as long as there is room for it."""
        length = (self.height - eta) / jnp.cos(self.angle)
        return Stance(self.angle + jnp.zeros_like(eta), length)
