"""Rows or columns of a map that are positions, as tables of offices have them."""

import numpy as np

from .settings import SETTINGS


def axis_of(block: np.ndarray) -> int | None:
    """0 where the first row is one of positions, 1 where the first column is, or None."""
    for axis, rows in ((0, block), (1, block.T)):
        if len(rows) > 1 and (_unlike(rows) or _unlike(rows[:, 1:])):
            return axis
    return None


def _unlike(rows: np.ndarray) -> bool:
    """Whether the first row rises or falls evenly, and the next one not as it does."""
    first, second, count = rows[0], rows[1], rows.shape[1]
    if count < 3:
        return False
    if count >= SETTINGS.many:
        return _step(first, SETTINGS.even) != 0 and not _alike(first, second)
    if not _step(first, SETTINGS.exact) or _alike(first, second):
        return False
    # So few heights may rise evenly by chance, but then as their neighbours nearly do.
    apart = np.std(np.diff(rows, axis=0), axis=1)
    others = apart[1:][np.isfinite(apart[1:])]
    return bool(others.size and apart[0] > SETTINGS.unlike * others.max())


def _step(values: np.ndarray, tolerance: float) -> float:
    """The step of values that rise or fall evenly, or 0."""
    steps = np.diff(values)
    step = float(steps.mean()) if np.isfinite(steps).all() else 0.0
    line = values[0] + step * np.arange(values.size)
    allowed = max(tolerance * abs(step), _rounding(values, abs(step)))
    even = step != 0 and np.max(np.abs(values - line)) <= allowed
    return step if even else 0.0


def _rounding(values: np.ndarray, step: float) -> float:
    """How far values lie off a line for the digits that they are written with."""
    if values.size < SETTINGS.many:
        return 0.0
    for digits in range(10):
        last = 10.0**-digits
        if np.max(np.abs(values - np.round(values, digits))) < 1e-6 * last:
            return last if last < 0.5 * step else 0.0  # both ends are rounded too
    return 0.0


def _alike(first: np.ndarray, second: np.ndarray) -> bool:
    """Whether both climb as one tilted surface does, the second one less evenly."""
    step, other = _step(first, SETTINGS.even), _step(second, 1.0)
    most = SETTINGS.as_steep
    return 1 / most < other / step < most if step else False
