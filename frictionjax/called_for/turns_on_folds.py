"""Where the load turns while a tip is on a fold: what is small decides there.

A force `gap` beyond a fold, `W' = rho - c (Y - Y*)^2/2`, lets a tip over it in
`pi sqrt(2/(c gap)) eps^(1 + gamma)` (the saddle-node's passage). A load that turns stays
within `gap` of its turn for a time of its own. Where these are alike, a tip slips late or
stays by what is small, and no estimate that is linear in that bounds its state: with `x'
= f(t) + x^2` near the fold, the solution that comes up from the well ends on the unstable
branch. Of a load `f = g - t^2` that is at g = 1, of a kink `f = g - |t|` at g = 1.0188 (the
first zero of Ai'), where the ratio of the times is 1.6 and 1.5. With much less force a tip
stays, with much more it has slipped. A load that turns nearer to a fold than what moves
the fold, or than half a percent of a well, leaves a tip where wells are flat. Where drag
is not small beside friction within the time `eps^gamma/Phi''` that a tip lags behind, it
goes over its last folds after the turn, and where the limit turns says nothing of them.
"""

from collections.abc import Iterator
from typing import NamedTuple

import jax
import numpy as np
from jaxtyping import Array, Float

from .._compile import Interpreted, values_at
from ..effects import CompliantArray
from ..loads import AbstractLoad
from ..model import Scene, known_turning_points
from ..supports import AbstractSupport
from .setting import AWAY, Setting

# Times of passage over times near a turn, between which the estimate may be exceeded: at
# 1.1, 1.0, 0.54 and 0.49 it is (`pytest -m slow tests/called_for/test_turns_on_folds.py`).
_DECIDED = 0.47, 2.5
_WELLS = 40  # that a tip may lag behind
_DRAGGED = 0.4  # of friction: drag that is not small
_MOVED = 2.0  # times a change of the force at a fold: as near to it
_MANY = 32  # bristles of an array: of more, one is on a fold wherever they are
_BESIDE = (np.linspace(0.0, 1.0, 801)[1:]) ** 2  # of the way to the next turn


# In NumPy: through JAX each kind of load compiled dozens of single steps, half a second.
@Interpreted
def _pace(load: AbstractLoad, t: Array) -> Array:
    return jax.grad(load)(t)


@Interpreted
def _held(support: AbstractSupport, states: Array) -> Array:
    return jax.vmap(support.force)(states)


@Interpreted
def _state_of(support: AbstractSupport, force: Array) -> Array:
    return support.state_of(force)


class _Turn(NamedTuple):
    """A turn that the limit slides up to: s, its state there, where the load goes to.

    `drag`: viscous force in N as long before it as a tip lags behind. `beside`: times in s
    from the turn, before and after it, and `falls`, by how much the load is less there.
    """

    time: float
    edge: float
    sign: float
    drag: float
    beside: Float[np.ndarray, "2 times"]
    falls: Float[np.ndarray, "2 times"]


def turns_on_folds(at: Setting, change: float = 0.0) -> Float[np.ndarray, " turns"]:
    """Times in s at which the load turns while a tip may be on a fold.

    Any tip of a `CompliantArray`: folds of each are elsewhere. `change` in N: what the
    force at which a tip goes over a fold changes by.
    """
    phases = bristle_places(at.scene)
    everywhere = phases.size > _MANY
    found = [
        turn.time
        for turn in _slid_up_to(at)
        if everywhere or any(_on_fold(at, turn, change, phase) for phase in phases)
    ]
    return np.array(found)


def bristle_places(scene: Scene) -> Float[np.ndarray, " bristles"]:
    """Where bristles stand, each once, in [0, 1) periods; of one alone 0."""
    arrays = [e for e in scene.effects if isinstance(e, CompliantArray)]
    return np.unique(np.asarray(arrays[0].offsets) % 1.0) if arrays else np.zeros(1)


def _slid_up_to(at: Setting) -> Iterator[_Turn]:
    scene, duration = at.scene, float(at.scene.duration)
    turns = known_turning_points(scene.load, duration, scene.turns)
    turns = turns[turns > 0]
    edges = np.concatenate([[0.0], turns, [duration]])
    loads = values_at(scene.load, edges)
    z = float(scene.z0)
    for i in range(1, turns.size + 1):
        sign = 1.0 if loads[i] > loads[i - 1] else -1.0
        edge = float(_state_of(scene.support, loads[i] - sign * _rho(at, sign)))
        if sign * (edge - z) <= 0:  # the tip does not slide up to this turn
            continue
        z = edge
        ways = np.array([edges[i] - edges[i - 1], edges[i + 1] - edges[i]])
        beside = ways[:, None] * _BESIDE
        away = edges[i] + np.array([[-1.0], [1.0]]) * beside
        falls = sign * (loads[i] - values_at(scene.load, away.ravel()).reshape(away.shape))
        drag = _dragged(at, edges[i], ways[0])
        yield _Turn(float(edges[i]), edge, sign, drag, beside, falls)


def _on_fold(at: Setting, turn: _Turn, change: float, phase: float) -> bool:
    last, following = _gaps(at, turn, phase)
    well = last + following
    near = max(AWAY * well, _MOVED * change)
    behind = last + well * np.arange(_WELLS)
    return bool(
        min(last, following) < near
        or turn.drag > _DRAGGED * _rho(at, turn.sign)
        or any(_undecided(at, gap, turn) for gap in behind)
    )


def _rho(at: Setting, sign: float) -> float:
    return float(at.law.rho_plus if sign > 0 else -at.law.rho_minus)


def _gaps(at: Setting, turn: _Turn, phase: float) -> tuple[float, float]:
    """Force in N beyond the last fold, and short of the next one, with the limit there."""
    sign, edge = turn.sign, turn.edge
    top = float(at.data.phase[np.argmax(sign * at.data.force)]) - phase
    passed = np.floor(sign * (edge / at.eps - top))
    folds = at.eps * (top + sign * np.array([passed, passed + 1]))
    here, last, following = _held(at.scene.support, np.append(edge, folds)).tolist()
    return sign * (here - last), sign * (following - here)


def _dragged(at: Setting, turn: float, way: float) -> float:
    """Viscous force in N on a slide, as long before a turn as a tip lags behind."""
    viscosity = at.eps**at.gamma
    lag = min(viscosity / at.softest, way)
    pull = float(_pace(at.scene.load, turn - lag))
    return viscosity * abs(pull) / at.softest


def _undecided(at: Setting, gap: float, turn: _Turn) -> bool:
    """Whether passing a fold with this much force (N) takes about as long as the load is so
    near to its turn."""
    # Beyond the fold no force is less than the gap, however flat it is.
    curved = np.pi * np.sqrt(2 / (at.bend * gap)) if at.bend > 0 else np.inf
    passing = min(curved, 1 / gap) * at.eps ** (1 + at.gamma)
    held = 0.0
    for beside, fall in zip(turn.beside, turn.falls, strict=True):
        off = np.flatnonzero(fall > gap)
        held += float(beside[off[0] if off.size else -1])
    low, high = _DECIDED
    return bool(low * held < passing < high * held)
