"""How far a curve is from every solution: weighted impulses over windows of all lengths."""

from typing import NamedTuple

import numpy as np

from .curve import CurveSamples, Intervals
from .settings import SETTINGS


class CurveSystem(NamedTuple):
    """`eps` in m, `viscosity` eps^gamma in N s/m, `reach` (rho_plus - rho_minus)/2 in N,
    and `bend`, the largest |f_zz| that solutions nearby meet, in N/m^2."""

    eps: float
    viscosity: float
    reach: float
    bend: float


class FromWindows(NamedTuple):
    """In eps: how far a curve is at least from every solution; and what verdicts go by,
    how far it would be if that were `second_order` at most, beyond which it is no bound."""

    least: float
    nearby: float


def distances_by_windows(
    ts, z, at: CurveSamples, on: Intervals, system: CurveSystem
) -> FromWindows:
    """Bounds from weighted impulses over windows.

    A curve within delta of a solution has, for every weight omega and window,
    `|int omega (eps^gamma z' - f) dt| <= delta (eps^gamma (|omega_i| + |omega_j|)
    + int |eps^gamma omega' + omega f_z| dt) + delta^2/2 int |omega f_zz| dt`: that bounds
    delta from below, whatever the perturbation. (Where `eps^gamma omega' + omega f_z`
    about vanishes, a shift by eps/10 was 1.02 eps without the second order.) Three weights,
    for three kinds of motion: 1 for rests; `f_z` for slides near the folds; 1/f, that is
    the time a well takes, where the motion never comes near to rest.
    """
    threshold = SETTINGS.sliding * system.reach
    slow = np.minimum(np.abs(at.force[:-1]), np.abs(at.force[1:]))
    sliding = np.minimum(slow, np.abs(on.middle)) > threshold
    sliding &= on.middle * at.force[:-1] > 0
    inverse = np.where(sliding, 1 / np.where(sliding, on.middle, 1.0), 0.0)
    everywhere = np.ones_like(sliding)
    weights = (
        (np.ones_like(on.middle), everywhere),
        (on.middle_slope, everywhere),
        (inverse, sliding),
    )
    window = _Windows(np.diff(ts), np.diff(z), at, on, system)
    found = zip(*(window.worst(omega, where) for omega, where in weights), strict=True)
    return FromWindows(*(max(one) for one in found))


class _Windows:
    """Windows of dyadic lengths over one curve."""

    def __init__(self, h, dz, at: CurveSamples, on: Intervals, system: CurveSystem):
        self.h, self.eps, self.viscosity, _, self.bend = h, *system
        self.slope = at.slope
        self.defect = self.viscosity * dz - on.impulse
        steepest = np.maximum(np.abs(at.slope[:-1]), np.abs(at.slope[1:]))
        rest = steepest * h * _bow(h, dz)
        second = np.maximum(np.abs(at.bend[:-1]), np.abs(at.bend[1:]))
        stiff = on.doubt == 0
        self.doubt = np.where(stiff, rest, on.doubt)
        self.slack = self.doubt + 0.5 * (SETTINGS.second_order * self.eps) ** 2 * second * h

    def worst(self, omega: np.ndarray, where: np.ndarray) -> FromWindows:
        """Largest distances in units of eps over windows inside `where`.

        Sums grow by pairs, not as differences of running sums: no window loses digits to
        the million before it.
        """
        size = np.abs(omega)
        total = omega * self.defect
        slack = np.where(where, size * self.slack, np.inf)
        doubt = np.where(where, size * self.doubt, np.inf)
        bent = 2 * self.bend * size * self.h
        ends = size * self.viscosity
        half = 0.5 * self.h * omega
        left = ends + np.abs(half * self.slope[:-1])
        right = ends + np.abs(half * self.slope[1:])
        inner = np.abs(
            self.viscosity * (omega[:-1] - omega[1:])
            - self.slope[1:-1] * (half[:-1] + half[1:])
        )
        response, least, nearby, m = np.zeros_like(total), 0.0, 0.0, 1
        while total.size:
            count = total.size
            allowed = np.maximum(response + left[:count] + right[m - 1 :], 1e-300)
            excess = np.maximum(np.abs(total) - slack, 0.0)
            nearby = max(nearby, float(np.max(excess / allowed)))
            excess = np.maximum(np.abs(total) - doubt, 0.0)
            root = 2 * excess / (allowed + np.sqrt(allowed**2 + bent * excess))
            least = max(least, float(np.max(root)))
            if count <= m:
                break
            total = total[:-m] + total[m:]
            slack = slack[:-m] + slack[m:]
            doubt = doubt[:-m] + doubt[m:]
            bent = bent[:-m] + bent[m:]
            response = response[:-m] + response[m:] + inner[m - 1 : m - 1 + count - m]
            m *= 2
        return FromWindows(least / self.eps, nearby / self.eps)


def _bow(h: np.ndarray, dz: np.ndarray) -> np.ndarray:
    """How far a chord may be from the curve, in m: an eighth of the second difference."""
    speed = dz / h
    change = np.abs(np.diff(speed))
    change = np.maximum(np.append(change, 0.0), np.insert(change, 0, 0.0))
    return np.minimum(change * h, 2 * np.abs(dz)) / 8
