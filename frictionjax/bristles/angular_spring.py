"""Third model of the paper: rigid rod on an angular spring (Section 3.3)."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from .._checks import Asked, Real, as_real, is_known, require, require_real
from .._compile import Interpreted
from .bristle import AbstractBristle, Rod, SlopeBounds, Stance
from .radians import in_radians


class AngularSpring(AbstractBristle):
    """`A = sqrt(L^2 - (h-eta)^2) - sqrt(L^2 - h^2)`, `F = k/2 (theta - theta_rest)^2`.

    Third model of the paper (Section 3.3).

    `stiffness` k in N m/rad, `length` L of the rod in m, `height` h of its root in m,
    `rest_angle` theta_rest in rad; `theta = arccos((h - eta)/L)` is the rod's angle from
    the vertical and `theta_lim = arccos(h/L)` the one on the flat surface.

    Raises `ValueError` unless k > 0, L > h > 0 and theta_lim > theta_rest > -pi/2.

    >>> rod = fx.bristles.AngularSpring(1.0, length=1.4, height=1.0, rest_angle=0.3)
    >>> law = fx.friction(scene.profile, rod)
    >>> print(f"rho = {law.rho_plus:.4f} N, {law.rho_minus:.4f} N")
    rho = 0.0440 N, -0.0540 N
    """

    asked: ClassVar = {
        "stiffness": Asked("N m/rad", "> 0"),
        "length": Asked("m", "> height, with -tan(theta_lim) < w' < cot(theta_lim)"),
        "height": Asked("m", "> 0"),
        "rest_angle": Asked("rad", "in (-pi/2, arccos(height/length))"),
    }

    positive: ClassVar = ("stiffness", "length", "height")
    angles: ClassVar = ("rest_angle",)

    stiffness: Real = eqx.field(converter=as_real)
    length: Real = eqx.field(converter=as_real)
    height: Real = eqx.field(converter=as_real)
    rest_angle: Real = eqx.field(converter=as_real)

    def __check_init__(self):
        self._require_positive()
        allowed = in_radians("rest_angle > -pi/2", self.rest_angle)
        require_real("bristle.rest_angle", self.rest_angle, allowed)
        if not is_known(self):
            return
        length, height = float(self.length), float(self.height)
        rest = float(self.rest_angle)
        require(
            length > height, "bristle.length", length, f"length > height = {height:.6g}"
        )
        limit = float(_angle_of(self, np.float64(0.0)))
        allowed = in_radians(f"theta_lim = {limit:.6g} > rest_angle > -pi/2", rest)
        require(-0.5 * np.pi < rest < limit, "bristle.rest_angle", rest, allowed)

    @property
    def limit_angle(self) -> Real:
        """`theta_lim = arccos(h/L)` in rad."""
        return self._angle(jnp.zeros_like(self.height))

    def _reach(self, eta: Real) -> Real:
        """Horizontal extent of the rod, all digits kept where L - h = 1e-9 L."""
        above = self.length - self.height + eta  # in this order: the first two are exact
        return jnp.sqrt(above * (self.length + (self.height - eta)))

    def _angle(self, eta: Real) -> Real:
        # arccos loses half the digits near theta = 0; the two sides of the rod do not.
        return jnp.arctan2(self._reach(eta), self.height - eta)

    def offset(self, eta: Real) -> Real:
        # The difference of the two roots, multiplied out: no cancellation at small eta.
        zero = jnp.zeros_like(eta)
        return eta * (2 * self.height - eta) / (self._reach(eta) + self._reach(zero))

    def energy(self, eta: Real) -> Real:
        return 0.5 * self.stiffness * (self._angle(eta) - self.rest_angle) ** 2

    def slope_bounds(self) -> SlopeBounds:
        """`-tan(theta_lim) < w' < cot(theta_lim)`: no jumps, and only the tip touches."""
        limit = self.limit_angle
        return SlopeBounds(
            -jnp.tan(limit), 1 / jnp.tan(limit), "-tan(theta_lim)", "cot(theta_lim)"
        )

    def rod(self, eta: Real) -> Rod:
        """It rises by cot(theta) from the tip to its root, at the angle in use."""
        reach = self._reach(eta)
        return Rod((self.height - eta) / reach, reach)

    def geometry(self, eta: Real) -> Stance:
        """Always as long as it is; as steep as there is room for it."""
        return Stance(self._angle(eta), self.length + jnp.zeros_like(eta))


@Interpreted
def _angle_of(rod: AngularSpring, eta: Real) -> Real:
    return rod._angle(eta)
