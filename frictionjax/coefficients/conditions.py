"""Under which condition coefficients are a scene's friction: what they leave out."""

from typing import Any, NamedTuple

from .._checks import ByIdentity, is_concrete

_CONDITIONS = ByIdentity()  # of coefficients


class Condition(NamedTuple):
    """What coefficients leave out, to be said after a number; who tells the rest."""

    words: str
    elsewhere: str = ""


def note_condition(found: Any, condition: Condition) -> None:
    """Keep the condition of coefficients, beside them; nothing where traced."""
    if is_concrete(found):
        _CONDITIONS.put(found, condition)


def condition_of(found: Any) -> Condition | None:
    """Of coefficients; None where they have none, or nothing is known of them."""
    return _CONDITIONS.get(found)
