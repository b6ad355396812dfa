"""The kinds of parts that files can hold, and their numbers by name.

Of a part that is no such kind, one made of functions say, files hold nothing.
"""

from typing import Any

import equinox as eqx
import numpy as np

from .. import bristles, effects, loads, profiles, supports
from .._checks import Part, asked_names


def _by_name(*kinds: type[Part]) -> dict[str, type[Part]]:
    return {kind.__name__: kind for kind in kinds}


PARTS: dict[str, dict[str, type[Part]]] = {
    "profile": _by_name(
        profiles.Sine, profiles.Fourier, profiles.Spline, profiles.Polyline
    ),
    "bristle": _by_name(
        bristles.Homothetic,
        bristles.VerticalSpring,
        bristles.SlantedSpring,
        bristles.AngularSpring,
        bristles.Linear,
    ),
    "support": _by_name(supports.Spring),
    "load": _by_name(
        loads.Ramp, loads.Sine, loads.Triangle, loads.PiecewiseLinear, loads.Pulled
    ),
}
"""Of every table of a scene its kinds, by the name that files call them."""
EFFECTS = _by_name(
    effects.LeadingOrder,
    effects.RigidArray,
    effects.CompliantArray,
    effects.AxialLoad,
    effects.Noise,
    effects.NapFlip,
    effects.Inertia,
)
"""Kinds of the tables [[effects]], of which a scene has any number."""
# What documents of results hold.
_WITHOUT_SCENE = PARTS["profile"] | PARTS["bristle"] | EFFECTS


def numbers_of_part(part: Any) -> dict[str, Any]:
    """Constructor arguments of a part by name, those that it has."""
    given = {name: getattr(part, name) for name in asked_names(type(part), {})}
    return {name: value for name, value in given.items() if value is not None}


def part_entry(part: Any) -> dict[str, Any]:
    """Kind and numbers of a profile, a bristle or an effect.

    The kind alone of one made of functions. Of a batch of bristles each number is a list.
    """
    kind = type(part).__name__
    if _WITHOUT_SCENE.get(kind) is not type(part):
        return {"kind": kind}
    if isinstance(part, profiles.Spline):  # as evaluated: rounded otherwise than .heights
        places = np.arange(np.size(part.coefficients)) / np.size(part.coefficients)
        return {"kind": kind, "heights": [float(part(y)) for y in places]}
    known = numbers_of_part(part).items()
    return {"kind": kind} | {name: np.asarray(value).tolist() for name, value in known}


def part_of(entry: dict[str, Any]) -> Any:
    """The part again; None for one made of functions."""
    numbers = {name: value for name, value in entry.items() if name != "kind"}
    if not numbers and entry["kind"] not in EFFECTS:
        return None
    kind = _WITHOUT_SCENE[entry["kind"]]
    one = all(np.ndim(value) == 0 for value in numbers.values())
    if not issubclass(kind, bristles.AbstractBristle) or one:
        return kind(**numbers)
    first = kind(**{name: rows[0] for name, rows in numbers.items()})
    # The constructor takes one bristle.
    leaves = [np.array(rows) for rows in numbers.values()]
    return eqx.tree_at(lambda b: [getattr(b, k) for k in numbers], first, leaves)
