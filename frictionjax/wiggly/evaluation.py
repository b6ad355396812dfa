"""From what lanes found to the values of each cell."""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from ..arguments import Real
from ..scene import Scene
from .lanes import Arrivals, Legs
from .layout import Layout, Slide
from .path import Path, states_at
from .status import Status
from .survey import Survey, survey_of

_LEAST = 1024  # stops of one compiled call
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
    since z0, 1 where a bracket has closed, 2 where one has set off from a slip map. `gap`: how closely, in eps. `sampled`: share of
    the path's way in slides of which only some periods were measured. `survey_error`,
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


@eqx.filter_jit
def _energies(scene: Scene, eps, well, tip, t, guide):
    """z in m at stops, and E_eps of z less E of the guide, in J."""

    def one(eps: Real, well: Real, tip: Real, t: Real, guide: Real):
        z = eps * (well + tip) + scene.potential.offset(tip, eps)
        wiggle = scene.potential.tip_energy_change(tip, eps)
        elastic = scene.support.energy(z) - scene.support.energy(guide)
        return z, elastic - scene.load(t) * (z - guide) + wiggle

    return jax.vmap(one)(eps, well, tip, t, guide)


def _states(scene: Scene, eps, well, tip, t, guide) -> tuple[np.ndarray, np.ndarray]:
    size = _LEAST
    while size < eps.size:
        size *= 4
    columns = (
        np.pad(c, (0, size - c.size), mode="edge") for c in (eps, well, tip, t, guide)
    )
    z, energy = _energies(scene, *(jnp.asarray(c) for c in columns))
    return np.asarray(z)[: eps.size], np.asarray(energy)[: eps.size]


class _Stops(NamedTuple):
    """What the sums need of every stop, shape (S,)."""

    time: np.ndarray
    z: np.ndarray
    energy: np.ndarray
    work: np.ndarray
    viscous: np.ndarray
    residual: np.ndarray
    beyond: np.ndarray
    surplus: np.ndarray
    deficit: np.ndarray
    ahead: np.ndarray
    behind: np.ndarray
    sliding: np.ndarray


def _stops(scene: Scene, layout: Layout, found: Found, eps: np.ndarray) -> _Stops:
    windows, a, legs = layout.windows, found.arrivals, found.legs
    size = eps[windows.cell[windows.owner]]
    z, energy = _states(scene, size, a.well, a.tip, windows.stop, legs.guide1)
    rise = legs.guide1 - legs.guide0
    moved = legs.end > legs.start
    return _Stops(
        time=windows.stop,
        z=z,
        energy=energy,
        work=a.work,
        viscous=a.viscous,
        residual=a.residual,
        beyond=a.viscous - legs.friction * rise,
        surplus=a.surplus,
        deficit=a.deficit,
        ahead=np.where(moved, a.ahead, 0.0),
        behind=np.where(moved, a.behind, 0.0),
        sliding=np.sign(rise),
    )


def _survey(slide: Slide, stops: _Stops) -> Survey:
    """Curves through the periods measured in one slide."""
    at = slide.stops
    start = -(stops.energy[at] + stops.work[at] + stops.beyond[at])
    sums = {"work": stops.work, "viscous": stops.viscous, "residual": stops.residual}
    extremes = {
        "ahead": stops.ahead[at],
        "behind": stops.behind[at],
        "surplus": stops.surplus[at] + start,
        "deficit": stops.deficit[at] + start,
    }
    return survey_of(
        slide.low,
        slide.high,
        slide.starts,
        slide.ends,
        {name: value[at] for name, value in sums.items()},
        extremes,
    )


class _Cell(NamedTuple):
    """One cell's way through [0, T]: its chain of stops, and its surveyed slides."""

    chain: np.ndarray
    slides: list[Slide]
    surveys: list[Survey]

    def total(self, name: str, stops: _Stops) -> np.ndarray:
        """Running sum at the chain's stops, slides before them included."""
        sums = np.cumsum(getattr(stops, name)[self.chain])
        for survey in self.surveys:
            whole = survey.integral(getattr(survey, name), np.array([survey.high]))[0]
            sums = sums + np.where(stops.time[self.chain] > survey.low, whole, 0.0)
        return sums

    def before(self, survey: Survey, stops: _Stops, name: str = "work") -> float:
        """Integral in J from 0 to the begin of a surveyed slide."""
        earlier = stops.time[self.chain] <= survey.low
        total = float(np.sum(getattr(stops, name)[self.chain[earlier]]))
        for other in self.surveys:
            if other.high <= survey.low:
                total += other.integral(getattr(other, name), np.array([other.high]))[0]
        return total


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
    balanced: bool,
    start: tuple[np.ndarray, np.ndarray],
) -> Answers:
    """Values of all cells from what was found at the stops of the layout."""
    stops = _stops(scene, layout, found, eps)
    count = eps.size
    guide = np.full(count, path.states[0])
    z_start, energy0 = _states(scene, eps, *start, np.zeros(count), guide)
    guides = states_at(scene, path, ts)
    of_path = _dissipation_of_path(path, ts, guides)
    whole = float(path.travel[-1])
    rows = []
    for c in range(count):
        slides = sorted(
            (s for s in layout.slides if s.cell == c), key=lambda slide: slide.low
        )
        cell = _Cell(layout.chain[c], slides, [_survey(s, stops) for s in slides])
        energetics = _no_energetics(ts.size)
        if balanced:
            of = layout, layout.output[c], energy0[c], of_path, path
            energetics = _energetics(cell, stops, *of)
        output = layout.output[c]
        z = np.where(output >= 0, stops.z[output], z_start[c])
        rows.append(
            (
                z,
                *energetics,
                *_deviations(cell, stops),
                np.where(output >= 0, found.how[output], 0),
                np.where(output >= 0, found.gap[output], 0.0),
                _share(cell, path, whole),
                max([s.error_extreme for s in cell.surveys], default=0.0),
                sum(s.error_work for s in cell.surveys) if balanced else 0.0,
                _status(cell, stops, layout, found, output, path, eps[c], balanced),
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


def _running(cell: _Cell, stops: _Stops, outputs: _Outputs, name: str) -> np.ndarray:
    """Integral in J from 0 to each requested time."""
    in_chain = (outputs.place >= 0) & (outputs.stop >= 0)
    sums = cell.total(name, stops)
    found = np.where(in_chain, sums[np.maximum(outputs.place, 0)], 0.0)
    for k, survey in enumerate(cell.surveys):
        mine = np.flatnonzero(~in_chain & (outputs.stop >= 0) & (outputs.survey == k))
        done = survey.integral(getattr(survey, name), outputs.begin[mine])
        own = getattr(stops, name)[outputs.stop[mine]]
        found[mine] = cell.before(survey, stops, name) + done + own
    return found


def _energetics(cell, stops, layout, output, energy0, of_path, path):
    """Dissipation and residual at the outputs, gap at the end, sup of the error, all in J.

    `int eps^gamma z'^2` is the path's dissipation and what the energies and the work of
    z - path add to it; the direct sum is an independent second value.
    """
    outputs = _outputs(cell, stops, layout, output)
    work = _running(cell, stops, outputs, "work")
    energy = np.where(output >= 0, stops.energy[output], energy0)
    beyond = energy0 - stops.energy[cell.chain] - cell.total("work", stops)
    final = beyond[-1] + _spent(cell, stops, path)
    return (
        of_path + energy0 - energy - work,
        _running(cell, stops, outputs, "residual"),
        cell.total("residual", stops)[-1],
        _second_opinion(cell, stops, final),
        _worst_dissipation(cell, stops, energy0, beyond),
    )


def _second_opinion(cell: _Cell, stops: _Stops, final: float) -> float:
    """Estimate in J of the error of the dissipation at the end.

    The direct sum over a surveyed slide is one slip off where slips drift across the ends
    of its periods; there the survey's own estimate and the residual stand in for it.
    """
    if cell.surveys:
        guessed = sum(survey.error_work for survey in cell.surveys)
        return guessed + float(cell.total("residual", stops)[-1])
    return abs(float(cell.total("viscous", stops)[-1]) - final)


def _no_energetics(size: int) -> tuple:
    nothing = np.full(size, np.nan)
    return nothing, nothing, np.nan, np.nan, np.nan


def _spent(cell: _Cell, stops: _Stops, path: Path) -> float:
    """The path's dissipation in J over [0, T], from the legs and slides of the cell."""
    legs = float(np.sum((stops.viscous - stops.beyond)[cell.chain]))
    return legs + sum(path.rho[s.piece] * s.way for s in cell.slides)


def _worst_dissipation(cell, stops, energy0, beyond) -> float:
    start = beyond - stops.beyond[cell.chain]
    high = np.max(start + stops.surplus[cell.chain], initial=0.0)
    low = np.min(start + stops.deficit[cell.chain], initial=0.0)
    for survey in cell.surveys:
        fine = survey.fine()
        done = cell.before(survey, stops) + survey.integral(survey.work, fine)
        high = max(high, np.max(energy0 - done + survey.curve(survey.surplus, fine)))
        low = min(low, np.min(energy0 - done + survey.curve(survey.deficit, fine)))
    return float(max(high, -low))


def _deviations(cell: _Cell, stops: _Stops) -> tuple[float, float]:
    """Largest |z - path|, and by how much z lags outside the strip, in m."""
    ahead, behind = stops.ahead[cell.chain], stops.behind[cell.chain]
    sliding = stops.sliding[cell.chain]
    lags = np.where(sliding > 0, -behind, np.where(sliding < 0, ahead, 0.0))
    far, lag = np.max(np.maximum(ahead, -behind)), np.max(lags, initial=0.0)
    for slide, survey in zip(cell.slides, cell.surveys, strict=True):
        fine = survey.fine()
        high = float(np.max(survey.curve(survey.ahead, fine)))
        low = float(np.min(survey.curve(survey.behind, fine)))
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
        slip = eps * (path.rho_plus - path.rho_minus)
        viscous = cell.total("viscous", stops)[-1]
        residual = cell.total("residual", stops)[-1]
        if not residual <= _RESIDUAL_SHARE * (slip + viscous):
            return int(Status.UNBALANCED)
    return int(Status.OK)
