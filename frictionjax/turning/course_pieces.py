"""The course of a limit with modes: what it does between any two loads, in closed form."""

from typing import NamedTuple

import jax
import numpy as np
from jaxtyping import Array, Float

from .._compile import Interpreted, in_chunks, values_at
from ..loads import AbstractPull
from ..supports import AbstractSupport
from .settings import SETTINGS
from .way_over import WayOver

_Column = Float[np.ndarray, " n"]


class HybridPlay(NamedTuple):
    """At times, (n,): `z`, the `root` u and the `tip` p in m, `mode`, and the `dissipation`
    in J."""

    z: np.ndarray
    root: np.ndarray
    tip: np.ndarray
    mode: np.ndarray
    dissipation: np.ndarray


class LimitPiece(NamedTuple):
    """While the load goes from `load` to `until` (N), one way, in a mode.

    `z`, `last`: states in m at both ends, `lost` and `spent` the dissipation in J there. A
    jump where the load stays. A slide has its `friction` in N, a rod in between its `over`
    and how far its root is ahead of its tip, `ahead` to `beyond` in m; else it rests.
    """

    mode: int
    load: float
    until: float
    z: float
    last: float
    lost: float
    spent: float
    friction: float | None = None
    over: WayOver | None = None
    ahead: float = 0.0
    beyond: float = 0.0

    @property
    def jumps(self) -> bool:
        """Whether the state moves under a load that stays."""
        return self.load == self.until and self.z != self.last


class Jumps(NamedTuple):
    """Jumps of a limit, (j,): `time` in s, states `z` before and `last` after in m, and the
    dissipation `lost` before and `spent` after in J."""

    time: _Column
    z: _Column
    last: _Column
    lost: _Column
    spent: _Column


@Interpreted
def _states_of(support: AbstractSupport, forces: Array) -> Array:
    return jax.vmap(support.state_of)(forces)


def loads_at(load: AbstractPull, times: _Column) -> _Column:
    """The load in N at times in s."""
    return in_chunks(values_at, SETTINGS.times, (load,), (np.asarray(times, float),))


def states_of(support: AbstractSupport, forces: _Column) -> _Column:
    """Where in m a support takes up forces in N."""
    return in_chunks(_states_of, SETTINGS.times, (support,), (np.asarray(forces, float),))


class LimitCourse(NamedTuple):
    """Stretches of time on which the load goes one way, and the pieces of each.

    `edges` (s) has one more than `stretches`; `reach` c in m. `rests`: by mode, the forces
    in N on the root that the rod withstands.
    """

    edges: _Column
    stretches: list[list[LimitPiece]]
    load: AbstractPull
    support: AbstractSupport
    reach: float
    rests: dict[int, tuple[float, float]]

    def loads(self, ts: _Column) -> _Column:
        """The load in N at times in s."""
        return loads_at(self.load, ts)

    def at(self, ts: _Column) -> HybridPlay:
        """The limit at sorted times in s; on a jump, before it."""
        loads, last = self.loads(ts), len(self.stretches) - 1
        number = np.clip(np.searchsorted(self.edges, ts) - 1, 0, last)
        z, tip, spent = np.empty((3, ts.size))
        mode = np.empty(ts.size, int)
        for stretch in np.unique(number):
            low, high = np.searchsorted(number, [stretch, stretch + 1])
            pieces = _moving(self.stretches[stretch])
            way = _way(pieces)
            ends = way * np.array([piece.until for piece in pieces[:-1]])
            which = np.searchsorted(ends, way * loads[low:high])
            for index in np.unique(which):
                rows = low + np.flatnonzero(which == index)
                piece = pieces[index]
                z[rows] = self._states(piece, loads[rows])
                slid = 0.0 if piece.friction is None else piece.friction
                spent[rows] = piece.lost + slid * (z[rows] - piece.z)
                mode[rows] = piece.mode
                # Behind the root, before it, or where it was left.
                tip[rows] = z[rows] + (1 - piece.mode) * self.reach
                if piece.mode == 0:
                    tip[rows] = piece.z + self.reach - piece.ahead
        return HybridPlay(z, z + self.reach, tip, mode, spent)

    def strip(self, ts: _Column, mode: np.ndarray) -> tuple[_Column, _Column]:
        """States in m that a rod in its mode withstands at times in s: NaN in between."""
        loads = self.loads(ts)
        ends = np.full((2, ts.size), np.nan)
        for one, (least, most) in self.rests.items():
            rows = mode == one
            if rows.any():
                held = [states_of(self.support, loads[rows] - f) for f in (most, least)]
                ends[:, rows] = held
        return ends[0], ends[1]

    def jumps(self) -> Jumps:
        """All of them; those that follow each other under one load are one."""
        rows: list[list[float]] = []
        for number, pieces in enumerate(self.stretches):
            before = None
            for piece in pieces:
                if not piece.jumps:
                    before = None
                    continue
                time = self._time_of(number, piece.load)
                if before is None:
                    rows.append([time, piece.z, piece.last, piece.lost, piece.spent])
                else:
                    rows[-1][2], rows[-1][4] = piece.last, piece.spent
                before = piece
        return Jumps(*np.array(rows, float).reshape(-1, 5).T)

    def changes(self) -> _Column:
        """Times in s at which one piece ends and another begins, edges among them."""
        inside = [
            self._time_of(number, piece.until)
            for number, pieces in enumerate(self.stretches)
            for piece in pieces[:-1]
        ]
        return np.unique([*self.edges, *inside])

    def _states(self, piece: LimitPiece, loads: _Column) -> _Column:
        if piece.friction is not None:
            return states_of(self.support, loads - piece.friction)
        if piece.over is None:
            return np.full(loads.size, piece.z)
        found = piece.over.places(piece.ahead, piece.beyond, loads)
        return piece.z + (found - piece.ahead)

    def _time_of(self, number: int, load: float) -> float:
        """When the load first comes to a level on a stretch."""
        first, last = self.edges[number : number + 2]
        way = _way(self.stretches[number])
        for _ in range(SETTINGS.zooms):
            times = np.linspace(first, last, SETTINGS.times)
            there = way * (loads_at(self.load, times) - load) >= 0
            place = int(np.argmax(there)) if there.any() else times.size - 1
            first, last = times[max(place - 1, 0)], times[place]
        return float(last)


def _moving(pieces: list[LimitPiece]) -> list[LimitPiece]:
    """Those on which time passes: the last one, a rest, where the load stays."""
    return [piece for piece in pieces if piece.load != piece.until] or pieces[-1:]


def _way(pieces: list[LimitPiece]) -> float:
    return 1.0 if pieces[-1].until >= pieces[0].load else -1.0
