"""What bounds on the surface leave room for, where no start of the search meets them.

A barrier keeps a margin, and its starts look at few places of the lowest slope.
"""

from typing import Any, NamedTuple

import jax
import numpy as np

from ..common import coefficients_of
from .barrier import SETTINGS as BARRIER_SETTINGS
from .barrier import Iterates, Reach, Settled
from .exchange import (
    BentSurface,
    SurfaceBounds,
    extrema,
    least_bent_seen,
    least_bent_within,
    place_of_lowest,
    plain_slopes,
    steepest_surface,
    with_ends_seen,
)
from .multistart import StartRuns, best_first
from .reachable import followed, slopes_asked
from .settings import SETTINGS


class RoomLeft(NamedTuple):
    """All starts, one more where a surface was found, and places of their lowest slopes.

    `share` of the slopes asked for that surfaces within the bounds have, 1 where they have
    all; None where that is not known.
    """

    runs: StartRuns
    places: np.ndarray
    share: float | None


def room_left(problem: Any, runs: StartRuns, places: np.ndarray) -> RoomLeft:
    """Looks for the least bent surface itself where none of the starts meets the targets.

    Where there is none either, for the steepest.
    """
    met = np.any(runs.settled.met)
    layout = problem.layout
    *_, order = best_first(runs, float(problem.task.slope), problem.scale)
    best = int(order[0])
    if met and not (layout.sharp or layout.high) and problem.asked.apart is None:
        runs, places = _less_bent(problem, runs, places, best)
    if met or not (layout.sharp or layout.high):
        return RoomLeft(runs, places, 1.0 if met and not layout.free else None)
    slopes = slopes_wanted(problem, runs, best)
    uneven = 1.0 if slopes is None else float(np.max(slopes / slopes[::-1]))
    if slopes is None or not uneven < layout.harmonics or not np.any(runs.path.done):
        return RoomLeft(runs, places, None)
    bounds = _bounds(problem, slopes)
    found, share = _surface_within(bounds)
    row = None if found is None else _row(problem, runs, best, bounds, found)
    if found is None or row is None:
        return RoomLeft(runs, places, share)
    return RoomLeft(*_with_row(runs, places, row, found.place), share)


def _with_row(
    runs: StartRuns, places: np.ndarray, row: StartRuns, place: float
) -> tuple[StartRuns, np.ndarray]:
    more = jax.tree_util.tree_map(lambda all_, one: np.concatenate([all_, one]), runs, row)
    return more, np.append(places, place)


def _less_bent(
    problem: Any, runs: StartRuns, places: np.ndarray, best: int
) -> tuple[StartRuns, np.ndarray]:
    """One start more where the slopes of the best one have a surface less bent.

    Barriers ask for a place of the lowest slope; where it is flattened none is to be asked
    for. Slopes of free bristles, and of targets that differ, are known only by then.
    """
    settled = jax.tree_util.tree_map(lambda rows: rows[best], runs.settled)
    ends = np.array([settled.reach.plus, settled.reach.minus])
    energy = float(np.sum(np.square(settled.waves)))
    if not settled.met or energy <= (1 + SETTINGS.proven) * float(runs.bound[best]):
        return runs, places
    found = least_bent_seen(plain_slopes(problem.layout.harmonics), ends)
    if found is None or not float(np.sum(np.square(found.waves))) < energy:
        return runs, places
    place = place_of_lowest(found.waves)
    plus, minus = ends.tolist()
    bounds = SurfaceBounds(problem.layout.harmonics, plus, minus, np.inf, np.inf)
    row = _row(problem, runs, best, bounds, BentSurface(found.waves, place, found.bound))
    return (runs, places) if row is None else _with_row(runs, places, row, place)


def _surface_within(bounds: SurfaceBounds) -> tuple[BentSurface | None, float | None]:
    """The least bent with all of the slopes, if any, and the share that there is, None
    where none was found."""
    found = least_bent_within(bounds)
    if found is not None:
        return found, 1.0
    steepest = steepest_surface(bounds)
    if steepest is None:
        return None, None
    if steepest.share < 1:
        return None, steepest.share
    place, own = steepest.place, steepest.waves / steepest.share
    return least_bent_within(bounds, place) or BentSurface(own, place, 0.0), steepest.share


def slopes_wanted(problem: Any, runs: StartRuns, index: int) -> np.ndarray | None:
    """Slopes (omega_plus, -omega_minus) that the targets ask of a start's bristles, (2,).

    Of targets that differ the best compromise, which lies between them; None where a
    bristle does not follow them.
    """
    known = problem.law.known_at(runs.settled.free[index])
    asked = slopes_asked(known, np.asarray(problem.task.coefficients))
    if not (np.all(np.isfinite(asked)) and followed(known, asked)):
        return None
    wanted = np.asarray(runs.settled.wanted[index]) * float(problem.task.slope)
    return np.clip(wanted, np.min(asked, axis=0), np.max(asked, axis=0))


def _bounds(problem: Any, slopes: np.ndarray) -> SurfaceBounds:
    task = problem.task
    plus, minus = (slopes / float(task.slope)).tolist()
    allowed = float(task.curvature), float(task.height)
    return SurfaceBounds(problem.layout.harmonics, plus, minus, *allowed)


def _row(
    problem: Any, runs: StartRuns, best: int, bounds: SurfaceBounds, found: BentSurface
) -> StartRuns | None:
    """A start of one step, with a leading axis; None where a bound does not hold."""
    array: Any = np.asarray
    task, free = problem.task, array(runs.settled.free[best])
    ends = np.array([bounds.plus, bounds.minus])
    waves = with_ends_seen(plain_slopes(bounds.harmonics), found.waves, ends)
    slopes, bends, heights = (values for _, values in extrema(waves))
    plus, minus = np.max(slopes), -np.min(slopes)
    reach = Reach(plus, minus, np.max(np.abs(bends)), np.ptp(heights))
    exact = np.max(np.abs([plus, minus] - ends)) <= BARRIER_SETTINGS.exact * np.sum(ends)
    known = problem.law.known_at(free)
    steep = plus * task.slope / known.upper, minus * task.slope / -known.lower
    room = {
        "slopes": 1 - np.max(steep),
        "curvature": 1 - reach.curvature / bounds.curvature,
        "height": 1 - reach.height / bounds.height,
        "free": np.min(np.minimum(free, 1 - free), initial=1.0),
    }
    if not exact or min(room.values()) < 0:
        return None
    rho = coefficients_of(known, task.slope * plus, task.slope * minus, np)
    left = ((np.asarray(rho) - np.asarray(task.coefficients)) * task.factors).ravel()
    held = [np.max(heights), -np.min(heights)] if problem.layout.high else []
    one = StartRuns(
        settled=Settled(array(waves), free, reach, array(ends), left, array(True)),
        path=_one_step(task, runs, [*waves, plus, plus, minus, minus, *held, *free]),
        room={name: room[name] for name in runs.room},
        bound=array(min(found.bound, float(np.sum(np.square(waves))))),
        misfit=_first(np.sum(left**2), runs.misfit.shape[1]),
        ran=array(True),
    )
    return jax.tree_util.tree_map(lambda leaf: np.asarray(leaf)[None], one)


def _one_step(task: Any, runs: StartRuns, x: list) -> Iterates:
    """As of one step, in as much room as others have."""
    kept = runs.path.x.shape[1]
    energy = np.sum(np.square(x[: runs.settled.waves.shape[1]])) / float(task.energy)
    return Iterates(
        x=_first(np.array(x), kept),
        loss=_first(energy, kept),
        weight=_first(BARRIER_SETTINGS.last, kept),
        decrement=_first(0.0, kept),
        steps=1,
        done=True,
    )


def _first(value: Any, count: int) -> Any:
    """A row, and NaN after it."""
    rows = np.full((count, *np.shape(value)), np.nan)
    rows[0] = value
    return rows
