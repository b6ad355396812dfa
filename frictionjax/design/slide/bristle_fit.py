"""Inverse design at finite eps: the bristle whose steady slide has a wanted friction."""

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from ..._checks import (
    Real,
    as_real,
    as_text,
    is_concrete,
    require,
    require_flags,
    require_real,
    with_nan,
)
from ..._compile import Program, in_chunks, waiting
from ..._text import Named, SelfDrawn, ShownNumbers
from ...bristles import AbstractBristle, normal_force, pulling_text
from ...io import AS_IS, LEAF, PART, TOLD, Document, Form, by_name, nested
from ...model import BristlePotential, smallest_stretch
from ...profiles import AbstractProfile
from ...supports import Spring
from ..bristle import AngleFit, FitStatus, fit_angle, intervals_text
from ..common import (
    QUANTITIES,
    DesignResult,
    FreeParameter,
    OnSlopes,
    free_parameter,
    on_slopes,
    quantity_of,
    require_passed_on,
)
from .scan import Scan, crossings, scan_slides, sliding, touching
from .settings import SETTINGS
from .slide_friction import (
    SLIDE,
    SLIDE_FORCES,
    SteadySlide,
    forces_of,
    require_force,
    slide_at,
    spring_of,
)

_PAIRS = Form(read=lambda rows: jnp.asarray(np.array(rows, float).reshape(-1, 2)))


class SlideFit(ShownNumbers, SelfDrawn, DesignResult, eqx.Module):
    """A bristle whose steady slide at `eps` gives a wanted quantity.

    As `AngleFit`, with the quantity made of the slide's forces, `force` "mean" or "peak":
    `value`, of `solutions` the nearest to what it was, but for those of which drag,
    `eps^gamma rate/k_h`, is more than half of the friction in the mean of both ways, where
    there are others; `achieved`, `target`, `solutions` (all that a scan of 43 values an
    interval tells apart, its extrema polished), `reachable` (intervals, 2): least and
    largest quantity of that scan. `failed` (n,): values of it at which there is a bristle
    but its slide was not found, but for those next to an end where nothing grows towards
    the target; without a solution the status is then UNKNOWN, not UNREACHABLE. `slide`: of
    the bristle returned. `by_target`: d value/d target, infinite where the status is
    TANGENT. `limit`: the fit for eps -> 0.
    """

    bristle: AbstractBristle
    value: Real
    achieved: Real
    target: Real
    solutions: Real
    reachable: Real
    failed: Real
    by_target: Real
    slide: SteadySlide
    limit: AngleFit
    status: FitStatus = eqx.field(static=True)
    force: str = eqx.field(static=True)

    _good = FitStatus.OK, FitStatus.TANGENT
    _picture = "draw_slide_fit"
    document = Document(
        "frictionjax.SlideFit",
        {"message": TOLD}
        | dict.fromkeys(("value", "achieved", "target", "solutions"), LEAF)
        | {
            "reachable": _PAIRS,
            "failed": LEAF,
            "by_target": LEAF,
            "status": by_name(FitStatus),
            "force": AS_IS,
            "bristle": PART,
            "slide": SLIDE,
            "limit": nested(AngleFit),
        },
    )

    @property
    def message(self) -> str:
        """Why, for people."""
        limit = self.limit
        asked = f"{limit.quantity} = {as_text(self.target)} of {self.force} forces"
        asked += f" at eps = {as_text(self.slide.eps)}"
        value = f"{limit.free} = {as_text(self.value)}"
        if self.status == FitStatus.UNREACHABLE:
            return (
                f"{asked} cannot be reached by {limit.free}: steady slides show "
                f"{intervals_text(self.reachable)}; nearest: {as_text(self.achieved)} "
                f"at {value}{self._in_the_limit}"
            )
        if self.status == FitStatus.UNKNOWN:
            count, first = self.failed.shape[0], as_text(self.failed[0])
            known = intervals_text(self.reachable)
            shown = f"others show {known}" if known else "no other is known"
            return (
                f"{asked}: {self.status.message}: {count} slides were not computed, the "
                f"first at {limit.free} = {first}; {shown}"
            )
        count = int(np.size(self.solutions))
        others = "" if count < 2 else f" ({count} solutions)"
        pulls = pulling_text(normal_force(self.bristle), self.bristle)
        told = f"; {pulls}" if pulls else ""
        ended = f"{self.status.message}, {value}{others}{told}"
        return f"{asked}: {ended}{self._in_the_limit}"

    @property
    def _in_the_limit(self) -> str:
        """Where the limit's design would pull. Slides of those are not computed."""
        pulls = self.limit.status == FitStatus.PULLS
        return f"; in the limit: {self.limit.message}" if pulls else ""

    def __repr__(self) -> str:
        return f"SlideFit({self.message})"

    def _numbers(self) -> list[Named]:
        asked = f"{self.limit.quantity} of {self.force} forces"
        return [
            Named(self.limit.free, self.value, "", "of the bristle found"),
            Named("wanted", self.target, "", asked),
            Named("achieved", self.achieved, "", asked),
            Named("eps", self.slide.eps, "m", "of the slide"),
            Named("by_target", self.by_target, "", f"d {self.limit.free}/d wanted"),
            Named("in the limit", self.limit.value, "", f"{self.limit.free} for eps -> 0"),
        ]


class _Asked(NamedTuple):
    """Of a design: number of the quantity, whether of peaks, (eps, gamma, rate, k_h)."""

    which: Any
    peak: Any
    scene: tuple


class _Slide(NamedTuple):
    """At one coordinate: the quantity and the number, each with its slope, the slide."""

    shown: Any
    slope: Any
    speed: Any
    value: Any
    slide: SteadySlide


def _quantity(free, bristle, profile, asked: _Asked, x):
    """The quantity at a coordinate of the number, and the slide."""
    wiggle = BristlePotential(profile, free.at(bristle, x))
    slide = slide_at(wiggle, *asked.scene)
    mean, peak = (quantity_of(forces_of(slide, f), asked.which) for f in SLIDE_FORCES)
    return jnp.where(asked.peak, peak, mean), slide


@Program
def _quantities(
    free: FreeParameter,
    bristle: AbstractBristle,
    profile: AbstractProfile,
    asked: Any,
    places: Array,
) -> Array:
    """The quantity at coordinates (n,), NaN where there is no slide."""

    def one(x: Array) -> Array:
        found, slide = _quantity(free, bristle, profile, asked, x)
        return jnp.where(slide.ok, found, jnp.nan)

    return jax.lax.map(one, places)


@Program
def _alone(
    free: FreeParameter,
    bristle: AbstractBristle,
    profile: AbstractProfile,
    asked: Any,
    x: Array,
) -> _Slide:
    """A slide, its quantity and the number, and how both change with the coordinate."""

    def one(x: Array) -> tuple[tuple[Array, Array], SteadySlide]:
        found, slide = _quantity(free, bristle, profile, asked, x)
        return (found, free.value(bristle, x)), slide

    found, slopes, slide = jax.jvp(one, (x,), (jnp.ones_like(x),), has_aux=True)
    return _Slide(
        shown=found[0], slope=slopes[0], speed=slopes[1], value=found[1], slide=slide
    )


@Program
def _follows(
    free: FreeParameter,
    bristle: AbstractBristle,
    profile: AbstractProfile,
    places: Array,
    eps: Any,
) -> Array:
    """Whether bristles at coordinates (n,) follow the surface at this eps: G > 0.

    And F' keeps its sign over a period. Next to alpha = 0 it does not, and slides show
    their drag alone: no difference, a ratio of 1.
    """
    heights = eps * profile(jnp.arange(profile.points) / profile.points)

    def one(x: Array) -> Array:
        part = free.at(bristle, x)
        alpha = part.with_slopes(jnp.zeros(()))[2]
        presses = jnp.all(part.with_slopes(heights)[2] * alpha > 0)
        return presses & (smallest_stretch(BristlePotential(profile, part), eps) > 0)

    return jax.vmap(one)(places)


@Program
def _coordinates(free: FreeParameter, bristle: AbstractBristle, ends: Array) -> Array:
    return jax.vmap(jax.vmap(lambda value: free.coordinate(bristle, value)))(ends)


@Program
def _values(free: FreeParameter, bristle: AbstractBristle, places: Array) -> Array:
    return jax.vmap(lambda x: free.value(bristle, x))(places)


@with_nan
def fit_slide(
    profile: AbstractProfile,
    bristle: AbstractBristle,
    eps: Any,
    gamma: Any = 1.0,
    rate: Any = 1.0,
    support: Spring | None = None,
    force: str = "mean",
    *,
    progress: bool = False,
    **wanted: Any,
) -> SlideFit:
    """The bristle whose steady slide at `eps` (m) has a wanted friction.

    `profile`, `bristle`: as in `fit_angle`. `gamma`, `rate` (N/s), `support`: as in
    `steady_slide`. `force`: "mean", over time, or "peak", the largest. `wanted`: one target
    (`rho_plus`, `rho_minus`, `ratio` or `difference`, of these forces), `free`, `bounds`
    and `pulling`, as in `fit_angle`. The admissible intervals of the limit are scanned as
    far as bristles slide at this eps, pressing (or pulling) throughout a period, turns of
    the quantity are found, and each change of sign is polished by `scipy.optimize.brentq`:
    50 to 200 slides, so this takes seconds, not a millisecond. A ratio of 1, or no
    difference, of drag alone next to alpha = 0 is no solution. `.status` tells what no
    bristle reaches from what could not be evaluated (`UNKNOWN`).

    Returns a `SlideFit`: `.bristle .value .achieved .solutions .slide .limit .success` and
    more; forces in N.

    `progress`: a line on standard error where it takes more than two seconds.

    Raises `ValueError` as `fit_angle` and `steady_slide` do, for several targets, and for
    effects: slides are those of one bristle; `TypeError` for what `fit_angle` has not.

    >>> fx.fit_slide(scene.profile, scene.bristle, eps=0.01, ratio=1.3)
    SlideFit(ratio = 1.3 of mean forces at eps = 0.01: found, angle = 0.930165)
    """
    require_passed_on("fit_slide", fit_angle, wanted)
    alone = "none: of an array or the leading order, scan fx.steady_slide(effects=...)"
    require(not wanted.get("effects"), "effects", wanted.get("effects"), alone)
    support = spring_of(support)
    require_force(force)
    require_flags(progress=progress)
    for name, value in (("eps", eps), ("gamma", gamma), ("rate", rate)):
        require_real(name, value, f"{name} > 0", lambda v: v > 0)
    limit = fit_angle(profile, bristle, **wanted)
    require(is_concrete(limit), "targets", "traced", "known numbers: this is a search")
    require(limit.code.ndim == 0, limit.quantity, limit.target, "one number")
    scene = tuple(as_real(v) for v in (eps, gamma, rate, support.stiffness))
    with waiting("fit_slide", progress) as tell:
        return _searched(profile, bristle, limit, scene, force, tell)


def _searched(
    profile: AbstractProfile,
    bristle: AbstractBristle,
    limit: AngleFit,
    scene: tuple,
    force: str,
    tell: Callable[[str], None],
) -> SlideFit:
    """Over all bristles that slide at (eps, gamma, rate, k_h), told what is under way."""
    which = QUANTITIES.index(limit.quantity)
    asked = _Asked(np.asarray(which), np.asarray(force == "peak"), scene)
    free = free_parameter(limit.bristle, limit.free)
    parts = _sliding_parts(limit, free, profile, scene[0])
    allowed = "an eps at which some bristle slides (G > 0, and F' of one sign)"
    require(parts, "eps", scene[0], allowed)
    target = float(limit.target)

    def shown(places: np.ndarray) -> np.ndarray:
        fixed = free, limit.bristle, profile, asked
        return in_chunks(_quantities, SETTINGS.together, fixed, (places,))

    def alone(x: Any) -> _Slide:
        return _alone(free, limit.bristle, profile, asked, np.asarray(x))

    def gap(x: Any) -> float:
        return float(alone(x).shown) - target

    def slope(x: Any) -> float:
        return float(alone(x).slope)

    tell("slides of the whole range")
    scans = [scan_slides(shown, slope, *ends) for ends in parts]
    tell("solutions")
    roots = np.concatenate([crossings(gap, one, target) for one in scans])
    turns = np.concatenate([touching(one, target) for one in scans])
    failed = np.concatenate([one.failed(target) for one in scans])
    found = roots if roots.size else turns
    good = np.array([alone(x).slide.ok for x in found], dtype=bool)
    failed, found = np.concatenate([failed, found[~good]]), found[good]
    slides = [alone(x).slide for x in found]
    found = _with_friction(free, limit, found, parts, scene, slides)

    def values(places: np.ndarray) -> Array:
        return _values(free, limit.bristle, places)

    at = _nearest(scans, target)
    status = FitStatus.UNKNOWN if failed.size else FitStatus.UNREACHABLE
    if found.size:
        now = float(free_parameter(bristle, limit.free).now(bristle))
        some = _rubbing(free, limit, found, scene)
        at = some[np.argmin(np.abs(values(some) - now))]
        status = FitStatus.TANGENT if at in turns else FitStatus.OK
    best = alone(at)
    part = free.put(limit.bristle, best.value)
    tangent = status == FitStatus.TANGENT
    return SlideFit(
        part,
        best.value,
        best.shown,
        limit.target,
        jnp.sort(values(found)),
        jnp.asarray([one.reach for one in scans if one.known]).reshape(-1, 2),
        jnp.sort(values(failed)),
        jnp.asarray(np.inf) if tangent else best.speed / best.slope,
        best.slide,
        limit,
        status,
        force,
    )


def _with_friction(
    free: FreeParameter,
    limit: AngleFit,
    found: np.ndarray,
    parts: list[tuple[float, float]],
    scene: tuple,
    slides: list[SteadySlide],
) -> np.ndarray:
    """Without those that hardly press and show the ratio 1, or no difference, of drag."""
    drag = _drag_of(scene)
    own = {"ratio": 1.0, "difference": 0.0}.get(limit.quantity, np.nan)
    unit = 1.0 if limit.quantity == "ratio" else drag
    means = np.array([0.5 * float(one.mean_plus - one.mean_minus) for one in slides])
    drags = means < 2 * drag
    if not abs(float(limit.target) - own) <= SETTINGS.no_friction * unit or not drags.any():
        return found

    def presses(places: np.ndarray) -> np.ndarray:
        return np.array([abs(float(law.alpha)) for law in _laws_at(free, limit, places)])

    most = presses(np.concatenate([np.linspace(*ends, 9) for ends in parts])).max()
    return found[~drags | (presses(found) >= SETTINGS.pressing * most)]


def _rubbing(
    free: FreeParameter, limit: AngleFit, found: np.ndarray, scene: tuple
) -> np.ndarray:
    """Without those of which drag is more than half of friction, where there are others.

    Next to where a bristle stops pressing ratios of slides are those of their drag.
    """
    if found.size < 2:
        return found
    laws = _laws_at(free, limit, found)
    means = np.array([0.5 * float(abs(law.rho_plus - law.rho_minus)) for law in laws])
    rubs = means > 2 * _drag_of(scene)
    return found[rubs] if np.any(rubs) else found


def _drag_of(scene: tuple) -> float:
    """Mean force of viscosity in a slide, N."""
    eps, gamma, rate, stiffness = (float(number) for number in scene)
    return eps**gamma * rate / stiffness


def _laws_at(free: FreeParameter, limit: AngleFit, places: np.ndarray) -> list[OnSlopes]:
    return [on_slopes(free.at(limit.bristle, x), limit.slopes) for x in places]


def _sliding_parts(
    limit: AngleFit, free: FreeParameter, profile: AbstractProfile, eps: Any
) -> list[tuple[float, float]]:
    """Admissible intervals of the coordinate in which bristles slide: `_follows`."""
    ends = np.asarray(limit.admissible)
    ends = ends[~np.isnan(ends[:, 0])]
    places = np.sort(np.asarray(_coordinates(free, limit.bristle, ends)), axis=1)

    def follows(some: np.ndarray) -> np.ndarray:
        return np.asarray(_follows(free, limit.bristle, profile, some, eps))

    return [part for low, high in places for part in sliding(follows, low, high)]


def _nearest(scans: list[Scan], target: float) -> float:
    """The coordinate whose quantity is nearest, or the first where none is known."""
    nodes = np.concatenate([one.nodes for one in scans])
    away = np.abs(np.concatenate([one.values for one in scans]) - target)
    return float(nodes[np.nanargmin(away)] if np.isfinite(away).any() else nodes[0])
