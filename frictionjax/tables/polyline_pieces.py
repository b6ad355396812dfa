"""Flanks and corners of a polyline, each a polynomial."""

import numpy as np
from numpy.polynomial import Polynomial

from ..profiles import Polyline
from .pieces import Pieces


def polyline_pieces(profile: Polyline) -> Pieces:
    """One piece for each corner, and for each flank that has a straight part.

    In a corner of width b that turns by k, `w = h + s x + k b (u^3 - u^4/2)` with
    `u = x/b + 1/2` and x from its point: `u = t/b` in the place t from where it begins.
    """
    corners = profile.corners()
    x, heights = np.asarray(profile.x), np.asarray(profile.heights)
    before, turn, width, straight = (
        np.asarray(v)
        for v in (corners.before, corners.turn, corners.width, corners.straight)
    )
    half = 0.5 * width
    safe = np.where(width > 0, width, 1.0)
    none = np.zeros_like(x)
    rounded = np.stack(
        [heights - before * half, before, none, turn / safe**2, -0.5 * turn / safe**3],
        axis=1,
    )
    after = before + turn
    flank = np.stack([heights + after * half, after, none, none, none], axis=1)
    left = np.concatenate([x - half, x + half])
    terms = np.concatenate([rounded, flank])
    length = np.concatenate([width, straight])
    left, terms = left[length > 0], terms[length > 0]
    begins = left % 1.0
    order = np.argsort(begins)
    return _from_zero(begins[order], terms[order])


def _from_zero(left: np.ndarray, terms: np.ndarray) -> Pieces:
    """Pieces that begin at 0, where the last one of the period before goes on."""
    if left[0] == 0:
        return Pieces(left, terms)
    later = Polynomial([1.0 - left[-1], 1.0])  # t from the last piece's left to y - 1
    going_on = Polynomial(terms[-1])(later).coef
    going_on = np.pad(going_on, (0, terms.shape[1] - going_on.size))
    return Pieces(np.append(0.0, left), np.concatenate([going_on[None], terms]))
