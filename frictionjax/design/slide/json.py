"""Designs of steady slides as JSON, and back."""

import json
from typing import Any

import jax.numpy as jnp

from ...io import array_of, document_of, part_entry, part_of, plain
from ..bristle import AngleFit, FitStatus, angle_entry, angle_fields
from ..surface import ProfileFit, ProfileStatus, profile_to_json
from .slide_friction import SteadySlide

_KIND, _PROFILE_KIND = "frictionjax.SlideFit", "frictionjax.SlideProfileFit"
_ARRAYS = (
    "value",
    "achieved",
    "target",
    "solutions",
    "reachable",
    "failed",
    "by_target",
)
_PARTS = ("bristle", "slide", "limit", "status", "force")
_PROFILE_ARRAYS = ("targets", "achieved", "history")
_PROFILE_PARTS = ("slides", "limit", "fit", "force", "status", "steps")


def _slide_entry(slide: SteadySlide) -> dict[str, Any]:
    return plain(dict(vars(slide)))


def _slide_of(entry: dict[str, Any]) -> SteadySlide:
    numbers = {name: jnp.asarray(array_of(value)) for name, value in entry.items()}
    codes = {k: v.astype(int) for k, v in numbers.items() if k.startswith("code")}
    return SteadySlide(**numbers | codes)


def slide_to_json(fit: Any) -> str:
    """The JSON text of a `SlideFit`."""
    document: dict[str, Any] = {"kind": _KIND, "message": fit.message}
    document |= {name: getattr(fit, name) for name in _ARRAYS}
    document |= {"status": fit.status.name, "force": fit.force}
    document |= {"bristle": part_entry(fit.bristle), "slide": _slide_entry(fit.slide)}
    return json.dumps(plain(document | {"limit": angle_entry(fit.limit)}), indent=1)


def slide_from_json(source: Any) -> dict[str, Any]:
    """The fields of a `SlideFit`, of a JSON text or file."""
    document = document_of(source, _KIND, {*_ARRAYS, *_PARTS})
    found = {name: jnp.asarray(array_of(document[name])) for name in _ARRAYS}
    return found | {
        "reachable": found["reachable"].reshape(-1, 2),
        "bristle": part_of(document["bristle"]),
        "slide": _slide_of(document["slide"]),
        "limit": AngleFit(**angle_fields(document["limit"])),
        "status": FitStatus[document["status"]],
        "force": document["force"],
    }


def dump_profile(fit: Any) -> str:
    """The JSON text of a `SlideProfileFit`."""
    document = {"kind": _PROFILE_KIND, "message": fit.message, "force": fit.force}
    document |= {name: getattr(fit, name) for name in _PROFILE_ARRAYS}
    document |= {"status": fit.status.name, "steps": fit.steps}
    document["slides"] = [_slide_entry(slide) for slide in fit.slides]
    for name in ("fit", "limit"):
        document[name] = json.loads(profile_to_json(getattr(fit, name)))
    return json.dumps(plain(document), indent=1)


def profile_fields(source: Any) -> dict[str, Any]:
    """The fields of a `SlideProfileFit`, of a JSON text or file."""
    document = document_of(source, _PROFILE_KIND, {*_PROFILE_ARRAYS, *_PROFILE_PARTS})
    found: dict[str, Any] = {k: array_of(document[k]) for k in _PROFILE_ARRAYS}
    for name in ("fit", "limit"):
        found[name] = ProfileFit.from_json(json.dumps(document[name]))
    return found | {
        "slides": tuple(_slide_of(entry) for entry in document["slides"]),
        "force": document["force"],
        "status": ProfileStatus[document["status"]],
        "steps": document["steps"],
    }
