"""Enums whose members say for people what their integer means."""

import enum
from typing import Any, Self

import numpy as np

from .arguments import is_known


class Outcome(enum.IntEnum):
    """Base of enums with members `NAME = integer, message`."""

    message: str

    def __new__(cls, code: int, message: str):
        member = int.__new__(cls, code)
        member._value_ = code
        member.message = message
        return member

    @classmethod
    def of(cls, code: int) -> Self:
        """The member with this integer."""
        return {int(member): member for member in cls}[int(code)]

    @classmethod
    def flags(cls) -> dict[str, Any]:
        """CF conventions for a data set that holds the integers."""
        return {
            "flag_values": np.array([int(member) for member in cls], dtype=np.int8),
            "flag_meanings": " ".join(member.name.lower() for member in cls),
        }


def outcomes(kind: type[Outcome], codes: Any) -> Any:
    """The member with this integer, or an array of members; integers where traced."""
    if not is_known(codes):
        return codes
    return np.vectorize(kind.of, otypes=[object])(np.asarray(codes, dtype=int))[()]


def flags(good: Any) -> Any:
    """One bool, or a NumPy array of them; what is traced stays as it is."""
    if not is_known(good):
        return good
    return bool(good) if np.ndim(good) == 0 else np.asarray(good)


def counted(kind: type[Outcome], codes: Any) -> str:
    """How computations ended, in words: `OK`, or `3 of 4 OK, 1 MAX_STEPS`."""
    known = np.asarray(codes, dtype=int)
    if known.ndim == 0:
        return kind.of(int(known)).name
    found = {kind.of(c).name: int(np.sum(known == c)) for c in np.unique(known)}
    good = found.pop(kind.of(0).name, 0)
    others = "".join(f", {count} {name}" for name, count in found.items())
    return f"{good} of {known.size} {kind.of(0).name}{others}"
