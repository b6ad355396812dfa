"""What estimates are made from: a scene at one eps and gamma, and laws of its slides."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from ..coefficients import Coefficients
from ..model import (
    Scene,
    coefficients_jit,
    composed,
    require_friction,
    require_reach,
)
from ..slide_laws import SlideData, slide_data

AWAY = 0.005  # of the time that a well takes
FASTEST = 10.0  # times a slide, 0.05 eps in that time: a tip that is faster slips
_BOTH = 0.24  # of the geometric mean, where a tip rests and is held up by drag
_SHARE = 0.5  # of a well, that every slip goes through
_BESIDE = 12  # places about a fold, that tell how it bends


class Setting(NamedTuple):
    """`scene`: as engines see it, effects of the potential worked in. `eps` in m.

    `law`: its coefficients; `data`: force of a well and speeds of the limit.
    """

    scene: Scene
    eps: float
    gamma: float
    law: Coefficients
    data: SlideData

    @property
    def rho(self) -> float:
        """The larger of the two coefficients of friction, in N."""
        return max(float(self.law.rho_plus), -float(self.law.rho_minus))

    @property
    def speed(self) -> float:
        """Speed of the fastest slide, in m/s."""
        return float(np.max(np.abs(self.data.speed)))

    @property
    def fastest(self) -> float:
        """How many times as fast as their slide tips move, at most, outside of slips.

        Outside is further from one than half a percent of the time a well takes, and where
        a tip moves by less than 0.05 eps in that. What makes a slip early is felt so many
        times. With k the stiffness and v the speed of the slide, a tip on the way to a
        fold, `W' = rho - c (Y - Y*)^2/2`, moves `sqrt(100 eps k/c)` times as fast then: in
        stiff wells it hardly moves. One that viscosity holds up at the fold moves
        `8e4 eps^gamma v/c` times as fast. Where both matter (`x' = t + x^2`, solved by Airy
        functions) that is at most their sum and 0.2334 of their geometric mean. The force
        is at most `rho_plus + eps^gamma v`, as it grows only where the tip is slower than
        the slide, and so no tip is faster than `v + (rho_plus - rho_minus)/eps^gamma`.
        """
        bend = self.bend
        if not bend > 0:
            return FASTEST
        resting = np.sqrt(self.eps * self.stiffest / (2 * AWAY * bend))
        viscous = self._drag
        if not viscous.size:
            return float(min(resting, FASTEST))
        held_up = 2 * viscous / (AWAY**2 * bend)
        together = resting + held_up + _BOTH * np.sqrt(resting * held_up)
        driven = np.minimum(together, 1 + self._width / viscous)
        return float(min(np.max(driven), FASTEST))

    def apart(self, shift: float) -> float:
        """How far apart tips are outside of slips, in m, at most, that slip for the same
        pull with supports `shift` (m) apart."""
        if self.is_behind(shift):
            return self.eps + shift
        return min(self.fastest * shift, self.eps + shift)

    def is_behind(self, shift: float) -> bool:
        """Whether there are times outside of both slips, so apart, at which one tip is a
        slip behind the other.

        That takes half a percent of a well on both sides, and the least that a slip takes.
        A tip that viscosity holds up all the way never slips.
        """
        least = self.eps * (2 * AWAY + _SHARE / self._driven)
        return self._driven > FASTEST and shift >= least

    @property
    def _driven(self) -> float:
        """Times as fast as their slide tips are at most: the pull against viscosity."""
        drag = self._drag
        return float(1 + self._width / np.min(drag)) if drag.size else float("inf")

    @property
    def _drag(self) -> Float[np.ndarray, " n"]:
        """`eps^gamma v` in N, where the limit slides."""
        speeds = np.abs(self.data.speed)
        return self.eps**self.gamma * speeds[speeds > 0]

    @property
    def _width(self) -> float:
        """`rho_plus - rho_minus` in N."""
        return float(self.law.rho_plus) - float(self.law.rho_minus)

    @property
    def bend(self) -> float:
        """Least c of `W' = rho - c (Y - Y*)^2/2` at both folds, in N."""
        phase, force = self.data.phase, self.data.force
        bend = np.inf
        for sign in (1.0, -1.0):
            top = int(np.argmax(sign * force))
            away = phase - phase[top]
            away = away - np.round(away)
            near = np.argsort(np.abs(away))[1:_BESIDE]
            fall = np.abs(force[near] - force[top])
            bend = min(bend, float(np.median(2 * fall / away[near] ** 2)))
        return bend

    @property
    def softest(self) -> float:
        """Least Phi'' along the limit, in N/m."""
        return float(np.min(self.data.stiffness))

    @property
    def stiffest(self) -> float:
        """Largest Phi'' along the limit, in N/m."""
        return float(np.max(self.data.stiffness))


def setting_of(scene: Scene, eps: float, gamma: float) -> Setting | None:
    """The setting of a known scene; None where its load turns too often to slide long.

    Raises `ValueError` for an eps (m) at which the bristle loses its contact, and for tips
    that leave no friction.
    """
    plain = composed(scene)
    require_reach(plain.potential, eps)
    require_friction(plain)
    law = coefficients_jit(plain.potential)
    data = slide_data(plain, law, np.array([eps]))
    return None if data is None else Setting(plain, eps, gamma, law, data)
