"""Times that tell what an effect changes: about turns of the load, and some wells a slide.

Time is counted in wells here: by how far the load would move the support alone, in eps.
"""

from collections.abc import Iterator
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from ..called_for import AWAY, Setting
from ..model import Scene, known_turning_points

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
_HALVINGS = 52


class TellingTimes(NamedTuple):
    """`at` in s; `away` in s: half a percent of what a well takes there."""

    at: Float[np.ndarray, " n"]
    away: Float[np.ndarray, " n"]


class _Stretch(NamedTuple):
    """From one turn of the load to the next: times in s, and wells.

    `resting`: wells until the limit slides; `lag`: by which drag holds tips up then.
    """

    began: float
    ended: float
    wells: float
    resting: float
    lag: float
    direction: float


def telling_times(at: Setting, turns: Float[np.ndarray, " turns"]) -> TellingTimes:
    """Of a scene whose effects are worked in, at one eps.

    Of stretches between turns of the load all that begin or end at one of `turns` (s), and
    of the others no more than a few.
    """
    stretches = list(_stretches(at))
    beside = [np.any((turns == s.began) | (turns == s.ended)) for s in stretches]
    others = thinned(np.flatnonzero(~np.array(beside)), _OTHERS)
    kept = np.union1d(np.flatnonzero(beside), others)
    parts = [_times_of(at, stretches[i]) for i in kept]
    return TellingTimes(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def thinned(values: np.ndarray, most: int) -> np.ndarray:
    """No more than `most` of them, evenly chosen."""
    return values[:: max(1, -(-values.size // most))]


def _stretches(at: Setting) -> Iterator[_Stretch]:
    scene, duration = at.scene, float(at.scene.duration)
    turns = known_turning_points(scene.load, duration, scene.turns)
    edges = np.concatenate([[0.0], turns[turns > 0], [duration]])
    pulled = _pulled(scene, edges)
    z = float(scene.z0)
    lag = at.eps ** (at.gamma - 1) * at.speed / at.softest
    for i in range(edges.size - 1):
        wells = (pulled[i + 1] - pulled[i]) / at.eps
        if abs(wells) < AWAY:
            yield _Stretch(edges[i], edges[i + 1], 0.0, 0.0, 0.0, 0.0)
            continue
        sign = float(np.sign(wells))
        rho = float(at.law.rho_plus if sign > 0 else at.law.rho_minus)
        force = float(scene.support.force(jnp.asarray(z))) + rho
        onset = float(scene.support.state_of(jnp.asarray(force)))
        resting = np.clip(sign * (onset - pulled[i]) / at.eps, 0.0, abs(wells))
        if resting < abs(wells):
            ahead = float(scene.support.force(jnp.asarray(pulled[i + 1]))) - rho
            z = float(scene.support.state_of(jnp.asarray(ahead)))
        yield _Stretch(edges[i], edges[i + 1], abs(wells), float(resting), lag, sign)


def _times_of(at: Setting, stretch: _Stretch) -> TellingTimes:
    length = stretch.ended - stretch.began
    if stretch.wells == 0.0:  # the load stands still
        times = np.linspace(stretch.began, stretch.ended, _STILL)
        return TellingTimes(times, np.full(_STILL, AWAY * length))
    places = _places(stretch)
    low = np.maximum(places - 0.5, 0.0)
    high = np.minimum(places + 0.5, stretch.wells)
    times, before, after = _when(at, stretch, np.stack([places, low, high]))
    a_well = np.minimum((after - before) / (high - low), length)
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


def _when(
    at: Setting, stretch: _Stretch, places: Float[np.ndarray, "3 n"]
) -> Float[np.ndarray, "3 n"]:
    """Times in s at which the load has gone so many wells from the start of a stretch."""
    start = _pulled(at.scene, np.array([stretch.began]))[0]
    wanted = stretch.direction * start + at.eps * places
    low = np.full(places.shape, stretch.began)
    high = np.full(places.shape, stretch.ended)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        short = stretch.direction * _pulled(at.scene, middle) < wanted
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    return 0.5 * (low + high)


def _pulled(scene: Scene, times: np.ndarray) -> np.ndarray:
    """Where the support alone would be, in m."""
    loads = jax.vmap(scene.load)(jnp.asarray(times.ravel()))
    states = jax.vmap(scene.support.state_of)(loads)
    return np.asarray(states).reshape(times.shape)
