"""How much earlier noise lets tips slip: barriers against temperature.

At a force f below the top of a well's force the barrier of the tilted well is
`eps int max(W' - (rho - f), 0) dY` over the hump about the top, and it is passed at most
`max|W''|/(2 pi eps^(1 + gamma)) exp(-barrier/T)` times a second (Kramers, Physica 7, 284,
1940, whose curvatures are replaced by the largest).
"""

from typing import NamedTuple

import numpy as np

from .setting import Setting

_CHANCE = 0.01  # of a barrier above the one told to be passed even once


class ActivatedSlips(NamedTuple):
    """`force` in N below the top at which noise may pass what is left of the barrier.

    `width`: half the hump's, in periods; `logarithm`: barrier over temperature; `free`: no
    force is left at which a barrier holds.
    """

    force: float
    width: float
    logarithm: float
    free: bool


def activated_slips(at: Setting, heat: float) -> ActivatedSlips:
    """Of tips at the temperature `heat` (J), over the scene's duration."""
    phase, force = at.data.phase, at.data.force
    steepest = float(np.max(np.abs(np.gradient(force, phase))))
    rate = steepest / (2 * np.pi * at.eps ** (1 + at.gamma))
    tries = rate * float(at.scene.duration) / _CHANCE
    logarithm = max(1.0, float(np.log(tries)))
    sides = [_one_side(at, sign, heat * logarithm) for sign in (1.0, -1.0)]
    found = max(sides)
    return ActivatedSlips(found[0], found[1], logarithm, any(side[2] for side in sides))


def _one_side(at: Setting, sign: float, barrier: float) -> tuple[float, float, bool]:
    """Deficit in N, half the width of the hump, and whether the barrier (J) never holds."""
    from scipy.optimize import brentq  # 0.2 s, and sweeps have to be quick

    phase, force = at.data.phase, sign * at.data.force
    top = int(np.argmax(force))
    turned = np.roll(force, -top)
    around = np.roll(np.diff(phase, append=phase[0] + 1.0), -top)
    rho = float(turned[0])

    def beyond(deficit: float) -> float:
        return at.eps * _hump(turned, around, deficit)[0] - barrier

    if beyond(rho) < 0:
        return rho, 0.5, True
    found = float(brentq(beyond, 0.0, rho, xtol=1e-9 * rho))
    return found, 0.5 * _hump(turned, around, found)[1], False


def _hump(force: np.ndarray, steps: np.ndarray, deficit: float) -> tuple[float, float]:
    """Area in N above `force[0] - deficit`, and width, of the hump about the top.

    `force` over a period from its top on, `steps` from each place to the next.
    """
    above = np.maximum(force - (force[0] - deficit), 0.0)
    # Beyond the first place on either side that is not above is another hump.
    low = np.flatnonzero(above == 0.0)
    inside = np.ones(above.size, dtype=bool)
    if low.size:
        inside[low[0] : low[-1] + 1] = False
    area = np.where(inside, above, 0.0)
    trapezes = 0.5 * (area + np.roll(area, -1)) * steps
    return float(trapezes.sum()), float(steps[inside].sum())
