"""The group of all commands: each ends with one line on standard error, or in silence."""

import os
import shlex
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import click


class Left(click.Abort):
    """Ctrl-C, or SIGTERM, while compiled code runs, which cannot be stopped, only left."""

    def __init__(self, status: int = 130):
        super().__init__()
        self.status = status


@contextmanager
def _heard() -> Iterator[None]:
    """SIGTERM leaves as Ctrl-C does, so that nothing half written stays behind."""

    def leave(number: int, frame: Any) -> None:
        raise Left(128 + number)

    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, leave)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


class OneLineErrors(click.Group):
    """A group whose commands end with one line on standard error, or in silence.

    Exit status 2 for what the user can mend in the command or around it, 1 for a full
    disk, 130 for Ctrl-C, 143 where it is told to end.
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
            with _heard():
                sys.exit(super().main(*args, **kwargs))
        except Left as left:
            os._exit(left.status)
        except click.Abort:
            sys.exit(130)
        except click.ClickException as error:
            message = error.format_message()
        except OSError as error:
            message, status = _of_file(error)
        except ValueError as error:
            message = str(error)
        except RuntimeError as error:
            from .._checks import SurroundingsError

            if not isinstance(error, SurroundingsError):
                raise
            message = str(error)
        click.echo(f"Error: {' '.join(message.split())}", err=True)
        sys.exit(status)


def _of_file(error: OSError) -> tuple[str, int]:
    """Message and exit status of a file that cannot be read or written."""
    from .._checks import FULL

    status = 1 if error.errno in FULL else 2
    # Whoever writes a file names it: what is left is what is printed.
    name = error.filename or ("standard output" if status == 1 else "")
    if name == "standard output":
        # Else Python would say so once more, with another status, where it ends.
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115
    where = f"{name}: " if name else ""
    return f"{where}{error.strerror or error}", status


@click.group(cls=OneLineErrors, invoke_without_command=True)
@click.version_option(package_name="frictionjax")
@click.pass_context
def main(context: click.Context) -> None:
    """Directional dry friction as the limit of viscous motion over a wiggly surface.

    Commands use an embedded scene where no SCENE.toml is named.
    """
    if context.invoked_subcommand is None:
        click.echo(context.get_help())
