"""All starts of a fit as one compiled program."""

from functools import partial
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array

from .bending import free_energy
from .constraints import Layout
from .energy_bound import energy_bound
from .interior import Path, Task, barrier_of, descend, residuals
from .least_bent import has_closed_form, least_bent, path_to
from .settling import Settled, rooms, settle
from .starts import start


class Runs(NamedTuple):
    """What the program returns, a row for each start.

    `room`: of each bound, in shares of itself; `bound`: of the energy; `misfit`: squared
    residuals (scaled, starts by steps); the rest as named there.
    """

    settled: Settled
    path: Path
    room: dict[str, Array]
    bound: Array
    misfit: Array


@eqx.filter_jit
def run(
    layout: Layout,
    kept: int,
    most: Any,
    task: Task,
    places: Array,
    keys: Array,
    shares: Array,
) -> Runs:
    """The optimum from every start; `shares[0]` are the bristles' own free parameters.

    At most `most` steps, of which there is room for `kept`. Where the optimum has a closed
    form it is every start's.
    """
    one = partial(_one, layout, kept, most, task, shares[0])

    def descended(*lanes) -> Runs:
        return jax.vmap(one)(*lanes)

    if not has_closed_form(layout):
        return descended(places, keys, shares)
    x, known = least_bent(layout, task)

    def direct(*lanes) -> Runs:
        found = _direct(layout, kept, task, x)
        return jax.tree_util.tree_map(
            lambda v: jnp.broadcast_to(v, (places.shape[0], *v.shape)), found
        )

    return jax.lax.cond(known, direct, descended, places, keys, shares)


def _direct(layout: Layout, kept: int, task: Task, x: Array) -> Runs:
    settled = settle(layout, task, x)
    bound = free_energy(settled.reach.plus, settled.reach.minus, layout.harmonics)
    path = path_to(layout, task, x, kept)
    return _runs(layout, task, settled, path, bound)


def _one(layout, kept, most, task, own, place, key, share) -> Runs:
    first = start(layout, task, key, share, own)
    last = barrier_of(layout, task, place, first)
    final, path = descend(last, first, kept, most)
    settled = settle(layout, task, final)
    bound = energy_bound(last, final, settled.reach)
    return _runs(layout, task, settled, path, bound)


def _runs(layout, task, settled: Settled, path: Path, bound: Array) -> Runs:
    def misfit(x):
        point = layout.split(x)
        return jnp.sum(residuals(task, point.plus[1], point.minus[1], point.free) ** 2)

    room = rooms(layout, task, settled.reach, settled.free)
    return Runs(settled, path, room, bound, jax.vmap(misfit)(path.x))
