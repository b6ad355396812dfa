"""From what lanes found to the values of each cell."""

from typing import NamedTuple

import jax
import numpy as np

from ..arguments import Real
from ..programs import Program, in_chunks
from ..scene import Scene
from .job_queue import Arrivals, Legs
from .lane import Sums
from .layout import Layout, Slide
from .path import Path, states_at
from .status import Status
from .survey import (
    AHEAD,
    BEHIND,
    DEFICIT,
    RESIDUAL,
    SURPLUS,
    VISCOUS,
    WORK,
    Survey,
    surveys_of,
)

_CHUNK = 2048  # stops of one compiled call
_RESIDUAL_SHARE = 0.05  # of the energy dissipated; solutions leave about 1e-6 of it


class Found(NamedTuple):
    """Values at all stops of a layout, shape (S,), and of the legs that lead to them.

    `gap`: how closely brackets have closed, in eps; `how`: as in `Answers`.
    `steps`, `rejected`: of each cell.
    """

    arrivals: Arrivals
    legs: Legs
    gap: np.ndarray
    how: np.ndarray
    steps: np.ndarray
    rejected: np.ndarray


class Answers(NamedTuple):
    """Values of all cells; (cells, n) at the requested times, else (cells,).

    `tolerance`: of steps, in periods. `how`: 0 where one lane has integrated every slip
    since z0, 1 where a bracket has closed, 2 where one has that set off from a slip map.
    `gap`: how closely, in eps. `sampled`: share of the path's way in slides of which only
    some periods were measured, NaN where only the times were. `survey_error`,
    `survey_work_error`: estimates of the errors that this makes in `sup_error` (m) and in
    the dissipation (J).
    """

    z: np.ndarray
    dissipation: np.ndarray
    running_residual: np.ndarray
    residual: np.ndarray
    dissipation_gap: np.ndarray
    dissipation_error: np.ndarray
    sup_error: np.ndarray
    strip_excess: np.ndarray
    how: np.ndarray
    gap: np.ndarray
    sampled: np.ndarray
    survey_error: np.ndarray
    survey_work_error: np.ndarray
    status: np.ndarray
    steps: np.ndarray
    rejected: np.ndarray
    tolerance: np.ndarray


@Program
def _energies(scene: Scene, eps, well, tip, t, guide):
    """z in m at stops, and E_eps of z less E of the guide, in J."""

    def one(eps: Real, well: Real, tip: Real, t: Real, guide: Real):
        z = eps * (well + tip) + scene.potential.offset(tip, eps)
        wiggle = scene.potential.tip_energy_change(tip, eps)
        elastic = scene.support.energy(z) - scene.support.energy(guide)
        return z, elastic - scene.load(t) * (z - guide) + wiggle

    return jax.vmap(one)(eps, well, tip, t, guide)


def _states(scene: Scene, eps, well, tip, t, guide) -> tuple[np.ndarray, np.ndarray]:
    z, energy = in_chunks(_energies, _CHUNK, (scene,), (eps, well, tip, t, guide))
    return z, energy


class _Stops(NamedTuple):
    """What the sums need of every stop, shape (S,); `sums` (3, S), `extremes` (4, S)."""

    time: np.ndarray
    z: np.ndarray
    energy: np.ndarray
    sums: np.ndarray
    beyond: np.ndarray
    extremes: np.ndarray
    sliding: np.ndarray


def _stops(scene: Scene, layout: Layout, found: Found, eps: np.ndarray) -> _Stops:
    windows, a, legs = layout.windows, found.arrivals, found.legs
    size = eps[windows.cell[windows.owner]]
    z, energy = _states(scene, size, a.well, a.tip, windows.stop, legs.guide1)
    rise = legs.guide1 - legs.guide0
    moved = legs.end > legs.start
    ways, surpluses = (a.ahead, a.behind), (a.surplus, a.deficit)
    return _Stops(
        time=windows.stop,
        z=z,
        energy=energy,
        sums=np.stack([a.work, a.viscous, a.residual]),
        beyond=a.viscous - legs.friction * rise,
        extremes=np.stack([*(np.where(moved, v, 0.0) for v in ways), *surpluses]),
        sliding=np.sign(rise),
    )


def _surveys(slides: list[Slide], stops: _Stops) -> dict[int, Survey]:
    """Curves through the periods measured in each slide, by the number of the slide."""
    found: dict[int, Survey] = {}
    counts = np.array([slide.stops.size for slide in slides])
    for count in np.unique(counts):
        mine = np.flatnonzero(counts == count)
        some = [slides[i] for i in mine]
        at = np.stack([slide.stops for slide in some])
        sums = stops.sums[:, at].swapaxes(0, 1)
        extremes = stops.extremes[:, at].swapaxes(0, 1)
        start = stops.energy[at] + sums[:, WORK] + stops.beyond[at]
        extremes[:, SURPLUS:] -= start[:, None]
        low, high = np.array([(slide.low, slide.high) for slide in some]).T
        starts = np.stack([slide.starts for slide in some])
        ends = np.stack([slide.ends for slide in some])
        fits = surveys_of(low, high, starts, ends, sums, extremes)
        found |= zip(mine.tolist(), fits, strict=True)
    return found


class _Cell(NamedTuple):
    """One cell's way through [0, T]: its chain of stops, and its surveyed slides.

    `totals` (3, chain): running sums in J at the chain's stops, slides before them
    included. `before` (slides, 3): integrals from 0 to the begin of each slide.
    """

    chain: np.ndarray
    slides: list[Slide]
    surveys: list[Survey]
    totals: np.ndarray
    before: np.ndarray


def _cell_of(
    chain: np.ndarray, slides: list[Slide], surveys: list[Survey], stops: _Stops
) -> _Cell:
    own, time = stops.sums[:, chain], stops.time[chain]
    totals, before = np.cumsum(own, axis=1), np.zeros((len(slides), 3))
    running = np.concatenate([np.zeros((3, 1)), totals], axis=1)
    for k, survey in enumerate(surveys):
        before[k] = running[:, np.searchsorted(time, survey.low, side="right")]
        before[k] += sum(other.whole for other in surveys if other.high <= survey.low)
    for survey in surveys:
        totals += np.where(time > survey.low, survey.whole[:, None], 0.0)
    return _Cell(chain, slides, surveys, totals, before)


def _dissipation_of_path(path: Path, times: np.ndarray, states: np.ndarray) -> np.ndarray:
    """What the path dissipates in J up to each time."""
    spent = np.concatenate([[0.0], np.cumsum(path.rho * np.diff(path.states))])
    piece = path.piece_of(times)
    return spent[piece] + path.rho[piece] * (states - path.states[piece])


def evaluate(
    scene: Scene,
    path: Path,
    eps: np.ndarray,
    ts: np.ndarray,
    layout: Layout,
    found: Found,
    wanted: Sums,
    start: tuple[np.ndarray, np.ndarray],
) -> Answers:
    """Values of all cells from what was found at the stops of the layout.

    Suprema are NaN where no extremes were `wanted`.
    """
    stops = _stops(scene, layout, found, eps)
    count = eps.size
    guide = np.full(count, path.states[0])
    z_start, energy0 = _states(scene, eps, *start, np.zeros(count), guide)
    guides = states_at(scene, path, ts)
    of_path = _dissipation_of_path(path, ts, guides)
    whole = float(path.travel[-1])
    surveys = _surveys(layout.slides, stops)
    rows = []
    for c in range(count):
        mine = [i for i, slide in enumerate(layout.slides) if slide.cell == c]
        mine.sort(key=lambda i: layout.slides[i].low)
        own = [layout.slides[i] for i in mine], [surveys[i] for i in mine]
        cell = _cell_of(layout.chain[c], *own, stops)
        energetics = _no_energetics(ts.size)
        if wanted.energies:
            of = layout, layout.output[c], energy0[c], of_path, path, eps[c]
            energetics = _energetics(cell, stops, *of)
        output = layout.output[c]
        z = np.where(output >= 0, stops.z[output], z_start[c])
        rows.append(
            (
                z,
                *energetics,
                *(_deviations(cell, stops) if wanted.extremes else (np.nan, np.nan)),
                np.where(output >= 0, found.how[output], 0),
                np.where(output >= 0, found.gap[output], 0.0),
                _share(cell, path, whole) if layout.whole else np.nan,
                max([s.error_extreme for s in cell.surveys], default=0.0),
                sum(s.error_work for s in cell.surveys) if wanted.energies else 0.0,
                _status(cell, stops, layout, found, output, path, eps[c], wanted.energies),
            )
        )
    columns = [np.array(column) for column in zip(*rows, strict=True)]
    return Answers._make([*columns, found.steps, found.rejected, np.zeros(count)])


class _Outputs(NamedTuple):
    """Where in a cell's chain or in which surveyed slide each requested time is."""

    stop: np.ndarray
    place: np.ndarray
    survey: np.ndarray
    begin: np.ndarray


def _outputs(cell: _Cell, stops: _Stops, layout: Layout, output: np.ndarray) -> _Outputs:
    place = np.full(stops.time.size + 1, -1)
    place[cell.chain] = np.arange(cell.chain.size)
    lows = np.array([survey.low for survey in cell.surveys])
    survey = np.searchsorted(lows, stops.time[output], side="right") - 1
    begin = layout.windows.begin[layout.windows.owner[output]]
    return _Outputs(output, place[output], survey, begin)


def _running(cell: _Cell, stops: _Stops, outputs: _Outputs) -> np.ndarray:
    """Integrals in J from 0 to each requested time, (3, n)."""
    in_chain = (outputs.place >= 0) & (outputs.stop >= 0)
    found = np.where(in_chain, cell.totals[:, np.maximum(outputs.place, 0)], 0.0)
    for k, survey in enumerate(cell.surveys):
        mine = np.flatnonzero(~in_chain & (outputs.stop >= 0) & (outputs.survey == k))
        done = survey.integrals(outputs.begin[mine])
        own = stops.sums[:, outputs.stop[mine]]
        found[:, mine] = cell.before[k][:, None] + done + own
    return found


def _energetics(cell, stops, layout, output, energy0, of_path, path, eps):
    """Dissipation and residual at the outputs, gap at the end, sup of the error, all in J.

    `int eps^gamma z'^2` is the path's dissipation and what the energies and the work of
    z - path add to it; the direct sum is an independent second value.
    """
    outputs = _outputs(cell, stops, layout, output)
    running = _running(cell, stops, outputs)
    energy = np.where(output >= 0, stops.energy[output], energy0)
    beyond = energy0 - stops.energy[cell.chain] - cell.totals[WORK]
    final = beyond[-1] + _spent(cell, stops, path)
    spent = of_path + energy0 - energy - running[WORK]
    gap = _second_opinion(cell, stops, final)
    if not cell.surveys and cell.totals[VISCOUS, -1] < eps * path.width:
        # Before the first slip the motion is smooth and dissipates little of the energies:
        # 4700 wells from the origin, over a way of 5e-7 wells, their differences are 4e-3
        # off, and this sum 7e-5.
        spent, gap = running[VISCOUS], float(cell.totals[RESIDUAL, -1])
    return (
        spent,
        running[RESIDUAL],
        cell.totals[RESIDUAL, -1],
        gap,
        _worst_dissipation(cell, stops, energy0, beyond),
    )


def _second_opinion(cell: _Cell, stops: _Stops, final: float) -> float:
    """Estimate in J of the error of the dissipation at the end.

    The direct sum over a surveyed slide is one slip off where slips drift across the ends
    of its periods; there the survey's own estimate and the residual stand in for it.
    """
    if cell.surveys:
        guessed = sum(survey.error_work for survey in cell.surveys)
        return guessed + float(cell.totals[RESIDUAL, -1])
    return abs(float(cell.totals[VISCOUS, -1]) - final)


def _no_energetics(size: int) -> tuple:
    nothing = np.full(size, np.nan)
    return nothing, nothing, np.nan, np.nan, np.nan


def _spent(cell: _Cell, stops: _Stops, path: Path) -> float:
    """The path's dissipation in J over [0, T], from the legs and slides of the cell."""
    legs = float(np.sum(stops.sums[VISCOUS, cell.chain] - stops.beyond[cell.chain]))
    return legs + sum(path.rho[s.piece] * s.way for s in cell.slides)


def _worst_dissipation(cell, stops, energy0, beyond) -> float:
    start = beyond - stops.beyond[cell.chain]
    surplus, deficit = stops.extremes[SURPLUS:, cell.chain]
    high = np.max(start + surplus, initial=0.0)
    low = np.min(start + deficit, initial=0.0)
    for before, survey in zip(cell.before, cell.surveys, strict=True):
        left = energy0 - before[WORK] - survey.work
        high = max(high, np.max(left + survey.extremes[SURPLUS]))
        low = min(low, np.min(left + survey.extremes[DEFICIT]))
    return float(max(high, -low))


def _deviations(cell: _Cell, stops: _Stops) -> tuple[float, float]:
    """Largest |z - path|, and by how much z lags outside the strip, in m."""
    ahead, behind = stops.extremes[:SURPLUS, cell.chain]
    sliding = stops.sliding[cell.chain]
    lags = np.where(sliding > 0, -behind, np.where(sliding < 0, ahead, 0.0))
    far, lag = np.max(np.maximum(ahead, -behind)), np.max(lags, initial=0.0)
    for slide, survey in zip(cell.slides, cell.surveys, strict=True):
        high = float(np.max(survey.extremes[AHEAD]))
        low = float(np.min(survey.extremes[BEHIND]))
        far = max(far, high, -low)
        sign = stops.sliding[slide.stops[0]]
        lag = max(lag, -low if sign > 0 else high if sign < 0 else 0.0)
    return float(far), float(lag)


def _share(cell: _Cell, path: Path, whole: float) -> float:
    covered = sum(abs(s.way) for s in cell.slides)
    return float(covered / whole) if whole > 0 else 0.0


def _status(cell, stops, layout, found, output, path, eps, balanced) -> int:
    used = np.concatenate(
        [cell.chain, output[output >= 0], *(s.stops for s in cell.slides)]
    )
    codes = found.arrivals.code[used]
    bad = codes[codes != 0]
    if bad.size:
        return int(bad[0]) if np.isfinite(bad[0]) else int(Status.NOT_FINITE)
    if balanced:
        slip = eps * path.width
        _, viscous, residual = cell.totals[:, -1]
        if not residual <= _RESIDUAL_SHARE * (slip + viscous):
            return int(Status.UNBALANCED)
    return int(Status.OK)
