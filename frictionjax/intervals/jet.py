"""A function of one number over intervals: its values and two derivatives, bounded."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from . import interval as iv
from .interval import Interval


class Jet(NamedTuple):
    """Bounds over each of N intervals of t, arrays (N, ...) or (1, ...) where all agree.

    `value`, `slope`, `bend`: of f, f', f''; the derivatives hold away from seams. `seam`:
    whether f may jump or have a kink inside, as where two branches meet.
    """

    value: Interval
    slope: Interval
    bend: Interval
    seam: np.ndarray

    def mapped(self, change: Callable[[np.ndarray], np.ndarray]) -> "Jet":
        """All arrays changed alike: reshaped, picked, broadcast."""
        value, slope, bend = (part.mapped(change) for part in self[:3])
        return Jet(value, slope, bend, change(self.seam))

    @property
    def is_point(self) -> bool:
        """Whether it is one known number everywhere."""
        return bool(np.all(self.value.lo == self.value.hi)) and not self.seam.any()


def constant(value: Interval, seam: np.ndarray | None = None) -> Jet:
    """A function that does not change, but where it jumps."""
    none = iv.point(np.zeros_like(value.lo))
    no_seam = np.zeros(value.lo.shape, dtype=bool)
    return Jet(value, none, none, no_seam if seam is None else seam)


def number(value: np.ndarray) -> Jet:
    """An array of known numbers, the same for all intervals."""
    return constant(iv.point(np.asarray(value, dtype=float)[None]))


def variable(lo: np.ndarray, hi: np.ndarray) -> Jet:
    """`t` itself on [lo, hi], shapes (N,)."""
    one, none = iv.point(np.ones_like(lo)), iv.point(np.zeros_like(lo))
    return Jet(Interval(lo, hi), one, none, np.zeros(lo.shape, dtype=bool))


def add(a: Jet, b: Jet) -> Jet:
    value, slope, bend = (iv.add(x, y) for x, y in zip(a[:3], b[:3], strict=True))
    return Jet(value, slope, bend, a.seam | b.seam)


def negated(a: Jet) -> Jet:
    value, slope, bend = (iv.negated(part) for part in a[:3])
    return Jet(value, slope, bend, a.seam)


def sub(a: Jet, b: Jet) -> Jet:
    return add(a, negated(b))


def mul(a: Jet, b: Jet) -> Jet:
    value = iv.mul(a.value, b.value)
    slope = iv.add(iv.mul(a.slope, b.value), iv.mul(a.value, b.slope))
    mixed = iv.scaled(iv.mul(a.slope, b.slope), 2.0)
    ends = iv.add(iv.mul(a.bend, b.value), iv.mul(a.value, b.bend))
    return Jet(value, slope, iv.add(ends, mixed), a.seam | b.seam)


def composed(a: Jet, value: Interval, first: Interval, second: Interval, seam=None) -> Jet:
    """`f(a)` from the ranges of f, f' and f'' over that of `a`."""
    slope = iv.mul(first, a.slope)
    bend = iv.add(iv.mul(second, iv.square(a.slope)), iv.mul(first, a.bend))
    return Jet(value, slope, bend, a.seam if seam is None else a.seam | seam)


def chosen(which: np.ndarray, a: Jet, b: Jet) -> Jet:
    """`a` where the condition holds, else `b`."""
    pairs = zip(a[:3], b[:3], strict=True)
    value, slope, bend = (iv.where(which, x, y) for x, y in pairs)
    return Jet(value, slope, bend, np.where(which, a.seam, b.seam))


def either(a: Jet, b: Jet) -> Jet:
    """One or the other, with a seam unless both are the same number."""
    value, slope, bend = (iv.hull(x, y) for x, y in zip(a[:3], b[:3], strict=True))
    same = np.ones(value.lo.shape, dtype=bool)
    for x, y in zip(a[:3], b[:3], strict=True):
        same &= (x.lo == x.hi) & (y.lo == y.hi) & (x.lo == y.lo)
    return Jet(value, slope, bend, a.seam | b.seam | ~same)


def summed(a: Jet, axes: tuple[int, ...]) -> Jet:
    """The sum over axes of the values (not that of the intervals)."""
    along = tuple(axis + 1 for axis in axes)
    count = int(np.prod([a.seam.shape[axis] for axis in along]))
    slack = 1.2e-16 * (4 + count)

    def total(part: Interval) -> Interval:
        lo, hi = part.lo.sum(axis=along), part.hi.sum(axis=along)
        off = 0.0 if iv.is_whole(part) else slack * part.size.sum(axis=along)
        return Interval(lo - off, hi + off)

    value, slope, bend = (total(part) for part in a[:3])
    return Jet(value, slope, bend, np.any(a.seam, axis=along, keepdims=False))
