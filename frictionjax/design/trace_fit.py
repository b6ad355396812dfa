"""The surface behind a measured friction trace, through the wiggly dynamics."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ..arguments import require, require_real, require_x64
from ..scene import Scene
from .trace import Trace
from .trace_descent import Descent, Observed, Programs, Step, descend
from .trace_problem import Problem, problem_of
from .trace_report import report, without_trajectory
from .trace_result import TraceFit
from .trace_start import start

_PENALTIES = (10.0, 1.0, 0.1)  # of starts, the best of which goes on


def fit_trace(
    trace: Trace,
    scene: Scene,
    eps: Any,
    gamma: Any = 1.0,
    harmonics: int = 8,
    within: Any = 0.1,
    accuracy: Any = 1e-3,
    max_steps: int = 100,
    progress: Callable[[Step], None] = lambda step: None,
) -> TraceFit:
    """The surface whose wiggly dynamics give a measured trace.

    `scene`: bristle, support, load and z0 of the measurement; its profile is not used.
    `eps` (m) and `gamma`: of the measurement. `harmonics`: of the profile. `within`: a
    slope w' counts as determined where its standard error is within this share of half
    the range of w'. `accuracy`: of trajectories, in eps; no sample counts as better than
    that. `max_steps`: trajectories computed. `progress(step)`: told every iterate.

    While the tip is not in a slip the equation itself shows the wiggle force: a robust
    fit of V_eps'(z) = l - Phi'(z) - eps^gamma z' (eq. 2.7) at the samples is the start.
    Then Levenberg and Marquardt's method through the trajectory from z0 and its
    derivatives, every slip integrated. Samples inside slips are left out. Directions that
    the trace leaves open follow a weak prior (little bending); what is reported as
    determined does not depend on it: `.identifiability`.

    Raises `ValueError` for a scene without profile and bristle, times outside
    [0, duration], forces that the support cannot have, and numbers out of range.
    """
    require_x64(scene)
    known = isinstance(trace, Trace)
    require(known, "trace", type(trace).__name__, "a Trace")
    whole = isinstance(harmonics, int) and not isinstance(harmonics, bool)
    require(whole and harmonics >= 1, "harmonics", harmonics, "a whole number >= 1")
    steps = isinstance(max_steps, int) and not isinstance(max_steps, bool)
    require(steps and max_steps >= 1, "max_steps", max_steps, "a whole number >= 1")
    for name, value in (("eps", eps), ("gamma", gamma), ("within", within)):
        require_real(name, value, f"{name} > 0", lambda v: v > 0)
    allowed = "1e-8 <= accuracy <= 0.1"
    require_real("accuracy", accuracy, allowed, lambda v: 1e-8 <= v <= 0.1)
    problem = problem_of(trace, scene, float(eps), float(gamma), harmonics, accuracy)
    found = _descent(problem, problem.observed(), harmonics, max_steps, progress)
    if found is None:
        return without_trajectory(trace, problem, harmonics)
    return report(trace, problem, found, float(within))


def _descent(problem: Problem, seen: Observed, harmonics, most, progress) -> Descent | None:
    """The best start, and the descent from it; None where no start has a trajectory."""
    best: tuple | None = None
    zero = np.zeros(2 * harmonics)
    for factor in _PENALTIES:
        penalty = factor * problem.penalty
        parts = problem.rough, problem.scene, problem.eps
        numbers = start(*parts, zero, penalty, problem.admissible)
        found = problem.run(numbers)
        off = np.minimum(np.abs(found.z - seen.z), 0.25 * seen.eps)
        loss = float(np.mean(off))
        if np.isfinite(loss) and (best is None or loss < best[0]):
            best = loss, numbers, found
    if best is None:
        return None
    programs = Programs(problem.run, problem.read, problem.admissible)
    return descend(seen, best[1], best[2], programs, most, progress)
