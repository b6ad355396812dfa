"""What a cell's brackets need, and how many wells its lanes pass through for it."""

from typing import NamedTuple

import numpy as np

from ..limit_path import Path
from .settings import SETTINGS


class Requirements(NamedTuple):
    """What a cell's brackets need, in wells, shape (cells,).

    `run_up`: from a start to where it is forgotten. `transient`: from the start of a slide
    to where the slide before is forgotten. `tile`: between two cuts of the chain, infinite
    where it is not cut. `samples`: periods measured in a slide, 0 for all. `lattice_offset`
    (cells, pieces): from the start of a slide to its first lattice point, which is half a
    period from the slips of a slow slide: what is measured should not begin in a slip.
    `restarts` (cells, pieces): where the chain is cut however long its tiles are, at a
    piece's end.
    """

    run_up: np.ndarray
    transient: np.ndarray
    tile: np.ndarray
    samples: np.ndarray
    lattice_offset: np.ndarray
    restarts: np.ndarray


def wells_of(
    path: Path, eps: np.ndarray, needs: Requirements
) -> tuple[np.ndarray, np.ndarray]:
    """Wells of the path in each cell: outside inner parts of slides, and inside."""
    ways = np.abs(np.diff(path.states))[None, :] / eps[:, None]
    inner = inner_wells(ways, needs)
    return np.sum(ways - inner, axis=1), np.sum(inner, axis=1)


def cost_of(path: Path, eps: np.ndarray, needs: Requirements, times: int) -> np.ndarray:
    """Wells that lanes pass through in each cell, about."""
    outer, inner = wells_of(path, eps, needs)
    slides = np.sum(inner_wells(np.abs(np.diff(path.states)) / eps[:, None], needs) > 0, 1)
    shown = times * inner / np.maximum(inner + outer, 1e-9)
    tiles = outer / needs.tile
    brackets = slides * needs.samples + shown
    # The first tile sets off from the known z0.
    run_ups = 2 * needs.run_up * np.maximum(tiles - 1, 0.0)
    return outer + run_ups + 2 * (needs.run_up + 2) * brackets


def longest_lane(path: Path, eps: np.ndarray, needs: Requirements) -> np.ndarray:
    """Wells of a tile and its run-up, at most all of them between two cuts."""
    ends = np.where(needs.restarts, path.travel[1:], 0.0)
    begins = np.maximum.accumulate(np.pad(ends, ((0, 0), (1, 0)))[:, :-1], axis=1)
    between = np.max(path.travel[1:] - begins, axis=1)
    return np.minimum(between / eps, needs.tile + needs.run_up)


def wells_a_leg(path: Path, eps: np.ndarray) -> np.ndarray:
    """Wells between two stops of each cell's lanes, where nothing else stops them."""
    span = max(float(path.travel[-1]), 1e-300)
    return np.clip(np.floor(SETTINGS.leg * span / eps), 1, SETTINGS.most_wells_a_leg)


def inner_wells(ways: np.ndarray, needs: Requirements) -> np.ndarray:
    """Wells of each slide of which only some are measured, (cells, pieces)."""
    inner = np.floor(ways) - np.ceil(needs.transient)[:, None] - SETTINGS.tail - 1
    samples = needs.samples[:, None]
    return np.where((samples > 0) & (inner > 2 * samples), inner, 0.0)
