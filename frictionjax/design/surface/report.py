"""From what the program computed to what the user is told."""

import dataclasses
from functools import partial
from typing import Any

import jax.numpy as jnp
import numpy as np

from ..._checks import as_text
from ..._compile import Program
from ...profiles import Fourier
from ..common import FreeLaw, coefficients_in_scene
from .array_surface import ratio_seen
from .barrier import SETTINGS as BARRIER_SETTINGS
from .barrier import bending_energy, heights_of_waves
from .fallback import RoomLeft, slopes_wanted
from .history import History, Start
from .multistart import StartRuns, best_first, targets_met
from .open_directions import identifiability
from .reachable import (
    followed,
    limits_of,
    reachable_text,
    share_text,
    slopes_asked,
)
from .result import ProfileFit
from .settings import SETTINGS
from .status import ProfileStatus


def report_fit(problem: Any, found: RoomLeft) -> ProfileFit:
    """The result of the best start; see `ProfileFit`."""
    task, (runs, places, share) = problem.task, found
    slope = float(task.slope)
    losses, energies, order = best_first(runs, slope, problem.scale)
    best = int(order[0])
    profile = Fourier(*_series(runs.settled.waves[best], np.asarray(task.slope)))
    cos: Any = np.asarray(profile.cos)
    sin: Any = np.asarray(profile.sin)
    free = runs.settled.free[best]
    bristles = _bristles(problem, free)
    # They are computed while the starts are listed.
    laws = tuple(coefficients_in_scene(problem.asked, profile, b) for b in bristles)
    wanted = np.asarray(task.coefficients)
    met = targets_met(task, runs.settled.residuals)
    # Of free bristles each start asks for other slopes: the share is the best one's.
    shares = [None if problem.layout.free else share] * order.size
    shares[best] = share
    statuses = [
        _status(problem, runs, i, losses[i], met[i], shares[i]) for i in range(order.size)
    ]
    status = statuses[best]
    starts = tuple(
        _start(problem, runs, int(i), statuses[i], losses[i], energies[i], places[i])
        for i in order
    )
    history = _history(problem, runs)
    reached = np.array([[float(c.rho_plus), float(c.rho_minus)] for c in laws])
    why = _message(problem, found, best, status, reached, losses[best])
    fit = ProfileFit(
        profile=profile,
        bristles=bristles,
        coefficients=laws,
        targets=wanted,
        bending_energy=bending_energy(cos, sin),
        bending_bound=slope**2 * max(0.0, float(runs.bound[best])),
        residuals=reached - wanted,
        largest_error=float(np.max(np.abs(reached / wanted - 1))),
        chi2=float(losses[best]),
        degrees_of_freedom=_freedom(problem),
        misfit=float(np.sqrt(losses[best] / wanted.size)),
        status=status,
        why=why,
        starts=starts,
        history=history,
        identify=partial(identifiability, task.law, cos, sin, free, problem.asked.apart),
        free=_free_values(problem, free),
        bounds=problem.bounds,
        effects=problem.asked.effects,
    )
    if problem.asked.nap_flip is None:
        return fit
    turns = dict.fromkeys(known.message for known in fit.naps)
    return dataclasses.replace(fit, why="; ".join([why, *turns]))


@Program
def _series(waves: Any, slope: Any) -> tuple[Any, Any]:
    """Compiled: NumPy arrays become JAX arrays in 30 us so, by `asarray` in 70."""
    cos, sin = heights_of_waves(waves)
    return _unsigned(slope * cos), _unsigned(slope * sin)


def _unsigned(values: Any) -> Any:
    """Zeros without a sign: -0.0 in a file looks as if it meant something."""
    return jnp.where(values == 0, 0.0, values)


def _bristles(problem: Any, free: Any) -> tuple:
    if not isinstance(problem.law, FreeLaw):
        return tuple(target.bristle for target in problem.targets)
    bristles = problem.law.bristles_at(free)
    return tuple(bristles[index] for index in problem.law.which)


def _free_values(problem: Any, free: Any) -> dict[str, float]:
    """By name; with the bristle's index in front where several have it."""
    if not isinstance(problem.law, FreeLaw):
        return {}
    values = np.asarray(problem.law.values(free))
    names = [number.name for _, number in problem.law.free]
    labels = [
        name if names.count(name) == 1 else f"bristles[{index}].{name}"
        for (index, _), name in zip(problem.law.free, names, strict=True)
    ]
    return dict(zip(labels, map(float, values), strict=True))


def _status(
    problem: Any, runs: StartRuns, index: int, loss: float, met: bool, share: float | None
) -> ProfileStatus:
    if not np.isfinite(loss):
        return ProfileStatus.NOT_FINITE
    if not bool(runs.path.done[index]):
        return ProfileStatus.MAX_STEPS
    if not bool(runs.settled.met[index]):
        return _bound_reached(problem, runs, index, share)
    if met:
        return ProfileStatus.MET
    given = problem.targets[0].uncertainty is not None
    if given and loss <= _likely(_freedom(problem)):
        return ProfileStatus.WITHIN_UNCERTAINTY
    return ProfileStatus.CONTRADICTORY


def _freedom(problem: Any) -> int:
    """Residuals that two slopes and the free parameters leave."""
    return max(0, problem.task.coefficients.size - 2 - problem.layout.free)


def _likely(freedom: int) -> float:
    from scipy.stats import chi2  # 0.5 s, for targets with uncertainties only

    return float(chi2.ppf(SETTINGS.sure, max(freedom, 1)))


def _bound_reached(
    problem: Any, runs: StartRuns, index: int, share: float | None
) -> ProfileStatus:
    room = {name: float(values[index]) for name, values in runs.room.items()}
    fixed = not problem.layout.free
    if fixed and not followed(problem.law.known, _asked(problem, runs, index)):
        return ProfileStatus.INADMISSIBLE
    if room["slopes"] < SETTINGS.near + BARRIER_SETTINGS.edge:
        return ProfileStatus.INADMISSIBLE
    if share is None or share < 1:
        felt = _bound_felt(room, share)
        if felt is not None:
            return felt
    wanted = np.asarray(runs.settled.wanted[index])
    if fixed and len(problem.targets) == 1:  # a run may end far from what is asked
        wanted = np.abs(_asked(problem, runs, index)[0])
    if _within(wanted, _most(problem)):
        out = not fixed and (share is None or share < 1)
        return ProfileStatus.OUT_OF_BOUNDS if out else ProfileStatus.NOT_FOUND
    return ProfileStatus.TOO_FEW_HARMONICS


def _bound_felt(room: dict[str, float], share: float | None) -> ProfileStatus | None:
    """The bound on the surface that a start came to; one of them where `share` < 1."""
    margin = 1 - BARRIER_SETTINGS.row_margin + SETTINGS.near
    if room.get("curvature", 1.0) < margin:
        return ProfileStatus.TOO_SHARP
    if room.get("height", 1.0) < margin:
        return ProfileStatus.TOO_HIGH
    if share is None:
        return None
    high = room.get("height", np.inf) < room.get("curvature", np.inf)
    return ProfileStatus.TOO_HIGH if high else ProfileStatus.TOO_SHARP


def _within(wanted: np.ndarray, most: float) -> bool:
    return bool(np.all(wanted > 0) and np.max(wanted / wanted[::-1]) < most)


def _most(problem: Any) -> float:
    """The largest ratio of slopes that this many harmonics have."""
    layout, apart = problem.layout, problem.asked.apart
    return layout.harmonics if apart is None else ratio_seen(apart, layout.harmonics)


def _message(
    problem: Any,
    found: RoomLeft,
    best: int,
    status: ProfileStatus,
    reached: Any,
    loss: float,
) -> str:
    if status == ProfileStatus.MET:
        return status.message
    nearest = "; ".join(
        f"rho_plus = {as_text(row[0])} N, rho_minus = {as_text(row[1])} N"
        for row in reached
    )
    if status in (ProfileStatus.CONTRADICTORY, ProfileStatus.WITHIN_UNCERTAINTY):
        misfit = np.sqrt(loss / reached.size)
        unit = "uncertainties" if problem.targets[0].uncertainty is not None else "targets"
        return f"{status.message}; rms residual {misfit:.3g} of the {unit}: {nearest}"
    if status in (ProfileStatus.MAX_STEPS, ProfileStatus.NOT_FINITE):
        return status.message
    return f"{status.message}; {_reachable(problem, found, best)}; nearest: {nearest}"


def _asked(problem: Any, runs: StartRuns, index: int) -> np.ndarray:
    """Slopes that the targets ask of their bristles as a start found them."""
    known = problem.law.known_at(runs.settled.free[index])
    return slopes_asked(known, np.asarray(problem.task.coefficients))


def _reachable(problem: Any, found: RoomLeft, best: int) -> str:
    task, layout, runs = problem.task, problem.layout, found.runs
    asked = _asked(problem, runs, best)
    within = ""
    if found.share is not None and found.share < 1:
        slopes = slopes_wanted(problem, runs, best)
        within = "" if slopes is None else share_text(found.share, slopes)
    limits = limits_of(task.law, runs.settled.free[best])
    return reachable_text(limits, layout.harmonics, asked, within, as_text(_most(problem)))


def _start(
    problem: Any,
    runs: StartRuns,
    index: int,
    status: ProfileStatus,
    loss: float,
    energy: float,
    place: float,
) -> Start:
    values = _free_values(problem, runs.settled.free[index])
    ran = bool(runs.ran[index])
    return Start(
        number=index,
        status=status,
        loss=float(loss),
        bending_energy=float(energy),
        place=float(place),
        steps=int(runs.path.steps[index]) if ran else 0,
        free=tuple(values.values()),
        ran=ran,
    )


def _history(problem: Any, runs: StartRuns) -> History:
    slope, layout = float(problem.task.slope), problem.layout
    x: Any = np.asarray(runs.path.x)[:, : int(np.max(np.asarray(runs.path.steps)))]
    first = 2 * layout.harmonics
    cos, sin = heights_of_waves(x[..., :first])
    steps = x.shape[1]
    free = x[..., x.shape[-1] - layout.free :]
    if isinstance(problem.law, FreeLaw):
        low, high = np.asarray(problem.law.low), np.asarray(problem.law.high)
        free = low + (high - low) * free
    rows = History(
        loss=problem.scale**2 * np.asarray(runs.misfit)[:, :steps],
        bending_energy=slope**2 * np.sum(x[..., :first] ** 2, axis=-1),
        barrier=np.asarray(runs.path.weight)[:, :steps],
        decrement=np.asarray(runs.path.decrement)[:, :steps],
        omega_plus=slope * x[..., first + 1],
        omega_minus=-slope * x[..., first + 3],
        cos=slope * np.asarray(cos),
        sin=slope * np.asarray(sin),
        free=free,
    )
    run = np.asarray(runs.ran)
    return rows if run.all() else History._make(_of_starts(run, row) for row in rows)


def _of_starts(run: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """The rows of starts that were run, NaN for others."""
    return np.where(run.reshape(-1, *(1,) * (rows.ndim - 1)), rows, np.nan)
