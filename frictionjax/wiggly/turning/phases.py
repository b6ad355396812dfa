"""One phase of a rod that turns over: a slide, or a turning, to its end or to a stop."""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool

from ..._checks import Real
from ..._compile import Program
from ...turning import BentForce, SceneParts, compression
from ..equation import (
    Balance,
    Driven,
    Point,
    Status,
    TipField,
    advance,
    arrival,
    at_rest,
    dissipated,
    slopes_between,
)
from ..rosenbrock import Linearised, rosenbrock_step
from ..stepping import Control, ControlState, judge, step_of
from .settings import SETTINGS


class Begun(NamedTuple):
    """Where a phase starts: `origin` in s, `well`, and `place` in periods from it; `stop`
    in s from there; its step control, the level of its steps, and its budget of them."""

    origin: Any
    well: Any
    place: Any
    stop: Any
    control: Control
    level: Any
    budget: Any


class Ended(NamedTuple):
    """Where it ends: `time` in s since its start, `place`; `out`: the end of its range by
    which it has left, -1 or 1, or 0. `lost` and `viscous`: the energy dissipated (J) from
    energies and as a sum; `residual`: see `Balance`."""

    time: Any
    place: Any
    out: Any
    lost: Any
    viscous: Any
    residual: Any
    level: Any
    steps: Any
    rejected: Any
    code: Any


class Steps(NamedTuple):
    """Steps that were made, (room,), the first `count` of them: when each ends, in s since
    the start of its phase, where (m), with which slopes it begins and ends (m/s), and the
    energy dissipated by then (J). Of its side's state."""

    count: Any
    time: Any
    state: Any
    slope0: Any
    slope1: Any
    lost: Any


class TurningField(TipField):
    """A root over its pinned tip: `eps^gamma z' = l - Phi'(z) - U'(x)`, `x = z - above`.

    The same equation with the energy of the rod in between as the potential; `y` is the
    state z in eps. `above`: z in m where the root is above the tip.
    """

    rod: BentForce = None  # type: ignore[assignment]  # fields before it have defaults
    above: Any = 0.0

    def ahead(self, y: Real) -> Real:
        """How far the root is ahead of the tip, in m."""
        return self.eps * (self.well + y) - self.above

    def state(self, y: Real) -> Real:
        return self.eps * (self.well + y)

    def driven(self, t: Real, y: Real) -> Driven:
        load, state = self.load(self.origin + t), self.state(y)
        force = load - self.support.force(state) - self.rod.force(self.ahead(y))
        return Driven(force, jnp.ones_like(y), state, load)

    def energy(self, t: Real, y: Real) -> Real:
        z = self.state(y)
        held = self.support.energy(z) - self.load(self.origin + t) * z
        return held + self.rod.energy(self.ahead(y))


RangeEnds = Callable[[Real], tuple[Real, Real]]
"""Of a place: by how much it is past the lower end and past the upper one."""


class _March(NamedTuple):
    """On the way; `length`: of the step on which the phase ends, where `out` is not 0."""

    time: Real
    place: Real
    point: Point
    control: ControlState
    sums: Balance
    out: Real
    length: Real
    steps: Real
    rejected: Real
    code: Real


@Program
def slide(
    parts: SceneParts, eps: Real, viscosity: Real, side: Real, begun: Begun
) -> tuple[Ended, Steps]:
    """With the rod straight, `place` the tip's, until it has to turn over.

    That is where the compression has come to the critical load while the root moves
    against the nap. It ends too where there is no room to note more steps.
    """
    potential = parts.potential(side)
    field = TipField(
        potential,
        parts.held(side),
        parts.pulled(side),
        eps,
        viscosity,
        well=begun.well,
        origin=begun.origin,
    )
    never = jnp.full_like(eps, -1.0)

    def ends(y: Real) -> tuple[Real, Real]:
        return compression(potential, y, eps) - parts.critical, never

    return _through(field, ends, begun)


@Program
def turn(
    parts: SceneParts,
    eps: Real,
    viscosity: Real,
    rod: BentForce,
    above: Real,
    begun: Begun,
) -> tuple[Ended, Steps]:
    """With the rod bent over its pinned tip, `place` the state z in eps."""
    field = TurningField(
        parts.potential(jnp.ones_like(eps)),
        parts.support,
        parts.load,
        eps,
        viscosity,
        well=begun.well,
        origin=begun.origin,
        rod=rod,
        above=above,
    )

    def ends(y: Real) -> tuple[Real, Real]:
        ahead = field.ahead(y)
        return -ahead - rod.reach, ahead - rod.reach

    return _through(field, ends, begun)


def _through(field: TipField, ends: RangeEnds, begun: Begun) -> tuple[Ended, Steps]:
    zero = jnp.zeros_like(begun.place)
    march = _March(
        time=zero,
        place=begun.place,
        point=field.point(zero, begun.place),
        control=ControlState(begun.level, zero),
        sums=at_rest(),
        out=zero,
        length=zero,
        steps=zero,
        rejected=zero,
        code=zero,
    )
    none = jnp.zeros(SETTINGS.room)
    room = Steps(jnp.zeros((), int), none, none, none, none, none)
    before = field.energy(zero, begun.place)

    def goes_on(carry: tuple[_March, Steps]) -> Bool[Array, ""]:
        march, noted = carry
        ended = (march.out != 0) | (march.code != 0)
        # A place is left for the step on which the phase ends.
        return (march.time < begun.stop) & ~ended & (noted.count < SETTINGS.room - 1)

    def one_more(carry: tuple[_March, Steps]) -> tuple[_March, Steps]:
        march, noted = carry
        after = _stepped(field, ends, begun, march)
        return after, _noted(field, before, noted, march, after)

    march, noted = jax.lax.while_loop(goes_on, one_more, (march, room))
    last = jax.lax.cond(
        march.out != 0, lambda m: _located(field, ends, m), lambda m: m, march
    )
    noted = _noted(field, before, noted, march, last)
    lost = dissipated(field, last.sums, last.time, last.place, before)
    ended = Ended(
        time=last.time,
        place=last.place,
        out=last.out,
        lost=lost,
        viscous=last.sums.viscous,
        residual=last.sums.residual,
        level=last.control.level,
        steps=last.steps,
        rejected=last.rejected,
        code=last.code,
    )
    return ended, noted


def _noted(
    field: TipField, before: Real, noted: Steps, start: _March, end: _March
) -> Steps:
    """With the step from `start` to `end`; where there is none its place is still free."""
    length, at = end.time - start.time, noted.count
    whole = jnp.where(length > 0, length, 1.0)
    way = end.place - start.place
    slope0, slope1, _ = slopes_between(start.point, end.point, whole, way)
    return Steps(
        count=at + (length > 0),
        time=noted.time.at[at].set(end.time),
        state=noted.state.at[at].set(end.point.state),
        slope0=noted.slope0.at[at].set(field.eps * start.point.stretch * slope0),
        slope1=noted.slope1.at[at].set(field.eps * end.point.stretch * slope1),
        lost=noted.lost.at[at].set(
            dissipated(field, end.sums, end.time, end.place, before)
        ),
    )


def _step(field: TipField, march: _March, length: Real) -> tuple[Real, tuple]:
    start = Linearised(*march.point[:3])
    args = start, march.time, length, march.place
    return rosenbrock_step(SETTINGS.tableau, field.velocity, *args)


def _out(ends: RangeEnds, before: Real, after: Real) -> Real:
    """By which end a step leaves: only one that it moves towards."""
    low, high = ends(after)
    down = (low >= 0) & (after < before)
    up = (high >= 0) & (after > before)
    return jnp.where(down, -1.0, jnp.where(up, 1.0, 0.0))


def _arrived(
    field: TipField, march: _March, length: Real, place: Real, time: Real
) -> _March:
    end = field.point(time, place)
    seen = arrival(field, march.time, length, end)
    sums = advance(
        field, march.sums, march.time, length, march.place, place, march.point, seen
    )
    return march._replace(time=time, place=place, point=end, sums=sums)


def _stepped(field: TipField, ends: RangeEnds, begun: Begun, march: _March) -> _March:
    wanted = step_of(march.control.level, begun.control.first_step)
    left = begun.stop - march.time
    cut = wanted >= left
    length = jnp.minimum(wanted, left)
    place, stages = _step(field, march, length)
    verdict = judge(
        SETTINGS.tableau.order,
        begun.control,
        march.control,
        step=length,
        moved=jnp.abs(place - march.place),
        error=jnp.abs(stages[-1]),
        cut=cut,
    )
    out = jnp.where(verdict.accepted, _out(ends, march.place, place), 0.0)
    goes_on = verdict.accepted & (out == 0)
    time = jnp.where(cut, begun.stop, march.time + length)
    there = _where(goes_on, _arrived(field, march, length, place, time), march)
    return there._replace(
        control=_where(out == 0, verdict.after, march.control),
        out=out,
        length=length,
        steps=march.steps + 1,
        rejected=march.rejected + ~verdict.accepted,
        code=_code(begun, march, length, stages[-1], verdict.accepted),
    )


def _located(field: TipField, ends: RangeEnds, march: _March) -> _March:
    """The step that leaves, as short as it may be."""

    def halve(_: Any, sides: tuple[Real, Real]) -> tuple[Real, Real]:
        inside, outside = sides
        middle = 0.5 * (inside + outside)
        place, _ = _step(field, march, middle)
        gone = _out(ends, march.place, place) != 0
        return jnp.where(gone, inside, middle), jnp.where(gone, middle, outside)

    sides = jnp.zeros_like(march.length), march.length
    _, length = jax.lax.fori_loop(0, SETTINGS.halvings, halve, sides)
    place, _ = _step(field, march, length)
    return _arrived(field, march, length, place, march.time + length)


def _code(
    begun: Begun, march: _March, length: Real, error: Real, accepted: Bool[Array, ""]
) -> Real:
    """Why it goes no further, 0 where it does."""
    lost = ~accepted & (begun.origin + march.time + length <= begun.origin + march.time)
    small = jnp.where(jnp.isfinite(error), Status.STEP_TOO_SMALL, Status.NOT_FINITE)
    spent = march.steps + 1 >= begun.budget
    return jnp.where(lost, small, jnp.where(spent, Status.MAX_STEPS, 0)).astype(float)


def _where(chosen: Any, new: Any, old: Any) -> Any:
    return jax.tree_util.tree_map(lambda a, b: jnp.where(chosen, a, b), new, old)
