"""The limit system of a rod that turns over: a play operator with modes."""

from typing import Any, NamedTuple

import jax
import numpy as np
from numpy.polynomial import Chebyshev

from .._checks import ByIdentity, no_less, no_more, require
from .._compile import Program
from ..effects import NapFlip
from ..model import Scene, known_turning_points
from ..supports import AbstractSupport
from ..tables import load_table
from .course_pieces import HybridPlay, LimitCourse, LimitPiece, loads_at
from .critical_forces import FlippingRod, flipping_rod
from .polynomials import turning_force
from .settings import SETTINGS
from .way_over import WayOver


class _State(NamedTuple):
    """Mode, `z` in m, the load that it is an equilibrium of (N), and what is lost (J).

    `ahead`: of a rod in between how far its root is ahead of its tip, in m; `way`: -1 or 1,
    where it goes back or forth. `path`: its way over.
    """

    mode: int
    z: float
    load: float
    lost: float
    ahead: float = 0.0
    way: int = 0
    path: WayOver | None = None


@Program
def _pulls(support: AbstractSupport, z: jax.Array) -> jax.Array:
    return jax.vmap(support.force)(z)


@Program
def _support_at(support: AbstractSupport, z: Any) -> tuple[Any, Any]:
    return support.force(z), support.energy(z)


@Program
def _state_of(support: AbstractSupport, force: Any) -> Any:
    return support.state_of(force)


class _System(NamedTuple):
    """The support, the rod and what pulls it in between."""

    support: AbstractSupport
    rod: FlippingRod
    turning: Chebyshev

    def after(self, state: _State, load: float) -> tuple[_State, list[LimitPiece]]:
        """The state once the load has gone to `load`, one way, and on what way."""
        pieces: list[LimitPiece] = []
        while True:
            before, (state, found) = state, self._on(state, load)
            pieces += found
            if state.load == load and state.mode == before.mode:
                if all(piece.load == piece.until for piece in pieces):
                    pieces.append(_still(state, load))
                return state, pieces

    def _on(self, state: _State, load: float) -> tuple[_State, list[LimitPiece]]:
        """As far as it goes in one mode."""
        if state.mode == 0:
            return self._over(state, load)
        standing = state.mode == 1
        lowest, highest = self.rod.standing_rest if standing else self.rod.turned_rest
        pull, _ = self._at(state.z)
        slides, turns = (highest, lowest) if standing else (lowest, highest)
        way, pieces = state.mode, []
        if way * (state.load - pull - slides) > 0:  # it has just come round, and is late
            state, late = self._jumped(state, slides)
            pieces.append(late)
            pull, _ = self._at(state.z)
        if way * (load - pull - slides) > 0:
            state, found = self._slid(state, load, slides, pull)
            return state, pieces + found
        if way * (load - pull - turns) <= 0 and way * (load - state.load) < 0:
            if way * (pull + turns - state.load) < 0:
                pieces += _rests(state, pull + turns)
            return self._begun(state, pull + turns, -way), pieces
        return state._replace(load=load), pieces + _rests(state, load)

    def _at(self, z: float) -> tuple[float, float]:
        force, energy = _support_at(self.support, np.asarray(z))
        return float(force), float(energy)

    def held(self, force: float) -> float:
        """Where in m the support takes up a force in N."""
        return float(_state_of(self.support, np.asarray(force)))

    def _jumped(self, state: _State, friction: float) -> tuple[_State, LimitPiece]:
        """To where friction holds the tip, under a load that stays."""
        load = state.load
        z = self.held(load - friction)
        lost = load * (z - state.z) - (self._at(z)[1] - self._at(state.z)[1])
        there = state._replace(z=z, lost=state.lost + lost)
        return there, _between(state, there)

    def _slid(
        self, state: _State, load: float, friction: float, pull: float
    ) -> tuple[_State, list[LimitPiece]]:
        """With the tip where friction holds it, after a rest."""
        begins = pull + friction
        late = state.mode * (begins - state.load) <= 0
        rest = [] if late else _rests(state, begins)
        begun = state._replace(load=begins if rest else state.load)
        z = self.held(load - friction)
        there = begun._replace(z=z, load=load, lost=state.lost + friction * (z - state.z))
        return there, [*rest, _between(begun, there)._replace(friction=friction)]

    def _begun(self, state: _State, load: float, way: int) -> _State:
        """In between, at the end that it comes from."""
        reach = self.rod.reach
        ahead = -way * reach
        origin = state.z - ahead  # z where the root is above the tip
        places = reach * np.cos(np.pi * (np.arange(SETTINGS.nodes) + 0.5) / SETTINGS.nodes)
        pulls = np.asarray(_pulls(self.support, origin + places))
        held = Chebyshev.fit(places, pulls, SETTINGS.nodes - 1, domain=[-reach, reach])
        path = WayOver.of(held + self.turning)
        return state._replace(mode=0, load=load, ahead=ahead, way=way, path=path)

    def _over(self, state: _State, load: float) -> tuple[_State, list[LimitPiece]]:
        assert state.path is not None
        way = (1 if load > state.load else -1) if load != state.load else state.way
        found = state.path.follow(state.ahead, state.load, load, way)
        pieces, here = [], state
        for leg in found.legs:
            z = state.z + leg.last - state.ahead
            there = here._replace(z=z, load=leg.until, lost=here.lost + leg.lost)
            piece = _between(here, there)
            over = None if piece.load == piece.until else state.path
            pieces.append(piece._replace(over=over, ahead=leg.ahead, beyond=leg.last))
            here = there
        path = None if found.out else state.path
        end = here._replace(mode=found.out, ahead=found.ahead, way=way, path=path)
        return end, pieces


def _between(first: _State, last: _State) -> LimitPiece:
    return LimitPiece(
        mode=first.mode,
        load=first.load,
        until=last.load,
        z=first.z,
        last=last.z,
        lost=first.lost,
        spent=last.lost,
        ahead=first.ahead,
        beyond=last.ahead,
    )


def _still(state: _State, load: float) -> LimitPiece:
    return _between(state, state._replace(load=load))


def _rests(state: _State, load: float) -> list[LimitPiece]:
    return [_still(state, load)] if load != state.load else []


_KNOWN = ByIdentity()  # of scenes


def limit_course(scene: Scene, effect: NapFlip) -> LimitCourse:
    """Of a scene with known numbers, from z0 to its end.

    The load is followed from turning point to turning point; between them it rises or
    falls, and what happens is in closed form but for roots. `z = u + c` in every mode.

    Raises `ValueError` as `flipping_rod` does, and for z0 outside of what the rod as it
    stands at first withstands at t = 0.
    """
    found = _KNOWN.get(scene)
    if found is None:
        found = _limit_course(scene, effect)
        _KNOWN.put(scene, found)
    return found


def hybrid_play(scene: Scene, effect: NapFlip, ts: np.ndarray) -> HybridPlay:
    """The limit at sorted times in s. Raises `ValueError` as `limit_course` does."""
    return limit_course(scene, effect).at(ts)


def _limit_course(scene: Scene, effect: NapFlip) -> LimitCourse:
    rod = flipping_rod(scene, effect)
    system = _System(scene.support, rod, turning_force(rod.bent))
    turns = known_turning_points(scene.load, scene.duration, scene.turns)
    edges = np.unique(np.concatenate([[0.0], turns, [float(scene.duration)]]))
    table = load_table(scene.load)
    loads = loads_at(table, edges)
    state = _State(1, float(scene.z0), float(loads[0]), 0.0)
    _require_start(system, state)
    stretches = []
    for load in loads[1:]:
        state, pieces = system.after(state, float(load))
        stretches.append(pieces)
    rests = {1: rod.standing_rest, -1: rod.turned_rest}
    return LimitCourse(edges, stretches, table, scene.support, rod.reach, rests)


def _require_start(system: _System, state: _State) -> None:
    least, most = system.rod.standing_rest
    ends = [system.held(state.load - force) for force in (most, least)]
    slack = 4 * float(np.finfo(float).eps) * max(map(abs, ends))
    needs = "what the rod withstands at t = 0, the interval "
    needs += f"[{no_less(ends[0], 9)}, {no_more(ends[1], 9)}]"
    inside = ends[0] - slack <= state.z <= ends[1] + slack
    require(inside, "scene.z0", state.z, needs)
