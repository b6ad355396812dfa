"""What accuracy costs on the user's machine: measurements, table, picture, files."""

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ..cost_of_accuracy import ACCURACIES, METHODS, work_precision
from ..instants import slips_of
from ..plot import draw_work_precision
from ..scene import Scene
from ..scene_files import scene_document
from .folder import write_figures, write_record
from .job import Job, joined
from .tables import flag_names, number, table

# Slips of the cells that are measured where none are named: at the last, general solvers
# are lost already.
_SLIPS = (100.0, 1000.0, 10_000.0)
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
    "field",
    "Jacobian",
    "status",
)


def chosen_eps(scene: Scene, eps: Any) -> list[float]:
    """The eps of a study's list with about a hundred, a thousand, ten thousand slips.

    Where nothing slips: the largest, the smallest and one between.
    """
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
) -> str:
    """Measure what a job asks for, write it into `folder`, return its tables.

    Raises `ValueError` as `work_precision` does; nothing is written before the end.
    """
    data = work_precision(
        job.scene,
        job.study["eps"],
        job.study["gamma"],
        methods or METHODS,
        accuracies or ACCURACIES,
        seconds=seconds,
        progress=progress,
    )
    text = joined([("", line) for line in job.notes] + cost_sections(data))
    toml = scene_document(job.scene, job.study)
    write_record(folder, {"cost": data}, toml, text)
    write_figures(folder, iter([("work_precision", draw_work_precision(data))]))
    return text


def cost_sections(data: xr.Dataset) -> list[tuple[str, str]]:
    """For each cell its title and table, and what the columns mean."""
    sections = []
    for gamma in data.gamma.values:
        for eps in data.eps.values:
            cell = data.sel(gamma=gamma, eps=eps)
            title = f"gamma = {gamma:.4g}, eps = {eps:.4g} m"
            sections.append((title, f"{_truth(cell)}\n{cost_table(cell)}"))
    sections.append(("", _COLUMNS))
    return sections


_COLUMNS = (
    "error: largest of z outside slips; slip: mean over one slip period; end: at the\n"
    "last time; all in eps. dissipation: relative. residual: in energies of one slip.\n"
    "s: median of warm runs, spread: slowest over fastest of several. compile s: what the\n"
    "first call took longer; methods share programs. field, Jacobian: evaluations, -\n"
    "where a solver does not tell. 'wrong': success was reported half an eps or more\n"
    "away, beyond the error of the reference; below that no error means anything."
)


def _truth(cell: xr.Dataset) -> str:
    return (
        f"reference: {cell.reference_ways.item()}; they differ by "
        f"{number(float(cell.reference_error))} eps, dissipation by "
        f"{number(float(cell.reference_dissipation_error))}"
    )


def cost_table(cell: xr.Dataset) -> str:
    """One line a run of one cell."""
    names = flag_names(cell.status)
    rows = [
        _row(cell.sel(solver=solver, accuracy=accuracy), names)
        for solver in cell.solver.values
        for accuracy in cell.accuracy.values
    ]
    return table(_HEADER, rows, left=1)


def _row(run: xr.Dataset, names: dict[int, str]) -> tuple[str, ...]:
    errors = ("error", "slip_error", "end_error", "dissipation_error", "residual")
    counts = ("steps", "rejected", "evaluations", "jacobians")
    known, several = int(run.runs) > 0, int(run.runs) > 1
    status = "wrong" if int(run.wrong) else names[int(run.status)]
    return (
        str(run.solver.item()),
        f"{float(run.accuracy):.0e}",
        *(_short(float(run[name])) for name in errors),
        f"{float(run.mescd):.1f}" if np.isfinite(run.mescd) else "-",
        number(float(run.seconds)),
        f"{float(run.seconds_high / run.seconds_low):.2f}" if several else "-",
        f"{float(run.compile_seconds):.1f}" if known else "-",
        *(_count(float(run[name])) for name in counts),
        status,
    )


def _short(value: float) -> str:
    return f"{value:.1e}" if np.isfinite(value) else "-"


def _count(value: float) -> str:
    return f"{int(value)}" if np.isfinite(value) else "-"
