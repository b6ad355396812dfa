"""Steady slides of one scene at many speeds in one compiled call."""

import numpy as np
from jaxtyping import Float

from ...model import AbstractPotential
from .slide_rows import find_slides, rows_of_slides, slide_table
from .slide_sides import Sides


def slides_at_speeds(
    potential: AbstractPotential,
    speeds: Float[np.ndarray, " n"],
    *,
    eps: float,
    gamma: float,
    stiffness: float,
) -> Sides:
    """Forces (N) of slides whose support moves at `speeds` (m/s, none 0), arrays (n,).

    `eps` in m, `stiffness` of the spring in N/m; known numbers, within the bristle's reach.
    Where springs are so soft that errors are hardly forgotten the code is `OPEN_BRACKET`.
    """
    rates = stiffness * np.abs(speeds)
    rows = rows_of_slides(0, eps, gamma, rates, stiffness, np.sign(speeds))
    return find_slides([slide_table(potential, eps)], rows).sides
