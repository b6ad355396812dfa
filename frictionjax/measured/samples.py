"""Heights as a file gives them, and where each stands in it."""

from typing import NamedTuple

import numpy as np


class HeightSamples(NamedTuple):
    """Positions `x` in m, shape (n,); `heights` in m, (rows, n), NaN where one is missing.

    `notes`: lines on how the file was read. `lines`: number of each sample's line, shape
    (rows, n); `columns`: of its column; empty where the file is no text.
    """

    x: np.ndarray
    heights: np.ndarray
    notes: list[str]
    lines: np.ndarray
    columns: np.ndarray

    def place(self, row: int, sample: int) -> str:
        """Where a sample stands in the file."""
        if not self.lines.size:
            return f"row {row}, sample {sample}"
        return f"line {self.lines[row, sample]}, column {self.columns[row, sample]}"
