"""Tips with mass side by side: the compiled loop.

All lanes of a row are of one scene and go from stop to stop together; eps, viscosity, mass
and tolerance are each lane's own.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from ..._checks import Real
from ..._compile import Program
from ...loads import AbstractPull
from ...model import AbstractPotential
from ...supports import AbstractSupport
from ..equation import Status, TipField
from ..rosenbrock import dense_output
from ..stepping import Control, ControlState, judge, step_of
from .coupled_step import MassiveStep, step_with_mass
from .massive_tip import MassiveTip, TipMotion
from .settings import SETTINGS


class MassiveScene(NamedTuple):
    """What all lanes share; `z0` in m, `rho_plus`, `rho_minus` in N."""

    potential: AbstractPotential
    support: AbstractSupport
    load: AbstractPull
    z0: Any
    rho_plus: Any
    rho_minus: Any


class MassiveLane(NamedTuple):
    """What is a lane's own: eps (m), viscosity (N s/m), mass (kg), well and tip (periods)
    of z0, step control, `pause` (s) that makes an error of a speed one of a place, and its
    budget of steps."""

    eps: Any
    viscosity: Any
    mass: Any
    well: Any
    tip: Any
    control: Control
    pause: Any
    budget: Any


class Stretches(NamedTuple):
    """Stretches between stops, (n,): start and length in s. The load turns at stops."""

    start: Any
    length: Any


class _Stretch(NamedTuple):
    """One of them, with the limit system's state (m) and dissipation (J) at its start."""

    start: Real
    length: Real
    limit: Real
    limit_lost: Real


class SupremaSoFar(NamedTuple):
    """So far, of |z - limit| and the distance from the strip in m, of dissipations in J."""

    far: Real
    outside: Real
    apart: Real


class MassAtStops(NamedTuple):
    """At the ends of segments: `z` (m), `velocity` (m/s), `lost` (J) and what is `left` of
    the energy balance (J), (lanes, n)."""

    z: Any
    velocity: Any
    lost: Any
    left: Any


class _Going(NamedTuple):
    """A lane on its way; `time` in s since the segment's start."""

    well: Real
    motion: TipMotion
    time: Real
    arrived: Bool[Array, ""]
    control: ControlState
    suprema: SupremaSoFar
    steps: Real
    rejected: Real
    code: Real


class OnTheWay(NamedTuple):
    """Lanes at a stop, with the limit system's state (m) and dissipation (J) there."""

    going: Any
    limit: Any
    limit_lost: Any


def at_start(lanes: MassiveLane, z0: float) -> OnTheWay:
    """Lanes, (lanes,) each, at rest."""
    none = np.zeros_like(lanes.eps)
    going = _Going(
        well=lanes.well,
        motion=TipMotion(lanes.tip, none, none, none),
        time=none,
        arrived=none > 0,
        control=ControlState(none, none),
        suprema=SupremaSoFar(none, none, none),
        steps=none,
        rejected=none,
        code=none,
    )
    return OnTheWay(going, np.asarray(z0), np.zeros(()))


@Program
def march_with_mass(
    scene: MassiveScene,
    segments: Stretches,
    with_suprema: bool,
    lanes: MassiveLane,
    before: OnTheWay,
) -> tuple[OnTheWay, MassAtStops]:
    """Lanes, (lanes,) each, through some segments, from where they are."""

    def of_row(fn: Callable) -> Callable:
        return jax.vmap(fn, in_axes=(0, 0, None))

    step = of_row(lambda lane, going, at: _stepped(scene, lane, going, at, with_suprema))
    report = of_row(lambda lane, going, at: _at_stop(scene, lane, going, at))

    def through(before: OnTheWay, segment: Stretches) -> tuple[OnTheWay, MassAtStops]:
        going, limit, limit_lost = before
        at = _Stretch(*segment, limit, limit_lost)
        there = jnp.broadcast_to(at.length <= 0, going.arrived.shape)
        going = going._replace(time=jnp.zeros_like(going.time), arrived=there)
        going = jax.lax.while_loop(
            lambda going: jnp.any(_active(going)),
            lambda going: step(lanes, going, at),
            going,
        )
        strip = _strip_at(scene, at, at.length[None])[:, 0]
        limit, limit_lost = _limit_in(scene, at, strip)
        return OnTheWay(going, limit, limit_lost), report(lanes, going, at)

    after, found = jax.lax.scan(through, before, segments)
    return after, MassAtStops(*(jnp.moveaxis(column, 0, -1) for column in found))


def _active(going: _Going) -> Bool[Array, "..."]:
    return (going.code == 0) & ~going.arrived


def _tip_of(scene: MassiveScene, lane: MassiveLane, well: Real, origin: Real) -> MassiveTip:
    parts = scene.potential, scene.support, scene.load
    field = TipField(*parts, lane.eps, lane.viscosity, well=well, origin=origin)
    return MassiveTip(field, lane.mass)


def _stepped(
    scene: MassiveScene,
    lane: MassiveLane,
    going: _Going,
    at: _Stretch,
    with_suprema: bool,
) -> _Going:
    """One step, accepted or not; nothing where the lane has arrived or failed."""
    tip = _tip_of(scene, lane, going.well, at.start)
    wanted = step_of(going.control.level, lane.control.first_step)
    remaining = at.length - going.time
    cut = wanted >= remaining
    size = jnp.where(_active(going), jnp.minimum(wanted, remaining), wanted)
    step = step_with_mass(SETTINGS.tableau, tip, going.time, size, going.motion)
    moved = jnp.abs(step.end.tip - going.motion.tip)
    off = step.stages.tip[-1], lane.pause * step.stages.speed[-1]
    error = jnp.maximum(jnp.abs(off[0]), jnp.abs(off[1]))
    error = jnp.where(jnp.isfinite(step.end.speed), error, jnp.inf)
    verdict = judge(
        SETTINGS.tableau.order,
        lane.control,
        going.control,
        step=size,
        moved=moved,
        error=error,
        cut=cut,
    )
    good = verdict.accepted
    suprema = going.suprema
    if with_suprema:
        suprema = _widened(scene, tip, going, step, size, at)
    turns = jnp.round(step.end.tip)
    end = step.end._replace(tip=step.end.tip - turns)
    after = _Going(
        well=_where(good, going.well + turns, going.well),
        motion=_where(good, end, going.motion),
        time=jnp.where(good, jnp.where(cut, at.length, going.time + size), going.time),
        arrived=good & cut,
        control=verdict.after,
        suprema=_where(good, suprema, going.suprema),
        steps=going.steps + 1,
        rejected=going.rejected + ~good,
        code=_code(lane, going, size, error, good),
    )
    return _where(_active(going), after, going)


def _code(lane: MassiveLane, going: _Going, size: Real, error: Real, good: Any) -> Real:
    """Why a lane goes no further, 0 where it does."""
    lost = ~good & (going.time + size <= going.time)
    small = jnp.where(jnp.isfinite(error), Status.STEP_TOO_SMALL, Status.NOT_FINITE)
    spent = going.steps + 1 >= lane.budget
    return jnp.where(lost, small, jnp.where(spent, Status.MAX_STEPS, 0)).astype(float)


def _where(chosen: Any, new: Any, old: Any) -> Any:
    return jax.tree_util.tree_map(lambda a, b: jnp.where(chosen, a, b), new, old)


def _widened(
    scene: MassiveScene,
    tip: MassiveTip,
    going: _Going,
    step: MassiveStep,
    size: Real,
    at: _Stretch,
) -> SupremaSoFar:
    """SupremaSoFar with what a step shows at a few shares of it."""
    far, outside, apart = going.suprema
    strips = _strip_at(scene, at, going.time + jnp.asarray(SETTINGS.shares) * size)
    for share, strip in zip(SETTINGS.shares, strips.T, strict=True):
        y, lost = (
            dense_output(SETTINGS.tableau, before, end, list(stages), jnp.asarray(share))
            for before, end, stages in (
                (going.motion.tip, step.end.tip, step.stages.tip),
                (going.motion.lost, step.end.lost, step.stages.lost),
            )
        )
        z = tip.field.state(y)
        limit, limit_lost = _limit_in(scene, at, strip)
        far = jnp.maximum(far, jnp.abs(z - limit))
        outside = jnp.maximum(outside, jnp.maximum(strip[0] - z, z - strip[1]))
        apart = jnp.maximum(apart, jnp.abs(lost - limit_lost))
    return SupremaSoFar(far, outside, apart)


def _strip_at(scene: MassiveScene, at: _Stretch, times: Array) -> Float[Array, "2 n"]:
    """Lower and upper edge in m, times (n,) in s after a stretch starts.

    Searched for: a tip may be far from the edge at which the limit system is. (And three of
    Newton's steps written out, for the support of a function, are a program of gigabytes.)
    """
    loads = jax.vmap(scene.load)(at.start + times)
    held = jnp.stack([loads - scene.rho_plus, loads - scene.rho_minus])
    return scene.support.state_of(held)


def _limit_in(
    scene: MassiveScene, at: _Stretch, strip: Float[Array, "2"]
) -> tuple[Real, Real]:
    """State and dissipation of the limit system, in a strip with these edges.

    It is the play operator: on a stretch on which the load does not turn, one clip.
    """
    limit = jnp.clip(at.limit, *strip)
    way = limit - at.limit
    rho = jnp.where(way >= 0, scene.rho_plus, scene.rho_minus)
    return limit, at.limit_lost + rho * way


def _at_stop(
    scene: MassiveScene, lane: MassiveLane, going: _Going, at: _Stretch
) -> MassAtStops:
    tip = _tip_of(scene, lane, going.well, at.start)
    first = _tip_of(scene, lane, lane.well, at.start)
    none = jnp.zeros_like(lane.tip)
    before = first.energy(TipMotion(lane.tip, none, none, none))
    left = before + going.motion.work - tip.energy(going.motion) - going.motion.lost
    values = MassAtStops(
        z=tip.field.state(going.motion.tip),
        velocity=lane.eps * going.motion.speed,
        lost=going.motion.lost,
        left=left,
    )
    unknown = jnp.full_like(lane.tip, jnp.nan)
    return MassAtStops(*(jnp.where(going.code == 0, value, unknown) for value in values))
