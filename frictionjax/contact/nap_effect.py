"""With and against the nap (Section 3.4): both effects of the paper, for one bristle."""

from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np

from .._checks import as_real, is_concrete, require, require_flags, require_real, with_nan
from .._compile import waiting
from .._text import ResultTable, SelfDrawn
from ..bristles import AbstractBristle, AngularSpring, Stance
from ..coefficients import Coefficients
from ..model import friction
from ..profiles import AbstractProfile
from ..rods import hinged_load
from ..turning import (
    NO_TURNING,
    NapSlides,
    TurningWindow,
    nap_slides,
    stiffnesses,
    turned_over,
    turning_window,
)

_NO_GEOMETRY = (
    "the bristle has no geometry: its nap and the force along it are unknown, and "
    "rho_with is of a slide to the right"
)
_UPRIGHT = "it stands upright and has no nap: a slide to the right is taken as with it"


class _NapNumbers(NamedTuple):
    rho_with: float
    rho_against: float
    ratio: float
    axial_with: float
    axial_against: float
    flipped: NapSlides | None
    window: TurningWindow | None
    critical_load: float | None
    message: str


class Nap(SelfDrawn, _NapNumbers):
    """What `nap` found. Forces in N, friction > 0, traction positive.

    `rho_with`, `rho_against`: friction of slides with and against the nap, of the bristle
    as it stands; `ratio`: the second over the first. `axial_with`, `axial_against`: the
    force along it then; NaN where it has no geometry. `flipped`: the rod turned over, and
    `axial_flipped`, `rho_flipped`, of it moved as the first was against the nap; None and
    NaN where it cannot turn. `window`: the critical loads of the energetic effect, None
    where there are none. `critical_load`: `pi^2 B/L^2` of the stiffness given, else None.
    `message`: what that means.
    """

    __slots__ = ()
    _picture = "draw_strokes"

    @property
    def axial_flipped(self) -> float:
        """Force along the rod turned over, moved as it was against the nap before."""
        return np.nan if self.flipped is None else self.flipped.axial_with

    @property
    def rho_flipped(self) -> float:
        """Friction of the rod turned over, moved likewise: the paper's rho_against."""
        return np.nan if self.flipped is None else self.flipped.rho_with

    @property
    def knows_nap(self) -> bool:
        """Whether its nap is known; else `rho_with` is of a slide to the right."""
        return not np.isnan(self.axial_with)

    @property
    def ways(self) -> tuple[str, str]:
        """What `rho_with` and `rho_against` are of, in words."""
        known = self.knows_nap
        return ("with the nap", "against it") if known else ("to the right", "to the left")

    @property
    def turns_over(self) -> bool:
        """Whether it turns over against its nap and only then, by its critical load."""
        loads, own = self.window, self.critical_load
        return bool(loads and own and loads.least < own < loads.greatest)

    def table(self) -> ResultTable:
        """Friction and axial force of slides with the nap, against it and turned over.

        Of a bristle whose nap is not known of slides to the right and to the left.

        >>> rod = fx.bristles.AngularSpring(1.0, length=1.4, height=1.0, rest_angle=0.3)
        >>> fx.nap(fx.profiles.Sine(slope=0.5), rod).table()
        moved         friction, N  axial force, N
        with the nap      0.16056       -0.117003
        against it       0.495204          -1.054
        turned over      0.363291       -0.264736
        against/with = 3.08422
        turns over against the nap for critical loads of 0.264736 to 1.054 N (bending ...
        """
        forth, back = self.ways
        rows = [
            (forth, self.rho_with, self.axial_with),
            (back, self.rho_against, self.axial_against),
        ]
        if self.flipped is not None:
            rows.append(("turned over", self.rho_flipped, self.axial_flipped))
        cells = tuple((name, f"{rho:.6g}", f"{axial:.6g}") for name, rho, axial in rows)
        which = "against/with" if self.knows_nap else "left/right"
        ratio = f"{which} = {self.ratio:.6g}"
        if self.turns_over:
            turned = self.rho_flipped / self.rho_with
            ratio += f" if it kept its nap, turned over/with = {turned:.6g}"
        note = f"{ratio}\n{self.message}"
        return ResultTable(("moved", "friction, N", "axial force, N"), cells, 1, note)

    def __repr__(self) -> str:
        return repr(self.table())

    def _repr_html_(self) -> str:
        return self.table()._repr_html_()


@with_nan
def nap(
    profile: AbstractProfile,
    bristle: AbstractBristle,
    bending_stiffness: Any = None,
    *,
    progress: bool = False,
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

    `progress`: a line on standard error where it takes more than two seconds.

    Returns a `Nap`: `.rho_with`, `.rho_against`, `.rho_flipped` in N, > 0; `.axial_with`
    and its like in N, traction positive; `.window`, `.turns_over`, `.message`.

    Raises `ValueError` as `friction(profile, bristle)` does, for traced parts, and for a
    bending stiffness that is not positive, or of a bristle that is no rod.

    >>> fx.nap(scene.profile, scene.bristle)
    moved         friction, N  axial force, N
    with the nap     0.120394       -0.549184
    against it       0.087947       -0.549184
    against/with = 0.730492
    only a rod on an angular spring, AngularSpring, can turn over
    """
    require_flags(progress=progress)
    with waiting("nap", progress) as tell:
        tell("as it stands")
        law = friction(profile, bristle)
        known = is_concrete(law, bristle)
        require(known, "bristle", "traced numbers", "known ones: friction has derivatives")
        stance = bristle.geometry(jnp.zeros(()))
        critical = _critical_load(bristle, bending_stiffness)
        slides = _slides(law, stance)
        tell("turned over")
        flipped, why = turned_over(profile, bristle, law)
    loads = None if flipped is None else turning_window(slides, flipped)
    notes = [_stands(stance)]
    if flipped is None or loads is None:
        notes.append(why)
    else:
        notes.append(_of_window(bristle, loads))
        notes.append(_of_load(slides, flipped, critical))
    return Nap(
        rho_with=slides.rho_with,
        rho_against=slides.rho_against,
        ratio=slides.rho_against / slides.rho_with,
        axial_with=slides.axial_with,
        axial_against=slides.axial_against,
        flipped=flipped,
        window=loads if loads is not None and loads.open else None,
        critical_load=critical,
        message="; ".join(note for note in notes if note),
    )


def _critical_load(bristle: Any, bending_stiffness: Any) -> float | None:
    if bending_stiffness is None:
        return None
    name = "bending_stiffness"
    kind = type(bristle).__name__
    rod = isinstance(bristle, AngularSpring)
    require(rod, name, bending_stiffness, f"None for a {kind}: {NO_TURNING}")
    allowed = "bending_stiffness > 0 in N m^2"
    require_real(name, bending_stiffness, allowed, lambda B: B > 0)
    return float(hinged_load(as_real(bending_stiffness), bristle.length))


def _slides(law: Coefficients, stance: Stance | None) -> NapSlides:
    if stance is not None:
        return nap_slides(law, float(stance.angle))
    found = nap_slides(law, 0.0)
    return found._replace(axial_with=np.nan, axial_against=np.nan)


def _stands(stance: Stance | None) -> str:
    if stance is None:
        return _NO_GEOMETRY
    return "" if float(stance.angle) else _UPRIGHT


def _of_window(bristle: Any, loads: TurningWindow) -> str:
    least, greatest = loads
    if not loads.open:
        return (
            "no critical load turns it over against the nap and only then: it would have "
            f"to be above {least:.6g} N and below {greatest:.6g} N, as no load is"
        )
    soft, stiff = stiffnesses(loads, bristle.length)
    return (
        f"turns over against the nap for critical loads of {least:.6g} to {greatest:.6g} N "
        f"(bending stiffness {soft:.6g} to {stiff:.6g} N m^2)"
    )


def _of_load(slides: NapSlides, flipped: NapSlides, critical: float | None) -> str:
    if critical is None:
        return ""
    told = f"its own is {critical:.6g} N:"
    if critical <= -slides.axial_with:
        return f"{told} it buckles with the nap too"
    if critical > -slides.axial_against:
        return f"{told} it stays as it stands, and friction is rho_with and rho_against"
    if critical <= -flipped.axial_with:
        return f"{told} it buckles against the nap, and again once turned over"
    if critical > -flipped.axial_against:
        return f"{told} it turns over against the nap, and never back"
    both = "rho_with and rho_flipped (with the nap, and turned over)"
    return f"{told} it turns over, and friction is {both}"
