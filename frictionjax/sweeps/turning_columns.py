"""Cells of a scene whose rod turns over, and how far they are from a limit that jumps."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from jaxtyping import Float

from .._checks import cells_of
from ..effects import NapFlip
from ..limit import LimitSolution
from ..model import Scene
from ..numerics import cubic, graph_distance
from ..turning import LimitCourse, limit_course
from ..wiggly import ENDED
from .settings import SETTINGS

if TYPE_CHECKING:
    from ..wiggly import MotionSteps

_Column = Float[np.ndarray, " n"]

NOTHING_OF_IT = {
    "strip_excess": "a rod in between has no strip, and each mode has its own",
    "survey_error": "every slip is integrated: nothing is sampled",
    "sampled": "every slip is integrated: nothing is sampled",
    "bracket": "every slip is integrated from z0: there are no brackets",
    "z_minus": "of the rod in the limit's mode; NaN in between, where it has no strip",
    "z_plus": "of the rod in the limit's mode; NaN in between, where it has no strip",
    "compression": "of straight rods: NaN where it is bent at all times asked for",
    "sprung_share": "of straight rods: NaN where it is bent at all times asked for",
}
"""What of a sweep's variables is NaN, wholly or in part, and why."""

_INSIDE = np.array([0.25, 0.5, 0.75])  # of other steps: where their cubics are seen


class GraphErrors(NamedTuple):
    """Over all of [0, T]: sup |z_eps - z| (m) and of the dissipations (J), and how far
    their completed graphs are apart, in m and J."""

    sup: float
    graph: float
    of_dissipation: float
    dissipation_graph: float


_UNKNOWN = GraphErrors(*[float("nan")] * 4)


class Pace(NamedTuple):
    """What a second is worth beside states, in m/s, and beside dissipations, in W: means of
    the limit, of the way that it goes and of the energy that it loses."""

    speed: float
    power: float


def pace_of(scene: Scene, course: LimitCourse) -> Pace:
    """Of a scene's limit."""
    duration = float(scene.duration)
    pieces = [piece for pieces in course.stretches for piece in pieces]
    way = sum(abs(piece.last - piece.z) for piece in pieces)
    spent = pieces[-1].spent if pieces else 0.0
    return Pace(way / duration, spent / duration)


def attributes(scene: Scene, effect: NapFlip) -> dict[str, Any]:
    """Of a data set: what seconds are worth, and when the limit jumps and loses what."""
    course = limit_course(scene, effect)
    pace, jumps = pace_of(scene, course), course.jumps()
    found = {"graph_speed": pace.speed, "graph_power": pace.power}
    if jumps.time.size == 0:
        return found
    lost = jumps.spent - jumps.lost
    return found | {"jump_times": jumps.time, "jump_losses": lost}


def turning_values(
    scene: Scene,
    effect: NapFlip,
    request: Any,
    report: Callable[[float], None],
) -> dict[str, np.ndarray]:
    """Values of all cells, by name; each is what it is alone."""
    from ..wiggly import MAX_STEPS, integrate_turning  # nothing else needs it

    course = limit_course(scene, effect)
    pace, ts = pace_of(scene, course), np.asarray(request.ts)
    eps, gamma = cells_of(request.eps, request.gamma)
    rows = []
    for one, power in zip(eps, gamma, strict=True):
        found = integrate_turning(
            scene,
            float(one),
            float(power),
            effect=effect,
            ts=ts,
            accuracy=request.accuracy,
            budget=MAX_STEPS,
            until=float(scene.duration) if request.suprema or request.balanced else None,
            noted=request.suprema or request.balanced,
        )
        errors = _UNKNOWN
        if found.made is not None and found.status in ENDED:
            errors = _errors(found.made, course, pace, float(one))
        rows.append(_row(found, errors, request))
        report(1.0)
    columns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    return {
        name: value.astype(np.int8) if name in ("status", "how", "mode") else value
        for name, value in columns.items()
    }


def limit_values(
    scene: Scene, effect: NapFlip, limit: LimitSolution
) -> dict[str, np.ndarray]:
    """What a data set says of the limit: over time, and of its jumps in all."""
    course = limit_course(scene, effect)
    ts, jumps = np.asarray(limit.ts), course.jumps()
    lower, upper = course.strip(ts, np.asarray(limit.mode))
    values = {
        "z_limit": limit.z,
        "root_limit": limit.root,
        "mode_limit": np.asarray(limit.mode, np.int8),
        "dissipation_limit": limit.dissipation,
        "load": course.loads(ts),
        "z_minus": lower,
        "z_plus": upper,
        "jumps": jumps.time.size,
        "jump_loss": float(np.sum(jumps.spent - jumps.lost)),
    }
    return {name: np.asarray(value) for name, value in values.items()}


def _row(found: Any, errors: GraphErrors, request: Any) -> dict[str, Any]:
    none = np.full(found.z.size, np.nan)
    row = {
        "z": found.z,
        "root": found.root,
        "mode": found.mode,
        "status": found.status,
        "steps": found.steps,
        "rejected": found.rejected,
        "tolerance": found.tolerance,
        "how": np.zeros(found.z.size),
        "bracket": none,
        "sampled": np.nan,
    }
    if request.suprema:
        row |= {"sup_error": errors.sup, "graph_error": errors.graph}
        row |= {"strip_excess": np.nan, "survey_error": np.nan}
    if request.balanced:
        good = found.status in ENDED
        row |= {
            "dissipation": found.dissipation,
            "dissipation_error": errors.of_dissipation,
            "dissipation_graph_error": errors.dissipation_graph,
            "residual": found.left if good else np.nan,
            "dissipation_gap": found.gap if good else np.nan,
        }
    return row


def _errors(
    made: "MotionSteps", course: LimitCourse, pace: Pace, eps: float
) -> GraphErrors:
    """Of a motion that has come to its end, on the times of both."""
    times, z, spent = _curve(made, eps)
    jumps = course.jumps()
    even = max(int(np.ceil(pace.speed * times[-1] / (SETTINGS.apart * eps))), 1)
    both = [times, course.changes(), np.linspace(0.0, times[-1], even + 1)]
    grid = np.unique(np.concatenate(both))
    limit = course.at(grid)
    own = np.interp(grid, times, z), np.interp(grid, times, spent)
    places = np.repeat(np.searchsorted(grid, jumps.time, side="right"), 2)
    late = np.repeat(jumps.time, 2)
    grid = np.insert(grid, places, late)

    def beside(values: _Column, ends: tuple[_Column, _Column]) -> _Column:
        return np.insert(values, places, np.stack(ends, axis=1).ravel())

    def with_jumps(values: _Column, curve: _Column) -> _Column:
        return np.insert(values, places, np.interp(late, times, curve))

    state, loss = with_jumps(own[0], z), with_jumps(own[1], spent)
    aim = beside(limit.z, (jumps.z, jumps.last))
    lost = beside(limit.dissipation, (jumps.lost, jumps.spent))
    return GraphErrors(
        sup=float(np.max(np.abs(state - aim))),
        graph=graph_distance(grid, state, aim, pace.speed),
        of_dissipation=float(np.max(np.abs(loss - lost))),
        dissipation_graph=graph_distance(grid, loss, lost, pace.power),
    )


def _curve(made: "MotionSteps", eps: float) -> tuple[_Column, _Column, _Column]:
    """Times, states and dissipation of a motion, so close that straight lines join them."""
    length, rise = made.end - made.begin, made.z1 - made.z0
    slopes = made.slope0 * length, made.slope1 * length
    off = np.maximum(np.abs(slopes[0] - rise), np.abs(slopes[1] - rise))
    bent = np.flatnonzero(off > SETTINGS.bent * eps)
    seen = cubic(_INSIDE, rise[bent, None], *(s[bent, None] for s in slopes))
    gained = _INSIDE * (made.lost1 - made.lost0)[bent, None]
    inside = (
        (made.begin[bent, None] + _INSIDE * length[bent, None]).ravel(),
        (made.z0[bent, None] + seen).ravel(),
        (made.lost0[bent, None] + gained).ravel(),
    )
    ends = [
        np.append(first[:1], last)
        for first, last in (
            (made.begin, made.end),
            (made.z0, made.z1),
            (made.lost0, made.lost1),
        )
    ]
    columns = [np.concatenate(pair) for pair in zip(ends, inside, strict=True)]
    order = np.argsort(columns[0], kind="stable")
    times, z, spent = (column[order] for column in columns)
    return times, z, spent
