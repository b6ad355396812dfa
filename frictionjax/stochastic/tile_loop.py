"""One path in tiles, side by side: the compiled loop.

Steps are those of `path_loop.py`, to the last bit, as noise is counted by steps from t = 0.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int, UInt32

from .._compile import Program
from ..loads import AbstractPull
from ..supports import AbstractSupport
from .force_table import ForceTable
from .path_loop import Bath, block_draws, first_draw, stepper
from .settings import SETTINGS


class TileValues(NamedTuple):
    """z in m: at the `end` of every tile, (tiles,), and at the wanted steps."""

    end: Float[Array, " tiles"]
    z: Float[Array, "times tiles"]


class _March(NamedTuple):
    """After some blocks: z, the last R of each tile, and the values `written` so far."""

    block: Int[Array, ""]
    z: Float[Array, " tiles"]
    noise: Float[Array, " tiles"]
    written: Int[Array, " tiles"]
    out: Float[Array, "times tiles"]


@Program
def run_tiles(
    table: ForceTable,
    support: AbstractSupport,
    load: AbstractPull,
    bath: Bath,
    key: UInt32[Array, " words"],
    blocks: Int[Array, ""],
    begin: Int[Array, " tiles"],
    wanted: Int[Array, "times tiles"],
    z0: Float[Array, " tiles"],
) -> TileValues:
    """Tiles of `blocks` blocks of steps from the block `begin` and `z0` (m) on.

    `wanted`: steps from t = 0, which do not decrease along a tile; none after its end is
    told.
    """
    stepped = stepper(table, support, bath)
    size, tiles = SETTINGS.block, jnp.arange(z0.size)
    rooms = wanted.shape[0]

    def advance(state: tuple, now: tuple) -> tuple[tuple, Array]:
        z, before = state
        noise, pull = now
        z = stepped(z, pull, before + noise)
        return (z, noise), z

    def march(march: _March) -> _March:
        block = begin + march.block
        first = block * size
        noise = jax.vmap(lambda one: block_draws(key, one, size))(block).T
        times = bath.step * (first[None] + jnp.arange(size)[:, None])
        pulls = jax.vmap(jax.vmap(load))(times)
        (z, last), values = jax.lax.scan(advance, (march.z, march.noise), (noise, pulls))

        def due(written: Array) -> tuple[Array, Array]:
            step = wanted[jnp.minimum(written, rooms - 1), tiles]
            return (written < rooms) & (step <= first + size), step

        def write(place: tuple) -> tuple:
            written, out = place
            now, step = due(written)
            row = values[jnp.clip(step - first - 1, 0, size - 1), tiles]
            out = out.at[jnp.where(now, written, rooms), tiles].set(row, mode="drop")
            return written + now, out

        some = (march.written, march.out)
        written, out = jax.lax.while_loop(lambda p: jnp.any(due(p[0])[0]), write, some)
        return _March(march.block + 1, z, last, written, out)

    def before(block: Array) -> Array:
        last = block_draws(key, block - 1, size)[-1]
        return jnp.where(block == 0, first_draw(key), last)

    out = jnp.broadcast_to(z0, wanted.shape)
    begun = jnp.sum(wanted <= begin[None] * size, axis=0)
    start = _March(jnp.zeros((), int), z0, jax.vmap(before)(begin), begun, out)
    end = jax.lax.while_loop(lambda m: m.block < blocks, march, start)
    return TileValues(end.z, end.out)
