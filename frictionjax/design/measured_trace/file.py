"""Files of traces: which columns they have, in which units."""

from pathlib import Path
from typing import Any

import numpy as np

from ..._checks import require
from ..._text import Table, factor_of, read_table
from .comments import with_comments

TRACE_QUANTITIES = ("force", "z")
_DIMENSIONS = {"t": "time", "force": "force", "z": "length"}
_SAME = {  # other names of columns
    "time": "t",
    "friction force": "force",
    "lateral force": "force",
    "tangential force": "force",
}
_CALLED = {"t": "times"}
_SKIPPED = ("index", "#", "no", "no.", "sample")
_KNOWN = "t, force or z, uncertainty, or index, which is skipped"


def trace_columns(path: Path, decimal: str | None = None) -> dict[str, np.ndarray]:
    """Columns of a file by name: `t`, `force` or `z`, `uncertainty`; in s, N and m.

    Raises `ValueError` that names line and column of what is not one of these.
    """
    table = read_table(path.read_bytes(), decimal)
    names = [_SAME.get(heading.name, heading.name) for heading in table.headings]
    listed = ", ".join(names)
    columns = f"line {table.heading_line}, columns"
    require("t" in names, columns, listed, "t among them")
    measured = [name for name in TRACE_QUANTITIES if name in names]
    require(bool(measured), columns, listed, "force or z among them")
    require(len(measured) == 1, columns, listed, "one of force and z")
    table = table._replace(headings=with_comments(table, names, _DIMENSIONS))
    found: dict[str, np.ndarray] = {}
    for column, name in enumerate(names):
        if name in _SKIPPED:
            continue
        place = table.heading_place(column)
        require(name in (*_DIMENSIONS, "uncertainty"), place, name, _KNOWN)
        require(name not in found, place, name, f"one column of {_CALLED.get(name, name)}")
        found[name] = _in_si(table, column, name, measured[0], names)
    _require_times(table, names.index("t"))
    if "uncertainty" in names:
        _require_positive(table, names.index("uncertainty"))
    return found


def _in_si(
    table: Table, column: int, name: str, measured: str, names: list[str]
) -> np.ndarray:
    heading, place = table.headings[column], table.heading_place(column)
    if name == "uncertainty":
        own = table.headings[names.index(measured)].unit
        known = bool(own) == bool(heading.unit)
        allowed = f"a unit, or none, as {measured} has: {measured} ({own or '-'})"
        require(known, place, f"{name} ({heading.unit or '-'})", allowed)
    dimension = _DIMENSIONS[measured if name == "uncertainty" else name]
    return table.numbers[:, column] * factor_of(place, heading, dimension)


def _require_times(table: Table, column: int) -> None:
    times = table.numbers[:, column]
    require(times[0] >= 0, table.place(0, column), times[0], "times from 0 on")
    back = np.flatnonzero(np.diff(times) <= 0)
    if back.size:
        row = int(back[0]) + 1
        allowed = f"increasing times, more than {times[row - 1]:.10g} on the line before"
        require(False, table.place(row, column), times[row], allowed)


def _require_positive(table: Table, column: int) -> None:
    values: Any = table.numbers[:, column]
    bad = np.flatnonzero(values <= 0)
    if bad.size:
        row = int(bad[0])
        require(False, table.place(row, column), values[row], "an uncertainty > 0")
