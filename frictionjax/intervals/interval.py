"""Intervals of real numbers, as NumPy arrays of their ends."""

import functools
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

# Four roundings: NumPy's elementary functions err by less, its arithmetic by a half.
_WIDER = 4 * float(np.finfo(float).eps)
_LEAST = float(np.finfo(float).smallest_subnormal)
LARGEST = float(np.finfo(float).max)


class Interval(NamedTuple):
    """All numbers from `lo` to `hi`, arrays of one shape; NaN where there is no number."""

    lo: np.ndarray
    hi: np.ndarray

    @property
    def size(self) -> np.ndarray:
        """Largest absolute value."""
        return np.maximum(np.abs(self.lo), np.abs(self.hi))

    @property
    def width(self) -> np.ndarray:
        """`hi - lo`."""
        return self.hi - self.lo

    @property
    def middle(self) -> np.ndarray:
        """The number half way: of a point, its value to a few roundings."""
        return 0.5 * self.lo + 0.5 * self.hi

    def mapped(self, change: Callable[[np.ndarray], np.ndarray]) -> "Interval":
        """Both ends changed alike: reshaped, picked, broadcast."""
        return Interval(change(self.lo), change(self.hi))


def point(value: np.ndarray) -> Interval:
    """An interval that holds one number."""
    return Interval(value, value)


def everything(like: Interval) -> Interval:
    """All numbers."""
    return Interval(np.full_like(like.lo, -np.inf), np.full_like(like.hi, np.inf))


def wider(lo: np.ndarray, hi: np.ndarray, slack: float = _WIDER) -> Interval:
    """Ends that hold true after roundings; zeros stay zeros.

    What is too large for a float is a number all the same, above the largest.
    """
    lo, hi = np.minimum(lo, LARGEST), np.maximum(hi, -LARGEST)
    return Interval(lo - slack * np.abs(lo), hi + slack * np.abs(hi))


def holds_zero(a: Interval) -> np.ndarray:
    """Where 0 is inside or at an end."""
    return (a.lo <= 0) & (a.hi >= 0)


def where(condition: np.ndarray, a: Interval, b: Interval) -> Interval:
    """`a` where the condition holds, else `b`."""
    return Interval(np.where(condition, a.lo, b.lo), np.where(condition, a.hi, b.hi))


def hull(a: Interval, b: Interval) -> Interval:
    """The least interval that holds both; everything where either has no number."""
    lo, hi = np.minimum(a.lo, b.lo), np.maximum(a.hi, b.hi)
    return Interval(np.where(np.isnan(lo), -np.inf, lo), np.where(np.isnan(hi), np.inf, hi))


def meet(a: Interval, b: Interval) -> Interval:
    """What both hold, two bounds of one number."""
    return Interval(np.fmax(a.lo, b.lo), np.fmin(a.hi, b.hi))


def negated(a: Interval) -> Interval:
    return Interval(-a.hi, -a.lo)


def add(a: Interval, b: Interval) -> Interval:
    lo, hi = np.minimum(a.lo + b.lo, LARGEST), np.maximum(a.hi + b.hi, -LARGEST)
    return Interval(lo - _rounded_off(lo, a.lo, b.lo), hi + _rounded_off(hi, a.hi, b.hi))


def _rounded_off(total: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """0 where a sum is exact: whole numbers stay whole, so that places are decided."""
    exact = (total - a == b) & (total - b == a)
    return np.where(exact, 0.0, _WIDER * np.abs(total))


def sub(a: Interval, b: Interval) -> Interval:
    return add(a, negated(b))


def mul(a: Interval, b: Interval) -> Interval:
    """Products; 0 times an unbounded end is 0, as that end itself is no member."""
    xs, ys = _ends(a), _ends(b)
    ends = [x * y for x in xs for y in ys]
    lo, hi = _extremes(ends)
    if np.isnan(lo).any():  # as it is where any end is
        none = np.isnan(a.lo) | np.isnan(b.lo)
        lo, hi = _extremes([np.where(np.isnan(end) & ~none, 0.0, end) for end in ends])
    if _keeps_digits(a) or _keeps_digits(b) or (is_whole(a) and is_whole(b)):
        return Interval(lo, hi)
    return wider(lo, hi)


def _ends(a: Interval) -> tuple[np.ndarray, ...]:
    """Both, or the one of a point: half the products."""
    return (a.lo,) if a.lo is a.hi else (a.lo, a.hi)


def _extremes(ends: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    return functools.reduce(np.minimum, ends), functools.reduce(np.maximum, ends)


def _keeps_digits(a: Interval) -> bool:
    """Whether it is one power of two, or 0."""
    if a.lo.size != 1 or a.lo.item() != a.hi.item():
        return False
    return abs(np.frexp(a.lo.item())[0]) in (0.0, 0.5)


def is_whole(a: Interval) -> bool:
    """Whether all ends are whole numbers, of which sums and products are exact."""
    return bool(np.all(a.lo == np.rint(a.lo)) and np.all(a.hi == np.rint(a.hi)))


def scaled(a: Interval, factor: float) -> Interval:
    return mul(a, point(np.asarray(factor)))


def square(a: Interval) -> Interval:
    low, high = a.lo * a.lo, a.hi * a.hi
    least = np.where(holds_zero(a), 0.0, np.minimum(low, high))
    return wider(least, np.maximum(low, high))


def reciprocal(a: Interval) -> Interval:
    """`1/a`; everything where 0 is inside, one side where it is an end."""
    with np.errstate(divide="ignore"):
        lo = np.where(a.hi == 0, -np.inf, 1.0 / a.hi)
        hi = np.where(a.lo == 0, np.inf, 1.0 / a.lo)
    found = wider(lo, hi)
    inside = (a.lo < 0) & (a.hi > 0) | (a.lo == 0) & (a.hi == 0)
    return where(inside, everything(found), found)


def power(a: Interval, n: int) -> Interval:
    """Whole powers."""
    if n < 0:
        return reciprocal(power(a, -n))
    if n == 0:
        return point(np.ones_like(a.lo))
    low, high = a.lo**n, a.hi**n
    slack = _WIDER * (1 + 0.25 * n)
    if n % 2:
        return wider(low, high, slack)
    least = np.where(holds_zero(a), 0.0, np.minimum(low, high))
    return wider(least, np.maximum(low, high), slack)


def rising(fn: Callable[[np.ndarray], np.ndarray], a: Interval) -> Interval:
    """Range of a function that grows everywhere."""
    with np.errstate(all="ignore"):
        lo, hi = fn(a.lo), fn(a.hi)
    lo, hi = wider(lo, hi)
    return Interval(lo, hi + _LEAST)  # a value that has underflown is not 0


def sine(a: Interval, quarters: float = 0.0) -> Interval:
    """Range of `sin(a + quarters pi/2)`: 0 for the sine, 1 for the cosine."""
    fn = np.cos if quarters else np.sin
    with np.errstate(invalid="ignore"):
        low, high = fn(a.lo), fn(a.hi)
        slack = 1e-15 * (1 + a.size)  # of multiples of pi
        turns = [_holds_multiple(a, (k - quarters) * np.pi / 2, slack) for k in (1, 3)]
    found = wider(np.minimum(low, high), np.maximum(low, high))
    # The place of a zero is known to a rounding of the argument.
    least = np.where(turns[1], -1.0, np.maximum(found.lo - _LEAST, -1.0))
    most = np.where(turns[0], 1.0, np.minimum(found.hi + _LEAST, 1.0))
    none = np.isnan(low) | np.isnan(high)
    unbounded = np.isinf(a.lo) | np.isinf(a.hi)
    least = np.where(unbounded, -1.0, np.where(none, np.nan, least))
    return Interval(least, np.where(unbounded, 1.0, np.where(none, np.nan, most)))


def _holds_multiple(a: Interval, first: float, slack: np.ndarray) -> np.ndarray:
    """Whether `first + 2 pi k` is in an interval for a whole k."""
    whole = 2 * np.pi
    return np.floor((a.hi + slack - first) / whole) >= np.ceil(
        (a.lo - slack - first) / whole
    )
