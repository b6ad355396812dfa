"""The surface behind a measured friction trace, through the wiggly dynamics."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ..arguments import require, require_real, require_x64
from ..scene import Scene
from .trace import Trace
from .trace_descent import Descent, Programs, Step, descend
from .trace_passage import unbounded
from .trace_problem import Problem, problem_of
from .trace_report import explains, report, without_trajectory
from .trace_result import TraceFit
from .trace_start import start

# Starts: bounded by passages or not, and the size of the prior. Of 10 surfaces at 3e-4 N
# the bounded ones do for 9, and the last for the one left over.
_STARTS = ((True, 10.0), (True, 1.0), (True, 0.1), (True, 0.01), (False, 0.01))


def fit_trace(
    trace: Trace,
    scene: Scene,
    eps: Any,
    gamma: Any = 1.0,
    harmonics: int = 8,
    within: Any = 0.1,
    accuracy: Any = 1e-3,
    max_steps: int = 100,
    starts: int = 5,
    progress: Callable[[Step], None] = lambda step: None,
) -> TraceFit:
    """The surface whose wiggly dynamics give a measured trace.

    `scene`: bristle, support, load and z0 of the measurement; its profile is not used.
    `eps` (m) and `gamma`: of the measurement. `harmonics`: of the profile. `within`: a
    slope w' counts as determined where its standard error is within this share of half
    the range of w'. `accuracy`: of trajectories, in eps; no sample counts as better than
    that. `max_steps`: trajectories of a descent. `starts`: descents at most, 1 to 5, from
    starts with weaker and weaker priors, until one explains the trace. `progress(step)`:
    told every iterate.

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
    few = isinstance(starts, int) and not isinstance(starts, bool)
    most = len(_STARTS)
    require(few and 1 <= starts <= most, "starts", starts, f"a whole number, 1 to {most}")
    for name, value in (("eps", eps), ("gamma", gamma), ("within", within)):
        require_real(name, value, f"{name} > 0", lambda v: v > 0)
    allowed = "1e-8 <= accuracy <= 0.1"
    require_real("accuracy", accuracy, allowed, lambda v: 1e-8 <= v <= 0.1)
    problem = problem_of(trace, scene, float(eps), float(gamma), harmonics, accuracy)
    found = _descent(trace, problem, starts, max_steps, progress)
    if found is None:
        return without_trajectory(trace, problem, harmonics)
    return report(trace, problem, found, float(within))


def _descent(
    trace: Trace, problem: Problem, starts: int, most: int, progress: Callable
) -> Descent | None:
    """The best of the descents; None where no start has a trajectory.

    One after the other, until one explains the trace: descents end in that optimum or far
    from it.
    """
    best: Descent | None = None
    for held, numbers, flow in _starts(problem)[:starts]:
        programs = Programs(problem.run, problem.read, problem.admissible, held)
        found = descend(problem.observed(), numbers, flow, programs, most, progress)
        if explains(trace, problem, found):
            return found
        if best is None or found.steps[-1].objective < best.steps[-1].objective:
            best = found
    return best


def _starts(problem: Problem) -> list[tuple]:
    """Bounds, coefficients and trajectories of the starts, nearest to the samples first.

    The last, without bounds from passages, is for surfaces on which these bend the way.
    """
    known = []
    zero = np.zeros(problem.penalty.size)
    for bounded, factor in _STARTS:
        held = problem.held if bounded else unbounded
        parts = problem.rough, problem.scene, problem.eps
        penalty = factor * problem.penalty
        numbers = start(*parts, zero, penalty, problem.admissible, held)
        found = problem.run(numbers)
        off = np.minimum(np.abs(found.z - problem.reading.z), 0.25 * float(problem.eps))
        known.append((not bounded, float(np.mean(off)), held, numbers, found))
    known = sorted((k for k in known if np.isfinite(k[1])), key=lambda k: k[:2])
    return [k[2:] for k in known]
