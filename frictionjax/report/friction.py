"""The friction of a scene, as text and as numbers."""

import math
from pathlib import Path
from typing import Any

import numpy as np

from ..contact import Nap, nap
from ..effects import NapFlip, nap_flip_among
from ..limit import solve_limit
from ..model import Scene, friction
from .job import Job, joined
from .tables import coefficient_table, coefficients_by_name, errors_by_name, row_table

_TIMES = 2001  # pictures follow a rod that turns over


def friction_text(job: Job) -> str:
    """Notes of a job and tables of its friction coefficients."""
    sections = [("", line) for line in job.notes]
    table = coefficient_table(friction(job.scene), job.error)
    sections.append(("Friction coefficients", table))
    if job.rows is not None:
        sections.append(("Over the rows of the map", row_table(job.rows)))
    return joined(sections)


def friction_document(job: Job) -> dict[str, Any]:
    """The same as JSON has it: null where an error is not finite."""
    law = friction(job.scene)
    numbers: dict[str, Any] = coefficients_by_name(law)
    if law.alpha is not None:
        numbers["pulling"] = bool(law.alpha < 0)
    error = errors_by_name(law, job.error)
    if job.rows is not None or error:
        finite = {name: e if math.isfinite(e) else None for name, e in error.items()}
        numbers["error"] = finite
    if job.rows is not None:
        numbers["rows"] = {"mean": job.rows.mean, "std": job.rows.std}
    if job.notes:
        numbers["notes"] = job.notes
    return numbers


def nap_text(job: Job, bending_stiffness: float | None) -> str:
    """Notes of a job, and friction with and against the nap of its bristle."""
    sections = [("", line) for line in job.notes]
    sections.append(("With and against the nap", repr(_nap_of(job, bending_stiffness))))
    return joined(sections)


def nap_document(job: Job, bending_stiffness: float | None) -> dict[str, Any]:
    """The same as JSON has it: null for what the bristle does not have."""
    found = _nap_of(job, bending_stiffness)
    forces = {
        name: _finite(getattr(found, name))
        for name in (
            "rho_with",
            "rho_against",
            "rho_flipped",
            "ratio",
            "axial_with",
            "axial_against",
            "axial_flipped",
            "critical_load",
        )
    }
    window = None if found.window is None else found.window._asdict()
    return {**forces, "window": window, "message": found.message}


def nap_figures(job: Job, bending_stiffness: float | None, folder: Path) -> str:
    """Pictures of a rod on an angular spring into a folder; their names, a line each.

    Of one that turns over under the load of the scene also how it does, and the loops of
    both effects, all in the limit.
    """
    from .. import plot
    from .folder import write_figures

    stiffness = _stiffness(job, bending_stiffness)
    own = plot.draw_own_nap(job.scene.profile, job.scene.bristle, stiffness)
    pictures = [("nap", own)]
    notes = []
    scene = turning_scene(job, stiffness)
    if nap_flip_among(scene.effects) is not None:
        ts = np.linspace(0.0, float(scene.duration), _TIMES)
        limit = solve_limit(scene, ts)
        if np.any(np.asarray(limit.mode) != 1):
            pictures.append(("turning", plot.draw_turning(scene, limit)))
            pictures.append(("nap_loops", plot.draw_nap_loops(scene, ts)))
        else:
            notes.append("under the load of the scene the rod does not turn over")
    names = [path.name for path in write_figures(folder, iter(pictures))]
    return "\n".join(names + notes)


def turning_scene(job: Job, bending_stiffness: float | None) -> Scene:
    """The scene of a job with its rod as flexible as asked for, else as in the scene.

    A rod that turns over does so, and that alone; a stiffer one keeps its nap.
    """
    stiffness = _stiffness(job, bending_stiffness)
    if stiffness is None:
        return job.scene
    if not _nap_of(job, stiffness).turns_over:
        return job.scene.replace(effects=())
    effect = NapFlip(np.asarray(stiffness))  # type: ignore[arg-type]
    return job.scene.replace(effects=(effect,))


def _stiffness(job: Job, asked: float | None) -> float | None:
    """The bending stiffness asked for, else that of the scene, where it has one."""
    effect = nap_flip_among(job.scene.effects)
    if asked is not None or effect is None:
        return asked
    return float(effect.bending_stiffness)


def _nap_of(job: Job, bending_stiffness: float | None) -> Nap:
    """Of the scene's parts; `job` always has a bristle."""
    profile, bristle = job.scene.profile, job.scene.bristle
    assert profile is not None
    assert bristle is not None
    return nap(profile, bristle, _stiffness(job, bending_stiffness))


def _finite(number: float | None) -> float | None:
    return None if number is None or not math.isfinite(number) else number
