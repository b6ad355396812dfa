"""A whole study: sweep, orders, tables, pictures, files."""

from pathlib import Path

import numpy as np

from ..friction_law import friction
from ..scene_files import scene_document
from ..studies import study
from ..sweeps import sweep
from .folder import write_study
from .job import Job, joined
from .tables import coefficient_table, failed_table, order_table, row_table, sweep_table

_TIMES = 401  # pictures follow the slips of the larger eps


def run_study(job: Job, folder: Path, method: str, progress: bool) -> str:
    """Run the study that a job asks for, write it into `folder`, return its tables.

    Nothing is written before all cells are done. Raises `ValueError` as `sweep` does.
    """
    scene = job.scene
    law = friction(scene)
    ts = np.linspace(0.0, float(scene.duration), _TIMES)
    data = sweep(scene, ts=ts, method=method, progress=progress, **job.study)
    found = study(data)
    sections = [("", line) for line in job.notes]
    sections.append(("Friction coefficients", coefficient_table(law, job.error)))
    if job.rows is not None:
        sections.append(("Friction over the rows of the map", row_table(job.rows)))
    sections += [
        ("Cells", sweep_table(data)),
        ("Orders of convergence", order_table(found.orders)),
        ("Failed cells", failed_table(found.failed)),
    ]
    text = joined(sections)
    toml = scene_document(scene, job.study)
    write_study(folder, found, scene, law, toml, text)
    return text
