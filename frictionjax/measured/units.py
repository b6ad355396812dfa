"""Units of length, as instruments and people write them."""

import re

from .._checks import require

ALLOWED = "a unit of length (m, mm, um, nm, pm, angstrom, inch, ...)"
_MICRO = "[\u00b5\u03bcu]"  # micro sign, Greek mu, and the letter where neither is there
_SYMBOLS: dict[str, float] = {  # as they stand: "Mm" is no millimetre
    r"m": 1.0,
    r"km": 1e3,
    r"mm|MM": 1e-3,
    r"cm|CM": 1e-2,
    r"dm": 0.1,
    rf"{_MICRO}m|UM|\u00b5M|mkm|\u043c\u043a\u043c": 1e-6,
    r"nm|NM": 1e-9,
    r"pm": 1e-12,
    "A|\u00c5|\u212b|Ang": 1e-10,
    r"in": 0.0254,
    r"mil|thou": 2.54e-5,
    rf"{_MICRO}in": 2.54e-8,
}
_WORDS: dict[str, float] = {  # in any case, with or without an s
    r"met(er|re)": 1.0,
    r"centimet(er|re)": 1e-2,
    r"millimet(er|re)": 1e-3,
    r"micromet(er|re)|micron": 1e-6,
    r"nanomet(er|re)": 1e-9,
    r"picomet(er|re)": 1e-12,
    "angstrom|\u00e5ngstr\u00f6m": 1e-10,
    r"inch|inches": 0.0254,
    r"microinch|microinches": 2.54e-8,
}


def metres(unit: str) -> float | None:
    """Metres in a unit of length; None for what is none."""
    text = unit.strip().rstrip(".")
    for symbol, value in _SYMBOLS.items():
        if re.fullmatch(symbol, text):
            return value
    for word, value in _WORDS.items():
        if re.fullmatch(f"({word})s?", text, re.IGNORECASE):
            return value
    return None


def require_unit(name: str, unit: str | None) -> float | None:
    """Metres in a unit that a user has given, None where he has given none."""
    if unit is None:
        return None
    value = metres(unit) if isinstance(unit, str) else None
    require(value is not None, name, unit, ALLOWED)
    return value


_CELL = (  # `Z (nm)`, `[um]`, `X/mm`, `x_um`, `Distance, um`, `Lateral um`, `nm`
    re.compile(r"[(\[{<]\s*([^()\[\]{}<>]*?)\s*[)\]}>]$"),
    re.compile(r"(?:.*[/_,\s])?([^/_,\s]+)$"),
    re.compile(r"(.*\s(A|in)|[nN]/[aA])$"),  # "Profile A", "measured in"
)
_OTHERS = re.compile(r"m?V|deg|rad|px|pixels?|samples?|counts?|a\.?u\.?|s|\u00b0|%")


def cell_unit(cell: str) -> str | None:
    """The unit that a cell of a heading states, of length or not; None without one."""
    text = cell.strip().strip("\"'#% ")
    bracket, last, phrase = (pattern.search(text) for pattern in _CELL)
    if bracket:
        return bracket[1] or None
    word = last[1] if last and not phrase else ""
    return word if metres(word) is not None or _OTHERS.fullmatch(word) else None
