"""Bristles and surfaces as entries of JSON documents, and back."""

import dataclasses
from typing import Any

import equinox as eqx
import numpy as np

from .. import bristles, profiles

_BRISTLES = ("Homothetic", "VerticalSpring", "SlantedSpring", "AngularSpring")
_PROFILES = ("Sine", "Fourier", "Spline", "Polyline")
_PARTS: dict[str, Any] = {name: getattr(bristles, name) for name in _BRISTLES}
_PARTS |= {name: getattr(profiles, name) for name in _PROFILES}


def part_entry(part: Any) -> dict[str, Any]:
    """Kind and numbers of a part; the kind alone of one made of functions.

    Of a batch of bristles each number is a list.
    """
    kind = type(part).__name__
    if _PARTS.get(kind) is not type(part):
        return {"kind": kind}
    if kind == "Spline":
        count = np.size(part.coefficients)
        return {"kind": kind, "heights": [float(part(k / count)) for k in range(count)]}
    names = [f.name for f in dataclasses.fields(part) if not f.metadata.get("static")]
    given = {name: getattr(part, name) for name in names}
    known = {name: value for name, value in given.items() if value is not None}
    return {"kind": kind} | {k: np.asarray(value).tolist() for k, value in known.items()}


def part_of(entry: dict[str, Any]) -> Any:
    """The part again; None for one made of functions."""
    numbers = {name: value for name, value in entry.items() if name != "kind"}
    if not numbers:
        return None
    kind = entry["kind"]
    if kind in _PROFILES or np.ndim(next(iter(numbers.values()))) == 0:
        return _PARTS[kind](**numbers)
    first = _PARTS[kind](**{name: rows[0] for name, rows in numbers.items()})
    # The constructor takes one bristle.
    leaves = [np.array(rows) for rows in numbers.values()]
    return eqx.tree_at(lambda b: [getattr(b, k) for k in numbers], first, leaves)
