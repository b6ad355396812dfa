"""What users build on, as text: public names with their signatures, and the shell's help.

`python tests/support/promised.py` writes it anew, where a promise has grown.
"""

import enum
import inspect
import re
import types
from pathlib import Path

import click

FOLDER = Path(__file__).parents[1] / "promised"
# Spaces of `fx` whose names are public too: classes, of some functions as well.
SPACES = "bristles", "effects", "loads", "measured", "plot", "principle", "profiles"
SPACES += ("supports",)
_FUNCTIONS = {"plot": ("draw_", "animate"), "measured": ("read_",)}


def _line(name: str, thing) -> str:
    if isinstance(thing, types.ModuleType) or not callable(thing):
        return name
    if isinstance(thing, enum.EnumMeta):  # whose call is that of Python's version
        return f"{name}: {', '.join(thing.__members__)}"
    try:
        parameters = inspect.signature(thing).parameters.values()
    except ValueError:
        return name
    bare = [p.replace(annotation=inspect.Parameter.empty) for p in parameters]
    return name + re.sub(r" at 0x[0-9a-f]+", "", str(inspect.Signature(bare)))


def public_names() -> dict:
    """Everything that users build on, by name: `fx.solve`, `fx.loads.Sine`, `fx.loads`."""
    import frictionjax as fx

    found = {f"fx.{name}": getattr(fx, name) for name in sorted(fx.__all__)}
    for space in SPACES:
        home, functions = getattr(fx, space), _FUNCTIONS.get(space, ())
        for name in sorted(dir(home)):
            if name[0].isupper() or name.startswith(functions):
                found[f"fx.{space}.{name}"] = getattr(home, name)
    return found


def signatures() -> str:
    """A line for each public name, with its arguments and their defaults."""
    lines = [_line(name, thing) for name, thing in public_names().items()]
    return "\n".join(lines) + "\n"


def helps() -> str:
    """What `--help` prints, of every command."""
    from frictionjax.cli import main

    texts = []
    for name in (None, *sorted(main.commands)):
        command = main if name is None else main.commands[name]
        called = "frictionjax" if name is None else f"frictionjax {name}"
        with click.Context(command, info_name=called, terminal_width=88) as context:
            texts.append(command.get_help(context))
    return "\n\n".join(texts) + "\n"


PROMISES = {"signatures.txt": signatures, "help.txt": helps}

if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for file, text in PROMISES.items():
        (FOLDER / file).write_text(text())
