"""From a descent to the result of a fit to a trace."""

from typing import Any

import numpy as np

from ...profiles import Fourier
from ..measured_trace import Trace
from .flow import Flow
from .gauss_newton import Descent, Step, View, weigh
from .problem import TraceProblem
from .result import TraceFit, TraceHistory
from .settings import SETTINGS
from .status import TraceStatus
from .weights import TraceIdentifiability, identify

_UNTRUSTED = (TraceStatus.MISFIT, TraceStatus.OTHER_SLIPS, TraceStatus.MAX_STEPS)


def report_trace(
    trace: Trace, problem: TraceProblem, found: Descent, within: float, odd: str = ""
) -> TraceFit:
    """Judge where the descent ended."""
    now = weigh(problem.observed(), found.flow)
    sd = problem.observed().sd
    counted = _counted(now, found.numbers.size)
    excess = float(np.sum((now.away / sd)[counted] ** 2))
    freedom = _freedom(counted, found.numbers.size)
    # Where uncertainties are not known, what is left over is taken for them.
    scale = 1.0
    if trace.uncertainty is None:
        scale = max(1.0, float(np.sqrt(excess / freedom)))
    sd = sd * scale
    by_bumps = np.asarray(problem.run_bumps(found.numbers).by)
    tips = problem.tips(found.numbers, np.asarray(found.flow.z))
    judged = identify(
        found.numbers,
        (np.asarray(found.flow.by) / (scale * now.sd))[:, now.used],
        (by_bumps / (scale * now.sd))[:, now.used],
        tips[now.used],
        within,
    )
    chi2 = excess / scale**2 / freedom
    high = _high(chi2, freedom)
    if found.drawn:
        high = excess > freedom
    status = _status(problem, found, now, judged, high, sd)
    r = (now.away / sd)[now.used]
    orders = tips[now.used], trace.ts[now.used]
    if status == TraceStatus.FITTED and scale > 1 and _patterned(r, *orders):
        status = TraceStatus.MISFIT
    if status in _UNTRUSTED:  # derivatives at a surface that is not the trace's
        judged = judged._replace(determined=np.zeros_like(judged.determined))
    known = judged, status, sd, tips, excess / scale**2
    return _fit(trace, problem, found, now, counted, *known, odd)


def _counted(now: View, unknowns: int) -> np.ndarray:
    """Samples that chi2 is of: those used, or all where these are too few to judge by."""
    for some in (now.used, now.clear):
        if np.sum(some) > unknowns:
            return some
    return np.ones(now.used.size, dtype=bool)


def _freedom(counted: np.ndarray, unknowns: int) -> int:
    return max(1, int(np.sum(counted)) - unknowns)


def explains(trace: Trace, problem: TraceProblem, found: Descent) -> bool:
    """Whether a descent ended where the surface explains the trace, without doubt.

    From a start at random with no excess at all: where those are needed, wrong surfaces
    nearly explain the trace (1.2, 1.8 and 2.3 deviations of chi2 above what is expected,
    with ten samples in three slips).
    """
    seen = problem.observed()
    now = weigh(seen, found.flow)
    freedom = max(1, int(np.sum(now.used)) - found.numbers.size)
    r = (now.away / seen.sd)[now.used]
    excess = float(r @ r) / freedom
    tips = problem.tips(found.numbers, np.asarray(found.flow.z))[now.used]
    if trace.uncertainty is None:
        patterned = _patterned(r, tips, trace.ts[now.used])
        good = excess <= 1 or not (found.drawn or patterned)
    else:
        allowed = 0 if found.drawn else SETTINGS.doubtful
        good = excess <= 1 + allowed * np.sqrt(2 / freedom)
    return bool(found.converged and good and not now.disputed.any())


def _patterned(r: np.ndarray, *orders: np.ndarray) -> bool:
    """Whether residuals hang together (J. von Neumann's ratio) in any of these orders.

    Along the surface where it is wrong; in time where the sensor drifts, or its zero or its
    clock is off: several slips interleave along the surface, where that looks like noise
    (0.96 to 0.98 of a drift of 10 mN beside noise of 1, in time 0.18).
    """
    limit = 1 - SETTINGS.sigmas / np.sqrt(r.size)
    return any(_neumann_ratio(r[np.argsort(order)]) < limit for order in orders)


def _neumann_ratio(r: np.ndarray) -> float:
    """Mean squared step over twice the mean square: 1 +- 1/sqrt(n) of white noise."""
    return float(np.sum(np.diff(r) ** 2) / (2 * max(float(np.sum(r**2)), 1e-300)))


def _high(chi2: float, freedom: int) -> bool:
    return chi2 > max(SETTINGS.too_much, 1 + SETTINGS.sigmas * np.sqrt(2 / freedom))


def _status(
    problem: TraceProblem,
    found: Descent,
    now: View,
    judged: TraceIdentifiability,
    high: bool,
    sd: np.ndarray,
) -> TraceStatus:
    samples, eps = now.used.size, float(problem.eps)
    disputed = int(np.sum(now.disputed))
    known = (
        (high or np.median(sd) > SETTINGS.no_phase * eps, TraceStatus.MISFIT),
        (disputed > SETTINGS.misfit * samples, TraceStatus.MISFIT),
        (disputed > SETTINGS.disputed * samples, TraceStatus.OTHER_SLIPS),
        (not found.converged, TraceStatus.MAX_STEPS),
        (np.ptp(problem.reading.z) < eps, TraceStatus.NO_SLIDE),
        (judged.share < SETTINGS.little, TraceStatus.UNDETERMINED),
    )
    return next((status for bad, status in known if bad), TraceStatus.FITTED)


def _fit(
    trace, problem, found, now, counted, judged, status, sd, tips, chi2, odd
) -> TraceFit:
    stiffness = problem.reading.support if trace.quantity == "force" else 1.0
    achieved = problem.quantity_of(trace.quantity, found.flow.z)
    waves: Any = np.split(found.numbers, 2)
    return TraceFit(
        profile=Fourier(*waves),
        trace=trace,
        eps=float(problem.eps),
        gamma=float(problem.gamma),
        achieved=achieved,
        residuals=achieved - trace.values,
        deviation=sd * stiffness,
        used=now.used,
        slipping=~now.clear,
        disputed=int(np.sum(now.disputed)),
        tips=tips,
        chi2=chi2,
        degrees_of_freedom=_freedom(counted, found.numbers.size if found.steps else 0),
        status=status,
        history=_history(found.steps),
        identifiability=judged,
        odd=odd,
    )


def _history(steps: list[Step]) -> TraceHistory:
    columns = zip(*steps, strict=True) if steps else [()] * len(Step._fields)
    return TraceHistory(*(np.array(column) for column in columns))


def without_fit(
    trace: Trace, problem: TraceProblem, harmonics: int, status: TraceStatus, odd: str = ""
) -> TraceFit:
    """The result where no surface was looked for, or no start has a trajectory.

    A flat surface: nothing is determined, and no number is NaN.
    """
    count, unknowns = trace.ts.size, 2 * harmonics
    numbers = np.full(unknowns, 1e-300)  # no surface, which a profile cannot be
    z = problem.unheld()[:count]
    none = np.zeros(count, dtype=bool)
    sd = problem.reading.sd
    judged = identify(
        numbers, np.zeros((unknowns, 1)), np.zeros((2 * unknowns, 1)), np.zeros(0), 0.0
    )
    away = z - problem.reading.z
    now = View(away, sd, sd, ~none, none, none, 1.0)
    still: Any = z, np.zeros(count), np.zeros((unknowns, count)), 0
    found = Descent(numbers, Flow(*still), [], False)
    tips = z / float(problem.eps)
    known = judged, status, sd, tips - np.floor(tips), float(np.sum((away / sd) ** 2))
    return _fit(trace, problem, found, now, ~none, *known, odd)
