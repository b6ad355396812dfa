"""Units of a trace that comments of its file state: `# force in mN`."""

import re

from ..._checks import require
from ..._text import Heading, Table, is_unit, place_of, plain_unit, size_of

_TOKENS = re.compile(r"[^\s,;:=()\[\]/]+")
_FILLERS = {"in", "is", "are", "unit", "units", "given", "measured", "column"}
_OTHERS = {"lbf", "ozf", "gf", "kgf", "dyn", "V", "mV"}  # named where they are refused
_SAME = {"time": "t", "times": "t", "forces": "force"}
_WORDS = {"min", "h", "s", "m", "N"}  # other things in a sentence
_NEEDS = "its unit in the heading, as force (mN): this comment is not understood"


def with_comments(
    table: Table, names: list[str], dimensions: dict[str, str]
) -> list[Heading]:
    """Headings, with units that comments state for columns that have none.

    `dimensions`: of columns by name. Raises `ValueError` for a comment that differs from
    a heading, and one with a unit whose column is not told.
    """
    found = list(table.headings)
    for line, text in table.comments:
        for word, unit in _stated(text):
            columns = [i for i, name in enumerate(names) if _is_meant(word, name, found[i])]
            for column in columns:
                own = found[column].unit
                place = place_of(line, 0).split(",")[0]
                needs = f"{own}, as line {table.heading_line}, column {column + 1}"
                require(own in ("", unit), place, text[:60], needs)
                found[column] = Heading(found[column].name, unit)
            if not columns:
                _require_no_other(line, text, unit, found, names, dimensions)
    return found


def _stated(text: str) -> list[tuple[str, str]]:
    """Words of a comment and the units behind them, "" for a unit behind none."""
    tokens, found = _TOKENS.findall(text), []
    for i, token in enumerate(tokens):
        if not is_unit(token) and token not in _OTHERS:
            continue
        before = [t for t in tokens[:i] if t.lower() not in _FILLERS]
        word = before[-1] if before else ""
        if not re.match(r"[-+]?[\d.]", word):  # an amount: `load 5 mN`
            found.append(("" if is_unit(word) else word.lower(), plain_unit(token)))
    return found


def _is_meant(word: str, name: str, heading: Heading) -> bool:
    meant = _SAME.get(word, word)
    return bool(word) and (meant == name or word in heading.name.split())


def _require_no_other(
    line: int,
    text: str,
    unit: str,
    found: list[Heading],
    names: list[str],
    dimensions: dict[str, str],
) -> None:
    """Raise where a unit may be that of a column without one."""
    open_ = [
        name
        for name, heading in zip(names, found, strict=True)
        if not heading.unit and size_of(unit, dimensions.get(name, "")) not in (None, 1.0)
    ]
    require(unit in _WORDS or not open_, f"line {line}", text[:60], _NEEDS)
