"""From the accuracy asked for to the tolerance and the reach of a step."""

from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..._checks import Real, known_numbers, require, require_real
from ...loads import AbstractPull, steep_times
from ...model import AbstractPotential, Scene, coefficients
from ...supports import AbstractSupport
from ..stepping import Control
from .landscape import Landscape, WiggleFolds, landscape
from .settings import SETTINGS
from .turns_at_folds import nearest_turn


def require_accuracy(
    accuracy: Any, name: str = "accuracy", least: float = SETTINGS.least_asked
) -> None:
    """Check the accuracy asked for."""
    allowed = f"{least:.0e} <= {name} <= 1 (error of z in units of eps)"
    require_real(name, accuracy, allowed, lambda a: least <= a <= 1)


def accuracies_of(
    accuracies: Any, least: float = SETTINGS.least_asked
) -> Float[np.ndarray, " accuracies"]:
    """Accuracies asked for, one or several, each once and rising.

    Raises `ValueError` where they are none, or less than `least`.
    """
    known = known_numbers(accuracies)
    numbers = known.dtype != object and known.ndim <= 1 and known.size > 0
    require(numbers, "accuracies", accuracies, "one number or a list of them")
    for value in np.atleast_1d(known):
        require_accuracy(float(value), "accuracies", least)
    return np.unique(known.astype(float))


class StepPlan(NamedTuple):
    """Step control of one trajectory: tolerances and reach in periods, steps in s.

    `loosest`: tolerance in the middle of a slip; `pace`: periods a second of the fastest
    slide: see `Control`. `brief`: tolerance of a lane that goes through a few wells only.
    `unit`: the accuracy in m.
    """

    tolerance: Real
    loosest: Real
    brief: Real
    pace: Real
    reach: Real
    first_step: Real
    shortest_step: Real
    folds: WiggleFolds
    unit: Real

    @property
    def control(self) -> Control:
        """What steers the steps of a trajectory through many wells."""
        return Control(
            first_step=self.first_step,
            tolerance=self.tolerance,
            loosest=self.loosest,
            pace=self.pace,
            reach=self.reach,
        )


class PullRange(NamedTuple):
    """How hard a scene pulls: largest |l'| on [0, T] in N/s, smallest Phi'' in N/m.

    `way`: the most that its limit moves one way, m; `total`: to and fro, where known.
    """

    fastest: Real
    softest: Real
    way: Real
    total: Any = np.inf


def _pull_of(scene: Scene, edges: Float[Array, " n"]) -> PullRange:
    """The same for all cells: sampled between turning points, and over reached states."""
    found = coefficients(scene.potential)
    rho = found.rho_plus, found.rho_minus
    return pull_between(scene.load, scene.support, edges, *rho)


def _edges_of(scene: Scene) -> Float[Array, " n"]:
    """Ends and turning points of its load in s, sorted."""
    ends = jnp.stack([jnp.zeros_like(scene.duration), scene.duration])
    return jnp.sort(jnp.concatenate([ends, scene.turning_points()]))


def pull_between(
    load: AbstractPull,
    support: AbstractSupport,
    edges: Float[Array, " n"],
    rho_plus: Real,
    rho_minus: Real,
) -> PullRange:
    """The same of a load with these turning points, its ends among them, in s."""
    times = jax.vmap(partial(steep_times, load))(edges[:-1], edges[1:]).ravel()
    slopes, values = jax.vmap(load.slope)(times), jax.vmap(load)(edges)
    low, high = jnp.min(values), jnp.max(values)
    forces = jnp.linspace(low - rho_plus, high - rho_minus, 9)
    states = jax.vmap(support.state_of)(forces)
    stiffness = jax.vmap(support.stiffness_at)(states)
    softest = jnp.min(stiffness)
    beyond = high - low - (rho_plus - rho_minus)
    way = jnp.maximum(beyond, 0.0) / softest
    return PullRange(jnp.max(jnp.abs(slopes)), softest, way)


def remembered_slips(ground: Landscape, pull: PullRange, eps: Real, gamma: Real) -> Real:
    """How many slips back a disturbance still matters, in the scene's fastest slide.

    Averaging over a well, a slide at speed v lags by a force that is quadratic in
    eps^gamma v; its slope gives one e-fold of forgetting in
    `4 pi^2 v^2 eps^(2 gamma - 1)/(|W_fold'''| Phi'')` wells: 40 at gamma = 1/2 on the
    benchmark scene at any eps (a slip leaves 0.975 of a disturbance, as measured), one or
    less at gamma = 1. No more than there are in all: the fastest moment may be a short one,
    or the softest place a small one.
    """
    speed = pull.fastest / pull.softest
    bend = jnp.maximum(ground.flat_curvature, 1e-300)
    slips = 4 * jnp.pi**2 * speed**2 * eps ** (2 * gamma - 1) / (bend * pull.softest)
    return jnp.minimum(slips, pull.total / eps)


def _way_to_fold(ground: Landscape, pull: PullRange, eps: Real, gamma: Real) -> Real:
    """How near in periods the tip is to a fold when its slip is half a percent away.

    At rest the force is quadratic in the distance, which so shrinks like sqrt(eps). Where
    viscosity is large, the passage is wider: `eps^(gamma+1) y' = l' t + b y^2`, with b half
    the curvature.
    """
    bend = jnp.maximum(0.5 * ground.fold_curvature, 1e-300)
    at_rest = jnp.sqrt(SETTINGS.before * pull.softest * eps / bend)
    return jnp.maximum(at_rest, 0.3 * _width_of_fold(ground, pull, eps, gamma))


def _width_of_fold(ground: Landscape, pull: PullRange, eps: Real, gamma: Real) -> Real:
    """Of the passage, in periods: `(eps^(gamma+1) l')^(1/3) b^(-2/3)`."""
    bend = jnp.maximum(0.5 * ground.fold_curvature, 1e-300)
    return jnp.cbrt(eps ** (gamma + 1) * pull.fastest / bend**2)


def _pace_at_fold(ground: Landscape, pull: PullRange, eps: Real, gamma: Real) -> Real:
    """Speed of a tip that passes a fold, in periods a slip, in the fastest slide.

    From the scales of time and place of `eps^(gamma+1) y' = l' t + b y^2`.
    """
    bend = jnp.maximum(0.5 * ground.fold_curvature, 1e-300)
    rate = jnp.maximum(pull.fastest, 1e-300)
    return pull.softest * jnp.cbrt(eps ** (2 - gamma) / (bend * rate))


def _adding(
    ground: Landscape, pull: PullRange, eps: Real, gamma: Real, memory: Real
) -> Real:
    """How many times an error of a step at a fold comes up in the state.

    Errors of the slips remembered add up with mixed signs: as the root of their number.
    (As the number itself: tolerances 6 times smaller at gamma = 1/2, for errors that were
    10 times below the target already.) They are errors in time, the larger the slower a
    tip passes the fold. One slip's own counts by the speed of the tip before it: a passage
    of width s and time s/pace ends like `s^2/(pace (t* - t))`.
    """
    pace = _pace_at_fold(ground, pull, eps, gamma)
    creep = jnp.minimum(memory, 1.0) * SETTINGS.creep / pace
    before = _width_of_fold(ground, pull, eps, gamma) ** 2 / (pace * SETTINGS.before**2)
    haste = SETTINGS.haste * jnp.minimum(before, SETTINGS.fastest_counted) / pace
    return jnp.maximum(jnp.sqrt(1 + memory) * jnp.maximum(creep, 1.0), haste)


def _of_few_wells(way: Real, start: Real, accuracy: Real) -> Real:
    """Tolerances over those of slides through many wells.

    `way`: wells that the limit moves through one way at most; `start`: wells from the
    origin at t = 0.
    """
    share = way / SETTINGS.many_wells
    near = jnp.minimum(
        SETTINGS.rounded * (start + way) / accuracy, jnp.clip(share, SETTINGS.roughest, 1.0)
    )
    return jnp.maximum(jnp.clip(share**SETTINGS.power, SETTINGS.fewest, 1.0), near)


class SteppedParts(NamedTuple):
    """What plans of steps read of a scene whose pull is known."""

    potential: AbstractPotential
    support: AbstractSupport
    duration: Any
    z0: Any


def plan_steps(
    scene: Scene | SteppedParts,
    eps: Real,
    gamma: Real,
    accuracy: Real,
    pull: PullRange | None = None,
) -> StepPlan:
    """Step control for an error of `accuracy` eps in z at times outside slips.

    `pull`: that of the scene, where it is known, and how near the load turns to folds, too.
    """
    ground = landscape(scene.potential, eps)
    turn: Real | float = jnp.inf
    if pull is None:
        assert isinstance(scene, Scene)
        edges = _edges_of(scene)
        pull = _pull_of(scene, edges)
        turn = nearest_turn(scene.load, scene.support, edges, ground.folds, eps)
    memory = remembered_slips(ground, pull, eps, gamma)
    stretch = jnp.maximum(1.0, ground.stretch)
    adding = _adding(ground, pull, eps, gamma, memory)
    few = _of_few_wells(pull.way / eps, jnp.abs(scene.z0) / eps, accuracy)
    share = few * accuracy / (SETTINGS.safety * stretch)
    at_folds = SETTINGS.fold * jnp.minimum(_way_to_fold(ground, pull, eps, gamma), turn)
    held = eps * scene.support.stiffness_at(scene.z0)
    relaxation = eps ** (gamma + 1) / jnp.maximum(ground.steepest, held)
    shortest = SETTINGS.double_spacing * scene.duration
    first = jnp.clip(1e-2 * relaxation, 2 * shortest, 1e-2 * scene.duration)
    tolerance, brief = (
        jnp.clip(jnp.minimum(share / many, at_folds), SETTINGS.tightest, SETTINGS.loosest)
        for many in (adding, jnp.minimum(adding, SETTINGS.few_add))
    )
    plan = StepPlan(
        tolerance=tolerance,
        loosest=jnp.maximum(tolerance, SETTINGS.in_slips * few * accuracy / stretch),
        brief=brief,
        pace=jnp.where(pull.fastest > 0, pull.fastest / (pull.softest * eps), jnp.inf),
        reach=0.25 * ground.branch,
        first_step=first,
        shortest_step=shortest,
        folds=ground.folds,
        unit=accuracy * eps,
    )
    return jax.lax.stop_gradient(plan)
