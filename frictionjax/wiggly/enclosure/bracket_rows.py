"""Brackets of a layout as they are added, a few at a time."""

import numpy as np

from .brackets import Brackets


class BracketRows:
    """Brackets as they are added: cell, begin, paired and stops of each."""

    def __init__(self) -> None:
        self._cells: list[np.ndarray] = []
        self._begins: list[np.ndarray] = []
        self._paired: list[np.ndarray] = []
        self._sizes: list[np.ndarray] = []
        self._stops: list[np.ndarray] = []
        self._count = 0

    def add(
        self,
        cell: np.ndarray,
        begin: np.ndarray,
        paired: bool,
        stops: np.ndarray,
        sizes: np.ndarray,
    ) -> np.ndarray:
        """Add brackets; the numbers of their stops among all.

        `cell`, `begin`, `sizes`: of each, so many of the stops as its size.
        """
        self._cells.append(cell)
        self._begins.append(begin)
        self._paired.append(np.full(sizes.size, paired))
        self._sizes.append(sizes)
        self._stops.append(stops)
        self._count += stops.size
        return np.arange(self._count - stops.size, self._count)

    def brackets(self) -> Brackets:
        """All of them."""
        sizes = np.concatenate(self._sizes)
        owner = np.repeat(np.arange(sizes.size), sizes)
        return Brackets(
            cell=np.concatenate(self._cells),
            begin=np.concatenate(self._begins),
            paired=np.concatenate(self._paired),
            owner=owner,
            stop=np.concatenate(self._stops),
        )
