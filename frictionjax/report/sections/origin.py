"""Where the numbers of a report come from, and how to make them again."""

import os
import platform
from collections.abc import Sequence
from datetime import UTC, datetime
from importlib.metadata import version
from typing import NamedTuple

from ..page import Section, definitions, linked_files, paragraph, preformatted

_PACKAGES = ("jax", "jaxlib", "diffrax", "numpy", "scipy", "xarray", "matplotlib")
_CPU_FILE = "/proc/cpuinfo"
_NOT_RANDOM = "none: nothing in this computation is drawn at random"


class Origin(NamedTuple):
    """`command`: as it was typed; `seconds`: that it took until the report was written.

    `facts`: what else is to be known, by name; `seed`: of what is random.
    """

    command: str
    seconds: float
    facts: Sequence[tuple[str, str]] = ()
    seed: str = _NOT_RANDOM


def origin_section(origin: Origin) -> Section:
    """Versions, date, machine, seed."""
    now = datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")
    entries = [
        ("frictionjax", version("frictionjax")),
        ("made on", f"{now}, in {origin.seconds:.3g} s from the start of the command"),
        *origin.facts,
        ("numbers", "64-bit floats"),
        ("seed", origin.seed),
        ("Python", f"{platform.python_version()} on {platform.platform()}"),
        ("processor", f"{_processor()}, {os.cpu_count()} cores"),
        ("packages", ", ".join(f"{name} {version(name)}" for name in _PACKAGES)),
    ]
    return Section("Where these numbers come from", [definitions(entries)])


def _processor() -> str:
    try:
        with open(_CPU_FILE, encoding="utf-8") as file:
            for line in file:
                if line.startswith("model name"):
                    return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine() or "unknown"


def reproduction_section(
    origin: Origin,
    toml: str,
    again: Sequence[str],
    files: Sequence[tuple[str, str]],
    python: str = "",
) -> Section:
    """The command as typed, the scene file, commands that make the same again, files.

    `again`: commands, run in the folder of the report; none where the scene file does not
    hold all that is needed. `python`: lines that read the data.
    """
    blocks = [
        paragraph("The command, as it was typed:"),
        preformatted(origin.command),
        paragraph("The scene, as a file; it is in the folder beside this page too:"),
        preformatted(toml.rstrip()),
    ]
    if again:
        blocks += [
            paragraph("In that folder this makes the same numbers again:"),
            preformatted("\n".join(again)),
        ]
    if python:
        blocks += [
            paragraph("In Python the data are read like this:"),
            preformatted(python),
        ]
    blocks += [paragraph("Files in the folder:"), linked_files(files)]
    return Section("Make it again", blocks)
