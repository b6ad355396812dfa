"""Passages of a curve over places of the period, and what each must show."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Int

from .._compile import Program, once_a_scene
from ..numerics import Extrema, concatenated, periodic_extrema, rows_of
from .curve import CurveSamples, Intervals
from .forces import Force
from .settings import SETTINGS


class Transits(NamedTuple):
    """Passages over place + n: samples before and after, n, and +1 or -1; shapes (k,)."""

    before: np.ndarray
    after: np.ndarray
    well: np.ndarray
    sign: np.ndarray


def transits(well: np.ndarray, inside: np.ndarray, place: float, band: float) -> Transits:
    """Where a curve goes from one side of `place` + n to the other, by more than `band`.

    Samples within the band do not count, so neither noise nor lingering at a fold makes a
    passage of its own.
    """
    beyond = inside - place
    outside = np.flatnonzero(np.abs(beyond - np.round(beyond)) > band)
    side = (well + np.floor(beyond)).astype(np.int64)[outside]
    step = np.diff(side)
    over = np.flatnonzero(step)
    sign = np.sign(step[over])
    upper = np.maximum(side[over], side[over + 1])
    return Transits(outside[over], outside[over + 1], upper, sign)


def along(passage: Transits, sign: int) -> Transits:
    """Those in one direction."""
    return rows_of(passage, passage.sign == sign)


def over_windows(operation: np.ufunc, values: np.ndarray, first, last) -> np.ndarray:
    """The operation over values[first:last] for each window."""
    if first.size == 0:
        return np.zeros(0)
    pairs = np.stack([first, last], axis=1).ravel()
    return operation.reduceat(np.append(values, values[-1]), pairs)[::2]


@once_a_scene
def _extrema(force: Force) -> Extrema:
    def wiggle(y: Array) -> Array:
        return force.potential.tip_force(y, force.eps)[0]

    return periodic_extrema(wiggle, force.potential.points)


class CurveFolds(NamedTuple):
    """Upward passages meet `V_eps'` at its largest, downward ones at its smallest."""

    places: dict[int, float]
    forces: dict[int, float]


def folds_of(force: Force) -> CurveFolds:
    """Where the tip leaves a well upward (+1) and downward (-1), and the force there."""
    top, most, bottom, least = (float(v) for v in _extrema(force))
    return CurveFolds({1: top, -1: bottom}, {1: most, -1: least})


def missing_forces(force: Force, folds: CurveFolds, at: CurveSamples) -> np.ndarray:
    """For each well left, the force missing at the fold in units of `Phi'' eps`.

    At the fold a solution moves on, so l - Phi' is larger than V' there: never positive
    for a solution, and only the time is noisy, not the place. A well skipped misses 1,
    less what the load overshoots while a fold is passed (0.64 at eps = 1e-2, gamma = 1).
    """
    return np.concatenate([_missing(force, folds, at, sign) for sign in (1, -1)])


def _missing(force: Force, folds: CurveFolds, at: CurveSamples, sign: int) -> np.ndarray:
    place = folds.places[sign]
    found = along(transits(at.well, at.inside, place, SETTINGS.around_fold), sign)
    best = over_windows(np.maximum, sign * at.load, found.before, found.after + 1)
    pull, stiffness = _pull(force, found.well, place)
    eps = float(force.eps)
    return (sign * (pull + folds.forces[sign]) - best) / (stiffness * eps)


def _pull(force: Force, well: np.ndarray, place: float) -> tuple[np.ndarray, np.ndarray]:
    """`Phi'` and `Phi''` with the tip at well + place; padded, to compile for few sizes."""
    room = (1 << max(10, int(well.size).bit_length())) - well.size
    wells = np.pad(well.astype(float), (0, room))
    pulls = _pulls(force, jnp.asarray(wells), jnp.asarray(place))
    pull, stiffness = (np.asarray(v)[: well.size] for v in pulls)
    return pull, stiffness


@Program
def _pulls(force: Force, well, place):
    z = jax.vmap(lambda n: force.state(n, place))(well)
    return jax.vmap(force.support.force)(z), jax.vmap(force.support.stiffness_at)(z)


def most_forgetful(folds: CurveFolds, at: CurveSamples) -> Int[np.ndarray, " k"]:
    """Numbers of samples: the first, and of every well the one forgotten fastest."""
    size = at.well.size
    entries = [
        along(transits(at.well, at.inside, folds.places[-sign], SETTINGS.around_fold), sign)
        for sign in (1, -1)
    ]
    entered = np.concatenate([entry.after for entry in entries])
    edges = np.unique(np.append(entered, 0))
    visit = np.repeat(np.arange(edges.size), np.diff(np.append(edges, size)))
    steepest = np.lexsort((at.slope, visit))[edges]
    numbers = np.unique(np.append(steepest, 0))
    return numbers[numbers < size - 1]


class FastParts(NamedTuple):
    """Of slips, (k,): `int f dt` in N s, the way in m, and between samples inside, by which
    noise changes the first, `int |f_z| dt` in N s/m."""

    impulse: np.ndarray
    way: np.ndarray
    swayed: np.ndarray


def fast_parts(
    folds: CurveFolds, ts: np.ndarray, z: np.ndarray, at: CurveSamples, on: Intervals
) -> FastParts:
    """The fast part of an upward slip is around the fold of the downward ones."""
    gap = (folds.places[1] - folds.places[-1]) % 1
    band = min(SETTINGS.around_fastest, 0.5 * gap, 0.5 - 0.5 * gap)
    sway = np.diff(ts) * np.maximum(np.abs(at.slope[:-1]), np.abs(at.slope[1:]))
    found = []
    for sign in (1, -1):
        crossed = transits(at.well, at.inside, folds.places[-sign], band)
        slip = along(crossed, sign)
        impulse = sign * over_windows(np.add, on.impulse, slip.before, slip.after)
        way = sign * (z[slip.after] - z[slip.before])
        first, last = slip.before + 1, slip.after - 1
        swayed = over_windows(np.add, sway, first, np.maximum(first, last))
        swayed = np.where(last > first, swayed, 0.0)
        found.append(FastParts(impulse, way, swayed))
    return concatenated(found)


def viscosity_ratio(parts: FastParts, viscosity: float, eps: float) -> float:
    """`int f dt / (z_j - z_i)` over fast parts, over the viscosity in N s/m; NaN without.

    An impulse over half a period, not a squared velocity: noise enters at its two ends
    only, but where a tip lingers, which tells nothing.
    """
    told = eps * parts.swayed < SETTINGS.swayed * viscosity * parts.way
    impulse, way = np.sum(parts.impulse[told]), np.sum(parts.way[told])
    return float(impulse / way) / viscosity if way else np.nan
