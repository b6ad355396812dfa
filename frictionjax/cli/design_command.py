"""Bristles and surfaces for a wanted friction."""

import time
from typing import Any

import click

from .options import bristle_option, out_option, report_option, scene_argument
from .running import report_asked, start, write_folder


@click.command()
@scene_argument
@click.option("--ratio", type=float, help="Wanted -rho_plus/rho_minus.")
@click.option("--difference", type=float, help="Wanted rho_plus + rho_minus in N.")
@click.option("--rho-plus", type=float, help="Wanted friction to the right in N, > 0.")
@click.option("--rho-minus", type=float, help="Wanted friction to the left in N, < 0.")
@click.option(
    "--free",
    help="The bristle's number to choose [angle]; with --rho-plus and --rho-minus together "
    "the surface is designed, and this number too where it is given with --bounds.",
)
@click.option("--bounds", type=(float, float), help="Of that number.", metavar="LOW HIGH")
@bristle_option(".")
@click.option("--pulling", is_flag=True, help="Bristles that pull (alpha < 0) will do too.")
@click.option("--harmonics", type=click.IntRange(1), default=16, show_default=True)
@click.option(
    "--smallest-radius", type=float, help="Of the surface's curvature, in periods."
)
@click.option(
    "--largest-amplitude", type=float, help="Of the surface, highest to lowest, in periods."
)
@click.option(
    "--period", type=float, default=1e-3, show_default=True, help="Of heights.csv, in m."
)
@click.option(
    "--samples",
    type=int,
    default=1024,
    show_default=True,
    help="Of heights.csv in a period; at least 64, and 16 a harmonic of the surface.",
)
@out_option("design")
@report_option
def design(
    scene: str | None, bristle: str | None, out: str, report: bool, **asked: Any
) -> None:
    """The bristle, or the surface, with a wanted friction.

    Writes the scene with it, the heights of its surface for a machine tool, tables and
    pictures into a folder.
    """
    started = time.perf_counter()
    start()
    from ..report import TARGETS, DesignRequest, read_job, require_folder, run_design

    folder = require_folder(out)
    job = read_job(scene, bristle)._replace(report=report_asked(report, started))
    wanted = {name: asked.pop(name) for name in [*asked] if name in TARGETS}
    request = DesignRequest(wanted, **asked)
    write_folder(folder, lambda place: run_design(job, place, request))
