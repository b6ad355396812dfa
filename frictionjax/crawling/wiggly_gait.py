"""The crawler at finite eps: every slip of both feet, until two runs agree."""

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from .._compile import padded_size
from ..model import Scene, coefficients_jit, known_turning_points, scene_of_tables
from ..wiggly import Status
from .gait import Gait
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

    def march(finer: float) -> MarchedFeet:
        numbers = *asked[:3], finer, asked.max_steps
        plan = CrawlPlan(*(jnp.asarray(float(number)) for number in numbers))
        columns = (jnp.asarray(column) for column in (starts, ends - starts, places))
        return march_feet(tables, *columns, plan)

    runs = [march(SETTINGS.finer[0])]
    for finer in SETTINGS.finer[1:]:
        runs.append(march(finer))
        error = _apart(runs[-2], runs[-1], at, asked.eps)
        if runs[-1].code or error <= asked.accuracy:
            break
    law = coefficients_jit(scene.potential)
    slip = asked.eps * float(law.rho_plus - law.rho_minus)
    return _told(runs, error, at, asked, slip)


def _apart(rough: MarchedFeet, fine: MarchedFeet, at: np.ndarray, eps: float) -> float:
    """How far in eps two runs are apart, at times at which no foot slips.

    Inside a slip an error in time, however small, is one of place.
    """
    gaps = np.abs(np.asarray(rough.stops.places) - np.asarray(fine.stops.places))[at]
    slips = np.abs(np.asarray(fine.stops.speeds))[at] > SETTINGS.in_slips
    return float(np.max(gaps[~np.any(slips, axis=1)], initial=0.0)) / eps


def _told(
    runs: list[MarchedFeet],
    error: float,
    at: np.ndarray,
    asked: CrawlRequest,
    slip: float,
) -> Gait:
    """The finest run, and whether it can be believed; `slip`: energy of one, J."""
    found = runs[-1]
    places, lost, left, tension = (
        np.asarray(column)[at]
        for column in (
            found.stops.places,
            found.stops.lost,
            found.stops.left,
            found.stops.tension,
        )
    )
    code = int(found.code)
    if code == Status.OK and not error <= asked.accuracy:
        code = int(Status.SENSITIVE)
    # Of feet that hardly move, nearly nothing is dissipated: a slip's energy beside it.
    if code == Status.OK and np.max(np.abs(left)) > SETTINGS.balance * (lost[-1] + slip):
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
