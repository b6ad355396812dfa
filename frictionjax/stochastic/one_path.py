"""One path of the wiggly system with noise, in tiles side by side.

A path alone would leave all lanes of the loop but one idle. So [0, T] is cut into tiles,
all of which set off at once from guesses. Where a tile begins with what the one before
ended with, to the last bit, it is the path from there on: the same steps with the same
noise. The others set off again, from the ends that are there now. Every round adds one tile
at least, so that there are never more steps after each other than of the path at once; as
tips forget where they came from, two or three rounds are the rule (`README.md` of
`effects`). Guesses decide nothing but how many.
"""

from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float, Int, UInt32

from .._compile import padded_size
from ..effects import Noise
from ..model import Scene, coefficients_jit, strips_at
from ..tables import load_table
from .paths import NoisyCell, cell_loop, checked_cell
from .settings import SETTINGS
from .tile_loop import run_tiles


class OnePath(NamedTuple):
    """`z` in m at sorted times; `ok`: all finite. `steps` in all of `step` s, taken in
    `rounds`, of an even share each."""

    z: Float[np.ndarray, " times"]
    ok: bool
    step: float
    steps: int
    rounds: int


class _Tiles(NamedTuple):
    """Each of `blocks` blocks of steps, from the block `begin` on: (tiles,).

    `wanted` (rooms, tiles): steps that are told of each; `place`: of every time its room
    and its tile in that.
    """

    blocks: int
    begin: Int[np.ndarray, " tiles"]
    wanted: Int[np.ndarray, "rooms tiles"]
    place: tuple[Int[np.ndarray, " times"], Int[np.ndarray, " times"]]


def noisy_path(
    scene: Scene,
    noise: Noise,
    *,
    eps: float,
    gamma: float,
    key: UInt32[np.ndarray, " words"],
    ts: Any = None,
) -> OnePath:
    """The path of a key: that of `noisy_paths`, to the last bit, without its work.

    Raises `ValueError` as that does.
    """
    scene, cell, times = checked_cell(scene, noise, eps, gamma, ts)
    force, plan, bath = cell_loop(cell)
    tiles = _laid_out(plan.nearest(np.asarray(times)))
    starts = tiles.begin * SETTINGS.block * plan.step
    z0 = _guesses(scene, cell, starts)
    load, rounds, known = load_table(cell.load), 0, False
    while not known:
        found = run_tiles(
            force.table,
            cell.support,
            load,
            bath,
            key,
            jnp.asarray(tiles.blocks),
            tiles.begin,
            tiles.wanted,
            z0,
        )
        ends = np.append(z0[:1], np.asarray(found.end)[:-1])
        rounds += 1
        known = rounds == z0.size or np.array_equal(ends, z0, equal_nan=True)
        z0 = ends
    z = np.asarray(found.z)[tiles.place]
    return OnePath(z, bool(np.all(np.isfinite(z))), plan.step, plan.total, rounds)


def _laid_out(steps: Int[np.ndarray, " times"]) -> _Tiles:
    """As long as each other; the last wanted step is in the last, or in one before."""
    size, count = SETTINGS.block, SETTINGS.lanes
    blocks = max(1, -(-int(steps[-1]) // (size * count)))
    begin = blocks * np.arange(count)
    tile = np.maximum(steps - 1, 0) // (size * blocks)
    room = np.arange(steps.size) - np.searchsorted(tile, tile)
    rooms = padded_size(int(room.max()) + 1, SETTINGS.times)
    # What is not wanted is after the end of the tile, where nothing is told.
    wanted = np.tile((begin + blocks) * size + 1, (rooms, 1))
    wanted[room, tile] = steps
    return _Tiles(blocks, begin, wanted, (room, tile))


def _guesses(
    scene: Scene, cell: NoisyCell, times: Float[np.ndarray, " tiles"]
) -> Float[np.ndarray, " tiles"]:
    """States in m: the scene's own, then those of a tip that friction holds."""
    law = coefficients_jit(scene.potential)
    grid = np.linspace(0.0, cell.duration, SETTINGS.guesses)
    _, lower, upper = strips_at(scene, float(law.rho_plus), float(law.rho_minus), grid)
    states = [float(scene.z0)]
    for low, high in zip(lower[1:].tolist(), upper[1:].tolist(), strict=True):
        states.append(min(max(states[-1], low), high))
    return np.interp(times, grid, states)
