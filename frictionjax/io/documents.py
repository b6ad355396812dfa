"""Documents: JSON from a text or a file, checked, and what of a value it can hold."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from .._checks import require, write_whole


def read_document(source: Any) -> Any:
    """What a JSON text holds, or the file at a path.

    Raises `ValueError` for what is not there, or no JSON.
    """
    text = str(source)
    if not text.lstrip().startswith("{"):
        try:
            text = Path(source).read_text(encoding="utf-8-sig")
        except (OSError, UnicodeDecodeError):
            require(False, "source", str(source), "the text or the file of a fit's JSON")
    try:
        return json.loads(text)
    except json.JSONDecodeError as problem:
        raise ValueError(f"source: not JSON ({problem})") from None


def checked_document(document: Any, kind: str, needed: set[str]) -> dict[str, Any]:
    """The document; raises `ValueError` for another kind, or where it lacks an entry."""
    known = isinstance(document, dict) and document.get("kind") == kind
    require(known, "source", "another document", f"JSON with kind = {kind!r}")
    missing = sorted(needed - set(document))
    require(not missing, "source", f"without {', '.join(missing)}", "a whole fit")
    return document


def written(text: str, path: Any) -> str:
    """The text, which is written to `path` where one is given."""
    if path is not None:
        write_whole(path, text)
    return text


def plain(value: Any, infinite: bool = True) -> Any:
    """Lists in place of arrays; JSON has neither NaN, null here, nor infinity, a text.

    Null too where not `infinite`.
    """
    if isinstance(value, dict):
        return {name: plain(entry, infinite) for name, entry in value.items()}
    if hasattr(value, "shape"):
        return plain(np.asarray(value).tolist(), infinite)
    if isinstance(value, list | tuple):
        return [plain(entry, infinite) for entry in value]
    if isinstance(value, float) and not np.isfinite(value):
        unknown = np.isnan(value) or not infinite
        return None if unknown else ("inf" if value > 0 else "-inf")
    return value


def array_of(rows: Any) -> np.ndarray:
    """The array that `plain` made lists of."""
    return np.array(rows, dtype=float)  # null becomes NaN
