"""Straight flanks with rounded corners."""

from typing import Any, ClassVar, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from .._checks import (
    Asked,
    Real,
    as_real,
    is_known,
    known_numbers,
    no_more,
    require,
    require_real,
)
from .profile import AbstractProfile
from .settings import SETTINGS


class Corners(NamedTuple):
    """What a polyline looks like around each of its points, arrays of shape (n,).

    `ends`: of the zones that belong to a point, in the middle of what is straight of the
    flank after it. `before`, `turn`: slope of the flank before the point, and by how much
    the next is larger. `width`: of the corner, half of it on either side of the point.
    `straight`: what two corners leave of the flank after the point.
    """

    ends: Any
    before: Any
    turn: Any
    width: Any
    straight: Any


class Polyline(AbstractProfile):
    """Straight flanks between points, with rounded corners: the surface that people cut.

    `x`: positions in periods, shape (n,), n >= 2, increasing in [0, 1); the point x = 1 is
    the first one again and is not repeated. `heights`: in periods, shape (n,). `radius`:
    of curvature in the middle of every corner, `(1 + w'^2)^(3/2) / abs(w'')`, in periods.

    In a corner w' goes from one flank's slope to the next one's as `3 t^2 - 2 t^3`, over
    `1.5 radius abs(turn) / (1 + mean^2)^(3/2)` of y centred on the point (`turn`, `mean`:
    difference and mean of the two slopes). So w is C^2, abs(w'') is largest in the middle,
    flanks lie where the straight lines are, and the steepest slopes are exactly theirs.
    (An arc of a circle: w'' jumps at its ends. A step of degree 5: nothing here asks for
    more than C^2, and corners of that radius are a quarter wider.)

    Raises `ValueError` for fewer than 2 points, shapes that differ, x that does not
    increase in [0, 1), values that are not finite, heights that are all equal, and a
    radius that is not positive or whose corners overlap, with the largest one that fits.

    >>> ratchet = fx.profiles.Polyline([0.0, 0.8], [0.0, 0.05], radius=0.02)
    >>> law = fx.friction(ratchet, scene.bristle)
    >>> print(f"slopes from {law.omega_minus:.4f} to {law.omega_plus:.4f}")
    slopes from -0.2500 to 0.0625
    """

    asked: ClassVar = {
        "x": Asked("periods", "a list of 2 or more, increasing, in [0, 1)", row=True),
        "heights": Asked("periods", "a list as long as x, not all equal", row=True),
        "radius": Asked("periods", "> 0, so that corners do not overlap"),
    }

    x: Float[Array, " n"]
    heights: Float[Array, " n"]
    radius: Real
    points: int = eqx.field(static=True, default=SETTINGS.unseen)

    def __init__(self, x: Any, heights: Any, radius: Any):
        self.x, self.heights, self.radius = as_real(x), as_real(heights), as_real(radius)
        if is_known(self.x, self.heights, self.radius):
            _require_points(self.x, self.heights)
            require_real("profile.radius", self.radius, "radius > 0", lambda r: r > 0)
            known = [np.asarray(v) for v in (self.x, self.heights, self.radius)]
            found = _corners(known[0], known[1], known[2], np)
            _require_room(found, float(self.radius))
            self.points = _resolving(found)

    def corners(self) -> Corners:
        """What it looks like around each of its points, NumPy arrays."""
        x, heights = np.asarray(self.x), np.asarray(self.heights)
        return _corners(x, heights, np.asarray(self.radius), np)

    def __call__(self, y: Float[ArrayLike, "*shape"]) -> Float[Array, "*shape"]:
        corners = _corners(self.x, self.heights, self.radius, jnp)
        y = jnp.asarray(y)
        y = y - jnp.floor(y)
        # The last zone ends where the first begins, a little before or after y = 1.
        y = jnp.where(y >= corners.ends[-1], y - 1, y)
        y = jnp.where(y < corners.ends[-1] - 1, y + 1, y)
        # (All corners added up: 2.4 times the time for 4 points, 12 times for 32.)
        ends = jax.lax.broadcast_to_rank(corners.ends[:-1], y.ndim + 1)
        zone = jnp.sum(y[..., None] >= ends, axis=-1)
        width = jnp.maximum(corners.width, SETTINGS.narrowest)[zone]
        along = y - self.x[zone]
        share = along / width + 0.5
        t = jnp.clip(share, 0.0, 1.0)
        risen = t**3 * (1 - 0.5 * t) + jnp.maximum(share - 1, 0.0)
        turned = corners.turn[zone] * width * risen
        return self.heights[zone] + corners.before[zone] * along + turned


def _corners(x: Any, heights: Any, radius: Any, xp: Any) -> Corners:
    gaps = xp.append(x[1:], x[:1] + 1) - x
    after = (xp.roll(heights, -1) - heights) / gaps
    before = xp.roll(after, 1)
    turn, mean = after - before, 0.5 * (after + before)
    width = 1.5 * radius * xp.abs(turn) / ((1 + mean**2) * xp.sqrt(1 + mean**2))
    half = 0.5 * width
    straight = gaps - half - xp.roll(half, -1)
    return Corners(x + half + 0.5 * straight, before, turn, width, straight)


def _resolving(corners: Corners) -> int:
    """Samples a period, a power of 2: another radius seldom needs another program."""
    rounded = corners.width[corners.width > SETTINGS.narrowest]
    narrowest = min(rounded.min(), (corners.straight + corners.width).min())
    size = max(narrowest, SETTINGS.thinnest)
    wanted = 2 ** int(np.ceil(np.log2(SETTINGS.a_corner / size)))
    return int(np.clip(wanted, SETTINGS.fewest, SETTINGS.most))


def _require_points(given_x: Any, given_heights: Any) -> None:
    x, heights = known_numbers(given_x), known_numbers(given_heights)
    enough = x.ndim == 1 and x.size >= 2
    require(enough, "profile.x", given_x, "2 or more positions, shape (n,)")
    same = heights.shape == x.shape
    require(same, "profile.heights", given_heights, f"shape {x.shape} of x")
    require(np.all(np.isfinite(x)), "profile.x", x, "finite positions")
    require(np.all(np.isfinite(heights)), "profile.heights", heights, "finite heights")
    require(np.all(np.diff(x) > 0), "profile.x", x, "increasing positions")
    again = bool(x[-1] == x[0] + 1)
    needs = "0 <= x < 1: the point x = 1 is the first one again and is not repeated"
    require(not again and x[-1] < 1 and x[0] >= 0, "profile.x", x, needs)
    require(np.ptp(heights) > 0, "profile.heights", heights, "heights that vary")


def _require_room(corners: Corners, radius: float) -> None:
    half = 0.5 * corners.width
    taken = np.maximum(half + np.roll(half, -1), SETTINGS.narrowest)
    largest = radius * float(np.min(1 + corners.straight / taken))
    needs = f"radius <= {no_more(largest)}, or the corners of a flank overlap"
    require(radius <= largest * (1 + 1e-12), "profile.radius", radius, needs)
