"""What a cell's brackets need, and how many wells its lanes pass through for it."""

from typing import NamedTuple

import numpy as np

from ..limit_path import Path
from .settings import SETTINGS


class Requirements(NamedTuple):
    """What a cell's brackets need, in wells, shape (cells,), where slides remember longest.

    `run_up`: from a start to where it is forgotten. `transient`: from the start of a slide
    to where the slide before is forgotten. `tile`: between two cuts of the chain, infinite
    where it is not cut. `share` (cells, pieces): of these three that a piece needs, whose
    slide may remember less than others. `samples`: periods measured in a slide, 0 for all.
    `lattice_offset` (cells, pieces): from the start of a slide to its first lattice point,
    which is half a period from the slips of a slow slide: what is measured should not begin
    in a slip.
    `restarts` (cells, pieces): where the chain is cut however long its tiles are, at a
    piece's end. `settles`: whether tips are at rest half a period behind slips, so that
    lanes that have met there need not be two any longer. `leg`: between two stops of a
    lane, where nothing else stops it.
    """

    run_up: np.ndarray
    transient: np.ndarray
    tile: np.ndarray
    share: np.ndarray
    samples: np.ndarray
    lattice_offset: np.ndarray
    restarts: np.ndarray
    settles: np.ndarray
    leg: np.ndarray


def forgotten_after(lag, memory, accuracy: float):
    """Wells in which a bracket closes that is as wide as the lag, and those of a run-up.

    `lag`, `memory`: wells, of one shape.
    """
    forgets = memory * np.log((lag + 2) / (SETTINGS.forgotten * accuracy))
    return forgets, np.ceil(SETTINGS.margin + forgets)


def resting_after(lag, landed, shift, forgets):
    """Wells back to a start between slips, from which a bracket closes at rest.

    Windows begin half a period behind slips. Tips that have `landed` before are in one well
    with both lanes of a bracket from the start; where lags are less than half a period,
    lanes that set off a little after a slip come to rest in one. `forgets` wells more pass
    where the rest of half a period is too short. Infinite where tips lag further: their
    lanes have to catch up with each other. `shift`: of folds, wells.
    """

    def resting(late, least: float):
        rest = np.maximum(0.5 - late - shift, 0.0)
        wells = rest + np.ceil(np.maximum(SETTINGS.slips_forget * forgets - rest, 0.0))
        return np.where(rest > least, wells, np.inf)

    slow = resting(SETTINGS.after_slip + lag, SETTINGS.short_rest)
    return np.minimum(slow, resting(landed + SETTINGS.beyond, SETTINGS.short_stay))


def wells_of(
    path: Path, eps: np.ndarray, needs: Requirements
) -> tuple[np.ndarray, np.ndarray]:
    """Wells of the path in each cell: outside inner parts of slides, and inside."""
    ways = np.abs(np.diff(path.states))[None, :] / eps[:, None]
    inner = inner_wells(ways, needs)
    return np.sum(ways - inner, axis=1), np.sum(inner, axis=1)


def cost_of(path: Path, eps: np.ndarray, needs: Requirements, times: int) -> np.ndarray:
    """Wells that lanes pass through in each cell, about."""
    ways = np.abs(np.diff(path.states)) / eps[:, None]
    inside = inner_wells(ways, needs)
    outer, inner = np.sum(ways - inside, axis=1), np.sum(inside, axis=1)
    shown = times * inside / np.maximum(inner + outer, 1e-9)[:, None]
    tiles = np.sum((ways - inside) / needs.share, axis=1) / needs.tile
    brackets = (inside > 0) * needs.samples[:, None] + shown
    # The first tile sets off from the known z0.
    run_ups = 2 * needs.run_up * np.maximum(tiles - 1, 0.0)
    passed = np.where(needs.settles, SETTINGS.settled_lane, SETTINGS.lane)[:, None]
    sampled = np.sum((needs.share * needs.run_up[:, None] + passed) * brackets, axis=1)
    return outer + run_ups + 2 * sampled


def longest_lane(path: Path, eps: np.ndarray, needs: Requirements) -> np.ndarray:
    """Wells of a tile and its run-up, at most all of them between two cuts."""
    ends = np.where(needs.restarts, path.travel[1:], 0.0)
    begins = np.maximum.accumulate(np.pad(ends, ((0, 0), (1, 0)))[:, :-1], axis=1)
    between = np.max(path.travel[1:] - begins, axis=1)
    return np.minimum(between / eps, needs.tile + needs.run_up)


def wells_a_leg(path: Path, eps: np.ndarray, late: np.ndarray) -> np.ndarray:
    """Wells between two stops of each cell's lanes, where nothing else stops them.

    `late` (cells,): how many times further lanes may go, as tips stay far behind the path.
    """
    span = max(float(path.travel[-1]), 1e-300)
    most = SETTINGS.most_wells_a_leg * np.floor(late)
    return np.clip(np.floor(SETTINGS.leg * span / eps), 1, most)


def transients(needs: Requirements) -> np.ndarray:
    """Wells of each slide until the one before is forgotten, (cells, pieces)."""
    return np.ceil(needs.share * needs.transient[:, None])


def tiles_at(path: Path, needs: Requirements, ways: np.ndarray, cell: int) -> np.ndarray:
    """Tiles of a cell on the way from 0 to `ways`, in units of eps."""
    each = np.diff(path.travel) / (needs.share[cell] * needs.tile[cell])
    return np.interp(ways, path.travel, np.append(0.0, np.cumsum(each)))


def inner_wells(ways: np.ndarray, needs: Requirements) -> np.ndarray:
    """Wells of each slide of which only some are measured, (cells, pieces).

    None where lanes that remember long would go through more wells for these than there
    are. (Angular, gamma = 3/4, eps = 2e-3: 4.5e5 steps for 2.7e5.)
    """
    inner = np.floor(ways) - transients(needs) - SETTINGS.tail - 1
    samples = needs.samples[:, None]
    run_up = np.where(samples > 0, needs.run_up[:, None], 0.0)  # may be inf where none are
    each = np.where(run_up > SETTINGS.some_memory, needs.share * run_up, 1.0)
    return np.where((samples > 0) & (inner > 2 * samples * each), inner, 0.0)
