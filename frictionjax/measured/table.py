"""Lines of a text file: what they say, and the block of their numbers."""

from typing import NamedTuple

import numpy as np

from .._checks import require
from .cells import Dialect, find_dialect, only_marks

_COMMENTS = ("#", "%", ";", "//", "!")


class NumberTable(NamedTuple):
    """`block`: numbers, shape (rows, columns), NaN where one is missing.

    `lines`: number of each row's line, from 1. `said`: numbered lines of text, headings
    and comments. `dialect`: how the numbers are written.
    """

    block: np.ndarray
    lines: np.ndarray
    said: list[tuple[int, str]]
    dialect: Dialect


class _Row(NamedTuple):
    line: int
    text: str
    numbers: list[float]


def read_numbers(text: str, decimal: str | None) -> NumberTable:
    """Numbers and headings of a text.

    Raises `ValueError` where rows differ in length, text follows numbers, or there are no
    numbers.
    """
    numbered = enumerate(text.splitlines(), 1)
    lines = [(n, line) for n, line in numbered if line.strip().strip(' \t,;"')]
    dialect = find_dialect(lines, decimal)
    rows: list[_Row] = []
    said: list[tuple[int, str]] = []
    for number, line in lines:
        numbers = dialect.numbers(line)
        if numbers and not _is_comment(line, numbers):
            rows.append(_Row(number, line, numbers))
        else:
            said.append((number, line.strip()))
    rows, marks = _without_marks(rows, dialect)
    said = sorted([*said, *marks])
    require(bool(rows), "numbers", "nothing", "columns of numbers: a trace or a map")
    for number, line in said:
        late = number > rows[0].line and not line.startswith(_COMMENTS)
        require(not late, f"line {number}", line[:40], "numbers, after others")
    block = np.array(_of_one_width(rows))
    block[~np.isfinite(block)] = np.nan
    return NumberTable(block, np.array([row.line for row in rows]), said, dialect)


def _is_comment(line: str, numbers: list[float]) -> bool:
    """Whether a line without a number is a rule between others, or a comment mark."""
    return not any(n == n for n in numbers) and line.strip().startswith(("--", "**", ".."))


def _without_marks(
    rows: list[_Row], dialect: Dialect
) -> tuple[list[_Row], list[tuple[int, str]]]:
    """Rows without a number go where they have not a word for what is missing in all
    columns: above the numbers that may be a title."""
    widths = {len(row.numbers) for row in rows if any(n == n for n in row.numbers)}

    def kept(row: _Row) -> bool:
        words = only_marks(dialect.cells(row.text)) and len(row.numbers) in widths
        return words or any(n == n for n in row.numbers)

    return (
        [row for row in rows if kept(row)],
        [(row.line, row.text.strip()) for row in rows if not kept(row)],
    )


def _of_one_width(rows: list[_Row]) -> list[list[float]]:
    """Rows of the width of the widest, cells counted up to its last number.

    A separator may end a line, and then a cell behind it is empty.
    """
    first = rows[0]
    if all(len(row.numbers) == len(first.numbers) for row in rows):
        filled = len(first.numbers) - int(all(_ends_empty(row) for row in rows))
        return [row.numbers[:filled] for row in rows]
    width = max(len(_filled(row)) for row in rows)
    like = next(row for row in rows if len(_filled(row)) == width)
    for row in rows:
        needs = f"{width} numbers, as in line {like.line}"
        said = f"{len(row.numbers)} numbers"
        require(len(row.numbers) >= width, f"line {row.line}", said, needs)
    return [row.numbers[:width] for row in rows]


def _ends_empty(row: _Row) -> bool:
    return row.numbers[-1] != row.numbers[-1] and row.text.rstrip(" \r")[-1] in ";,\t"


def _filled(row: _Row) -> list[float]:
    """Numbers without those behind the last separator, where nothing is."""
    numbers = row.numbers
    return numbers[:-1] if _ends_empty(row) else numbers
