"""Least bending energy at the targets, from inside the bounds: Newton on a barrier.

With the place of the lowest slope fixed everything that bounds the surface is linear and
the energy is a square, so for given bristles the problem is convex and its barrier is
self-concordant: Newton needs 20 to 40 steps from anywhere, and no iterate leaves the
bounds. optax drives it: Newton's direction, a stop before the walls and optax's
backtracking are one `optax.chain`. What lost, in `benchmarks/design.py`: optax.lbfgs on the
same barrier and on an augmented Lagrangian.
"""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import optax
from jaxtyping import Array, Float

from ...._checks import Real
from ...common import AbstractLaw
from .constraints import FitShape, Unknowns, at, flat
from .settings import SETTINGS


class FitTask(eqx.Module):
    """Numbers of a fit, traced.

    `coefficients`: wanted, in N, shape (targets, 2); `factors`: of their residuals.
    `curvature`, `height`: the largest allowed. `slope`, `energy`: units of the unknowns.
    `firm`: price of a gap between the two bounds of an extreme slope.
    """

    law: AbstractLaw
    coefficients: Float[Array, "targets 2"]
    factors: Float[Array, "targets 2"]
    curvature: Real
    height: Real
    slope: Real
    energy: Real
    firm: Real


def coefficient_residuals(
    task: FitTask, plus: Real, minus: Real, free: Array
) -> Float[Array, " rows"]:
    """Scaled residuals of the coefficients at slopes in units of `task.slope`."""
    found = task.law.coefficients(task.slope * plus, task.slope * minus, free)
    return ((found - task.coefficients) * task.factors).ravel()


def _misfit(task: FitTask, point: Unknowns) -> Float[Array, " rows"]:
    """At both bounds of the extreme slopes: out of reach the better one would open up."""
    ends = zip(point.plus, point.minus, strict=True)
    both = [coefficient_residuals(task, plus, minus, point.free) for plus, minus in ends]
    return jnp.concatenate(both) / jnp.sqrt(2.0)


def _bristle_room(task: FitTask, start: Array, point: Unknowns) -> Float[Array, " rows"]:
    """> 0 where every bristle can follow the slopes and presses the way it did."""
    known, before = task.law.at(point.free), task.law.at(start)
    kept = (1 - SETTINGS.edge if point.free.size else 1.0) / task.slope
    upper = kept * known.upper - point.plus[1]
    lower = -kept * known.lower - point.minus[1]
    rows = jnp.concatenate([upper, lower, known.alpha / before.alpha])
    return jnp.where(jnp.isinf(rows), 1.0, rows)


class Barrier(NamedTuple):
    """The function that is minimised: `task` at one start and one weight."""

    layout: FitShape
    rows: Array
    ends: Array
    task: FitTask
    place: Real
    start: Array
    weight: Real

    def reach(self, x: Array) -> Float[Array, "2"]:
        """Room of the two rows that hold up the extreme slopes."""
        point = self.layout.split(x)
        places = jnp.stack([jnp.zeros(()), self.place])
        top, bottom = at(point.waves, places)
        return jnp.stack([top - point.plus[0], -bottom - point.minus[0]])

    def near(self, x: Array) -> tuple[Real, Real]:
        """All but misfit and linear rows, and whether x is inside."""
        point = self.layout.split(x)
        room = jnp.append(_bristle_room(self.task, self.start, point), self.reach(x))
        gaps = point.plus[1] - point.plus[0] + point.minus[1] - point.minus[0]
        energy = jnp.sum(point.waves**2) / self.task.energy
        return energy + self.task.firm * gaps - self.weight * _logs(room), jnp.all(room > 0)

    def misfit(self, x: Array) -> Real:
        """Half the squared residuals, by their weight."""
        return 0.5 * SETTINGS.firm * jnp.sum(_misfit(self.task, self.layout.split(x)) ** 2)

    def value(self, x: Array) -> Real:
        """Energy, misfit and barrier; infinite outside."""
        near, inside = self.near(x)
        room = self.ends - self.rows @ x
        total = near + self.misfit(x) - self.weight * _logs(room)
        return jnp.where(inside & jnp.all(room > 0), total, jnp.inf)

    def hessian(self, x: Array) -> Array:
        """Second derivatives.

        Rows come in pairs, a wave and its negative, so the waves' part is one product.
        """
        bend = jax.hessian(lambda x: self.near(x)[0] + self.misfit(x))(x)
        stiff = self.weight / (self.ends - self.rows @ x) ** 2
        count, waves = self.layout.points, 2 * self.layout.harmonics
        pairs = 1 + self.layout.sharp + self.layout.high
        for first in range(0, 2 * pairs * count, 2 * count):
            rows = self.rows[first : first + count, :waves]
            above, below = stiff[first : first + count], stiff[first + count :][:count]
            up, down = self.rows[first, waves:], self.rows[first + count, waves:]
            among = (rows * (above + below)[:, None]).T @ rows
            across = jnp.outer(above @ rows, up) - jnp.outer(below @ rows, down)
            rest = jnp.sum(above) * jnp.outer(up, up) + jnp.sum(below) * jnp.outer(
                down, down
            )
            bend = bend + jnp.block([[among, across], [across.T, rest]])
        last = self.rows[2 * pairs * count :]
        return bend + (last * stiff[2 * pairs * count :, None]).T @ last

    def room(self, x: Array, step: Array) -> Real:
        """The step's length in units of the way to the nearest linear wall."""
        return jnp.max((self.rows @ step) / (self.ends - self.rows @ x))


def _logs(room: Array) -> Real:
    return jnp.sum(jnp.log(jnp.where(room > 0, room, 1.0)))


def newton() -> optax.GradientTransformationExtraArgs:
    """Newton's direction, turned downhill where the Hessian is not positive.

    `update(..., barrier=...)`. Eigenvalues of the Hessian scaled to a unit diagonal.
    """

    def update(
        updates: Array, state: Any, params: Any = None, *, barrier: Barrier, **_: Any
    ) -> tuple[Array, Any]:
        hessian = barrier.hessian(params)
        scale = 1 / jnp.sqrt(jnp.abs(jnp.diag(hessian)))
        values, vectors = jnp.linalg.eigh(hessian * scale[None] * scale[:, None])
        values = jnp.maximum(jnp.abs(values), SETTINGS.flattest * values[-1])
        along = (vectors.T @ (scale * updates)) / values
        return -scale * (vectors @ along), state

    return optax.GradientTransformationExtraArgs(lambda _: optax.EmptyState(), update)


def stop_before_walls() -> optax.GradientTransformationExtraArgs:
    """Shorten steps that would reach a wall of the barrier."""

    def update(
        updates: Array, state: Any, params: Any = None, *, barrier: Barrier, **_: Any
    ) -> tuple[Array, Any]:
        way = barrier.room(params, updates) / SETTINGS.wall
        return updates / jnp.maximum(way, 1.0), state

    return optax.GradientTransformationExtraArgs(lambda _: optax.EmptyState(), update)


def optimiser() -> optax.GradientTransformationExtraArgs:
    """Damped Newton that stays inside, as an optax chain."""
    backtracking = optax.scale_by_backtracking_linesearch(
        SETTINGS.backtracks,
        decrease_factor=0.5,
        increase_factor=jnp.inf,
        max_learning_rate=1.0,
    )
    return optax.chain(newton(), stop_before_walls(), backtracking)


class Iterates(NamedTuple):
    """Iterates of one start: `x` (steps, n), and `loss`, `weight`, `decrement` (steps,).

    `steps`: how many there are; `done`: whether the last barrier was centred.
    """

    x: Array
    loss: Array
    weight: Array
    decrement: Array
    steps: Any
    done: Any


def barrier_of(layout: FitShape, task: FitTask, place: Real, start: Unknowns) -> Barrier:
    """The last barrier of a start."""
    rows, ends = jnp.asarray(layout.rows()), layout.ends(task.curvature, task.height)
    return Barrier(layout, rows, ends, task, place, start.free, jnp.asarray(SETTINGS.last))


def follow_barrier(
    last: Barrier,
    start: Unknowns,
    kept: int,
    most: Any,
    optimise: optax.GradientTransformationExtraArgs | None = None,
) -> tuple[Array, Iterates]:
    """The optimum from one start strictly inside, and the way to it.

    `most` steps, traced; there is room for `kept` of them.
    """
    first = flat(start)
    if optimise is None:
        optimise = optimiser()

    def body(state: tuple) -> tuple:
        x, memory, weight, path = state
        barrier = last._replace(weight=weight)
        loss, slope = jax.value_and_grad(barrier.value)(x)
        step, memory = optimise.update(
            slope,
            memory,
            x,
            value=loss,
            grad=slope,
            value_fn=lambda x, barrier: barrier.value(x),
            barrier=barrier,
        )
        decrement = -jnp.sum(slope * step)
        centred = decrement <= SETTINGS.centred * weight
        path = _noted(path, x + step, loss, weight, decrement)
        path = path._replace(done=centred & (weight <= SETTINGS.last))
        lower = jnp.maximum(weight * SETTINGS.shrink, SETTINGS.last)
        return x + step, memory, jnp.where(centred, lower, weight), path

    def go_on(state: tuple) -> Array:
        path = state[-1]
        return ~path.done & (path.steps < most) & jnp.all(jnp.isfinite(state[0]))

    empty = jnp.full(kept, jnp.nan)
    path = Iterates(jnp.full((kept, first.size), jnp.nan), empty, empty, empty, 0, False)
    state = (first, optimise.init(first), jnp.asarray(SETTINGS.first), path)
    final, _, _, path = jax.lax.while_loop(go_on, body, state)
    return final, path


def _noted(path: Iterates, x: Array, loss: Any, weight: Any, decrement: Any) -> Iterates:
    place = path.steps
    return Iterates(
        path.x.at[place].set(x),
        path.loss.at[place].set(loss),
        path.weight.at[place].set(weight),
        path.decrement.at[place].set(decrement),
        place + 1,
        path.done,
    )
