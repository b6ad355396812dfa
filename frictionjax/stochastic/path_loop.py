"""Paths of the wiggly system with noise, side by side: the compiled loop.

`z_(n+1) = z_n + h f(t_n, z_n)/viscosity + sqrt(2 T h/viscosity) (R_n + R_(n+1))/2`, R_n
normal and independent: B. Leimkuhler and C. Matthews, Appl. Math. Res. eXpress 2013, 34.
It costs what Euler's scheme does, and its averages are of order 2 in h (order 1), exact in
a harmonic well at any step (Euler's variance: off by 1/(1 - h c/2 viscosity), c curvature).
R_0 alone has the variance 3: a path sets off from a place that is known, and half of a
normal R_0 would leave `z_n` with n - 1/2 steps of noise for n (by 17, 5 and 2% too little
after 3, 10 and 30 of free diffusion).

Noise is counted: R_n of a path depends on its key and on n alone.
"""

from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int, UInt32

from .._checks import Real
from .._compile import Program
from ..loads import AbstractPull
from ..supports import AbstractSupport
from .force_table import ForceTable
from .settings import SETTINGS

_BEFORE = 2**32 - 1  # the number of the block that holds R_0 alone


class Bath(NamedTuple):
    """`eps` in m, `viscosity` in N s/m, `temperature` in J, `step` in s."""

    eps: Real
    viscosity: Real
    temperature: Real
    step: Real


class PathValues(NamedTuple):
    """At the wanted steps: `z` in m, and the `work` done on the tip by the load until then,
    `-int l' z` in J, shapes (lanes, times)."""

    z: Float[Array, "lanes times"]
    work: Float[Array, "lanes times"]


class _State(NamedTuple):
    """Before a step: z and work of each lane, and R_n."""

    z: Float[Array, " lanes"]
    work: Float[Array, " lanes"]
    noise: Float[Array, " lanes"]


class _March(NamedTuple):
    """After some blocks: `written` wanted times are in `out` (times, 2, lanes)."""

    block: Int[Array, ""]
    state: _State
    written: Int[Array, ""]
    out: Float[Array, "times 2 lanes"]


def block_draws(
    key: UInt32[Array, " words"], block: Int[Array, ""], count: int
) -> Float[Array, " count"]:
    """The normal numbers of a block of steps."""
    path = jax.random.wrap_key_data(key, impl="threefry2x32")
    return jax.random.normal(jax.random.fold_in(path, block), (count,))


def first_draw(key: UInt32[Array, " words"]) -> Float[Array, ""]:
    """R_0 of a path."""
    return jnp.sqrt(3.0) * block_draws(key, jnp.uint32(_BEFORE), 1)[0]


def stepper(table: ForceTable, support: AbstractSupport, bath: Bath) -> Callable:
    """The step of tips at z (m) under a pull (N), `noise` the sum of R_n and the next."""
    mobility = bath.step / bath.viscosity
    spread = jnp.sqrt(0.5 * bath.temperature * mobility)

    def stepped(z: Array, pull: Array, noise: Array) -> Array:
        force = pull - jax.vmap(support.force)(z) - table.force(z, bath.eps)
        return z + mobility * force + spread * noise

    return stepped


@Program
def run_lanes(
    table: ForceTable,
    support: AbstractSupport,
    load: AbstractPull,
    bath: Bath,
    wanted: Int[Array, " times"],
    keys: UInt32[Array, "lanes words"],
    z0: Float[Array, " lanes"],
) -> PathValues:
    """Paths from `z0` (m) at the steps `wanted`, whole numbers that do not decrease."""
    stepped = stepper(table, support, bath)
    size = SETTINGS.block

    def advance(state: _State, now: tuple) -> tuple[_State, Array]:
        noise, pull, pull_after = now
        z = stepped(state.z, pull, state.noise + noise)
        work = state.work - 0.5 * (pull_after - pull) * (state.z + z)
        return _State(z, work, noise), jnp.stack([z, work])

    def march(march: _March) -> _March:
        first = march.block * size
        noise = jax.vmap(lambda key: block_draws(key, march.block, size))(keys).T
        pulls = jax.vmap(load)(bath.step * (first + jnp.arange(size + 1)))
        steps = noise, pulls[:-1], pulls[1:]
        state, values = jax.lax.scan(advance, march.state, steps)

        def here(place: tuple) -> Array:
            written, _ = place
            at = wanted[jnp.minimum(written, wanted.size - 1)]
            return (written < wanted.size) & (at <= first + size)

        def write(place: tuple) -> tuple:
            written, out = place
            row = values[wanted[written] - first - 1]
            return written + 1, out.at[written].set(row)

        written, out = jax.lax.while_loop(here, write, (march.written, march.out))
        return _March(march.block + 1, state, written, out)

    nothing = jnp.zeros_like(z0)
    before = jax.vmap(first_draw)(keys)
    out = jnp.broadcast_to(jnp.stack([z0, nothing]), (wanted.size, 2, z0.size))
    start = _March(
        jnp.zeros((), int), _State(z0, nothing, before), jnp.sum(wanted <= 0), out
    )
    end = jax.lax.while_loop(lambda m: m.written < wanted.size, march, start)
    z, work = jnp.moveaxis(end.out, 0, -1)
    return PathValues(z, work)
