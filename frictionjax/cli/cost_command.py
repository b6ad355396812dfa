"""What accuracy costs in time."""

import time
from typing import Any

import click

from .options import (
    POSITIVE,
    numbers_of,
    out_option,
    progress_option,
    refuse_beside,
    report_option,
    scene_argument,
    surface_options,
)
from .running import interruptible, report_asked, start, write_folder

# About forty slips and a hundred and fifty: of more, general solvers take all the time.
_CELLS = 2
# Seconds, so that what was begun, and the writing, end after 30 or so.
_TOTAL = 25.0
_LEAST = 1e-3  # seconds: what is left of the total where loading took all of it


@click.command()
@scene_argument
@surface_options
@click.option("--eps", help="In m: a list or START:STOP:N. [two of the scene's list]")
@click.option("--gamma", help="Viscosity is eps^gamma: a list or START:STOP:N. [1]")
@click.option("--accuracies", help="In eps: a list or START:STOP:N. [1e-1, 1e-3, 1e-5]")
@click.option(
    "--methods",
    help="A list: auto, resolved, windowed, a diffrax solver, LSODA, BDF, Radau.",
)
@click.option(
    "--seconds",
    type=POSITIVE,
    default=2.0,
    show_default=True,
    help="After which a run is ended; diffrax's after a million steps for each.",
)
@click.option(
    "--total",
    type=POSITIVE,
    help="Seconds after which no more runs are begun, but of the first method, which comes "
    "before all others, in all cells. [25, where no methods are named, and LSODA's at the "
    "loosest accuracy in any case]",
)
@click.option(
    "--order-within",
    type=POSITIVE,
    help="Instead: which eps give the order of convergence to +- this, and in which time.",
)
@out_option("cost", "Not with --order-within, which writes no files.")
@report_option
@progress_option
def cost(
    scene: str | None,
    eps: str | None,
    gamma: str | None,
    accuracies: str | None,
    methods: str | None,
    seconds: float,
    total: float | None,
    order_within: float | None,
    out: str,
    report: bool,
    progress: bool,
    **surface: Any,
) -> None:
    """What accuracy costs in time: our methods and general solvers."""
    started = time.perf_counter()
    start()
    from ..report import chosen_eps, read_job, require_folder, run_cost, run_order_cost

    if order_within is not None:
        others = "methods", "accuracies", "seconds", "total", "out", "report", "progress"
        refuse_beside("--order-within", *others)
        job = read_job(scene, **surface)
        job = job._replace(study=job.study | numbers_of(eps=eps, gamma=gamma))
        within = order_within
        click.echo(interruptible(lambda: run_order_cost(job, within)))
        return
    folder = require_folder(out)
    cells = {"gamma": [1.0]} | numbers_of(gamma=gamma, accuracies=accuracies, eps=eps)
    asked = cells.pop("accuracies", None)
    names = None if methods is None else [name.strip() for name in methods.split(",")]
    job = read_job(scene, **surface)
    if "eps" not in cells:
        cells["eps"] = chosen_eps(job.scene, job.study["eps"])[:_CELLS]
    job = job._replace(study=job.study | cells, report=report_asked(report, started))
    if total is None and names is None:
        total = _TOTAL
    spent = time.perf_counter() - started
    left = None if total is None else max(_LEAST, total - spent)
    write_folder(
        folder, lambda place: run_cost(job, place, names, asked, seconds, progress, left)
    )
