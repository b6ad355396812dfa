"""What a bristle is."""

import abc
from collections.abc import Callable
from typing import Any, ClassVar, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from .._checks import (
    Part,
    Real,
    is_concrete,
    is_foreign,
    require,
    require_function,
    require_real,
)

_ROUNDED = 1e-12  # m: an A(0) that is a difference of lengths


class SlopeBounds(NamedTuple):
    """Open interval of surface slopes that the bristle's geometry allows, and its name.

    The names go into error messages, after "omega_minus >" and "omega_plus <".
    """

    lower: Real | float = -jnp.inf
    upper: Real | float = jnp.inf
    lower_name: str = "-inf"
    upper_name: str = "inf"


class Rod(NamedTuple):
    """A straight rod from the tip to the root.

    `slope`: how steeply it rises, no unit; `reach`: how far away the root is along x, in m.

    >>> rod = fx.bristles.AngularSpring(1.0, length=1.4, height=1.0, rest_angle=0.3)
    >>> found = rod.rod(eta=0.0)
    >>> print(f"rises by {found.slope:.4f} over {found.reach:.4f} m")
    rises by 1.0206 over 0.9798 m
    """

    slope: Real
    reach: Real


class Stance(NamedTuple):
    """How a bristle stands: `angle` theta from the vertical (rad), `length` (m).

    theta > 0 where the tip is behind the root, p < u: `u - p = length sin(theta)`.

    >>> stance = scene.bristle.geometry(eta=0.01)
    >>> print(f"{stance.angle:.2f} rad, {stance.length:.4f} m")
    1.00 rad, 1.8323 m
    """

    angle: Real
    length: Real


class AbstractBristle(Part):
    """A bristle: two scalar functions of the height `eta` of the surface under its tip.

    Everything else (a, alpha, mu, rho, V_eps, the dynamics) follows by autodiff. `positive`
    and `angles` name constructor arguments: those > 0, and those within a right angle
    either way. Designs look for them there; any other number may be anywhere. Bristles of
    a class of your own are checked as `Custom` is where they are made.

    >>> spring = scene.bristle
    >>> print(f"A = {spring.offset(0.01):.4f} m, F = {spring.energy(0.01):.4f} J")
    A = -0.0156 m, F = 0.1611 J
    """

    positive: ClassVar[tuple[str, ...]] = ()
    angles: ClassVar[tuple[str, ...]] = ()

    def __check_init__(self):
        if is_foreign(self):
            require_two(f"bristle: {type(self).__name__}.", self.offset, self.energy)

    def _require_positive(self) -> None:
        for name in self.positive:
            value = getattr(self, name)
            require_real(f"bristle.{name}", value, f"{name} > 0", lambda v: v > 0)

    @abc.abstractmethod
    def offset(self, eta: Real) -> Real:
        """`A(eta)` in m: how far the state is ahead of the tip, `z = p + A`; A(0) = 0."""

    @abc.abstractmethod
    def energy(self, eta: Real) -> Real:
        """`F(eta)` in J: energy stored when the tip stands at height `eta`."""

    def with_slopes(self, eta: Real) -> tuple[Real, Real, Real]:
        """`A(eta)` in m, `A'(eta)`, and `F'(eta)` in N."""
        one = jnp.ones_like(eta)
        offset, ahead = jax.jvp(self.offset, (eta,), (one,))
        return offset, ahead, jax.jvp(self.energy, (eta,), (one,))[1]

    def slope_bounds(self) -> SlopeBounds:
        """Slopes that the contact allows; without a bound of its own, any."""
        return SlopeBounds()

    def rod(self, eta: Real) -> Rod | None:
        """The rod that has to clear the surface ahead of a tip at height `eta` (m)."""
        return None

    def geometry(self, eta: Real) -> Stance | None:
        """How it stands with its tip at height `eta` (m); None where nothing says it."""
        return None

    def root_constant(self) -> Real:
        """`c` in m of the state `z = u + c`, u the place of the root.

        0 of a bristle without a geometry: z is all that is known of its root.
        """
        zero = jnp.zeros(())
        known = self.geometry(zero)
        return zero if known is None else -known.length * jnp.sin(known.angle)


def require_two(whose: str, offset: Callable, energy: Callable) -> None:
    """Check what makes a bristle: A and F that JAX traces, `A(0) = 0` but for rounding,
    and a finite `F'(0)` that is not 0."""
    require_function(f"{whose}offset", offset, "a function A of eta")
    require_function(f"{whose}energy", energy, "a function F of eta")
    if not is_concrete(offset, energy):
        return
    zero: Any = np.float64(0.0)
    start = float(offset(zero))
    require(abs(start) <= _ROUNDED, f"{whose}offset", start, "A(0) = 0")
    alpha = float(jax.grad(lambda eta: jnp.asarray(energy(eta)))(zero))
    require(np.isfinite(alpha), f"{whose}energy", alpha, "a finite F'(0)")
    require(alpha != 0, f"{whose}energy", alpha, "alpha = F'(0) != 0")
