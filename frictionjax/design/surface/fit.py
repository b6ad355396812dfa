"""A surface that gives the friction one wants: least bending energy at given targets."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from ..._checks import require, require_flags, require_real, require_whole, with_nan
from ..._compile import padded_size, waiting
from ...effects import AbstractEffect, Engine
from ...numerics import stacked
from ..common import (
    AbstractLaw,
    FixedLaw,
    FreeLaw,
    Geometry,
    SceneEffects,
    Target,
    effects_of_scene,
    extreme_slopes,
    free_parameter,
    lean_of,
    require_bounds,
    require_targets,
    with_arrays,
)
from .array_surface import fit_to_array, require_plain
from .barrier import FitShape, FitTask, free_energy
from .exchange import place_of_lowest
from .fallback import room_left
from .flattened import flattened
from .least_bent import least_bent
from .multistart import StartRuns, descended
from .report import report_fit
from .result import ProfileFit
from .settings import SETTINGS
from .starts import places


class SurfaceProblem(NamedTuple):
    """A fit, checked: what was asked for and the task of the program.

    `scale`: of the residuals that the program takes, so that the largest weighs 1. `asked`:
    effects of the scene.
    """

    targets: list[Target]
    law: AbstractLaw
    layout: FitShape
    task: FitTask
    scale: float
    bounds: dict[str, float | None]
    asked: SceneEffects


@with_nan
def fit_profile(
    targets: Any,
    harmonics: int = 16,
    starts: int = 8,
    free: Sequence[str] = (),
    bounds: Mapping[str, Any] | None = None,
    smallest_radius: float | None = None,
    largest_amplitude: float | None = None,
    seed: int = 0,
    max_steps: int = 1000,
    pulling: bool = False,
    effects: Sequence[AbstractEffect] = (),
    progress: bool = False,
) -> ProfileFit:
    """The least bent surface whose friction coefficients are the targets.

    `targets`: a `Target` or several, one surface for all. `harmonics`: of the profile.
    `starts`: optimisations from random surfaces (`seed`), and free parameters, at once, of
    `max_steps` each. `free`: numbers of the bristles that are fitted too, by name, each
    within its `bounds` `{name: (low, high)}`; a bristle in several targets is one bristle.
    Bristles press, alpha > 0, before and after, unless `pulling`, which allows those with
    alpha < 0; a fit does not change the sign. `smallest_radius`: of curvature,
    `1/max |w''|`, and `largest_amplitude`: `max w - min w`, in periods.

    `effects`: of the scene that the coefficients are of. `LeadingOrder` changes none. Of a
    `CompliantArray`, and of a `RigidArray` of tips at one phase, targets are forces of all
    bristles, which are those of one times their number (`friction` of a scene with the
    first tells those of one). Upright tips at different phases, of `Homothetic` and
    `VerticalSpring`, see a sum of slopes, and the least bent surface for that is found:
    see `array_surface`; without `free` and bounds on the surface. With `NapFlip` targets
    are those of the rod as it stands, and `.message` and `.naps` say for which critical
    loads it turns over, and whether for its own.

    Coefficients see only the extreme slopes (Lemmas 2 and 3), so infinitely many surfaces
    fit: this is the one with the least `int_0^1 w''^2`; `.bending_bound` proves how near.
    `.identifiability` and `.family` say what is left open. Where no bound is felt it has a
    closed form, or where a slope is flattened is a least distance, taken in one step; where
    the problem is convex, a start whose optimum is proven stands for the others, which do
    not run.

    Every iterate is admissible (`1 + a omega > 0`, the bristles' own bounds; free bristles
    keep 0.1% from the steepest slopes that they follow) and keeps the other bounds with a
    margin of 0.5%. Where only surfaces nearer to them have the slopes, the least bent of
    those, by exchange over some places of the lowest slope, is one start more: by hand, it
    takes 1 to 3 s at 16 harmonics, 45 at 40.
    Targets that no surface meets come back with the best weighted compromise and a
    `.status` and `.message` that say why.

    `progress`: a line on standard error where it takes more than two seconds.

    Returns a `ProfileFit`: `.profile .bristles .coefficients .bending_energy .residuals`
    (N, shape (targets, 2)) `.success` and more.

    Raises `ValueError` for targets of the wrong sign, shape or kind, weights or
    uncertainties that are not positive, bristles that press on nothing, or pull, names
    and bounds of free parameters that do not fit together, a target asked for by its nap
    whose bounds of an angle reach the other side, and other effects, by name.

    >>> fx.fit_profile(fx.Target(scene.bristle, rho_plus=0.12, rho_minus=-0.05))
    ProfileFit(MET: every target is met)
      bending_energy = 0.123945, largest_error = ..., rank = 2
      rho_plus = 0.12 N (target 0.12), rho_minus = -0.05 N (target -0.05)
    """
    require_flags(pulling=pulling, progress=progress)
    counts = ("harmonics", harmonics), ("starts", starts), ("max_steps", max_steps)
    for name, value in counts:
        require_whole(name, value)
    require_whole("seed", seed, 0)
    given = smallest_radius, largest_amplitude, pulling, effects
    problem = surface_problem(targets, harmonics, free, bounds, *given)
    apart: Any = np.array(places(problem.layout, starts))
    array = problem.asked.apart
    with waiting("fit_profile", progress) as tell:
        if array is None:
            runs, apart = _proven(problem, starts, apart)
        else:
            runs = fit_to_array(problem.layout, problem.task, array, starts)
        if runs is None:
            tell(f"{starts} starts")
            runs = _descended(problem, apart, seed, max_steps)
        tell("what bounds leave room for")
        found = room_left(problem, runs, apart)
        tell("what is left open")
        return report_fit(problem, found)


def _proven(
    problem: SurfaceProblem, starts: int, apart: np.ndarray
) -> tuple[StartRuns | None, np.ndarray]:
    """The optimum in a step, if one is known, and places of each start's lowest slope."""
    known = problem.layout, problem.task, starts
    runs = least_bent(*known)
    if runs is not None:
        return runs, apart
    runs = flattened(*known)
    if runs is None:
        return None, apart
    return runs, np.full(starts, place_of_lowest(runs.settled.waves[0]))


def _descended(problem: SurfaceProblem, apart: Any, seed: int, max_steps: int) -> StartRuns:
    """From random surfaces and free parameters to the optimum of each start."""
    layout, law, starts = problem.layout, problem.law, apart.size
    keys: Any = jax.random.split(jax.random.PRNGKey(seed), starts)
    size = starts, layout.free
    shares: Any = np.random.default_rng(seed).uniform(*SETTINGS.shares, size=size)
    if isinstance(law, FreeLaw):
        shares[0] = np.clip(np.asarray(law.shares()), *SETTINGS.shares)
    kept = padded_size(max_steps, SETTINGS.kept)
    return descended(layout, problem.task, apart, keys, shares, kept, max_steps)


def surface_problem(
    targets: Any,
    harmonics: int = 16,
    free: Sequence[str] = (),
    bounds: Mapping[str, Any] | None = None,
    radius: float | None = None,
    amplitude: float | None = None,
    pulling: bool = False,
    effects: Sequence[AbstractEffect] = (),
) -> SurfaceProblem:
    """The problem, checked, in the units of its targets; see `fit_profile`."""
    asked, known = require_targets(targets, pulling)
    together = effects_of_scene(
        effects, Engine.DESIGN, [target.bristle for target in asked]
    )
    if together.apart is not None:
        require_plain(free, radius, amplitude)
    for name, value in (("smallest_radius", radius), ("largest_amplitude", amplitude)):
        if value is not None:
            require_real(name, value, f"{name} > 0 in periods", lambda v: v > 0)
    law = _law(asked, known, free, bounds, together.times)
    count = len(law.free) if isinstance(law, FreeLaw) else 0
    layout = FitShape(int(harmonics), radius is not None, amplitude is not None, count)
    wanted = np.array([[float(t.rho_plus), float(t.rho_minus)] for t in asked])
    sizes = np.abs(wanted)
    if asked[0].uncertainty is not None:
        sizes = np.array([np.broadcast_to(t.uncertainty, 2) for t in asked], dtype=float)
    weights = np.array([[float(t.weight)] for t in asked])
    factors = np.sqrt(weights) / sizes
    scale = float(np.max(factors * np.abs(wanted)))
    plus, minus = _expected(wanted, _own_geometry(law))
    slope = 0.5 * (plus + minus)
    if radius is not None:
        slope = min(slope, 0.25 / float(radius))
    if amplitude is not None:
        slope = min(slope, harmonics * float(amplitude))
    uneven = max(plus / minus, minus / plus)
    array: Any = np.asarray
    task = FitTask(
        law=law,
        coefficients=array(wanted),
        factors=array(factors / scale),
        curvature=array(np.inf if radius is None else 1 / float(radius) / slope),
        height=array(np.inf if amplitude is None else float(amplitude) / slope),
        slope=array(slope),
        energy=array(free_energy(plus / slope, minus / slope, harmonics)),
        firm=array(SETTINGS.firm * min(uneven, float(harmonics))),
    )
    given = {
        "smallest_radius": None if radius is None else float(radius),
        "largest_amplitude": None if amplitude is None else float(amplitude),
    }
    return SurfaceProblem(asked, law, layout, task, scale, given, together)


def _expected(wanted: np.ndarray, known: Geometry) -> tuple[float, float]:
    """Slopes of about the size asked for, inside what the bristles can follow."""
    plus, minus = extreme_slopes(wanted[:, 0], wanted[:, 1], known.a, known.alpha)
    share, most = SETTINGS.follows, SETTINGS.uneven
    highest, lowest = share * np.min(known.upper), -share * np.max(known.lower)
    mean_plus, mean_minus = (
        float(np.mean(np.minimum(np.where(side > 0, side, np.inf), limit)))
        for side, limit in ((plus, highest), (-minus, lowest))
    )
    finite = [side for side in (mean_plus, mean_minus) if np.isfinite(side)]
    other = max(finite, default=1.0)
    return min(mean_plus, most * other), min(mean_minus, most * other)


def _law(
    targets: list[Target],
    known: list[Geometry],
    free: Sequence[str],
    bounds: Mapping[str, Any] | None,
    times: Any,
) -> FixedLaw | FreeLaw:
    names = _names_of(free)
    meant = "a mapping from names to pairs (low, high)"
    require(bounds is None or isinstance(bounds, Mapping), "bounds", bounds, meant)
    given = dict(bounds or {})
    for name in given:
        require(name in names, "bounds", name, f"names in free = {names}")
    if not names:
        return FixedLaw(stacked([one.of_several(times) for one in known]))
    distinct: list[Any] = []
    which = [_index_of(target.bristle, distinct) for target in targets]
    bristles = tuple(with_arrays(bristle) for bristle in distinct)
    numbers, lows, highs = [], [], []
    for name in names:
        allowed = f"bounds = {{{name!r}: (low, high), ...}}"
        require(name in given, "bounds", ", ".join(given) or "none", allowed)
        for index, number in _numbers_called(name, bristles):
            low, high = _bounds_of(name, number, bristles[index], given[name])
            numbers.append((index, number))
            lows.append(low)
            highs.append(high)
    ends = jnp.asarray(lows), jnp.asarray(highs)
    law = FreeLaw(bristles, tuple(which), tuple(numbers), *ends, times)
    _require_geometry(law, targets)
    return law


def _names_of(free: Any) -> list[str]:
    names = [free] if isinstance(free, str) else free
    words = isinstance(names, list | tuple) and all(isinstance(n, str) for n in names)
    require(words, "free", str(free), "a name or a list of names")
    require(len(set(names)) == len(names), "free", str(free), "every name once")
    return [str(name) for name in names]


def _own_geometry(law: FixedLaw | FreeLaw) -> Geometry:
    """Of the bristles as they are."""
    if isinstance(law, FixedLaw):
        return law.known
    return law.known_at(law.shares())


def _index_of(bristle: Any, distinct: list[Any]) -> int:
    for index, known in enumerate(distinct):
        if known is bristle:
            return index
    distinct.append(bristle)
    return len(distinct) - 1


def _numbers_called(name: str, bristles: tuple) -> list[tuple[int, Any]]:
    found, problem = [], None
    for index, bristle in enumerate(bristles):
        try:
            found.append((index, free_parameter(bristle, name)))
        except ValueError as error:
            problem = error
    if not found and problem is not None:
        raise problem
    return found


def _bounds_of(name: str, number: Any, bristle: Any, given: Any) -> tuple[float, float]:
    label = f"bounds of {name!r}"
    require(given is not None, label, None, "a pair (low, high)")
    require_bounds(number, bristle, given, label)
    low, high = np.clip(np.asarray(given, dtype=float), *number.range_of(bristle)).tolist()
    own = float(number.now(bristle))
    inside = low <= own <= high
    require(inside, label, (low, high), f"low <= {own!r} <= high")
    return low, high


def _require_geometry(law: FreeLaw, targets: list[Target]) -> None:
    """Every free parameter at either end leaves a bristle there is, with its nap.

    Angles alone turn a nap round, so that the ends of each tell.
    """
    own = np.asarray(law.shares())
    naps = {place for place, target in zip(law.which, targets, strict=True) if target.nap}
    for index, (place, number) in enumerate(law.free):
        for end in (0.0, 1.0):
            share = own.copy()
            share[index] = end
            known = law.known_at(jnp.asarray(share))
            good = np.all(np.isfinite(known.a)) and np.all(np.isfinite(known.alpha))
            value = float(law.values(jnp.asarray(share))[index])
            name = f"bounds of {number.name!r}"
            require(good, name, value, "a bristle with that number")
            if place in naps:
                leans = law.bristles[place], law.bristles_at(jnp.asarray(share))[place]
                before, after = map(lean_of, leans)
                needs = "the nap on its side, of a target asked for by it"
                require(before * after > 0, name, value, needs)
