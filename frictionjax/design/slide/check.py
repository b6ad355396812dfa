"""What a design of the limit shows on the dynamics: the gap, at a few eps."""

import dataclasses
from collections.abc import Sequence
from typing import Any

import equinox as eqx
import numpy as np

from ..._checks import CodedResult, Real, as_real, with_nan
from ..._text import ResultTable
from ...bristles import AbstractBristle, pulling_text
from ...coefficients import Coefficients
from ...effects import AbstractEffect, Engine
from ...model import friction
from ...profiles import AbstractProfile
from ...supports import Spring
from ...wiggly import Status
from ..common import coefficients_in_scene, compliant_count, effects_of_scene
from .slide_friction import SteadySlide, steady_slide

CHECKED_EPS = (1e-2, 1e-3, 1e-4)  # m
_FORCES = ("mean_plus", "mean_minus", "peak_plus", "peak_minus")
_MEANS = ("eps/m", "mean +/N", "gap", "mean -/N", "gap", "ratio", "gap")
_HEADER = (*_MEANS, "peak +/N", "peak -/N", "status")


class DesignCheck(CodedResult, eqx.Module):
    """The limit `law`, the steady `slide` at every eps, and the gaps between them.

    `bristles`: of a compliant array; forces are of all of them. `ok`, `status` and
    `message` are those of the slides.
    """

    law: Coefficients
    slide: SteadySlide
    gamma: Real
    rate: Real
    bristles: int = eqx.field(static=True, default=1)
    _outcomes = Status

    @property
    def _codes(self) -> Any:
        return self.slide._codes

    @property
    def ratio(self) -> Real:
        """`-rho_plus/rho_minus` of the limit."""
        return -self.law.rho_plus / self.law.rho_minus

    @property
    def gap_plus(self) -> Real:
        """`mean_plus/rho_plus - 1`, shape (n,)."""
        return self.slide.mean_plus / self.law.rho_plus - 1

    @property
    def gap_minus(self) -> Real:
        """`mean_minus/rho_minus - 1`, shape (n,)."""
        return self.slide.mean_minus / self.law.rho_minus - 1

    @property
    def gap_ratio(self) -> Real:
        """The slide's ratio over that of the limit, less 1, shape (n,)."""
        return self.slide.ratio / self.ratio - 1

    @property
    def table(self) -> str:
        """The gaps as text, one line an eps, the limit below.

        >>> print(fx.check_design(scene.profile, scene.bristle, eps=[1e-2, 1e-3]).table)
        eps/m  mean +/N     gap    mean -/N     gap    ratio      gap  peak +/N ...
         0.01  0.118858  -1.28%  -0.0878434  -0.12%  1.35306  -1.160%  0.122622 ...
        0.001  0.120051  -0.28%  -0.0876831  -0.30%  1.36915  +0.015%  0.120511 ...
        limit  0.120394           -0.087947          1.36894           0.120394   -0.087947
        """
        return str(self.gap_table)

    @property
    def gap_table(self) -> ResultTable:
        """The gaps, one line an eps, the limit below."""
        rows = [self._row(i) for i in range(self.slide.eps.size)]
        plus, minus = float(self.law.rho_plus), float(self.law.rho_minus)
        last = ("limit", f"{plus:.6g}", "", f"{minus:.6g}", "", f"{float(self.ratio):.6g}")
        rows.append((*last, "", f"{plus:.6g}", f"{minus:.6g}", ""))
        return ResultTable(_HEADER, tuple(rows), left=0)

    def _row(self, i: int) -> tuple[str, ...]:
        found, worst = self.slide, np.atleast_1d(self.slide.status)[i]
        return (
            f"{float(found.eps[i]):.3g}",
            f"{float(found.mean_plus[i]):.6g}",
            f"{float(self.gap_plus[i]):+.2%}",
            f"{float(found.mean_minus[i]):.6g}",
            f"{float(self.gap_minus[i]):+.2%}",
            f"{float(found.ratio[i]):.6g}",
            f"{float(self.gap_ratio[i]):+.3%}",
            f"{float(found.peak_plus[i]):.6g}",
            f"{float(found.peak_minus[i]):.6g}",
            worst.name.lower(),
        )

    def _in_words(self) -> str:
        if shape := np.shape(self.law.rho_plus):
            return f"DesignCheck(batch {shape}: {self.slide!r})"
        told = f"gamma = {float(self.gamma):.4g}, rate = {float(self.rate):.4g} N/s"
        told += f", forces of all {self.bristles} bristles" * (self.bristles > 1)
        pulls = "" if self.law.alpha is None else pulling_text(self.law.alpha)
        pulls = f"\n({pulls})" if pulls else ""
        return f"Steady slide, {told}; gaps to the limit\n{self.table}{pulls}"


@with_nan
def check_design(
    profile: AbstractProfile,
    bristle: AbstractBristle,
    eps: Any = CHECKED_EPS,
    gamma: float = 1.0,
    rate: float = 1.0,
    support: Spring | None = None,
    effects: Sequence[AbstractEffect] = (),
    *,
    progress: bool = False,
) -> DesignCheck:
    """Steady slides at a few eps (m) beside the limit; prints as a table.

    `profile`, `bristle`: the design. `gamma`, `rate` (N/s), `support`: as in
    `steady_slide`. `effects`: of the scene that it is for, as in `fit_profile`; of a
    compliant array forces are those of all its bristles. The mean force nears the limit
    from above where viscosity rules, and from below by half the drop of a slip,
    `k_h eps/2`, where the tip rests between slips.

    `progress`: a line on standard error where it takes more than two seconds.

    Returns a `DesignCheck`: `.law`, the coefficients of the limit, `.slide`, the forces in
    N, and the relative gaps between them, `.gap_plus .gap_minus .gap_ratio`, shape (n,).

    Raises `ValueError` as `steady_slide` does.

    >>> fx.check_design(scene.profile, scene.bristle)
    Steady slide, gamma = 1, rate = 1 N/s; gaps to the limit
     eps/m  mean +/N     gap    mean -/N     gap    ratio      gap  peak +/N ...
      0.01  0.118858  -1.28%  -0.0878434  -0.12%  1.35306  -1.160%  0.122622 ...
     0.001  0.120051  -0.28%  -0.0876831  -0.30%  1.36915  +0.015%  0.120511 ...
    0.0001  0.120351  -0.04%  -0.0879079  -0.04%  1.36906  +0.009%    0.1204 ...
     limit  0.120394           -0.087947          1.36894           0.120394   -0.087947
    """
    slide = steady_slide(
        profile,
        bristle,
        eps=np.atleast_1d(eps),
        gamma=gamma,
        rate=rate,
        support=support,
        effects=effects,
        progress=progress,
    )
    count = compliant_count(effects)
    forces = {name: count * getattr(slide, name) for name in _FORCES}
    return DesignCheck(
        law=_law(profile, bristle, effects),
        slide=dataclasses.replace(slide, **forces),
        gamma=as_real(gamma),
        rate=as_real(rate),
        bristles=count,
    )


def _law(
    profile: AbstractProfile, bristle: AbstractBristle, effects: Sequence[AbstractEffect]
) -> Coefficients:
    """What a design for such scenes is held against."""
    if not effects:
        return friction(profile, bristle)
    asked = effects_of_scene(effects, Engine.SLIDE, [bristle])
    return coefficients_in_scene(asked, profile, bristle)
