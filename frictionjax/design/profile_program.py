"""All starts of a fit as one compiled program."""

from functools import partial
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array

from .constraints import Layout
from .energy_bound import energy_bound
from .interior import Path, Task, barrier_of, descend, residuals
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

    At most `most` steps, of which there is room for `kept`.
    """
    one = partial(_one, layout, kept, most, task, shares[0])
    return jax.vmap(one)(places, keys, shares)


def _one(layout, kept, most, task, own, place, key, share) -> Runs:
    first = start(layout, task, key, share, own)
    last = barrier_of(layout, task, place, first)
    final, path = descend(last, first, kept, most)
    settled = settle(layout, task, final)
    room = rooms(layout, task, settled.reach, settled.free)
    bound = energy_bound(last, final, settled.reach)

    def misfit(x):
        point = layout.split(x)
        return jnp.sum(residuals(task, point.plus[1], point.minus[1], point.free) ** 2)

    return Runs(settled, path, room, bound, jax.vmap(misfit)(path.x))
