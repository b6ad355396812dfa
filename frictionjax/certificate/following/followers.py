"""Many solutions at once, each from its state to the end of its stretch."""

from itertools import pairwise
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from ..._checks import Real
from ..._compile import Program
from ...numerics import concatenated, cubic, rows_of
from ..forces import AbstractForce
from .radau_step import Follower, try_step
from .settings import SETTINGS


class Departures(NamedTuple):
    """Columns, (k,), in the order of time: the times in s from which and until which a
    solution is followed, and the tip at well + inside at the start, in periods."""

    start: Any
    end: Any
    well: Any
    inside: Any


class Followed(NamedTuple):
    """Solutions at times, (n,): z in m, and by how much it may be off in periods. NaN where
    no solution leads to."""

    state: Any
    doubt: Any


class _Nodes(NamedTuple):
    """Ends of steps, (m,): the stretch, time in s, z in m, z' in m/s, and the doubt."""

    row: Any
    time: Any
    state: Any
    speed: Any
    doubt: Any


def followed_at(
    ts: Float[np.ndarray, " n"],
    force: AbstractForce,
    viscosity: float,
    departures: list[Departures],
    stops: Float[np.ndarray, " s"],
) -> list[Followed]:
    """For each of several sets at the times `ts` in s; at the end of a stretch, and not at
    the start of the next, where both meet.

    `viscosity` is `eps^gamma` in N s/m; `stops`: times at which the load turns, in s, the
    last of them not before the last end.
    """
    nodes = _nodes(force, viscosity, concatenated(departures), stops)
    edges = np.cumsum([0, *(some.start.size for some in departures)])
    parts = np.searchsorted(nodes.row, edges).tolist()
    return [_at(ts, rows_of(nodes, slice(*part))) for part in pairwise(parts)]


def _at(ts: Float[np.ndarray, " n"], nodes: _Nodes) -> Followed:
    """Cubics between the nodes of one set, in the order of time."""
    right = np.minimum(np.searchsorted(nodes.time, ts), nodes.time.size - 1)
    first, last = rows_of(nodes, np.maximum(right - 1, 0)), rows_of(nodes, right)
    known = (first.row == last.row) & (ts >= first.time) & (ts <= last.time)
    step = np.where(known & (right > 0), last.time - first.time, 1.0)
    share = (ts - first.time) / step
    rise = last.state - first.state
    state = first.state + cubic(share, rise, step * first.speed, step * last.speed)
    doubt = np.maximum(first.doubt, last.doubt)
    return Followed(np.where(known, state, np.nan), np.where(known, doubt, np.nan))


def _nodes(
    force: AbstractForce, viscosity: float, departures: Departures, stops: np.ndarray
) -> _Nodes:
    """Of all stretches, in the order of time; who has come to its end leaves its seat."""
    start, end = departures.start, departures.end
    rows, tried = np.arange(start.size), np.zeros(start.size, int)
    none: Any = np.zeros(start.size)
    at = Follower(
        time=start.copy(),
        tip=departures.inside.copy(),
        doubt=none,
        step=(end - start) * SETTINGS.first,
        well=departures.well,
        end=end,
    )
    parts, traced = [], jnp.asarray(viscosity)
    while rows.size:
        seated = rows[: SETTINGS.lanes]
        count = seated.size
        # Seats that nobody takes repeat the last one.
        seats = np.append(seated, np.full(SETTINGS.lanes - count, seated[-1]))
        new, seen = _tries(force, traced, stops, rows_of(at, seats))
        for column, values in zip(at, new, strict=True):
            column[seated] = np.asarray(values)[:count]
        seen = rows_of(seen, (slice(None), slice(count)))
        row = np.broadcast_to(seated[:, None], seen[0].shape)
        parts.append(jax.tree.map(np.ravel, _Nodes(row, *seen)))
        tried[seated] += SETTINGS.tries
        rows = rows[(at.time[rows] < end[rows]) & (tried[rows] < SETTINGS.most)]
    nodes = concatenated(parts)
    return rows_of(nodes, np.lexsort((nodes.time, nodes.row)))


@Program
def _tries(force: AbstractForce, viscosity: Real, stops: Any, some: Follower) -> tuple:
    """Followers after some tries each; and all places of each try."""

    def seen(at: Follower) -> tuple:
        speed = force.driven(at.time, at.well, at.tip).force / viscosity
        return at.time, force.state(at.well, at.tip), speed, at.doubt

    def one(at: Follower) -> tuple:
        places = try_step(force, viscosity, stops, at)
        return places[-1], jax.tree.map(lambda *of: jnp.stack(of), *map(seen, places))

    def all_of(some: Follower, _: None) -> tuple:
        return jax.vmap(one)(some)

    return jax.lax.scan(all_of, some, None, length=SETTINGS.tries)
