"""What the laws of a slide need of a scene: the force of a well, speeds of the limit."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import jax
import numpy as np
from jaxtyping import Array, Float

from .._checks import Real
from .._compile import in_chunks, once_a_scene
from ..coefficients import Coefficients
from ..model import (
    AbstractPotential,
    BristlePotential,
    Scene,
    known_turning_points,
    strips_at,
    tabulated_potentials,
)
from ..numerics import slope_of
from .settings import SETTINGS


class SlideData(NamedTuple):
    """Arrays that `predict_errors` needs; a data set keeps them in its attributes.

    Over `phase`, a period of the state from its own start: `phase` Y in periods, shape
    (n,); `force` W'(Y) and `change` Q'(0; Y), in N and N/m. Over moments of [0, T], shape
    (m,): `length` in s, `pull`, by which the load changes, in N, `speed` of the limit in
    m/s, 0 where it rests, `stiffness` Phi'' in N/m.
    """

    phase: Float[np.ndarray, " n"]
    force: Float[np.ndarray, " n"]
    change: Float[np.ndarray, " n"]
    length: Float[np.ndarray, " m"]
    pull: Float[np.ndarray, " m"]
    speed: Float[np.ndarray, " m"]
    stiffness: Float[np.ndarray, " m"]

    def attributes(self) -> dict[str, Float[np.ndarray, " places"]]:
        """By the names that they have in the attributes of a data set."""
        return {name: getattr(self, field) for name, field in _ATTRIBUTES.items()}

    @classmethod
    def of(cls, attributes: Mapping[Any, Any]) -> "SlideData | None":
        """What the attributes of a data set of `sweep` hold; None where they hold none."""
        if not set(_ATTRIBUTES) <= set(attributes):
            return None
        fields = {field: attributes[name] for name, field in _ATTRIBUTES.items()}
        return cls(**{field: np.asarray(value) for field, value in fields.items()})


_ATTRIBUTES = {
    "law_phase": "phase",
    "law_well_force": "force",
    "law_well_force_change": "change",
    "law_length": "length",
    "law_pull": "pull",
    "law_speed": "speed",
    "law_stiffness": "stiffness",
}


LAW_DIMS = {
    name: "law_place" if field in ("phase", "force", "change") else "law_moment"
    for name, field in _ATTRIBUTES.items()
}
"""Along what these arrays are."""


def slide_data(
    scene: Scene, found: Coefficients, eps: Float[np.ndarray, " cells"]
) -> SlideData | None:
    """What the laws need of a scene with these coefficients, for known values.

    None where the load turns more often than there are moments: nothing slides long.
    """
    turns = np.unique(known_turning_points(scene.load, scene.duration, scene.turns))
    if turns.size >= SETTINGS.moments:
        return None
    small = SETTINGS.small_eps * float(np.max(eps))
    wells = _wells(tabulated_potentials(scene.potential, small)[0], small)
    return SlideData(*wells, *_moments(scene, found, turns))


@once_a_scene
def _forces(potential: AbstractPotential, eps: Float[Array, ""], y: Float[Array, " n"]):
    """State, W' and Q' at places `y` of the tip, the last to second order in `eps`."""
    if isinstance(potential, BristlePotential):
        height, slope = jax.jvp(potential.profile, (y,), (np.ones(y.shape),))
        a = potential.a()
        state, force = y + a * height, potential.alpha() * slope / (1 + a * slope)
    else:
        state, force = y, jax.vmap(slope_of(potential._leading))(y)

    def change(size: Real) -> Array:
        whole = jax.vmap(lambda place: potential.tip_force(place, size)[0])(y)
        return (whole - force) / size

    sizes = jax.lax.map(change, np.array([0.5, 1.0]) * eps)
    return state, force, 2 * sizes[0] - sizes[1]


def _wells(
    potential: AbstractPotential, eps: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Phase, W' and Q' over a period, more densely around both extremes of W'.

    The tip coordinate is held where Q' is found from forces: at an extreme of W', where
    alone it counts, the phase may be held as well.
    """

    def at(places: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        size = np.asarray(eps)
        return in_chunks(_forces, SETTINGS.together, (potential, size), (places,))

    even = np.arange(SETTINGS.even_places) / SETTINGS.even_places
    leading = at(even)[1]
    around = np.geomspace(SETTINGS.nearest, SETTINGS.farthest, SETTINGS.beside_extreme)
    beside = np.concatenate([-around[::-1], [0.0], around])
    tops = [_top(at, even[int(np.argmax(sign * leading))], sign) for sign in (1, -1)]
    places = np.unique(np.concatenate([even, *((top + beside) % 1.0 for top in tops)]))
    return at(places)


def _top(at, place: float, sign: int) -> float:
    """Where `sign W'` is largest, from the best of the even places."""
    width = 1 / SETTINGS.even_places
    for _ in range(SETTINGS.zooms):
        near = place + width * np.linspace(-1, 1, SETTINGS.zoom_parts + 1)
        values = sign * at(near)[1]
        # Of a flat top, or where rounding says so, the middle.
        best = np.flatnonzero(values >= values.max())
        place, width = float(near[best].mean()), 4 * width / SETTINGS.zoom_parts
    return place


def _moments(
    scene: Scene, found: Coefficients, turns: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Length, pull, speed, stiffness of stretches between times, turning points among them.

    Speed is that of the strip's edge, so it is right in a stretch in which the limit begins
    to move too; stiffness is that of the edges' states, found again at the limit's own.
    """
    ends = np.linspace(0.0, float(scene.duration), SETTINGS.moments)
    times = np.unique(np.concatenate([ends, turns]))
    rho_plus, rho_minus = float(found.rho_plus), float(found.rho_minus)
    load, lower, upper = strips_at(scene, rho_plus, rho_minus, times)
    length, pull = np.diff(times), np.diff(load)
    first = np.where(pull > 0, lower[:-1], upper[:-1])
    last = np.where(pull > 0, lower[1:], upper[1:])
    edge = last - first
    z = _played(float(scene.z0), lower, upper)
    known = np.flatnonzero((edge != 0) & (pull != 0))
    speed = np.where((np.diff(z) != 0) & (pull != 0), edge / length, 0.0)
    if not known.size:
        return length, pull, speed, np.ones_like(speed)
    places = 0.5 * (first + last)[known]
    order = np.argsort(places)
    values = (pull[known] / edge[known])[order]
    stiffness = np.interp(0.5 * (z[1:] + z[:-1]), places[order], values)
    return length, pull, speed, stiffness


def _played(start: float, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """The limit's states: the play operator."""
    z, states = start, []
    for low, high in zip(lower.tolist(), upper.tolist(), strict=True):
        z = min(max(z, low), high)
        states.append(z)
    return np.array(states)
