"""Inverse design at finite eps: the surface whose steady slide has the wanted friction."""

import dataclasses
from typing import Any, NamedTuple

import numpy as np

from ..arguments import as_text, require, require_real
from ..bristles import AbstractBristle
from ..profiles import Fourier
from ..supports import Spring
from .fit_status import FitStatus
from .profile_fit import fit_profile
from .profile_result import ProfileFit
from .steady_slide import SteadySlide, spring_of, steady_slide
from .targets import Target, require_targets

_MET = 1e-6  # relative error of a force; slides are right to 1e-7
_STEPS = 30
_FAR = 0.5  # of log forces, the longest step
_HALVINGS = 6


@dataclasses.dataclass(frozen=True, repr=False, eq=False)
class SlideProfileFit:
    """The least bent surface whose steady slide at `eps` shows wanted forces.

    `profile`, `bristle`: the design. `target`, `achieved` (2,): forces to the right and to
    the left in N, of the kind `force` ("mean" or "peak"). `slide`: of the design. `fit`:
    the limit design with these coefficients, its history and identifiability; `limit`: the
    one for the target itself, which the slide misses. `steps`: designs tried.
    """

    profile: Fourier
    bristle: AbstractBristle
    force: str
    target: np.ndarray
    achieved: np.ndarray
    slide: SteadySlide
    fit: ProfileFit
    limit: ProfileFit
    steps: int
    status: FitStatus

    @property
    def success(self) -> bool:
        """Whether the slide shows the forces asked for."""
        return self.status == FitStatus.OK

    @property
    def residuals(self) -> np.ndarray:
        """What is missing, relative (2,)."""
        return self.achieved / self.target - 1

    @property
    def message(self) -> str:
        """Why, for people."""
        asked = f"{self.force} forces {as_text(self.target)} N at eps = "
        asked += as_text(self.slide.eps)
        if self.success:
            return f"{asked}: found in {self.steps} designs"
        shown = f"the last design shows {as_text(self.achieved)} N"
        if self.status == FitStatus.UNREACHABLE:
            return f"{asked}: not reached; {shown}, in the limit: {self.fit.message}"
        return f"{asked}: {self.status.message}; {shown}"

    def __repr__(self) -> str:
        return f"SlideProfileFit({self.message})"


class _Trial(NamedTuple):
    """A limit design for log |coefficients| and the log |forces| that its slide shows."""

    at: np.ndarray
    fit: ProfileFit
    slide: SteadySlide
    shown: np.ndarray

    @property
    def known(self) -> bool:
        return bool(self.fit.success and self.slide.ok)


def fit_slide_profile(
    target: Target,
    eps: Any,
    gamma: Any = 1.0,
    rate: Any = 1.0,
    support: Spring | None = None,
    force: str = "mean",
    **options: Any,
) -> SlideProfileFit:
    """The least bent surface whose steady slide at `eps` (m) has the target's forces.

    `target`: `rho_plus` and `rho_minus` (N) are those of the slide, `force` "mean" or
    "peak". `gamma`, `rate` (N/s), `support`: as in `steady_slide`. `options`: of
    `fit_profile`. Coefficients that a limit design is asked for are moved until its slide
    shows the forces (Broyden's method in logarithms: forces tend to coefficients, so the
    first step assumes that they are): 2 to 6 designs to 1e-6 where it was tried.

    Raises `ValueError` as `fit_profile` and `steady_slide` do, and for several targets.
    """
    single = isinstance(target, Target)
    require(single, "target", type(target).__name__, "one frictionjax.Target")
    require_targets(target)
    require(force in ("mean", "peak"), "force", force, "'mean' or 'peak'")
    for name, value in (("eps", eps), ("gamma", gamma), ("rate", rate)):
        require_real(name, value, f"{name} > 0", lambda v: v > 0)
    support = spring_of(support)
    wanted = np.array([float(target.rho_plus), float(target.rho_minus)])

    def tried(at: np.ndarray) -> _Trial:
        plus, minus = np.sign(wanted) * np.exp(at)
        fit = fit_profile(target._replace(rho_plus=plus, rho_minus=minus), **options)
        bristle: Any = fit.bristles[0]
        slide = steady_slide(fit.profile, bristle, eps, gamma, rate, support)
        return _Trial(at, fit, slide, np.log(np.abs(_forces(slide, force))))

    aim = np.log(np.abs(wanted))
    first = tried(aim)
    last, steps = _moved(tried, first, aim)
    bristle: Any = last.fit.bristles[0]
    return SlideProfileFit(
        profile=last.fit.profile,
        bristle=bristle,
        force=force,
        target=wanted,
        achieved=np.sign(wanted) * np.exp(last.shown),
        slide=last.slide,
        fit=last.fit,
        limit=first.fit,
        steps=steps,
        status=_status(last, aim),
    )


def _forces(slide: SteadySlide, force: str) -> np.ndarray:
    plus, minus = getattr(slide, f"{force}_plus"), getattr(slide, f"{force}_minus")
    return np.array([float(plus), float(minus)])


def _met(trial: _Trial, wanted: np.ndarray) -> bool:
    return trial.known and bool(np.max(np.abs(trial.shown - wanted)) <= _MET)


def _status(last: _Trial, wanted: np.ndarray) -> FitStatus:
    if _met(last, wanted):
        return FitStatus.OK
    return FitStatus.UNKNOWN if last.fit.success else FitStatus.UNREACHABLE


def _moved(tried: Any, last: _Trial, wanted: np.ndarray) -> tuple[_Trial, int]:
    """Broyden's method from the first trial, and how many designs there were.

    A step to a design or a slide that is not found is halved; where that does not help,
    the design that could not be made is the answer.
    """
    pull, steps = np.eye(2), 1
    while last.known and not _met(last, wanted) and steps < _STEPS:
        move = np.linalg.solve(pull, wanted - last.shown)
        move *= min(1.0, _FAR / np.max(np.abs(move)))
        for _ in range(_HALVINGS):
            found, steps = tried(last.at + move), steps + 1
            if found.known:
                break
            move = 0.5 * move
        else:
            return found, steps
        off = found.shown - last.shown - pull @ move
        pull = pull + np.outer(off, move) / (move @ move)
        last = found
    return last, steps
