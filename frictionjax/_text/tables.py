"""Tables of numbers in text files of instruments, whatever wrote them.

UTF-8 with or without a byte order mark, UTF-16, and what Windows writes in western Europe;
columns between semicolons, tabs, commas or blanks; decimal commas where no comma separates
columns. What cannot be read is named by line and column.
"""

import csv
import re
from typing import NamedTuple

import numpy as np

from .._checks import require
from .encoding import decoded
from .thousands import BOTH_WAYS, is_grouped, ungrouped
from .units import Heading, heading_of, is_unit

_COMMENTS = ("#", "%", "//")
_NUMBER = re.compile(r"[-+]?(\d+[.,]?\d*|[.,]\d+)([eEdD][-+]?\d+)?$")
_BLANK = " "
_GROUPS = BOTH_WAYS.format(option="in the call")
_EMPTY = "an empty cell"
_POINTS = {".": "point", ",": "comma"}
# Names between blanks, each with the unit in brackets behind it.
_WORDS = re.compile(r"[^\s(\[]+(?:\s*[(\[][^)\]]*[)\]])?|[(\[][^)\]]*[)\]]")


class Table(NamedTuple):
    """Columns under headings: `numbers` (rows, columns); `lines` (rows,) of the file."""

    headings: list[Heading]
    numbers: np.ndarray
    lines: list[int]
    heading_line: int
    comments: list[tuple[int, str]] = []

    def place(self, row: int, column: int) -> str:
        """Where a number stands in the file."""
        return place_of(self.lines[row], column, self.headings[column].name)

    def heading_place(self, column: int) -> str:
        """Where a heading stands in the file."""
        return place_of(self.heading_line, column)


class _Row(NamedTuple):
    line: int
    cells: list[str]


def place_of(line: int, column: int, name: str = "") -> str:
    """`line 3, column 2 (force)`, columns counted from 0 and told from 1."""
    return f"line {line}, column {column + 1}{f' ({name})' if name else ''}"


def read_table(data: bytes, decimal: str | None = None) -> Table:
    """A line of headings, perhaps one of units below it, and lines of numbers.

    `decimal`: the mark of decimals, "." or ",", where the file can be read both ways.

    Raises `ValueError` that names line and column: for no such lines, a row of another
    length, a cell that is empty or no finite number, two columns of one name.
    """
    good = decimal in (None, ".", ",")
    require(good, "decimal", decimal, 'a point "." or a comma ","')
    text = decoded(data)
    rows = _rows(text)
    require(len(rows) > 1, "lines", len(rows), "a line of names and lines of numbers")
    first, *rest = rows
    name = f"line {first.line}"
    said = " ".join(first.cells)
    require(not _numeric(first), name, said, "names of the columns above numbers")
    headings = [heading_of(cell) for cell in first.cells]
    if any(map(is_unit, rest[0].cells)):
        headings = _with_units(first, headings, rest.pop(0))
    _require_names(first, headings)
    require(bool(rest), "lines", "names alone", "lines of numbers below them")
    for row in rest:
        _require_length(row, len(headings), headings)
    numbers = _numbers(headings, rest, decimal)
    comments = [(i, line.strip()) for i, line in _comments(text) if i != first.line]
    return Table(headings, numbers, [row.line for row in rest], first.line, comments)


def _comments(text: str) -> list[tuple[int, str]]:
    lines = enumerate(text.splitlines(), start=1)
    return [(i, line) for i, line in lines if line.lstrip().startswith(_COMMENTS)]


def _numeric(row: _Row) -> bool:
    return all(_NUMBER.match(cell) for cell in row.cells)


def _rows(text: str) -> list[_Row]:
    """The lines that are neither blank nor comments, as cells.

    The last comment above numbers is their heading, where it has as many names.
    """
    every = [(i, line) for i, line in enumerate(text.splitlines(), start=1) if line.strip()]
    lines = [(i, line) for i, line in every if not line.lstrip().startswith(_COMMENTS)]
    if not lines:
        return []
    above = [(i, line.lstrip(" #%/")) for i, line in every if i < lines[0][0]]
    for number, names in above[-1:]:
        heading, *found = _split([(number, names), *lines])
        if _numeric(found[0]) and len(heading.cells) == len(found[0].cells):
            return [heading, *found]
    return _split(lines)


def _split(lines: list[tuple[int, str]]) -> list[_Row]:
    """Cells, between what separates those of the first line."""
    heading = lines[0][1]
    separator = next((known for known in (";", "\t", ",") if known in heading), _BLANK)
    return [_Row(number, _cells(line, separator)) for number, line in lines]


def _cells(line: str, separator: str) -> list[str]:
    if separator == _BLANK:
        return [word.strip() for word in _WORDS.findall(line)]
    (cells,) = csv.reader([line], delimiter=separator, skipinitialspace=True)
    cells = [cell.strip() for cell in cells]
    return cells[:-1] if len(cells) > 1 and not cells[-1] else cells


def _with_units(first: _Row, headings: list[Heading], units: _Row) -> list[Heading]:
    """Headings with the units of the line below them; "-" is none."""
    _require_length(units, len(headings))
    found = []
    for column, (heading, cell) in enumerate(zip(headings, units.cells, strict=True)):
        known = place_of(first.line, column)
        require(not heading.unit, known, first.cells[column], "its unit in one place")
        plain = cell.strip("()[]- ")
        place = place_of(units.line, column, heading.name)
        require(is_unit(plain) or not plain, place, cell, "a unit, or a number")
        found.append(Heading(heading.name, heading_of(f"({plain})").unit))
    return found


def _require_names(first: _Row, headings: list[Heading]) -> None:
    seen: dict[str, int] = {}
    for column, heading in enumerate(headings):
        place = place_of(first.line, column)
        require(heading.name, place, first.cells[column], "a name")
        before = seen.setdefault(heading.name, column)
        needs = f"another name than column {before + 1}"
        require(before == column, place, first.cells[column], needs)


def _require_length(row: _Row, count: int, headings: list[Heading] | None = None) -> None:
    size, needs = len(row.cells), f"{count}, one for each name"
    # An empty last cell was taken for the end of the line.
    last = place_of(row.line, size, headings[-1].name if headings else "")
    require(size != count - 1, last, _EMPTY, "a number" if headings else "a unit, or -")
    require(size == count, f"line {row.line}", f"{size} fields", needs)


def _numbers(headings: list[Heading], rows: list[_Row], decimal: str | None) -> np.ndarray:
    found = np.empty((len(rows), len(headings)))
    if decimal is None:
        _require_decimals(headings, rows)
    points = decimal or ""
    for index, row in enumerate(rows):
        for column, cell in enumerate(row.cells):
            place = place_of(row.line, column, headings[column].name)
            require(cell, place, _EMPTY, "a number")
            if decimal is not None:
                cell = ungrouped(cell, "," if decimal == "." else ".")
            require(_NUMBER.match(cell), place, cell, "a finite number")
            for point in ".,":
                if point in cell:
                    points = points or point
                    needs = f"decimal {_POINTS[points]}s, as above"
                    require(point == points, place, cell, needs)
            plain = cell.replace(",", ".").replace("d", "e").replace("D", "e")
            found[index, column] = float(plain)
    return found


def _require_decimals(headings: list[Heading], rows: list[_Row]) -> None:
    """Raise where all commas stand as those of thousands do: `25,875`."""
    marked = [
        (row.line, column, cell)
        for row in rows
        for column, cell in enumerate(row.cells)
        if "," in cell
    ]
    points = any("." in cell for row in rows for cell in row.cells)
    if points or not marked or not all(is_grouped(c) for _, _, c in marked):
        return
    line, column, cell = marked[0]
    require(False, place_of(line, column, headings[column].name), cell, _GROUPS)
