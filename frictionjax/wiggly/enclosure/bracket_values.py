"""What closing the brackets of a sweep gives."""

from typing import NamedTuple

import numpy as np

from ..lanes import SegmentEnds, Segments


class BracketValues(NamedTuple):
    """Values at all stops of a layout, shape (S,), and of the segments that lead to them.

    `gap`: how closely brackets have closed, in eps; `how`: as in `CellResults`.
    `steps`, `rejected`: of each cell.
    """

    arrivals: SegmentEnds
    segments: Segments
    gap: np.ndarray
    how: np.ndarray
    steps: np.ndarray
    rejected: np.ndarray
