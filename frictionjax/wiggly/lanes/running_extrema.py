"""How far a curve strays from its guide over one step."""

from typing import NamedTuple

import jax.numpy as jnp

from ..._checks import Real
from ...numerics import cubic, cubic_slope


class Guide(NamedTuple):
    """A cubic in time over one leg, in m: the strip's edge, or the state at rest.

    `start` (s), `length` (s), `value` at the start, `rise` (m), slopes at both ends (m/s).
    `friction`: what it dissipates, in N per m of its way.
    """

    start: Real
    length: Real
    value: Real
    rise: Real
    slope0: Real
    slope1: Real
    friction: Real

    def way(self, t: Real) -> Real:
        """How far it has come at time `t`, in m."""
        return cubic((t - self.start) / self.length, *self._ends())

    def slope(self, t: Real) -> Real:
        """How fast it moves at time `t`, in m/s."""
        return cubic_slope((t - self.start) / self.length, *self._ends()) / self.length

    def _ends(self) -> tuple[Real, Real, Real]:
        """The rise, and the slopes at both ends over all of the length, in m."""
        return self.rise, self.slope0 * self.length, self.slope1 * self.length

    def __call__(self, t: Real) -> Real:
        return self.value + self.way(t)


class Extent(NamedTuple):
    """Extremes so far of z - guide, of the way from the strip to z, negative inside (m),
    and of the dissipation beyond the guide's (J)."""

    ahead: Real
    behind: Real
    outside: Real
    surplus: Real
    deficit: Real


class StepCurve(NamedTuple):
    """Values of a curve at both ends of a step, and slopes (a second)."""

    ends: tuple[Real, Real]
    slopes: tuple[Real, Real]


def widened(
    extent: Extent, step: Real, apart: StepCurve, outside: StepCurve, beyond: StepCurve
) -> Extent:
    """The extent after a step of z - guide, of the way from the strip and of the
    dissipation beyond the guide's.

    (Ends alone miss up to 0.005 eps where z turns between them, and 7e-4 of all that two
    slips dissipate, after a short fast stretch of the load: at the top slips end while the
    guide goes on.)
    """
    behind, ahead = _extremes(step, *apart)
    _, farthest = _extremes(step, *outside)
    deficit, surplus = _extremes(step, *beyond)
    return Extent(
        ahead=jnp.maximum(extent.ahead, ahead),
        behind=jnp.minimum(extent.behind, behind),
        outside=jnp.maximum(extent.outside, farthest),
        surplus=jnp.maximum(extent.surplus, surplus),
        deficit=jnp.minimum(extent.deficit, deficit),
    )


def _extremes(
    step: Real, ends: tuple[Real, Real], slopes: tuple[Real, Real]
) -> tuple[Real, Real]:
    """Smallest and largest value over a step of the cubic with these ends and slopes."""
    rise = ends[1] - ends[0]
    ways = step * slopes[0], step * slopes[1]
    first, last = ways[0] - rise, ways[1] - rise
    # Where the cubic's derivative, a s^2 + b s + c, is zero.
    a, b, c = 3 * (first + last), -2 * (2 * first + last), first + rise
    root = jnp.sqrt(jnp.maximum(b * b - 4 * a * c, 0.0))
    q = -0.5 * (b + jnp.where(b >= 0, root, -root))
    low, high = jnp.minimum(*ends), jnp.maximum(*ends)
    # No arc that bends one way leaves the tangents at its ends; the cubic does where a
    # step runs from a slip far into the rest behind it, by 0.1 eps at gamma = 2.
    sizes = jnp.abs(ways[0]), jnp.abs(ways[1])
    top_most = jnp.minimum(ends[0] + sizes[0], ends[1] + sizes[1])
    bottom_most = jnp.maximum(ends[0] - sizes[0], ends[1] - sizes[1])
    for top, bottom in ((q, a), (c, q)):
        inside = (top * bottom > 0) & (jnp.abs(top) < jnp.abs(bottom))
        s = jnp.where(inside, top / jnp.where(inside, bottom, 1.0), 0.0)
        value = ends[0] + cubic(s, rise, *ways)
        high = jnp.maximum(high, jnp.minimum(value, top_most))
        low = jnp.minimum(low, jnp.maximum(value, bottom_most))
    return low, high
