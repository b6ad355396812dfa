"""Steady slides of one scene at many speeds in one compiled call."""

import numpy as np
from jaxtyping import Float

from ...model import AbstractPotential
from .slide_curve import array_peaks, require_bristles, with_peaks
from .slide_rows import find_slides, rows_of_slides, slide_table
from .slide_sides import Sides


def slides_at_speeds(
    potential: AbstractPotential,
    speeds: Float[np.ndarray, " n"],
    *,
    eps: float,
    gamma: float,
    stiffness: float,
    phases: Float[np.ndarray, " bristles"] | None = None,
) -> Sides:
    """Forces (N) of slides whose support moves at `speeds` (m/s, none 0), arrays (n,).

    `eps` in m, `stiffness` of the spring in N/m; known numbers, within the bristle's reach.
    Where springs are so soft that errors are hardly forgotten the code is `OPEN_BRACKET`.
    `phases`: of bristles on a spring each, whose mean has the peaks.
    """
    if phases is not None:
        require_bristles(phases)
    rates = stiffness * np.abs(speeds)
    rows = rows_of_slides(0, eps, gamma, rates, stiffness, np.sign(speeds))
    table = slide_table(potential, eps)
    found = find_slides([table], rows)
    if phases is None or np.all(phases == phases[0]):
        return found
    rises, which = np.unique(rates, return_inverse=True)
    pairs = [array_peaks(table, eps, (gamma, r, stiffness), phases) for r in rises.tolist()]
    peak, off = (np.stack(column) for column in zip(*pairs, strict=True))
    left = (speeds < 0).astype(int)
    return with_peaks(found, peak[which, left], off[which, left])
