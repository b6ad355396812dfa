"""How fast the limit is reached."""

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
from .running import report_asked, start, write_folder


@click.command()
@scene_argument
@surface_options
@click.option("--eps", help="In m: a list 0.1,0.05 or START:STOP:N (equal ratios).")
@click.option("--gamma", help="Viscosity is eps^gamma: a list or START:STOP:N.")
@click.option(
    "--accuracy",
    type=float,
    help="Wanted error of z in units of eps. [the scene's, or 1e-3]",
)
@click.option(
    "--method",
    default="auto",
    show_default=True,
    help="auto, resolved (every slip), windowed, or a solver of diffrax.",
)
@click.option(
    "--budget",
    type=POSITIVE,
    help="Seconds of computation: the best of the scene's accuracy and 1e-3 to 1e-6, or "
    "with --accuracy the eps, that fit.",
)
@click.option(
    "--effects",
    type=click.Choice(["all", "auto"]),
    help="Of the scene: all, or those that the accuracy calls for.",
)
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    help="Of the path of a scene with noise. [0]",
)
@click.option(
    "--rows", is_flag=True, help="Every row of the map of --heights, and how they differ."
)
@out_option("study")
@report_option
@progress_option
def study(
    scene: str | None,
    eps: str | None,
    gamma: str | None,
    accuracy: float | None,
    method: str,
    budget: float | None,
    effects: str | None,
    seed: int | None,
    out: str,
    report: bool,
    progress: bool,
    **surface: Any,
) -> None:
    """Convergence to the limit: tables, data and pictures in a folder.

    Data are NetCDF.
    """
    started = time.perf_counter()
    start()
    from ..report import (
        expectation,
        prepare_study,
        read_job,
        require_folder,
        run_study,
        with_seed,
        within_budget,
    )

    folder = require_folder(out)
    wanted = numbers_of(eps=eps, gamma=gamma)
    if accuracy is not None:
        wanted["accuracy"] = accuracy
    if effects is not None:
        wanted["effects"] = effects
    if surface["rows"] and budget is not None:
        refuse_beside("--rows", "budget")
    job = read_job(scene, **surface)
    job = with_seed(job._replace(study=job.study | wanted), seed)
    prepare_study(job, method)  # while its cost is found
    if budget is not None:
        job, expected = within_budget(job, budget, method, accuracy)
        click.echo(expected, err=True)
    else:
        expected = expectation(job, method)
        click.echo(f"Expected: {expected}", err=True)
    job = job._replace(report=report_asked(report, started, expected))
    write_folder(folder, lambda place: run_study(job, place, method, progress))
