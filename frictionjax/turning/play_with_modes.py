"""The limit system of a rod that turns over: a play operator with modes."""

from typing import Any, NamedTuple

import jax
import numpy as np
from numpy.polynomial import Chebyshev

from .._checks import no_less, no_more, require
from .._compile import Program, padded_size
from ..effects import NapFlip
from ..model import Scene, known_turning_points
from ..supports import AbstractSupport
from ..tables import load_table
from .critical_forces import FlippingRod, flipping_rod
from .polynomials import turning_force
from .settings import SETTINGS
from .way_over import WayOver


class HybridPlay(NamedTuple):
    """At times, (n,): `z` and the `root` u in m, `mode`, and the `dissipation` in J."""

    z: np.ndarray
    root: np.ndarray
    mode: np.ndarray
    dissipation: np.ndarray


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
def _loads(load: Any, times: jax.Array) -> jax.Array:
    return jax.vmap(load)(times)


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

    def after(self, state: _State, load: float) -> _State:
        """The state once the load has gone to `load`, one way."""
        while True:
            before, state = state, self._on(state, load)
            if state.load == load and state.mode == before.mode:
                return state

    def _on(self, state: _State, load: float) -> _State:
        """As far as it goes in one mode."""
        if state.mode == 0:
            return self._over(state, load)
        standing = state.mode == 1
        lowest, highest = self.rod.standing_rest if standing else self.rod.turned_rest
        pull, _ = self._at(state.z)
        slides, turns = (highest, lowest) if standing else (lowest, highest)
        way = state.mode
        if way * (state.load - pull - slides) > 0:  # it has just come round, and is late
            state = self._slid(state, state.load, slides, late=True)
            pull, _ = self._at(state.z)
        if way * (load - pull - slides) > 0:
            return self._slid(state, load, slides)
        if way * (load - pull - turns) <= 0 and way * (load - state.load) < 0:
            return self._begun(state, pull + turns, -way)
        return state._replace(load=load)

    def _at(self, z: float) -> tuple[float, float]:
        force, energy = _support_at(self.support, np.asarray(z))
        return float(force), float(energy)

    def held(self, force: float) -> float:
        """Where in m the support takes up a force in N."""
        return float(_state_of(self.support, np.asarray(force)))

    def _slid(
        self, state: _State, load: float, friction: float, late: bool = False
    ) -> _State:
        """With the tip where friction holds it; `late`: it gets there in a jump."""
        z = self.held(load - friction)
        lost = friction * (z - state.z)
        if late:
            lost = load * (z - state.z) - (self._at(z)[1] - self._at(state.z)[1])
        return state._replace(z=z, load=load, lost=state.lost + lost)

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

    def _over(self, state: _State, load: float) -> _State:
        assert state.path is not None
        way = (1 if load > state.load else -1) if load != state.load else state.way
        found = state.path.follow(state.ahead, state.load, load, way)
        z = state.z + found.ahead - state.ahead
        return state._replace(
            mode=found.out,
            z=z,
            load=found.load,
            lost=state.lost + found.lost,
            ahead=found.ahead,
            way=way,
            path=None if found.out else state.path,
        )


def hybrid_play(scene: Scene, effect: NapFlip, ts: np.ndarray) -> HybridPlay:
    """Of a scene with known numbers, at sorted times in s.

    The load is followed from turning point to turning point; between them it rises or
    falls, and what happens is in closed form but for roots. `z = u + c` in every mode.

    Raises `ValueError` as `flipping_rod` does, and for z0 outside of what the rod as it
    stands at first withstands at t = 0.
    """
    rod = flipping_rod(scene, effect)
    system = _System(scene.support, rod, turning_force(rod.bent))
    turns = known_turning_points(scene.load, scene.duration, scene.turns)
    grid, back = np.unique(np.concatenate([[0.0], ts, turns]), return_inverse=True)
    room = np.full(padded_size(grid.size, SETTINGS.times, 2), grid[-1])
    room[: grid.size] = grid
    loads = np.asarray(_loads(load_table(scene.load), room))[: grid.size]
    state = _State(1, float(scene.z0), float(loads[0]), 0.0)
    _require_start(system, state)
    rows = []
    for load in loads:
        state = system.after(state, float(load))
        rows.append((state.z, state.mode, state.lost))
    z, mode, lost = (
        np.array(column)[back[1 : 1 + ts.size]] for column in zip(*rows, strict=True)
    )
    return HybridPlay(z, z + rod.reach, mode, lost)


def _require_start(system: _System, state: _State) -> None:
    least, most = system.rod.standing_rest
    ends = [system.held(state.load - force) for force in (most, least)]
    slack = 4 * float(np.finfo(float).eps) * max(map(abs, ends))
    needs = "what the rod withstands at t = 0, the interval "
    needs += f"[{no_less(ends[0], 9)}, {no_more(ends[1], 9)}]"
    inside = ends[0] - slack <= state.z <= ends[1] + slack
    require(inside, "scene.z0", state.z, needs)
