"""Friction and compression of a rod as it stands and turned over (Section 3.4)."""

from typing import Any, NamedTuple

import equinox as eqx
import numpy as np

from ..bristles import AbstractBristle, AngularSpring
from ..coefficients import Coefficients
from ..model import coefficients_jit, potential
from ..profiles import AbstractProfile
from ..rods import hinged_load

NO_TURNING = "only a rod on an angular spring, AngularSpring, can turn over"


class NapSlides(NamedTuple):
    """Of slides with and against a nap: friction in N, > 0, and axial force in N, traction
    positive; `alpha` in N, what presses without friction."""

    alpha: float
    rho_with: float
    rho_against: float
    axial_with: float
    axial_against: float


class TurningWindow(NamedTuple):
    """Critical loads in N of rods that turn over against the nap, and only then."""

    least: float
    greatest: float

    @property
    def open(self) -> bool:
        """Whether there are any."""
        return self.least < self.greatest


def axial_force(normal: Any, rho: Any, angle: Any) -> Any:
    """Force in N along a bristle at `angle` (rad) on a slide, traction positive.

    `normal` force and friction `rho` in N, rho signed as rho_plus and rho_minus are:
    `-(N cos(theta) - rho sin(theta))`. With `N = alpha - a rho` and `a = cot(theta)` this
    is the paper's axial tension, its estimate for a flat surface with dry friction.
    """
    return rho * np.sin(angle) - normal * np.cos(angle)


def nap_is_left(angle: Any) -> Any:
    """Whether a bristle at `angle` (rad) moves with its nap to the left, else to the right.

    With the nap the tip is behind the root (Section 3.4): p < u where the angle is > 0.
    """
    return angle < 0


def nap_slides(law: Coefficients, angle: float) -> NapSlides:
    """Of a bristle at `angle` (rad)."""
    right, left = float(law.rho_plus), float(law.rho_minus)
    axial_right = float(axial_force(float(law.normal_plus), right, angle))
    axial_left = float(axial_force(float(law.normal_minus), left, angle))
    alpha = float(law.alpha)
    if nap_is_left(angle):
        return NapSlides(alpha, -left, right, axial_left, axial_right)
    return NapSlides(alpha, right, -left, axial_right, axial_left)


def turned_over(
    profile: AbstractProfile, bristle: AbstractBristle, law: Coefficients
) -> tuple[NapSlides | None, str]:
    """The rod turned over; None where it cannot, and why.

    In a mirror it stands as before, with a rest angle of the other sign, on a surface whose
    slopes have changed sign.
    """
    if not isinstance(bristle, AngularSpring):
        return None, NO_TURNING
    limit, rest = float(bristle.limit_angle), float(bristle.rest_angle)
    if rest <= -limit:
        return None, f"turned over it would not press: rest_angle <= -{limit:.6g}"
    steep = float(law.omega_plus), float(np.tan(limit))
    if steep[0] >= steep[1] or -float(law.omega_minus) >= 1 / steep[1]:
        return None, "turned over it would not clear the surface"
    other = eqx.tree_at(lambda rod: rod.rest_angle, bristle, -bristle.rest_angle)
    pressed = coefficients_jit(potential(profile, other))
    alpha, a = float(pressed.alpha), float(pressed.a)
    normal, rho = _lemma_3(alpha, a, -float(law.omega_minus))
    normal_back, rho_back = _lemma_3(alpha, a, -float(law.omega_plus))
    found = NapSlides(
        alpha=alpha,
        rho_with=rho,
        rho_against=-rho_back,
        axial_with=float(axial_force(normal, rho, limit)),
        axial_against=float(axial_force(normal_back, rho_back, limit)),
    )
    return found, ""


def _lemma_3(alpha: float, a: float, omega: float) -> tuple[float, float]:
    """Normal force and friction in N of a slide whose steepest slope is omega."""
    normal = alpha / (1 + a * omega)
    return normal, omega * normal


def turning_window(standing: NapSlides, turned: NapSlides) -> TurningWindow:
    """What a critical load must exceed, and must not reach, so that both modes slide with
    their nap and turn over against it."""
    return TurningWindow(
        max(-standing.axial_with, -turned.axial_with),
        min(-standing.axial_against, -turned.axial_against),
    )


def stiffnesses(window: TurningWindow, length: Any) -> tuple[float, float]:
    """The same in N m^2, of rods of a length in m."""
    unit = float(hinged_load(1.0, length))
    return window.least / unit, window.greatest / unit
