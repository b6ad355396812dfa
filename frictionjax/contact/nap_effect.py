"""With and against the nap (Section 3.4): both effects of the paper, for one bristle."""

from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np

from .._checks import as_real, is_concrete, require, require_real, with_nan
from ..bristles import AbstractBristle, AngularSpring, Stance
from ..model import Coefficients, coefficients_jit, friction, potential
from ..profiles import AbstractProfile
from ..rods import hinged_load

_NO_GEOMETRY = "the bristle has no geometry: its nap and the force along it are unknown"
_UPRIGHT = "it stands upright and has no nap: a slide to the right is taken as with it"
_NO_TURNING = "only a rod on an angular spring, AngularSpring, can turn over"


class TurningWindow(NamedTuple):
    """Critical loads in N of rods that turn over against the nap, and only then."""

    least: float
    greatest: float


class Flipped(NamedTuple):
    """The rod turned over, its tip on the other side of its root.

    `alpha` in N; `rho` in N, its friction moved as the rod before was against the nap,
    which is with its own; `axial` in N then, and `axial_back` moved the other way. Traction
    is positive.
    """

    alpha: float
    rho: float
    axial: float
    axial_back: float


class Nap(NamedTuple):
    """What `nap` found. Forces in N, friction > 0, traction positive.

    `rho_with`, `rho_against`: friction of slides with and against the nap, of the bristle
    as it stands; `ratio`: the second over the first. `axial_with`, `axial_against`: the
    force along it then; NaN where it has no geometry. `flipped`: the rod turned over, and
    `axial_flipped`, `rho_flipped`, of it moved as the first was against the nap; None and
    NaN where it cannot turn. `window`: the critical loads of the energetic effect, None
    where there are none. `critical_load`: `pi^2 B/L^2` of the stiffness given, else None.
    `message`: what that means.
    """

    rho_with: float
    rho_against: float
    ratio: float
    axial_with: float
    axial_against: float
    flipped: Flipped | None
    window: TurningWindow | None
    critical_load: float | None
    message: str

    @property
    def axial_flipped(self) -> float:
        """Force along the rod turned over, moved as it was against the nap before."""
        return np.nan if self.flipped is None else self.flipped.axial

    @property
    def rho_flipped(self) -> float:
        """Friction of the rod turned over, moved likewise: the paper's rho_against."""
        return np.nan if self.flipped is None else self.flipped.rho

    def __repr__(self) -> str:
        rows = [
            ("with the nap", self.rho_with, self.axial_with),
            ("against it", self.rho_against, self.axial_against),
        ]
        if self.flipped is not None:
            rows.append(("turned over", self.rho_flipped, self.axial_flipped))
        lines = [f"{'moved':<14}{'friction, N':>14}{'axial force, N':>16}"]
        lines += [f"{name:<14}{rho:>14.6g}{axial:>16.6g}" for name, rho, axial in rows]
        return "\n".join([*lines, f"against/with = {self.ratio:.6g}", self.message])


class _Slides(NamedTuple):
    """Friction in N, > 0, and axial force in N, of slides with and against the nap."""

    rho_with: float
    rho_against: float
    axial_with: float
    axial_against: float


@with_nan
def nap(
    profile: AbstractProfile,
    bristle: AbstractBristle,
    bending_stiffness: Any = None,
) -> Nap:
    """Friction and axial force of a bristle moved with and against its nap, eps -> 0.

    With the nap the tip is behind the root (Section 3.4). Two effects make the directions
    differ. The geometric one, of a bristle that stays as it stands: the surface is steeper
    for it one way (`rho_against`). The energetic one, of a rod on an angular spring that
    buckles: it turns over, and its spring, rest angle now on the other side, presses
    harder (`rho_flipped`, the paper's rho_against, whose formula lacks a factor k/h, as its
    rho_with does). That needs a critical load above the compressions of both slides with
    the nap and below those of both against it: `window`. For an even surface there are such
    loads where `(theta_lim + |rest|)/(theta_lim - |rest|)` is less than
    `(1 + omega cot)(1 + omega tan)/((1 - omega cot)(1 - omega tan))`. Traction, by which
    the paper explains it, never occurs: the axial force is `-N (cos theta - omega sin
    theta)`, and `omega < cot theta` where the rod clears the surface.

    `bending_stiffness` B in N m^2: the critical load of the rod between hinges, as it
    turns, is `pi^2 B/L^2`.

    Raises `ValueError` as `friction(profile, bristle)` does, for traced parts, and for a
    bending stiffness that is not positive, or of a bristle that is no rod.
    """
    law = friction(profile, bristle)
    known = is_concrete(law, bristle)
    require(known, "bristle", "traced numbers", "known ones: friction has derivatives")
    stance = bristle.geometry(jnp.zeros(()))
    critical = _critical_load(bristle, bending_stiffness)
    slides = _slides(law, stance)
    flipped, why = _flipped(profile, bristle, law)
    window = None if flipped is None else _window(slides, flipped)
    notes = [_stands(stance)]
    if flipped is None:
        notes.append(why)
    else:
        notes.append(_of_window(bristle, slides, flipped, window))
        notes.append(_of_load(slides, flipped, critical))
    return Nap(
        rho_with=slides.rho_with,
        rho_against=slides.rho_against,
        ratio=slides.rho_against / slides.rho_with,
        axial_with=slides.axial_with,
        axial_against=slides.axial_against,
        flipped=flipped,
        window=window,
        critical_load=critical,
        message="; ".join(note for note in notes if note),
    )


def _critical_load(bristle: Any, bending_stiffness: Any) -> float | None:
    if bending_stiffness is None:
        return None
    name = "bending_stiffness"
    kind = type(bristle).__name__
    rod = isinstance(bristle, AngularSpring)
    require(rod, name, bending_stiffness, f"None for a {kind}: {_NO_TURNING}")
    allowed = "bending_stiffness > 0 in N m^2"
    require_real(name, bending_stiffness, allowed, lambda B: B > 0)
    return float(hinged_load(as_real(bending_stiffness), bristle.length))


def _slides(law: Coefficients, stance: Stance | None) -> _Slides:
    right, left = float(law.rho_plus), float(law.rho_minus)
    angle = 0.0 if stance is None else float(stance.angle)
    unknown = np.nan if stance is None else 0.0
    axial_right = unknown + axial_force(float(law.normal_plus), right, angle)
    axial_left = unknown + axial_force(float(law.normal_minus), left, angle)
    if angle < 0:  # the tip is ahead of the root: with the nap is to the left
        return _Slides(-left, right, axial_left, axial_right)
    return _Slides(right, -left, axial_right, axial_left)


def axial_force(normal: Any, rho: Any, angle: Any) -> Any:
    """Force in N along a bristle at `angle` (rad) on a slide, traction positive.

    `normal` force and friction `rho` in N, rho signed as rho_plus and rho_minus are:
    `-(N cos(theta) - rho sin(theta))`. With `N = alpha - a rho` and `a = cot(theta)` this
    is the paper's axial tension, its estimate for a flat surface with dry friction.
    """
    return rho * np.sin(angle) - normal * np.cos(angle)


def _flipped(
    profile: AbstractProfile, bristle: AbstractBristle, law: Coefficients
) -> tuple[Flipped | None, str]:
    """The rod turned over; None where it cannot, and why.

    In a mirror it stands as before, with a rest angle of the other sign, on a surface whose
    slopes have changed sign.
    """
    if not isinstance(bristle, AngularSpring):
        return None, _NO_TURNING
    limit, rest = float(bristle.limit_angle), float(bristle.rest_angle)
    if rest <= -limit:
        return None, f"turned over it would not press: rest_angle <= -{limit:.6g}"
    steep = float(law.omega_plus), float(np.tan(limit))
    if steep[0] >= steep[1] or -float(law.omega_minus) >= 1 / steep[1]:
        return None, "turned over it would not clear the surface"
    other = AngularSpring(
        bristle.stiffness, bristle.length, bristle.height, -bristle.rest_angle
    )
    pressed = coefficients_jit(potential(profile, other))
    alpha, a = float(pressed.alpha), float(pressed.a)
    normal, rho = _lemma_3(alpha, a, -float(law.omega_minus))
    normal_back, rho_back = _lemma_3(alpha, a, -float(law.omega_plus))
    axial = axial_force(normal, rho, limit)
    return Flipped(alpha, rho, axial, axial_force(normal_back, rho_back, limit)), ""


def _lemma_3(alpha: float, a: float, omega: float) -> tuple[float, float]:
    """Normal force and friction in N of a slide whose steepest slope is omega."""
    normal = alpha / (1 + a * omega)
    return normal, omega * normal


def _window(slides: _Slides, flipped: Flipped) -> TurningWindow | None:
    least, greatest = _ends(slides, flipped)
    return TurningWindow(least, greatest) if least < greatest else None


def _ends(slides: _Slides, flipped: Flipped) -> tuple[float, float]:
    """What a critical load must exceed, and what it must not reach."""
    least = max(-slides.axial_with, -flipped.axial)
    return least, min(-slides.axial_against, -flipped.axial_back)


def _stands(stance: Stance | None) -> str:
    if stance is None:
        return _NO_GEOMETRY
    return "" if float(stance.angle) else _UPRIGHT


def _of_window(
    bristle: Any, slides: _Slides, flipped: Flipped, window: TurningWindow | None
) -> str:
    least, greatest = _ends(slides, flipped)
    if window is None:
        return (
            "no critical load turns it over against the nap and only then: it would have "
            f"to be above {least:.6g} N and below {greatest:.6g} N"
        )
    stiff = [load / float(hinged_load(1.0, bristle.length)) for load in window]
    return (
        f"turns over against the nap for critical loads of {least:.6g} to {greatest:.6g} N "
        f"(bending stiffness {stiff[0]:.6g} to {stiff[1]:.6g} N m^2)"
    )


def _of_load(slides: _Slides, flipped: Flipped, critical: float | None) -> str:
    if critical is None:
        return ""
    told = f"its own is {critical:.6g} N:"
    if critical <= -slides.axial_with:
        return f"{told} it buckles with the nap too"
    if critical > -slides.axial_against:
        return f"{told} it stays as it stands, and friction is rho_with and rho_against"
    if critical <= -flipped.axial:
        return f"{told} it buckles against the nap, and again once turned over"
    if critical > -flipped.axial_back:
        return f"{told} it turns over against the nap, and never back"
    return f"{told} it turns over, and friction is rho_with and rho_flipped"
