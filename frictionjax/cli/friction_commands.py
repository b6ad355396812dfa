"""What friction a scene has, and what its accuracy calls for."""

import json
import time
from typing import Any

import click

from .options import POSITIVE, scene_argument, surface_options
from .running import interruptible, report_asked, start, write_folder


@click.command()
@scene_argument
@surface_options
@click.option("--json", "as_json", is_flag=True, help="Numbers as JSON.")
def friction(scene: str | None, as_json: bool, **surface: Any) -> None:
    """Friction coefficients of a scene, in each direction."""
    start()
    from ..report import friction_document, friction_text, read_job

    job = read_job(scene, **surface)
    if not as_json:
        click.echo(friction_text(job))
        return
    for line in job.notes[1:]:
        click.echo(line, err=True)
    click.echo(json.dumps(friction_document(job), indent=2))


@click.command()
@scene_argument
@surface_options
@click.option(
    "--bending-stiffness",
    type=POSITIVE,
    help="Of a rod on an angular spring, in N m^2. [the scene's, of its NapFlip]",
)
@click.option("--json", "as_json", is_flag=True, help="Numbers as JSON.")
@click.option(
    "--out",
    metavar="DIR",
    help="Also nap.png there, over angles of a rod on an angular spring; of one that turns "
    "over also turning.png and nap_loops.png.",
)
@click.option(
    "--report",
    is_flag=True,
    help="Also report.html there, or in frictionjax-nap: one page that tells it all.",
)
@click.option(
    "--movie", metavar="FILE.gif", help="Also the bristle sliding, its force beside it."
)
@click.option(
    "--eps",
    type=POSITIVE,
    help="Of the movie, in m. [of the scene's with slips that are seen, the one whose "
    "forces are nearest to the limit's]",
)
def nap(
    scene: str | None,
    bending_stiffness: float | None,
    as_json: bool,
    out: str | None,
    report: bool,
    movie: str | None,
    eps: float | None,
    **surface: Any,
) -> None:
    """Friction with and against the nap, and whether rods turn over."""
    started = time.perf_counter()
    start()
    from ..report import (
        nap_document,
        nap_figures,
        nap_text,
        no_nap_pictures,
        read_job,
        require_folder,
        require_gif,
        write_movie,
    )

    out = "frictionjax-nap" if report and out is None else out
    folder = None if out is None else require_folder(out)
    file = None if movie is None else require_gif(movie, folder)
    if file is None and eps is not None:
        raise click.UsageError("--eps: needs --movie FILE.gif beside it")
    job = read_job(scene, **surface)._replace(report=report_asked(report, started))
    skipped = [] if folder is None else no_nap_pictures(job)
    if folder is not None and (report or not skipped):
        write_folder(folder, lambda place: nap_figures(job, bending_stiffness, place))
    elif skipped:
        click.echo("\n".join(skipped), err=as_json)
    if file is not None:
        film = file
        told = interruptible(lambda: write_movie(job, bending_stiffness, eps, film))
        click.echo(f"Written to {told}", err=as_json)
    if not as_json:
        click.echo(nap_text(job, bending_stiffness))
        return
    for line in job.notes[1:]:
        click.echo(line, err=True)
    click.echo(json.dumps(nap_document(job, bending_stiffness), indent=2))


@click.command()
@scene_argument
@click.option("--eps", type=float, default=1e-3, show_default=True, help="Period in m.")
@click.option(
    "--gamma", type=float, default=1.0, show_default=True, help="Viscosity is eps^gamma."
)
@click.option("--accuracy", type=float, default=1e-3, show_default=True, help="In eps.")
def explain(scene: str | None, eps: float, gamma: float, accuracy: float) -> None:
    """A scene's equation, and which effects its accuracy calls for."""
    start()
    from ..explain import explain as explained
    from ..report import read_job

    click.echo(repr(explained(read_job(scene).scene, eps, gamma, accuracy)))
