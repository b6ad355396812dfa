"""Fits to traces as JSON, and back."""

import json
from typing import Any

import numpy as np

from ...io import document_of, plain
from ...profiles import Fourier
from ..measured_trace import Trace
from .status import TraceStatus
from .weights import TraceIdentifiability

_KIND = "frictionjax.TraceFit"
_PLAIN = ("eps", "gamma", "disputed", "chi2", "degrees_of_freedom")
_ROWS = ("achieved", "residuals", "deviation", "tips")
_FLAGS = ("used", "slipping", "determined", "visited")  # bool
_PARTS = ("profile", "trace", "status", "used", "slipping", "history", "identifiability")


def trace_to_json(fit: Any) -> str:
    """The JSON text of a fit; numbers keep all digits, those not finite become null."""
    trace = fit.trace
    document: dict[str, Any] = {"kind": _KIND, "status": fit.status.name, "odd": fit.odd}
    document |= {name: getattr(fit, name) for name in _PLAIN}
    document |= {name: getattr(fit, name) for name in (*_ROWS, "used", "slipping")}
    document["profile"] = {"cos": fit.profile.cos, "sin": fit.profile.sin}
    document["trace"] = {"ts": trace.ts, trace.quantity: trace.values}
    if trace.uncertainty is not None:
        document["trace"]["uncertainty"] = trace.uncertainty
    document["history"] = fit.history._asdict()
    document["identifiability"] = fit.identifiability._asdict()
    return json.dumps(plain(document), indent=1)


def trace_from_json(source: Any) -> dict[str, Any]:
    """The fields of a fit, of a JSON text or file; see `TraceFit.from_json`."""
    document = document_of(source, _KIND, {*_PLAIN, *_ROWS, *_PARTS})
    entries = document["identifiability"].items()
    seen: dict[str, Any] = {k: v if k == "rank" else _array(k, v) for k, v in entries}
    profile: dict[str, Any] = {k: np.array(v) for k, v in document["profile"].items()}
    found = {name: _number(document[name]) for name in _PLAIN}
    found |= {name: _array(name, document[name]) for name in (*_ROWS, "used", "slipping")}
    return found | {
        "profile": Fourier(**profile),
        "trace": Trace(**document["trace"]),
        "status": TraceStatus[document["status"]],
        "history": {k: _array(k, v, counts=True) for k, v in document["history"].items()},
        "identifiability": TraceIdentifiability(**seen),
        "odd": document.get("odd", ""),  # not in documents of earlier versions
    }


def _array(name: str, rows: Any, counts: bool = False) -> np.ndarray:
    if name in _FLAGS and not counts:
        return np.array(rows, dtype=bool)
    whole = counts and name in ("used", "slipping", "disputed")
    return np.array(rows, dtype=int if whole else float)  # null becomes NaN


def _number(value: Any) -> Any:
    return float("nan" if value is None else value) if not isinstance(value, int) else value
