"""Order of convergence by the law that theory has for it, where errors follow the law."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from ..slide_laws import NO_LAW, Law
from .order import (
    Fit,
    Verdict,
    constant_range,
    fit_order,
    plain_slope,
    verdict_of,
)
from .settings import SETTINGS


class Trust(NamedTuple):
    """How well a law knows its errors.

    `within`: factor in which errors that follow it may differ; `drift`: what the order of
    this factor may be off by, which is added to every interval.
    """

    within: float
    drift: float


# Over 14 scenes, 9 gamma and 3 grids: sup errors within 3% of the law at the smallest eps,
# but for a slide of few slips; dissipation, a sum over slides of either sign, within 70%.
STATE, ENERGY = Trust(1.25, 0.004), Trust(2.0, 0.01)


class LawFit(NamedTuple):
    """A fit, the law it rests on, and the curve through the errors that was fitted.

    `law.name` is "free" where no law is used; `law.order` and `law.constant` are what
    theory predicts whether it is used or not, NaN where it predicts nothing. `fitted`:
    errors of the fitted curve at all eps, NaN without a fit.
    """

    fit: Fit
    law: Law
    fitted: Float[np.ndarray, " n"]


def fit_with_law(
    eps: Float[np.ndarray, " n"],
    errors: Float[np.ndarray, " n"],
    uncertainty: Float[np.ndarray, " n"],
    predicted: Float[np.ndarray, " n"] | None,
    law: Law,
    trust: Trust,
) -> LawFit:
    """Fit the order of `errors` (n,), by the law where the errors follow it, else freely.

    `predicted` (n,): the errors that the law has at these eps, finite eps included. What is
    fitted is the ratio of the errors to them: its order, with `fit_order`'s interval, is
    added to the law's, and half of what this order changes by from all usable eps to the
    smaller half of them. The law is used where the smaller half of the eps has a median
    ratio in [1/`trust.within`, `trust.within`] and the order of the ratio may be 0 within
    0.05.
    So the interval says how well errors and law agree, not how well a power fits a few
    decades: at gamma = 0.6 two terms that differ by eps^0.067 compete, which no free fit
    tells apart.

    Where at the smallest eps of the window the law is not within a factor of 1.5 of its
    own power, order and constant are theory's, confirmed through the law, and the verdict
    is `NOT_YET_SEEN`.
    """
    free = fit_order(eps, errors, uncertainty)
    if predicted is None or not np.isfinite(law.order):
        return LawFit(free, law._replace(name=NO_LAW.name), _line(eps, free))
    known = np.isfinite(predicted) & (predicted > 0)
    ratio = np.where(known, errors / np.where(known, predicted, 1.0), np.nan)
    usable = known & (errors > SETTINGS.above_floor * uncertainty) & (errors > 0)
    if usable.sum() < SETTINGS.usable or not _follows(
        eps[usable], ratio[usable], trust.within
    ):
        return LawFit(free, law._replace(name=NO_LAW.name), _line(eps, free))
    found = fit_order(eps[known], ratio[known], uncertainty[known] / predicted[known])
    drifts = not (found.low - SETTINGS.agrees <= 0.0 <= found.high + SETTINGS.agrees)
    if found.verdict == Verdict.TOO_FEW_POINTS or drifts:
        return LawFit(free, law._replace(name=NO_LAW.name), _line(eps, free))
    fit = _by_law(eps, errors, np.where(usable, ratio, np.nan), found, law, trust)
    fit = fit._replace(
        preasymptotic=found.preasymptotic + int(np.sum(~known & np.isfinite(errors))),
        failed=int(np.sum(~np.isfinite(errors))),
    )
    return LawFit(_judged(fit, law, eps, predicted), law, predicted * _line(eps, found))


def _by_law(
    eps: np.ndarray,
    errors: np.ndarray,
    ratio: np.ndarray,
    found: Fit,
    law: Law,
    trust: Trust,
) -> Fit:
    """A fit of the ratio of errors to their law, as one of the errors; NaN: not usable."""
    usable = np.isfinite(ratio)
    widened = trust.drift + SETTINGS.unsettled * _change(eps[usable], ratio[usable])
    low, high = found.low - widened, found.high + widened
    window = usable & (eps >= found.eps_min) & (eps <= found.eps_max)
    ends = constant_range(eps[window], ratio[window], low, high)
    return found._replace(
        order=law.order + found.order,
        low=law.order + low,
        high=law.order + high,
        constant=law.constant * found.constant,
        seen=plain_slope(eps[window], errors[window]),
        constant_low=law.constant * min(ends[0], found.constant),
        constant_high=law.constant * max(ends[1], found.constant),
    )


def _change(eps: np.ndarray, ratio: np.ndarray) -> float:
    """By how much the order of a ratio differs in the smaller half of its eps."""
    small = eps <= np.median(eps)
    return abs(plain_slope(eps, ratio) - plain_slope(eps[small], ratio[small]))


def _judged(fit: Fit, law: Law, eps: np.ndarray, predicted: np.ndarray) -> Fit:
    """With the verdict on its interval, and on whether the window shows its power."""
    verdict = verdict_of(fit.low, fit.high, fit.misfit)
    last = int(np.argmin(np.abs(eps - fit.eps_min)))
    power = law.constant * eps[last] ** law.order
    far = predicted[last] > SETTINGS.seen * power or predicted[last] * SETTINGS.seen < power
    if far and verdict in (Verdict.CONVERGES, Verdict.DIVERGES):
        verdict = Verdict.NOT_YET_SEEN
    return fit._replace(verdict=verdict)


def _line(eps: np.ndarray, fit: Fit) -> np.ndarray:
    return fit.constant * eps**fit.order


def _follows(eps: np.ndarray, ratio: np.ndarray, within: float) -> bool:
    small = ratio[eps <= np.median(eps)]
    return bool(1 / within <= np.median(small) <= within)
