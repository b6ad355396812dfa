"""What there is to start from: scenes that ship, figures of the paper."""

from pathlib import Path

import click

from .options import out_option
from .running import start, write_folder


@click.command()
@click.argument("name", required=False, metavar="[NAME]")
@click.option("--schema", is_flag=True, help="Every field of a scene file instead.")
@click.option(
    "--out", metavar="FILE", help="Write the scene there instead, over no other file."
)
def scenes(name: str | None, schema: bool, out: str | None) -> None:
    """Scenes that ship: a line each, or the file of one to start from."""
    if out is not None and (schema or name is None):
        needs = "not with --schema" if schema else "needs NAME beside it"
        raise click.UsageError(f"--out: {needs}")
    start()
    from ..io import example_lines, example_text, schema_text

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
    from .._checks import write_whole
    from ..report import require_no_work_lost

    require_no_work_lost(out, map(example_text, example_lines()))
    write_whole(out, text)
    click.echo(f"Written to {out}")


@click.command()
@out_option("figures")
def figures(out: str) -> None:
    """Figures of the paper: coefficients against a bristle's angle."""
    start()
    from ..report import paper_figures, require_folder, write_figures

    def draw(place: Path) -> str:
        return "\n".join(path.name for path in write_figures(place, paper_figures()))

    write_folder(require_folder(out), draw)
