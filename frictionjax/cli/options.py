"""Options and arguments that commands share."""

import functools
from collections.abc import Callable
from typing import Any

import click


def _options(*options: Callable) -> Callable:
    def decorate(command: Callable) -> Callable:
        for option in reversed(options):
            command = option(command)
        return command

    return decorate


def bristle_option(which: str) -> Callable:
    kinds = click.Choice(["slanted", "angular"])
    return click.option(
        "--bristle", type=kinds, help=f"Another bristle than the scene's{which}"
    )


def out_option(command: str, told: str | None = None) -> Callable:
    """`told`: help, where the name does not say it all."""
    default = f"frictionjax-{command}"
    return click.option(
        "--out", default=default, show_default=True, metavar="DIR", help=told
    )


report_option = click.option(
    "--report", is_flag=True, help="Also report.html there: one page that tells it all."
)
POSITIVE = click.FloatRange(min=0, min_open=True)
progress_option = click.option(
    "--progress/--no-progress", default=True, help="A bar on standard error."
)


def scene_argument(command: Callable) -> Callable:
    """The file of a scene, which errors about its scene name.

    With `--functions` functions of Python that the file names may be imported.
    """

    @functools.wraps(command)
    def named(*args: Any, scene: str | None, functions: bool, **kwargs: Any) -> Any:
        if functions and scene is not None:
            from ..io import PathWithFunctions

            scene = PathWithFunctions(scene)
        try:
            return command(*args, scene=scene, **kwargs)
        except ValueError as error:
            raise ValueError(_of_scene(scene, str(error))) from error

    named = click.option(
        "--functions", is_flag=True, help="Import what SCENE.toml names: runs its code."
    )(named)
    return click.argument("scene", required=False, metavar="[SCENE.toml]")(named)


def _of_scene(file: str | None, message: str) -> str:
    """A message about a scene with the file that it is in, in the file's words."""
    if file is None or not message.startswith("scene."):
        return message
    return f"{file}: {message.replace('scene.effects: ', '[[effects]] ', 1)}"


surface_options = _options(
    bristle_option(
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


def numbers_of(**given: str | None) -> dict[str, Any]:
    """Lists of numbers, of the options that are given.

    An empty text is not a missing option: it is refused by name.
    """
    from ..report import number_list

    known = {name: text for name, text in given.items() if text is not None}
    return {name: number_list(name, text) for name, text in known.items()}


def refuse_beside(beside: str, *names: str) -> None:
    """Raise where the user has given an option that means nothing beside another one."""
    context = click.get_current_context()
    by_user = click.core.ParameterSource.COMMANDLINE
    given = [n for n in names if context.get_parameter_source(n) is by_user]
    if given:
        listed = ", ".join(_as_given(context, name) for name in given)
        raise click.UsageError(f"{listed}: not with {beside}")


def _as_given(context: click.Context, name: str) -> str:
    """An option as the user has typed it: `--no-progress`, `--order-within`."""
    option = next(one for one in context.command.params if one.name == name)
    refused = context.params[name] is False and option.secondary_opts
    return option.secondary_opts[0] if refused else option.opts[0]
