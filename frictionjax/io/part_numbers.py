"""The numbers of a scene, each with its unit and what it is."""

from typing import Any

import numpy as np

from .._checks import Part
from .._text import ResultTable
from ..model import Scene
from .registry import numbers_of_part

_PERIODS = "periods"
_STIFFNESS = "N m^2", "bending stiffness of the rod"
_HEIGHT = "m", "height of the root over the mean surface"
_REST = "m", "length without force"
_SLOPE_ERROR = "1", "error of the extreme slopes, by what samples leave open"
_SLOPE_TAKEN = "1", "of it, what a smoothing filter takes off"
_OFFSETS = _PERIODS, "where the tips stand"
MEANINGS: dict[str, dict[str, tuple[str, str]]] = {
    "Sine": {
        "slope": ("1", "steepest slope of the surface"),
        "amplitude": ("N", "largest load"),
        "period": ("s", "time after which the load repeats itself"),
    },
    "Fourier": {
        "cos": (_PERIODS, "heights of the cosine waves"),
        "sin": (_PERIODS, "heights of the sine waves"),
        "slope_error": _SLOPE_ERROR,
        "slope_taken": _SLOPE_TAKEN,
    },
    "Spline": {
        "heights": (_PERIODS, "heights at even distances"),
        "slope_error": _SLOPE_ERROR,
        "slope_taken": _SLOPE_TAKEN,
    },
    "Polyline": {
        "x": (_PERIODS, "positions of the corners"),
        "heights": (_PERIODS, "heights of the corners"),
        "radius": (_PERIODS, "of the rounded corners"),
    },
    "Homothetic": {"alpha": ("N", "normal force without friction")},
    "VerticalSpring": {
        "stiffness": ("N/m", "of the spring"),
        "rest_length": _REST,
        "height": _HEIGHT,
    },
    "SlantedSpring": {
        "stiffness": ("N/m", "of the spring"),
        "rest_length": _REST,
        "height": _HEIGHT,
        "angle": ("rad", "from the vertical, positive where the tip is left of the root"),
    },
    "AngularSpring": {
        "stiffness": ("N m/rad", "of the angular spring at the root"),
        "length": ("m", "of the rod"),
        "height": _HEIGHT,
        "rest_angle": ("rad", "from the vertical, where the spring is without force"),
    },
    "Linear": {
        "a": ("1", "lean of the bristle, A'(0)"),
        "alpha": ("N", "normal force without friction"),
    },
    "Spring": {"stiffness": ("N/m", "k_h of the spring that the bristle is held by")},
    "Ramp": {
        "rate": ("N/s", "how fast the load rises"),
        "start": ("N", "load at the start"),
    },
    "Triangle": {
        "amplitude": ("N", "largest load"),
        "period": ("s", "time after which the load repeats itself"),
    },
    "PiecewiseLinear": {
        "times": ("s", "of the corners of the load"),
        "values": ("N", "loads there"),
    },
    "Pulled": {
        "rest_length": _REST,
        "position": ("m", "where the far end of the spring is, a load read in m"),
    },
    "LeadingOrder": {},
    "RigidArray": {
        "offsets": _OFFSETS,
        "weights": ("1", "how many bristles stand at each"),
    },
    "CompliantArray": {"offsets": _OFFSETS},
    "AxialLoad": {"bending_stiffness": _STIFFNESS},
    "Noise": {
        "temperature": ("J/m^exponent", "thermal energy over eps^exponent"),
        "exponent": ("1", "power of eps in the thermal energy"),
    },
    "NapFlip": {"bending_stiffness": _STIFFNESS},
    "Inertia": {
        "mass": ("kg/m^exponent", "mass over eps^exponent"),
        "exponent": ("1", "power of eps in the mass"),
    },
}
"""Of every kind of part that files hold its numbers: unit, and what they are."""
_FEW = 6  # numbers of a list that are written out


def unit_of(part: Part, name: str) -> str:
    """Of a part's number; "" where nothing is known of it."""
    return MEANINGS.get(type(part).__name__, {}).get(name, ("", ""))[0]


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
    header = ("part", "kind", "number", "value", "unit", "meaning")
    return ResultTable(header, tuple(rows), left=3, meanings=2)


def _rows_of(table: str, part: Any, metres: bool = False) -> list[tuple[str, ...]]:
    """`metres`: of a load that is read as a position."""
    kind = type(part).__name__
    meanings = MEANINGS.get(kind, {})
    found = []
    numbers = numbers_of_part(part) if isinstance(part, Part) else {}
    for name, value in numbers.items():
        if isinstance(value, Part):
            found += _rows_of(f"{table}, {name}", value, metres=True)
            continue
        unit, meaning = meanings.get(name, ("", ""))
        unit = unit.replace("N", "m") if metres else unit
        found.append((table, kind, name, _value(value), unit, meaning))
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
    return f"{numbers.size} values, {numbers.min():.3g} to {numbers.max():.3g}"
