"""Brackets of a layout as they are added, a few at a time."""

import numpy as np

from .brackets import Brackets


class BracketRows:
    """Brackets as they are added: cell, begin, paired and stops of each."""

    def __init__(self) -> None:
        self._added: list[tuple[np.ndarray, ...]] = []
        self._count = 0

    def add(
        self,
        cell: np.ndarray,
        begin: np.ndarray,
        paired: bool | np.ndarray,
        stops: np.ndarray,
        sizes: np.ndarray,
    ) -> np.ndarray:
        """Add brackets; the numbers of their stops among all.

        `cell`, `begin`, `sizes`: of each, so many of the stops as its size. `paired`: of
        each, or of all.
        """
        self._added.append((cell, begin, np.full(sizes.size, paired), sizes, stops))
        self._count += stops.size
        return np.arange(self._count - stops.size, self._count)

    def brackets(self) -> Brackets:
        """All of them."""
        columns = zip(*self._added, strict=True)
        cell, begin, paired, sizes, stop = (np.concatenate(c) for c in columns)
        return Brackets(
            cell=cell,
            begin=begin,
            paired=paired,
            owner=np.repeat(np.arange(sizes.size), sizes),
            stop=stop,
        )
