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


def widen(
    extent: Extent, step: Real, gaps: tuple[Real, Real], slopes: tuple[Real, Real]
) -> Extent:
    """The extent after a step on which z - guide has these values and slopes at its ends.

    (Ends alone miss up to 0.005 eps where z turns between them.)
    """
    low, high = _extremes(step, gaps, slopes)
    return extent._replace(
        ahead=jnp.maximum(extent.ahead, high), behind=jnp.minimum(extent.behind, low)
    )


def leave(
    extent: Extent, step: Real, gaps: tuple[Real, Real], slopes: tuple[Real, Real]
) -> Extent:
    """The extent after a step at whose ends z is so far outside the strip (negative
    inside) and goes away so fast.
    """
    _, high = _extremes(step, gaps, slopes)
    return extent._replace(outside=jnp.maximum(extent.outside, high))


def spend(
    extent: Extent, step: Real, beyond: tuple[Real, Real], rates: tuple[Real, Real]
) -> Extent:
    """The extent after a step on which the dissipation beyond the guide's goes from one
    value (J) to the other, at these rates (W) at its ends.

    (Ends alone missed 7e-4 of all that two slips dissipate, after a short fast stretch of
    the load: at the top slips end while the guide goes on.)
    """
    low, high = _extremes(step, beyond, rates)
    return extent._replace(
        surplus=jnp.maximum(extent.surplus, high), deficit=jnp.minimum(extent.deficit, low)
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
