"""The report of what accuracy costs, as a page."""

import time
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from .._text import ResultTable
from ..model import friction
from ..studies import flag_names
from ..wiggly import Status
from .job import Job, ReportRequest
from .page import (
    Captioned,
    Page,
    Section,
    definitions,
    items,
    page_text,
    paragraph,
    shown,
    table_region,
)
from .sections import (
    Origin,
    coefficient_section,
    origin_section,
    reproduction_section,
    scene_section,
    scene_sentence,
    status_legend,
    words_section,
)


class MeasuredCell(NamedTuple):
    """Of one eps and gamma: a title, what it was judged by, a line for each run."""

    title: str
    judged_by: str
    table: ResultTable


class CostFacts(NamedTuple):
    """What was measured; `columns`: what those of the tables mean; `seconds`: after which
    a run was ended."""

    job: Job
    data: xr.Dataset
    cells: Sequence[MeasuredCell]
    columns: str
    coefficients: ResultTable
    picture: Figure
    toml: str
    seconds: float


_WORDS = (
    *("eps", "gamma", "state z", "accuracy", "reference", "slip", "cell", "residual"),
    *("dissipation", "rho", "alpha", "omega", "ratio"),
)
_ABOUT = (
    "To follow a bristle through all slips over a surface costs computing time, and the "
    "more accurate, the more. Here methods compute the same motion at several accuracies, "
    "are timed side by side, and are judged by a reference, the same motion computed in "
    "two ways, which is known as well as these agree: their own word that they have "
    "succeeded is not taken for it."
)
_PYTHON = """\
import frictionjax as fx
import xarray as xr

data = xr.load_dataset("cost.nc", engine="h5netcdf")
fx.plot.draw_work_precision(data)"""
_FILES = (
    ("cost.nc", "every number measured (NetCDF), with units"),
    ("scene.toml", "the scene"),
    ("tables.txt", "the tables as text"),
    ("work_precision.png", "the picture of this page"),
)


def cost_page(facts: CostFacts, asked: ReportRequest) -> str:
    """The page: which method to take, all runs, what was wrong, what judged them."""
    job, data = facts.job, facts.data
    law = friction(job.scene)
    cell = _shown_cell(data)
    origin = _origin(facts, asked)
    return page_text(
        Page(
            title="What accuracy costs",
            about=_ABOUT,
            verdict=verdict_of_cost(data),
            first=[items(job.notes)] if job.notes else [],
            sections=[
                _picture_section(facts),
                *_runs(facts),
                _failures(data),
                _judged(facts),
                scene_section(job.scene, law, float(cell.eps), float(cell.gamma)),
                coefficient_section(law, facts.coefficients),
                _cost(data),
                origin_section(origin),
                reproduction_section(origin, facts.toml, [_again(facts)], _FILES, _PYTHON),
                words_section(_WORDS),
            ],
            made_by=f"Written by {data.attrs.get('source', 'frictionjax')}. "
            f"{scene_sentence(job.scene)}",
        )
    )


def _again(facts: CostFacts) -> str:
    """The command with everything in it: the scene file does not hold all."""
    data = facts.data
    lists = {
        "eps": [f"{float(v)!r}" for v in data.eps.values],
        "gamma": [f"{float(v)!r}" for v in data.gamma.values],
        "accuracies": [f"{float(v)!r}" for v in data.accuracy.values],
        "methods": map(str, data.solver.values),
    }
    options = " ".join(f"--{name} {','.join(values)}" for name, values in lists.items())
    rest = f"--seconds {facts.seconds:g} --out again --report"
    return f"frictionjax cost scene.toml {options} {rest}"


def _shown_cell(data: xr.Dataset) -> xr.Dataset:
    """The cell of the picture: smallest eps, gamma nearest to 1."""
    nearest = int(np.argmin(np.abs(data.gamma.values - 1.0)))
    return data.isel(gamma=nearest).sel(eps=float(data.eps.min()))


def verdict_of_cost(data: xr.Dataset) -> str:
    """Which method to take, as the shell says it, and what cannot be trusted."""
    return f"{data.attrs['advice']} {_trust(data)}"


def _trust(data: xr.Dataset) -> str:
    """How many runs reported success and were wrong, how many are not done or tried."""
    count, wrong = data.status.size, int(np.sum(data.wrong.values > 0))
    untried = int(np.sum(data.status.values == int(Status.NOT_TRIED)))
    undone = int(np.sum(data.status.values != int(Status.OK))) - untried
    said = (
        f"Of {count} runs {wrong or 'none'} reported success and {_were(wrong)} half an "
        "eps or more off"
    )
    if wrong:
        named = [
            f"`{name}` {int(np.sum(data.wrong.sel(solver=name).values > 0))}"
            for name in map(str, data.solver.values)
            if np.any(data.wrong.sel(solver=name).values > 0)
        ]
        said += f" ({', '.join(named)})"
    slow = f"{undone or 'none'} {_were(undone)} too slow or failed"
    if untried:
        return f"{said}, {slow}, and {untried} {_were(untried)} not tried."
    return f"{said}, and {slow}."


def _were(count: int) -> str:
    return "was" if count == 1 else "were"


def _picture_section(facts: CostFacts) -> Section:
    drawn = Captioned(facts.picture, _picture_told(facts.data), _CAPTION)
    return Section("Error against time", [shown(drawn, "work and precision")])


_CAPTION = (
    "Above, left: error against seconds, a line for each method, lower left is better; the "
    "yellow band joins runs that nothing beats in both. Right: is the accuracy that was "
    "asked for kept? Above the stairs it is not. Below, where there are several cells: "
    "seconds, and error over accuracy, at the accuracy in the middle."
)


def _picture_told(data: xr.Dataset) -> str:
    cell = _shown_cell(data)
    lines = [
        "Graphs of error against seconds, and of error reached against accuracy asked for, "
        f"at eps = {float(cell.eps):.4g} m, gamma = {float(cell.gamma):.4g}."
    ]
    for solver in map(str, cell.solver.values):
        runs = cell.sel(solver=solver)
        known = np.isfinite(runs.error.values) & np.isfinite(runs.seconds.values)
        if not known.any():
            lines.append(f"{solver}: no run is known.")
            continue
        best = int(np.nanargmin(np.where(known, runs.error.values, np.nan)))
        lines.append(
            f"{solver}: at best {float(runs.error[best]):.1e} eps off in "
            f"{float(runs.seconds[best]):.3g} s."
        )
    return " ".join(lines)


def _runs(facts: CostFacts) -> list[Section]:
    blocks = [paragraph(facts.columns)]
    blocks += [table_region(one.table, f"Runs at {one.title}") for one in facts.cells]
    return [Section("Every run", blocks)]


def _failures(data: xr.Dataset) -> Section:
    rows = _failed_rows(data)
    blocks = [paragraph(_trust(data))]
    if rows:
        header = ("gamma", "eps/m", "solver", "asked", "status", "why")
        table = ResultTable(header, tuple(rows), left=3, meanings=1)
        blocks.append(table_region(table, "Runs that failed or were not tried"))
    codes = data.status.values.ravel().tolist()
    legend = table_region(status_legend(codes), "What statuses mean", as_csv=False)
    return Section("What failed", [*blocks, legend])


_WRONG = "success was reported half an eps or more off, and further than asked for"


def _failed_rows(data: xr.Dataset) -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = []
    names = flag_names(data.status)
    runs = data[["status", "wrong"]].stack(run=("gamma", "eps", "solver", "accuracy"))
    for place in range(runs.run.size):
        run = runs.isel(run=place)
        code, wrong = int(run.status), bool(run.wrong > 0)
        if code == Status.OK and not wrong:
            continue
        gamma, eps, solver, accuracy = run.run.item()
        status = "wrong" if wrong else names[code]
        why = _WRONG if wrong else Status.of(code).message
        method = f"{gamma:.4g}", f"{eps:.4g}", str(solver)
        asked = f"{accuracy:.0e}"
        if rows and (*rows[-1][:3], *rows[-1][4:]) == (*method, status, why):
            asked = f"{rows.pop()[3]}, {asked}"  # a line for all that ended alike
        rows.append((*method, asked, status, why))
    return rows


def _judged(facts: CostFacts) -> Section:
    blocks = [paragraph(_REFERENCE)]
    lines = [f"{one.title}: {'; '.join(one.judged_by.splitlines())}" for one in facts.cells]
    return Section("What judges the runs", [*blocks, items(lines)])


_REFERENCE = (
    "Every run is held against the same motion computed in two ways that do not share "
    "their errors, at tighter tolerances. The error of a run that differs by less than "
    "these two do cannot be told: their difference is printed (`<`). The residual of the "
    "energy balance, in energies of one slip, is a second judge, which needs no reference."
)


def _cost(data: xr.Dataset) -> Section:
    timed = np.nansum(data.seconds.values * np.maximum(data.runs.values, 1))
    entries = [
        ("runs timed", f"{int(np.sum(data.runs.values))}"),
        ("seconds in them", f"{timed:.3g} s"),
        ("compilation", f"{np.nansum(data.compile_seconds.values):.3g} s, all first calls"),
    ]
    return Section("What it cost to measure", [definitions(entries)])


def _origin(facts: CostFacts, asked: ReportRequest) -> Origin:
    data = facts.data
    told = [
        ("methods", ", ".join(map(str, data.solver.values))),
        ("accuracies", f"{', '.join(f'{v:.0e}' for v in data.accuracy.values)}, in eps"),
        ("eps", f"{', '.join(f'{v:.4g}' for v in data.eps.values)} m"),
        ("gamma", ", ".join(f"{v:.4g}" for v in data.gamma.values)),
    ]
    return Origin(asked.command, time.perf_counter() - asked.started, told)
