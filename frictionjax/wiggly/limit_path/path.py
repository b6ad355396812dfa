"""The path that the strip's edges prescribe: where, when and how fast the tip must slide.

Lanes measure from it and start by it; what they find does not depend on it, since brackets
and known starts decide which values are accepted.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int, Shaped

from ..._compile import in_chunks, padded_size
from ...loads import AbstractPull
from ...model import SETTINGS as MODEL_SETTINGS
from ...supports import AbstractSupport
from ..equation import PullRange
from .motion import Motion, Piece, arrivals_at, motion_program


class Probes(NamedTuple):
    """Where the speed of the path has been looked at on each piece, P pieces.

    `times` (P, n): s, those of the steepest places of the path among them; `speeds` (P, n):
    m/s. `unseen` (P,): by how much a polynomial through a few nodes misses them, relative.
    """

    times: Float[np.ndarray, "pieces n"]
    speeds: Float[np.ndarray, "pieces n"]
    unseen: Float[np.ndarray, " pieces"]


NO_PROBES = Probes(np.zeros((0, 0)), np.zeros((0, 0)), np.zeros(0))


class Path(NamedTuple):
    """Pieces between turning points of the load, P of them, as NumPy arrays.

    `load`, `support`: as tables. `edges` (P+1,): times in s. `loads` (P+1,): there, in N.
    `states` (P+1,): of the path, in m. `direction` (P,): 1, -1 or 0 where the path rests.
    `touch` (P,): time at which a slide begins, the piece's end where none does. `travel`
    (P+1,): way so far, in m. `rho` (P,): force of friction in N on the slide. `rho_plus`,
    `rho_minus`: in N. `speed`: largest of slides in m/s. `stiffness`, `stiffest`: smallest
    and largest Phi'' there. `pulled`: what the load goes up and down in all, N. `pull`: how
    hard the load pulls. `probes`: speeds on the way. `rows` (room, 7): the pieces for
    compiled programs. `outside`: how far z0 is from the strip, in m.
    """

    load: AbstractPull
    support: AbstractSupport
    edges: Float[np.ndarray, " edges"]
    loads: Float[np.ndarray, " edges"]
    states: Float[np.ndarray, " edges"]
    direction: Shaped[np.ndarray, " pieces"]
    touch: Float[np.ndarray, " pieces"]
    travel: Float[np.ndarray, " edges"]
    rho: Float[np.ndarray, " pieces"]
    rho_plus: float
    rho_minus: float
    speed: float = 0.0
    stiffness: float = 1.0
    stiffest: float = 1.0
    pulled: float = 0.0
    pull: PullRange | None = None
    probes: Probes = NO_PROBES
    rows: Float[np.ndarray, "room 7"] = np.zeros((0, 7))
    outside: float = 0.0

    @property
    def width(self) -> float:
        """`rho_plus - rho_minus` in N: times eps, the energy of one slip."""
        return self.rho_plus - self.rho_minus

    def piece_of(self, times: Float[np.ndarray, "*shape"]) -> Int[np.ndarray, "*shape"]:
        """Index of the piece that holds each time; a turning point opens its piece."""
        found = np.searchsorted(self.edges, times, side="right") - 1
        return np.clip(found, 0, self.direction.size - 1)

    def motion_at(
        self,
        times: Float[np.ndarray, " n"],
        beside: Float[np.ndarray, " n"] | None = None,
    ) -> Motion:
        """The path at each time; its speed, from the right at kinks, at times `beside`."""
        if times.size == 0:
            return Motion(*[times] * len(Motion._fields))
        columns = times, times if beside is None else beside
        fixed = self.load, self.support, self.rows
        return in_chunks(motion_program, MODEL_SETTINGS.times, fixed, columns)

    def states_at(self, times: Float[np.ndarray, "*shape"]) -> Float[np.ndarray, "*shape"]:
        """State in m at times of any shape."""
        return self.motion_at(times.ravel()).states.reshape(times.shape)

    def speeds_at(self, times: Float[np.ndarray, "*shape"]) -> Float[np.ndarray, "*shape"]:
        """Speed in m/s at times of any shape, from the right at kinks."""
        return self.motion_at(times.ravel()).speeds.reshape(times.shape)

    def times_at(
        self, piece: Int[np.ndarray, " n"], states: Float[np.ndarray, " n"]
    ) -> Float[np.ndarray, " n"]:
        """When the path is at each state, on the slide of each piece."""
        if states.size == 0:
            return states
        early, late = self.touch[piece], self.edges[piece + 1]
        found = arrivals_at(self, states, self.rho[piece], early, late)
        return np.clip(found, early, late)


def rows_of_path(path: Path) -> Float[np.ndarray, "room 7"]:
    """The pieces as rows of `Piece`; those that fill the room never begin."""
    pieces = Piece(
        begin=path.edges[:-1],
        touch=path.touch,
        direction=path.direction,
        state=path.states[:-1],
        end_state=path.states[1:],
        travel=path.travel[:-1],
        rho=path.rho,
    )
    count = path.direction.size
    rows = np.full((padded_size(count, MODEL_SETTINGS.edges), len(pieces)), np.inf)
    rows[:count] = np.stack(pieces, axis=1)
    return rows
