"""How often a diffrax solver evaluates the field and its Jacobian: a run that counts.

Diffrax tells steps only. How often a root finder iterates is known inside of it alone, and
what a solver carries is lost where a step is rejected. So the root finder gets a second
unknown, which counts its iterations and which diffrax hands out with the stages; the step
size controller, which hears of every attempt, adds them up. (A callback in the field: 30
us an evaluation, ten times what a step takes.)
"""

from typing import Any, NamedTuple

import diffrax
import equinox as eqx
import jax
import jax.numpy as jnp
import optimistix as optx
from diffrax import CalculateJacobian
from jaxtyping import Array, Float

from .._checks import Real
from ..model import Scene
from ..wiggly import (
    AbstractWrappedController,
    AbstractWrappedSolver,
    TipField,
    checkpoint_at_start,
    checkpoints_at,
    controller_of,
    field_of,
    plan_steps,
    times_of_stops,
    with_tolerance,
)


class Work(NamedTuple):
    """Evaluations of the field and of its Jacobian, the latter with one more of the field
    each, which is not among the former.
    """

    evaluations: Real
    jacobians: Real


def _nothing() -> Work:
    return Work(jnp.zeros(()), jnp.zeros(()))


class Counts(NamedTuple):
    """Of a whole run."""

    steps: Any
    rejected: Any
    work: Work


class _CountingFinder(optx.AbstractRootFinder):
    """Finds the first of two unknowns as the finder inside does; the second one counts."""

    rtol: Any
    atol: Any
    norm: Any
    finder: Any

    def __init__(self, finder: Any):
        self.rtol, self.atol, self.norm = finder.rtol, finder.atol, finder.norm
        self.finder = finder

    def init(self, fn, y, args, options, f_struct, aux_struct, tags):
        fn, y = _first_of_two(fn, y)
        return self.finder.init(fn, y, args, options, f_struct[0], aux_struct, tags)

    def step(self, fn, y, args, options, state, tags):
        count = y[1]
        fn, y = _first_of_two(fn, y)
        y, state, aux = self.finder.step(fn, y, args, options, state, tags)
        return (y, jnp.asarray(state.step, dtype=count.dtype)), state, aux

    def terminate(self, fn, y, args, options, state, tags):
        fn, y = _first_of_two(fn, y)
        return self.finder.terminate(fn, y, args, options, state, tags)

    def postprocess(self, fn, y, aux, args, options, state, tags, result):
        return y, aux, {}


def _first_of_two(fn, y):
    """The function of the first unknown alone, and that unknown."""

    def first(one, args):
        (out, _), aux = fn((one, y[1]), args)
        return out, aux

    return first, y[0]


class _Counted(AbstractWrappedSolver):
    """Wraps a solver of y' to one of (y, work of the attempt, step), as `Observed` does."""

    solver: Any
    field: TipField

    def init(self, terms, t0, t1, y0, args):
        return self.solver.init(self._terms(), t0, t1, _pair(y0[0]), args)

    def step(self, terms, t0, t1, y0, args, solver_state, made_jump):
        tip, _, step = y0
        (tip1, count), (error, _), info, after, result = self.solver.step(
            self._terms(), t0, t1, _pair(tip), args, solver_state, made_jump
        )
        work = _work_of(self.solver, t1 - t0, count, info, solver_state)
        y1 = (tip1, work, jnp.maximum(t1 - t0, 0.5 * step))
        still = (error, _nothing(), jnp.zeros(()))
        return y1, still, {"y0": y0, "y1": y1}, after, result

    def _terms(self) -> diffrax.ODETerm:
        def velocity(t, pair, args):
            return _pair(self.field.velocity(t, pair[0]))

        return diffrax.ODETerm(velocity)


def _pair(value: Real) -> tuple[Real, Real]:
    return value, jnp.zeros_like(value)


def _work_of(solver, length: Real, count: Real, info: dict, state: Any) -> Work:
    """What an attempt took. `count`: where the second unknown has gone."""
    if isinstance(solver, diffrax.ImplicitEuler):
        return Work(1 + count, jnp.ones(()))  # and one evaluation for the estimate
    tableau = solver.tableau
    first = state[0] if tableau.fsal else True
    stages = tableau.num_stages - jnp.where(first, 0, 1)
    how = solver.calculate_jacobian
    if how == CalculateJacobian.never:
        return Work(1.0 * stages, jnp.zeros(()))
    # Rates are stored where the last stage is the next step's first, else increments; the
    # first of them is then the last step's. Rounded: a length of 1e-20 is divided out.
    found = jnp.round(info["k"][1] / (length if tableau.fsal else 1.0))
    iterations = jnp.sum(found) - jnp.where(first, 0.0, found[0])
    # One Jacobian of an explicit stage in any case; the loop over stages starts with it.
    jacobians = 1.0 + (stages if how == CalculateJacobian.every_stage else 1.0)
    guess = 0.0 if tableau.fsal else 1.0
    return Work(iterations + guess, jnp.asarray(jacobians))


class _Tally(AbstractWrappedController):
    """Adds up the work of all attempts, the rejected ones too."""

    controller: Any

    def __init__(self, controller: Any):
        self.controller = controller

    def wrap(self, direction):
        return _Tally(self.controller.wrap(direction))

    def init(self, terms, t0, t1, y0, dt0, args, func, error_order):
        parts = terms, t0, t1, y0, dt0, args, func, error_order
        first, state = self.controller.init(*parts)
        return first, (state, _nothing())

    def adapt_step_size(self, t0, t1, y0, y1_candidate, args, y_error, error_order, state):
        inside, spent = state
        parts = t0, t1, y0, y1_candidate, args, y_error, error_order
        *found, inside, result = self.controller.adapt_step_size(*parts, inside)
        spent = jax.tree_util.tree_map(jnp.add, spent, y1_candidate[1])
        return *found, (inside, spent), result


def can_count(solver: diffrax.AbstractSolver) -> bool:
    """Whether the work of a solver can be counted: Runge-Kutta methods, implicit Euler."""
    kinds = diffrax.AbstractRungeKutta, diffrax.ImplicitEuler
    return isinstance(solver, kinds)


@eqx.filter_jit
def count_work(
    scene: Scene,
    eps: Real,
    gamma: Real,
    ts: Float[Array, " n"],
    accuracy: Real,
    solver: diffrax.AbstractSolver,
    max_steps: int,
) -> Counts:
    """Steps, evaluations and Jacobians of `solve` with a diffrax solver `can_count` names.

    The same steps once more, about as long as without counting: not to be timed.
    """
    plan = plan_steps(scene, eps, gamma, accuracy)
    field = field_of(scene, eps, gamma)
    finding = with_tolerance(solver, plan.tolerance)
    if hasattr(finding, "root_finder"):
        counting = _CountingFinder(finding.root_finder)
        finding = eqx.tree_at(lambda s: s.root_finder, finding, counting)
    stops, _ = times_of_stops(ts, scene.turning_points(), ts[-1], plan.shortest_step)
    tally = _Tally(controller_of(plan))
    start = checkpoint_at_start((field.start(scene.z0), _nothing()), plan, _nothing())
    parts = stops, start, field, plan, _Counted(finding, field), tally
    fronts = checkpoints_at(*parts, max_steps, tally=lambda state: state[1])
    last = jax.tree_util.tree_map(lambda leaf: leaf[-1], fronts)
    return Counts(last.steps, last.rejected, last.tally)
