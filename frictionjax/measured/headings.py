"""What the headings and comments of a text file say: units, sizes, factors."""

import re
from typing import NamedTuple

from ..arguments import require
from .cells import Dialect
from .units import ALLOWED, cell_unit, metres

_COMMENT = re.compile(r"^(?:[#%;!\"]|//)+\s*|\s*\"$")
_ENTRY = re.compile(r"\s*([^=:]+?)\s*[=:]\s*(.*?)\s*")
_SIZES = re.compile(r"\b([hw])\s*=\s*(\d+)\b")
_QUANTITY = re.compile(r"([-+.\deE]+)\s*(\S.*)?")
_ALONG = {"x", "xy", "lateral", "position", "distance", "horizontal", "length", "spacing"}
_UP = {"z", "value", "height", "heights", "data", "vertical", "amplitude"}
_EITHER = {"unit", "units", "axis", "all", "of", "measurement"}


class Stated(NamedTuple):
    """One thing that a file says: where, and what."""

    line: int
    text: str
    column: int = 0

    @property
    def place(self) -> str:
        return f"line {self.line}" + (f", column {self.column}" if self.column else "")


class Headings(NamedTuple):
    """What headings say of a block of numbers: None, or nothing, where they do not.

    `length`, `height`: units of x and z. `pixel`: distance of samples in m. `width`: of
    all samples, in m. `factor`: m per unit of the heights. `sizes`: `h`, `w`, rows and
    columns.
    """

    length: list[Stated]
    height: list[Stated]
    pixel: float | None
    width: float | None
    factor: float | None
    sizes: dict[str, int]


def read_headings(said: list[tuple[int, str]], columns: int, dialect: Dialect) -> Headings:
    """Entries `key=value` or `key: value`, and units in the headings of columns.

    Raises `ValueError` for a size or factor that is no number > 0, or in no unit of length.
    """
    lines = [(number, _COMMENT.sub("", text)) for number, text in said]
    sizes = {k: int(v) for _, text in lines for k, v in _SIZES.findall(text)}
    entries = [(n, m[1], m[2]) for n, text in lines if (m := _ENTRY.fullmatch(text))]
    length, height = _units_of_columns(lines, columns, dialect)
    for number, key, value in entries:
        along, up = _meant(key)
        length += [Stated(number, value)] if along and value else []
        height += [Stated(number, value)] if up and value else []
    found = {
        name: _size(number, key, value, name)
        for number, key, value in entries
        for name in _named(key, value)
    }
    get = found.get
    return Headings(length, height, get("pixel"), get("width"), get("factor"), sizes)


def _meant(key: str) -> tuple[bool, bool]:
    """Whether `X unit`, `Value units` or `Units` speak of lengths, of heights."""
    words = set(re.findall(r"[a-z]+", key.lower()))
    if not words & {"unit", "units"}:
        return False, False
    both = words <= _EITHER
    up = bool(words & _UP)
    return both or (not up and bool(words & _ALONG)), both or up


def _named(key: str, value: str) -> list[str]:
    """Which size an entry gives: of a pixel, of a map (Gwyddion's `Width: 10 um`)."""
    lower = key.lower()
    if lower.startswith("height conversion factor"):
        return ["factor"]
    if lower.startswith(("pixel size", "pixel width", "x pixel size")):
        return ["pixel"]
    quantity = _QUANTITY.fullmatch(value)
    return ["width"] if lower == "width" and quantity and quantity[2] else []


def _size(number: int, key: str, text: str, name: str) -> float:
    """A size in m; a factor in m per unit, whose key may say `(-> nm)`."""
    quantity = _QUANTITY.fullmatch(text)
    try:
        value = float(quantity[1].replace(",", ".")) if quantity else 0.0
    except ValueError:
        value = 0.0
    place = f"line {number}, {key.lower().split('(')[0].strip()}"
    require(0 < value < float("inf"), place, text, "a number > 0 in m")
    arrow = re.search(r"->\s*([^\s)]+)", key)
    unit = arrow[1] if arrow else (quantity and quantity[2]) or "m"
    scale = metres(unit)
    require(scale is not None, place, text, ALLOWED)
    assert scale is not None
    return value * scale


def _units_of_columns(
    lines: list[tuple[int, str]], columns: int, dialect: Dialect
) -> tuple[list[Stated], list[Stated]]:
    """Units in the heading nearest to the numbers that has one for a column."""
    for number, text in reversed(lines):
        cells = _cells_of(text, columns, dialect)
        units = [cell_unit(cell) for cell in cells]
        stated = [Stated(number, u, i + 1) if u else None for i, u in enumerate(units)]
        if len(cells) == 1 and stated[0]:
            return [], [stated[0]._replace(column=0)]
        if any(stated):
            return [s for s in stated[:-1] if s], [s for s in stated[-1:] if s]
    return [], []


def _cells_of(text: str, columns: int, dialect: Dialect) -> list[str]:
    """Cells of a heading with as many as the numbers have, up to three; or one, or none."""
    if columns in (2, 3):
        own = [text.split(s) for s in {dialect.separator or "\t", "\t", ";"}]
        parted = re.split(r"\s{2,}|(?<=[)\]])\s+", text)
        some = [c for c in own if len(c) == columns and any(map(cell_unit, c))]
        # `Height, nm` and `distance um` are no two columns.
        loose = [c for c in (parted, text.split(","), text.split()) if len(c) == columns]
        whole = [cells for cells in loose if all(map(cell_unit, cells))]
        return next(iter(some + whole), [])
    entry = _ENTRY.fullmatch(text)
    unit = cell_unit(text) if columns == 1 or re.search(r"[)\]]$", text) else None
    return [text] if not entry and unit and metres(unit) else []
