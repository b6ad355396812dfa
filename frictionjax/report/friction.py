"""The friction of a scene, as text and as numbers."""

import math
from pathlib import Path
from typing import Any

from ..contact import Nap, nap
from ..model import friction
from .job import Job, joined
from .tables import coefficient_table, coefficients_by_name, errors_by_name, row_table


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


def nap_figure(job: Job, bending_stiffness: float | None, folder: Path) -> str:
    """Its picture, of a rod on an angular spring, into a folder."""
    from .. import plot
    from .folder import write_figures

    picture = plot.draw_own_nap(job.scene.profile, job.scene.bristle, bending_stiffness)
    return write_figures(folder, iter([("nap", picture)]))[0].name


def _nap_of(job: Job, bending_stiffness: float | None) -> Nap:
    """Of the scene's parts; `job` always has a bristle."""
    profile, bristle = job.scene.profile, job.scene.bristle
    assert profile is not None
    assert bristle is not None
    return nap(profile, bristle, bending_stiffness)


def _finite(number: float | None) -> float | None:
    return None if number is None or not math.isfinite(number) else number
