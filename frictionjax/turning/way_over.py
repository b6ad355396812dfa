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


class Passage(NamedTuple):
    """Where a root has come to: `ahead` in m, at which `load` in N, having lost so much
    energy in jumps (J); `out`: the end that it has left by, -1 or 1, or 0."""

    ahead: float
    load: float
    lost: float
    out: int


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
        level, lost, falls = before, 0.0, False
        while True:
            if not falls and self._holds(ahead, way):
                target = self._next_turn(ahead, way)
                if way * (self.balance(target) - load) >= 0:
                    return Passage(self._root(ahead, target, load), load, lost, 0)
                ahead, level, falls = target, float(self.balance(target)), True
            else:
                target = self._landing(ahead, way, level)
                lost += self._lost(ahead, target, level)
                ahead, falls = target, False
            if ahead == self.balance.domain[(way + 1) // 2]:
                return Passage(ahead, level, lost, way)

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
