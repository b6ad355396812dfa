"""How long a tip that slides without rest takes from one well to the next.

In a fast slide the force never falls to zero, so time is a function of the tip: from
eq. 2.8, `dt/dy = eps^(gamma+1) G/(l - Phi' - V_eps')`, over exactly one period. That
integrand is smooth and hardly stiff, where `y'` as a function of time is both.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..._compile import Program, in_chunks
from ...loads import AbstractPull
from ...model import TabulatedScene
from ...supports import AbstractSupport
from .gauss import GAUSS_NODES, GAUSS_POINTS, GAUSS_WEIGHTS, PRIMITIVE, TO_LEGENDRE
from .settings import SETTINGS
from .well_pull import WellPull

# From values at Gauss nodes to integrals from the left end to each node.
_TO_NODES = np.polynomial.legendre.legval(GAUSS_NODES, PRIMITIVE).T @ TO_LEGENDRE


class SupportPull(NamedTuple):
    """Force on the flat surface near the lattice point, as Taylor series; shape (...,).

    `load`: of l in time, `support`: of Phi' in z, four derivatives each on the last axis.
    """

    load: np.ndarray
    support: np.ndarray


class Transit(NamedTuple):
    """Passages over one well: `length` in s, `kept`, and `times` at the nodes (..., M).

    `kept`: the share of a shift in time at the start that is left at the end. All NaN
    where the force vanishes on the way.
    """

    length: np.ndarray
    kept: np.ndarray
    times: np.ndarray


@jax.jit
def _passages(
    sweeps: int,
    way: Array,
    against: Array,
    weight: Array,
    sign: Array,
    load: Array,
    support: Array,
    viscosity: Array,
    times: Array,
) -> Any:
    """Newton's method for `t(y)`, linearised exactly: quadratic, and fit for stiff ends."""
    shape = (*times.shape[:-1], -1, GAUSS_POINTS)
    to_nodes, weights = jnp.asarray(_TO_NODES.T), jnp.asarray(GAUSS_WEIGHTS)

    def running(values: Array) -> tuple[Array, Array]:
        """Integrals from the start to each node, and to the end."""
        panels = values.reshape(shape)
        each = panels @ weights
        before = jnp.cumsum(each, axis=-1) - each
        found = panels @ to_nodes + before[..., None]
        return found.reshape(times.shape), jnp.sum(each, axis=-1)

    side = sign[:, None, None]
    s = [support[..., k, None] for k in range(4)]
    f = [side * load[..., k, None] for k in range(4)]
    z = way[:, None, :]
    held = side * (s[0] + z * (s[1] + z * (s[2] / 2 + z * s[3] / 6))) + against[:, None, :]
    pace = viscosity[:, None, None] * weight[:, None, :]

    def slopes(t: Array) -> tuple[Array, Array, Array]:
        force = f[0] + t * (f[1] + t * (f[2] / 2 + t * f[3] / 6)) - held
        gain = f[1] + t * (f[2] + t * f[3] / 2)
        rate = pace / force
        return force, rate, -rate * gain / force

    def sweep(_: Any, t: Array) -> Array:
        _, rate, bend = slopes(t)
        grown, _ = running(bend)
        # (t + d)' = rate + bend d; e = exp(grown) solves the homogeneous equation.
        found, _ = running((rate - bend * t) * jnp.exp(-grown))
        return found * jnp.exp(grown)

    times = jax.lax.fori_loop(0, sweeps, sweep, times)
    force, rate, bend = slopes(times)
    _, length = running(rate)
    _, grown = running(bend)
    smallest = jnp.min(jnp.where(pace > 0, force, jnp.inf), axis=-1)
    blank = jnp.where(smallest > 0, 0.0, jnp.nan)
    return length + blank, jnp.exp(grown) + blank, times


def transit_times(
    track: WellPull,
    pull: SupportPull,
    viscosity: np.ndarray,
    times=None,
    sweeps: int = SETTINGS.first_sweeps,
) -> Transit:
    """Passages of one well from n lattice points of each cell; `pull` has shape (C, n).

    `times` (C, n, M): a guess, from which one sweep is made; None where the pull stays the
    same, and it takes `sweeps`. `viscosity` (C,): eps^gamma.
    """
    if times is None:
        rate = pull.load[..., 1]  # where it is 0, nothing passes
        steady = pull.support[..., 1] / np.where(rate == 0, np.nan, rate)
        times = track.way[:, None, :] * steady[..., None]
    else:
        sweeps = SETTINGS.near_sweeps
    columns = *track, pull.load, pull.support, viscosity, times
    length, kept, times = in_chunks(_passages, SETTINGS.tracks, (sweeps,), columns)
    return Transit(length, kept, times)


def steady_transit_times(
    track: WellPull, viscosity: np.ndarray, beyond: np.ndarray
) -> np.ndarray:
    """Seconds of a passage under steady forces `beyond` (C, n) the fold's, in N."""
    gaps = track.fold[:, None] - track.against
    pace = (
        viscosity[:, None]
        * track.weight
        * np.tile(GAUSS_WEIGHTS, track.way.shape[1] // GAUSS_POINTS)
    )
    return np.einsum("cm,cnm->cn", pace, 1 / (beyond[..., None] + gaps[:, None]))


def one_transit_time(
    track: WellPull, pull: SupportPull, viscosity: np.ndarray
) -> np.ndarray:
    """Seconds of one passage of each track, shape (C,); `pull` has that shape too."""
    # As many as `transit_times` is asked for elsewhere: no further program is compiled.
    many = SupportPull(
        load=np.repeat(pull.load[:, None], SETTINGS.degree, axis=1),
        support=np.repeat(pull.support[:, None], SETTINGS.degree, axis=1),
    )
    return transit_times(track, many, viscosity, sweeps=SETTINGS.lone_sweeps).length[:, 0]


@Program
def _series(
    load: AbstractPull,
    support: AbstractSupport,
    times: Float[Array, " n"],
    states: Float[Array, " n"],
):
    def derivatives(fn: Callable) -> Callable:
        first = jax.grad(fn)
        second = jax.grad(first)
        third = jax.grad(second)
        return lambda x: jnp.stack([fn(x), first(x), second(x), third(x)])

    of_load = jax.vmap(derivatives(load))(times)
    return of_load, jax.vmap(derivatives(support.force))(states)


def pull_at(scene: TabulatedScene, times: np.ndarray, states: np.ndarray) -> SupportPull:
    """Taylor series of l and Phi' at times in s and states in m of one shape."""
    columns = times.ravel(), states.ravel()
    parts = scene.load, scene.support
    load, support = in_chunks(_series, SETTINGS.near, parts, columns)
    shape = (*times.shape, 4)
    return SupportPull(load.reshape(shape), support.reshape(shape))
