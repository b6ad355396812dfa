"""From the accuracy asked for to the tolerance and the reach of a step."""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from ..arguments import Real, require_real
from ..coefficients import Coefficients, coefficients
from ..extrema import periodic_extrema, slope_of
from ..potentials import AbstractPotential
from ..scene import Scene, load_range

# At 100 and 0.1 below, errors at gamma = 0.65 were 1.6 times as large, and 3e-3 eps where
# 1e-3 was asked for, for 7% fewer steps.
_SAFETY = 200.0
_LOOSEST = 1e-4  # looser ones save little (46 steps a slip for 58): guard and folds rule
# Share of the way to a fold, half a percent of a slip period before it, that one step may
# err by. At 0.6 slips came up to 3% of a period early, with closed brackets (eps = 1e-5 to
# 1e-7, gamma = 2); at 0.2 none did.
_FOLD = 0.03
# Speed at folds below which tolerances are tighter in proportion, where slips add up. At
# gamma = 1/2, eps = 1e-4 (0.006) errors were 2.4e-3 eps without, where 1e-3 was asked for.
_CREEP = 0.025
_TIGHTEST = 1e-13
# Errors of a few slips, added up; those of all add up to 1e4 at eps = 1e-8, gamma = 1/4. At
# 4, surveys at gamma = 0.4 were 4e-3 eps off; 16 to 500 gave the same to 1e-5 eps.
_FEW_ADD = 30.0
# Of the accuracy: error of a step in the middle of a slip. At 0.2 steps are 4% fewer, and
# brackets at eps = 1e-8 stay open.
_IN_SLIPS = 0.05
_SAMPLES = 64  # of the load's slope between two turning points
_DOUBLE_SPACING = 2.0**-50  # shortest step over the duration: four spacings of floats


def require_accuracy(accuracy: Any) -> None:
    """Check the accuracy asked for."""
    allowed = "1e-10 <= accuracy <= 1 (error of z in units of eps)"
    require_real("accuracy", accuracy, allowed, lambda a: 1e-10 <= a <= 1)


class Folds(NamedTuple):
    """Extreme folds in the tip coordinate of well 0, where slides hang before a slip.

    `place_*`: periods, `state_*`: z in m, `force_*`: V_eps' in N, at its maximum (plus)
    and minimum (minus).
    """

    place_plus: Real
    state_plus: Real
    force_plus: Real
    place_minus: Real
    state_minus: Real
    force_minus: Real


class Plan(NamedTuple):
    """Step control of one trajectory: tolerances and reach in periods, steps in s.

    `loosest`: tolerance in the middle of a slip; `pace`: periods a second of the fastest
    slide: see `Control`. `brief`: tolerance of a lane that goes through a few wells only.
    `memory`: slips back that a disturbance still matters.
    """

    tolerance: Real
    loosest: Real
    brief: Real
    pace: Real
    reach: Real
    first_step: Real
    shortest_step: Real
    memory: Real
    folds: Folds


class Landscape(eqx.Module):
    """What step control needs to know of the wiggly force in the tip coordinate.

    `fold_curvature`, `flat_curvature`: |W'''| at the sharper and at the flatter of the two
    extreme folds, in N. `steepest`: max |W''| in N. `branch`: width in periods of the
    narrowest branch on which `W'` is monotone; a tip must cross a falling one to change
    wells. `stretch`: largest G.
    """

    fold_curvature: Real
    flat_curvature: Real
    steepest: Real
    branch: Real
    stretch: Real
    folds: Folds


def landscape(potential: AbstractPotential, eps: Real) -> Landscape:
    """Scan one period of `V_eps'` in the tip coordinate."""
    points = potential.points

    def force(y):
        return potential.tip_force(y, eps)[0]

    # Nobody differentiates a plan: a tenth less to trace.
    extrema = periodic_extrema(force, points, differentiable=False)
    grid = (jnp.arange(points) + 0.5) / points
    one = jnp.ones_like(grid)
    every = jax.vmap(lambda y: potential.tip_force(y, eps))
    (_, stretches), (slopes, _) = jax.jvp(every, (grid,), (one,))
    top, bottom = extrema.argmax, extrema.argmin
    states = [eps * y + potential.offset(y, eps) for y in (top, bottom)]
    # Forward twice: reverse mode takes twice as long to trace.
    bend = slope_of(slope_of(jax.vmap(force)))
    curvatures = jnp.abs(bend(jnp.stack([top, bottom])))
    return Landscape(
        fold_curvature=jnp.max(curvatures),
        flat_curvature=jnp.min(curvatures),
        steepest=jnp.max(jnp.abs(slopes)),
        branch=jnp.minimum(_narrowest_run(slopes) / points, 0.5),
        stretch=jnp.max(stretches),
        folds=Folds(top, states[0], extrema.max, bottom, states[1], extrema.min),
    )


def _narrowest_run(slopes: Float[Array, " n"]) -> Real:
    """Samples in the shortest run of one sign of the 1-periodic `slopes`, at least 2.

    Rounding noise on flat stretches counts as rising.
    """
    falling: Bool[Array, " twice"] = jnp.tile(slopes < -1e-9 * jnp.max(jnp.abs(slopes)), 2)
    index, twice = jnp.arange(falling.shape[0]), falling.shape[0]
    turns = (falling != jnp.roll(falling, 1)) & (index > 0)
    # Sorted to the front (a running maximum instead compiles three times as long).
    places = jnp.sort(jnp.where(turns, index, 2 * twice))
    widths = jnp.where(places[1:] < twice, jnp.diff(places), twice)
    return jnp.maximum(jnp.min(widths), 2)


class Pull(NamedTuple):
    """How hard a scene pulls: largest |l'| on [0, T] in N/s, smallest Phi'' in N/m."""

    fastest: Real
    softest: Real


def pull_of(scene: Scene, found: Coefficients) -> Pull:
    """The same for all cells: sampled between turning points, and over reached states."""
    ends = jnp.stack([jnp.zeros_like(scene.duration), scene.duration])
    edges = jnp.sort(jnp.concatenate([ends, scene.turning_points()]))
    share = (jnp.arange(_SAMPLES) + 0.5) / _SAMPLES
    times = (edges[:-1, None] + jnp.diff(edges)[:, None] * share).ravel()
    slopes = jax.vmap(scene.load.slope)(times)
    low, high = load_range(scene)
    forces = jnp.linspace(low - found.rho_plus, high - found.rho_minus, 9)
    states = jax.vmap(scene.support.state_of)(forces)
    stiffness = jax.vmap(scene.support.stiffness_at)(states)
    return Pull(jnp.max(jnp.abs(slopes)), jnp.min(stiffness))


def remembered_slips(ground: Landscape, pull: Pull, eps: Real, gamma: Real) -> Real:
    """How many slips back a disturbance still matters, in the scene's fastest slide.

    Averaging over a well, a slide at speed v lags by a force that is quadratic in
    eps^gamma v; its slope gives one e-fold of forgetting in
    `4 pi^2 v^2 eps^(2 gamma - 1)/(|W_fold'''| Phi'')` wells: 40 at gamma = 1/2 on the
    benchmark scene at any eps (a slip leaves 0.975 of a disturbance, as measured), one or
    less at gamma = 1.
    """
    speed = pull.fastest / pull.softest
    bend = jnp.maximum(ground.flat_curvature, 1e-300)
    return 4 * jnp.pi**2 * speed**2 * eps ** (2 * gamma - 1) / (bend * pull.softest)


def _way_to_fold(ground: Landscape, pull: Pull, eps: Real, gamma: Real) -> Real:
    """How near in periods the tip is to a fold when its slip is half a percent away.

    At rest the force is quadratic in the distance, which so shrinks like sqrt(eps). Where
    viscosity is large, the passage is wider: `eps^(gamma+1) y' = l' t + b y^2`, with b half
    the curvature, has the scale `(eps^(gamma+1) l')^(1/3) b^(-2/3)`.
    """
    bend = jnp.maximum(0.5 * ground.fold_curvature, 1e-300)
    at_rest = jnp.sqrt(0.005 * pull.softest * eps / bend)
    passage = jnp.cbrt(eps ** (gamma + 1) * pull.fastest / bend**2)
    return jnp.maximum(at_rest, 0.3 * passage)


def _pace_at_fold(ground: Landscape, pull: Pull, eps: Real, gamma: Real) -> Real:
    """Speed of a tip that passes a fold, in periods a slip, in the fastest slide.

    From the scales of time and place of `eps^(gamma+1) y' = l' t + b y^2`.
    """
    bend = jnp.maximum(0.5 * ground.fold_curvature, 1e-300)
    rate = jnp.maximum(pull.fastest, 1e-300)
    return pull.softest * jnp.cbrt(eps ** (2 - gamma) / (bend * rate))


def plan_steps(
    scene: Scene, eps: Real, gamma: Real, accuracy: Real, pull: Pull | None = None
) -> Plan:
    """Step control for an error of `accuracy` eps in z at times outside slips.

    Errors of the slips remembered add up with mixed signs: as the root of their number.
    (As the number itself: tolerances 6 times smaller at gamma = 1/2, for errors that were
    10 times below the target already.) They are errors in time, the larger the slower a
    tip passes the fold. `pull`: that of the scene, where it is known.
    """
    if pull is None:
        pull = pull_of(scene, coefficients(scene.potential))
    ground = landscape(scene.potential, eps)
    memory = remembered_slips(ground, pull, eps, gamma)
    stretch = jnp.maximum(1.0, ground.stretch)
    creep = jnp.minimum(memory, 1.0) * _CREEP / _pace_at_fold(ground, pull, eps, gamma)
    adding = jnp.sqrt(1 + memory) * jnp.maximum(creep, 1.0)
    share = accuracy / (_SAFETY * stretch)
    at_folds = _FOLD * _way_to_fold(ground, pull, eps, gamma)
    relaxation = eps ** (gamma + 1) / ground.steepest
    shortest = _DOUBLE_SPACING * scene.duration
    first = jnp.clip(1e-2 * relaxation, 2 * shortest, 1e-2 * scene.duration)
    tolerance, brief = (
        jnp.clip(jnp.minimum(share / many, at_folds), _TIGHTEST, _LOOSEST)
        for many in (adding, jnp.minimum(adding, _FEW_ADD))
    )
    plan = Plan(
        tolerance=tolerance,
        loosest=jnp.maximum(tolerance, _IN_SLIPS * accuracy / stretch),
        brief=brief,
        pace=jnp.where(pull.fastest > 0, pull.fastest / (pull.softest * eps), jnp.inf),
        reach=0.25 * ground.branch,
        first_step=first,
        shortest_step=shortest,
        memory=memory,
        folds=ground.folds,
    )
    return jax.lax.stop_gradient(plan)
