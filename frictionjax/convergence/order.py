"""Order of convergence by regression, with an interval that says what the data can."""

import enum
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.special import fdtr, stdtrit  # scipy.stats takes 0.2 s to import

from .._checks import require
from .regression import Asymptote, asymptote
from .settings import SETTINGS

_CUBIC = 4  # parameters


class Verdict(enum.IntEnum):
    """What the interval of an order says."""

    CONVERGES = 0
    DIVERGES = 1
    UNDECIDED = 2
    TOO_FEW_POINTS = 3
    NO_POWER = 4
    NOT_YET_SEEN = 5  # errors follow their law, but not yet its power of eps -> 0


class Fit(NamedTuple):
    """Order of `error ~ eps^order` as eps -> 0, its 95% interval and its window.

    `constant`: error/eps^order in the middle of the window, with `constant_low`,
    `constant_high` those of `constant_range`. `preasymptotic`, `floor`, `failed`: how many
    cells were left out because eps was too large, the error too near the solver's own, or
    the cell failed. `misfit`: the largest factor by which the fitted line misses a point of
    its window; beyond 3 the verdict is that it is no power. `seen`: slope of the window's
    errors by plain regression, which is no statement on eps -> 0.
    """

    order: float
    low: float
    high: float
    constant: float
    eps_min: float
    eps_max: float
    points: int
    preasymptotic: int
    floor: int
    failed: int
    verdict: Verdict
    misfit: float
    seen: float
    constant_low: float
    constant_high: float


def fit_order(eps: np.ndarray, errors: np.ndarray, uncertainty: np.ndarray) -> Fit:
    """Fit the order of `errors` (n,) at `eps` (n,), known to `uncertainty` (n,).

    A NaN error is a failed cell. Windows reach down to the smallest usable eps and hold at
    least half of the usable points, and five; of five such windows the longest counts that
    a curve fits: residuals of neighbours are as random as chance has it, those of large
    eps are no larger than those of small eps, and the order is in three times the interval
    of the shortest window. The shortest counts where none does.

    The interval is for the order as eps -> 0, not for a power law through the window: it
    holds the scatter and what `asymptote` allows for, a correction 1 + c eps^q with
    q >= 0.2, a logarithm as factor or divisor where the errors show one; and in a window of
    less than a factor of 3 in eps a wave of the errors by a factor of 1.25. Not in it: a
    correction above 5% that the scatter hides, one that decays more slowly than eps^0.2
    otherwise, and errors that change their law below the smallest eps.

    Raises `ValueError` for shapes that differ or eps that are not positive and distinct.
    """
    eps, errors = np.asarray(eps, float), np.asarray(errors, float)
    uncertainty = np.asarray(uncertainty, float)
    require(eps.ndim == 1, "eps", eps, "a list of values, shape (n,)")
    require(errors.shape == eps.shape, "errors", errors, f"shape {eps.shape}")
    require(uncertainty.shape == eps.shape, "uncertainty", uncertainty, f"{eps.shape}")
    distinct = np.all(eps > 0) and np.unique(eps).size == eps.size
    require(distinct, "eps", eps, "positive, distinct values")
    failed = ~np.isfinite(errors)
    known = np.where(failed, 0.0, errors)
    near_floor = ~failed & ~(known > SETTINGS.above_floor * uncertainty)
    usable = np.flatnonzero(~failed & ~near_floor)
    usable = usable[np.argsort(-eps[usable])]
    counts = {"floor": int(near_floor.sum()), "failed": int(failed.sum())}
    if usable.size < SETTINGS.least_points:
        return _no_fit(usable.size, **counts)
    x, y = np.log(eps[usable]), np.log(errors[usable])
    start, found = _best_window(x, y)
    window = eps[usable][start:]
    wave = _unseen_wave(window)
    found = found._replace(low=found.low - wave, high=found.high + wave)
    middle = y[start:].mean() - found.slope * x[start:].mean()
    misfit = float(np.exp(np.abs(y - middle - found.slope * x)[start:].max()))
    ends = constant_range(window, errors[usable][start:], found.low, found.high)
    return Fit(
        order=found.slope,
        low=found.low,
        high=found.high,
        constant=float(np.exp(middle)),
        eps_min=float(window.min()),
        eps_max=float(window.max()),
        points=window.size,
        preasymptotic=start,
        verdict=verdict_of(found.low, found.high, misfit),
        misfit=misfit,
        seen=plain_slope(window, errors[usable][start:]),
        constant_low=min(ends[0], float(np.exp(middle))),
        constant_high=max(ends[1], float(np.exp(middle))),
        **counts,
    )


def _unseen_wave(window: Float[np.ndarray, " n"]) -> float:
    """What the order may be off by where the window is narrower than waves of the errors.

    A part of a wave is a slope like any other. Of windows that are wide enough it is 0.
    """
    width = float(np.log(window.max() / window.min()))
    return float(np.log(SETTINGS.waves)) * max(0.0, 1 / width - 1 / np.log(SETTINGS.narrow))


def _no_fit(points: int, floor: int, failed: int) -> Fit:
    nan = float("nan")
    values: dict[str, Any] = dict.fromkeys(Fit._fields, nan)
    values |= {"points": points, "preasymptotic": 0, "floor": floor, "failed": failed}
    return Fit(**values | {"verdict": Verdict.TOO_FEW_POINTS})


def plain_slope(eps: Float[np.ndarray, " n"], errors: Float[np.ndarray, " n"]) -> float:
    """Slope of log error over log eps by least squares, all points alike."""
    x, y = np.log(eps), np.log(errors)
    return float((x - x.mean()) @ y / np.sum((x - x.mean()) ** 2))


def constant_range(
    eps: Float[np.ndarray, " n"], errors: Float[np.ndarray, " n"], low: float, high: float
) -> tuple[float, float]:
    """Constants of the powers of orders `low` to `high` through the errors of small eps.

    Through the middle of the smaller half of the eps (n,), n >= 4, and with what the
    scatter about a line leaves of it (95%): it holds a constant together with its order.
    (Through the middle of all: errors that bend put it off by what they bend.)
    """
    x, y = np.log(eps), np.log(errors)
    small = x <= np.median(x)
    left = y - y.mean() - plain_slope(eps, errors) * (x - x.mean())
    scatter = np.sqrt(np.sum(left**2) / (x.size - 2) / np.sum(small))
    margin = float(stdtrit(x.size - 2, 0.975) * scatter)
    ends = y[small].mean() - np.array([low, high]) * x[small].mean()
    with np.errstate(over="ignore"):  # orders of a narrow window may be anything
        return float(np.exp(ends.min() - margin)), float(np.exp(ends.max() + margin))


def verdict_of(low: float, high: float, misfit: float) -> Verdict:
    """What an interval of the order says, and how far the line misses its points."""
    if misfit > SETTINGS.worst_misfit:
        return Verdict.NO_POWER
    if low > 0:
        return Verdict.CONVERGES
    return Verdict.DIVERGES if high < 0 else Verdict.UNDECIDED


def _best_window(x: np.ndarray, y: np.ndarray) -> tuple[int, Asymptote]:
    """Where the window x[start:] (x falls) that counts starts, and its asymptote.

    The longest that fits. (The narrowest interval of all windows: half of those of
    eps (1 + 3 eps^0.2) missed, since it is narrow where chance hides the bend.)
    """
    shortest = max(0, x.size - max(SETTINGS.shortest_window, x.size // 2))
    starts = np.unique(
        np.linspace(0, shortest, SETTINGS.windows).round().astype(int)
    ).tolist()
    every = _scatter(x, y)
    last = _asymptote(x, y, starts[-1], every)
    for start in starts[:-1]:
        found = _asymptote(x, y, start, every)
        if _fits(found, last):
            return start, found
    return starts[-1], last


def _asymptote(x: np.ndarray, y: np.ndarray, start: int, every: float) -> Asymptote:
    """Of a window. It scatters as all points do, by `every`, unless unlikely (99%)."""
    own = _scatter(x[start:], y[start:])
    freedom = x.size - start - _CUBIC, x.size - _CUBIC
    if freedom[0] > 0 and every > 0 and fdtr(*freedom, (own / every) ** 2) < SETTINGS.rare:
        every = own
    return asymptote(x[start:], y[start:], every)


def _scatter(x: np.ndarray, y: np.ndarray) -> float:
    """Scatter about a cubic: no window may claim less by luck."""
    if x.size <= _CUBIC:
        return 0.0
    left = y - np.polyval(np.polyfit(x - x.mean(), y, 3), x - x.mean())
    return float(np.sqrt(np.sum(left**2) / (x.size - _CUBIC)))


def _fits(found: Asymptote, last: Asymptote) -> bool:
    if np.abs(found.left).max() < SETTINGS.exact:
        return True
    return _agrees(found, last) and _is_random(found.left) and _is_even(found.left)


def _agrees(found: Asymptote, last: Asymptote) -> bool:
    """Whether an order is within three times the interval of the shortest window.

    Once: a short interval that missed drew the longer ones after it, 80% coverage for 100%.
    """
    low, high = last.low - last.slope, last.high - last.slope
    return 3 * low <= found.slope - last.slope <= 3 * high


def _is_random(left: np.ndarray) -> bool:
    """Whether neighbouring residuals differ as much as chance has it (von Neumann, 95%)."""
    steps = float(np.sum(np.diff(left) ** 2))
    return steps >= (2 - 2 * SETTINGS.one_sided / np.sqrt(left.size)) * float(left @ left)


def _is_even(left: np.ndarray) -> bool:
    """Whether residuals of large eps may be as small as those of small eps (99%).

    Of a hump the slope is fitted to the hump, with an interval that says so to nobody.
    """
    half = left.size // 2
    large, small = left[:half], left[half:]
    if half < _CUBIC - 1 or not small.any():
        return True
    ratio = np.mean(large**2) / np.mean(small**2)
    return bool(fdtr(half - 1, left.size - half - 1, ratio) < 1 - SETTINGS.rare)


def local_orders(
    eps: Float[np.ndarray, " n"], errors: Float[np.ndarray, " n"]
) -> Float[np.ndarray, " pairs"]:
    """Slopes between neighbours in the log-log plot, shape (n - 1,); signs are kept."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.diff(np.log(errors)) / np.diff(np.log(eps))
