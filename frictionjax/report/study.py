"""A whole study: what it will cost, and how it is run."""

import time
from pathlib import Path

import jax.numpy as jnp
import numpy as np

from .._checks import cells_of, grid_of, require
from .._compile import in_background
from ..called_for import simulated
from ..cost import PREDICTED_ACCURACIES, CostPrediction, fit_budget, predict_cost
from ..effects import Engine, does, noise_among
from ..model import require_reach
from ..sweeps import sweep
from ..wiggly import is_ours, prepare_cells, require_accuracy
from .job import Job

_TIMES = 601  # close-ups of pictures want 8 in a slip: 8.8 at the default's largest eps
_TIMES_A_ROW = 101  # of a map: nobody draws each, and files of all would be large
_LAWS_A_ROW = 0.2, 0.5  # s of a processor: laws and orders of 6 to 24 cells, measured


def with_seed(job: Job, seed: int | None) -> Job:
    """The job with the path of its scene's noise, 0 where no other is asked for.

    Raises `ValueError` for the seed of a scene without noise.
    """
    if noise_among(job.scene.effects) is None:
        require(seed is None, "seed", seed, "none: the scene has no effects.Noise")
        return job
    return job._replace(seed=seed or 0)


def expected_cost(job: Job, method: str) -> CostPrediction | None:
    """What the sweep of a job will cost; None for solvers of which nobody knows.

    Another machine's numbers where this one has not been measured: that would take longer
    than most studies.
    """
    job = _as_simulated(job)
    if not is_ours(method) or not _is_predicted(job):
        return None
    ts = study_times(job)
    return predict_cost(job.scene, ts=ts, method=method, measure=False, **job.study)


def _as_simulated(job: Job) -> Job:
    """The job with what is simulated of its scene's effects, and numbers of a study."""
    numbers = {key: value for key, value in job.study.items() if key != "effects"}
    found = simulated(job.scene, job.study.get("effects", "all"), **numbers)
    return job._replace(scene=found.scene, study=numbers)


def _is_predicted(job: Job) -> bool:
    """Whether work can be foretold: effects of the scene may be of another kind."""
    return all(does(Engine.COST, effect) for effect in job.scene.effects)


def expectation(job: Job, method: str) -> str:
    """In words what the sweep of a job will cost.

    Raises `ValueError` for a method that there is not.
    """
    found = expected_cost(job, method)
    if found is None and is_ours(method):
        return "unknown time, as nobody has measured scenes with such effects"
    if found is None:
        from ..wiggly import solver_of  # and diffrax, 0.5 s

        solver_of(method)
        return f"unknown time, as nobody has measured {method}"
    if job.scenes:
        return _of_rows(len(job.scenes), found)
    return str(found)


def _of_rows(count: int, each: CostPrediction) -> str:
    low, high = (f"{count * seconds:.2g}" for seconds in _LAWS_A_ROW)
    return f"{count} rows, each about {each}; then {low} to {high} s for laws and orders"


def prepare_study(job: Job, method: str) -> None:
    """Have the longest program compiled in the background, 0.4 s where it is kept.

    Raises `ValueError` for eps and gamma as `sweep` does.
    """
    job = _as_simulated(job)
    if not is_ours(method) or not _is_predicted(job):
        return
    eps, gamma = grid_of("eps", job.study["eps"]), grid_of("gamma", job.study["gamma"])
    require_reach(job.scene.potential, jnp.asarray(eps))
    prepare_cells(job.scene, cells_of(eps, gamma)[0], _TIMES)


def within_budget(
    job: Job, seconds: float, method: str, asked: float | None
) -> tuple[Job, str]:
    """The job with the best accuracy, or the one asked for and the eps, that fit.

    Accuracies tried: that of the job's own study among them. In words what it is, which is
    a note of the job too.
    """
    eps, gamma = job.study["eps"], job.study["gamma"]
    if asked is not None:
        require_accuracy(asked)  # `fit_budget` would name its own argument, accuracies
    own = float(job.study["accuracy"])
    tried = {*PREDICTED_ACCURACIES, own} if asked is None else {asked}
    finest = job._replace(study=job.study | {"accuracy": min(tried)})
    found = fit_budget(
        _as_simulated(finest).scene,
        eps,
        gamma,
        seconds,
        study_times(job),
        method,
        sorted(tried),
    )
    count = np.unique(eps).size
    note = (
        f"Budget of {seconds:g} s: accuracy {found.accuracy:.0e}, "
        f"{found.eps.size} of {count} eps, {found.cost}"
    )
    study = job.study | {"eps": found.eps.tolist(), "accuracy": found.accuracy}
    return job._replace(study=study, notes=[*job.notes, note]), note


def study_times(job: Job) -> np.ndarray:
    """Times in s at which a study keeps the state."""
    count = _TIMES_A_ROW if job.scenes else _TIMES
    return np.linspace(0.0, float(job.scene.duration), count)


def run_study(job: Job, folder: Path, method: str, progress: bool) -> str:
    """Run the study that a job asks for, write it into `folder`, return its tables.

    Raises `ValueError` as `sweep` does.
    """
    in_background(_import_results, "imports", daemon=True)
    scenes, ts = job.scenes or job.scene, study_times(job)
    started = time.perf_counter()
    options = job.study | {"method": method, "key": job.seed}
    data = sweep(scenes, ts=ts, progress=progress, **options)
    seconds = time.perf_counter() - started
    from .study_results import write_results

    return write_results(job, data, folder, seconds, progress)


def _import_results() -> None:
    """Import what is needed once cells have run: pictures and data sets, 1 s.

    To draw a first picture here too saved 0.1 s: not done.
    """
    from . import study_results as study_results
