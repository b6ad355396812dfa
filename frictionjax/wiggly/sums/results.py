"""From what lanes found to the values of each cell."""

from typing import Any, NamedTuple

import numpy as np

from ...numerics import stacked
from ..enclosure import BracketContext, BracketValues, Layout
from ..equation import Status
from ..limit_path import Path
from .cell_sums import (
    NO_DEVIATIONS,
    CellWay,
    deviations,
    energetics,
    no_energetics,
    way_of,
)
from .settings import SETTINGS
from .stop_values import sampled_slides_at, stop_values_of


class Sums(NamedTuple):
    """What cells have besides states: `energies`, and `extremes` of the way."""

    energies: bool
    extremes: bool


class CellResults(NamedTuple):
    """Values of all cells; (cells, n) at the requested times, else (cells,).

    `tolerance`: of steps, in periods. `how`: 0 where one lane has integrated every slip
    since z0, 1 where a bracket has closed, 2 where one has that set off from a slip map.
    `gap`: how closely, in eps. `sampled`: share of the path's way in slides of which only
    some periods were measured, NaN where only the times were. `survey_error`,
    `survey_work_error`: estimates of the errors that this makes in `sup_error` (m), in the
    dissipation or in its distance from the path's (of the dissipation over [0, T]).
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


def nothing_found(cells: int, times: int) -> CellResults:
    """Of cells through which no lane has gone: no values, and no steps."""
    in_time = ("z", "dissipation", "running_residual", "gap")
    columns: dict[str, Any] = dict.fromkeys(CellResults._fields, np.full(cells, np.nan))
    columns |= dict.fromkeys(in_time, np.full((cells, times), np.nan))
    columns |= dict.fromkeys(("steps", "rejected"), np.zeros(cells))
    columns["how"] = np.zeros((cells, times), dtype=int)
    columns["status"] = np.full(cells, int(Status.OPEN_BRACKET))
    return CellResults(**columns)


def _dissipation_of_path(path: Path, times: np.ndarray, states: np.ndarray) -> np.ndarray:
    """What the path dissipates in J up to each time."""
    spent = np.concatenate([[0.0], np.cumsum(path.rho * np.diff(path.states))])
    piece = path.piece_of(times)
    return spent[piece] + path.rho[piece] * (states - path.states[piece])


def evaluate(
    rounds: BracketContext,
    ts: np.ndarray,
    layout: Layout,
    values: BracketValues,
    wanted: Sums,
) -> CellResults:
    """Values of all cells from what was found at the stops of the layout.

    Suprema are NaN where no extremes were `wanted`.
    """
    path, eps = rounds.path, rounds.ground.eps
    stops, z_start, energy0 = stop_values_of(rounds, layout, values)
    guides = path.states_at(ts)
    of_path = _dissipation_of_path(path, ts, guides)
    whole = float(path.travel[-1])
    surveys = sampled_slides_at(layout.slides, stops)
    rows = []
    for c in range(eps.size):
        mine = [i for i, slide in enumerate(layout.slides) if slide.cell == c]
        mine.sort(key=lambda i: layout.slides[i].low)
        cell = way_of(
            chain=layout.chain[c],
            slides=[layout.slides[i] for i in mine],
            surveys=[surveys[i] for i in mine],
            stops=stops,
        )
        output = layout.output[c]
        energies = no_energetics(ts.size)
        if wanted.energies:
            energies = energetics(
                cell=cell,
                stops=stops,
                layout=layout,
                output=output,
                energy0=energy0[c],
                of_path=of_path,
                path=path,
                unit=rounds.accuracy * eps[c],
                eps=eps[c],
            )
        off = deviations(cell, stops) if wanted.extremes else NO_DEVIATIONS
        used = np.concatenate(
            [cell.chain, output[output >= 0], *(slide.stops for slide in cell.slides)]
        )
        unbalanced = wanted.energies and not _is_balanced(cell, eps[c] * path.width)
        row: Any = {
            "z": np.where(output >= 0, stops.z[output], z_start[c]),
            "how": np.where(output >= 0, values.how[output], 0),
            "gap": np.where(output >= 0, values.gap[output], 0.0),
            "sampled": _share(cell, path, whole) if layout.whole else np.nan,
            "status": _status(values.arrivals.code[used], unbalanced),
            "steps": values.steps[c],
            "rejected": values.rejected[c],
            "tolerance": 0.0,
        }
        rows.append(CellResults(**row | energies | off))
    return stacked(rows)


def _share(cell: CellWay, path: Path, whole: float) -> float:
    covered = sum(abs(s.way) for s in cell.slides)
    return float(covered / whole) if whole > 0 else 0.0


def _is_balanced(cell: CellWay, slip: float) -> bool:
    """Whether the energies add up; `slip`: energy of one, J."""
    _, viscous, residual = cell.totals[:, -1]
    return bool(residual <= SETTINGS.residual * (slip + viscous))


def _status(codes: np.ndarray, unbalanced: bool) -> int:
    """What lanes ended with at the stops that are used."""
    bad = codes[codes != 0]
    if bad.size:
        return int(bad[0]) if np.isfinite(bad[0]) else int(Status.NOT_FINITE)
    return int(Status.UNBALANCED if unbalanced else Status.OK)
