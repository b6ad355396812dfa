"""About when a slide passes its wells: the slow equation, averaged over a well.

`dT/dn = P(X)`, with X the force beyond the fold at the time T and the lattice point n, and
P the time of a passage under that force. It says how a slide is cut into panels, and is a
guess for the recursion that is solved on them.
"""

from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from ..._compile import Program, in_chunks
from ...loads import AbstractPull
from ...model import TabulatedScene
from ...supports import AbstractSupport
from .settings import SETTINGS
from .transit import steady_transit_times
from .well_pull import WellPull

_RANGE = np.log(SETTINGS.table_forces)


class Lags(NamedTuple):
    """A slide on a grid of numbers of wells since its start, shape (steps + 1,).

    `force`: N beyond the fold, NaN from where slides end. `time`: s. `kept`: share of a
    shift that a well leaves.
    """

    number: np.ndarray
    force: np.ndarray
    time: np.ndarray
    kept: np.ndarray


def _grid(wells: np.ndarray) -> np.ndarray:
    """Numbers from 0 to `wells`, graded towards both ends; (C, steps + 1)."""
    many = np.log(np.maximum(wells / (2 * SETTINGS.short), 1.1))[:, None]
    half = (
        0.5 * np.expm1(many * np.linspace(0, 1, SETTINGS.steps // 2 + 1)) / np.expm1(many)
    )
    return wells[:, None] * np.concatenate([half, 1 - half[:, -2::-1]], axis=1)


@Program
def _march(load: AbstractPull, support: AbstractSupport, *columns: Array) -> Any:
    return jax.vmap(partial(_slide, load, support))(*columns)


def _slide(
    load: AbstractPull,
    support: AbstractSupport,
    table: Array,
    low: Array,
    fold: Array,
    sign: Array,
    eps: Array,
    origin: Array,
    first: Array,
    time: Array,
    number: Array,
) -> list[Array]:
    pitch = (_RANGE[1] - _RANGE[0]) / (SETTINGS.table_rows - 1)

    def law(force: Array) -> tuple[Array, Array]:
        """P in s, and its derivative."""
        place = (jnp.log(force) - low) / pitch
        row = jnp.clip(jnp.floor(place).astype(int), 0, SETTINGS.table_rows - 2)
        rise = table[row + 1] - table[row]
        length = jnp.exp(table[row] + rise * (place - row))
        return length, length * rise / (pitch * force)

    def force_at(time: Array, at: Array) -> Array:
        held = support.force(origin + sign * eps * (first + at))
        return sign * (load(time) - held) - fold

    def step(before: tuple, at: Array) -> tuple[tuple, tuple]:
        # Newton's method for log X: in T it diverged where X is 1e-7 of the load.
        time, force, last = before
        wells = at - last

        def sweep(_: Any, state: tuple[Array, Array]) -> tuple[Array, Array]:
            log, _ = state
            force = jnp.exp(log)
            length, slope = law(force)
            later = time + wells * length
            rate = sign * load.slope(later)
            left = force - force_at(later, at)
            change = left / (force * (1 - wells * slope * rate))
            return log - jnp.clip(change, -SETTINGS.farthest, SETTINGS.farthest), change

        begin = jnp.log(force), jnp.zeros_like(force)
        log, change = jax.lax.fori_loop(0, SETTINGS.step_sweeps, sweep, begin)
        here = jnp.where(jnp.abs(change) < SETTINGS.last_change, jnp.exp(log), jnp.nan)
        length, slope = law(here)
        later = time + wells * length
        kept = jnp.exp(slope * sign * load.slope(later))
        return (later, here, at), (here, later, kept)

    begin = force_at(time, number[0])
    gain = law(begin)[1] * sign * load.slope(time)
    _, rows = jax.lax.scan(step, (time, begin, number[0]), number[1:])
    start = begin, time, jnp.exp(gain)
    return [jnp.concatenate([a[None], b]) for a, b in zip(start, rows, strict=True)]


def lags_of(
    scene: TabulatedScene,
    track: WellPull,
    eps,
    viscosity,
    origin,
    first,
    time,
    force,
    wells,
) -> Lags:
    """Slides of `wells` from the lattice points `first`, passed at `time` (s); all (C,).

    `force`: beyond the fold there.
    """
    low = np.log(force) + _RANGE[0]
    logs = low[:, None] + np.linspace(0.0, _RANGE[1] - _RANGE[0], SETTINGS.table_rows)
    table = np.log(steady_transit_times(track, viscosity, np.exp(logs)))
    number = _grid(wells)
    columns = table, low, track.fold, track.sign, eps, origin, first, time, number
    parts = scene.load, scene.support
    force, time, kept = in_chunks(_march, SETTINGS.slides, parts, columns)
    return Lags(number, force, time, kept)
