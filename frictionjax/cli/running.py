"""How commands begin, and how what they find is written."""

import atexit
import gc
import os
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from .command_group import Left


def start() -> None:
    """Ask for what suits a CPU and a shell; before anything is computed."""
    from .._compile import keep_compiled, use_fast_cpu

    # Imports make many objects and little garbage, and Python looks for it all the while,
    # and once more before it ends.
    gc.set_threshold(100_000, 50, 100)
    atexit.register(gc.freeze)
    use_fast_cpu()
    os.environ["MPLBACKEND"] = "Agg"  # heard when it is imported, which can wait
    import jax

    from ..wiggly import FailedCells

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


def report_asked(report: bool, started: float, expected: str = "") -> Any:
    """A report that tells the command as it was typed; None where none is asked for."""
    from ..report import ReportRequest

    command = click.get_current_context().obj
    return ReportRequest(command, started, expected) if report else None


def write_folder(folder: Path, work: Callable[[Path], str]) -> None:
    """Run `work` on a place for its files, and print the tables that it returns.

    Also which files of the folder are not of this run, though they look it.
    """
    from ..report import filled, left_before

    with filled(folder) as place:
        text = interruptible(lambda: work(place))
        made = {path.name for path in place.iterdir()}
    click.echo(text)
    click.echo(f"\nWritten to {folder}")
    if old := left_before(folder, made):
        click.echo(f"Not of this run, there before: {', '.join(old)}")


def interruptible(work: Callable[[], Any]) -> Any:
    """Run `work`; Ctrl-C leaves at once, without a traceback."""
    from .._compile import interruptibly

    try:
        return interruptibly(work)
    except KeyboardInterrupt:
        raise Left from None
