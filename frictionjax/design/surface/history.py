"""How the starts of a fit ended, and every iterate on the way."""

from typing import NamedTuple

import numpy as np

from .status import ProfileStatus


class Start(NamedTuple):
    """How one start ended.

    `loss`: squared residuals, weighted. `place`: of the lowest slope from the highest,
    in periods. `steps` of Newton. `number`: of the start, 0 with the bristles' own values.
    `ran`: False where the optimum of another one, which is proven, stands for it: then the
    rest is of that one, and `steps` is 0.
    """

    number: int
    status: ProfileStatus
    loss: float
    bending_energy: float
    place: float
    steps: int
    free: tuple[float, ...]
    ran: bool = True


class History(NamedTuple):
    """Every iterate of every start: arrays (starts, steps), NaN after a start's end.

    And everywhere for starts that were not run.

    Starts in the order in which they were drawn. `loss`: weighted squared residuals.
    `barrier`: its weight. `decrement`: Newton's. `omega_plus`, `omega_minus`: bounds of the
    extreme slopes. `cos`, `sin`: the iterates, (starts, steps, harmonics); `free`: (starts,
    steps, free parameters).
    """

    loss: np.ndarray
    bending_energy: np.ndarray
    barrier: np.ndarray
    decrement: np.ndarray
    omega_plus: np.ndarray
    omega_minus: np.ndarray
    cos: np.ndarray
    sin: np.ndarray
    free: np.ndarray
