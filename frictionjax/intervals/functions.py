"""Elementary functions of jets: ranges of each one and of its two derivatives."""

import functools
import math
from collections.abc import Callable

import numpy as np

from . import interval as iv
from . import jet as jets
from .interval import Interval
from .jet import Jet

Rule = Callable[..., Jet]
_ONE = iv.point(np.ones(()))
_ERF = 2 / math.sqrt(math.pi)
_erf = np.vectorize(math.erf, otypes=[float])
_erfc = np.vectorize(math.erfc, otypes=[float])


def _bounded(a: Interval, least: float, most: float) -> Interval:
    return Interval(np.maximum(a.lo, least), np.minimum(a.hi, most))


def _even(fn: Callable[[np.ndarray], np.ndarray], a: Interval) -> Interval:
    """Range of an even function that grows with |a|."""
    size = Interval(np.where(iv.holds_zero(a), 0.0, np.minimum(*map(abs, a))), a.size)
    return iv.rising(fn, size)


def exp(a: Jet) -> Jet:
    value = _bounded(iv.rising(np.exp, a.value), 0.0, np.inf)
    return jets.composed(a, value, value, value)


def exp2(a: Jet) -> Jet:
    return exp(jets.mul(a, jets.number(np.asarray(math.log(2.0)))))


def expm1(a: Jet) -> Jet:
    growth = _bounded(iv.rising(np.exp, a.value), 0.0, np.inf)
    return jets.composed(a, iv.rising(np.expm1, a.value), growth, growth)


def _above(a: Jet, least: float, value: Interval, first: Interval, second: Interval):
    """A function that lives above `least` only: not a number below, unbounded on both."""
    none, both = a.value.hi < least, (a.value.lo <= least) & (a.value.hi >= least)
    blank = iv.point(np.where(none, np.nan, 0.0))
    known = iv.where(none, blank, value)
    return jets.composed(a, known, first, second, seam=both)


def log(a: Jet) -> Jet:
    held = _bounded(a.value, 0.0, np.inf)
    rate = iv.reciprocal(held)
    value = _unbelow(iv.rising(np.log, held), held.lo <= 0)
    return _above(a, 0.0, value, rate, iv.negated(iv.square(rate)))


def _unbelow(a: Interval, where: np.ndarray) -> Interval:
    return Interval(np.where(where, -np.inf, a.lo), a.hi)


def log1p(a: Jet) -> Jet:
    held = _bounded(a.value, -1.0, np.inf)
    rate = iv.reciprocal(_bounded(iv.add(held, _ONE), 0.0, np.inf))
    value = _unbelow(iv.rising(np.log1p, held), held.lo <= -1)
    return _above(a, -1.0, value, rate, iv.negated(iv.square(rate)))


def sqrt(a: Jet) -> Jet:
    held = _bounded(a.value, 0.0, np.inf)
    value = _bounded(iv.rising(np.sqrt, held), 0.0, np.inf)
    rate = iv.scaled(iv.reciprocal(value), 0.5)
    second = iv.scaled(iv.power(iv.reciprocal(value), 3), -0.25)
    return _above(a, 0.0, value, rate, second)


def rsqrt(a: Jet) -> Jet:
    return reciprocal(sqrt(a))


def cbrt(a: Jet) -> Jet:
    value = iv.rising(np.cbrt, a.value)
    rate = iv.reciprocal(iv.scaled(iv.square(value), 3.0))
    bend = iv.scaled(iv.reciprocal(iv.power(value, 5)), -2 / 9)
    return jets.composed(a, value, rate, bend, seam=iv.holds_zero(a.value))


def sin(a: Jet) -> Jet:
    value = iv.sine(a.value)
    return jets.composed(a, value, iv.sine(a.value, 1.0), iv.negated(value))


def cos(a: Jet) -> Jet:
    value = iv.sine(a.value, 1.0)
    return jets.composed(a, value, iv.negated(iv.sine(a.value)), iv.negated(value))


def tan(a: Jet) -> Jet:
    return jets.mul(sin(a), reciprocal(cos(a)))


def sinh(a: Jet) -> Jet:
    value = iv.rising(np.sinh, a.value)
    return jets.composed(a, value, _even(np.cosh, a.value), value)


def cosh(a: Jet) -> Jet:
    value = _even(np.cosh, a.value)
    return jets.composed(a, value, iv.rising(np.sinh, a.value), value)


def tanh(a: Jet) -> Jet:
    value = _bounded(iv.rising(np.tanh, a.value), -1.0, 1.0)
    # 1 - tanh^2 loses its digits far out: as 1/cosh^2.
    rate = iv.square(iv.reciprocal(_even(np.cosh, a.value)))
    return jets.composed(a, value, rate, iv.scaled(iv.mul(value, rate), -2.0))


def logistic(a: Jet) -> Jet:
    fall = _bounded(iv.rising(np.exp, iv.negated(a.value)), 0.0, np.inf)
    value = _bounded(iv.reciprocal(iv.add(_ONE, fall)), 0.0, 1.0)
    half = iv.scaled(a.value, 0.5)
    rate = iv.scaled(iv.square(iv.reciprocal(_even(np.cosh, half))), 0.25)
    turned = iv.rising(np.tanh, half)
    return jets.composed(a, value, rate, iv.negated(iv.mul(turned, rate)))


def _bell(a: Interval, size: float) -> Interval:
    fall = _bounded(iv.rising(np.exp, iv.negated(iv.square(a))), 0.0, 1.0)
    return iv.scaled(fall, size)


def erf(a: Jet) -> Jet:
    rate = _bell(a.value, _ERF)
    value = _bounded(iv.rising(_erf, a.value), -1.0, 1.0)
    return jets.composed(a, value, rate, iv.scaled(iv.mul(a.value, rate), -2.0))


def erfc(a: Jet) -> Jet:
    rate = _bell(a.value, -_ERF)
    turned = iv.rising(lambda x: _erfc(-x), iv.negated(a.value))
    value = _bounded(turned, 0.0, 2.0)
    return jets.composed(a, value, rate, iv.scaled(iv.mul(a.value, rate), -2.0))


def atan(a: Jet) -> Jet:
    rate = iv.reciprocal(iv.add(_ONE, iv.square(a.value)))
    bend = iv.scaled(iv.mul(a.value, iv.square(rate)), -2.0)
    return jets.composed(a, iv.rising(np.arctan, a.value), rate, bend)


def atan2(a: Jet, b: Jet) -> Jet:
    """Of `a` over `b`; with a seam on the half line where it jumps, and at 0."""
    quarter = jets.number(np.asarray(np.pi / 2))
    by_b, by_a = atan(divide(a, b)), atan(divide(b, a))
    above, below = jets.sub(quarter, by_a), jets.negated(jets.add(quarter, by_a))
    around = jets.either(jets.either(by_b, above), below)
    lo = np.full_like(around.value.lo, -np.pi)
    around = around._replace(value=Interval(lo, -lo), seam=np.ones_like(around.seam))
    sides = jets.chosen(a.value.lo > 0, above, jets.chosen(a.value.hi < 0, below, around))
    return jets.chosen(b.value.lo > 0, by_b, sides)


def asinh(a: Jet) -> Jet:
    size = iv.rising(np.sqrt, iv.add(_ONE, iv.square(a.value)))
    rate = iv.reciprocal(size)
    bend = iv.negated(iv.mul(a.value, iv.power(rate, 3)))
    return jets.composed(a, iv.rising(np.arcsinh, a.value), rate, bend)


def square(a: Jet) -> Jet:
    return integer_power(a, 2)


def integer_power(a: Jet, n: int) -> Jet:
    if n in (0, 1):
        return a if n else jets.constant(iv.power(a.value, 0))
    first = iv.scaled(iv.power(a.value, n - 1), float(n))
    second = iv.scaled(iv.power(a.value, n - 2), float(n * (n - 1)))
    seam = iv.holds_zero(a.value) if n < 0 else None
    return jets.composed(a, iv.power(a.value, n), first, second, seam)


def reciprocal(a: Jet) -> Jet:
    return integer_power(a, -1)


def divide(a: Jet, b: Jet) -> Jet:
    return jets.mul(a, reciprocal(b))


def real_power(a: Jet, b: Jet) -> Jet:
    """`a**b`: whole known powers of any number, others of positive numbers."""
    known = b.value.lo
    if b.is_point and known.size and np.all(known == known.flat[0]):
        n = float(known.flat[0])
        if n.is_integer() and abs(n) < 1000:
            return integer_power(a, int(n))
        return _fixed_power(a, n)
    return exp(jets.mul(b, log(a)))


def _fixed_power(a: Jet, n: float) -> Jet:
    held = _bounded(a.value, 0.0, np.inf)

    def range_of(p: float) -> Interval:
        ends = held if p >= 0 else Interval(held.hi, held.lo)
        return iv.rising(lambda x: x**p, ends)

    first, second = iv.scaled(range_of(n - 1), n), iv.scaled(range_of(n - 2), n * (n - 1))
    return _above(a, 0.0, range_of(n), first, second)


def absolute(a: Jet) -> Jet:
    up, down = a.value.lo >= 0, a.value.hi <= 0
    both = jets.either(a, jets.negated(a))
    value = Interval(np.zeros_like(a.value.lo), a.value.size)
    folded = both._replace(value=value)
    return jets.chosen(up, a, jets.chosen(down, jets.negated(a), folded))


def maximum(a: Jet, b: Jet) -> Jet:
    first, second = a.value.lo >= b.value.hi, b.value.lo >= a.value.hi
    ends = (np.maximum(x, y) for x, y in zip(a.value, b.value, strict=True))
    both = jets.either(a, b)._replace(value=Interval(*ends))
    return jets.chosen(first, a, jets.chosen(second, b, both))


def minimum(a: Jet, b: Jet) -> Jet:
    return jets.negated(maximum(jets.negated(a), jets.negated(b)))


def _step(a: Jet, fn: Callable[[np.ndarray], np.ndarray]) -> Jet:
    """A function that is constant but where it jumps."""
    value = Interval(fn(a.value.lo), fn(a.value.hi))
    return jets.constant(value, a.seam | (value.lo != value.hi))


def sign(a: Jet) -> Jet:
    return _step(a, np.sign)


def floor(a: Jet) -> Jet:
    return _step(a, np.floor)


def ceil(a: Jet) -> Jet:
    return _step(a, np.ceil)


def rounded(a: Jet) -> Jet:
    """To the nearest whole number, halves to either."""
    value = Interval(np.ceil(a.value.lo - 0.5), np.floor(a.value.hi + 0.5))
    return jets.constant(value, a.seam | (value.lo != value.hi))


def remainder(a: Jet, b: Jet) -> Jet:
    """`a - b trunc(a/b)`, of the sign of `a`, as XLA has it."""
    whole = _step(divide(a, b), np.trunc)
    found = jets.sub(a, jets.mul(whole, b))
    size = b.value.size
    lo = np.where(a.value.lo >= 0, 0.0, -size)
    hi = np.where(a.value.hi <= 0, 0.0, size)
    found = found._replace(value=iv.meet(found.value, Interval(lo, hi)))
    if not b.is_point:
        return found
    # Remainders of floats are exact, also of whole numbers by whole ones.
    ends = [np.fmod(end, b.value.lo) for end in a.value]
    same = (a.value.width < size) & (ends[1] >= ends[0])
    same &= (a.value.lo >= 0) | (a.value.hi < 0)
    held = a._replace(value=Interval(*ends))
    return jets.chosen(same & np.isfinite(size), held, found)


def polynomial(x: Jet, *terms: Jet) -> Jet:
    """`terms[0] + terms[1] x + ...`, as `jnp.polyval` is written from JAX 0.12 on."""
    return functools.reduce(
        lambda total, term: jets.add(jets.mul(total, x), term), terms[::-1]
    )


ELEMENTARY: dict[str, Rule] = {
    "abs": absolute,
    "add": jets.add,
    "add_any": jets.add,
    "asinh": asinh,
    "atan": atan,
    "atan2": atan2,
    "cbrt": cbrt,
    "ceil": ceil,
    "cos": cos,
    "cosh": cosh,
    "div": divide,
    "erf": erf,
    "erfc": erfc,
    "exp": exp,
    "exp2": exp2,
    "expm1": expm1,
    "floor": floor,
    "log": log,
    "log1p": log1p,
    "logistic": logistic,
    "max": maximum,
    "min": minimum,
    "mul": jets.mul,
    "neg": jets.negated,
    "polynomial": polynomial,
    "pow": real_power,
    "rem": remainder,
    "round": rounded,
    "rsqrt": rsqrt,
    "sign": sign,
    "sin": sin,
    "sinh": sinh,
    "sqrt": sqrt,
    "square": square,
    "sub": jets.sub,
    "tan": tan,
    "tanh": tanh,
}
"""By the names that JAX has for them."""
