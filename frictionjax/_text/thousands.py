"""Numbers whose thousands a mark parts: `20,292`, which may be a decimal one as well."""

import re

_GROUPED = re.compile(r"[-+]?[1-9]\d{0,2}(?:(,\d{3})+(\.\d*)?|(\.\d{3})+(,\d*)?)")
BOTH_WAYS = (
    'decimal="," where commas mark decimals, decimal="." where they part thousands '
    "{option}: three digits stand behind each"
)


def is_grouped(cell: str) -> bool:
    """Whether three digits follow each comma, or each point, and no leading zero."""
    return _GROUPED.fullmatch(cell) is not None


def ungrouped(cell: str, mark: str) -> str:
    """A number without the marks that part its thousands, where those do."""
    parts = cell.split(mark)
    parted = is_grouped(cell) and all(re.match(r"\d{3}", part) for part in parts[1:])
    return "".join(parts) if parted else cell
