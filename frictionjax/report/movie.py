"""A moving picture of a scene's bristle, as a file."""

import os
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from .. import plot
from .._checks import require, write_whole
from ..contact import mechanics
from ..limit import solve_limit
from ..model import Scene
from ..wiggly import solve
from .friction import turning_scene
from .job import Job
from .sections import friction_of_slides

_TIMES = 4001  # of the solution, of which frames are chosen
_FRAMES = 80
_SLIPS = 25  # about so many on the way there and back: they can be told apart
_APART = 2.0  # times as many, or as few, still can
_FAR = 0.2  # of friction in the limit: forces that are less beyond it are near it


def require_gif(path: Any, made: Path | None = None) -> Path:
    """Check that a GIF of this name can be written; nothing is written yet.

    `made`: a folder that may not be there yet, but will be before the GIF is. Raises
    `ValueError` for another kind of file or a folder that is not there.
    """
    file = Path(path)
    require(file.suffix.lower() == ".gif", "movie", str(path), "a file named *.gif")
    folder = file.parent
    there = folder.is_dir() and os.access(folder, os.W_OK) and not file.is_dir()
    if made is not None and not folder.exists():
        there = made.resolve() == folder.resolve()
    require(there, "movie", str(path), "a file in a folder that can be written to")
    return file


def write_movie(
    job: Job, bending_stiffness: float | None, eps: float | None, path: Path
) -> str:
    """A GIF of the bristle of a job as it slides; what it shows, in a line.

    `eps` in m; None: of the scene's list one whose slips can be told apart, the first whose
    forces are within 20% of friction in the limit, else the nearest; gamma is the largest
    of its list. The line says where forces are farther off. The rod turns over where
    `bending_stiffness` (N m^2), or that of the scene, makes it.

    Raises `ValueError` as `plot.animate` does.
    """
    scene = turning_scene(job, bending_stiffness)
    known = [eps] if eps is not None else _seen_best(scene, job.study["eps"])
    gamma = float(np.max(job.study["gamma"]))  # least drag: slips look like slips
    eps, found, beyond = _nearest(scene, known, gamma)
    film = plot.animate(scene, found, eps, frames=_FRAMES)
    with tempfile.TemporaryDirectory() as place:
        whole = Path(place) / "film.gif"
        film.save(whole, writer="pillow")
        write_whole(path, whole.read_bytes())
    told = f"{path}: {_FRAMES} frames, eps = {eps:.4g} m, gamma = {gamma:.4g}"
    if beyond > _FAR:
        told += f"; forces go up to {beyond:.0%} beyond friction as eps -> 0: a smaller eps"
        told += " comes nearer"
    return told if found.ok else f"{told}; not to be trusted: {found.message}"


def _nearest(scene: Scene, known: list[float], gamma: float) -> tuple[float, Any, float]:
    """The first eps whose forces are near friction in the limit, else the nearest.

    With its solution, and by how much of that friction its forces go beyond it.
    """
    ts = np.linspace(0.0, float(scene.duration), _TIMES)
    law = friction_of_slides(scene)
    tried: list[tuple[float, Any, float]] = []
    for eps in known:
        found = solve(scene, eps, gamma, ts)
        force = mechanics(scene, found, eps).support_force.values
        ways = np.max(force / float(law.rho_plus)), np.max(force / float(law.rho_minus))
        tried.append((eps, found, float(max(ways)) - 1.0))
        if tried[-1][2] <= _FAR:
            return tried[-1]
    return min(tried, key=lambda one: one[2])


def _seen_best(scene: Scene, known: Any) -> list[float]:
    """Of a list of eps those with about `_SLIPS` on the limit's way, best first.

    One at least, though its slips be too many or too few.
    """
    values = np.asarray(known, dtype=float)
    way = float(np.ptp(np.asarray(solve_limit(scene).z)))
    if way == 0:
        return [float(np.max(values))]
    apart = np.abs(np.log(values * _SLIPS / way))
    order = np.argsort(apart)
    seen = order[apart[order] <= np.log(_APART)]
    return values[seen if seen.size else order[:1]].tolist()
