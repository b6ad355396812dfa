"""A whole study: sweep, orders, tables, pictures, files."""

from pathlib import Path

import numpy as np

from ..cost_prediction import ACCURACIES, CostPrediction, fit_budget, predict_cost
from ..friction_law import friction
from ..scene_files import scene_document
from ..studies import study
from ..sweeps import sweep
from ..wiggly.methods import is_ours
from .folder import write_study
from .job import Job, joined
from .tables import coefficient_table, failed_table, order_table, row_table, sweep_table

_TIMES = 401  # pictures follow the slips of the larger eps


def expected_cost(job: Job, method: str) -> CostPrediction | None:
    """What the sweep of a job will cost; None for solvers of which nobody knows.

    Another machine's numbers where this one has not been measured: that would take longer
    than most studies.
    """
    if not is_ours(method):
        return None
    ts = study_times(job)
    return predict_cost(job.scene, ts=ts, method=method, measure=False, **job.study)


def within_budget(job: Job, seconds: float, method: str, asked: float | None) -> Job:
    """The job with the best accuracy, or the one asked for and the eps, that fit."""
    eps, gamma = job.study["eps"], job.study["gamma"]
    tried = ACCURACIES if asked is None else (asked,)
    found = fit_budget(job.scene, eps, gamma, seconds, study_times(job), method, tried)
    count = np.unique(eps).size
    note = (
        f"Budget of {seconds:g} s: accuracy {found.accuracy:.0e}, "
        f"{found.eps.size} of {count} eps, {found.cost}"
    )
    study = job.study | {"eps": found.eps.tolist(), "accuracy": found.accuracy}
    return job._replace(study=study, notes=[*job.notes, note])


def study_times(job: Job) -> np.ndarray:
    """Times in s at which a study keeps the state."""
    return np.linspace(0.0, float(job.scene.duration), _TIMES)


def run_study(job: Job, folder: Path, method: str, progress: bool) -> str:
    """Run the study that a job asks for, write it into `folder`, return its tables.

    Raises `ValueError` as `sweep` does.
    """
    scene = job.scene
    law = friction(scene)
    data = sweep(scene, ts=study_times(job), method=method, progress=progress, **job.study)
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
