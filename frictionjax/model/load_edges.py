"""Where a load of known numbers turns: times that do not depend on its class."""

from typing import Any

import numpy as np
from jaxtyping import Array, Float

from .._compile import Interpreted, padded_size
from ..loads import AbstractLoad
from .settings import SETTINGS


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
