"""The friction of a scene, as text and as numbers."""

import math
from typing import Any

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
