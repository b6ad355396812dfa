"""Damped Gauss-Newton through the dynamics, for traces with slips in them."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .flow import Flow
from .settings import SETTINGS
from .start import Read


class TraceSamples(NamedTuple):
    """Samples as the descent sees them: `z` and `sd` in m, (n,); eps in m.

    `sliding`: fastest speed of a slide without wiggles, m/s. `penalty`: of each squared
    coefficient.
    """

    z: np.ndarray
    sd: np.ndarray
    eps: float
    sliding: float
    penalty: np.ndarray


class Programs(NamedTuple):
    """Functions of the coefficients: trajectory, equation at the samples, admissibility."""

    run: Callable[[np.ndarray], Flow]
    read: Callable[[np.ndarray], Read]
    admissible: Callable[[np.ndarray], bool]
    held: Callable[[np.ndarray, float], tuple[np.ndarray, np.ndarray]]


class Step(NamedTuple):
    """One iterate: `objective` per sample, robust; the rest as in `TraceHistory`."""

    objective: float
    chi2: float
    used: int
    slipping: int
    disputed: int
    damping: float
    blur: float


class Descent(NamedTuple):
    """Where a descent ended, with every iterate on the way.

    `drawn`: from a start at random.
    """

    numbers: np.ndarray
    flow: Flow
    steps: list[Step]
    converged: bool
    drawn: bool = False


class View(NamedTuple):
    """How far `away` z is at one iterate, in m, and which samples count.

    `clear`: not inside a slip. `used`: of those, in the right well. `disputed`: the others
    of those. `blurred`: deviation of z in m; `sd`: larger the faster z moves. `scale`:
    robust, 1 or more.
    """

    away: np.ndarray
    sd: np.ndarray
    blurred: np.ndarray
    clear: np.ndarray
    used: np.ndarray
    disputed: np.ndarray
    scale: float


def weigh(seen: TraceSamples, flow: Flow, blur: float = 0.0) -> View:
    """Look at the samples from one iterate.

    A sample that the model has inside a slip says when it slips, to within the clock,
    and nothing of the surface: it counts little, and not at all in the result. `blur`: in
    eps, added to the samples' own deviations.
    """
    away = np.asarray(flow.z) - seen.z
    pace = np.abs(np.asarray(flow.speed)) / seen.sliding
    # Smooth: with a sharp end at 10 samples went in and out for ever.
    blurred = np.hypot(seen.sd, blur * seen.eps)
    sd = blurred * (1 + (pace / SETTINGS.fast) ** 4)
    clear = pace < SETTINGS.fast
    used = clear & (np.abs(away) < SETTINGS.well * seen.eps)
    scale = 1.0
    if used.any():
        scale = max(scale, 1.5 * float(np.median(np.abs(away / sd)[used])))
    return View(away, sd, blurred, clear, used, clear & ~used, scale)


def _huber(r: np.ndarray) -> np.ndarray:
    size, cut = np.abs(r), SETTINGS.linear
    return np.where(size < cut, size**2, cut * (2 * size - cut))


def _weights(r: np.ndarray) -> np.ndarray:
    return SETTINGS.linear / np.maximum(np.abs(r), SETTINGS.linear)


def _objective(
    seen: TraceSamples,
    now: View,
    flow: Flow,
    read: Read,
    force_sd: np.ndarray,
    numbers,
    over,
) -> float:
    """Of another iterate, with the weights of this one.

    Samples in another well cost as much as one at its edge, and what the equation at the
    measured state costs: that has a slope where the trajectory has none (with a constant
    alone 2 of the first 4 trials ended in a wrong optimum).
    """
    away = np.abs(np.asarray(flow.z) - seen.z)
    if not np.all(np.isfinite(away)):
        return np.inf
    edge = SETTINGS.well * seen.eps
    costs = _huber(np.minimum(away, edge) / now.sd / now.scale)
    costs = costs + np.where(away > edge, _huber(read.r / force_sd / now.scale), 0.0)
    return float(np.sum(costs) + np.sum(seen.penalty * numbers**2) + np.sum(_huber(over)))


def _equations(seen: TraceSamples, now: View, flow: Flow, read: Read, numbers, over):
    """Gauss-Newton's matrix and slope: trajectory in the right well, equation elsewhere."""
    inside = np.abs(now.away) <= SETTINGS.well * seen.eps
    force_sd = read.deviation(now.blurred)
    r = np.where(inside, now.away / now.sd, read.r / force_sd) / now.scale
    by = np.where(inside, np.asarray(flow.by) / now.sd, read.by.T / force_sd)
    rows = by / now.scale
    weighted = rows * _weights(r)
    excess, by_excess = over
    steep = by_excess.T * _weights(excess)
    normal = weighted @ rows.T + np.diag(seen.penalty) + steep @ by_excess
    return normal, weighted @ r + seen.penalty * numbers + steep @ excess


def gauss_newton(
    seen: TraceSamples,
    numbers: np.ndarray,
    flow: Flow,
    programs: Programs,
    most: int,
    progress: Callable[[Step], None],
) -> Descent:
    """Levenberg and Marquardt's method from `numbers` with the trajectory `flow`.

    In rounds: with samples blurred, which brings slips to their places, and at last
    without. `most`: trajectories computed.
    """
    steps: list[Step] = []
    converged, read = False, programs.read(numbers)
    for blur, enough in zip(SETTINGS.blurs, SETTINGS.enough, strict=True):
        damping, growth, best, since = SETTINGS.damping, 2.0, np.inf, 0
        converged = False
        while not converged and len(steps) < most:
            now = weigh(seen, flow, blur)
            force_sd = read.deviation(now.blurred)
            rough = max(blur, SETTINGS.held)
            over = programs.held(numbers, rough)
            before = _objective(seen, now, flow, read, force_sd, numbers, over[0])
            steps.append(_step(seen, now, before, damping, blur))
            progress(steps[-1])
            since = 0 if before < best - enough else since + 1
            best = min(best, before)
            normal, slope = _equations(seen, now, flow, read, numbers, over)
            change = -np.linalg.solve(normal + damping * np.diag(np.diag(normal)), slope)
            promised = -float(change @ slope + 0.5 * change @ normal @ change) * 2
            trial, after = numbers + change, np.inf
            if programs.admissible(trial):
                tried, tried_read = programs.run(trial), programs.read(trial)
                far = programs.held(trial, rough)[0]
                after = _objective(seen, now, tried, tried_read, force_sd, trial, far)
            gain = (before - after) / max(promised, 1e-300)
            if after < before:
                numbers, flow, read = trial, tried, tried_read
                damping *= max(0.1, 1 - (2 * gain - 1) ** 3)
                damping = max(damping, SETTINGS.least_damping)
                growth = 2.0
                converged = before - after < enough
            else:
                converged = promised < enough or damping >= SETTINGS.most_damping
                damping, growth = min(damping * growth, SETTINGS.most_damping), 2 * growth
            converged = converged or since >= SETTINGS.patience
    now = weigh(seen, flow)
    over = programs.held(numbers, SETTINGS.held)
    last = _objective(seen, now, flow, read, read.deviation(seen.sd), numbers, over[0])
    steps.append(_step(seen, now, last, damping, 0.0))
    return Descent(numbers, flow, steps, converged)


def _step(seen: TraceSamples, now: View, objective: float, damping: float, blur: float):
    used = now.used
    chi2 = float(np.mean((now.away / now.sd)[used] ** 2)) if used.any() else np.inf
    counts = int(np.sum(used)), int(np.sum(~now.clear)), int(np.sum(now.disputed))
    return Step(objective / seen.z.size, chi2, *counts, damping, blur)
