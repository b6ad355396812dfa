"""The path of a scene: where it turns and touches, and where it is fast."""

import numpy as np

from ..._checks import ByIdentity
from ..._compile import once_a_scene
from ...model import Scene, TabulatedScene, padded_edges, strips_at
from ..equation import pull_between
from .fast_stretches import nodes_inside, probes_of, unseen_of
from .path import Path, Probes, rows_of_path
from .settings import SETTINGS

_pull = once_a_scene(pull_between)
_PATHS = ByIdentity()  # of scenes, whatever the eps


def _looked_at(path: Path) -> Path:
    """With the largest speed on slides, probed, and the extremes of the stiffness there."""
    low, high = path.touch, path.edges[1:]
    probes = probes_of(path, low, high)
    times = np.concatenate([probes, nodes_inside(low, high)], axis=1)
    motion = path.motion_at(times.ravel())
    speeds = motion.speeds.reshape(times.shape)
    count = times.shape[1] - SETTINGS.nodes
    times, seen, known = times[:, :count], speeds[:, :count], speeds[:, count:]
    unseen = unseen_of(low, high, known, times, seen)
    long = (path.direction != 0) & (high - low > SETTINGS.brief * path.edges[-1])
    return path._replace(
        speed=float(np.max(np.abs(speeds))),
        stiffness=float(np.min(motion.stiffness)),
        stiffest=float(np.max(motion.stiffness)),
        probes=Probes(times, seen, np.where(long, unseen, 0.0)),
    )


def known_path(scene: Scene, tables: TabulatedScene) -> Path | None:
    """The path of a scene with these tables, found once where it has few pieces.

    None as of `path_of`.
    """
    path = _PATHS.get(scene)
    if path is None:
        path = path_of(tables)
        if path is not None and path.direction.size <= SETTINGS.few_pieces:
            _PATHS.put(scene, path)
    elif path.support is not tables.support:  # of which the table is for an eps
        return path._replace(support=tables.support)
    return path


def path_of(scene: TabulatedScene) -> Path | None:
    """The path of a scene; None where the load turns more often than there is room for."""
    turns, duration = scene.turning_points, scene.duration
    if np.any(np.isnan(turns)):
        return None
    edges = np.unique(np.concatenate([[0.0], turns, [duration]]))
    rho_plus, rho_minus = scene.rho_plus, scene.rho_minus
    loads, lower, upper = strips_at(scene, rho_plus, rho_minus, edges)
    states = np.empty(edges.size)
    states[0] = np.clip(scene.z0, lower[0], upper[0])
    for i in range(1, edges.size):
        states[i] = np.clip(states[i - 1], lower[i], upper[i])
    moves = np.diff(states)
    direction = np.sign(moves)
    rho = np.where(direction > 0, rho_plus, rho_minus)
    path = Path(
        load=scene.load,
        support=scene.support,
        edges=edges,
        loads=loads,
        states=states,
        direction=direction,
        touch=np.where(direction == 0, edges[1:], edges[:-1]),
        travel=np.concatenate([[0.0], np.cumsum(np.abs(moves))]),
        rho=rho,
        rho_plus=rho_plus,
        rho_minus=rho_minus,
        pulled=float(np.abs(np.diff(loads)).sum()),
        outside=float(np.abs(states[0] - scene.z0)),
    )
    sliding = np.flatnonzero(direction)
    touch = path.touch.copy()
    touch[sliding] = path.times_at(sliding, states[sliding])
    path = path._replace(touch=touch)
    rho_ends = np.asarray(rho_plus), np.asarray(rho_minus)
    pull = _pull(scene.load, scene.support, padded_edges(turns, duration), *rho_ends)
    pull = pull._replace(total=path.travel[-1])
    return _looked_at(path._replace(rows=rows_of_path(path), pull=pull))
