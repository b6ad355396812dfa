"""Both feet from stop to stop: the compiled loop."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool

from .._checks import Real
from .._compile import Program
from ..model import Scene
from ..wiggly import Control, ControlState, Status, judge, plan_steps, step_of
from .settings import SETTINGS
from .two_feet import FeetStep, TwoFeet, step_of_feet


class CrawlPlan(NamedTuple):
    """`eps` in m, `gamma`, the accuracy in eps that steps are planned for, their tolerance
    over that of the plan, and most steps."""

    eps: Any
    gamma: Any
    accuracy: Any
    finer: Any
    budget: Any


class FeetAtStops(NamedTuple):
    """At each stop, (n,): places in m, their speeds in eps a slip's time, (n, 2); tension
    in N; dissipation, and what is left of the energy balance, in J."""

    places: Any
    speeds: Any
    tension: Any
    lost: Any
    left: Any


class _Going(NamedTuple):
    """On the way; `time` in s since the last stop."""

    wells: Array
    motion: Array
    time: Real
    arrived: Bool[Array, ""]
    control: ControlState
    steps: Real
    code: Real


class MarchedFeet(NamedTuple):
    """What was found at the stops, and how it ended."""

    stops: FeetAtStops
    steps: Any
    code: Any


@Program
def march_feet(
    scene: Scene, starts: Any, lengths: Any, places: Any, crawl: CrawlPlan
) -> MarchedFeet:
    """From `places` (m, (2,)) through stretches between stops: starts and lengths in s.

    `scene`: one foot, pulled by the spring whose other end is held. Its load turns and has
    its kinks at stops.
    """
    eps, viscosity = crawl.eps, crawl.eps**crawl.gamma
    plan = plan_steps(scene, eps, crawl.gamma, crawl.accuracy)
    share = SETTINGS.share * crawl.finer
    control = plan.control._replace(
        tolerance=share * plan.tolerance, loosest=share * plan.loosest
    )

    def feet_at(wells: Array, origin: Real) -> TwoFeet:
        parts = scene.potential, scene.load, scene.support.stiffness_at(0.0)
        return TwoFeet(*parts, eps, viscosity, wells, origin)

    wells, tips = scene.potential.tip(places, eps)
    first = jnp.append(tips, jnp.zeros(2))
    none = jnp.zeros_like(eps)
    before = feet_at(wells, starts[0]).energy(first)
    start = _Going(wells, first, none, none > 0, ControlState(none, none), none, none)

    def through(going: _Going, stretch: tuple) -> tuple[_Going, FeetAtStops]:
        origin, length = stretch
        going = going._replace(time=none, arrived=length <= 0)
        going = jax.lax.while_loop(
            lambda now: (now.code == 0) & ~now.arrived,
            lambda now: _stepped(feet_at(now.wells, origin), control, crawl, now, length),
            going,
        )
        feet, motion = feet_at(going.wells, origin), going.motion
        forces = feet.feet(motion)
        speeds = feet.rates(length, motion)[:2] / plan.pace
        left = before + motion[3] - feet.energy(motion) - motion[2]
        tension = feet.tension(length, forces)
        found = FeetAtStops(forces.place, speeds, tension, motion[2], left)
        known = going.code == 0
        return going, jax.tree_util.tree_map(lambda v: jnp.where(known, v, jnp.nan), found)

    going, stops = jax.lax.scan(through, start, (starts, lengths))
    return MarchedFeet(stops, going.steps, going.code)


def _stepped(
    feet: TwoFeet, control: Control, crawl: CrawlPlan, going: _Going, length: Real
) -> _Going:
    """One step, accepted or not."""
    wanted = step_of(going.control.level, control.first_step)
    remaining = length - going.time
    cut = wanted >= remaining
    size = jnp.minimum(wanted, remaining)
    step = step_of_feet(SETTINGS.tableau, feet.rates, going.time, size, going.motion)
    error = _largest(step.error)
    verdict = judge(
        SETTINGS.tableau.order,
        control,
        going.control,
        step=size,
        moved=_largest(step.end - going.motion),
        error=jnp.where(jnp.all(jnp.isfinite(step.end)), error, jnp.inf),
        cut=cut,
    )
    good = verdict.accepted
    return _after(going, step, good)._replace(
        time=jnp.where(good, jnp.where(cut, length, going.time + size), going.time),
        arrived=good & cut,
        control=verdict.after,
        code=_code(crawl, going, size, error, good),
    )


def _after(going: _Going, step: FeetStep, good: Bool[Array, ""]) -> _Going:
    """Where tips are counted from the wells that they are in."""
    turns = jnp.round(step.end[:2])
    end = step.end.at[:2].add(-turns)
    return going._replace(
        wells=jnp.where(good, going.wells + turns, going.wells),
        motion=jnp.where(good, end, going.motion),
        steps=going.steps + 1,
    )


def _largest(motion: Array) -> Real:
    return jnp.max(jnp.abs(motion[:2]))


def _code(crawl: CrawlPlan, going: _Going, size: Real, error: Real, good: Any) -> Real:
    """Why it goes no further, 0 where it does."""
    lost = ~good & (going.time + size <= going.time)
    small = jnp.where(jnp.isfinite(error), Status.STEP_TOO_SMALL, Status.NOT_FINITE)
    spent = going.steps + 1 >= crawl.budget
    return jnp.where(lost, small, jnp.where(spent, Status.MAX_STEPS, 0)).astype(float)
