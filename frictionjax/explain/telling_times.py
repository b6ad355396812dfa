"""Times that tell what an effect changes: about turns of the load, and some wells a slide.

Time is counted in wells here: by how far the load would move the support alone, in eps.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from ..called_for import AWAY, Setting
from ..model import TabulatedScene, tabulated_scene
from ..wiggly import arrivals_at, state_under

_WINDOW = 3.0  # wells
_PLACES = (0.0, 0.25, 0.5, 0.75, 1.0)  # of windows, in shares of what is left of a slide
_FEW = 60.0  # wells of a slide that are all seen
# Lags of a tip that drag holds up until it slides as it goes on, and wells of them, at
# most. (Of three wells half of the change was seen: nap, eps = 0.05, gamma = 0.5.)
_LAGS, _FIRST = 2.0, 30.0
_A_WELL = 100  # times
_RESTS = 800  # times from a turn until the limit slides
_OTHERS = 6  # stretches that no turn on a fold ends
_STILL = 100  # times while the load stands still


class TellingTimes(NamedTuple):
    """`at` in s; `away` in s: half a percent of what a well takes there."""

    at: Float[np.ndarray, " n"]
    away: Float[np.ndarray, " n"]


class _Stretch(NamedTuple):
    """From one turn of the load to the next: times in s, and wells.

    `start`: where the support alone would be then, in m; `direction` of the load, 0 where
    it stands still. `resting`: wells until the limit slides; `lag`: by which drag holds
    tips up then.
    """

    began: float
    ended: float
    start: float
    direction: float
    wells: float
    resting: float
    lag: float


def telling_times(at: Setting, turns: Float[np.ndarray, " turns"]) -> TellingTimes:
    """Of a scene whose effects are worked in, at one eps.

    Of stretches between turns of the load all that begin or end at one of `turns` (s), and
    of the others no more than a few.
    """
    tables = tabulated_scene(at.scene, at.eps)
    stretches = _stretches(at, tables)
    beside = [np.any((turns == s.began) | (turns == s.ended)) for s in stretches]
    others = thinned(np.flatnonzero(~np.array(beside)), _OTHERS)
    kept = [stretches[i] for i in np.union1d(np.flatnonzero(beside), others)]
    parts = [_while_it_stands(s) for s in kept if s.direction == 0]
    moving = [s for s in kept if s.direction != 0]
    if moving:
        parts.append(_while_it_moves(at.eps, tables, moving))
    return TellingTimes(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def thinned(values: np.ndarray, most: int) -> np.ndarray:
    """No more than `most` of them, evenly chosen."""
    return values[:: max(1, -(-values.size // most))]


def _stretches(at: Setting, tables: TabulatedScene) -> list[_Stretch]:
    turns = tables.turning_points
    edges = np.concatenate([[0.0], turns[turns > 0], [tables.duration]])
    began, ended = edges[:-1], edges[1:]
    alone = state_under(tables, edges, np.zeros(edges.size))
    wells = np.diff(alone) / at.eps
    direction = np.where(np.abs(wells) < AWAY, 0.0, np.sign(wells))
    rho = np.where(direction > 0, float(at.law.rho_plus), float(at.law.rho_minus))
    ahead = state_under(tables, ended, rho)
    z = _limit_at_turns(tables.z0, direction, ahead)
    onset = arrivals_at(tables, z, rho, began, ended)
    until = np.abs(state_under(tables, onset, np.zeros(onset.size)) - alone[:-1]) / at.eps
    lag = np.full(z.size, at.eps ** (at.gamma - 1) * at.speed / at.softest)
    columns = began, ended, alone[:-1], direction, np.abs(wells), until, lag
    return [_Stretch(*row) for row in np.stack(columns, axis=1).tolist()]


def _limit_at_turns(
    z: float, direction: Float[np.ndarray, " n"], ahead: Float[np.ndarray, " n"]
) -> Float[np.ndarray, " n"]:
    """The limit's state as each stretch begins: the edge `ahead` takes it along."""
    states = []
    for sign, edge in zip(direction.tolist(), ahead.tolist(), strict=True):
        states.append(z)
        if sign:
            z = sign * max(sign * z, sign * edge)
    return np.array(states)


def _while_it_stands(stretch: _Stretch) -> TellingTimes:
    times = np.linspace(stretch.began, stretch.ended, _STILL)
    return TellingTimes(times, np.full(_STILL, AWAY * (stretch.ended - stretch.began)))


def _while_it_moves(
    eps: float, tables: TabulatedScene, stretches: list[_Stretch]
) -> TellingTimes:
    """When the support alone would be at places of its way, and half a well about them."""
    parts = [_places(stretch) for stretch in stretches]
    rows = np.repeat(np.array(stretches), [part.size for part in parts], axis=0)
    of = _Stretch(*rows.T)
    places = np.concatenate(parts)
    low, high = np.maximum(places - 0.5, 0.0), np.minimum(places + 0.5, of.wells)
    wanted = of.start + of.direction * eps * np.stack([places, low, high])
    thrice = (np.tile(column, 3) for column in (of.began, of.ended))
    found = arrivals_at(tables, wanted.ravel(), np.zeros(wanted.size), *thrice)
    times, before, after = found.reshape(3, -1)
    a_well = np.minimum((after - before) / (high - low), of.ended - of.began)
    return TellingTimes(times, AWAY * a_well)


def _places(stretch: _Stretch) -> Float[np.ndarray, " n"]:
    """In wells from the start of a stretch; about turns of a sine evenly in time."""
    resting, wells = stretch.resting, stretch.wells
    rest = resting * np.linspace(0.0, 1.0, _RESTS) ** 2
    slide = wells - resting
    if slide <= 0:
        return rest
    last = min(_WINDOW, slide)
    shares = np.linspace(0.0, 1.0, round(4 * _A_WELL * last) + 2)
    windows = [wells - last * shares**2]
    if slide <= _FEW:
        return np.concatenate([rest, *windows, _window(resting, slide)])
    first = np.clip(_LAGS * stretch.lag, _WINDOW, _FIRST)
    starts = resting + np.array(_PLACES) * (slide - _WINDOW)
    windows += [_window(start, _WINDOW) for start in starts]
    return np.concatenate([rest, *windows, _window(resting, float(first))])


def _window(start: float, wells: float) -> Float[np.ndarray, " n"]:
    """One place more than fits, so that each well is seen at places of its own."""
    return start + np.linspace(0.0, wells, round(_A_WELL * wells) + 2)
