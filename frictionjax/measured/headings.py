"""What the headings and comments of a text file say: units, sizes, names of columns."""

import re
from typing import NamedTuple

from .cells import Dialect
from .entries import ALONG, UP, Size, Stated, is_entry, read_entries, words_of
from .units import cell_unit, metres

_COMMENT = re.compile(r"^(?:[#%;!\"]|//)+\s*|\s*\"$")
_AMOUNT = re.compile(r"[-+]?\d[\d.,eE+-]*\s*[^\W\d_]+")  # `0.3 um` heads no column
_INDEX = re.compile(
    r"#|(n|no|nr|nos|number|num|idx|index|i|samples?|points?|pts?|counts?|pixels?|px|rows?"
    r"|lines?|columns?|col)\.?",
    re.IGNORECASE,
)
# Units that are no other word, and in brackets any.
_UNIT = re.compile(
    "(?<![^\\W\\d_])(mm|MM|cm|[\u00b5\u03bcu]m|UM|nm|NM|\u00c5|(?i:microns?|angstroms?|inch|inches"
    "|(?:centi|milli|micro|nano|pico)met(?:er|re)s?))(?![^\\W_])"
)
_IN_BRACKETS = re.compile(r"[(\[{<]\s*([^()\[\]{}<>]*?)\s*[)\]}>]")
_PARTS = ("_", "-", "/", "(", "[", "{", "<", ",")


class Headings(NamedTuple):
    """What headings say of a block of numbers: None, or nothing, where they do not.

    `length`, `height`: units of x and z. `pixel`: distance of samples. `width`: of all
    samples. `factor`: of the heights. `sizes`: `h`, `w`, rows and columns. `names`: cells
    of the heading of columns, in line `named`. `unread`: the first line with a unit of
    length that is none of these.
    """

    length: list[Stated]
    height: list[Stated]
    pixel: Size | None
    width: Size | None
    factor: Size | None
    sizes: dict[str, int]
    names: list[str]
    named: int
    unread: Stated | None

    def is_index(self, column: int) -> bool:
        """Whether a column is headed as a count of samples."""
        name = self._name(column)
        return bool(_INDEX.fullmatch(name)) and not _is_length(self.names[column])

    def is_position(self, column: int) -> bool:
        """Whether a column is headed as positions."""
        words = words_of(self._name(column))
        return bool(words & (ALONG | {"pos", "y"})) and not words & UP

    def is_height(self, column: int) -> bool:
        """Whether a column is headed as heights."""
        return bool(words_of(self._name(column)) & UP)

    def _name(self, column: int) -> str:
        """`x` of `X (um)`, `x um`, `x_um`."""
        cell = self.names[column] if self.names else ""
        for part in _PARTS:
            cell = cell.split(part)[0] or cell
        words = [w for w in cell.strip(" \"'%").split() if metres(w) is None]
        return " ".join(words)


def _is_length(cell: str) -> bool:
    unit = cell_unit(cell)
    return unit is not None and metres(unit) is not None


def read_headings(
    said: list[tuple[int, str]], columns: int, dialect: Dialect, first: int
) -> Headings:
    """Entries `key=value` or `key: value`, and units in the heading of columns.

    `first`: the line of the first numbers; no line below it heads a column. Raises
    `ValueError` for a size or factor that is no number > 0, or in no unit of length.
    """
    lines = [(number, _without_mark(text)) for number, text in said]
    entries = read_entries(lines)
    above = [(number, text) for number, text in lines if number < first]
    named, cells = _heading(above, columns, dialect)
    units = [
        Stated(named, u, i + 1) if (u := cell_unit(c)) else None
        for i, c in enumerate(cells)
    ]
    length = [s for s in units[:-1] if s] + entries.length
    height = [s for s in units[-1:] if s] + entries.height
    if not any(units):
        height += _of_all(said, above, columns)
    sizes = entries.sizes
    used = {s.line for s in (*length, *height)} | {s.line for s in sizes.values()}
    unread = next((Stated(n, t) for n, t in said if n not in used and _has_unit(t)), None)
    return Headings(
        length,
        height,
        sizes.get("pixel"),
        sizes.get("width"),
        sizes.get("factor"),
        entries.counts,
        cells,
        named,
        unread,
    )


def _without_mark(text: str) -> str:
    """A line without its comment mark; `#` in a cell of its own is a column's name."""
    cell = re.match(r"#\s*[;,\t]", text)
    return (text if cell else _COMMENT.sub("", text)).rstrip(",;\t ")


def _has_unit(text: str) -> bool:
    inside = any(metres(unit) is not None for unit in _IN_BRACKETS.findall(text))
    return inside or _UNIT.search(text) is not None


def _heading(
    above: list[tuple[int, str]], columns: int, dialect: Dialect
) -> tuple[int, list[str]]:
    """Line and cells of the heading of columns: the nearest one, or units near it."""
    plain: tuple[int, list[str]] = 0, []
    for number, text in reversed(above):
        cells = _with_units(text, columns, dialect)
        if cells and (not plain[0] or all(map(_is_length, cells))):
            return number, cells
        if cells:
            break
        if not plain[0] and _are_names(text, columns, dialect):
            plain = number, _split(text, columns, dialect)
    return plain


def _split(text: str, columns: int, dialect: Dialect) -> list[str]:
    own = [text.split(s) for s in (dialect.separator or "\t", "\t", ";")]
    cells = next((c for c in own if len(c) == columns), text.split())
    return [c.strip() for c in cells] if len(cells) == columns > 1 else []


def _are_names(text: str, columns: int, dialect: Dialect) -> bool:
    """Whether a line without units names the columns, and is no title of two words."""
    cells = _split(text, columns, dialect)
    if not cells or is_entry(text) or any(_AMOUNT.fullmatch(c) for c in cells):
        return False
    known = all(words_of(c) & (ALONG | UP) or _INDEX.fullmatch(c) for c in cells)
    strong = any(separator in text for separator in "\t;")
    return known or (strong and all(re.search(r"[^\W\d_]|#", c) for c in cells))


def _with_units(text: str, columns: int, dialect: Dialect) -> list[str]:
    """Cells of a heading with as many as the numbers have, and a unit in one or all."""
    if columns < 2:
        return []
    own = [text.split(s) for s in {dialect.separator or "\t", "\t", ";"}]
    parted = re.split(r"\s{2,}|(?<=[)\]])\s+", text)
    some = [c for c in own if len(c) == columns and _heads(c)]
    # `Height, nm` and `distance um` are no two columns.
    ways = (parted, text.split(","), text.split(" / "), text.split())
    loose = [c for c in ways if len(c) == columns]
    whole = [c for c in loose if all(map(cell_unit, c)) and _heads(c)]
    return [cell.strip() for cell in next(iter(some + whole), [])]


def _heads(cells: list[str]) -> bool:
    """Whether cells with units may head columns: amounts do not, nor does a lone `in`."""
    stripped = [cell.strip() for cell in cells]
    if any(_AMOUNT.fullmatch(cell) for cell in stripped):
        return False
    units = [cell_unit(cell) for cell in stripped]
    bare = any(metres(cell) is not None for cell in stripped)
    return all(units) if bare else any(units)


def _of_all(
    said: list[tuple[int, str]], above: list[tuple[int, str]], columns: int
) -> list[Stated]:
    """The unit of a map, or of one column: `Height [nm]`, directly above or so named."""
    marks = {number: _COMMENT.match(text) for number, text in said}
    for number, text in reversed(above):
        bracket = columns == 1 or re.search(r"[)\]]$", text)
        unit = None if is_entry(text) or not bracket else cell_unit(text)
        if unit and metres(unit) is not None:
            words = words_of(text) - {unit.lower()}
            direct = number == above[-1][0] and not marks[number]
            if direct or not words or words & (UP | {"topography"}):
                return [Stated(number, unit)]
    return []
