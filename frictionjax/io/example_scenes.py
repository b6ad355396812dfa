"""Scenes that ship with the package, and what a scene file may hold."""

import inspect
from importlib import resources

from .._checks import Part, asked_names, require
from ..profiles import Fourier
from .named_functions import FUNCTION_KINDS
from .registry import EFFECTS, PARTS

_FOLDER, _ENDING = "examples", ".toml"
_TOP = """\
duration = (s) how long the load acts, > 0
z0 = (m) the state at the start, 0 where it is left out
[profile], [bristle], [support], [load]: one part each; [[effects]]: any number
[study]: eps (m) and gamma, lists of numbers > 0, and accuracy (in eps), a number > 0;
         effects, "all" of the scene's or "auto": those that the accuracy calls for"""
_HEIGHTS = """\
  or, instead of cos and sin, a measured surface:
  heights       the name of its file, beside this one
  period        m, > 0, at most 2/3 of the trace (may be left out: found)
  harmonics     no unit, a whole number >= 1 (may be left out: 8)
  row           no unit, a whole number >= 0 (may be left out: all rows)
  smoothing     m, > 0 (may be left out: none)
  pixel         m, > 0: distance of samples (may be left out: the file says it)
  height_scale  m per unit of the heights, > 0 (may be left out: the file says it)
  length_unit, height_unit, decimal, outliers: texts, as the options of commands"""

_FUNCTIONS = """\
Parts made of Python functions, "module:function", beside the file or where Python looks;
read with --functions or functions=True only; [potential] for both profile and bristle:"""


def example_lines() -> dict[str, str]:
    """What each scene that ships is, in a line, by name."""
    folder = resources.files(__package__) / _FOLDER
    names = sorted(f.name for f in folder.iterdir() if f.name.endswith(_ENDING))
    found = {name.removesuffix(_ENDING): example_text(name) for name in names}
    return {name: text.splitlines()[0].removeprefix("# ") for name, text in found.items()}


def example_text(name: str) -> str:
    """The file of a scene that ships, by name.

    Raises `ValueError` for another name, with those that there are.
    """
    stem = name.removesuffix(_ENDING)
    source = resources.files(__package__) / _FOLDER / f"{stem}{_ENDING}"
    if "/" in stem or not source.is_file():
        require(False, "NAME", name, f"one of {', '.join(example_lines())}")
    return source.read_text(encoding="utf-8")


def schema_text() -> str:
    """Every table of a scene file, its kinds and their fields, as the parts say it.

    Each field with its unit, what is allowed, and the default it has; of each kind what
    its class says of symbols and equations.
    """
    tables = {f"[{name}]": kinds for name, kinds in PARTS.items()}
    tables["[[effects]]"] = EFFECTS
    sections = [_TOP]
    for table, kinds in tables.items():
        sections += [_kind_text(table, name, kind) for name, kind in kinds.items()]
    named = [
        f'[{table}] kind = "{name}": {", ".join(kind.functions)}'
        for table, kinds in FUNCTION_KINDS.items()
        for name, kind in kinds.items()
    ]
    return "\n\n".join([*sections, "\n".join([_FUNCTIONS, *named])])


def _kind_text(table: str, name: str, kind: type[Part]) -> str:
    lines = [f'{table} kind = "{name}"', *_field_lines(kind)]
    if kind is Fourier:
        lines.append(_HEIGHTS)
    said = inspect.cleandoc(kind.__doc__ or "").partition(">>> ")[0].rstrip()
    said = said.partition("\n\nRaises ")[0]  # as fields say it
    return "\n".join([*lines, *(f"    {line}".rstrip() for line in said.splitlines())])


def _field_lines(kind: type[Part]) -> list[str]:
    """Of each field of a kind: its name, unit and range, and what it is where left out."""
    signature = inspect.signature(kind.__init__).parameters
    names = asked_names(kind, {})
    width = max(map(len, names), default=0)
    lines = []
    for name in names:
        default = signature[name].default
        needed = default is inspect.Parameter.empty
        absent = "none" if default is None else default
        told = "" if needed else f" (may be left out: {absent})"
        lines.append(f"  {name.ljust(width)}  {kind.asked[name]}{told}")
    return lines
