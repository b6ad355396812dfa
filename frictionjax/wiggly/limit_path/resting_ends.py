"""Which slides end slow: tips rest there where the path does, and starts are forgotten."""

import numpy as np
from jaxtyping import Bool, Float

from .path import Path
from .settings import SETTINGS


def slow_ends(
    path: Path,
    eps: Float[np.ndarray, " cells"],
    memory: Float[np.ndarray, "cells pieces"],
    power: Float[np.ndarray, "cells pieces"],
) -> Bool[np.ndarray, "cells pieces"]:
    """Whether each piece should end slow, (cells, pieces); rests of the path do not.

    `eps` in m, shape (cells,). `memory`: wells that the fastest slide in the direction of
    each piece remembers, about; slower ones in proportion to a `power` of their speed.
    """
    slides = np.flatnonzero(path.direction)
    slow = np.zeros((eps.size, path.direction.size), dtype=bool)
    if slides.size == 0:
        return slow
    ends = np.abs(path.states[slides + 1] - path.states[slides])
    level = np.maximum(ends - SETTINGS.end * eps[:, None], 0.0)
    state = path.states[slides] + path.direction[slides] * level
    times = path.times_at(np.tile(slides, eps.size), state.ravel())
    speed = path.speeds_at(times).reshape(state.shape)
    share = np.abs(speed) / (path.speed or 1.0)  # nothing slides at 0
    left = memory[:, slides] * share ** power[:, slides]
    slow[:, slides] = left * -np.log(SETTINGS.rests) < 1
    return slow
