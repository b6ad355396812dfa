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
from .forces import Force
from .settings import SETTINGS

_Column = Float[np.ndarray, " k"]


class CriticalPlaces(NamedTuple):
    """Of a side, (k,), tips in periods: moved against the nap, to smaller y, the rod is
    pressed by its critical load and more from a `place` down to where it is `relieved`.

    Each `place` is the next above its `relieved`. At it `pull`: `V_eps'` in N; `share`: by
    how much it changes, in N, with the critical load. `slopes` in N/m and `ways` in m, < 0,
    (k, steps): its derivative at the ends of steps that come to it, and how long they are.
    """

    relieved: _Column
    place: _Column
    pull: _Column
    share: _Column
    slopes: np.ndarray
    ways: np.ndarray

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


class RodSide(NamedTuple):
    """A straight rod as seen from a `side`, 1 or -1: see `turning.sides`. `shift` in m."""

    side: int
    force: Force
    places: CriticalPlaces
    shift: float

    @classmethod
    def of(cls, parts: SceneParts, side: int, eps: float) -> "RodSide":
        """Raises `ValueError` for an eps at which nothing turns it over."""
        one = jnp.asarray(float(side))
        force = Force(
            potential=parts.potential(one),
            support=parts.held(one),
            load=parts.pulled(one),
            eps=jnp.asarray(eps),
        )
        places = critical_places(force, float(parts.critical))
        return cls(side, force, places, (1 - side) * float(parts.reach))

    def seen(self, z: Any) -> Any:
        """A state of this side, in m."""
        return self.side * (z + self.shift)

    def beside(self, z: np.ndarray) -> Beside:
        """The critical places that tips come to at states in m."""
        fixed, columns = (self.force,), (self.seen(z),)
        return self.places.beside(*in_chunks(_tips, SETTINGS.steps, fixed, columns))

    def overloads(self, viscosity: float, near: Beside, ts: np.ndarray) -> np.ndarray:
        """By how much, in shares of the critical load, the load at times in s is past what
        brings a tip at rest to the place beside it; < 0 before.

        Of the load alone: errors of the state do not enter. The tip follows the load as it
        does once it has forgotten its start.
        """
        if ts.size == 0:
            return np.zeros(0)
        fixed = self.force, jnp.asarray(viscosity), self.places
        columns = ts, near.well, near.which
        return in_chunks(_overloads, SETTINGS.steps, fixed, columns)

    def standing_at(self, well: float, y: float) -> float:
        """The state in m with the tip at well + y of this side."""
        state = float(_state(self.force, np.asarray(well), np.asarray(y)))
        return self.side * state - self.shift

    def surface_at(self, y: float) -> float:
        """Its height in m under a tip at y of this side."""
        return float(_height(self.force, np.asarray(y)))


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
    pull, _, _, share = _numbers(force, place)
    back = np.linspace(SETTINGS.approach, 0.0, SETTINGS.approaching)
    coming = place[:, None] + back
    _, slopes, stretches, _ = (
        column.reshape(coming.shape) for column in _numbers(force, coming.ravel())
    )
    ways = stretches * (back[1] - back[0])
    return CriticalPlaces(relieved, place, pull, share * critical, slopes, ways)


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
def _tips(force: Force, z: Array) -> tuple[Array, Array]:
    return jax.vmap(force.tip)(z)


@Program
def _state(force: Force, well: Real, y: Real) -> Real:
    return force.state(well, y)


@Program
def _height(force: Force, y: Real) -> Real:
    assert isinstance(force.potential, BristlePotential)
    return force.eps * force.potential.profile(y)


@Program
def _compressions(force: Force, y: Array) -> Array:
    return jax.vmap(lambda one: _compression(force, one))(y)


def _compression(force: Force, y: Real) -> Real:
    assert isinstance(force.potential, BristlePotential)
    return compression(force.potential, y, force.eps)


def _numbers(force: Force, y: np.ndarray) -> tuple[np.ndarray, ...]:
    return in_chunks(_forces, SETTINGS.places, (force,), (y,))


@Program
def _forces(force: Force, y: Array) -> tuple[Array, Array, Array, Array]:
    """`V_eps'`, its slope by z, `dz/dy`, and its change with the compression."""

    def at(one: Real) -> tuple[Real, Real, Real, Real]:
        def both(s: Real) -> tuple[Real, Real]:
            return force.pull(s)[0], _compression(force, s)

        (pull, _), (by_tip, pressed) = jax.jvp(both, (one,), (jnp.ones_like(one),))
        stretch = force.stretch(one)
        return pull, by_tip / stretch, stretch, jnp.abs(by_tip / pressed)

    return jax.vmap(at)(y)


@Program
def _overloads(
    force: Force, viscosity: Real, places: CriticalPlaces, *columns: Array
) -> Array:
    def at(t: Real, well: Real, which: Array) -> Real:
        own: Any = jax.tree_util.tree_map(lambda c: jnp.asarray(c)[which], places)
        z = force.state(well, own.place)
        held = force.load(t) - force.support.force(z)
        stiffness = force.support.stiffness_at(z) + own.slopes
        drag = _drag(viscosity * jnp.minimum(force.load.slope(t), 0.0), stiffness, own.ways)
        return (own.pull + drag - held) / own.share

    return jax.vmap(at)(*columns)


def _drag(rate: Real, stiffness: Array, ways: Array) -> Real:
    """`q = eps^gamma z'` in N at a place to which the tip comes down, `rate` eps^gamma l'.

    `dq/dz = rate/q - stiffness` forgets where it began: implicit steps of it, from the
    velocity of the equilibrium. (That alone errs by 0.6% of the critical load at eps = 0.1
    and gamma = 0.5.) Where nothing is stable, steps go on as if it were, to be forgotten.
    """
    stiffness = jnp.maximum(stiffness, 0.1 * jnp.abs(stiffness[-1]))

    def step(drag: Real, along: tuple[Real, Real]) -> tuple[Real, None]:
        stiff, way = along
        known = drag - way * stiff
        return 0.5 * (known - jnp.sqrt(known**2 + 4 * way * rate)), None

    drag, _ = jax.lax.scan(step, rate / stiffness[0], (stiffness, ways))
    return drag
