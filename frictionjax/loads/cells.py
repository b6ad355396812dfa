"""Stretches of time on which a load is known to rise, to fall or to rest."""

from collections.abc import Callable
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from .._checks import require
from ..intervals import Enclosure, Interval, Jet, TooMuchWorkError
from ..intervals import interval as iv
from .settings import SETTINGS


class Kind(IntEnum):
    """What a load does on a cell; NEEDLE: too short to cut and not smooth, OPEN: unknown.

    BENT: its slope grows, or falls, on all of it, so that it turns once at most. SMALL: it
    changes by less than its rounding.
    """

    FALLING = -1
    FLAT = 0
    RISING = 1
    SMALL = 2
    NEEDLE = 3
    BENT = 4
    OPEN = 5


class LoadCells(NamedTuple):
    """Cells of [0, T] in order, shape (n,): ends in s, and the `Kind` of each.

    `size`: largest |l| met, N.
    """

    lo: np.ndarray
    hi: np.ndarray
    kind: np.ndarray
    size: float


def proved_cells(bounds: Enclosure, duration: float) -> LoadCells:
    """Cells on which bounds of l, l' and l'' prove what the load does.

    Cut until they do: nothing hides between samples, as none are taken. OPEN where more
    cells are needed than are affordable. Raises `ValueError` where the load is no number.
    """
    edges = np.linspace(0.0, duration, SETTINGS.first + 1)
    lo, hi, size, left = edges[:-1], edges[1:], 0.0, SETTINGS.most_cells
    done: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    bounds.allow(SETTINGS.most_numbers)
    while lo.size:
        try:
            kinds, size = _kinds(bounds, lo, hi, duration, size)
        except TooMuchWorkError:
            done.append((lo, hi, np.full(lo.size, int(Kind.OPEN))))
            break
        left -= lo.size
        again = kinds == Kind.OPEN
        done.append((lo[~again], hi[~again], kinds[~again]))
        lo, hi = lo[again], hi[again]
        cuts = SETTINGS.cuts if lo.size < SETTINGS.many else 2
        if cuts * lo.size > left:
            done.append((lo, hi, np.full(lo.size, int(Kind.OPEN))))
            break
        lo, hi = halves(lo, hi, cuts)
    lo, hi, kind = (np.concatenate(column) for column in zip(*done, strict=True))
    order = np.argsort(lo, kind="stable")
    return LoadCells(lo[order], hi[order], kind[order], size)


def halves(lo: np.ndarray, hi: np.ndarray, cuts: int = 2) -> tuple[np.ndarray, np.ndarray]:
    """Ends of equal parts of cells."""
    edges = lo[:, None] + (hi - lo)[:, None] * np.arange(cuts + 1) / cuts
    edges[:, -1] = hi
    return edges[:, :-1].ravel(), edges[:, 1:].ravel()


def needle(duration: float) -> float:
    """Length in s of the shortest cells."""
    return SETTINGS.needle * float(np.spacing(duration))


def _kinds(
    bounds: Enclosure, lo: np.ndarray, hi: np.ndarray, duration: float, size: float
) -> tuple[np.ndarray, float]:
    """The kind of each cell, OPEN where it must be cut, and the largest |l| so far.

    Middles are looked at where l' is not decided without them.
    """
    whole = bounds(lo, hi)
    _require_numbers(0.5 * (lo + hi), whole.value)
    limits = size, duration
    kinds = _decided(whole, whole.slope, hi - lo, *limits)
    # At first all of them, for the size of the load.
    left = np.flatnonzero(~whole.seam & (kinds == Kind.OPEN) | (size == 0))
    if left.size:
        some = whole.mapped(lambda a: a[left])
        middles, half = 0.5 * (lo[left] + hi[left]), 0.5 * (hi[left] - lo[left])
        middle = bounds(middles, middles)
        _require_numbers(middles, middle.value)
        known = middle.value.size[np.isfinite(middle.value.size)]
        size = max(size, float(np.max(known, initial=0.0)))
        slope = _slopes(some, middle.slope, half)
        kinds[left] = _decided(some, slope, 2 * half, size, duration)
    short = (kinds == Kind.OPEN) & (hi - lo <= needle(duration))
    return np.where(short, Kind.NEEDLE, kinds), size


def _decided(whole: Jet, slope: Interval, length, size: float, duration: float):
    """The kind of each cell by bounds of its slope; OPEN where they do not decide."""
    smooth, mean = ~whole.seam, size / duration
    with np.errstate(all="ignore"):
        small = length * slope.size <= SETTINGS.rounded * size
        calm = (slope.width <= SETTINGS.kink * mean) & (
            whole.value.width <= SETTINGS.steady * size
        )
    bent = (whole.bend.lo >= 0) | (whole.bend.hi <= 0)
    flat = slope.size <= np.where(smooth, SETTINGS.flat, SETTINGS.kink) * mean
    rules = (
        (flat, Kind.FLAT),
        (slope.lo >= 0, Kind.RISING),
        (slope.hi <= 0, Kind.FALLING),
        (smooth & bent, Kind.BENT),
        (smooth & small, Kind.SMALL),
    )
    kinds = np.select([rule for rule, _ in rules], [k for _, k in rules], Kind.OPEN)
    return np.where(smooth | calm, kinds, Kind.OPEN)


def _slopes(whole: Jet, at_middle: Interval, half: np.ndarray) -> Interval:
    """Bounds of l' over cells: directly, and from its middle by the bounds of l''."""
    with np.errstate(all="ignore"):
        away = iv.mul(whole.bend, Interval(-half, half))
        from_middle = iv.add(at_middle, away)
    near = iv.meet(whole.slope, from_middle)
    both = iv.where(whole.seam, whole.slope, near)
    unknown = np.isnan(both.lo) | np.isnan(both.hi)
    return iv.where(unknown, iv.everything(both), both)


def _require_numbers(times: np.ndarray, values: Interval) -> None:
    bad = (
        np.isnan(values.lo)
        | (values.lo > SETTINGS.too_large)
        | (values.hi < -SETTINGS.too_large)
    )
    if bad.any():
        at = f"no finite number at t = {times[bad][0]:.9g}"
        require(False, "load.fn", at, "finite values on [0, duration]")


LoadPoint = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""l in N and l' in N/s at times (n,)."""


def by_bounds(bounds: Enclosure) -> LoadPoint:
    """Values and slopes as the bounds have them: no compiled program is needed.

    A slope is 0 where bounds do not tell its sign: its rounding would be a turn.
    """

    def at(times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        found = bounds(times, times)
        with np.errstate(invalid="ignore"):
            unsure = iv.holds_zero(found.slope) & np.isfinite(found.slope.width)
            return found.value.middle, np.where(unsure, 0.0, found.slope.middle)

    return at
