"""Lines `key=value` of a text file: units, sizes of pixels, factors of heights."""

import re
from typing import NamedTuple

from .._checks import require
from .units import ALLOWED, metres

_ENTRY = re.compile(r"\s*([^=:]+?)\s*[=:]\s*(.*?)\s*")
_BLANK = re.compile(r"(.*(?:units?|einheit(?:en)?))\s+(\S+)", re.IGNORECASE)  # XUNIT mm
_NEXT = re.compile(r"[;,]\s*(?=[^;,=:\d]+[=:])")  # `unit x = mm, unit z = um`
_SIZES = re.compile(r"\b([hw])\s*=\s*(\d+)\b")
_QUANTITY = re.compile(r"(-?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][-+]?\d+)?)\s*(\S.*)?")
_THOUSANDS = re.compile(r"[1-9]\d{0,2}(,\d{3})+")
_BRACKET = re.compile(r"[(\[{<]\s*(->)?\s*([^()\[\]{}<>]*?)\s*[)\]}>]\s*$")
_OPENS = re.compile(r"[(\[{<]")
_LAST = re.compile(r"(?:_|\s+in\s+)([^\W\d_]+)$")  # pixel_size_um
_A_PIXEL = re.compile(r"(x )?pixel ?(size|width|spacing|pitch)\b(?!.*\by\b)")
_LETTERS = re.compile(r"[^\W\d_]+")
ALONG = {"x", "xy", "lateral", "position", "distance", "horizontal", "length", "spacing"}
UP = {"z", "value", "height", "heights", "data", "vertical", "amplitude"}
_EITHER = {"unit", "axis", "all", "of", "measurement"}


class Stated(NamedTuple):
    """One thing that a file says: where, and what."""

    line: int
    text: str
    column: int = 0

    @property
    def place(self) -> str:
        return f"line {self.line}" + (f", column {self.column}" if self.column else "")


class Size(NamedTuple):
    """A size that a file gives; `unit` in m, None where the file states none."""

    line: int
    place: str
    text: str
    value: float
    unit: float | None


class Entries(NamedTuple):
    """What entries say: units of lengths and heights, sizes by name, `h` and `w`."""

    length: list[Stated]
    height: list[Stated]
    sizes: dict[str, Size]
    counts: dict[str, int]


def read_entries(lines: list[tuple[int, str]]) -> Entries:
    """Entries `key=value` or `key: value`, several in a line perhaps.

    Raises `ValueError` for a size or factor that is no number > 0, in no unit of length,
    or given twice.
    """
    length: list[Stated] = []
    height: list[Stated] = []
    sizes: dict[str, Size] = {}
    for number, text in lines:
        for key, value in _entries_of(text):
            along, up = _meant(key)
            length += [Stated(number, value)] if along and value else []
            height += [Stated(number, value)] if up and value else []
            for name in _named(key, value):
                found = _size(number, key, value)
                old = sizes.setdefault(name, found)
                same = (old.value, old.unit) == (found.value, found.unit)
                require(same, found.place, value, f"{old.text} as {old.place}")
    counts = {k: int(v) for _, text in lines for k, v in _SIZES.findall(text)}
    return Entries(length, height, sizes, counts)


def is_entry(text: str) -> bool:
    """Whether a line is `key=value`."""
    return _ENTRY.fullmatch(text) is not None


def _entries_of(text: str) -> list[tuple[str, str]]:
    blank = _BLANK.fullmatch(text)
    if blank and metres(blank[2]) is not None:
        return [(blank[1], blank[2])]
    pieces = [_ENTRY.fullmatch(piece) for piece in _NEXT.split(text)]
    return [(m[1], m[2]) for m in pieces if m]


def words_of(text: str) -> set[str]:
    """Words of a key in lower case: `UnitX`, `XUNIT` and `X-Einheit` are two each."""
    parted = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text)
    spaced = re.sub(r"(?i)units?|einheit(?:en)?", " unit ", parted)
    return set(_LETTERS.findall(spaced.lower()))


def _meant(key: str) -> tuple[bool, bool]:
    """Whether `X unit`, `Value units` or `Units` speak of lengths, of heights."""
    words = words_of(key)
    if "unit" not in words:
        return False, False
    both = words <= _EITHER
    up = bool(words & UP)
    return both or (not up and bool(words & ALONG)), both or up


def _named(key: str, value: str) -> list[str]:
    """Which size an entry gives: of a pixel, of a map (Gwyddion's `Width: 10 um`)."""
    if key.lower().startswith("height conversion factor"):
        return ["factor"]
    plain = " ".join(re.split(r"[\s_-]+", _BRACKET.sub("", key).lower().strip()))
    if _A_PIXEL.match(plain):
        return ["pixel"]
    quantity = _QUANTITY.fullmatch(value)
    stated = quantity and (quantity[2] or _unit_in(key) is not None)
    return ["width"] if plain == "width" and stated else []


def _unit_in(key: str) -> float | None:
    """m per unit of `pixel size (um)`, `factor (nm/unit)`, `factor (-> nm)`."""
    bracket, last = _BRACKET.search(key), _LAST.search(key.strip())
    if bracket:
        return metres(bracket[2].split("/")[0])
    return metres(last[1]) if last else None


def _size(number: int, key: str, text: str) -> Size:
    place = f"line {number}, {_OPENS.split(key.lower())[0].strip()}"
    quantity = _QUANTITY.fullmatch(text)
    value = float(quantity[1].replace(",", ".")) if quantity else 0.0
    require(0 < value < float("inf"), place, text, "a number > 0 in m, or with its unit")
    assert quantity is not None
    clear = not _THOUSANDS.fullmatch(quantity[1])
    require(clear, place, text, "a decimal point: a comma may part thousands")
    arrow = _BRACKET.search(key)
    known = _unit_in(key)
    require(known is not None or not (arrow and arrow[1]), place, key, ALLOWED)
    own = metres(quantity[2].split("/")[0]) if quantity[2] else None
    require(own is not None or not quantity[2], place, text, ALLOWED)
    same = own is None or known is None or own == known
    require(same, place, text, f"one unit: its key is {key}")
    return Size(number, place, text, value, known if own is None else own)
