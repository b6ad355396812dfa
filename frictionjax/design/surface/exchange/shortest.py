"""The shortest vector within linear bounds, and series that lean as far as they can."""

from typing import Any

import numpy as np
from jaxtyping import Float

from .settings import SETTINGS


def least_distance(
    rows: Float[np.ndarray, "m n"], ends: Float[np.ndarray, " m"]
) -> Float[np.ndarray, " n"] | None:
    """The shortest `x` with `rows x >= ends`; None where there is none.

    By non-negative least squares (Lawson and Hanson, Solving Least Squares Problems, 23.4).
    """
    from scipy.optimize import nnls  # 0.7 s, where no barrier is followed

    both = np.concatenate([rows.T, ends[None]])
    aim = np.zeros(len(both))
    aim[-1] = 1.0
    try:
        prices, left = nnls(both, aim, maxiter=SETTINGS.exchanges * len(ends))
    except RuntimeError:  # it goes round in circles next to what is impossible
        return None
    if left <= SETTINGS.impossible:
        return None
    gap = both @ prices - aim
    return -gap[:-1] / gap[-1]


def most_uneven(
    rows: Float[np.ndarray, "m n"], top: Float[np.ndarray, " n"]
) -> Float[np.ndarray, " n"]:
    """The `x` with the largest `top x` while `rows x >= -1` (a linear program, HiGHS)."""
    from scipy.optimize import linprog

    none: Any = (None, None)
    return linprog(-top, -rows, np.ones(len(rows)), bounds=none, method="highs").x
