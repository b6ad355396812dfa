"""Headings of columns as instruments write them: a name, and the unit of its numbers."""

import re
from typing import NamedTuple

from .._checks import require

_PREFIXES = {"": 1.0, "k": 1e3, "m": 1e-3, "u": 1e-6, "n": 1e-9, "p": 1e-12}
UNITS = {
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0},
    "force": {f"{prefix}N": size for prefix, size in _PREFIXES.items()},
    "length": {f"{prefix}m": size for prefix, size in _PREFIXES.items()} | {"cm": 1e-2},
}
"""Factors to s, N and m, by unit, of each dimension; a micro sign counts as u."""

_MICRO = str.maketrans({"\u00b5": "u", "\u03bc": "u"})
_WRITTEN = (
    re.compile(r"^(?P<name>[^(\[]*)[(\[](?P<unit>[^)\]]*)[)\]]$"),  # force (mN), force [mN]
    re.compile(r"^(?P<name>[^/]*)/(?P<unit>[^/]*)$"),  # force/mN
)
_LOOSE = re.compile(r"^(?P<name>.*[^\s,])[\s,]+(?P<unit>\S+)$")  # force, mN; force mN
_JOINED = re.compile(r"^(?P<name>.+)_(?P<unit>[^_]+)$")  # force_mN


class Heading(NamedTuple):
    """A column: `name` in lower case, and `unit` as it is written, "" where none is."""

    name: str
    unit: str


def heading_of(text: str) -> Heading:
    """Name and unit of `force (mN)`, `force [mN]`, `force/mN`, `force_mN`, `force, mN`,
    `force mN` or `force`."""
    plain = text.strip().translate(_MICRO)
    for pattern in _WRITTEN:
        found = pattern.match(plain)
        if found:
            return Heading(found["name"].strip().lower(), found["unit"].strip())
    for pattern in (_JOINED, _LOOSE):
        found = pattern.match(plain)
        if not found or not is_unit(found["unit"]):
            continue
        return Heading(found["name"].strip().lower(), found["unit"])
    return Heading(plain.lower(), "")


def is_unit(text: str) -> bool:
    """Whether a text is a unit that is known, of any dimension."""
    return any(plain_unit(text) in known for known in UNITS.values())


def plain_unit(text: str) -> str:
    """A unit as `UNITS` has it, without brackets."""
    return text.strip().strip("()[]").strip().translate(_MICRO)


def size_of(unit: str, dimension: str) -> float | None:
    """Factor from a unit to s, N or m; None where it is none of that dimension."""
    return UNITS.get(dimension, {}).get(unit)


def factor_of(label: str, heading: Heading, dimension: str) -> float:
    """Factor from a column's unit to s, N or m; 1 where it has none.

    Raises `ValueError` for a unit that is not one of its dimension.
    """
    if not heading.unit:
        return 1.0
    known = UNITS[dimension]
    allowed = f"a unit of {dimension}: {', '.join(known)}"
    require(heading.unit in known, label, heading.unit, allowed)
    return known[heading.unit]
