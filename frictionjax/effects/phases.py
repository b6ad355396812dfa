"""Places of bristles on one root, as phases of the surface."""

from typing import Any

import numpy as np

from .._checks import is_known, known_numbers, require


def require_row(name: str, values: Any, what: str) -> None:
    """Check a row of finite numbers, shape (N,), N >= 1; `what`: they are, with unit."""
    if not is_known(values):
        return
    row = known_numbers(values)
    good = row.dtype.kind in "iuf" and row.ndim == 1 and row.size > 0
    require(good, name, values, f"{what}, shape (N,), N >= 1")
    require(np.all(np.isfinite(row)), name, values, f"finite {what}")
