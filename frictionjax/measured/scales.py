"""Metres per unit of a file: what the user says, what the file says, or asked for."""

import math
from typing import NamedTuple

import numpy as np

from .._checks import require
from .entries import Stated
from .settings import SETTINGS
from .units import ALLOWED, metres, require_unit


class GivenUnits(NamedTuple):
    """What a user says of a file; None where he does not. `length`, `height`: m a unit."""

    pixel: float | None
    height_scale: float | None
    length: float | None
    height: float | None
    decimal: str | None
    outliers: str | None = None

    @property
    def pixel_in_metres(self) -> float | None:
        return None if self.pixel is None else self.pixel * (self.length or 1.0)

    @property
    def heights(self) -> float | None:
        """m per unit of the heights."""
        return self.height if self.height_scale is None else self.height_scale


def asked_of(
    pixel: float | None,
    height_scale: float | None,
    length_unit: str | None,
    height_unit: str | None,
    decimal: str | None,
    outliers: str | None = None,
) -> GivenUnits:
    """Options of `read_heights`, checked."""
    known = outliers in (None, "missing", "keep")
    require(known, "outliers", outliers, '"missing" or "keep"')
    for name, given in (("pixel", pixel), ("height_scale", height_scale)):
        good = given is None or (math.isfinite(given) and given > 0)
        require(good, name, given, f"{name} > 0")
    both = height_scale is not None and height_unit is not None
    require(not both, "height_unit", height_unit, "none beside height_scale")
    length = require_unit("length_unit", length_unit)
    height = require_unit("height_unit", height_unit)
    return GivenUnits(pixel, height_scale, length, height, decimal, outliers)


class Scale(NamedTuple):
    """`value`: m per unit; `said`: who says so, where."""

    value: float
    said: str


def scale_of(
    asked: float | None, stated: list[Stated], option: str
) -> tuple[Scale | None, list[str]]:
    """The scale that holds, None without one, and notes where two speak.

    The user goes before the file. Raises `ValueError` for a unit that is no length, or two.
    """
    values = [metres(s.text) for s in stated]
    if asked is not None:
        odd = [s for s, v in zip(stated, values, strict=True) if v != asked]
        notes = [f"{s.place} says {s.text}: {option} goes before it" for s in odd[:1]]
        return Scale(asked, option), notes
    for one, value in zip(stated, values, strict=True):
        needs = f"{ALLOWED}, or {option}"
        require(value is not None, one.place, one.text, needs)
        same = value == values[0]
        require(same, one.place, one.text, f"{stated[0].text} as {stated[0].place}")
    if not stated:
        return None, []
    assert values[0] is not None
    return Scale(values[0], f"{stated[0].text}, {stated[0].place}"), []


def completed(
    length: Scale | None, height: Scale | None, place: str
) -> tuple[float, float, list[str]]:
    """m per unit of lengths and heights, where m may stand for what nobody says.

    Raises `ValueError` where the other one is no m.
    """
    for one, other, option in (
        (length, height, "length_unit"),
        (height, length, "height_unit or height_scale"),
    ):
        guess = one is not None or other is None or other.value == 1.0
        require(guess, place, "no unit", f"{option}, beside {other and other.said}")
    missing = [n for n, s in (("lengths", length), ("heights", height)) if s is None]
    notes = []
    if missing:
        what = " and ".join(missing)
        notes = [f"{place}: no unit of {what}, read as m (see length_unit, height_unit)"]
    return length.value if length else 1.0, height.value if height else 1.0, notes


def require_metres(x: np.ndarray, heights: np.ndarray, place: str) -> None:
    """Raise where numbers without a unit cannot be metres."""
    needs = "length_unit and height_unit (or height_scale): the file states none"
    span = float(np.ptp(x))
    require(span <= SETTINGS.longest_trace, place, f"a trace of {span:.4g} m", needs)
    slopes = np.abs(np.diff(heights, axis=1) / np.diff(x))
    known = slopes[np.isfinite(slopes)]
    slope = float(known.mean()) if known.size else 0.0
    require(slope <= SETTINGS.steepest, place, f"a mean slope of {slope:.4g}", needs)
