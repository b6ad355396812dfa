"""Grids eps x gamma."""

from typing import Any

import numpy as np

from .arguments import require_numbers


def grid_of(name: str, values: Any) -> np.ndarray:
    """Values of eps, falling, or of gamma, rising, each once.

    Raises `ValueError` where one is not a number > 0, or for lists of lists.
    """
    allowed = f"{name} > 0, a number or a list"
    require_numbers(name, values, allowed, lambda v: (v > 0) & (v.ndim <= 1))
    array = np.unique(np.atleast_1d(np.asarray(values, dtype=float)))
    return array[::-1] if name == "eps" else array


def cells_of(eps: np.ndarray, gamma: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """eps and gamma of every cell of a grid, gamma outside, shape (cells,) each."""
    return np.tile(eps, np.size(gamma)), np.repeat(gamma, np.size(eps))
