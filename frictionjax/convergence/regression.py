"""Slope of a curve far to the left, where corrections have decayed: what data can say."""

import functools
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.special import stdtrit  # scipy.stats takes 0.2 s to import

from .settings import SETTINGS

_LOGARITHMS = np.geomspace(*SETTINGS.logarithms)


class Asymptote(NamedTuple):
    """Slope as x -> -inf with its 95% interval.

    `left`: residuals of the best curve.
    """

    slope: float
    low: float
    high: float
    left: Float[np.ndarray, " n"]


class _Curves(NamedTuple):
    """Curves a + slope x + f(x) with their best a and slope, one a row.

    `misfit`: sum of squares of `left`; `beyond`: what their slope still changes at smaller
    x; `price`: of believing in f, 0 to 1, infinite where f is still large at the end.
    """

    q: np.ndarray
    c: np.ndarray
    slope: np.ndarray
    left: np.ndarray
    misfit: np.ndarray
    beyond: np.ndarray
    price: np.ndarray


class _Points(NamedTuple):
    """Points (x, y) with all that curves through them ask for anew.

    `unit`: orthonormal rows that span the lines; `spread`: root of the sum of squares of
    x - mean(x); `free`: y - mean(y); `before`: x - max(x).
    """

    unit: np.ndarray
    spread: float
    free: np.ndarray
    before: np.ndarray

    @classmethod
    def of(cls, x: np.ndarray, y: np.ndarray) -> "_Points":
        middle = x - x.mean()
        spread = np.sqrt(middle @ middle)
        unit = np.stack([np.ones(x.size), middle / spread])
        unit[0] /= np.sqrt(x.size)
        return cls(unit, spread, y - y.mean(), x - x.max())


class _Judged(NamedTuple):
    """How far the curves are from the best one in chi^2, and within what they may be."""

    best: int
    away: np.ndarray
    variance: float
    limit: float


def asymptote(
    x: Float[np.ndarray, " n"], y: Float[np.ndarray, " n"], scatter: float = 0.0
) -> Asymptote:
    """Slope of y (n,), n >= 4, as x (n,) -> -inf; y scatters by at least `scatter`.

    The interval is the hull of those of all curves that the data do not exclude (profile
    likelihood): y = a + p x + log(1 + c e^(q x)), q >= 0.2, and where the data show a
    bend also y = a + p x +- log(1 - c x). A correction of up to 5% at the largest x counts
    even where scatter hides it; without a limit to what may hide, no interval is useful
    (one of 12% behind 1% scatter, in one decade, is missed in 7 of 10 draws). What the
    slope of a curve still changes beyond the smallest x is allowed for twice over, for the
    next term of the correction.

    Coverage of 200 draws, 2% scatter over five decades, 8, 16, 32 points, of errors
    eps (1 + 3 eps^0.5): 99, 97, 98%; with eps^0.2: 99, 98, 96%; eps log(1/eps): 100, 97,
    97%; eps/log(1/eps): 93, 91, 90%; pure powers, 5% over two decades: 96, 97, 99%. Lost:
    slope of a parabola and twice its move, in the narrowest window: 83, 65, 49%; 11, 24,
    39%; 4, 21, 33%. That with the move of eps^0.2 over the window: 85, 65, 50%; 35, 46,
    49%; 21, 27, 33%. One linear term e^(q x) in the narrowest window: 76, 46, 10%; 11, 18,
    17%; 7, 0, 0%. The width on pure powers is 0.95, 1.08 and 1.2 times the first one's.
    """
    points = _Points.of(x, y)
    powers = _powers(points, np.ones(1), np.zeros(1))
    line = powers.misfit[0]
    q, c = (
        np.log([SETTINGS.slowest, SETTINGS.fastest]),
        _to_even(np.array([SETTINGS.smallest, SETTINGS.largest])),
    )
    for _ in range(SETTINGS.zooms):
        some_q = np.exp(np.linspace(q[0], q[1], SETTINGS.cells_q))
        some_c = _from_even(np.linspace(c[0], c[1], SETTINGS.cells_c))
        every_q, every_c = np.tile(some_q, some_c.size), np.repeat(some_c, some_q.size)
        new = _powers(points, every_q, every_c)
        # (Trees of JAX took twice as long.)
        powers = _Curves(*map(np.concatenate, zip(powers, new, strict=True)))
        judged = _judged(powers, x.size, line, scatter)
        near = judged.away <= judged.limit
        q = _around(np.log(powers.q[near]), q, SETTINGS.cells_q)
        c = _around(_to_even(powers.c[near]), c, SETTINGS.cells_c)
    best = judged.best
    low, high = _hull(powers, judged.away, judged, points)
    if x.size > SETTINGS.line_only:
        logarithms = _logarithms(points)
        cost = logarithms.misfit / judged.variance + judged.limit + SETTINGS.evidence
        away = np.maximum(cost - _cost(powers, judged)[best], 0.0)
        further = _hull(logarithms, away, judged, points)
        low, high = min(low, further[0]), max(high, further[1])
    return Asymptote(float(powers.slope[best]), low, high, powers.left[best])


def _to_even(c: np.ndarray) -> np.ndarray:
    return np.arcsinh(c / SETTINGS.even)


def _from_even(c: np.ndarray) -> np.ndarray:
    return SETTINGS.even * np.sinh(c)


def _around(values: np.ndarray, ends: np.ndarray, cells: int) -> np.ndarray:
    """The range of some values and a cell on both sides, inside the old range."""
    cell = (ends[1] - ends[0]) / (cells - 1)
    return np.clip([values.min() - cell, values.max() + cell], ends[0], ends[1])


def _powers(points: _Points, q: np.ndarray, c: np.ndarray) -> _Curves:
    bends = c[:, None] * np.exp(q[:, None] * points.before)
    end = c * np.exp(q * points.before.min())
    price = np.where(
        np.abs(end) > SETTINGS.at_the_end,
        np.inf,
        np.minimum((c / SETTINGS.hidden) ** 2, 1.0),
    )
    return _curves(points, np.log1p(bends), q, c, q * end / (1 + end), price)


def _logarithms(points: _Points) -> _Curves:
    """Curves whose logarithm the data must show; their form is exact, nothing is beyond."""
    bends = np.log1p(_LOGARITHMS[:, None] * -points.before)
    c = np.concatenate([_LOGARITHMS, -_LOGARITHMS])
    none = np.zeros(c.size)
    return _curves(points, np.concatenate([bends, -bends]), none, c, none, none + 1)


def _curves(points: _Points, bends, q, c, beyond, price) -> _Curves:
    left = points.free - bends
    part = left @ points.unit.T
    left -= part @ points.unit
    least = points.free.size * SETTINGS.rounding**2
    misfit = np.maximum((left**2).sum(axis=1), least)
    return _Curves(q, c, part[:, 1] / points.spread, left, misfit, beyond, price)


def _judged(curves: _Curves, n: int, line: float, scatter: float) -> _Judged:
    freedom, few = n - 2, n <= SETTINGS.line_only
    variance = line / freedom if few else curves.misfit.min() / (n - 4)
    judged = _Judged(0, np.zeros(0), max(variance, scatter**2), _limit(freedom))
    best = int(np.argmin(_cost(curves, judged)))
    if not few and abs(curves.c[best]) > SETTINGS.hidden:
        freedom = n - 4
    variance = max(curves.misfit[best] / freedom, scatter**2)
    judged = judged._replace(variance=float(variance), limit=_limit(freedom))
    cost = _cost(curves, judged)
    return judged._replace(best=int(np.argmin(cost)), away=cost - cost.min())


def _cost(curves: _Curves, judged: _Judged) -> np.ndarray:
    price = curves.price * (judged.limit + SETTINGS.evidence)
    return curves.misfit / judged.variance + price


@functools.cache
def _limit(freedom: int) -> float:
    return float(stdtrit(freedom, 0.5 + 0.5 * SETTINGS.level)) ** 2


def _hull(
    curves: _Curves, away: np.ndarray, judged: _Judged, points: _Points
) -> tuple[float, float]:
    left = np.sqrt(np.maximum(judged.limit - away, 0.0) * judged.variance)
    width = left / points.spread + np.abs(curves.beyond)
    near = away <= judged.limit
    if not near.any():
        return np.inf, -np.inf
    lows, highs = (curves.slope - width)[near], (curves.slope + width)[near]
    return float(lows.min()), float(highs.max())
