"""Comparisons and choices of jets: true, false, or either where intervals overlap."""

from collections.abc import Callable

import numpy as np

from . import jet as jets
from .functions import maximum, minimum
from .interval import Interval
from .jet import Jet


def _truth(sure: np.ndarray, never: np.ndarray) -> Jet:
    return jets.constant(Interval(sure.astype(float), (~never).astype(float)))


def less(a: Jet, b: Jet) -> Jet:
    x, y = a.value, b.value
    return _truth(x.hi < y.lo, x.lo >= y.hi)


def less_or_equal(a: Jet, b: Jet) -> Jet:
    x, y = a.value, b.value
    return _truth(x.hi <= y.lo, x.lo > y.hi)


def equal(a: Jet, b: Jet) -> Jet:
    x, y = a.value, b.value
    sure = (x.lo == x.hi) & (y.lo == y.hi) & (x.lo == y.lo)
    return _truth(sure, (x.hi < y.lo) | (x.lo > y.hi))


def negation(a: Jet) -> Jet:
    return jets.constant(Interval(1.0 - a.value.hi, 1.0 - a.value.lo))


def both(a: Jet, b: Jet) -> Jet:
    lo, hi = (np.minimum(x, y) for x, y in zip(a.value, b.value, strict=True))
    return jets.constant(Interval(lo, hi))


def any_of(a: Jet, b: Jet) -> Jet:
    lo, hi = (np.maximum(x, y) for x, y in zip(a.value, b.value, strict=True))
    return jets.constant(Interval(lo, hi))


def select(which: Jet, *cases: Jet) -> Jet:
    """The case whose number `which` is; of several that it may be, all."""
    lo, hi = which.value
    found = cases[0]
    for number, case in enumerate(cases[1:], start=1):
        joined = jets.chosen(hi >= number, jets.either(found, case), found)
        found = jets.chosen(lo >= number, case, joined)
    return found


def clamp(least: Jet, a: Jet, most: Jet) -> Jet:
    return minimum(maximum(a, least), most)


def is_finite(a: Jet) -> Jet:
    sure = np.isfinite(a.value.lo) & np.isfinite(a.value.hi)
    return _truth(sure, np.isnan(a.value.lo))


LOGIC: dict[str, Callable[..., Jet]] = {
    "and": both,
    "clamp": clamp,
    "eq": equal,
    "ge": lambda a, b: less_or_equal(b, a),
    "gt": lambda a, b: less(b, a),
    "is_finite": is_finite,
    "le": less_or_equal,
    "lt": less,
    "ne": lambda a, b: negation(equal(a, b)),
    "not": negation,
    "or": any_of,
    "select_n": select,
}
"""By the names that JAX has for them."""
