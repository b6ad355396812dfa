"""The way of a root over its pinned tip, as loads rise and fall slowly.

In between the rod and its support have an equilibrium where the load is
`balance(x) = Phi'(p + x - c) + U'(x)`, x how far the root is ahead of the tip. Where the
balance rises with x they are stable and the root follows the load; else it jumps, at a load
that stays, to the next place that holds, or to an end. What a jump loses is the area
between.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev

from .settings import SETTINGS


class Leg(NamedTuple):
    """From `ahead` to `last` (m), the load going from `load` to `until` (N), having `lost`
    energy (J). A jump where the load stays."""

    ahead: float
    last: float
    load: float
    until: float
    lost: float


class Passage(NamedTuple):
    """Where a root has come to: `ahead` in m, at which `load` in N, having lost so much
    energy in jumps (J); `out`: the end that it has left by, -1 or 1, or 0. `legs`: on what
    way."""

    ahead: float
    load: float
    lost: float
    out: int
    legs: tuple[Leg, ...]


class WayOver(NamedTuple):
    """`balance` in N over `ahead`, its `energy` (an antiderivative, J), its turns (m)."""

    balance: Chebyshev
    energy: Chebyshev
    turns: np.ndarray

    @classmethod
    def of(cls, balance: Chebyshev) -> "WayOver":
        """Of a balance over its domain."""
        low, high = balance.domain
        roots = balance.deriv().roots()
        real = roots.real[np.abs(roots.imag) < 1e-9 * (high - low)]
        inside = np.sort(real[(real > low) & (real < high)])
        return cls(balance, balance.integ(), inside)

    def follow(self, ahead: float, before: float, load: float, way: int) -> Passage:
        """From an equilibrium at the load `before`, while the load goes to `load`.

        `way`: -1 or 1, where the load falls or rises.
        """
        legs: list[Leg] = []
        level, falls = before, False
        while True:
            if not falls and self._holds(ahead, way):
                target = self._next_turn(ahead, way)
                if way * (self.balance(target) - load) >= 0:
                    there = self._root(ahead, target, load)
                    legs.append(Leg(ahead, there, level, load, 0.0))
                    return _passage(legs, 0)
                top = float(self.balance(target))
                legs.append(Leg(ahead, target, level, top, 0.0))
                ahead, level, falls = target, top, True
            else:
                target = self._landing(ahead, way, level)
                lost = self._lost(ahead, target, level)
                legs.append(Leg(ahead, target, level, level, lost))
                ahead, falls = target, False
            if ahead == self.balance.domain[(way + 1) // 2]:
                return _passage(legs, way)

    def places(self, first: float, last: float, loads: np.ndarray) -> np.ndarray:
        """Equilibria in m under loads in N, on a stable branch between two of them.

        From a table whose places lie close where a branch ends, in a fold, by Newton's
        method held between its neighbours there.
        """
        turned = 0.5 - 0.5 * np.cos(np.linspace(0, np.pi, SETTINGS.table))
        places = min(first, last) + abs(last - first) * turned
        levels = np.maximum.accumulate(self.balance(places))
        low = np.clip(np.searchsorted(levels, loads) - 1, 0, places.size - 2)
        found = np.interp(loads, levels, places)
        slope = self.balance.deriv()
        for _ in range(SETTINGS.newton):
            steep = slope(found)
            off = self.balance(found) - loads
            step = np.divide(off, steep, out=np.zeros_like(off), where=steep > 0)
            found = np.clip(found - step, places[low], places[low + 1])
        return found

    def _holds(self, ahead: float, way: int) -> bool:
        """Whether equilibria are stable on the way on from here."""
        ahead_of = 0.5 * (ahead + self._next_turn(ahead, way))
        return float(self.balance.deriv()(ahead_of)) > 0

    def _next_turn(self, ahead: float, way: int) -> float:
        """The next turn of the balance on the way, or the end."""
        end = float(self.balance.domain[(way + 1) // 2])
        near = 1e-9 * float(np.ptp(self.balance.domain))
        beyond = self.turns[way * (self.turns - ahead) > near]
        return float(beyond[0 if way > 0 else -1]) if beyond.size else end

    def _landing(self, ahead: float, way: int, level: float) -> float:
        """Where a jump at a load ends."""
        here = ahead
        while True:
            turn = self._next_turn(here, way)
            if way * (self.balance(turn) - level) > 0:
                return self._root(here, turn, level)
            if turn == self.balance.domain[(way + 1) // 2]:
                return turn
            here = turn

    def _root(self, first: float, last: float, load: float) -> float:
        from scipy.optimize import brentq

        sides = [float(self.balance(x)) - load for x in (first, last)]
        if sides[0] == 0 or sides[0] * sides[1] > 0:
            return first
        return float(brentq(lambda x: self.balance(x) - load, first, last, xtol=1e-15))

    def _lost(self, first: float, last: float, load: float) -> float:
        gained = float(self.energy(last) - self.energy(first))
        return load * (last - first) - gained


def _passage(legs: list[Leg], out: int) -> Passage:
    last = legs[-1]
    return Passage(last.last, last.until, sum(leg.lost for leg in legs), out, tuple(legs))
