"""Forces of a slide for eps -> 0, as a multiple of a power of eps, and the law's name."""

from typing import NamedTuple

import numpy as np

from .orbit import Orbit, periodic_orbit
from .settings import SETTINGS
from .well_force import WellForce

FREE, AVERAGED, SLIPS, BETWEEN = "free", "averaged", "slips", "between"


class LimitOrbit(NamedTuple):
    """`F - rho ~ force eps^order` (N) at moments of a slide, and the law that says so."""

    force: Orbit
    order: float
    law: str


def threshold(well: WellForce) -> float:
    """gamma at which tips begin to rest: `(p - 1)/p`, 1/2 for the usual fold."""
    return 1 - 1 / well.flatness


def limit_orbit(
    well: WellForce, speed: np.ndarray, stiffness: np.ndarray, gamma: float
) -> LimitOrbit:
    """At moments of these speeds (m/s) and stiffnesses (N/m), shape (m,).

    Below the threshold (law "averaged") wells are passed without a rest: the force is that
    of the averaged equation, of order `gamma p/(p - 1)`, the same all over a well. Above it
    ("slips") a tip rests at the fold until it falls into the next well, of order 1. At the
    threshold ("between") both are of order 1, and the constant is a number.
    """
    rests = gamma - threshold(well)
    if rests < -SETTINGS.same_gamma:
        force = averaged_force(well, speed)
        return LimitOrbit(Orbit(force, force, force), gamma / threshold(well), AVERAGED)
    if rests <= SETTINGS.same_gamma:
        eps = SETTINGS.small_drop * well.range / stiffness
        orbit = periodic_orbit(well, stiffness * eps, speed * eps**gamma)
        scaled = Orbit._make(values / eps + well.shift for values in orbit)
        return LimitOrbit(scaled, 1.0, BETWEEN)
    ways = _slips(well)
    top = well.shift + 0.0 * stiffness
    mean = top - 0.5 * np.sum(ways**2) * stiffness
    return LimitOrbit(Orbit(top, top - ways.max() * stiffness, mean), 1.0, SLIPS)


def averaged_force(well: WellForce, drag: np.ndarray) -> np.ndarray:
    """Force beyond rho (N) for a small viscous force where tips do not rest.

    From `int dY/(f + gap) = 1/drag` as f -> 0, where the integral is `B f^(1/p - 1)`. For
    a sine it is `drag^2/(2 rho)`, for p = 2 `2 pi^2 drag^2/|W'''|`.
    """
    power = threshold(well)
    # Above rounding of a flank's gaps, which is far below those of any other top.
    force = np.log(well.range) + (-12.0 if power == 1.0 else -27.0)
    level = np.interp(force, well.log_forces, well.log_times) + power * force
    return (np.exp(level) * drag) ** (1 / power)


def fold_force(
    well: WellForce, speed: np.ndarray, stiffness: np.ndarray, gamma: float
) -> tuple[np.ndarray, float]:
    """Largest force beyond rho over eps^order (N) where tips rest before a slip, and order.

    For gamma < p/(p - 1) it is what a tip needs to leave its fold: for p = 2
    `2.338 (k v)^(2/3) (|W'''|/2)^(-1/3)`, of order 2 (1 + gamma)/3, with the first zero of
    Airy's function. Above, the force drops before that, and what is left is the viscous
    force v eps^gamma of a tip that creeps over the steepest place.
    """
    creeps = gamma * threshold(well) - 1
    if creeps > SETTINGS.same_gamma:
        return speed, gamma
    if creeps >= -SETTINGS.same_gamma:
        eps = SETTINGS.small_drop * well.range / stiffness
        orbit = periodic_orbit(well, stiffness * eps, speed * eps**gamma)
        return orbit.largest / eps**gamma, gamma
    power = 1 / (1 + threshold(well))
    drop, drag = (np.asarray(share * well.range) for share in SETTINGS.resting)
    found = periodic_orbit(well, drop, drag).largest
    return found * (stiffness * speed / (drop * drag)) ** power, (1 + gamma) * power


def _slips(well: WellForce) -> np.ndarray:
    """Ways of the slips of a period, in periods: from each highest place to the next.

    One well, less by what is flat of it; shorter where there are two tops of one height.
    """
    places = np.concatenate([well.place[:-1], well.place[:-1] + 1.0])
    high = np.flatnonzero(well.gap[:-1] < SETTINGS.high * well.range)
    following = np.append(high[1:], high[0] + well.place.size - 1)
    apart = following > high + 1
    return places[following[apart] - 1] - places[high[apart] + 1]
