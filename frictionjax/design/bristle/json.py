"""Designs of bristles as JSON, and back."""

import json
from typing import Any

import jax.numpy as jnp
import numpy as np

from ...io import array_of, document_of, part_entry, part_of, plain
from ..common import Slopes
from .inverse import Pulled

_KIND = "frictionjax.AngleFit"
_ARRAYS = ("value", "achieved", "target", "roots", "admissible", "reachable")
_NAMES = ("free", "quantity")
_PARTS = ("kind", "bristle", "profile", "code", "slopes")


def angle_entry(fit: Any) -> dict[str, Any]:
    """An `AngleFit` as a document; one made of functions loses them."""
    document: dict[str, Any] = {"kind": _KIND, "message": fit.message}
    document |= {name: getattr(fit, name) for name in (*_ARRAYS, *_NAMES, "code")}
    document |= {"alpha": fit.alpha, "pulling": fit.pulling}
    document["pulled"] = fit.pulled._asdict()
    document |= {"bristle": part_entry(fit.bristle), "profile": part_entry(fit.profile)}
    return plain(document | {"slopes": fit.slopes._asdict()})


def angle_fields(document: dict[str, Any]) -> dict[str, Any]:
    """The fields of an `AngleFit`, of such a document."""
    found = {name: jnp.asarray(array_of(document[name])) for name in _ARRAYS}
    # Documents of earlier versions lack these.
    unknown = np.full(np.shape(document["target"]), np.nan).tolist()
    alpha = document.get("alpha", unknown)
    pulled = document.get("pulled", {"value": unknown, "alpha": unknown})
    slopes = {k: jnp.asarray(array_of(v)) for k, v in document["slopes"].items()}
    return found | {
        "bristle": part_of(document["bristle"]),
        "profile": part_of(document["profile"]),
        "code": jnp.asarray(document["code"]),
        "alpha": jnp.asarray(array_of(alpha)),
        "pulled": Pulled(**{k: jnp.asarray(array_of(v)) for k, v in pulled.items()}),
        "slopes": Slopes(**slopes),
        "free": document["free"],
        "quantity": document["quantity"],
        "pulling": document.get("pulling", True),
    }


def angle_to_json(fit: Any) -> str:
    """The JSON text of an `AngleFit`."""
    return json.dumps(angle_entry(fit), indent=1)


def angle_from_json(source: Any) -> dict[str, Any]:
    """The fields of an `AngleFit`, of a JSON text or file."""
    return angle_fields(document_of(source, _KIND, {*_ARRAYS, *_NAMES, *_PARTS}))
