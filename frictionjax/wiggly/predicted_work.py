"""How much work the lanes will have, from the plan alone: nothing is integrated."""

from typing import NamedTuple

import numpy as np

from .._checks import quiet_where_extreme
from ..model import BristlePotential, Scene, TabulatedScene, tabulated_scene
from ..tables import SETTINGS as TABLES
from ..tables import SeriesBristle, SeriesProfile
from .enclosure import Requirements, cost_of, longest_lane, wells_of
from .lane_steps import drag_of, steps_a_well
from .limit_path import Path, known_path
from .plan import planned
from .settings import SETTINGS
from .ways import Way, slides_of


class Workload(NamedTuple):
    """Work of lanes in each cell, shape (cells,), and of all of them: pieces, weight.

    `steps`: of all lanes. `chain`: those that one lane takes after the other. `jobs`:
    lanes that set off; `segments`: of their ways. `maps`: slides of which slip maps are
    made; `rounds`: those of them that wait for each other. `pieces`: of the path, between
    turns of the load. `weight`: of a step, relative to one of parts in the smallest tables.
    """

    steps: np.ndarray
    chain: np.ndarray
    jobs: np.ndarray
    segments: np.ndarray
    maps: np.ndarray
    rounds: np.ndarray
    pieces: int
    weight: float


@quiet_where_extreme
def workload(
    scene: Scene,
    eps: np.ndarray,
    gamma: np.ndarray,
    times: int,
    accuracy: float,
    method: str,
) -> Workload | None:
    """Work of the cells (eps, gamma), shape (cells,); None where lanes do not serve."""
    tables = tabulated_scene(scene, eps)
    path = known_path(scene, tables)
    if path is None:
        return None
    accuracy = min(accuracy, SETTINGS.loosest)
    plan = planned(tables, path, eps, gamma, times, accuracy, method)
    control, ground, needs, way = plan
    by_map = way == Way.SLIP_MAP
    lag = ground.longest_lag
    steps = steps_a_well(control, lag, drag_of(path, eps, gamma))
    rests = SETTINGS.steps_a_piece * path.direction.size
    longest, ways = longest_lane(path, eps, needs), path.travel[-1] / eps
    total = steps * cost_of(path, eps, needs, times) + rests
    alone = np.where(ways > 0, longest / np.where(ways > 0, ways, 1.0), 1.0)
    chain = steps * longest + rests * alone
    wells = ways / np.maximum(np.count_nonzero(path.direction), 1)
    orders = np.log10(np.maximum(wells, SETTINGS.long_slide))
    growth = (ways / 1e3) ** SETTINGS.map_growth
    slides = slides_of(path, eps) & by_map[:, None]
    maps, rounds = np.count_nonzero(slides, axis=1), _longest_chains(slides, needs.restarts)
    each = SETTINGS.map_steps * orders**SETTINGS.map_orders
    each *= accuracy**-SETTINGS.map_accuracy
    total = np.where(by_map, maps * each, total)
    chain = np.where(by_map, SETTINGS.map_chain * rounds * steps * growth, chain)
    jobs, segments = _rows(path, eps, needs, times)
    # Beside maps only turns are gone through, as far as tips lag there.
    turns = np.minimum(maps * lag, ways) / needs.leg
    panels = maps * SETTINGS.map_segments * orders**2
    segments = np.where(by_map, panels + turns, segments)
    alike = path.direction.size, _weight_of(tables)
    return Workload(total, chain, jobs, segments, maps, rounds, *alike)


def _longest_chains(slides: np.ndarray, cut: np.ndarray) -> np.ndarray:
    """Slides, (cells, pieces), that follow one another without a cut: the most, (cells,).

    `cut`: at the end of which pieces.
    """
    chain = np.cumsum(np.pad(cut, ((0, 0), (1, 0)))[:, :-1], axis=1)
    counts = [np.bincount(c, s).max() for c, s in zip(chain, slides, strict=True)]
    return np.array(counts)


def _rows(
    path: Path, eps: np.ndarray, needs: Requirements, times: int
) -> tuple[np.ndarray, np.ndarray]:
    """Jobs and segments: two lanes for each bracket, the first one from stop to stop.

    The second one not beyond the begin, where tips settle.
    """
    outer, inner = wells_of(path, eps, needs)
    shown = times * inner / np.maximum(inner + outer, 1e-9)
    slides = np.count_nonzero(path.direction)
    tiles, sampled = 1 + outer / needs.tile, needs.samples * slides * (inner > 0) + shown
    stops = outer / needs.leg + times - shown + 2 * path.edges.size
    return 2 * (tiles + sampled), stops + 2 * tiles + (4 - needs.settles) * sampled


def _weight_of(scene: TabulatedScene) -> float:
    potential = scene.lane_potential
    if not isinstance(potential, BristlePotential):
        return 1.0
    profile, bristle = potential.profile, potential.bristle
    surface = SETTINGS.in_pieces
    if isinstance(profile, SeriesProfile):
        surface = 1 + SETTINGS.a_harmonic * (profile.cos.shape[0] - TABLES.harmonics[0])
    shape = SETTINGS.no_series
    if isinstance(bristle, SeriesBristle):
        shape = 1 + SETTINGS.a_degree * (bristle.ahead.shape[0] - 1 - TABLES.degrees[0])
    return surface * shape
