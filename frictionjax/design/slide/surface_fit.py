"""Inverse design at finite eps: a surface whose steady slides have the wanted friction."""

import dataclasses
import itertools
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..._checks import as_text, require, require_flags, require_real, with_nan
from ..._compile import waiting
from ..._text import Named, ShownNumbers, require_no_axes
from ...bristles import AbstractBristle
from ...effects import Engine
from ...io import ARRAY, AS_IS, TOLD, Document, by_name, nested, several
from ...profiles import Fourier
from ...supports import Spring
from ..common import (
    DesignResult,
    Target,
    compliant_count,
    effects_of_scene,
    named_forces,
    require_passed_on,
    require_targets,
)
from ..surface import MET, ProfileFit, ProfileStatus, fit_profile
from .settings import SETTINGS
from .slide_friction import (
    SLIDE,
    SteadySlide,
    forces_of,
    require_force,
    spring_of,
    steady_slide,
)

_DESIGNED = (*MET, ProfileStatus.CONTRADICTORY)


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class SlideProfileFit(ShownNumbers, DesignResult):
    """A surface, least bent for its coefficients, with wanted steady slides at `eps`.

    `targets`, `achieved` (targets, 2): forces to the right and to the left in N, of the
    kind `force` ("mean" or "peak"). `slides`: of the design, one a target, of a compliant
    array as in `steady_slide`, in means over its bristles. `fit`: the limit
    design behind it, with its history and identifiability, whose coefficients are those
    that the slides need; `limit`: the one for the targets themselves, which slides miss.
    `history` (designs,): largest relative difference between the forces that a design was
    made for and those that its slides show; `steps`: how many designs.
    """

    force: str
    targets: np.ndarray
    achieved: np.ndarray
    slides: tuple[SteadySlide, ...]
    fit: ProfileFit
    limit: ProfileFit
    history: np.ndarray
    steps: int
    status: ProfileStatus

    _good = MET
    document = Document(
        "frictionjax.SlideProfileFit",
        {
            "message": TOLD,
            "force": AS_IS,
            "targets": ARRAY,
            "achieved": ARRAY,
            "history": ARRAY,
            "status": by_name(ProfileStatus),
            "steps": AS_IS,
            "slides": several(SLIDE),
            "fit": nested(ProfileFit),
            "limit": nested(ProfileFit),
        },
    )

    @property
    def profile(self) -> Fourier:
        """The surface."""
        return self.fit.profile

    @property
    def bristles(self) -> tuple[AbstractBristle | None, ...]:
        """The bristles on it, one for each target."""
        return self.fit.bristles

    @property
    def residuals(self) -> np.ndarray:
        """What is missing, relative (targets, 2)."""
        return self.achieved / self.targets - 1

    @property
    def message(self) -> str:
        """Why, for people."""
        asked = f"{self.force} forces {_text(self.targets)} at eps = "
        asked += as_text(self.slides[0].eps)
        if self.status == ProfileStatus.MET:
            return f"{asked}: found in {self.steps} designs"
        shown = f"slides show {_text(self.achieved)}"
        if self.status in _DESIGNED:
            return f"{asked}: {self.status.message}; {shown}"
        if self.status in (ProfileStatus.NO_SLIDE, ProfileStatus.NOT_SETTLED):
            return f"{asked}: {self.status.message} in {self.steps} designs; {shown}"
        return f"{asked}: not reached; {shown}, in the limit: {self.fit.message}"

    def plot(self, ax: Any = None, figure: Any = None) -> Any:
        """The surface, beside the limit's, and how it was found.

        `figure`: a matplotlib Figure or SubFigure to draw into; `ax` is refused, as the
        picture has several axes.

        >>> wanted = fx.Target(scene.bristle, rho_plus=0.12, rho_minus=-0.05)
        >>> figure = fx.fit_slide_profile(wanted, eps=0.01).plot()
        >>> [axes.get_xlabel() for axes in figure.axes]
        ['y (periods)', 'y (periods)', 'design', '|force| wanted (N)']
        """
        require_no_axes(ax)
        from ...plot import draw_slide_profile_fit

        return draw_slide_profile_fit(self, figure)

    def _numbers(self) -> list[Named]:
        told = named_forces(self.force, self.achieved, self.targets)
        bending = self.fit.bending_energy
        return [
            *told,
            Named("eps", self.slides[0].eps, "m", "period of the wiggles"),
            Named("bending_energy", bending, "", "int w''^2"),
            Named("steps", self.steps, "", "designs"),
        ]

    def __repr__(self) -> str:
        return f"SlideProfileFit({self.status.name}: {self.message})"


def _text(forces: np.ndarray) -> str:
    return "; ".join(as_text(row) for row in forces) + " N"


class _Trial(NamedTuple):
    """A limit design for slides that show `at` of its coefficients, in logarithms.

    `shown` (targets, 2): log |forces| of its slides; `off`: by how much they show more
    than the design was made for.
    """

    at: np.ndarray
    fit: ProfileFit
    slides: tuple[SteadySlide, ...]
    shown: np.ndarray
    off: np.ndarray

    @property
    def designed(self) -> bool:
        """Whether the targets are met in the limit, as well as one surface can."""
        return self.fit.status in _DESIGNED

    @property
    def known(self) -> bool:
        return self.designed and all(slide.ok for slide in self.slides)

    @property
    def apart(self) -> float:
        return float(np.max(np.abs(self.off)))


@with_nan
def fit_slide_profile(
    targets: Any,
    eps: Any,
    gamma: Any = 1.0,
    rate: Any = 1.0,
    support: Spring | None = None,
    force: str = "mean",
    *,
    progress: bool = False,
    **options: Any,
) -> SlideProfileFit:
    """A surface whose steady slides at `eps` (m) have the targets' forces.

    `targets`: a `Target` or several, one surface for all; their `rho_plus` and `rho_minus`
    (N) are those of slides, `force` "mean", over time, or "peak", the largest. `gamma`,
    `rate` (N/s), `support`: as in `steady_slide`. `options`: of `fit_profile`, and with
    its `effects` slides have them too; those of a compliant array are of all its bristles.

    Slides show a little more or less than the coefficients of a surface. The limit design
    is made for what is then left of the targets, until both agree (Broyden's method in
    logarithms): 2 to 6 designs to 1e-6 where it was tried. Only surfaces that are least
    bent for their coefficients are looked at: one with other curvatures at its folds may
    meet several targets better. Targets that contradict each other, or are out of reach,
    end as those of `fit_profile` do, with its statuses.

    `progress`: a line on standard error where it takes more than two seconds.

    Returns a `SlideProfileFit`: `.profile`, `.slides`, their forces in N, `.success` and
    more.

    Raises `ValueError` as `fit_profile` and `steady_slide` do, and for targets without
    uncertainties of no more than `eps^gamma rate/k_h`, for each bristle of a compliant
    array: slides on every surface have larger mean and peak forces.

    >>> wanted = fx.Target(scene.bristle, rho_plus=0.12, rho_minus=-0.05)
    >>> fx.fit_slide_profile(wanted, eps=0.01)
    SlideProfileFit(MET: mean forces [ 0.12 -0.05] N at eps = 0.01: found in 5 designs)
    """
    require_passed_on("fit_slide_profile", fit_profile, options)
    many, _ = require_targets(targets, options.get("pulling", False))
    effects = options.get("effects", ())
    effects_of_scene(effects, Engine.SLIDE, [target.bristle for target in many])
    count = compliant_count(effects)
    require_force(force)
    require_flags(progress=progress)
    for name, value in (("eps", eps), ("gamma", gamma), ("rate", rate)):
        require_real(name, value, f"{name} > 0", lambda v: v > 0)
    support = spring_of(support)
    drag = float(eps) ** float(gamma) * float(rate) / float(support.stiffness)
    _require_more_than_drag(many, count * drag, force)

    def tried(at: np.ndarray) -> _Trial:
        shares = np.exp(at).reshape(-1, 2)
        asked = [_shared(t, s) for t, s in zip(many, shares, strict=True)]
        fit = fit_profile(asked, **options)
        parts: Any = fit.bristles
        slides = tuple(
            steady_slide(fit.profile, part, eps, gamma, rate, support, effects)
            for part in parts
        )
        found = np.array([forces_of(slide, force) for slide in slides], dtype=float)
        found *= count
        has = np.array([[float(c.rho_plus), float(c.rho_minus)] for c in fit.coefficients])
        shown = np.log(np.abs(found))
        off = (shown - np.log(np.abs(has))).ravel() - at
        return _Trial(at, fit, slides, shown, off)

    with waiting("fit_slide_profile", progress) as tell:
        designs = itertools.count(1)

        def heard(at: np.ndarray) -> _Trial:
            tell(f"design {next(designs)}, and its slides")
            return tried(at)

        first = heard(np.zeros(2 * len(many)))
        last, history = _settled(heard, first)
    wanted = np.array([[float(t.rho_plus), float(t.rho_minus)] for t in many])
    return SlideProfileFit(
        force=force,
        targets=wanted,
        achieved=np.sign(wanted) * np.exp(last.shown),
        slides=last.slides,
        fit=last.fit,
        limit=first.fit,
        history=history,
        steps=history.size,
        status=_status(last, wanted),
    )


def _require_more_than_drag(targets: list[Target], drag: float, force: str) -> None:
    """Raise `ValueError` for forces that no slide of a surface has, however smooth.

    In a period of a slide at v = rate/k_h the wiggles, which have the period eps in z,
    do no work: v mean(f) = mean(f z') = eps^gamma mean(z'^2) >= eps^gamma v^2 (eq. 2.8),
    and a peak is no less than the mean. Of a compliant array for each bristle; of a rigid
    one once, as its tips have one z. Targets with uncertainties need not be met.
    """
    for index, target in enumerate(targets):
        name = "target" if len(targets) == 1 else f"targets[{index}]"
        for side in ("rho_plus", "rho_minus") if target.uncertainty is None else ():
            value = float(getattr(target, side))
            needs = (
                f"more than {as_text(drag)} N, what every slide takes by its drag alone, "
                f"eps^gamma rate/k_h, in {force} forces: ask for more, or drag slower"
            )
            require(abs(value) > drag, f"{name}.{side}", value, needs)


def _shared(target: Target, shares: np.ndarray) -> Target:
    """The coefficients of slides that show `shares` (2,) of them as the target."""
    forces = target.rho_plus / shares[0], target.rho_minus / shares[1]
    uncertainty = target.uncertainty
    if uncertainty is not None:
        uncertainty = np.broadcast_to(np.asarray(uncertainty, dtype=float), 2) / shares
    return target._replace(
        rho_plus=float(forces[0]), rho_minus=float(forces[1]), uncertainty=uncertainty
    )


def _status(last: _Trial, wanted: np.ndarray) -> ProfileStatus:
    if not last.designed:
        return last.fit.status
    if not last.known:
        return ProfileStatus.NO_SLIDE
    if last.apart > SETTINGS.settled:
        return ProfileStatus.NOT_SETTLED
    # What several slides show is right to that: the limit design takes it for a conflict.
    met = np.max(np.abs(last.shown - np.log(np.abs(wanted)))) <= SETTINGS.settled
    return ProfileStatus.MET if met else last.fit.status


def _settled(
    tried: Callable[[np.ndarray], _Trial], last: _Trial
) -> tuple[_Trial, np.ndarray]:
    """Broyden's method from the first trial, and how far each design was from settled.

    A step to a design or a slide that is not found is halved; where that does not help,
    the design that could not be made is the answer.
    """
    pull, history = -np.eye(last.at.size), [last.apart]
    while last.known and last.apart > SETTINGS.settled and len(history) < SETTINGS.designs:
        move = np.linalg.solve(pull, -last.off)
        move *= min(1.0, SETTINGS.far / np.max(np.abs(move)))
        for _ in range(SETTINGS.step_halvings):
            found = tried(last.at + move)
            history.append(found.apart)
            if found.known:
                break
            move = 0.5 * move
        else:
            return found, np.array(history)
        change = found.off - last.off - pull @ move
        pull = pull + np.outer(change, move) / (move @ move)
        last = found
    return last, np.array(history)
