"""Fits of profiles as JSON, and back."""

import json
from functools import partial
from typing import Any

import numpy as np

from ...io import document_of, part_entry, part_of
from ...model import Coefficients
from ...profiles import Fourier
from .history import History, Start
from .open_directions import CoefficientIdentifiability
from .status import ProfileStatus

_KIND = "frictionjax.ProfileFit"
_SHAPES = ("cos", "sin", "free")  # of iterates: most of the numbers, left out
_PLAIN = (
    "bending_energy",
    "bending_bound",
    "largest_error",
    "chi2",
    "degrees_of_freedom",
    "misfit",
    "success",
    "message",
    "free",
    "bounds",
)
_PARTS = (
    "profile",
    "bristles",
    "coefficients",
    "targets",
    "residuals",
    "status",
    "starts",
    "identifiability",
)


def profile_to_json(fit: Any) -> str:
    """The JSON text of a fit; numbers keep all digits, those not finite become null."""
    document: dict[str, Any] = {"kind": _KIND, "status": fit.status.name}
    document |= {name: getattr(fit, name) for name in _PLAIN}
    document["profile"] = {"cos": _rows(fit.profile.cos), "sin": _rows(fit.profile.sin)}
    document["bristles"] = [part_entry(bristle) for bristle in fit.bristles]
    document["coefficients"] = [
        {name: float(value) for name, value in vars(found).items() if value is not None}
        for found in fit.coefficients
    ]
    for name in ("targets", "residuals"):
        document[name] = _rows(getattr(fit, name))
    document["starts"] = [
        start._asdict() | {"status": start.status.name} for start in fit.starts
    ]
    if fit.history is not None:
        kept = fit.history._asdict().items()
        document["history"] = {k: _rows(v) for k, v in kept if k not in _SHAPES}
    seen = fit.identifiability._asdict()
    document["identifiability"] = {
        name: value if name == "rank" else _rows(value) for name, value in seen.items()
    }
    return json.dumps(_finite(document), indent=1)


def profile_from_json(source: Any) -> dict[str, Any]:
    """The fields of a fit, of a JSON text or file; see `ProfileFit.from_json`."""
    return _fields(document_of(source, _KIND, {*_PLAIN, *_PARTS}))


def _fields(document: dict[str, Any]) -> dict[str, Any]:
    profile: dict[str, Any] = {k: np.array(v) for k, v in document["profile"].items()}
    history = document.get("history")
    seen: dict[str, Any] = document["identifiability"]
    seen = {k: v if k == "rank" else _array(v) for k, v in seen.items()}
    return {name: _number(document[name]) for name in _PLAIN} | {
        "profile": Fourier(**profile),
        "bristles": tuple(part_of(entry) for entry in document["bristles"]),
        "coefficients": tuple(Coefficients(**found) for found in document["coefficients"]),
        "targets": _array(document["targets"]),
        "residuals": _array(document["residuals"]),
        "status": ProfileStatus[document["status"]],
        "starts": tuple(_start(entry) for entry in document["starts"]),
        "history": None if history is None else _history(history),
        "identify": partial(CoefficientIdentifiability, **seen),
    }


def _start(entry: dict[str, Any]) -> Start:
    numbers = {name: _number(value) for name, value in entry.items()}
    status = ProfileStatus[entry["status"]]
    return Start(**numbers | {"status": status, "free": tuple(entry["free"])})


def _history(entry: dict[str, Any]) -> History:
    columns = {name: _array(rows) for name, rows in entry.items()}
    empty = np.zeros((*columns["loss"].shape, 0))
    return History(**columns, **dict.fromkeys(_SHAPES, empty))


def _rows(values: Any) -> Any:
    return np.asarray(values, dtype=float).tolist()


def _array(rows: Any) -> np.ndarray:
    return np.array(rows, dtype=float)  # null becomes NaN


def _number(value: Any) -> Any:
    return float("nan") if value is None else value


def _finite(value: Any) -> Any:
    """JSON has no NaN."""
    if isinstance(value, dict):
        return {name: _finite(entry) for name, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(entry) for entry in value]
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value
