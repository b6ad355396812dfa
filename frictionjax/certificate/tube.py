"""How far a curve is from every solution: weighted impulses over windows of all lengths."""

import numpy as np

from .curve import CurveSamples, Intervals
from .settings import SETTINGS


def distance(
    ts, z, at: CurveSamples, on: Intervals, eps: float, viscosity: float, reach: float
) -> float:
    """Lower bound of the distance from any solution, in units of eps.

    A curve within delta of a solution has, for every weight omega and window,
    `|int omega (eps^gamma z' - f) dt| <= delta (eps^gamma (|omega_i| + |omega_j|)
    + int |eps^gamma omega' + omega f_z| dt)` + O(delta^2): the largest ratio bounds delta
    from below, whatever the perturbation. Three weights, for three kinds of motion: 1 for
    rests; `f_z` for slides near the folds; 1/f, that is the time a well takes, where the
    motion never comes near to rest. `reach` is `(rho_plus - rho_minus)/2` in N.
    """
    threshold = SETTINGS.sliding * reach
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
    window = _Windows(np.diff(ts), np.diff(z), at, on, eps, viscosity)
    return max(window.worst(omega, where) for omega, where in weights)


class _Windows:
    """Windows of dyadic lengths over one curve."""

    def __init__(
        self, h, dz, at: CurveSamples, on: Intervals, eps: float, viscosity: float
    ):
        self.h, self.eps, self.viscosity = h, eps, viscosity
        self.slope = at.slope
        self.defect = viscosity * dz - on.impulse
        steepest = np.maximum(np.abs(at.slope[:-1]), np.abs(at.slope[1:]))
        rest = steepest * h * _bow(h, dz)
        second = np.maximum(np.abs(at.bend[:-1]), np.abs(at.bend[1:]))
        stiff = on.doubt == 0
        self.slack = np.where(stiff, rest, on.doubt)
        self.slack += 0.5 * (SETTINGS.second_order * eps) ** 2 * second * h

    def worst(self, omega: np.ndarray, where: np.ndarray) -> float:
        """Largest distance in units of eps over windows inside `where`.

        Sums grow by pairs, not as differences of running sums: no window loses digits to
        the million before it.
        """
        size = np.abs(omega)
        total = omega * self.defect
        slack = np.where(where, size * self.slack, np.inf)
        ends = size * self.viscosity
        half = 0.5 * self.h * omega
        left = ends + np.abs(half * self.slope[:-1])
        right = ends + np.abs(half * self.slope[1:])
        inner = np.abs(
            self.viscosity * (omega[:-1] - omega[1:])
            - self.slope[1:-1] * (half[:-1] + half[1:])
        )
        response, worst, m = np.zeros_like(total), 0.0, 1
        while total.size:
            count = total.size
            allowed = response + left[:count] + right[m - 1 :]
            excess = np.maximum(np.abs(total) - slack, 0.0)
            worst = max(worst, float(np.max(excess / np.maximum(allowed, 1e-300))))
            if count <= m:
                break
            total = total[:-m] + total[m:]
            slack = slack[:-m] + slack[m:]
            response = response[:-m] + response[m:] + inner[m - 1 : m - 1 + count - m]
            m *= 2
        return worst / self.eps


def _bow(h: np.ndarray, dz: np.ndarray) -> np.ndarray:
    """How far a chord may be from the curve, in m: an eighth of the second difference."""
    speed = dz / h
    change = np.abs(np.diff(speed))
    change = np.maximum(np.append(change, 0.0), np.insert(change, 0, 0.0))
    return np.minimum(change * h, 2 * np.abs(dz)) / 8
