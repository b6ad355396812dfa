"""Numbers that stand for a missing height: -32768, 1e38, -9999; or that look so."""

import numpy as np

from .._checks import require
from .samples import HeightSamples
from .settings import SETTINGS

_BITS = (32767.0, 32768.0, 65535.0, 2.0**31 - 1, 2.0**31, 2.0**32 - 1)
_NINES = tuple(10.0**n - 1 for n in range(3, 8))
_MARKS = (
    *(*_BITS, *_NINES, 1000001.0),
    *(value / 1e3 for value in _BITS),
    *(value + 0.999 for value in _NINES),
)


def without_sentinels(samples: HeightSamples, outliers: str | None = None) -> HeightSamples:
    """Samples whose sentinels are missing ones, with a note for each.

    Well-known marks are. Other heights that lie alone are what the user says,
    `outliers` "missing" or "keep"; raises `ValueError` where he does not.
    """
    heights, notes = samples.heights.copy(), []

    def drop(held: np.ndarray) -> None:
        row, sample = (int(i) for i in np.argwhere(held)[0])
        place, value = samples.place(row, sample), heights[row, sample]
        many = f"taken as missing, as are {int(held.sum())} in all"
        notes.append(f"{place} = {value:.10g}: {many}")
        heights[held] = np.nan

    for value in _marks(heights, keep=outliers == "keep"):
        drop(heights == value)
    alone = np.zeros(heights.shape, bool) if outliers == "keep" else _alone(heights)
    if alone.any():
        _require_said(samples, heights, alone, outliers)
        drop(alone)
    return samples._replace(heights=heights, notes=[*samples.notes, *notes])


def _require_said(
    samples: HeightSamples, heights: np.ndarray, alone: np.ndarray, outliers: str | None
) -> None:
    row, sample = (int(i) for i in np.argwhere(alone)[0])
    others = heights[np.isfinite(heights) & ~alone]
    needs = (
        f'outliers="missing" or "keep" (--outliers): {int(alone.sum())} in all lie alone, '
        f"all others in [{others.min():.6g}, {others.max():.6g}]"
    )
    said = f"{heights[row, sample]:.10g}"
    require(outliers is not None, samples.place(row, sample), said, needs)


def _marks(heights: np.ndarray, keep: bool) -> list[float]:
    """Values at either end that are well-known marks, or no height at all."""
    found: list[float] = []
    rest = heights[np.isfinite(heights)]
    while rest.size > 2:
        ends = (float(rest.min()), float(rest.max()))
        marks = [v for v in ends if _is_huge(v) or (not keep and _is_mark(v, rest))]
        if not marks:
            break
        found += marks[:1]
        rest = rest[rest != marks[0]]
    return found


def _is_huge(value: float) -> bool:
    return abs(value) >= SETTINGS.huge


def _is_mark(value: float, heights: np.ndarray) -> bool:
    if not any(abs(abs(value) - mark) <= 1e-9 * mark for mark in _MARKS):
        return False
    others = heights[heights != value]
    if others.size < 2 or np.ptp(others) == 0:
        return False
    return float(np.min(np.abs(others - value))) > SETTINGS.far_mark * float(np.ptp(others))


def _alone(heights: np.ndarray) -> np.ndarray:
    """Which heights lie apart from all others, and stand there without a flank.

    A scratch or a particle has flanks, or neighbours of other heights that lie as far.
    """
    known = np.isfinite(heights)
    low, high = _bulk(np.sort(heights[known]))
    far = known & ((heights < low) | (heights > high))
    if not far.any():
        return far
    near = _grown(far) & known & ~far
    calm = heights[known & ~far & ~near]
    if calm.size < SETTINGS.fewest:
        calm = heights[known & ~far]
    edge = SETTINGS.flank * float(np.ptp(calm))
    flanks = near & ((heights < calm.min() - edge) | (heights > calm.max() + edge))
    return far & ~_grown(flanks) & ~_varied(heights, far)


def _bulk(values: np.ndarray) -> tuple[float, float]:
    """The interval that heights fill without a gap as wide as what they fill before."""
    everything = -np.inf, np.inf
    if values.size <= SETTINGS.fewest:
        return everything
    for value in (values[0], values[-1]):  # more than half may be one mark
        others = values[values != value]
        away = np.min(np.abs(others - value)) if others.size > SETTINGS.fewest else 0.0
        if others.size > SETTINGS.fewest and away > SETTINGS.far * np.ptp(others) > 0:
            return _bulk(others)  # one farther out hides those on the other side
    gaps = np.diff(values)
    for share in SETTINGS.bulks:
        count = max(SETTINGS.fewest, int(share * values.size)) - 1
        widths = values[count:] - values[:-count]
        first = int(np.argmin(widths))
        if widths[first] > 0:
            return _spread(values, gaps, first, first + count)
    return everything


def _spread(
    values: np.ndarray, gaps: np.ndarray, first: int, last: int
) -> tuple[float, float]:
    """From samples `first` to `last` outwards, to the first gaps wider than all inside."""
    while True:
        wide = gaps > SETTINGS.far * (values[last] - values[first])
        below, above = np.flatnonzero(wide[:first]), np.flatnonzero(wide[last:])
        lowest = int(below[-1]) + 1 if below.size else 0
        highest = last + int(above[0]) if above.size else values.size - 1
        if (lowest, highest) == (first, last):
            return float(values[first]), float(values[last])
        first, last = lowest, highest


def _grown(mask: np.ndarray) -> np.ndarray:
    """A mask and its neighbours, along rows and across them."""
    padded = np.pad(mask, 1)
    rows, columns = mask.shape
    shifts = [(i, j) for i in range(3) for j in range(3)]
    return np.any([padded[i : i + rows, j : j + columns] for i, j in shifts], axis=0)


def _varied(heights: np.ndarray, far: np.ndarray) -> np.ndarray:
    """Samples that have a far neighbour of another height."""
    outside = np.where(far, heights, np.nan)
    padded = np.pad(outside, 1, constant_values=np.nan)
    rows, columns = heights.shape
    found = np.zeros(far.shape, bool)
    for i in range(3):
        for j in range(3):
            other = padded[i : i + rows, j : j + columns]
            found |= np.isfinite(other) & (other != outside)
    return far & found
