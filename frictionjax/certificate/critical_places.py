"""Where the tip is when the rod is pressed by its critical load, and loads past that."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .._checks import Real, require
from .._compile import Program, in_chunks
from ..model import BristlePotential
from ..turning import SceneParts, compression
from .curve import Force
from .settings import SETTINGS

_Column = Float[np.ndarray, " k"]


class CriticalPlaces(NamedTuple):
    """Of a side, (k,), tips in periods: moved against the nap, to smaller y, the rod is
    pressed by its critical load and more from a `place` down to where it is `relieved`.

    Each `place` is the next above its `relieved`. At it `pull`: `V_eps'` in N; `slope`: its
    derivative in N/m; `share`: by how much it changes, in N, with the critical load.
    """

    relieved: _Column
    place: _Column
    pull: _Column
    slope: _Column
    share: _Column

    def beside(self, well: np.ndarray, inside: np.ndarray) -> "Beside":
        """Of tips at well + inside."""
        first = self.relieved[0]
        down = np.floor(inside - first)
        above = inside - first - down
        which = np.searchsorted(self.relieved - first, above, side="right") - 1
        which = np.maximum(which, 0)
        return Beside(well + down, which, inside - down <= self.place[which])


class Beside(NamedTuple):
    """The critical place that each of some tips comes to, (n,): in which `well`, `which` of
    them, and whether the tip is `past` it."""

    well: np.ndarray
    which: np.ndarray
    past: np.ndarray

    def at(self, rows: Any) -> "Beside":
        """Some of them."""
        return Beside(*(column[rows] for column in self))


def force_of_side(parts: SceneParts, side: int, eps: float) -> Force:
    """The driving force of a scene as seen from a side."""
    one = jnp.asarray(float(side))
    return Force(
        potential=parts.potential(one),
        support=parts.held(one),
        load=parts.pulled(one),
        eps=jnp.asarray(eps),
    )


def critical_places(force: Force, critical: float) -> CriticalPlaces:
    """Of a straight rod under a force of its side; `critical` load in N."""
    count = SETTINGS.places
    ends = np.linspace(0.0, 1.0, count + 1)[:-1]
    pressed = _pressed(force, ends) >= critical
    leaves, enters = (
        np.flatnonzero(pressed & ~np.roll(pressed, -1)),
        np.flatnonzero(~pressed & np.roll(pressed, -1)),
    )
    needs = "an eps at which the compression of the rod comes to its critical load"
    require(leaves.size > 0, "eps", float(force.eps), needs)
    relieved = np.array([_crossing(force, critical, ends[k]) for k in enters])
    found = np.array([_crossing(force, critical, ends[k]) for k in leaves])
    # The next one above, in the period of its own.
    ahead = np.min((found[None] - relieved[:, None]) % 1.0, axis=1)
    place = relieved + ahead
    pull, slope, share = _numbers(force, place)
    return CriticalPlaces(relieved, place, pull, slope, share * critical)


def overloads(
    force: Force, viscosity: float, places: CriticalPlaces, near: Beside, ts: np.ndarray
) -> np.ndarray:
    """By how much, in shares of the critical load, the load at times in s is past what
    brings a tip at rest to the place beside it; < 0 before.

    Of the load alone: errors of the state do not enter. The tip follows the load as fast as
    its equilibrium.
    """
    if ts.size == 0:
        return np.zeros(0)
    at = CriticalPlaces(*(column[near.which] for column in places))
    columns = ts, near.well, at.place, at.pull, at.slope, at.share
    fixed = force, jnp.asarray(viscosity)
    return in_chunks(_overloads, SETTINGS.steps, fixed, columns)


def _pressed(force: Force, y: np.ndarray) -> np.ndarray:
    return in_chunks(_compressions, SETTINGS.places, (force,), (y,))


def _crossing(force: Force, critical: float, low: float) -> float:
    """Where, a little above `low`, the compression passes the critical load."""
    high = low + 1 / SETTINGS.places
    for _ in range(SETTINGS.zooms):
        y = np.linspace(low, high, SETTINGS.places)
        pressed = _pressed(force, y) >= critical
        step = int(np.argmax(pressed != pressed[0]))
        low, high = y[max(step - 1, 0)], y[step]
    return 0.5 * (low + high)


@Program
def _compressions(force: Force, y: Array) -> Array:
    return jax.vmap(lambda one: _compression(force, one))(y)


def _compression(force: Force, y: Real) -> Real:
    assert isinstance(force.potential, BristlePotential)
    return compression(force.potential, y, force.eps)


def _numbers(force: Force, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return in_chunks(_forces, SETTINGS.places, (force,), (y,))


@Program
def _forces(force: Force, y: Array) -> tuple[Array, Array, Array]:
    """`V_eps'`, its slope by z, and its change with the compression."""

    def at(one: Real) -> tuple[Real, Real, Real]:
        def both(s: Real) -> tuple[Real, Real]:
            return force.pull(s)[0], _compression(force, s)

        (pull, _), (by_tip, pressed) = jax.jvp(both, (one,), (jnp.ones_like(one),))
        return pull, by_tip / force.stretch(one), jnp.abs(by_tip / pressed)

    return jax.vmap(at)(y)


@Program
def _overloads(force: Force, viscosity: Real, *columns: Array) -> Array:
    def at(t: Real, well: Real, y: Real, pull: Real, slope: Real, share: Real) -> Real:
        z = force.state(well, y)
        stiffness = force.support.stiffness_at(z) + slope
        speed = jnp.minimum(force.load.slope(t), 0.0) / stiffness
        speed = jnp.where(stiffness > 0, speed, 0.0)
        held = force.load(t) - force.support.force(z)
        return (pull + viscosity * speed - held) / share

    return jax.vmap(at)(*columns)
