"""How roots and extrema are found, and what differences are trusted for: with what lost."""

from typing import NamedTuple

import numpy as np


class Settings(NamedTuple):
    """Of brackets, of scans, of roundings."""

    # Roots in brackets (`roots.py`).
    rounding: float = 2.0**-51  # of the bracket's ends, and of the root
    # 104 bisections end any bracket, every third; Newton: under 10.
    most_iterations: int = 320
    # Newton steps that shrink less than this take turns with bisections: between the flanks
    # of a bump in the slope they go back and forth, inside of the bracket, for ever.
    slow: float = 0.7
    # Where they are small and no longer shrink (rounding of `f` over a small slope, a flank
    # narrower than that, a multiple root) a step this much longer closes the bracket.
    small: float = 1e-8  # of the bracket's ends
    beyond: float = 8.0
    # Of brackets around a guess, a step.
    growth: float = 4.0
    shrink: float = 32.0

    # Extrema of periodic functions (`extrema.py`).
    bumps: int = 8  # scanned maxima that are polished
    # Scanned points of which one is looked at: no two bumps of a resolved function are that
    # near.
    near: int = 4
    bent: float = 1e-8  # of the value: less, and a place carries no derivative

    # Differences and their integrals (`taylor.py`).
    cancelled: float = 8 * float(np.finfo(np.float64).eps)  # rounding of a difference
    settled: float = 1e-13  # of a quadrature, against one of half as many nodes

    # Distances of graphs (`completed_graphs.py`).
    halvings: int = 30  # of the largest difference: 1e-9 of it is left


SETTINGS = Settings()
