"""Panels of a period halved until passages are resolved, corners of the surface too."""

from collections.abc import Callable

import numpy as np

from .gauss import GAUSS_NODES, GAUSS_POINTS, TO_LEGENDRE
from .settings import SETTINGS

_PLACES = 0.5 * (1 + np.concatenate([[-1.0], GAUSS_NODES, [1.0]]))  # of a panel
# Legendre polynomials at both ends of a panel.
_AT_ENDS = np.stack([(-1.0) ** np.arange(GAUSS_POINTS), np.ones(GAUSS_POINTS)])


def halved_panels(
    gaps: Callable[[np.ndarray, np.ndarray], np.ndarray],
    excess: np.ndarray,
    allowed: np.ndarray,
) -> tuple[np.ndarray, np.ndarray] | None:
    """Left ends and widths of panels, shares of each way, (cells, panels) both.

    `gaps(cell, shares)`: force in N below the fold's at shares of the way of cells (n,).
    Of `1/(excess + gap)` under each excess (cells, pulls) the last coefficients of a panel,
    and what its series misses at its ends, are at most `allowed` (pulls,) of the whole.
    (A corner where the way starts, as fold places do, is between the end and the first
    node.) None where that takes more panels than there may be.
    """
    count = len(excess)
    cell = np.repeat(np.arange(count), 4)
    left, width = np.tile(np.arange(4) / 4, count), np.full(4 * count, 0.25)
    done, past = [], np.zeros((excess.shape[1], count))
    for level in range(SETTINGS.depth):
        held = np.maximum(gaps(cell, left[:, None] + width[:, None] * _PLACES), 0.0)
        means, rough = _series_of(1 / (excess[cell].T[..., None] + held))
        parts = width * means
        most = allowed[:, None] * (past + _of_cells(parts, cell, count))
        split = np.any(width * rough > most[:, cell], axis=0)
        split &= level < SETTINGS.depth - 1
        done.append(tuple(column[~split] for column in (cell, left, width)))
        past += _of_cells(parts[:, ~split], cell[~split], count)
        if not split.any():
            break
        half = 0.5 * width[split]
        cell, left = np.repeat(cell[split], 2), np.repeat(left[split], 2)
        width = np.repeat(half, 2)
        left[1::2] += half
        if cell.size > count * SETTINGS.halved_sizes[-1]:
            return None
    cell, left, width = (np.concatenate(column) for column in zip(*done, strict=True))
    most = np.max(np.bincount(cell))
    sizes = [size for size in SETTINGS.halved_sizes if size >= most]
    if not sizes:
        return None
    rows = [_filled(left[cell == c], width[cell == c], sizes[0]) for c in range(count)]
    lefts, widths = (np.stack(column) for column in zip(*rows, strict=True))
    return lefts, widths


def _series_of(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Means over panels, and how rough these are, of values at `_PLACES` of each."""
    series = values[..., 1:-1] @ TO_LEGENDRE.T
    missed = values[..., [0, -1]] - series @ _AT_ENDS.T
    last = np.sum(np.abs(series[..., -2:]), axis=-1)
    at_ends = SETTINGS.end_weight * np.sum(np.abs(missed), axis=-1)
    return series[..., 0], np.maximum(last, at_ends)


def _of_cells(parts: np.ndarray, cell: np.ndarray, count: int) -> np.ndarray:
    """Sums of the parts (pulls, n) of each cell, (pulls, cells)."""
    return np.array([np.bincount(cell, row, count) for row in parts])


def _filled(
    left: np.ndarray, width: np.ndarray, size: int
) -> tuple[np.ndarray, np.ndarray]:
    """The widest panels halved until there are so many, from left to right."""
    while left.size < size:
        wide = np.argsort(-width)[: size - left.size]
        half = 0.5 * width[wide]
        width = width.copy()
        width[wide] = half
        left = np.append(left, left[wide] + half)
        width = np.append(width, half)
    order = np.argsort(left)
    return left[order], width[order]
