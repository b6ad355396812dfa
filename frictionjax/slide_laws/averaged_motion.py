"""The motion averaged over wells: how the lag follows a load that changes its rate."""

from typing import NamedTuple

import numpy as np

from .ingredients import SlideData
from .well_force import WellForce


class AveragedMotion(NamedTuple):
    """What the averaged equation says beyond steady slides and the limit.

    `delay`: largest z - z_eps less that of steady slides, in m, shape (cells,); `spent`:
    energy dissipated beyond the limit's up to the end of each moment, J, (cells, moments).
    """

    delay: np.ndarray
    spent: np.ndarray


def averaged_motion(
    data: SlideData, wells: dict[int, WellForce], eps: np.ndarray, gamma: np.ndarray
) -> AveragedMotion:
    """Of cells (c,): `eps^gamma z' = 1/T(F - rho)` with F = l - Phi'(z), and of the limit.

    Implicit steps from one moment to the next; T is the time of a passage. `wells` by sign
    of the motion. Where tips rest the averaged motion is next to the limit.
    """
    viscosity = eps**gamma
    force = np.full(eps.size, _first_force(data, wells))
    held = float(force[0]) if force.size else 0.0
    lag = np.zeros(eps.size)
    spent = np.zeros((eps.size, data.length.size))
    for index, pull in enumerate(data.pull):
        stiffness = data.stiffness[index]
        pulled, limit = force + pull, held + pull
        force, held = pulled, limit
        for sign, well in wells.items():
            beyond = sign * pulled - well.rho
            # Most moments are of the other direction: none moves, and nothing is sought.
            if np.any(beyond > min(sign * pull, 0.0)):
                share = stiffness * data.length[index] / viscosity
                excess, travel = _moved(well, beyond, share, sign * pull)
                force = force - sign * travel
                lag = np.maximum(lag, excess / stiffness)
                spent[:, index] += travel * (well.rho + excess) / stiffness
            ahead = max(sign * limit - well.rho, 0.0)
            held -= sign * ahead
            spent[:, index] -= ahead * well.rho / stiffness
    steady_lag = _steady_lag(data, wells, viscosity)
    return AveragedMotion(lag - steady_lag, np.cumsum(spent, axis=1))


def _moved(
    well: WellForce, beyond: np.ndarray, share: np.ndarray, pull: float
) -> tuple[np.ndarray, np.ndarray]:
    """Excess of the force at the end of a moment, and k times the way, both in N."""
    excess = np.where(beyond > 0, _relaxed(well, beyond, share), 0.0)
    travel = np.maximum(beyond - excess, 0.0)
    stops = (beyond <= 0) & (beyond - pull > 0)
    if np.any(stops):
        stopped = _stopped(well, beyond - pull, -pull, share)
        travel = np.where(stops, np.maximum(travel, stopped), travel)
    return excess, travel


def _steady_lag(
    data: SlideData, wells: dict[int, WellForce], viscosity: np.ndarray
) -> np.ndarray:
    """Largest z - z_eps of steady slides at the speeds of all moments, in m, (cells,)."""
    found = np.zeros(viscosity.size)
    for sign, well in wells.items():
        speed = np.maximum(sign * data.speed, 0.0)
        lags = steady_force(well, speed * viscosity[:, None]) / data.stiffness
        found = np.maximum(found, lags.max(axis=1, initial=0.0))
    return found


def steady_force(well: WellForce, drag: np.ndarray) -> np.ndarray:
    """Force beyond rho (N) of a steady slide whose tips do not rest: `drag T(f) = 1`.

    0 where drag is.
    """
    moves = drag > 0
    level = np.log(np.where(moves, drag, 1.0))
    found = np.exp(np.interp(level, -well.log_times, well.log_forces))
    return np.where(moves, found, 0.0)


def _first_force(data: SlideData, wells: dict[int, WellForce]) -> float:
    """`l - Phi'(z)` of the limit at t = 0: that at the first motion, less the pull."""
    first = int(np.flatnonzero(data.speed)[0]) if data.speed.any() else 0
    sign = int(np.sign(data.speed[first]))
    held = sign * wells[sign].rho if sign else 0.0
    return held - float(np.sum(data.pull[:first]))


def _relaxed(well: WellForce, beyond: np.ndarray, share: np.ndarray) -> np.ndarray:
    """x > 0 with `x + share/T(x) = beyond`, where beyond > 0."""
    forces = np.exp(well.log_forces)
    total = forces + share[:, None] * np.exp(-well.log_times)
    return np.exp(_crossing(well, np.log(total), np.log(np.maximum(beyond, 1e-300))))


def _stopped(
    well: WellForce, excess: np.ndarray, unload: float, share: np.ndarray
) -> np.ndarray:
    """k times the way (N) on which a tip with this excess > 0 stops as the load turns back.

    In a moment in which the load falls by `unload`: `int_0^excess u/(u + unload)` with
    u = share/T. (Left out, sums over the turns of a triangle were 1.5 times too large.)
    """
    moving = excess > 0
    forces = np.exp(well.log_forces)
    rate = share[:, None] * np.exp(-well.log_times)
    part = rate / (rate + unload)
    steps = 0.5 * np.diff(forces) * (part[:, 1:] + part[:, :-1])
    way = np.concatenate([np.zeros((excess.size, 1)), np.cumsum(steps, axis=1)], axis=1)
    level = np.log(np.where(moving, excess, 1.0))
    place = (level - well.log_forces[0]) / (well.log_forces[1] - well.log_forces[0])
    index = np.clip(place.astype(int), 0, forces.size - 2)
    rows = np.arange(excess.size)
    inside = np.exp(level) - forces[index]
    found = way[rows, index] + inside * part[rows, index]
    return np.where(moving, found, 0.0)


def _crossing(well: WellForce, rising: np.ndarray, level: np.ndarray) -> np.ndarray:
    """log f at which each row of `rising` (cells, forces) reaches its level."""
    rows = np.arange(level.size)
    index = np.clip(np.sum(rising < level[:, None], axis=1), 1, rising.shape[1] - 1)
    low, high = rising[rows, index - 1], rising[rows, index]
    share = np.clip((level - low) / (high - low), 0.0, 1.0)
    step = well.log_forces[1] - well.log_forces[0]
    return well.log_forces[index - 1] + share * step
