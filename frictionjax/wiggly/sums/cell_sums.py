"""Sums over the way of one cell: dissipation, balance, largest deviations from the path."""

from typing import Any, NamedTuple

import numpy as np

from ..enclosure import Brackets, Layout, SampledPeriods
from ..equation import Errors, errors_of_sums
from ..limit_path import DEFICIT, RESIDUAL, SURPLUS, VISCOUS, WORK, Path, SampledSlide
from .settings import SETTINGS
from .stop_values import StopValues


class CellWay(NamedTuple):
    """One cell's way through [0, T]: its chain of stops, and its surveyed slides.

    `totals` (3, chain): running sums in J at the chain's stops, slides before them
    included. `before` (slides, 3): integrals from 0 to the begin of each slide.
    """

    chain: np.ndarray
    slides: list[SampledPeriods]
    surveys: list[SampledSlide]
    totals: np.ndarray
    before: np.ndarray


def way_of(
    chain: np.ndarray,
    slides: list[SampledPeriods],
    surveys: list[SampledSlide],
    stops: StopValues,
) -> CellWay:
    """The cell's running sums, slides of which only some slips were measured included."""
    sums, time = stops.sums[:, chain], stops.time[chain]
    totals, before = np.cumsum(sums, axis=1), np.zeros((len(slides), 3))
    running = np.concatenate([np.zeros((3, 1)), totals], axis=1)
    for k, survey in enumerate(surveys):
        before[k] = running[:, np.searchsorted(time, survey.low, side="right")]
        before[k] += sum(other.whole for other in surveys if other.high <= survey.low)
    for survey in surveys:
        totals += np.where(time > survey.low, survey.whole[:, None], 0.0)
    return CellWay(chain, slides, surveys, totals, before)


def _since_begin(brackets: Brackets, stops: StopValues, chosen: np.ndarray) -> np.ndarray:
    """Integrals in J over the brackets of the chosen stops, up to these, (3, n).

    Times in a rest of the path share a bracket, and lanes sum from one stop to the next.
    """
    owner = brackets.owner[chosen]
    first = np.searchsorted(brackets.owner, owner)
    found = stops.sums[:, chosen]
    later = np.flatnonzero(chosen > first)
    for bracket in np.unique(owner[later]):
        mine = later[owner[later] == bracket]
        begin = first[mine[0]]
        running = np.cumsum(stops.sums[:, begin : chosen[mine].max() + 1], axis=1)
        found[:, mine] = running[:, chosen[mine] - begin]
    return found


def _running(
    cell: CellWay, stops: StopValues, brackets: Brackets, output: np.ndarray
) -> np.ndarray:
    """Integrals in J from 0 to each requested time, (3, n).

    At a stop of the cell's chain, or in a bracket of its own, in a surveyed slide.
    """
    place = np.full(stops.time.size + 1, -1)
    place[cell.chain] = np.arange(cell.chain.size)
    place, known = place[output], output >= 0
    in_chain = (place >= 0) & known
    found = np.where(in_chain, cell.totals[:, np.maximum(place, 0)], 0.0)
    lows = np.array([survey.low for survey in cell.surveys])
    # Where its bracket begins: times of one bracket may be in surveys further on.
    first = np.searchsorted(brackets.owner, brackets.owner[output])
    which = np.searchsorted(lows, stops.time[first], side="right") - 1
    begin = brackets.begin[brackets.owner[output]]
    for k, survey in enumerate(cell.surveys):
        mine = np.flatnonzero(~in_chain & known & (which == k))
        done = survey.integrals(begin[mine])
        since_begin = _since_begin(brackets, stops, output[mine])
        found[:, mine] = cell.before[k][:, None] + done + since_begin
    return found


def energetics(
    cell: CellWay,
    stops: StopValues,
    layout: Layout,
    output: np.ndarray,
    energy0: float,
    of_path: np.ndarray,
    path: Path,
    unit: float,
    eps: float,
) -> dict[str, Any]:
    """Energies of a cell at its outputs and at the end, and how good they are, by the names
    of `CellResults`.

    `int eps^gamma z'^2` is the path's dissipation and what the energies and the work of
    z - path add to it; the direct sum is an independent second value. `unit`: the accuracy
    in m.
    """
    running = _running(cell, stops, layout.brackets, output)
    beyond = energy0 - stops.energy[cell.chain] - cell.totals[WORK]
    errors = _errors(cell, stops, path, unit)
    if _is_summed(cell, errors, path, eps):
        spent = running[VISCOUS]
        gap, worst, lost = _without_slips(cell, stops, energy0, beyond, errors)
    else:
        energy = np.where(output >= 0, stops.energy[output], energy0)
        spent = of_path + energy0 - energy - running[WORK]
        gap, worst, lost = _with_slips(cell, stops, energy0, beyond, path)
    return {
        "dissipation": spent,
        "running_residual": running[RESIDUAL],
        "residual": cell.totals[RESIDUAL, -1],
        "dissipation_gap": gap,
        "dissipation_error": worst,
        "survey_work_error": lost,
    }


def _errors(cell: CellWay, stops: StopValues, path: Path, unit: float) -> Errors:
    """Of the dissipation by either sum, what surveys add included."""
    _, viscous, residual = cell.totals[:, -1]
    size = stops.size[cell.chain].max(initial=0.0)
    errors = errors_of_sums(viscous, residual, size, unit, path.pulled)
    of_sum = errors.of_sum + sum(survey.error_viscous for survey in cell.surveys)
    of_energies = errors.of_energies + sum(s.error_work for s in cell.surveys)
    return Errors(of_sum, of_energies)


def _is_summed(cell: CellWay, errors: Errors, path: Path, eps: float) -> bool:
    """Whether the dissipation is to be summed directly.

    Not over surveyed slides with slips: those drift across the ends of periods.
    """
    few = cell.totals[VISCOUS, -1] < SETTINGS.no_slips * eps * path.pulled
    return bool(errors.sum_is_closer and (few or not cell.surveys))


def _with_slips(cell: CellWay, stops: StopValues, energy0: float, beyond, path: Path):
    """Gap, sup of the error, and what surveys may be off, from energies."""
    final = beyond[-1] + _spent(cell, stops, path)
    gap = _second_opinion(cell, stops, final)
    worst, change = _worst_dissipation(cell, stops, energy0, beyond)
    unsure = np.maximum(change, sum(survey.error_work for survey in cell.surveys))
    return gap, worst, _share(float(unsure), final)


def _without_slips(
    cell: CellWay, stops: StopValues, energy0: float, beyond, errors: Errors
):
    """The same where the motion is smooth, from the direct sum.

    What is dissipated is little of the energies there: 4700 wells from the origin, over a
    way of 5e-7 wells, their differences are 4e-3 off, and this sum 7e-5. On a support of
    100 N/m, surveyed, they are 6% off, and this 6e-5.
    """
    final = float(cell.totals[VISCOUS, -1])
    if not cell.surveys:
        beyond = np.cumsum(stops.beyond[cell.chain])
    worst, change = _worst_dissipation(cell, stops, energy0, beyond)
    unsure = float(sum(survey.error_viscous for survey in cell.surveys))
    shares = _share(unsure, final), _share(change, max(worst, final))
    return float(errors.of_sum), worst, float(np.max(shares))


def _share(error: float, whole: float) -> float:
    return error / max(abs(whole), 1e-300) if error > 0 else error  # NaN stays


def _second_opinion(cell: CellWay, stops: StopValues, final: float) -> float:
    """Estimate in J of the error of the dissipation at the end.

    The direct sum over a surveyed slide is one slip off where slips drift across the ends
    of its periods; there the survey's own estimate and the residual stand in for it.
    """
    if cell.surveys:
        guessed = sum(survey.error_work for survey in cell.surveys)
        return guessed + float(cell.totals[RESIDUAL, -1])
    return abs(float(cell.totals[VISCOUS, -1]) - final)


def no_energetics(size: int) -> dict[str, Any]:
    """What `energetics` would give, all NaN, and nothing that surveys spoil."""
    series = dict.fromkeys(("dissipation", "running_residual"), np.full(size, np.nan))
    numbers = ("residual", "dissipation_gap", "dissipation_error")
    return series | dict.fromkeys(numbers, np.nan) | {"survey_work_error": 0.0}


def _spent(cell: CellWay, stops: StopValues, path: Path) -> float:
    """The path's dissipation in J over [0, T], from the segments and slides of the cell."""
    segments = float(np.sum(stops.sums[VISCOUS, cell.chain] - stops.beyond[cell.chain]))
    return segments + sum(path.rho[s.piece] * s.way for s in cell.slides)


def _worst_dissipation(cell, stops, energy0, beyond) -> tuple[float, float]:
    """Largest distance of the dissipation from the path's, and the error of it."""
    surpluses = stops.beyond[cell.chain]
    start = beyond - surpluses
    # Where the path rests they grow all the way: largest at the ends, which are known.
    rests = surpluses == stops.sums[VISCOUS, cell.chain]
    extremes = stops.extremes[SURPLUS:, cell.chain]
    most, least = np.where(rests, beyond, start + extremes)
    rows = [(np.max(most, initial=0.0), -np.min(least, initial=0.0))]
    for before, survey in zip(cell.before, cell.surveys, strict=True):
        left = energy0 - before[WORK] - survey.work
        over, under = survey.extremes[SURPLUS], survey.extremes[DEFICIT]
        rows.append((np.max(left + over), -np.min(left + under)))
    values = np.max(np.array(rows), axis=1)
    errors = np.array([0.0, *(survey.error_surplus for survey in cell.surveys)])
    return float(values.max()), _change(values, errors)


NO_DEVIATIONS = {"sup_error": np.nan, "strip_excess": np.nan, "survey_error": 0.0}


def deviations(cell: CellWay, stops: StopValues) -> dict[str, float]:
    """Largest |z - path| of the whole way, and largest way from the strip to z, and by how
    much surveys may change them, by the names of `CellResults`; m.

    The first wells of a slide are surveyed most roughly, where z is still near the path:
    only what may be the largest of all counts.
    """
    ahead, behind, outside = stops.extremes[:SURPLUS, cell.chain]
    rows = [(np.max(np.maximum(ahead, -behind)), np.max(outside, initial=0.0), 0.0)]
    for survey in cell.surveys:
        ahead, behind, outside = survey.extremes[:SURPLUS]
        far = np.max(np.maximum(ahead, -behind))
        rows.append((far, np.max(outside), survey.error_extreme))
    *both, errors = np.array(rows).T
    changes = [_change(values, errors) for values in both]
    far, outside = (float(values.max()) for values in both)
    return {"sup_error": far, "strip_excess": outside, "survey_error": max(changes)}


def _change(values: np.ndarray, errors: np.ndarray) -> float:
    """By how much the largest value may change where each may by its error."""
    largest = values.max()
    lowest, highest = (values - errors).max(), (values + errors).max()
    return float(max(highest - largest, largest - lowest))
