"""What energy a trace gains or loses where its tip moves on by whole wells.

No surface is needed: V_eps' has zero mean over a well, so on any surface a tip that moves
on by wells, either way and however it gets there, has lost energy,
`int f dz = int eps^gamma z'^2 dt >= 0` with `f = l - Phi'(z)` (eq. 2.8). Nor is a fine
sampling: in a slip the load is constant, and f a function of z that two samples show.
"""

from typing import NamedTuple

import numpy as np

from ...wiggly import pulls_at
from ..measured_trace import Trace
from .problem import TraceProblem, states_under
from .settings import SETTINGS


class TraceStates(NamedTuple):
    """A trace as states `z` (m) and `force` = l - Phi' (N) at its samples.

    `sd`: of z, m, 0 where it is not known. `scatter`: of neighbouring forces, N.
    `stiffness`: of the support there, the median, N/m. `most`: the largest force that the
    load could build up, N.
    """

    z: np.ndarray
    force: np.ndarray
    sd: float
    scatter: float
    stiffness: float
    most: float


def seen_as(problem: TraceProblem, trace: Trace, factor: float = 1.0) -> TraceStates:
    """The trace times a factor; z is NaN where the support has no such force."""
    scene, ts = problem.scene, problem.ts[: trace.ts.size]
    rest = np.full(ts.size, float(scene.z0))
    load, start, _ = pulls_at(scene, ts, rest)
    most = abs(load[0]) + abs(start[0]) + np.ptp(load)
    z = force = factor * _without_spikes(trace.values)
    if trace.quantity == "force":
        z = states_under(scene, load - force)
    _, held, stiffness = pulls_at(scene, ts, z)
    if trace.quantity == "z":
        force = load - held
    elif not np.allclose(held, load - force, rtol=1e-6, atol=1e-9):
        z = np.full(z.size, np.nan)
    steep = float(np.median(stiffness))
    known = 0.0 if trace.uncertainty is None else float(np.median(trace.uncertainty))
    sd = abs(factor) * known / (steep if trace.quantity == "force" else 1.0)
    return TraceStates(z, force, sd, scatter_of(force), steep, float(most))


def _without_spikes(values: np.ndarray) -> np.ndarray:
    """Single samples far off both neighbours replaced by the nearer one."""
    middle = np.median(np.stack([values[:-2], values[1:-1], values[2:]]), axis=0)
    middle = np.concatenate([values[:1], middle, values[-1:]])
    most = SETTINGS.spike * scatter_of(values)
    return np.where(np.abs(values - middle) > most, middle, values)


def scatter_of(values: np.ndarray) -> float:
    """Standard deviation of one sample about its neighbours, by the median of all."""
    bends = np.diff(values, 2) / np.sqrt(6.0)
    return 1.4826 * float(np.median(np.abs(bends)))


def share_gained(seen: TraceStates, eps: float, within: float = 0.0) -> float:
    """Energy gained on ways over whole wells, as a share of all work on them.

    `within`: work of a way that noise explains, in scatters of the force times its length.
    """
    work, length = ways(seen.z, seen.force, eps)
    gains = work[work < -within * seen.scatter * length]
    if gains.size <= SETTINGS.few * seen.z.size:
        return 0.0
    return float(-np.sum(gains) / np.sum(np.abs(work)))


def ways(z: np.ndarray, force: np.ndarray, eps: float) -> tuple[np.ndarray, float]:
    """Work (J) of ways, one from each sample to where z first is `length` (m) away.

    That is whole wells, so many that a way holds some samples.
    """
    pace = float(np.median(np.abs(np.diff(z)))) / eps
    length = eps * max(1.0, float(np.ceil(SETTINGS.samples * pace)))
    steps = 0.5 * (force[1:] + force[:-1]) * np.diff(z)
    done = np.concatenate([[0.0], np.cumsum(steps)])
    count = min(z.size, SETTINGS.starts_of_ways)
    starts = np.unique(np.linspace(0, z.size - 1, count).astype(int))
    found = [np.zeros(0)]
    for lag in range(1, z.size):
        starts = starts[starts + lag < z.size]
        left = np.abs(z[starts + lag] - z[starts]) >= length
        found.append(_works(z, force, done, starts[left], lag, length))
        starts = starts[~left]
        if not starts.size:
            break
    return np.concatenate(found), length


def _works(
    z: np.ndarray,
    force: np.ndarray,
    done: np.ndarray,
    starts: np.ndarray,
    lag: int,
    length: float,
) -> np.ndarray:
    """Work of ways that end between the samples `lag - 1` and `lag` after their starts."""
    before, after = starts + lag - 1, starts + lag
    end = z[starts] + length * np.sign(z[after] - z[starts])
    step = z[after] - z[before]
    share = (end - z[before]) / step
    there = force[before] + share * (force[after] - force[before])
    return done[before] - done[starts] + 0.5 * (force[before] + there) * share * step
