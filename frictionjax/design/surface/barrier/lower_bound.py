"""A proof that no surface within the bounds bends much less."""

import jax
import jax.numpy as jnp
from jaxtyping import Array

from ...._checks import Real
from .bending import free_energy
from .constraints import at, basis
from .extreme_slopes import Reach
from .iterates import Barrier
from .settings import SETTINGS


def energy_bound(barrier: Barrier, x: Array, waves: Array, found: Reach) -> Real:
    """Lower bound of `int v'^2`, in units of the task.

    Of all surfaces with the extreme slopes that were `found`, of these `waves`, whose
    lowest slope is at the barrier's place from the highest, as theirs is. Where theirs is
    not, as a flattened slope's need not be, of all surfaces with these slopes.
    """
    energy = jnp.sum(waves**2)
    of_place = _bound_at_place(barrier, x, found)
    there = -at(waves, barrier.place) >= (1 - SETTINGS.there) * found.minus
    there &= of_place <= (1 + SETTINGS.rounded) * energy
    of_all = free_energy(found.plus, found.minus, barrier.layout.harmonics)
    return jnp.where(there, jnp.minimum(of_place, energy), of_all)


def _bound_at_place(barrier: Barrier, x: Array, found: Reach) -> Real:
    """Of surfaces whose lowest slope is at the place, by weak duality.

    Within the bounds as given (without margins). Any multipliers >= 0 prove a bound; those
    of the barrier after one more Newton step, linearised, balance the energy to rounding,
    and the bound is sharp.
    """
    layout, task = barrier.layout, barrier.task
    step = jnp.linalg.solve(barrier.hessian(x), -jax.grad(barrier.value)(x))
    room, change = barrier.ends - barrier.rows @ x, barrier.rows @ step
    prices = _prices(barrier.weight, room, change)
    top, bottom = _prices(barrier.weight, *jax.jvp(barrier.reach, (x,), (-step,)))
    prices = _balanced(prices, layout.points, layout.sharp) if layout.high else prices
    slopes = jnp.asarray(basis(layout.harmonics, 1))[0]
    force = prices @ barrier.rows[:, : slopes.size] - top * slopes
    force = force + bottom * at(jnp.eye(slopes.size), barrier.place)
    count = layout.points
    value = (top - jnp.sum(prices[:count])) * found.plus
    value += (bottom - jnp.sum(prices[count : 2 * count])) * found.minus
    if layout.sharp:
        value -= task.curvature * jnp.sum(prices[2 * count : 4 * count])
    if layout.high:
        value -= task.height * prices[-1 - 2 * layout.free]
    return task.energy * (value - 0.25 * task.energy * jnp.sum(force**2))


def _prices(weight: Real, room: Array, loss: Array) -> Array:
    """Multipliers of rows that lose room with the step."""
    return jnp.maximum(weight / room * (1 + loss / room), 0.0)


def _balanced(prices: Array, count: int, sharp: bool) -> Array:
    """The price of height is paid once by the highest points, once by the lowest."""
    first = (4 if sharp else 2) * count
    ways = prices[first : first + 2 * count].reshape(2, count)
    total = prices[first + 2 * count]
    ways = ways * (total / jnp.sum(ways, axis=1, keepdims=True))
    return prices.at[first : first + 2 * count].set(ways.ravel())
