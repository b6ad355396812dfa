"""Order of convergence by the law that theory has for it, where errors follow the law."""

from typing import NamedTuple

import numpy as np

from .orders import ABOVE_FLOOR, Fit, Verdict, fit_order, verdict_of
from .slide_laws import NO_LAW, Law

_AGREES = 0.05  # of an order: a prediction whose ratio still drifts by more is none
_USABLE = 4  # cells


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
    fitted: np.ndarray


def fit_with_law(
    eps: np.ndarray,
    errors: np.ndarray,
    uncertainty: np.ndarray,
    predicted: np.ndarray | None,
    law: Law,
    trust: Trust,
) -> LawFit:
    """Fit the order of `errors` (n,), by the law where the errors follow it, else freely.

    `predicted` (n,): the errors that the law has at these eps, finite eps included. What is
    fitted is the ratio of the errors to them: its order, with `fit_order`'s interval, is
    added to the law's. The law is used where the smaller half of the eps has a median ratio
    in [1/`trust.within`, `trust.within`] and the order of the ratio may be 0 within 0.05.
    So the interval says how well errors and law agree, not how well a power fits a few
    decades: at gamma = 0.6 two terms that differ by eps^0.067 compete, which no free fit
    tells apart.
    """
    free = fit_order(eps, errors, uncertainty)
    if predicted is None or not np.isfinite(law.order):
        return LawFit(free, law._replace(name=NO_LAW.name), _line(eps, free))
    known = np.isfinite(predicted) & (predicted > 0)
    ratio = np.where(known, errors / np.where(known, predicted, 1.0), np.nan)
    usable = known & (errors > ABOVE_FLOOR * uncertainty) & (errors > 0)
    if usable.sum() < _USABLE or not _follows(eps[usable], ratio[usable], trust.within):
        return LawFit(free, law._replace(name=NO_LAW.name), _line(eps, free))
    found = fit_order(eps[known], ratio[known], uncertainty[known] / predicted[known])
    drifts = not (found.low - _AGREES <= 0.0 <= found.high + _AGREES)
    if found.verdict == Verdict.TOO_FEW_POINTS or drifts:
        return LawFit(free, law._replace(name=NO_LAW.name), _line(eps, free))
    low = law.order + found.low - trust.drift
    high = law.order + found.high + trust.drift
    fit = found._replace(
        order=law.order + found.order,
        low=low,
        high=high,
        constant=law.constant * found.constant,
        preasymptotic=found.preasymptotic + int(np.sum(~known & np.isfinite(errors))),
        failed=int(np.sum(~np.isfinite(errors))),
        verdict=verdict_of(low, high, found.misfit),
    )
    return LawFit(fit, law, predicted * _line(eps, found))


def _line(eps: np.ndarray, fit: Fit) -> np.ndarray:
    return fit.constant * eps**fit.order


def _follows(eps: np.ndarray, ratio: np.ndarray, within: float) -> bool:
    small = ratio[eps <= np.median(eps)]
    return bool(1 / within <= np.median(small) <= within)
