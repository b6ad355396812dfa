"""How far a curve is from the solutions that set off from its own rests."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from ..forces import AbstractForce
from .followers import Departures, Followed, followed_at
from .settings import SETTINGS

_Column = Float[np.ndarray, " n"]


class FollowedCurve(NamedTuple):
    """Samples of a curve, (n,): times in s and z in m, the tip at well + inside in periods,
    the force on it in N, dz/dy in m, and how fast the limit would slide, in m/s. `stops`:
    times in s at which the load turns, the last not before the last sample, (s,)."""

    ts: _Column
    z: _Column
    well: _Column
    inside: _Column
    force: _Column
    stretch: _Column
    pace: _Column
    stops: np.ndarray


class FromRests(NamedTuple):
    """In eps: how far a curve is at least from every solution, and at most from the one
    through its first sample; inf where that cannot be said."""

    least: float
    most: float


class _Side(NamedTuple):
    """A solution at about the time of a sample: the least, the most and where it is `now`,
    (n,), in eps above the sample, doubt on its far side."""

    least: _Column
    most: _Column
    now: _Column


class _Between(NamedTuple):
    """Two solutions, those between which others are."""

    lower: _Side
    upper: _Side

    @property
    def off(self) -> _Column:
        """How far samples are from all that is between both, in eps.

        Up to `aside`, from which both set off, nothing is left out; beyond, what is off
        may have grown on the way as both have parted.
        """
        off = np.maximum(self.lower.least, -self.upper.most)
        off = np.where(np.isfinite(off), np.maximum(off, 0.0), 0.0)
        apart = np.nan_to_num(np.maximum(self.upper.now - self.lower.now, 0.0))
        grown = apart / (2 * SETTINGS.aside)
        return np.maximum(np.minimum(off, SETTINGS.aside), off / (1 + grown))

    @property
    def far(self) -> _Column:
        """How far samples are at most from any solution between both, in eps."""
        return np.maximum(np.maximum(self.upper.least, -self.lower.most), 0.0)


def distances_from_rests(
    force: AbstractForce,
    viscosity: float,
    curve: FollowedCurve,
    first: Int[np.ndarray, " k"],
) -> FromRests:
    """By solutions that set off from samples, best where tips forget where they were.

    `viscosity` is `eps^gamma` in N s/m; `first`: numbers of samples, in order from 0.

    Solutions keep their order. One that is close to the curve at a sample stays between
    two that set off from just below and just above it, and where tips forget where they
    were those two are soon one. Here slips show that come late or early, which no window
    over forces sees: at a fold the force that is missing is of second order. (By one
    solution and what a small change becomes, in place of two: next to folds that tips
    hardly pass, noise of eps/100 became 0.6 eps where it was to be 0.004, by hand.)

    A sample may be that of a moment earlier or later, in which the limit slides by eps/100
    at most: slips may take less than that, and no code knows how far they are just then.

    Two are followed until two more have set off twice: the older ones have come closer,
    and have to be between the next ones where these set off.
    """
    eps, ts = float(force.eps), curve.ts
    pace = np.maximum(curve.pace, SETTINGS.slowest * np.max(curve.pace, initial=1e-300))
    moment = SETTINGS.late * eps / pace
    times = np.clip([ts - moment, ts, ts + moment], ts[0], ts[-1])
    hurry = np.abs(curve.force[first]) / viscosity * moment[first] / eps
    hurry[0] = 0.0  # nothing came before
    aside = SETTINGS.aside + np.minimum(hurry, SETTINGS.hurry)

    def departures(turn: int, side: int) -> Departures:
        begin = first[turn::2]
        inside = curve.inside[begin] + side * eps * aside[turn::2] / curve.stretch[begin]
        end = np.append(begin[1:], ts.size - 1)
        return Departures(ts[begin], ts[end], curve.well[begin], inside)

    def seen(found: Followed, side: int) -> _Side:
        state, doubt = (column.reshape(times.shape) for column in found)
        above = (state - curve.z) / eps + side * doubt
        unknown = np.any(np.isnan(above), axis=0)
        return _Side(
            least=np.where(unknown, np.inf, np.min(above, axis=0)),
            most=np.where(unknown, -np.inf, np.max(above, axis=0)),
            now=above[1],
        )

    turns = range(min(first.size, 2))
    ways = [departures(turn, side) for turn in turns for side in (-1, 1)]
    found = followed_at(times.ravel(), force, viscosity, ways, curve.stops)
    pairs = [
        _Between(seen(lower, -1), seen(upper, 1))
        for lower, upper in zip(found[::2], found[1::2], strict=True)
    ]
    least = np.max([pair.off for pair in pairs])
    return FromRests(float(least), _at_most(pairs, first, aside))


def _at_most(pairs: list[_Between], first: np.ndarray, aside: np.ndarray) -> float:
    """From the solution through the first sample, as long as it is between all of them."""
    number = np.arange(first.size - 1)
    older = number % 2, first[1:]
    above = np.stack([pair.upper.now for pair in pairs])[older]
    below = np.stack([pair.lower.now for pair in pairs])[older]
    if not np.all(np.maximum(above, -below) <= aside[1:]):
        return np.inf
    return float(np.max(np.min([pair.far for pair in pairs], axis=0)))
