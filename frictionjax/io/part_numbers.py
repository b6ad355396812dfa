"""The numbers of a scene, each with its unit and what it is."""

from typing import Any

import numpy as np

from .._checks import Part
from .._text import ResultTable
from ..model import Scene
from .registry import numbers_of_part

_STIFFNESS = "bending stiffness of the rod"
_HEIGHT = "height of the root over the mean surface"
_REST = "length without force"
_SLOPE_ERROR = "error of the extreme slopes, by what samples leave open"
_SLOPE_TAKEN = "of it, what a smoothing filter takes off"
_OFFSETS = "where the tips stand"
MEANINGS: dict[str, dict[str, str]] = {
    "Sine": {
        "slope": "steepest slope of the surface",
        "amplitude": "largest load",
        "period": "time after which the load repeats itself",
    },
    "Fourier": {
        "cos": "heights of the cosine waves",
        "sin": "heights of the sine waves",
        "slope_error": _SLOPE_ERROR,
        "slope_taken": _SLOPE_TAKEN,
    },
    "Spline": {
        "heights": "heights at even distances",
        "slope_error": _SLOPE_ERROR,
        "slope_taken": _SLOPE_TAKEN,
    },
    "Polyline": {
        "x": "positions of the corners",
        "heights": "heights of the corners",
        "radius": "of the rounded corners",
    },
    "Homothetic": {"alpha": "normal force without friction"},
    "VerticalSpring": {
        "stiffness": "of the spring",
        "rest_length": _REST,
        "height": _HEIGHT,
    },
    "SlantedSpring": {
        "stiffness": "of the spring",
        "rest_length": _REST,
        "height": _HEIGHT,
        "angle": "from the vertical, positive where the tip is left of the root",
    },
    "AngularSpring": {
        "stiffness": "of the angular spring at the root",
        "length": "of the rod",
        "height": _HEIGHT,
        "rest_angle": "from the vertical, where the spring is without force",
    },
    "Linear": {
        "a": "lean of the bristle, A'(0)",
        "alpha": "normal force without friction",
    },
    "Spring": {"stiffness": "k_h of the spring that the bristle is held by"},
    "Ramp": {"rate": "how fast the load rises", "start": "load at the start"},
    "Triangle": {
        "amplitude": "largest load",
        "period": "time after which the load repeats itself",
    },
    "PiecewiseLinear": {"times": "of the corners of the load", "values": "loads there"},
    "Pulled": {
        "rest_length": _REST,
        "position": "where the far end of the spring is, a load read in m",
    },
    "LeadingOrder": {},
    "RigidArray": {"offsets": _OFFSETS, "weights": "how many bristles stand at each"},
    "CompliantArray": {"offsets": _OFFSETS},
    "AxialLoad": {"bending_stiffness": _STIFFNESS},
    "Noise": {
        "temperature": "thermal energy over eps^exponent",
        "exponent": "power of eps in the thermal energy",
    },
    "NapFlip": {"bending_stiffness": _STIFFNESS},
    "Inertia": {
        "mass": "mass over eps^exponent",
        "exponent": "power of eps in the mass",
    },
}
"""Of every kind of part that files hold, what its numbers are."""
_NUMBERS = "number", "value", "unit", "meaning"
_FEW = 6  # numbers of a list that are written out


def unit_of(part: Part | type[Part], name: str) -> str:
    """Of a part's number, as a heading has it; "" where nothing is known of it."""
    asked = part.asked.get(name)
    if asked is None:
        return ""
    return "1" if asked.unit == "no unit" else asked.unit.replace(" per ", "/")


def part_table(part: Part) -> ResultTable:
    """One line for each number of a part: kind, name, value, unit, meaning."""
    rows = (row[1:] for row in _rows_of("", part))
    return ResultTable(("kind", *_NUMBERS), tuple(rows), left=2, meanings=2)


def part_rows(scene: Scene) -> ResultTable:
    """One line for each number of a scene: part, kind, name, value, unit, meaning."""
    rows: list[tuple[str, ...]] = [
        ("scene", "", "duration", _value(scene.duration), "s", "how long the load acts"),
        ("scene", "", "z0", _value(scene.z0), "m", "state at the start"),
    ]
    parts = ("potential",) if scene.profile is None else ("profile", "bristle")
    for table in (*parts, "support", "load"):
        rows += _rows_of(table, getattr(scene, table))
    for effect in scene.effects:
        rows += _rows_of("effect", effect)
    return ResultTable(("part", "kind", *_NUMBERS), tuple(rows), left=3, meanings=2)


def _rows_of(table: str, part: Any, metres: bool = False) -> list[tuple[str, ...]]:
    """`metres`: of a load that is read as a position."""
    kind = type(part).__name__
    meanings = MEANINGS.get(kind, {})
    found = []
    numbers = numbers_of_part(part) if isinstance(part, Part) else {}
    for name, value in numbers.items():
        if isinstance(value, Part):
            found += _rows_of(f"{table}, {name}", value, metres=kind == "Pulled")
            continue
        unit = unit_of(part, name).replace("N", "m" if metres else "N")
        found.append((table, kind, name, _value(value), unit, meanings.get(name, "")))
    return found or [(table, kind, "", "", "", "")]


def _value(value: Any) -> str:
    try:
        numbers = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        return getattr(value, "__name__", type(value).__name__)
    if numbers.ndim == 0:
        return f"{float(numbers):.6g}"
    if numbers.size <= _FEW:
        return ", ".join(f"{v:.6g}" for v in numbers.ravel())
    if not numbers.any():
        return f"{numbers.size} values, all 0"
    return f"{numbers.size} values, {numbers.min():.3g} to {numbers.max():.3g}"
