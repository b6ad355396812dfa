"""The periodic force of a steady slide: `dF/dY = k eps (v eps^gamma/(F - W'(Y)) - 1)`."""

from typing import NamedTuple

import numpy as np

from .settings import SETTINGS
from .well_force import WellForce, gap_at


class Orbit(NamedTuple):
    """Force beyond rho over a period, in N: its largest, smallest and mean value."""

    largest: np.ndarray
    smallest: np.ndarray
    mean: np.ndarray


def periodic_orbit(well: WellForce, drop: np.ndarray, drag: np.ndarray) -> Orbit:
    """Of slides in which the force falls by `drop` = k eps (N) a well, under a viscous
    force `drag` = v eps^gamma (N); any shape.

    Implicit steps over nodes that are as dense as time is spent there, extrapolated from
    three grids to third order. (The step is exact in sign and never leaves F > W', so
    slides whose tips rest are no stiffer than others.)
    """
    shape = np.broadcast_shapes(drop.shape, drag.shape)
    drop, drag = np.broadcast_to(drop, shape).ravel(), np.broadcast_to(drag, shape).ravel()
    scale = excess_scale(well, drop, drag)
    place = _nodes(well, scale, SETTINGS.orbit_nodes * _tops(well))
    gap = gap_at(well, place)
    grids = [_cycle(place[::n], gap[::n], drop, drag, scale) for n in (1, 2, 4)]
    return Orbit._make(
        ((8 * a - 6 * b + c) / 3).reshape(shape) for a, b, c in zip(*grids, strict=True)
    )


def excess_scale(well: WellForce, drop: np.ndarray, drag: np.ndarray) -> np.ndarray:
    """Size of the force beyond rho (N): where `drop drag T(f) = min(f, drop)`.

    T(f) is the passage time. With tips that do not rest it is the averaged law
    `drag T(f) = 1`; with tips that rest, the balance at the fold, up to a factor.
    """
    forces = np.exp(well.log_forces)
    work = well.log_times + np.log(drop * drag)[:, None]
    excess = work - np.log(np.minimum(forces, drop[:, None]))
    index = np.clip(np.sum(excess > 0, axis=1) - 1, 0, forces.size - 2)
    rows = np.arange(drop.size)
    high, low = excess[rows, index], excess[rows, index + 1]
    share = np.clip(high / (high - low), 0.0, 1.0)
    step = well.log_forces[1] - well.log_forces[0]
    return np.exp(well.log_forces[index] + share * step)


def _tops(well: WellForce) -> int:
    """How many tops are about as high as the highest one, at least 1."""
    gap = well.gap[:-1]
    lowest = (gap < np.roll(gap, 1)) & (gap <= np.roll(gap, -1))
    return int(
        np.clip(
            np.sum(lowest & (gap < SETTINGS.nearly_top * well.range)), 1, SETTINGS.most_tops
        )
    )


def _nodes(well: WellForce, scale: np.ndarray, count: int) -> np.ndarray:
    """Places (count + 1, cells): half of them even in place, half in time."""
    low = scale[:, None] + well.gap
    spent = 0.5 * np.diff(well.place) * (1 / low[:, 1:] + 1 / low[:, :-1])
    spent = np.cumsum(spent, axis=1) / np.sum(spent, axis=1, keepdims=True)
    even = (well.place[1:] - well.place[0]) / (well.place[-1] - well.place[0])
    mixed = np.concatenate([np.zeros((scale.size, 1)), 0.5 * (spent + even)], axis=1)
    wanted = np.linspace(0, 1, count + 1)
    return np.stack([np.interp(wanted, row, well.place) for row in mixed], axis=1)


def _cycle(
    place: np.ndarray,
    gap: np.ndarray,
    drop: np.ndarray,
    drag: np.ndarray,
    first: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Largest, smallest and mean excess of the periodic solution on these nodes."""
    start = first.copy()
    for _ in range(SETTINGS.sweeps):
        states, kept = _march(place, gap, drop, drag, start)
        change = (states[-1] - start) / np.maximum(1 - kept, 1e-12)
        size = np.abs(states).max(axis=0)
        # No solution lies below the last well's fold by more than a well's drop.
        start = np.maximum(start + change, -drop)
        if np.all(np.abs(change) <= SETTINGS.converged * size):
            break
    weights = np.diff(place, axis=0)
    mean = 0.5 * np.sum(weights * (states[1:] + states[:-1]), axis=0)
    return states.max(axis=0), states.min(axis=0), mean


def _march(
    place: np.ndarray,
    gap: np.ndarray,
    drop: np.ndarray,
    drag: np.ndarray,
    start: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Excess at all nodes from `start`, and what of a change there is left at the end.

    A step solves `f = f_0 - h drop + h drop drag/(f + gap)` for f + gap > 0.
    """
    states = np.empty(place.shape)
    states[0] = state = start
    kept = np.ones_like(start)
    falls = np.diff(place, axis=0) * drop
    gains = falls * drag
    for index, (fall, gain) in enumerate(zip(falls, gains, strict=True), start=1):
        half = 0.5 * (state - fall + gap[index])
        root = np.sqrt(half * half + gain)
        free = np.where(half > 0, half + root, gain / np.maximum(root - half, 1e-300))
        state = free - gap[index]
        kept = kept * free * free / (free * free + gain)
        states[index] = state
    return states, kept
