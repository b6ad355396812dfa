"""The viscosity of cells, and those that floats do not hold."""

from collections.abc import Callable
from functools import wraps
from typing import Any

import numpy as np

_LARGE = 1e100  # products of three of them are floats still


def viscosity_of(eps: Any, gamma: Any) -> np.ndarray:
    """`eps^gamma` in N s/m, in NumPy; inf, without a warning, beyond what floats hold."""
    with np.errstate(over="ignore"):
        return np.power(eps, gamma)


def quiet_where_extreme(fn: Callable) -> Callable:
    """`fn(scene, eps, gamma, ...)` of cells, without NumPy's warnings where one is extreme.

    What overflows goes on as inf or NaN beside the others, and has its own status.
    """

    @wraps(fn)
    def call(scene: Any, eps: Any, gamma: Any, *args: Any, **named: Any) -> Any:
        viscosity = viscosity_of(eps, gamma)
        if np.all((viscosity > 1 / _LARGE) & (viscosity < _LARGE)):
            return fn(scene, eps, gamma, *args, **named)
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            return fn(scene, eps, gamma, *args, **named)

    return call
