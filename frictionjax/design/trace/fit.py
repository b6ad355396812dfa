"""The surface behind a measured friction trace, through the wiggly dynamics."""

import itertools
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ..._checks import (
    kind_of,
    require,
    require_flags,
    require_real,
    require_whole,
    with_nan,
)
from ..._compile import waiting
from ...effects import Engine
from ...model import Scene, scene_for
from ..measured_trace import Trace
from .flow import Flow
from .gauss_newton import Descent, Programs, Step, gauss_newton, weigh
from .oddities import oddity_of
from .passed import unbounded
from .problem import TraceProblem, trace_problem
from .programs import compiled_beside
from .report import explains, report_trace, without_fit
from .result import TraceFit
from .settings import SETTINGS
from .start import start_numbers
from .status import TraceStatus


@with_nan
def fit_trace(
    trace: Trace,
    scene: Scene,
    eps: Any,
    gamma: Any = 1.0,
    harmonics: int = 8,
    within: Any = 0.1,
    accuracy: Any = 1e-3,
    max_steps: int = 100,
    starts: int = 8,
    progress: bool | Callable[[Step], None] = True,
) -> TraceFit:
    """The surface whose wiggly dynamics give a measured `trace` (a `Trace`).

    `scene`: bristle, support, load and z0 of the measurement; its profile is not used.
    `eps` (m) and `gamma`: of the measurement. `harmonics`: of the profile. `within`: a
    slope w' counts as determined where its standard error is within this share of half
    the range of w'. `accuracy`: of trajectories, in eps; no sample counts as better than
    that. `max_steps`: trajectories of a descent. `starts`: descents at most, until one
    explains the trace: five from starts with weaker and weaker priors, then from the best
    of these with coefficients 30% off at random. Few samples a slip, and all slips at the
    same phases, need those. None is begun after 1.5e6 steps in all, some 10 s. Where the
    uncertainty is not known and noise was taken for motion, all that once or twice more.
    `progress`: a line on standard error where it takes more than two seconds, or a
    function that is told every iterate instead.

    A trace in another unit, with the other sign, drowned in noise or of another load is
    told from its energy alone, in a moment, and no surface is looked for: a tip that moves
    on by a well has lost energy on any surface (`.status`, `.message`). So are samples far
    beyond all others (mask them: `numpy.ma`), a start that is not the scene's z0, as of
    an offset, and the load itself in place of the force.

    While the tip is not in a slip the equation itself shows the wiggle force: a robust
    fit of V_eps'(z) = l - Phi'(z) - eps^gamma z' (eq. 2.8) at the samples is the start.
    Then Levenberg and Marquardt's method through the trajectory from z0 and its
    derivatives, every slip integrated. Samples inside slips are left out. Directions that
    the trace leaves open follow a weak prior (little bending); what is reported as
    determined does not depend on it: `.identifiability`.

    The zeros of force and clock are taken as known, and errors hold for them: an offset is
    for the most part a shift of the surface, which residuals hardly show. So is the
    bristle: another one may explain the trace as well, with other slopes. Where the
    uncertainty is not known, residuals that hang together along the surface, or in time, as
    of a sensor that drifts, are a misfit. Little drift may pass: of one that comes to 0.5%
    of rho_plus - rho_minus at the end, with 0.5% noise and 801 samples, 2 of 6 fits were
    FITTED, slopes up to 8 stated errors off, 0.006 of 0.14; three times that drift never
    was (by hand).

    Errors are linearised. At gamma = 0.5 with samples next to slips they are too small in
    some fits: of 14, three had a slope more than 3 errors off, at most 4.4. At gamma from
    0.8 to 2, 95% intervals held 98 to 100% (by hand).

    Returns a `TraceFit`: `.profile .achieved .residuals` (N or m, shape (n,)) `.status` and
    more.

    Raises `ValueError` for a scene without profile and bristle, times outside
    [0, duration], forces that the support cannot have, and numbers out of range.

    >>> trace = fx.simulate_trace(scene, eps=0.1, noise=0.001)
    >>> fx.fit_trace(trace, scene, eps=0.1, harmonics=2, progress=False)
    TraceFit(FITTED: the surface explains the trace; slopes determined at y in [0.000, ...
      301 of 301 samples used, 0 in slips, 0 in other wells; reduced chi2 = 1.03, 8 steps
    """
    scene = scene_for(Engine.TRACE, scene)
    known = isinstance(trace, Trace)
    require(known, "trace", kind_of(trace), "a Trace")
    require_whole("harmonics", harmonics)
    require_whole("max_steps", max_steps)
    require_whole("starts", starts)
    if not callable(progress):
        require_flags(progress=progress)
    for name, value in (("eps", eps), ("gamma", gamma), ("within", within)):
        require_real(name, value, f"{name} > 0", lambda v: v > 0)
    allowed = "1e-8 <= accuracy <= 0.1"
    require_real("accuracy", accuracy, allowed, lambda v: 1e-8 <= v <= 0.1)
    problem = trace_problem(trace, scene, float(eps), float(gamma), harmonics, accuracy)
    with waiting("fit_trace", progress is True) as tell:
        odd = oddity_of(trace, problem)
        if odd is not None:
            return without_fit(trace, problem, harmonics, *odd)
        tell("compiling, and starts")
        heard = _listener(progress, tell)
        with compiled_beside(problem) as ready:
            found, left = _descent(trace, problem, starts, max_steps, heard, ready)
        for _ in range(SETTINGS.again if trace.uncertainty is None else 0):
            louder = None if found is None else _louder(problem, found)
            if louder is None:
                break
            problem = louder
            found, left = _descent(trace, problem, starts, max_steps, heard)
        if found is None:
            return without_fit(trace, problem, harmonics, TraceStatus.NOT_FINITE)
        tell("what is determined")
        return report_trace(trace, problem, found, float(within), left)


def _listener(progress: Any, tell: Callable[[str], None]) -> Callable[[Step], None]:
    """Who is told every iterate: the user's function, or the line on standard error."""
    if callable(progress):
        return progress
    count = itertools.count(1)

    def heard(step: Step) -> None:
        known = f"{step.used} samples used, {step.disputed} in other wells"
        tell(f"iterate {next(count)}, {known}")

    return heard


def _descent(
    trace: Trace,
    problem: TraceProblem,
    starts: int,
    most: int,
    progress: Callable,
    ready: Callable[[], object] = lambda: None,
) -> tuple[Descent | None, str]:
    """The best of the descents, None where no start has a trajectory, and what was left.

    One after the other, until one explains the trace. `ready()`: waits for the program.
    """
    best: Descent | None = None
    work = _Work(problem)
    known = _starts(problem, ready)
    every = itertools.islice(itertools.chain(known, _drawn(problem, known)), starts)
    for index, (held, numbers, flow) in enumerate(every):
        if work.steps > SETTINGS.work:
            return best, f"tried {index} of {starts} starts, after {work.steps:.1e} steps"
        programs = Programs(work.run, problem.read, problem.admissible, held)
        found = gauss_newton(problem.observed(), numbers, flow, programs, most, progress)
        found = found._replace(drawn=index >= len(known))
        if explains(trace, problem, found):
            return found, ""
        if best is None or found.steps[-1].objective < best.steps[-1].objective:
            best = found
    return best, ""


def _louder(problem: TraceProblem, found: Descent) -> TraceProblem | None:
    """The problem with the noise that a fit leaves, where less of it bounds the surface.

    Noise to and fro is a passage to who does not know it: of 10 surfaces fitted so at a
    noise of 0.02 and 0.06 eps, 6 had slopes 4 to 9 standard errors off. (The scatter of
    neighbours is known before any fit, but holds slips: 0.4 eps of a loop of 160 samples
    without noise, which would leave it none of 1193 places.) What a fit leaves that has
    samples in other wells is no noise: more starts are needed there, not weaker bounds.
    """
    now = weigh(problem.observed(), found.flow)
    scale = now.scale
    placed = np.sum(now.disputed) <= SETTINGS.disputed * now.used.size
    louder = placed and scale > SETTINGS.louder * problem.noise
    bound = louder and problem.held(found.numbers)[0].any()
    return problem.with_noise(scale) if bound else None


class _Work:
    """Trajectories of a problem, and the steps of all of them."""

    def __init__(self, problem: TraceProblem):
        self._problem, self.steps = problem, 0

    def run(self, numbers: np.ndarray) -> Flow:
        """`Problem.run`, counted."""
        found = self._problem.run(numbers)
        self.steps += int(found.steps)
        return found


def _starts(problem: TraceProblem, ready: Callable[[], object]) -> list[tuple]:
    """Bounds, coefficients and trajectories of the starts, nearest to the samples first.

    The last, without bounds from passages, is for surfaces on which these bend the way.
    """
    begun, known = [], []
    zero = np.zeros(problem.penalty.size)
    bounded_starts = [(True, size) for size in SETTINGS.priors]
    for bounded, factor in [*bounded_starts, (False, SETTINGS.unbounded_prior)]:
        held = problem.held if bounded else unbounded
        parts = problem.rough, problem.scene, problem.eps
        penalty = factor * problem.penalty
        numbers = start_numbers(*parts, zero, penalty, problem.admissible, held)
        begun.append((bounded, held, numbers))
    ready()
    for bounded, held, numbers in begun:
        found = problem.run(numbers)
        edge = SETTINGS.well * float(problem.eps)
        off = np.minimum(np.abs(found.z - problem.reading.z), edge)
        known.append((not bounded, float(np.mean(off)), held, numbers, found))
    known = sorted((k for k in known if np.isfinite(k[1])), key=lambda k: k[:2])
    return [k[2:] for k in known]


def _drawn(problem: TraceProblem, known: list[tuple]) -> Iterator[tuple]:
    """Starts at random about the best of those known."""
    rng = np.random.default_rng(0)
    for held, best, _ in known[:1]:
        for _ in range(SETTINGS.tries):
            numbers = best * (1 + SETTINGS.spread * rng.normal(size=best.size))
            if not problem.admissible(numbers):
                continue
            found = problem.run(numbers)
            if np.all(np.isfinite(found.z)):
                yield held, numbers, found
