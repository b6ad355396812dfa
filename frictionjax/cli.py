"""The command line. Only click is imported here: `--help` must not wait for JAX."""

import json
import os
import shlex
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click


class Left(click.Abort):
    """Ctrl-C while compiled code runs, which cannot be stopped, only left."""


class OneLineErrors(click.Group):
    """A group whose commands end with one line on standard error, or in silence.

    Exit status 2 for what the user can mend in the command or around it, 1 for a full
    disk, 130 for Ctrl-C.
    """

    def make_context(self, info_name: Any, args: list[str], *more: Any, **kwargs: Any):
        """With what was typed, which reports tell."""
        kwargs["obj"] = shlex.join(["frictionjax", *args])
        return super().make_context(info_name, args, *more, **kwargs)

    def main(self, *args: Any, **kwargs: Any) -> Any:
        """Run the command line and exit."""
        kwargs["standalone_mode"] = False
        status = 2
        try:
            sys.exit(super().main(*args, **kwargs))
        except Left:
            os._exit(130)
        except click.Abort:
            sys.exit(130)
        except click.ClickException as error:
            message = error.format_message()
        except OSError as error:
            message, status = _of_file(error)
        except ValueError as error:
            message = str(error)
        except RuntimeError as error:
            from ._checks import SurroundingsError

            if not isinstance(error, SurroundingsError):
                raise
            message = str(error)
        click.echo(f"Error: {' '.join(message.split())}", err=True)
        sys.exit(status)


def _of_file(error: OSError) -> tuple[str, int]:
    """Message and exit status of a file that cannot be read or written."""
    from ._checks import FULL

    status = 1 if error.errno in FULL else 2
    # Whoever writes a file names it: what is left is what is printed.
    name = error.filename or ("standard output" if status == 1 else "")
    if name == "standard output":
        # Else Python would say so once more, with another status, where it ends.
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115
    where = f"{name}: " if name else ""
    return f"{where}{error.strerror or error}", status


def _options(*options: Callable) -> Callable:
    def decorate(command: Callable) -> Callable:
        for option in reversed(options):
            command = option(command)
        return command

    return decorate


def _bristle(which: str) -> Callable:
    kinds = click.Choice(["slanted", "angular"])
    return click.option(
        "--bristle", type=kinds, help=f"Another bristle than the scene's{which}"
    )


def _out(command: str) -> Callable:
    default = f"frictionjax-{command}"
    return click.option("--out", default=default, show_default=True, metavar="DIR")


_report = click.option(
    "--report", is_flag=True, help="Also report.html there: one page that tells it all."
)
_POSITIVE = click.FloatRange(min=0, min_open=True)
_progress = click.option(
    "--progress/--no-progress", default=True, help="A bar on standard error."
)
_scene = click.argument("scene", required=False, metavar="[SCENE.toml]")
_surface = _options(
    _bristle(
        ": slanted (k 1, rest length 2.4, height 1, angle 1) or angular (k 1, length "
        "1.414, height 1, rest angle 0.3)."
    ),
    click.option(
        "--heights",
        metavar="FILE",
        help="Measured trace or map as the surface: a text or a format of an instrument.",
    ),
    click.option("--harmonics", type=click.IntRange(1), help="Of its periodic part. [8]"),
    click.option("--period", type=float, help="In m; found in the data otherwise."),
    click.option(
        "--smoothing",
        type=float,
        metavar="LENGTH",
        help="Cut-off in m of a Gaussian filter of the surface.",
    ),
    click.option(
        "--pixel", type=float, help="Distance of samples in m, or in --length-unit."
    ),
    click.option("--length-unit", help="Of positions, as um. [what the file says]"),
    click.option("--height-unit", help="Of heights, as nm. [what the file says]"),
    click.option(
        "--height-scale", type=float, help="m per unit of the heights, for --height-unit."
    ),
    click.option("--decimal", help="Mark of decimals: . or , [as the file shows]"),
    click.option(
        "--outliers",
        type=click.Choice(["missing", "keep"]),
        help="What heights are that lie alone, far from all others. [asked]",
    ),
    click.option(
        "--row",
        type=click.IntRange(0),
        help="Row of a map. [mean over the rows, moved into phase]",
    ),
)


@click.group(cls=OneLineErrors, invoke_without_command=True)
@click.version_option(package_name="frictionjax")
@click.pass_context
def main(context: click.Context) -> None:
    """Directional dry friction as the limit of viscous motion over a wiggly surface.

    Commands use an embedded scene where no SCENE.toml is named.
    """
    if context.invoked_subcommand is None:
        click.echo(context.get_help())


def _start() -> None:
    from ._compile import keep_compiled, use_fast_cpu

    use_fast_cpu()
    os.environ["MPLBACKEND"] = "Agg"  # heard when it is imported, which can wait
    import jax

    from .wiggly import FailedCells

    warnings.simplefilter("once", FailedCells)  # a sweep and its study say the same
    # `keep_compiled` has its own: JAX warns anew for every program.
    warnings.filterwarnings("ignore", "Error writing persistent compilation cache")
    warnings.showwarning = _show_warning  # type: ignore[assignment]
    keep_compiled()
    jax.config.update("jax_enable_x64", True)
    # Threads that import, load programs and plan take turns: at 5 ms each a study took
    # 0.4 s longer.
    sys.setswitchinterval(5e-4)


def _show_warning(message: Any, *_: Any) -> None:
    click.echo(f"Warning: {' '.join(str(message).split())}", err=True)


def _asked(report: bool, started: float, expected: str = "") -> Any:
    """A report that tells the command as it was typed; None where none is asked for."""
    from .report import ReportRequest

    command = click.get_current_context().obj
    return ReportRequest(command, started, expected) if report else None


def _write(folder: Path, work: Callable[[Path], str]) -> None:
    """Run `work` on a place for its files, and print the tables that it returns."""
    from .report import filled

    with filled(folder) as place:
        text = _interruptible(lambda: work(place))
    click.echo(text)
    click.echo(f"\nWritten to {folder}")


def _interruptible(work: Callable[[], Any]) -> Any:
    """Run `work`; Ctrl-C leaves at once, without a traceback."""
    from ._compile import interruptibly

    try:
        return interruptibly(work)
    except KeyboardInterrupt:
        raise Left from None


@main.command()
@_scene
@_surface
@click.option("--json", "as_json", is_flag=True, help="Numbers as JSON.")
def friction(scene: str | None, as_json: bool, **surface: Any) -> None:
    """Friction coefficients of a scene, in each direction."""
    _start()
    from .report import friction_document, friction_text, read_job

    job = read_job(scene, **surface)
    if not as_json:
        click.echo(friction_text(job))
        return
    for line in job.notes[1:]:
        click.echo(line, err=True)
    click.echo(json.dumps(friction_document(job), indent=2))


@main.command()
@_scene
@_surface
@click.option(
    "--bending-stiffness",
    type=_POSITIVE,
    help="Of a rod on an angular spring, in N m^2. [the scene's, of its NapFlip]",
)
@click.option("--json", "as_json", is_flag=True, help="Numbers as JSON.")
@click.option(
    "--out",
    metavar="DIR",
    help="Also nap.png there, over angles of the rod; of one that turns over also "
    "turning.png and nap_loops.png.",
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
    "--eps", type=_POSITIVE, help="Of the movie, in m. [of the scene's, slips seen best]"
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
    """Friction with and against the nap, and whether the bristle turns over."""
    started = time.perf_counter()
    _start()
    from .report import (
        nap_document,
        nap_figures,
        nap_text,
        read_job,
        require_folder,
        require_gif,
        write_movie,
    )

    out = "frictionjax-nap" if report and out is None else out
    folder = None if out is None else require_folder(out)
    file = None if movie is None else require_gif(movie)
    if file is None and eps is not None:
        raise click.UsageError("--eps: needs --movie FILE.gif beside it")
    job = read_job(scene, **surface)._replace(report=_asked(report, started))
    if folder is not None:
        _write(folder, lambda place: nap_figures(job, bending_stiffness, place))
    if file is not None:
        film = file
        told = _interruptible(lambda: write_movie(job, bending_stiffness, eps, film))
        click.echo(f"Written to {told}", err=as_json)
    if not as_json:
        click.echo(nap_text(job, bending_stiffness))
        return
    for line in job.notes[1:]:
        click.echo(line, err=True)
    click.echo(json.dumps(nap_document(job, bending_stiffness), indent=2))


@main.command()
@_scene
@click.option("--eps", type=float, default=1e-3, show_default=True, help="Period in m.")
@click.option("--gamma", type=float, default=1.0, show_default=True)
@click.option("--accuracy", type=float, default=1e-3, show_default=True, help="In eps.")
def explain(scene: str | None, eps: float, gamma: float, accuracy: float) -> None:
    """The composed equation of a scene, and which effects its accuracy calls for."""
    _start()
    from .explain import explain as explained
    from .report import read_job

    click.echo(repr(explained(read_job(scene).scene, eps, gamma, accuracy)))


def _numbers(**given: str | None) -> dict[str, Any]:
    """Lists of numbers, of the options that are given.

    An empty text is not a missing option: it is refused by name.
    """
    from .report import number_list

    known = {name: text for name, text in given.items() if text is not None}
    return {name: number_list(name, text) for name, text in known.items()}


@main.command()
@_scene
@_surface
@click.option("--eps", help="In m: a list 0.1,0.05 or START:STOP:N (equal ratios).")
@click.option("--gamma", help="A list or START:STOP:N.")
@click.option("--accuracy", type=float, help="Wanted error of z in units of eps.")
@click.option("--method", default="auto", show_default=True, help="Solver.")
@click.option(
    "--budget",
    type=_POSITIVE,
    help="Seconds of computation: the best of the scene's accuracy and 1e-3 to 1e-6, or "
    "with --accuracy the eps, that fit.",
)
@click.option(
    "--effects",
    type=click.Choice(["all", "auto"]),
    help="Of the scene: all, or those that the accuracy calls for.",
)
@click.option(
    "--rows", is_flag=True, help="Every row of the map of --heights, and how they differ."
)
@_out("study")
@_report
@_progress
def study(
    scene: str | None,
    eps: str | None,
    gamma: str | None,
    accuracy: float | None,
    method: str,
    budget: float | None,
    effects: str | None,
    out: str,
    report: bool,
    progress: bool,
    **surface: Any,
) -> None:
    """Convergence to the limit: tables, NetCDF data and pictures in a folder."""
    started = time.perf_counter()
    _start()
    from .report import (
        expectation,
        prepare_study,
        read_job,
        require_folder,
        run_study,
        within_budget,
    )

    folder = require_folder(out)
    wanted = _numbers(eps=eps, gamma=gamma)
    if accuracy is not None:
        wanted["accuracy"] = accuracy
    if effects is not None:
        wanted["effects"] = effects
    if surface["rows"] and budget is not None:
        _refuse("--rows", "budget")
    job = read_job(scene, **surface)
    job = job._replace(study=job.study | wanted)
    prepare_study(job, method)  # while its cost is found
    if budget is not None:
        job, expected = within_budget(job, budget, method, accuracy)
        click.echo(expected, err=True)
    else:
        expected = expectation(job, method)
        click.echo(f"Expected: {expected}", err=True)
    job = job._replace(report=_asked(report, started, expected))
    _write(folder, lambda place: run_study(job, place, method, progress))


def _refuse(beside: str, *names: str) -> None:
    """Raise where the user has given an option that means nothing beside another one."""
    context = click.get_current_context()
    by_user = click.core.ParameterSource.COMMANDLINE
    given = [n for n in names if context.get_parameter_source(n) is by_user]
    if given:
        listed = ", ".join(f"--{name}" for name in given)
        raise click.UsageError(f"{listed}: not with {beside}")


@main.command()
@_scene
@_surface
@click.option("--eps", help="In m: a list or START:STOP:N. [three of the scene's list]")
@click.option("--gamma", help="A list or START:STOP:N. [1]")
@click.option("--accuracies", help="In eps: a list or START:STOP:N. [1e-1 to 1e-6]")
@click.option(
    "--methods",
    help="A list: auto, resolved, windowed, a diffrax solver, LSODA, BDF, Radau.",
)
@click.option(
    "--seconds",
    type=_POSITIVE,
    default=2.0,
    show_default=True,
    help="After which a run is ended; diffrax's after a million steps for each.",
)
@click.option(
    "--total",
    type=_POSITIVE,
    default=30.0,
    show_default=True,
    help="Seconds after which no more runs of general solvers are begun; ours come first.",
)
@click.option(
    "--order-within",
    type=_POSITIVE,
    help="Instead: which eps give the order of convergence to +- this, and in which time.",
)
@_out("cost")
@_report
@_progress
def cost(
    scene: str | None,
    eps: str | None,
    gamma: str | None,
    accuracies: str | None,
    methods: str | None,
    seconds: float,
    total: float,
    order_within: float | None,
    out: str,
    report: bool,
    progress: bool,
    **surface: Any,
) -> None:
    """What accuracy costs in time: this library's methods and general solvers."""
    started = time.perf_counter()
    _start()
    from .report import chosen_eps, read_job, require_folder, run_cost, run_order_cost

    if order_within is not None:
        others = "methods", "accuracies", "seconds", "total", "out", "report", "progress"
        _refuse("--order-within", *others)
        job = read_job(scene, **surface)
        job = job._replace(study=job.study | _numbers(eps=eps, gamma=gamma))
        within = order_within
        click.echo(_interruptible(lambda: run_order_cost(job, within)))
        return
    folder = require_folder(out)
    cells = {"gamma": [1.0]} | _numbers(gamma=gamma, accuracies=accuracies, eps=eps)
    asked = cells.pop("accuracies", None)
    names = None if methods is None else [name.strip() for name in methods.split(",")]
    job = read_job(scene, **surface)
    if "eps" not in cells:
        cells["eps"] = chosen_eps(job.scene, job.study["eps"])
    job = job._replace(study=job.study | cells, report=_asked(report, started))
    _write(
        folder, lambda place: run_cost(job, place, names, asked, seconds, progress, total)
    )


@main.command()
@_scene
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
@_bristle(".")
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
    type=click.IntRange(16),
    default=1024,
    show_default=True,
    help="Of heights.csv in a period.",
)
@_out("design")
@_report
def design(
    scene: str | None, bristle: str | None, out: str, report: bool, **asked: Any
) -> None:
    """The bristle, or the surface, with a wanted friction.

    Writes the scene with it, the heights of its surface for a machine tool, tables and
    pictures into a folder.
    """
    started = time.perf_counter()
    _start()
    from .report import TARGETS, DesignRequest, read_job, require_folder, run_design

    folder = require_folder(out)
    job = read_job(scene, bristle)._replace(report=_asked(report, started))
    wanted = {name: asked.pop(name) for name in [*asked] if name in TARGETS}
    request = DesignRequest(wanted, **asked)
    _write(folder, lambda place: run_design(job, place, request))


@main.command()
@click.argument("name", required=False, metavar="[NAME]")
@click.option("--schema", is_flag=True, help="Every field of a scene file instead.")
@click.option("--out", metavar="FILE", help="Write the scene there instead.")
def scenes(name: str | None, schema: bool, out: str | None) -> None:
    """Scenes that ship: all of them, a line each, or the file of one to start from."""
    _start()
    from .io import example_lines, example_text, schema_text

    if schema:
        click.echo(schema_text())
        return
    if name is None:
        known = example_lines()
        width = max(map(len, known))
        click.echo("\n".join(f"{n.ljust(width)}  {line}" for n, line in known.items()))
        return
    text = example_text(name)
    if out is None:
        click.echo(text, nl=False)
        return
    from ._checks import write_whole

    write_whole(out, text)
    click.echo(f"Written to {out}")


@main.command()
@_out("figures")
def figures(out: str) -> None:
    """Figures of the paper: coefficients against the angle of the bristle."""
    _start()
    from .report import paper_figures, require_folder, write_figures

    def draw(place: Path) -> str:
        return "\n".join(path.name for path in write_figures(place, paper_figures()))

    _write(require_folder(out), draw)
