"""Steps at folds, where forces cancel to their rounding.

Stiffly accurate methods damp whatever changes much within a step, growth as well as decay:
of a tip that rests just past a fold they make one that follows the unstable branch, with
errors estimated as nothing. Where a load turned just as a fold was reached and rounding put
the tip past it, at eps = 1e-12, the branch was followed for 0.25 s in steps of up to 1e22
times its own time. And within 1e-8 periods of a fold errors of steps are those of rounding,
whatever the step: at eps = 1e-11, gamma = 2 tips stayed there in steps shorter than the
spacing of floats at t.
"""

from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Bool

from ..._checks import Real
from ..equation import Point
from .settings import SETTINGS


class Foothold(NamedTuple):
    """Where a step of `step` s starts, and how far the velocity there is rounding.

    `drag`: N over periods a second; `width` (N) of the wiggly force; `noise`: periods a
    second.
    """

    step: Real
    point: Point
    drag: Real
    width: Real
    noise: Real

    def overgrown(self) -> Real:
        """How many times too long the step is for how fast it leaves an unstable branch.

        A tip that nothing moves off such a branch, not even the load, stays.
        """
        moves = (self.point.velocity != 0) | (self.point.by_time != 0)
        return jnp.where(moves, self.step / SETTINGS.most_folds * self.point.by_state, 0.0)

    def uneven(self, end: Point, way: Real, pace: Real, tolerance: Real) -> Real:
        """How many times too far the `way` (periods) of a slow tip that speeds up is off.

        Off the mean of the velocities at both ends: errors are estimated by a difference,
        which may vanish where they do not. `pace`, `tolerance`: as in `Control`.
        """
        before, after, mean = self.point.velocity, end.velocity, way / self.step
        off = jnp.abs(0.5 * (before + after) * self.step - way)
        speeds_up = (mean * before >= before**2) & (mean * after >= mean**2)
        told = speeds_up & (jnp.abs(after) < pace)
        told &= off < SETTINGS.sudden * jnp.abs(way)
        return jnp.where(told, off / (SETTINGS.uneven * jnp.abs(way) + tolerance), 0.0)

    def resolves(self, end: Point) -> Bool[Array, ""]:
        """Whether the step shows a slip that it ends in, or leaves little of its energy.

        Steps into slips that are over in 1e-6 of them left 18 slips' energy as residual.
        """
        left = 0.5 * self.drag * end.velocity**2 * self.step
        return (self.step * end.by_state < SETTINGS.most_folds) | (
            left < SETTINGS.left * self.width
        )

    def velocity(self) -> Real:
        """That of the point, on unstable branches not 0 by rounding.

        Where forces cancel to nothing a tip would wait in steps of its branch's own time,
        1e8 of them, until the load has changed by a rounding. It leaves to where the load
        draws it. (Pushed where they cancel to little, tips went to and fro at folds that
        little lifted them over.)
        """
        lost = (self.point.by_state > 0) & (self.point.velocity == 0)
        push = 2 * jnp.sign(self.point.by_time) * self.noise
        return jnp.where(lost, push, self.point.velocity)

    def beyond_rounding(self, error: Real, end: Point) -> Real:
        """What of the error of the step (periods) is not due to rounding of forces.

        Rounding moves the tip until a branch holds it, the steeper one at either end. (By
        the slope at the start, steps from a fold itself went anywhere: residuals of single
        slips were 20 times the slip's energy.)
        """
        slope = jnp.maximum(jnp.abs(self.point.by_state), jnp.abs(end.by_state))
        return jnp.maximum(error - self.noise * self.step / (1 + self.step * slope), 0.0)


def foothold(step: Real, point: Point, time: Real, drag: Real, width: Real) -> Foothold:
    """Of a step from a `point` at the `time` (s).

    The wiggly force, the load and the support's cancel, and times round too.
    """
    forces = jnp.abs(point.load) + width + jnp.abs(point.by_time * time) * drag
    return Foothold(step, point, drag, width, SETTINGS.rounding * forces / drag)


def pause_of(point: Point, time: Real, drag: Real) -> Real:
    """How long in s a tip stays where forces cancel to nothing: until floats go on.

    Those at t, or of the load, which near its turning points take 1e5 times as long. 0
    where it does not stay. Steps 1e-10 of that long were all that some tips found at a
    fold, gamma = 2, eps = 5e-14, where |z| was 0.1 m.
    """
    rests = (point.velocity == 0) & (point.by_state <= 0)
    rate = jnp.maximum(jnp.abs(point.by_time) * drag, 1e-300)
    of_load = 0.5 * SETTINGS.spacing * jnp.abs(point.load) / rate
    since = jnp.abs(time)
    pause = jnp.clip(of_load, SETTINGS.spacing * since, SETTINGS.longest_pause * since)
    return jnp.where(rests, pause, 0.0)
