"""The crawler at finite eps: every slip of both feet, until two runs agree."""

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from .._compile import padded_size
from ..model import Scene, coefficients_jit, known_turning_points, scene_of_tables
from ..wiggly import Status
from .gait import Gait
from .limit_gait import is_alike
from .march import CrawlPlan, MarchedFeet, march_feet
from .settings import SETTINGS


class CrawlRequest(NamedTuple):
    """`eps` in m, `gamma`, the error of places in eps, and the most steps of a run."""

    eps: float
    gamma: float
    accuracy: float
    max_steps: int


def wiggly_gait(scene: Scene, ts: Float[np.ndarray, " n"], asked: CrawlRequest) -> Gait:
    """Feet from 0 and L(0), at sorted times in s."""
    tables = scene_of_tables(scene, asked.eps)
    turns = known_turning_points(scene.load, scene.duration, scene.turns)
    stops = np.union1d(ts, turns[turns < ts[-1]])
    room = padded_size(stops.size, SETTINGS.stops)
    ends = np.append(stops, np.full(room - stops.size, stops[-1]))
    starts = np.append(0.0, ends[:-1])
    slack = float(scene.load(jnp.zeros(()))) / float(scene.support.stiffness_at(0.0))
    places = np.array([0.0, slack])
    at = np.searchsorted(stops, ts)

    law = coefficients_jit(scene.potential)
    slip = asked.eps * float(law.rho_plus - law.rho_minus)

    def march(finer: float) -> MarchedFeet:
        numbers = *asked[:3], finer, asked.max_steps
        plan = CrawlPlan(*(jnp.asarray(float(number)) for number in numbers))
        columns = starts, ends - starts, places
        return march_feet(tables, *map(jnp.asarray, columns), plan)

    runs = [march(SETTINGS.finer[0])]
    for finer in SETTINGS.finer[1:]:
        runs.append(march(finer))
        found = _told(runs, at, asked, slip)
        if found.code not in (Status.SENSITIVE, Status.UNBALANCED):
            break
    # Feet that are held alike both ways: rounding may decide which of them slips, and runs
    # that agree are a coin that fell the same way. (Runs that set off aside of each other
    # agreed as well: starts are forgotten before.)
    whole = found.code in (Status.OK, Status.UNBALANCED)
    if whole and is_alike(float(law.rho_plus), -float(law.rho_minus)):
        return found._replace(code=int(Status.SENSITIVE))
    return found


def _apart(rough: MarchedFeet, fine: MarchedFeet, at: np.ndarray, eps: float) -> float:
    """How far in eps two runs are apart, at times at which no foot slips.

    Inside a slip an error in time, however small, is one of place.
    """
    gaps = np.abs(np.asarray(rough.stops.places) - np.asarray(fine.stops.places))[at]
    slips = np.abs(np.asarray(fine.stops.speeds))[at] > SETTINGS.in_slips
    return float(np.max(gaps[~np.any(slips, axis=1)], initial=0.0)) / eps


def _told(
    runs: list[MarchedFeet], at: np.ndarray, asked: CrawlRequest, slip: float
) -> Gait:
    """The last run, and whether it can be believed; `slip`: energy of one, J."""
    before, found = runs[-2:]
    names = "places", "lost", "left", "tension"
    places, lost, left, tension = (
        np.asarray(getattr(found.stops, name))[at] for name in names
    )
    error = _apart(before, found, at, asked.eps)
    code = int(found.code)
    if code == Status.OK and not error <= asked.accuracy:
        code = int(Status.SENSITIVE)
    # Of feet that hardly move, nearly nothing is dissipated: a slip's energy beside it.
    allowed = asked.accuracy * (lost[-1] + slip)
    unlike = np.abs(np.asarray(before.stops.lost)[at] - lost)[-1]
    if code == Status.OK and not max(unlike, np.max(np.abs(left))) <= allowed:
        code = int(Status.UNBALANCED)
    return Gait(
        rear=places[:, 0],
        front=places[:, 1],
        tension=tension,
        dissipation=lost,
        residual=np.abs(left),
        error=error,
        steps=int(sum(run.steps for run in runs)),
        code=code,
    )
