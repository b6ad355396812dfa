"""What accuracy costs on the user's machine: measurements, table, picture, files."""

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from .._checks import write_whole
from .._text import ResultTable
from ..coefficients import coefficient_table
from ..cost import slips_of, work_precision
from ..effects import Engine, require_done
from ..io import scene_document
from ..model import Scene, friction
from ..plot import draw_work_precision
from ..studies import flag_names, formatted
from ..wiggly import Status
from .cost_page import CostFacts, MeasuredCell, cost_page
from .folder import write_figures, write_record
from .job import Job, joined

# Slips of the cells that may be measured where none are named: at the last, general solvers
# are lost already. (The command takes the first two of them: with 400 slips SciPy's BDF and
# Radau take 14 to 20 s for a run.)
_SLIPS = (40.0, 150.0, 10_000.0)
# Accuracies, where none are named. (`auto` does what is looser than 1e-3 as that.)
_ACCURACIES = (1e-1, 1e-3, 1e-5)
# Warm runs that are timed, few of each, so that there is time for more methods.
_REPEATS = 2
# In the order in which they are measured while there is time: ours take 0.1 s once they are
# compiled, and do not begin where there is no time for that; SciPy's take all that is left.
ASKED = ("auto", "resolved", "windowed", "LSODA", "BDF", "Radau", "Kvaerno5", "Kvaerno3")
_ANYWAY = ("LSODA",)  # held against ours however long these have compiled: 1 s, then 3
_HEADER = (
    "solver",
    "asked",
    "error",
    "slip",
    "end",
    "dissipation",
    "residual",
    "mescd",
    "s",
    "spread",
    "compile s",
    "steps",
    "rejected",
    "status",
)


def chosen_eps(scene: Scene, eps: Any) -> list[float]:
    """The eps of a study's list with about forty, a hundred and fifty, ten thousand slips.

    Where nothing slips: the largest, the smallest and one between. Raises `ValueError` for
    effects of which nothing is measured.
    """
    require_done(scene.effects, Engine.COST)
    known = np.sort(np.atleast_1d(np.asarray(eps, dtype=float)))[::-1]
    slips = slips_of(scene, 1.0) / known
    if not slips.any():
        return known[sorted({0, known.size // 2, known.size - 1})].tolist()
    wanted = [int(np.argmin(np.abs(np.log(slips / count)))) for count in _SLIPS]
    return known[sorted(set(wanted))].tolist()


def run_cost(
    job: Job,
    folder: Path,
    methods: list[str] | None,
    accuracies: list[float] | None,
    seconds: float,
    progress: bool,
    total: float | None = None,
) -> str:
    """Measure what a job asks for, write it into `folder`, return its tables.

    Raises `ValueError` as `work_precision` does; nothing is written before the end.
    """
    data = work_precision(
        job.scene,
        job.study["eps"],
        job.study["gamma"],
        methods or ASKED,
        accuracies or _ACCURACIES,
        repeats=_REPEATS,
        seconds=seconds,
        total=total,
        progress=progress,
        anyway=_ANYWAY if methods is None else (),
    )
    lines = [*job.notes, str(data.attrs["advice"])]
    text = joined([("", line) for line in lines] + cost_sections(data))
    toml = scene_document(job.scene, job.study)
    write_record(folder, {"cost": data}, toml, text)
    picture = draw_work_precision(data)
    write_figures(folder, iter([("work_precision", picture)]))
    if job.report is not None:
        coefficients = coefficient_table(friction(job.scene), job.error)
        columns = _COLUMNS + _calls(data)
        cells = [MeasuredCell(*cell) for cell in measured_cells(data)]
        facts = CostFacts(job, data, cells, columns, coefficients, picture, toml, seconds)
        write_whole(folder / "report.html", cost_page(facts, job.report))
    return text


def cost_sections(data: xr.Dataset) -> list[tuple[str, str]]:
    """For each cell its title and table, and what the columns mean."""
    sections = [
        (title, f"{truth}\n{table}") for title, truth, table in measured_cells(data)
    ]
    sections.append(("", _COLUMNS + _calls(data)))
    return sections


def measured_cells(data: xr.Dataset) -> list[tuple[str, str, ResultTable]]:
    """For each cell its title, what the reference is, and its table."""
    cells = []
    for gamma in data.gamma.values:
        for eps in data.eps.values:
            cell = data.sel(gamma=gamma, eps=eps)
            title = f"gamma = {gamma:.4g}, eps = {eps:.4g} m"
            cells.append((title, _truth(cell), cost_table(cell)))
    return cells


def _calls(data: xr.Dataset) -> str:
    """What SciPy's solvers spend on calls from Python; nothing where there are none."""
    share = data.calls_share.median(["gamma", "eps", "accuracy"])
    shares = [
        f"{name} {float(one):.0%}"
        for name, one in zip(share.solver.values, share, strict=True)
        if float(one) > 0
    ]
    if not shares:
        return ""
    return (
        "\nCalls of the compiled field from Python take this share of their seconds: "
        f"{', '.join(shares)}."
    )


_COLUMNS = (
    "error: largest of z outside slips; slip: mean over one slip period; end: at the last\n"
    "time asked for; all in eps. dissipation: relative. residual: in energies of a slip.\n"
    "mescd: right digits at the end. '<': below the error of the reference, which is what\n"
    "is printed ('>' of mescd). s: median of warm runs, spread: slowest over fastest of\n"
    "several. compile s: what the first call took longer; methods share programs.\n"
    "'wrong': success was reported half an eps or more off, and further than asked for,\n"
    "beyond the reference's error."
)
# Names of columns and of what is measured in them.
_MEASURED = {
    "error": "error",
    "slip": "slip_error",
    "end": "end_error",
    "dissipation": "dissipation_error",
    "mescd": "mescd",
}


def _truth(cell: xr.Dataset) -> str:
    """What the reference is, and the least of each measure that it can judge."""
    floors = [
        f"{column} {_digits(name, _reference(cell, name))}"
        for column, name in _MEASURED.items()
    ]
    return (
        f"reference: {cell.reference_ways.item()}\n"
        f"reference: the two differ by {', '.join(floors)}"
    )


def _reference(run: xr.Dataset, name: str) -> float:
    return float(run[f"reference_{name}"])


def _digits(name: str, value: float) -> str:
    if not np.isfinite(value):
        return "-"
    return f"{value:.1f}" if name == "mescd" else f"{value:.1e}"


def _judged(run: xr.Dataset, name: str) -> str:
    """A measure of one run, or the reference's own where that is no better."""
    value, floor = float(run[name]), _reference(run, name)
    if not (np.isfinite(value) and np.isfinite(floor)):
        return "-"  # without a second reference nothing is known
    if name == "mescd":
        return f">{_digits(name, floor)}" if value > floor else _digits(name, value)
    return f"<{_digits(name, floor)}" if value < floor else _digits(name, value)


def cost_table(cell: xr.Dataset) -> ResultTable:
    """One line a run of one cell; none of methods that there was no time for."""
    names = flag_names(cell.status)
    tried = (cell.status != Status.NOT_TRIED).any("accuracy")
    rows = [
        _row(cell.sel(solver=solver, accuracy=accuracy), names)
        for solver in cell.solver.values[tried.values]
        for accuracy in cell.accuracy.values
    ]
    return ResultTable(_HEADER, tuple(rows), left=1)


def _row(run: xr.Dataset, names: dict[int, str]) -> tuple[str, ...]:
    *errors, mescd = (_judged(run, name) for name in _MEASURED.values())
    known, several = int(run.runs) > 0, int(run.runs) > 1
    status = "wrong" if int(run.wrong) else names[int(run.status)]
    return (
        str(run.solver.item()),
        f"{float(run.accuracy):.0e}",
        *errors,
        _digits("residual", float(run.residual)),
        mescd,
        formatted(float(run.seconds)),
        f"{float(run.seconds_high / run.seconds_low):.2f}" if several else "-",
        f"{float(run.compile_seconds):.1f}" if known else "-",
        *(_count(float(run[name])) for name in ("steps", "rejected")),
        status,
    )


def _count(value: float) -> str:
    return f"{int(value)}" if np.isfinite(value) else "-"
