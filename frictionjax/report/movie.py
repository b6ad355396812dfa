"""A moving picture of a scene's bristle, as a file."""

import os
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from .. import plot
from .._checks import require, write_whole
from ..limit import solve_limit
from ..model import Scene
from ..wiggly import solve
from .friction import turning_scene
from .job import Job

_TIMES = 4001  # of the solution, of which frames are chosen
_FRAMES = 80
_SLIPS = 25  # about so many on the way there and back: they can be told apart


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

    `eps` in m; None: that of the scene's list whose slips can be told apart best; gamma is
    the largest of its list. The rod turns over where `bending_stiffness` (N m^2), or that
    of the scene, makes it.

    Raises `ValueError` as `plot.animate` does.
    """
    scene = turning_scene(job, bending_stiffness)
    if eps is None:
        eps = _seen_best(scene, job.study["eps"])
    gamma = float(np.max(job.study["gamma"]))  # least drag: slips look like slips
    ts = np.linspace(0.0, float(scene.duration), _TIMES)
    found = solve(scene, eps, gamma, ts)
    film = plot.animate(scene, found, eps, frames=_FRAMES)
    with tempfile.TemporaryDirectory() as place:
        whole = Path(place) / "film.gif"
        film.save(whole, writer="pillow")
        write_whole(path, whole.read_bytes())
    told = f"{path}: {_FRAMES} frames, eps = {eps:.4g} m, gamma = {gamma:.4g}"
    return told if found.ok else f"{told}; not to be trusted: {found.message}"


def _seen_best(scene: Scene, known: Any) -> float:
    """Of a list of eps the one with about `_SLIPS` on the way that the limit goes."""
    values = np.asarray(known, dtype=float)
    way = float(np.ptp(np.asarray(solve_limit(scene).z)))
    if way == 0:
        return float(np.max(values))
    return float(values[np.argmin(np.abs(np.log(values * _SLIPS / way)))])
