"""The force of a steady slide over one period of the load, and over many bristles."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ..._checks import Real, require
from ..._compile import Program
from ...model import AbstractPotential
from ...wiggly import RODAS5P, Status, dense_output
from .periodic_orbit import (
    SlideScene,
    find_periodic_orbit,
    least_pull,
    rise_to_turn,
    slide_step,
)
from .settings import SETTINGS
from .slide_sides import Sides, slide_scene

_KNOTS = SETTINGS.knots
_X, _W = np.polynomial.legendre.leggauss(4)
_SHARES = 0.5 * (_X + 1)


class SlideCurve(NamedTuple):
    """Straight lines between `force` (N, in the direction of motion) at `share`s of the
    load's period, from 0 to 1; `closed`: of the period, how far times add up to it."""

    share: Float[np.ndarray, " knots"]
    force: Float[np.ndarray, " knots"]
    closed: float

    def of_many(self, phases: Float[np.ndarray, " n"]) -> "SlideCurve":
        """The mean of the curves of bristles that are `phases` of a period ahead.

        Exact: a sum of straight lines bends where one of them does.
        """
        slope = np.diff(self.force) / np.diff(self.share)
        bend = (slope - np.roll(slope, 1)) / phases.size
        places = (self.share[:-1, None] - phases) % 1.0
        order = np.argsort(places, axis=None)
        share = np.concatenate([[0.0], places.ravel()[order], [1.0]])
        bends = np.append(0.0, np.cumsum(np.repeat(bend, phases.size)[order]))
        # The first slope is the one with which it ends where it began.
        gained = bends * np.diff(share)
        rise = np.cumsum(gained - np.sum(gained) * np.diff(share))
        begin = float(np.mean(np.interp(phases % 1.0, self.share, self.force)))
        return SlideCurve(share, begin + np.append(0.0, rise), self.closed)


def array_peaks(
    table: AbstractPotential,
    eps: float,
    numbers: tuple[float, float, float],
    phases: Float[np.ndarray, " n"],
) -> tuple[Float[np.ndarray, " 2"], Float[np.ndarray, " 2"]]:
    """Largest mean force of bristles at `phases` in slides to the right and to the left,
    and what their curves may be off, in N. `numbers`: gamma, rate and stiffness.

    Bristle i feels `V_eps(z + eps phase)`: the slide of one, `phase` of the load's period
    earlier or later, as the load rises or falls.
    """
    curves = slide_curves(table, eps, *numbers)
    signs = np.array([1.0, -1.0])
    together = [c.of_many(s * phases) for c, s in zip(curves, signs, strict=True)]
    peaks = signs * [np.max(curve.force) for curve in together]
    return peaks, numbers[-1] * eps * np.array([curve.closed for curve in curves])


def with_peaks(
    one: Sides, peak: Float[np.ndarray, "*slides"], off: Float[np.ndarray, "*slides"]
) -> Sides:
    """Slides of arrays: forces of one bristle, but these peaks, off by so much at most, N.

    Where that is more than 1e-5 of a force the code is `STEP_TOO_SMALL`.
    """
    code, mean = np.asarray(one.code), np.abs(np.asarray(one.mean))
    rough = (code == int(Status.OK)) & ~(off <= SETTINGS.added * mean)
    code = np.where(rough, int(Status.STEP_TOO_SMALL), code)
    return one._replace(peak=jnp.asarray(peak), code=jnp.asarray(code))


def require_bristles(phases: Float[np.ndarray, " n"]) -> None:
    """Raise `ValueError` for more bristles than curves are summed of."""
    most = f"at most {SETTINGS.bristles} bristles; fewer at random phases ripple as these"
    name = "effects.CompliantArray.offsets: number of bristles"
    require(phases.size <= SETTINGS.bristles, name, phases.size, most)


def slide_curves(
    table: AbstractPotential, eps: float, gamma: float, rate: float, stiffness: float
) -> tuple[SlideCurve, SlideCurve]:
    """Of slides to the right and to the left, of a known potential in a table."""
    numbers = (jnp.asarray(float(v)) for v in (eps, gamma, rate, stiffness))
    found = [np.asarray(column) for column in _curves(table, *numbers)]
    give = stiffness * eps
    times, forces, starts = found
    right, left = (_curve(times[i], forces[i], starts[i], give) for i in (0, 1))
    return right, left


def _curve(
    times: Float[np.ndarray, "steps knots"],
    forces: Float[np.ndarray, "steps knots"],
    start: Float[np.ndarray, ""],
    give: float,
) -> SlideCurve:
    ahead = np.append(0.0, np.cumsum(times.ravel()))
    force = np.append(start, forces.ravel())
    there = np.append(True, np.diff(ahead) > 0)
    share = ahead[there] / ahead[-1]
    force = force[there]
    force[-1] = force[0]
    return SlideCurve(share, force, float(abs(ahead[-1] / give - 1)))


@Program
def _curves(
    table: AbstractPotential, eps: Real, gamma: Real, rate: Real, stiffness: Real
) -> tuple[Array, Array, Array]:
    """Of both directions: what the load gains (N) up to each knot of each step from the one
    before, the force (N) there, and at the start."""

    def one(sign: Real) -> tuple[Array, Array, Array]:
        slide, _ = least_pull(slide_scene(table, eps, gamma, rate, stiffness, sign))
        return _knots(slide)

    return jax.lax.map(one, jnp.array([1.0, -1.0]))


def _knots(slide: SlideScene) -> tuple[Array, Array, Array]:
    """`rate dt = c G/D dx` over the parts of each step, and `f = U + D`."""
    period = find_periodic_orbit(slide)
    turn = jnp.log(slide.pull / slide.give)

    def along(
        state: tuple[Array, Array], size: Array
    ) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        way, level = state
        there = size > 0
        safe = jnp.where(there, size, 1e-3)
        x = period.start + way
        new, stages = slide_step(slide, x, safe, level)
        even = jnp.arange(1, _KNOTS + 1) / _KNOTS
        ends = jnp.sort(jnp.append(even, rise_to_turn(level, new, turn)))
        begins = jnp.append(0.0, ends[:-1])
        inside = begins[:, None] + (ends - begins)[:, None] * _SHARES[None]
        drives = jnp.exp(dense_output(RODAS5P, level, new, stages, inside))
        _, stretches = jax.vmap(jax.vmap(slide.ground))(x + size * inside)
        widths = 0.5 * size * (ends - begins)
        gained = slide.pull * widths * jnp.sum(_W[None] * stretches / drives, axis=1)
        grounds, _ = jax.vmap(slide.ground)(x + size * ends)
        forces = grounds + jnp.exp(dense_output(RODAS5P, level, new, stages, ends))
        new = jnp.where(there, new, level)
        return (way + size, new), (jnp.where(there, gained, 0.0), forces)

    begin = (jnp.zeros(()), period.level)
    _, rows = jax.lax.scan(along, begin, period.steps)
    gained, forces = rows
    height, _ = slide.ground(period.start)
    return gained, forces, height + jnp.exp(period.level)
