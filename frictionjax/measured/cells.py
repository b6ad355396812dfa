"""Numbers of a line: what parts them, which mark their decimals have."""

import csv
import math
import re
from typing import NamedTuple

from .._checks import require
from .._text import BOTH_WAYS, is_grouped, ungrouped
from .units import cell_unit

_MISSING = re.compile(
    r"-*|\*+|\?+|\.+|bad|nan|[-+]?1\.#\w*|#?n/?a!?|#num!|#wert!|null|none|void|invalid"
    r"|missing|masked|[-+]?inf(inity)?",
    re.IGNORECASE,
)
_WORD = re.compile(r"bad|nan|n/?a|null|void|invalid|missing|masked", re.IGNORECASE)
_NUMBER = re.compile(r"[-+]?(\d+[.,]?\d*|[.,]\d+)([eEdD][-+]?\d+)?")
_DATE = re.compile(r"\d[-.]\d+[-.]\d")
_PAIRS = re.compile(r"[-+]?\d+,\d+([eE][-+]?\d+)?(,[-+]?\d+,\d+([eE][-+]?\d+)?)*")
_NUMERIC = re.compile(r'[\d\s+\-.,;eEdD"]*\d[\d\s+\-.,;eEdD"]*')
_EITHER = (
    'decimal="." where commas part columns, decimal="," where they mark decimals: '
    "this line can be read both ways"
)
_BOTH = (
    'decimal="." where commas part whole numbers; where they mark decimals, '
    '";" or a tab between columns'
)
_GROUPS = BOTH_WAYS.format(option="(--decimal)")


class Dialect(NamedTuple):
    """`separator` of cells, None for white space; `decimal`: a point or a comma."""

    separator: str | None
    decimal: str

    def cells(self, line: str) -> list[str]:
        """Cells of a line, empty ones too where a letter parts them."""
        if self.separator is None:
            return line.replace('"', " ").split()
        if '"' in line:
            return [c.strip() for c in next(csv.reader([line], delimiter=self.separator))]
        return [cell.strip() for cell in line.split(self.separator)]

    def numbers(self, line: str) -> list[float] | None:
        """Numbers of a line, NaN where one is missing; None for a line of text."""
        cells = self.cells(line)
        try:
            return self._plain(cells)
        except ValueError:
            values = [self._number(cell) for cell in cells]
        known = [v for v in values if v is not None]
        return known if len(known) == len(values) else None

    def _plain(self, cells: list[str]) -> list[float]:
        """What nearly every line is: a twentieth of the time."""
        joined = "".join(cells)
        if "_" in joined or ("." in joined and self.decimal == ","):
            raise ValueError
        if self.decimal == ",":
            return [float(cell.replace(",", ".")) for cell in cells]
        return [float(cell) for cell in cells]

    def _number(self, cell: str) -> float | None:
        if _MISSING.fullmatch(cell):
            return math.nan
        text = cell.replace("\u2212", "-")
        other = "," if self.decimal == "." else "."
        text = ungrouped(text, other)
        if not _NUMBER.fullmatch(text) or other in text:
            return None
        return float(text.replace(",", ".").upper().replace("D", "E"))


def only_marks(cells: list[str]) -> bool:
    """Whether a row has no number, and a word in every cell for what is missing."""
    return bool(cells) and all(_WORD.fullmatch(cell) for cell in cells)


def find_dialect(lines: list[tuple[int, str]], decimal: str | None) -> Dialect:
    """How numbered lines write their numbers.

    Raises `ValueError` where a comma may part columns or thousands, or mark decimals.
    """
    found = _dialect_of(lines, decimal)
    if decimal is None and found.decimal == ",":
        _require_decimals(lines, found)
    return found


def _require_decimals(lines: list[tuple[int, str]], dialect: Dialect) -> None:
    """Raise where all commas stand as those of thousands do: `20,292`."""
    rows = [(n, line) for n, line in lines if _is_numeric(line) and "," in line]
    cells = [cell for _, line in rows for cell in dialect.cells(line) if "," in cell]
    grouped = bool(cells) and all(map(is_grouped, cells))
    if grouped:
        number, text = rows[0]
        require(False, f"line {number}", text.strip()[:40], _GROUPS)


def _dialect_of(lines: list[tuple[int, str]], decimal: str | None) -> Dialect:
    good = decimal in (None, ".", ",")
    require(good, "decimal", decimal, 'a point "." or a comma ","')
    rows = [(n, line.strip().strip(",")) for n, line in lines if _is_numeric(line)]
    texts = [text for _, text in rows]
    tabs = any("\t" in text for text in texts)
    spaced = any(len(c.split()) > 1 for t in texts for c in t.split("\t"))
    if any(";" in text for text in texts):
        return Dialect(";", decimal or _mark(rows))
    if any('","' in text for text in texts):
        return Dialect(",", decimal or _mark([(n, t.replace('","', "")) for n, t in rows]))
    if not any("," in text for text in texts) or decimal == ",":
        return Dialect("\t" if tabs and not spaced else None, decimal or ".")
    if tabs and not any(re.search(r",\s|\s,", text) for text in texts):
        return Dialect("\t", decimal or _mark(rows))
    words = [word for text in texts for word in text.split() if "," in word]
    if decimal and spaced and all(map(is_grouped, words)):
        return Dialect(None, decimal)
    return Dialect(",", ".") if decimal else _of_commas(rows, _heading(lines, rows))


def _is_numeric(line: str) -> bool:
    words = " ".join("" if _WORD.fullmatch(w) else w for w in re.split(r"[\s;]+", line))
    return bool(_NUMERIC.fullmatch(words)) and not _DATE.search(line)


def _mark(rows: list[tuple[int, str]]) -> str:
    """The decimal mark, where something else than a comma parts cells."""
    commas = next((row for row in rows if "," in row[1]), None)
    points = next((row for row in rows if "." in row[1]), None)
    if commas and points:
        number, text = max(commas, points)
        needs = "one mark for decimals: points and commas occur"
        require(False, f"line {number}", text[:40], needs)
    return "," if commas else "."


def _heading(lines: list[tuple[int, str]], rows: list[tuple[int, str]]) -> str:
    """The line above the numbers."""
    above = [line for number, line in lines if number < rows[0][0]]
    return above[-1].strip() if above else ""


def _of_commas(rows: list[tuple[int, str]], heading: str) -> Dialect:
    """Numbers with commas, and at most white space beside them.

    `0,5` is two whole numbers or one with decimals. Columns: a point, a sign or an
    exponent stands where decimals have none, or the heading has a unit for each. One
    number: its decimals begin with 0, or other lines have none.
    """
    texts = [text for _, text in rows]
    if any("." in text for text in texts):
        return Dialect(",", ".")
    words = [word for text in texts for word in text.split()]
    single = all(word.count(",") <= 1 for word in words)
    beside = any(re.search(r",\s|\s,", text) for text in texts)
    if beside and not any(re.search(r"\S,\S", text) for text in texts):
        return Dialect(",", ".")
    if not beside and single and all(len(text.split()) > 1 for text in texts):
        return Dialect(None, ",")
    if not beside and not all(_PAIRS.fullmatch(text) for text in texts):
        whole = single and not all("," in text for text in texts)
        return Dialect(None, ",") if whole else Dialect(",", ".")
    counts = {text.count(",") for text in texts}
    if counts == {heading.count(",")} and all(map(cell_unit, heading.split(","))):
        return Dialect(",", ".")
    if not beside and single and any(re.search(r",0\d", word) for word in words):
        return Dialect(None, ",")
    number, first = next((n, t) for n, t in rows if "," in t)
    require(False, f"line {number}", first[:40], _EITHER if single else _BOTH)
    raise AssertionError
