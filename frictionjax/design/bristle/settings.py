"""How finely numbers of a bristle are looked over, and what counts as met."""

from typing import NamedTuple

import numpy as np

_ULP = float(np.finfo(np.float64).eps)


class Settings(NamedTuple):
    """Of surveys of a number, of solutions, of batches."""

    # Where a number is admissible, and its quantity turns (`admissible.py`).
    most_intervals: int = 4  # of admissible numbers: slanted springs have three
    turns: int = 6  # extrema of the quantity in one interval
    grid: int = 257
    bisections: int = 64  # a bracket of the grid's width to neighbouring floats
    ternary: int = 60
    # Nodes of an interval: even inside, and halving towards both ends, where it may have
    # poles: from, to.
    even: int = 96
    halvings: tuple[int, int] = (7, 51)
    # Growth between these shares of the width before an end: that of (1/d)^(1/3).
    pole: float = 1e2
    asides: tuple[float, float] = (1e-3, 1e-9)
    flat: float = 256 * _ULP  # of the quantity: no change

    # Solutions (`inverse.py`).
    roots: int = 8  # of one target that are kept
    touch: float = 64 * _ULP  # of the target: an extremum that near it is a solution
    met: float = 1e-9  # of it, of a difference of the larger force if that is more
    inset: float = 1e-5  # of an interval that gives it throughout: from its ends

    # Batches (`angle.py`, `sensitivities.py`).
    # The smallest piece, and by how much the next size is larger: batches come in few
    # sizes, so that few programs are compiled.
    room: tuple[int, int] = (8, 8)
    side_by_side: int = 512  # targets: 7 KB each of comparisons at every node


SETTINGS = Settings()
