"""The load of a scene: held by its spring, and where it turns whatever its class."""

from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .._checks import kind_of, require
from .._compile import Interpreted, padded_size
from ..loads import AbstractLoad, Pulled
from ..supports import AbstractSupport, Spring
from .potentials import AbstractPotential, BristlePotential
from .settings import SETTINGS


def held_load(
    load: AbstractLoad, support: AbstractSupport, potential: AbstractPotential
) -> AbstractLoad:
    """A `Pulled` load with the scene's k_h and c; others as they are.

    Without a bristle u is z. Raises `ValueError` for another support than a spring.
    """
    if not isinstance(load, Pulled):
        return load
    needs = "a Spring, as the load is Pulled: l = k_h (q - L_h + c)"
    linear = isinstance(support, Spring)
    require(linear, "scene.support", kind_of(support), needs)
    constant = jnp.zeros(())
    if isinstance(potential, BristlePotential):
        constant = potential.bristle.root_constant()
    return load.held_by(support.stiffness, constant)  # type: ignore[attr-defined]


@Interpreted
def _turning_points(load: AbstractLoad, duration: Array, count: int) -> Array:
    return load.turning_points(duration, count)


def known_turning_points(
    load: AbstractLoad, duration: Any, room: int
) -> Float[np.ndarray, " n"]:
    """Turning points in (0, duration), in s; NaN where the room is too small."""
    times = _turning_points(load, np.asarray(duration), room)
    return times[~(times >= float(duration))]


def padded_edges(
    turning_points: Float[np.ndarray, " n"], duration: Any
) -> Float[np.ndarray, " room"]:
    """0, the turning points and `duration`, which fills one of a few rooms."""
    count = turning_points.size + 2
    factor = 4 if count <= SETTINGS.many_edges else 2
    size = padded_size(count, SETTINGS.edges, factor)
    edges = np.full(size, float(duration))
    edges[: turning_points.size + 1] = [0.0, *turning_points]
    return edges
