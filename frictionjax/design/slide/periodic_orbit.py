"""One period of a steady slide, in the tip coordinate; traceable and differentiable.

Under a load that grows at a constant rate a spring-held tip comes to slide periodically:
z(t + T) = z(t) + eps, T = eps k_h/rate. There z' > 0 throughout, since v = z' obeys
`eps^gamma v' = rate - (k_h + V'') v`, so time is a function of the tip. With
`D = eps^gamma z'` (what drives the tip), `U = V_eps'` and `c = rate eps^(gamma+1)`,

    dD/dy = c G/D - k_h eps G - dU/dy,    D(1) = D(0),

one scalar equation over one period, however small eps is. The map D(0) -> D(1) increases,
its slope is below 1 and grows: Newton's method from below never overshoots. The force in
the spring is `f = U + D`, and its mean over time is its mean over the way (its own
equation, times f), so `mean f = int_0^1 D G dy`: what a slip dissipates, over eps.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from ..._checks import Real
from ...model import AbstractPotential
from ...wiggly import (
    RODAS5P,
    Control,
    ControlState,
    Linearised,
    dense_output,
    judge,
    rosenbrock_step,
    step_of,
)
from .settings import SETTINGS

STEPS = 2048  # of one period; 60 to 700 are needed, plateaus of nearly equal folds: 1200
_TABLEAU = RODAS5P
# Of D in a step, in units of the highest wiggle: errors of D never grow, as c G/D^2 > 0,
# so log D needs few digits where D is small; in log D throughout: 3 times the steps.
_TOLERANCE, _LOOSEST = 1e-9, 1e-3
_FIRST, _SHORTEST = 1e-4, 1e-60
_REACH = 5.0  # of a step, in log D
_LARGEST = 0.02  # of the period: a step must not look over a fold
_FOLD = 2.338  # first zero of Ai(-x): how late a fold is left, in its own scale
_X, _W = np.polynomial.legendre.leggauss(4)
_SHARES = 0.5 * (_X + 1)


class SlideScene(NamedTuple):
    """What a period is made of: numbers, all traced.

    `sign`: 1 to the right, -1 to the left. `pull` c = rate eps^(gamma+1), `give` = k_h eps.
    """

    potential: AbstractPotential
    eps: Real
    sign: Real
    pull: Real
    give: Real

    def ground(self, x: Real) -> tuple[Real, Real]:
        """`sign U` and G at the way `x` in the direction of motion, in periods."""
        force, stretch = self.potential.tip_force(self.sign * x, self.eps)
        return self.sign * force, stretch

    def terrain(self, x: Real) -> tuple[Real, Real]:
        """G and `d(sign U)/dx` at the way `x`."""
        (_, stretch), (climb, _) = jax.jvp(self.ground, (x,), (jnp.ones_like(x),))
        return stretch, climb

    def slope(self, level: Real, stretch: Real, climb: Real) -> Real:
        """`dL/dx` of `L = log D`: positive D without a check, and layers of any depth."""
        drive = jnp.exp(-level)
        return drive * (self.pull * stretch * drive - self.give * stretch - climb)


class PeriodicOrbit(NamedTuple):
    """A period found: where it starts, its steps (STEPS,) padded with 0, and L there."""

    start: Real
    steps: Float[Array, " steps"]
    level: Real
    kept: Real
    closed: Real
    used: Int[Array, ""]


def least_pull(slide: SlideScene) -> tuple[SlideScene, Real]:
    """The slide with a viscosity that floats resolve, and about what that adds to f (N).

    A fold of curvature K is left late by `2.338 K^(-1/3) (c G)^(2/3)`, and away from
    wiggles a tip is dragged along with `c/(k_h eps)`.
    """
    still = _held(slide)
    start, steepest, _ = survey_ground(still)
    least = SETTINGS.least_pull * steepest**2
    resolved = jnp.maximum(still.pull, least)
    (stretch, _), (_, bend) = jax.jvp(still.terrain, (start,), (jnp.ones_like(start),))
    sharp = jnp.maximum(-bend, 1e-300) ** (-1 / 3)
    late, before = ((c * stretch) ** (2 / 3) for c in (resolved, still.pull))
    added = _FOLD * sharp * (late - before) + (resolved - still.pull) / still.give
    return slide._replace(pull=jnp.maximum(slide.pull, least)), added


def _held(slide: SlideScene) -> SlideScene:
    """The slide without derivatives; functions in its parts as they are."""
    numbers, rest = eqx.partition(slide, eqx.is_array_like)
    return eqx.combine(jax.lax.stop_gradient(numbers), rest)


def survey_ground(slide: SlideScene) -> tuple[Real, Real, Real]:
    """Way to the highest sample of `sign U`, steepest climb, and smallest G."""
    points = slide.potential.points
    grid = jnp.arange(points) / points
    both = jax.vmap(slide.ground)
    (force, stretch), (climb, _) = jax.jvp(both, (grid,), (jnp.ones_like(grid),))
    return grid[jnp.argmax(force)], jnp.max(climb), jnp.min(stretch)


def slide_step(slide: SlideScene, x: Real, step: Real, level: Real) -> tuple[Real, tuple]:
    """One Rosenbrock step and its stages."""

    def slope(x: Real, level: Real) -> Real:
        return slide.slope(level, *slide.terrain(x))

    (stretch, climb), bends = jax.jvp(slide.terrain, (x,), (jnp.ones_like(x),))
    drive = jnp.exp(-level)
    first = slide.pull * stretch * drive
    by_state = -drive * (2 * first - slide.give * stretch - climb)
    by_way = slide.slope(level, *bends)  # linear in both
    start = Linearised(drive * (first - slide.give * stretch - climb), by_state, by_way)
    return rosenbrock_step(_TABLEAU, slope, start, x, step, level)


def _once(slide: SlideScene, start: Real, level: Real):
    """Adaptive steps over a period from `level`; the steps, where it ends, and how many."""
    height, _ = slide.ground(start)

    def body(state: tuple) -> tuple:
        way, level, control, steps, count, tried = state
        step = jnp.clip(step_of(control.level, _FIRST), _SHORTEST, _LARGEST)
        last = way + step >= 1.0
        step = jnp.where(last, 1.0 - way, step)
        new, stages = slide_step(slide, start + way, step, level)
        share = height * jnp.exp(-jnp.maximum(level, new))
        allowed = jnp.clip(_TOLERANCE * share, _TOLERANCE, _LOOSEST)
        good, control = judge(
            _TABLEAU.order,
            Control(_FIRST, allowed, loosest=allowed, pace=1.0, reach=_REACH),
            control,
            step=step,
            moved=jnp.abs(new - level),
            error=jnp.abs(stages[-1]),
            cut=last,
        )
        steps = jnp.where(good, steps.at[count].set(step), steps)
        way = jnp.where(good, jnp.where(last, 1.0, way + step), way)
        level = jnp.where(good, new, level)
        return way, level, control, steps, count + good, tried + 1

    def go_on(state: tuple) -> Array:
        way, level, _, _, count, tried = state
        return (way < 1.0) & (count < STEPS) & (tried < 4 * STEPS) & jnp.isfinite(level)

    state = jnp.zeros(()), level, ControlState(), jnp.zeros(STEPS), 0, 0
    way, level, _, steps, count, _ = jax.lax.while_loop(go_on, body, state)
    return steps, jnp.where(way >= 1.0, level, jnp.nan), count


def _end(slide: SlideScene, period: PeriodicOrbit, level: Real) -> Real:
    """L after the same steps from another level; in forward mode differentiable."""

    def one(i: Array, state: tuple[Array, Array]) -> tuple[Array, Array]:
        way, level = state
        new, _ = slide_step(slide, period.start + way, period.steps[i], level)
        return way + period.steps[i], new

    return jax.lax.fori_loop(0, period.used, one, (jnp.zeros(()), level))[1]


def along_step(
    slide: SlideScene, x: Real, step: Real, level: Real
) -> tuple[Real, Real, Real]:
    """L after a step, `int D G dx` (N) over it, and its largest `sign f` (N).

    That is at its end or a turn inside. A step of 0 goes nowhere, and is no peak.
    """
    there = step > 0
    # Derivatives of a step that is not there must stay finite.
    safe = jnp.where(there, step, 1e-3)
    new, stages = slide_step(slide, x, safe, level)

    def inside(share: Array) -> Array:
        return dense_output(_TABLEAU, level, new, stages, share)

    share = rise_to_turn(level, new, jnp.log(slide.pull / slide.give))
    places = jnp.append(jnp.asarray(_SHARES), share)
    forces, stretches = jax.vmap(slide.ground)(x + safe * places)
    drives = jnp.exp(inside(places))
    mean = 0.5 * safe * jnp.sum(_W * drives[:-1] * stretches[:-1])
    peak = forces[-1] + drives[-1]
    new = jnp.where(there, new, level)
    return new, jnp.where(there, mean, 0.0), jnp.where(there, peak, -jnp.inf)


def replay(
    slide: SlideScene, period: PeriodicOrbit, level: Real
) -> tuple[Real, Array, Array]:
    """The same steps from another level: where it ends, mean and peak of each step.

    Differentiable: steps are given. Returns L at the end, `int D G dx` (N) of each step
    and the largest `sign f` (N) at its end or a turn inside.
    """

    def one(state: tuple[Array, Array], step: Array) -> tuple[Any, Any]:
        way, level = state
        new, *forces = along_step(slide, period.start + way, step, level)
        return (way + step, new), forces

    begin = jnp.zeros(()), level
    (_, last), (means, peaks) = jax.lax.scan(one, begin, period.steps)
    return last, means, peaks


class _Pull(NamedTuple):
    """Derivatives of L at the end, of mean and of peak force, traced back so far: by L at
    the start of a step, (3,), and by the numbers of the slide, (3, ...)."""

    left: Array
    by_level: Float[Array, " 3"]
    by_slide: Any


def force_slopes(slide: SlideScene, period: PeriodicOrbit) -> SlideScene:
    """Derivatives of mean and peak force by the numbers of a slide, (2, ...).

    Of the steps of its period, one after the other from the last, and of its start by the
    implicit function theorem. (The loop over steps differentiated as a whole takes a third
    more to trace and compile and three times as long to run.)
    """
    moving, still = eqx.partition(slide, eqx.is_inexact_array)

    def one(state: tuple[Array, Array], step: Array) -> tuple[Any, Any]:
        way, level = state
        new, _, peak = along_step(slide, period.start + way, step, level)
        return (way + step, new), (way, level, peak)

    begin = jnp.zeros(()), period.level
    _, (ways, levels, peaks) = jax.lax.scan(one, begin, period.steps)
    highest = jnp.argmax(peaks)

    def over_step(pull: _Pull) -> _Pull:
        place = pull.left - 1

        def step(moving: Any, level: Real) -> tuple[Real, Real, Real]:
            x = period.start + ways[place]
            return along_step(eqx.combine(moving, still), x, period.steps[place], level)

        _, back = jax.vjp(step, moving, levels[place])
        peak = jnp.array([0.0, 0.0, 1.0]) * (place == highest)
        pushes = pull.by_level, jnp.array([0.0, 1.0, 0.0]), peak
        by_slide, by_level = jax.lax.map(back, pushes)
        so_far = jax.tree_util.tree_map(jnp.add, pull.by_slide, by_slide)
        return _Pull(place, by_level, so_far)

    none = jax.tree_util.tree_map(lambda leaf: jnp.zeros((3, *leaf.shape)), moving)
    last = _Pull(period.used, jnp.array([1.0, 0.0, 0.0]), none)
    pull = jax.lax.while_loop(lambda pull: pull.left > 0, over_step, last)
    by_start = pull.by_level[1:] / (1 - pull.by_level[0])

    def closed(by: Array) -> Array:
        return by[1:] + jnp.multiply.outer(by_start, by[0])

    return jax.tree_util.tree_map(closed, pull.by_slide)


def rise_to_turn(level: Real, new: Real, turn: Real) -> Real:
    """Share of a step at which D rises through `rate eps^gamma/k_h`, so that f turns.

    Else its end. Not differentiated, and a straight line does: f is stationary there.
    """
    low, high = jax.lax.stop_gradient((level - turn, new - turn))
    turns = (low < 0) & (high > 0)
    return jnp.where(turns, -low / jnp.where(turns, high - low, 1.0), 1.0)


def find_periodic_orbit(slide: SlideScene) -> PeriodicOrbit:
    """The periodic slide by Newton's method from below; not differentiable.

    First with steps chosen anew each time, then, as these make the map rough, on the last
    ones to rounding.
    """
    start, steepest, thinnest = survey_ground(slide)
    low = slide.pull * thinnest / (slide.give * thinnest + steepest)
    none, far = jnp.zeros(STEPS), jnp.asarray(jnp.inf)
    begin = PeriodicOrbit(start, none, jnp.log(low), jnp.zeros(()), far, jnp.asarray(0))

    def remeshed(period: PeriodicOrbit) -> PeriodicOrbit:
        steps, _, used = _once(slide, start, period.level)
        return period._replace(steps=steps, used=used)

    def iterated(
        renew: Callable, limit: Any, most: int, period: PeriodicOrbit
    ) -> PeriodicOrbit:
        def body(state: tuple[PeriodicOrbit, Any]) -> tuple[PeriodicOrbit, Any]:
            period, count = state
            return _newton(slide, renew(period), limit), count + 1

        def go_on(state: tuple[PeriodicOrbit, Any]) -> Array:
            period, count = state
            good = jnp.isfinite(period.level) & (period.used < STEPS)
            return (period.closed > limit) & (count < most) & good

        return jax.lax.while_loop(go_on, body, (period, 0))[0]

    rough = iterated(remeshed, SETTINGS.rough, SETTINGS.newton, begin)
    again = rough._replace(closed=far)
    fine = iterated(lambda p: p, SETTINGS.closed, SETTINGS.newton_again, again)
    # Where c is at its least, steps of a landing may only replay from where they were made:
    # then what is left open there counts as the force that it is.
    height, _ = slide.ground(start)
    left = rough.closed * jnp.exp(rough.level) / height
    good = jnp.isfinite(fine.level) & (fine.closed <= SETTINGS.open)
    return jax.tree_util.tree_map(
        lambda a, b: jnp.where(good, a, b), fine, rough._replace(closed=left)
    )


def _newton(slide: SlideScene, period: PeriodicOrbit, limit: Real) -> PeriodicOrbit:
    """A step of Newton's method in D, where the map is convex: dD1/dD0 = kept D1/D0."""
    one = jnp.ones(())
    end, kept = jax.jvp(lambda v: _end(slide, period, v), (period.level,), (one,))
    here, there = jnp.exp(period.level), jnp.exp(end)
    slope = jnp.clip(kept * there / here, 0.0, 1.0 - 1e-9)
    new = here + (there - here) / (1 - slope)
    new = jnp.log(jnp.where(new > 0, new, 0.5 * here))
    closed = jnp.abs(end - period.level)
    level = jnp.where(closed <= limit, period.level, new)
    return period._replace(level=level, kept=kept, closed=closed)


def known_slide_forces(slide: SlideScene) -> tuple[Real, Real, PeriodicOrbit]:
    """As `slide_forces` without derivatives: a sixth to a third less to compile."""
    period = find_periodic_orbit(slide)
    _, means, peaks = replay(slide, period, period.level)
    return jnp.sum(means), jnp.max(peaks), period


def slide_forces(slide: SlideScene) -> tuple[Real, Real, PeriodicOrbit]:
    """Mean and peak force (N, positive) of a steady slide, and its period.

    Differentiable once: the start of the period by the implicit function theorem, the rest
    through its steps, which are kept.
    """
    still = _held(slide)
    period = jax.lax.stop_gradient(find_periodic_orbit(still))

    def totals(slide: SlideScene, level: Array) -> tuple[Array, Array, Array]:
        last, means, peaks = replay(slide, period, level)
        return last, jnp.sum(means), jnp.max(peaks)

    along = (jnp.ones(()),)
    _, tangents = jax.jvp(lambda v: totals(still, v), (period.level,), along)
    _, *by_level = jax.lax.stop_gradient(tangents)
    end, *both = totals(slide, period.level)
    moved = (end - jax.lax.stop_gradient(end)) / (1 - period.kept)
    mean, peak = (value + by * moved for value, by in zip(both, by_level, strict=True))
    return mean, peak, period
