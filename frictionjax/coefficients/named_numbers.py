"""Friction coefficients as tables: names, units, meanings, errors."""

import math
from typing import Any

from .._checks import as_text
from .._text import ResultTable
from ..bristles import pulling_text
from .conditions import condition_of

COEFFICIENTS = (
    ("rho_plus", "N", "friction against motion to the right"),
    ("rho_minus", "N", "friction against motion to the left"),
    ("ratio", "", "-rho_plus/rho_minus"),
    ("alpha", "N", "normal force without friction"),
    ("normal_plus", "N", "normal force of a slide to the right"),
    ("normal_minus", "N", "normal force of a slide to the left"),
    ("a", "", "lean of the bristle, A'(0)"),
    ("mu_plus", "", "largest slope that the bristle sees, friction/alpha"),
    ("mu_minus", "", "smallest slope that the bristle sees, friction/alpha"),
    ("omega_plus", "", "largest slope of the surface, friction/normal force"),
    ("omega_minus", "", "smallest slope of the surface, friction/normal force"),
)
OF_THE_BRISTLE = ("alpha", "a")  # the bristle's own, the same on every surface
# alpha < 0: rho_plus, of a slide to the right, is made by the smallest slope.
_SLOPES = {"omega_plus": "left", "omega_minus": "right"}


def coefficients_by_name(found: Any) -> dict[str, float]:
    """Numbers of a friction law by name, `ratio` = -rho_plus/rho_minus added.

    Only those that exist: the abstract setting has no bristle's.
    """
    left = float(found.rho_minus)
    numbers = {"ratio": -float(found.rho_plus) / left} if left else {}
    for name, _, _ in COEFFICIENTS:
        value = None if name == "ratio" else getattr(found, name, None)
        if value is not None:
            numbers[name] = float(value)
    return {name: numbers[name] for name, _, _ in COEFFICIENTS if name in numbers}


def errors_by_name(
    found: Any, standard: dict[str, float] | None = None
) -> dict[str, float]:
    """Errors by name, of what samples leave of the surface; empty where nothing is known.

    `standard`: errors over the rows of a map. They see scatter and no corners, the others
    both: the larger one of each is the error.
    """
    known = dict(standard or {})
    if found.omega_plus_error is None:
        return known
    for side in ("plus", "minus"):
        omega, mu = (float(getattr(found, f"{name}_{side}")) for name in ("omega", "mu"))
        of_omega = float(getattr(found, f"omega_{side}_error"))
        known |= _larger(known, f"omega_{side}", of_omega)
        known |= _larger(known, f"mu_{side}", of_omega * (mu / omega) ** 2)
        of_rho = float(getattr(found, f"rho_{side}_error"))
        known |= _larger(known, f"rho_{side}", of_rho)
        known |= _larger(known, f"normal_{side}", abs(float(found.a)) * of_rho)
    parts = (
        float(getattr(found, f"rho_{side}_error")) / float(getattr(found, f"rho_{side}"))
        for side in ("plus", "minus")
    )
    ratio = abs(coefficients_by_name(found)["ratio"])
    return known | _larger(known, "ratio", ratio * math.hypot(*parts))


def _larger(known: dict[str, float], name: str, error: float) -> dict[str, float]:
    return {name: max(known.get(name, 0.0), error)}


def coefficient_table(found: Any, error: dict[str, float] | None = None) -> ResultTable:
    """Friction coefficients with their units and meanings, and errors if known.

    `error`: standard errors over the rows of a map, beside those of `errors_by_name`.
    """
    numbers, error = coefficients_by_name(found), errors_by_name(found, error)
    pulls = numbers.get("alpha", 0.0) < 0
    rows = [
        (
            name,
            as_text(numbers[name]),
            *_plus_minus(name, error),
            unit,
            meaning_of(name, meaning, pulls),
        )
        for name, unit, meaning in COEFFICIENTS
        if name in numbers
    ]
    added = ("+-",) if error else ()
    header = "coefficient", "value", *added, "unit", "meaning"
    note = pulling_text(numbers.get("alpha", 0.0))
    said = _taken_text(found), note, _condition_text(found)
    notes = "\n".join(f"({note})" for note in said if note)
    return ResultTable(header, tuple(rows), note=notes, meanings=2)


def _taken_text(found: Any) -> str:
    """What of the errors of slopes a filter is the cause of; nothing without one."""
    plus, minus = found.omega_plus_taken, found.omega_minus_taken
    if plus is None or minus is None:
        return ""
    plus, minus = float(plus), float(minus)
    return f"+-: of omega_plus {plus:.2g}, of omega_minus {minus:.2g} by smoothing"


def _condition_text(found: Any) -> str:
    """Whose coefficients they are, where not the scene's as it moves."""
    condition = condition_of(found)
    if condition is None:
        return ""
    beside = f": {condition.elsewhere}" if condition.elsewhere else ""
    return f"friction {condition.words}{beside}"


def meaning_of(name: str, meaning: str, pulls: bool) -> str:
    """What a number means; where a bristle pulls, the normal forces change sides."""
    if not (pulls and name in _SLOPES):
        return meaning
    return f"{meaning} of a slide to the {_SLOPES[name]}"


def _plus_minus(name: str, error: dict[str, float] | None) -> tuple[str, ...]:
    if not error:
        return ()
    known = name in error and name not in OF_THE_BRISTLE
    return (f"{error[name]:.2g}" if known else "",)
