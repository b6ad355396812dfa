"""All starts of a fit as one compiled program."""

from functools import partial
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from .barrier import (
    FitShape,
    FitTask,
    Iterates,
    Settled,
    barrier_of,
    coefficient_residuals,
    energy_bound,
    follow_barrier,
    rooms,
    settle,
)
from .settings import SETTINGS
from .starts import random_start


class StartRuns(NamedTuple):
    """How all starts ended, a row for each.

    `room`: of each bound, in shares of itself; `bound`: of the energy; `misfit`: squared
    residuals (scaled, starts by steps); `ran`: False where another start's optimum, which
    is proven, stands for one that was not run; the rest as named there.
    """

    settled: Settled
    path: Iterates
    room: dict[str, Array]
    bound: Array
    misfit: Array
    ran: Array


def repeated(starts: int, row: StartRuns) -> StartRuns:
    """`StartRuns` of one start, without their axis, that stands for the others too."""

    def spread(leaf: Any) -> np.ndarray:
        if np.size(leaf) < SETTINGS.small:
            return np.asarray(leaf)[None].repeat(starts, 0)
        return np.broadcast_to(leaf, (starts, *np.shape(leaf)))

    rows = jax.tree_util.tree_map(spread, row)
    return rows._replace(ran=np.arange(starts) == 0)


def descended(
    layout: FitShape,
    task: FitTask,
    places: Any,
    keys: Any,
    shares: Any,
    kept: int,
    most: int,
) -> StartRuns:
    """The optimum from every start (`multistart`); one stands for all where it is proven.

    Without free parameters and bounds on the height the problem is convex, but for targets
    that cannot be met, and each start is a call of its own: mostly the first is proven
    (0.03 s). Side by side in a program eight took 0.42 s for 0.25: small products do not
    gain, and all wait for the slowest.
    """
    lanes = places, keys, shares
    steps = np.asarray(most)
    if layout.free or layout.high:
        return jax.device_get(multistart(layout, kept, steps, task, *lanes))
    rows = []
    for index in range(places.size):
        one = (lane[index : index + 1] for lane in lanes)
        rows.append(jax.device_get(multistart(layout, kept, steps, task, *one)))
        if _proven(task, rows[-1]):
            row = jax.tree_util.tree_map(lambda value: value[0], rows[-1])
            rows[-1] = repeated(places.size - index, row)
            break
    if len(rows) == 1:
        return rows[0]
    return jax.tree_util.tree_map(lambda *some: np.concatenate(some), *rows)


def _proven(task: FitTask, found: StartRuns) -> bool:
    """The targets are met, and no other surface with these slopes is less bent."""
    ended = bool(found.path.done[0]) and bool(found.settled.met[0])
    if not (ended and targets_met(task, found.settled.residuals)[0]):
        return False
    energy = np.sum(found.settled.waves**2)
    return bool(energy <= (1 + SETTINGS.proven) * found.bound[0])


def targets_met(task: FitTask, residuals: Any) -> np.ndarray:
    """Whether scaled residuals of starts, (n, rows), are of coefficients that are met."""
    shape = len(residuals), *np.shape(task.coefficients)
    errors = np.reshape(residuals, shape) / task.factors / task.coefficients
    return np.max(np.abs(errors), axis=(1, 2)) <= SETTINGS.target_met


def best_first(
    runs: StartRuns, slope: float, scale: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Squared residuals, bending energies and the order of starts, (n,) each.

    By residuals (times `scale`), and by energy among those that tie; `slope`: of the task.
    """
    losses = np.sum(np.asarray(runs.settled.residuals) ** 2, axis=1) * scale**2
    energies = slope**2 * np.sum(np.asarray(runs.settled.waves) ** 2, axis=1)
    filled = np.where(np.isfinite(losses), losses, np.inf)
    level = np.min(filled)
    tied = filled <= level * (1 + SETTINGS.tie) + SETTINGS.target_met**2
    return losses, energies, np.lexsort((np.where(tied, energies, filled), ~tied))


@eqx.filter_jit
def multistart(
    layout: FitShape,
    kept: int,
    most: Any,
    task: FitTask,
    places: Array,
    keys: Array,
    shares: Array,
) -> StartRuns:
    """The optimum from every start; `shares[0]` are the bristles' own free parameters.

    At most `most` steps, of which there is room for `kept`.
    """
    one = partial(_one, layout, kept, most, task, shares[0])
    return jax.lax.map(lambda row: one(*row), (places, keys, shares))


def _one(layout, kept, most, task, own, place, key, share) -> StartRuns:
    first = random_start(layout, task, key, share, own)
    last = barrier_of(layout, task, place, first)
    final, path = follow_barrier(last, first, kept, most)
    settled = settle(layout, task, final)
    bound = energy_bound(last, final, settled.waves, settled.reach)

    def misfit(x: Array) -> Array:
        point = layout.split(x)
        return jnp.sum(
            coefficient_residuals(task, point.plus[1], point.minus[1], point.free) ** 2
        )

    room = rooms(layout, task, settled.reach, settled.free)
    return StartRuns(
        settled, path, room, bound, jax.vmap(misfit)(path.x), jnp.asarray(True)
    )
