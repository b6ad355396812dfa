"""A trajectory with derivatives: every slip after the other, by `diffeqsolve`."""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool

from .._compile import Program, hoisted, once_a_scene, padded_size, strong_arrays
from ..model import are_times_of, smallest_stretch
from .equation import Status, StepPlan, plan_steps
from .problem import Problem
from .reverse_mode import in_reverse_mode, without_derivatives
from .sequential import SETTINGS, Past, integrate
from .solution import Solution


class Options(NamedTuple):
    """How a trajectory is integrated; `adjoint`: of diffrax, None for that of the steps."""

    solver: Any
    balanced: bool
    max_steps: int
    adjoint: Any


class Plan(NamedTuple):
    """Of steps; `good`: whether there is such a motion at all, as known numbers have to say
    before anything runs."""

    steps: StepPlan
    good: Bool[Array, ""]


@once_a_scene
def _planned(problem: Problem) -> Plan:
    scene, eps, gamma, _, accuracy = problem
    good = (eps > 0) & (gamma > 0) & (smallest_stretch(scene.potential, eps) > 0)
    return Plan(plan_steps(scene, eps, gamma, accuracy), good)


def _plan_of(problem: Problem) -> Plan:
    """Whatever the times."""
    return _planned(problem._replace(ts=jnp.zeros(0)))


def _answered(
    problem: Problem, plans: Plan, options: Options, past: Past | None = None
) -> tuple:
    scene, eps, gamma, ts, _ = problem
    plan = plans.steps
    found = integrate(
        scene,
        eps,
        gamma,
        ts,
        plan,
        options.solver,
        until=ts[-1],
        balanced=options.balanced,
        max_steps=options.max_steps,
        adjoint=options.adjoint,
        past=past,
    )
    counts = {
        "steps": found.steps,
        "rejected": found.rejected,
        "tolerance": plan.tolerance,
        "dissipation_gap": found.dissipation_gap,
    }
    good = plans.good & are_times_of(scene, ts)
    # As a factor: derivatives are NaN too.
    valid = jnp.where(good, 1.0, jnp.nan)
    # What of a `Solution` has derivatives.
    curve = jax.tree_util.tree_map(
        lambda values: values * valid, (found.z, found.dissipation, found.residual)
    )
    status = jnp.where(good, found.status, int(Status.NOT_FINITE))
    return curve, (status, counts), found.past


@Program
def _forth(problem: Problem, plan: Plan, options: Options) -> tuple:
    return _answered(problem, plan, options)


@Program
def _back(problem: Problem, plan: Plan, options: Options, past: Past, by: tuple) -> Problem:
    """Derivatives by the problem of what has those `by` the curve, or its first part."""
    moving, still = eqx.partition(problem, eqx.is_inexact_array)

    def curve(moving: Problem) -> tuple:
        return _answered(eqx.combine(moving, still), plan, options, past)[0][: len(by)]

    return jax.vjp(curve, moving)[1](by)[0]


@eqx.filter_custom_vjp
def _differentiable(problem: Problem, options: Options) -> tuple:
    """Forth and back in a program each, kept for later processes as others are.

    Derivatives of one program were traced anew in every process, for 10 s.
    """
    return _forth(problem, _plan_of(problem), options)[:2]


@_differentiable.def_fwd
def _with_past(perturbed: Any, problem: Problem, options: Options) -> tuple:
    plan = _plan_of(problem)
    curve, told, past = _forth(problem, plan, options)
    return (curve, told), (plan, past, curve)


@_differentiable.def_bwd
def _pulled_back(
    known: tuple, by: tuple, perturbed: Any, problem: Problem, options: Options
) -> Problem:
    plan, past, curve = known
    problem = without_derivatives(problem)
    if all(by_energy is None for by_energy in by[0][1:]):
        # Of z alone: energies are not gone through again.
        options, past, curve = options._replace(balanced=False), _of_tips(past), curve[:1]
    whole = jax.tree_util.tree_map(
        lambda value, by_value: jnp.zeros_like(value) if by_value is None else by_value,
        curve,
        by[0][: len(curve)],
    )
    return _back(problem, plan, options, past, whole)


def _of_tips(past: Past) -> Past:
    """The way without the energies that go with it."""
    return past._replace(fronts=past.fronts._replace(y=past.fronts.y[:1]))


def solve_one_after_the_other(problem: Problem, options: Options) -> Solution:
    problem = strong_arrays(hoisted(problem))
    ts = problem.ts
    if options.adjoint is None:
        padded = in_reverse_mode(_with_room(problem))
        curve, (status, counts) = _differentiable(padded, options)
        curve = jax.tree_util.tree_map(lambda values: values[: ts.size], curve)
    else:
        curve, (status, counts), _ = _forth(problem, _plan_of(problem), options)
    how = f"resolved, every slip, by {type(options.solver).__name__}"
    z, dissipation, residual = curve
    return Solution(ts, z, dissipation, residual, status, counts, how)


def _with_room(problem: Problem) -> Problem:
    """The last time again and again, so that other numbers of times compile nothing."""
    more = padded_size(problem.ts.size, SETTINGS.times) - problem.ts.size
    again = jnp.broadcast_to(problem.ts[-1:], (more,))
    return problem._replace(ts=jnp.concatenate([problem.ts, again]))
